// Powers of the cosine summed over many texels or points at a time, in double precision, by the widest vectors that the
// machine has. CosineKernel sums by these.
#pragma once

#include <cstddef>

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

}  // namespace goniochrome::prefilter::rows
