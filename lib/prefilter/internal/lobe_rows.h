// Powers of the cosine summed over many texels or points at a time, in double precision, by the widest vectors that the
// machine has. CosineKernel sums by these.
#pragma once

#include <cstddef>
#include <vector>

#include "prefilter/internal/horizon_table.h"

namespace goniochrome::prefilter::rows {

// A row of a lat-long map at polar angle theta: adds the sum over columns of rgb[3j+c] max(0, a + b sine[j] +
// c cosine[j])^exponent to sum[c].
void add_lat_long_row(const float* rgb, std::size_t columns, const double* sine, const double* cosine, double a,
                      double b, double c, double exponent, double sum[3]);

// A row of a cube's face: directions (p + q s[j]) / n with n^2 = m + s[j]^2, solid angles weight[j] / n^3.
void add_cube_row(const float* rgb, std::size_t columns, const double* s, const double* weight, double p, double q,
                  double m, double exponent, double sum[3]);

// Points (x,y,z)[j] of flux rgb[3j+c]: adds rgb max(0, d.(x,y,z))^exponent.
void add_points(const float* rgb, std::size_t points, const double* x, const double* y, const double* z,
                const double d[3], double exponent, double sum[3]);

// The points whose cosine to d is within `margin` of `cosine`: their indices in order to `found`, which has room for
// all. Returns how many.
std::size_t points_near(std::size_t points, const double* x, const double* y, const double* z, const double d[3],
                        double cosine, double margin, std::size_t* found);

// Texels beyond the end of a band that its sums may read, and do not count.
constexpr std::size_t kPadding = 16;

// The sum over `count` nodes of weight[i] max(0, a + b level[i])^exponent. Both arrays are kPadding longer, with
// weights of 0.
double sum_of_powers(const double* weight, const double* level, std::size_t count, double a, double b, double exponent);

// A part of a row of a lat-long map: the cosine is a + b sine[j] + c cosine[j] in the middle of a texel, changes by
// width (b cosine[j] - c sine[j]) along the row and by e + f sine[j] + g cosine[j] down, each taken as `least` or more.
// Texels have the solid angle `area`.
struct LatLongBand {
  double a, b, c, width, e, f, g, least, area;
  std::size_t columns;
};
// Texels that lie so near to the horizon, or are so large, that the four corners are needed.
struct CutTexels {
  std::vector<double> middle, along, down, area;
  std::vector<std::size_t> at;  // of the weight
  std::size_t count = 0;
};
// The solid angle of each texel of the part times the mean over it of the function whose second antiderivative is
// `band`, to weights[from], weights[from + 1], ... Cut texels are not weighed, and added to `cut` instead. Sine, cosine
// and weights have kPadding more places.
void lat_long_band_weights(const double* sine, const double* cosine, const LatLongBand& part,
                           const SecondIntegral& band, float* weights, std::size_t from, CutTexels& cut);
// The weights of the cut texels.
void cut_band_weights(const CutTexels& cut, const SecondIntegral& band, float* weights);

// A strip is kStrip neighboring texels of a row. Adds the sum over strips of the texels from rgb[3 at[i]] on, each
// times the weight of its own, of which there are kStrip to a strip, to sum[c].
constexpr std::size_t kStrip = 16;
void add_strips(const float* rgb, const int* at, const float* weights, std::size_t strips, double sum[3]);

// A row of a cube's face at the height t, `down` high: directions (p + q s[j]) / n with n^2 = m + s[j]^2, where p grows
// by r for each unit of t; texels are width[j] wide.
struct CubeBand {
  double p, q, m, t, r, down, least;
};
// Adds rgb[3j+c] times the solid angle of texel j and the mean over it of the function whose second antiderivative is
// `band`.
void add_cube_band(const float* rgb, std::size_t columns, const double* s, const double* width, const CubeBand& at,
                   const SecondIntegral& band, double sum[3]);

}  // namespace goniochrome::prefilter::rows
