// How visible the random error of a radiance is. goniochrome-theory(7), PATHS.
#pragma once

#include <array>

#include "color/color.h"

namespace goniochrome::render {

// The covariance of three channels: rr gg bb rg rb gb.
using Covariance = std::array<double, 6>;

// The root mean square CIEDE2000 difference between a radiance and the same with a small random error of this
// covariance, as seen before a diffuse white of this luminance. To first order in the error; without the rotation term
// of blues, which is worth a few percent.
double noise_de00(const color::Rgb& radiance, const Covariance& covariance, double white_luminance);

}  // namespace goniochrome::render
