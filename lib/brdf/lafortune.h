// Generalized cosine lobes describe a spatially varying surface: every texel has a set of its own.
// goniochrome-surfaces(7), "SPATIALLY VARYING SURFACES"; [McAllister2002], after Lafortune and others 1997.
#pragma once

#include <vector>

#include "base/vec3.h"
#include "color/color.h"

namespace goniochrome::brdf {

// rho_s (axes . wi wo)^n in the frame x = tangent, y = bitangent, z = normal. Axes (-1,-1,1) make a Phong lobe.
struct LafortuneLobe {
  color::Rgb albedo;  // rho_s, 1/sr
  Vec3 axes = {-1, -1, 1};
  double exponent = 1;  // n >= 0
};

struct Lafortune {
  color::Rgb diffuse;  // rho_d, 1/sr
  std::vector<LafortuneLobe> lobes;
};

// scale * x^n, taken in logarithms so that a large x^n and a small scale meet in range: 0 where x <= 0 or scale = 0,
// and the largest finite double instead of an overflow. Relative error 1e-12 where the result is a normal number.
double scaled_power(double scale, double x, double exponent);

// f(wi,wo) in 1/sr; 0 where a direction is below the surface.
color::Rgb brdf(const Lafortune& surface, const Vec3& to_light, const Vec3& to_viewer);

// Multiplies n + 1 by a factor; the lobe reflects as much light. Where its axes x and y are longer than z, they keep
// how much it grows toward grazing angles: n (a^2 - 1) stays.
void widen(LafortuneLobe& lobe, double factor);

// Widens a lobe for normals of its frame that vary about their mean, which has this length. [Toksvig2005]
void widen_by_normals(LafortuneLobe& lobe, double mean_length);

// The look-up of a lobe in a prefiltered environment: L = weight * P_n(direction), P_n of
// goniochrome-prefiltering(7), "PREFILTERING".
struct LobeFetch {
  Vec3 direction = {0, 0, 1};  // unit, in the frame of the surface
  color::Rgb weight;           // rho_s |p|^n max(0, n.p/|p|) 2 pi/(n+1); 0 where the lobe's peak is below the surface
};
LobeFetch environment_fetch(const LafortuneLobe& lobe, const Vec3& to_viewer);

// Two neighbors in an ascending list of stored exponents and the weight of the upper one, linear in log n; beyond the
// ends of the list, the outermost one has all the weight.
struct ExponentBlend {
  int lower = 0;
  double upper_weight = 0;
};
ExponentBlend exponent_blend(double exponent, const std::vector<double>& stored);

}  // namespace goniochrome::brdf
