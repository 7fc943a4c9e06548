// The colors that a print shows, as a table of chromas.
#pragma once

#include <string>
#include <vector>

#include "color/color.h"

namespace goniochrome::color {

struct PrintGamut {
  static constexpr int kLightnesses = 25, kHues = 72;

  std::string name;
  double darkest = 0, lightest = 100;  // L* of its gray axis
  std::vector<double> chroma;          // the largest ones; for each L* at even steps of that axis, a row of hues from 0

  // The largest chroma at a lightness and hue, interpolated; 0 beyond the gray axis.
  double most(double lightness, double hue_deg) const;
  // The color of the same hue, and as far as possible of the same lightness, with no more chroma than the print has.
  Lab nearest(const Lab& lab) const;
};

}  // namespace goniochrome::color
