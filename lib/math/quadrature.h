// Gauss quadrature: the points and weights at which sums stand for integrals.
// goniochrome-coats(7), "GLOSS" and goniochrome-prefiltering(7), "PREFILTERING".
#pragma once

#include <array>
#include <vector>

namespace goniochrome::math {

struct QuadraturePoint {
  double position, weight;
};

// The n points (ascending) and weights on [-1,1] that integrate polynomials of degree 2n-1 exactly, to rounding.
std::vector<QuadraturePoint> gauss_legendre(int n);

// Gauss quadrature of a sum: `count` points whose sum is that of these for every polynomial of degree 2 count - 1;
// these themselves where they are no more. Their positions must differ and their weights be above 0.
std::vector<QuadraturePoint> fewer_points(std::vector<QuadraturePoint> points, int count);

// `count` points on 0..1 and their weights, of sum 1; exact for polynomials of degree 2 count - 1.
struct GaussPoints {
  int count;
  std::array<double, 4> at, weight;
};
// The rules of 1, 2, 3 and 4 points.
inline constexpr std::array<GaussPoints, 4> kGaussPoints = {{
    {1, {.5}, {1}},
    {2, {.21132486540518713, .78867513459481287}, {.5, .5}},
    {3, {.1127016653792583, .5, .8872983346207417}, {5.0 / 18, 8.0 / 18, 5.0 / 18}},
    {4,
     {.06943184420297371, .33000947820757187, .66999052179242813, .93056815579702629},
     {.17392742256872693, .32607257743127307, .32607257743127307, .17392742256872693}},
}};
// The two points of the second rule; each has the weight 1/2.
inline constexpr std::array<double, 2> kGaussPair = {kGaussPoints[1].at[0], kGaussPoints[1].at[1]};

struct GaussRule {
  std::vector<double> at, weight;
};

// The rule that cuts 0..1 into `pieces` equal parts with 1 to 4 points each.
GaussRule gauss_rule(int points, int pieces);

}  // namespace goniochrome::math
