// This evaluates spherical harmonics at many scattered directions: on a fine grid by fast transforms, then by a short
// weighted sum around each direction (a non-uniform fast Fourier transform).
// goniochrome-prefiltering(7), "Zonal harmonics".
#pragma once

#include <cstddef>
#include <vector>

#include "base/unset_array.h"
#include "envmap/rotation.h"
#include "envmap/sphere_grid.h"
#include "prefilter/internal/harmonics.h"

namespace goniochrome::prefilter {

// Taps along each axis for an error of `error` relative to the largest value of the function; 2..14.
int taps_for(double error);

// Polar angle and azimuth (harmonics.h), in the frame of the environment, of the texel centers of a grid in the scene
// that `turn` brings the environment to; row by row.
struct GridAngles {
  std::vector<double> theta, phi;
  GridAngles(const envmap::SphereGrid& grid, const envmap::Rotation& turn);
};

// Texels of a lobe map, RGB: the sum over l, m of k[l] a_lm Y_lm at the angles, negative values set to zero (nothing
// below zero is true). The degree is k.size() - 1, at most that of `harmonics`.
std::vector<float> lobe_values(const Harmonics& harmonics, const std::vector<double>& k, const GridAngles& angles,
                               int taps);

// The Fourier moments along the rows of a grid onto which the texels of an environment (constant patches, at the
// nodes of a quadrature that is good enough once degree l is multiplied by k[l]) are spread: the way back of the same
// transform. Frequency n of the column moments is to be multiplied by scale[|n|].
struct ScatteredMoments {
  UnsetArray<double> values;  // [m][row][re R G B im R G B]
  std::size_t rows = 0, circle = 0;
  std::ptrdiff_t first_row = 0;
  std::vector<double> scale;
};
ScatteredMoments scattered_moments(const envmap::Environment& env, const std::vector<double>& k,
                                   const envmap::Clip& clip);

}  // namespace goniochrome::prefilter
