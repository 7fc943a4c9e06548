// The image of the mirror in a coat, which no table has a place for: it is widened to an orange peel of small slopes.
// goniochrome-export(7), "RGL table".
#pragma once

namespace goniochrome::materials {

// The slopes of the surface, a Gaussian distribution of half vectors.
inline constexpr double kMirrorSlope = 0.01;

// Its density at that angle of the half vector from the normal, 1/sr; 0 beyond 0.2 rad.
double mirror_peak(double half_rad);

// The area of such a surface that a viewer at that cosine sees, relative to the area of the ground: the cosine, and
// more near grazing. A mirror that reflects F shows F mirror_peak / (4 mirror_area), in f cos(theta_light).
double mirror_area(double cosine);

// Lobes of that exponent and more are narrower than the cells of a table at even angles: the mirror gets their light.
inline constexpr double kSharpestInCells = 1000;

}  // namespace goniochrome::materials
