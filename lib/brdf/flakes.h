// The flakes of a paint as its lobes have them: each flake is a mirror that shows one direction, drawn from the cosine
// power of its lobe, so that the mean over many flakes is the lobe. goniochrome-flakes(7), MODEL.
#pragma once

#include <vector>

#include "base/vec3.h"
#include "brdf/flake_tree.h"
#include "paint/paint.h"

namespace goniochrome::brdf {

// The part of the flakes that reflects by each lobe of the fit, in order: flakes are equally bright, so that it is the
// part of the light of all flakes. The sum is 1, or 0 where the paint has no flakes.
std::vector<double> flake_shares(const paint::LobeFit& fit);

// The radius of the disc of even radiance as which a flake shows a disc: both have the same spread about the middle.
double shown_radius(double disc_radius_rad, double flake_spread_deg);

// The part of a lobe's flakes that show a disc of that radius, the middle of which is so far from the mirror direction,
// horizon apart; at most 1.
double part_that_shows(double exponent, double radius_rad, double between_rad);

// Flakes that show a disc, as a box of tilts. `mirrored` is the mirror direction of the view, and `across` any direction that is
// fixed to the surface. Tilts are cos^(E+1) of the angle to the mirror direction, and the turn about it.
FlakeBox tilts_that_show(double exponent, const Vec3& mirrored, const Vec3& across, const Vec3& toward,
                         double radius_rad);

// The grain of a disc lamp in one lobe: the mean light for a weight K_DD of 1 and a white of 1, and the variance
// of it over patches that hold one flake of the lobe each, relative to the mean squared.
struct DiscGrain {
  double mean = 0, relative_variance = 0;
};
DiscGrain disc_grain(double exponent, const Vec3& normal, const Vec3& mirrored, const Vec3& toward, double radius_rad,
                     double spread_deg, double coat_index);

}  // namespace goniochrome::brdf
