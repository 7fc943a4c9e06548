// The color map of a flake paint holds its color at every pair of directions in one plane with the normal. Every other
// pair has the color of the pair in plane that lies on its isoline, or, where a map says so, of a pair in plane that
// has its aspecular angle. goniochrome-interference(7), "ISOCHROMATIC LINES"; [Kirchner], figure 2
#pragma once

#include <vector>

#include "brdf/isoline.h"
#include "color/color.h"

namespace goniochrome::brdf {

// Reflectance factors (pi f, 1 = perfect diffuser) in the working space, gloss left out, negative where a color is
// outside it, over the cosines of both angles in air: `size` columns, cosine of one direction from 0 (90 deg) to 1; 2
// size rows from the top, cosine of the other from 0 to 1 on the opposite side of the normal (the gloss line is the
// diagonal of this half), then back to 0 on the same side. Texel centers at (i + 1/2)/size.
struct ColorMap {
  int size = 0;
  double index = 1.5;          // of the coat
  std::vector<float> factors;  // RGB interleaved, row by row
  // The color is a function of the aspecular angle in air alone, so that no isoline is followed.
  bool aspecular = false;
  // How far each texel is from the nearest reading of the map: degrees in the plane of the aspecular angle in the coat
  // and the angle of incidence on the flakes, or, where `aspecular`, of the aspecular angle in air. Empty: not known.
  std::vector<float> distance_deg = {};

  float* texel(int column, int row) { return &factors[3 * (static_cast<std::size_t>(row) * size + column)]; }
  const float* texel(int column, int row) const {
    return &factors[3 * (static_cast<std::size_t>(row) * size + column)];
  }
};

// An unfilled map.
ColorMap color_map_of_size(int size, double index);

// The directions to light and viewer that a texel's center stands for, the light at azimuth 0.
struct MapDirections {
  Vec3 light, view;
};
MapDirections map_directions(int size, int column, int row);

// Where a pair stands, in texels from the upper left corner. A fetch there is bilinear, and held at the borders.
struct MapPlace {
  double x = 0, y = 0;
};
MapPlace map_place(const InPlane& pair, int size);

// The bilinear fetch.
color::Rgb fetched(const ColorMap& map, const MapPlace& place);

// The place of a pair in plane that has an aspecular angle (0..180 deg): in the first column, where the light grazes.
MapPlace aspecular_place(double aspecular_rad, int size);

// Where a pair above the surface, in plane or not, is looked up. `treatment` has no effect on an aspecular map.
MapPlace place_of_pair(const ColorMap& map, const Vec3& to_light, const Vec3& to_viewer, CriticalAngle treatment);

// The reflectance factor for unit directions in the frame z = normal, in plane or not; 0 where one is below the
// surface.
color::Rgb reflectance_factor(const ColorMap& map, const Vec3& to_light, const Vec3& to_viewer,
                              CriticalAngle treatment);

}  // namespace goniochrome::brdf
