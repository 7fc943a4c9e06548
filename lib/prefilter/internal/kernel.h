// The kernel of a filter: a zonal kernel K, a function of the angle to the middle of the lobe alone. Its map is P(d) =
// scale() times the integral of L(w) K(angle between d and w) dw, so that a constant map stays itself.
//
// The methods of this room ask the kernel for what they need. ZonalKernel answers from values of K where it can, by
// quadrature and differences; CosineKernel knows everything in closed form; NumericKernel makes a kernel of any
// function. goniochrome-prefiltering(7), "PREFILTERING".
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "base/angles.h"

namespace goniochrome::prefilter {

class ZonalKernel {
 public:
  // The angle from which on K is zero and up to which it is smooth: no quadrature may reach across it.
  struct Edge {
    double cosine = -2, angle_rad = 2 * kPi;  // beyond the sphere: there is none
    bool exists() const { return cosine > -1; }
  };
  explicit ZonalKernel(Edge edge) : edge_(edge) {}
  virtual ~ZonalKernel() = default;

  const Edge& edge() const { return edge_; }
  // True for the cosine itself up to 90 deg: the centroid of a texel then stands for all of it.
  virtual bool is_cosine() const { return false; }

  // K at an angle of the given cosine: 1 at the top, falling from there to 0 or more.
  virtual double value(double cosine) const = 0;
  // 1 over the integral of K over the sphere, 1/sr.
  virtual double scale() const = 0;
  // 1 over the width of K, 1/rad, at least 1: the power cos^E has sqrt(E).
  virtual double sharpness() const = 0;
  // The exponent of the cosine power that is as sharp: plans, costs and sizes of maps go by it.
  virtual double exponent() const { return sharpness() * sharpness(); }
  // K is below 1e-30 beyond this angle, in radians.
  virtual double support_rad() const = 0;

  // Zonal harmonic coefficients. k_l, l = 0..degree: what the filter multiplies degree l by; k_0 = 1.
  virtual std::vector<double> multipliers(int degree) const;
  // The sum over all l beyond a table of multipliers of (2l+1)|k_l|, or 1e300 where it has no bound.
  virtual double tail(const std::vector<double>& multipliers) const;
  // sqrt(sum over l > degree of (2l+1) k_l^2).
  virtual double norm_beyond(int degree) const;

  // Quadrature over texels. The most that ln K changes per radian up to this angle.
  virtual double variation(double angle_rad) const;
  // About the value at this small angle, in radians, inside the edge.
  virtual double near_edge(double angle_rad) const;
  // True if K bends so much beside its edge that a few points in a texel there do not serve.
  virtual bool bends_beside_edge() const { return edge_.exists(); }
  // The mean of K over a parallelogram on which the cosine is linear: t0 in the middle, changing by a and b from side
  // to side.
  virtual double linear_mean(double t0, double a, double b) const;

  // Blocks. dK/dt at the cosine t, where K is `value`; t lies inside the edge.
  virtual double slope(double t, double value) const;
  // The largest |d2K/dt2| between two cosines inside the edge, at which K is `least` and `most`.
  virtual double bend(double low, double high, double least, double most) const;
  // The mean of K over the cosines between the edge and the one at which K is `most`.
  virtual double mean_to_edge(double most) const { return most / 2; }

  // Sums of rgb[3j+c] K(cosine j) over many texels or points, added to sum[c].
  // A row of a lat-long map: the cosines are a + b sine[j] + c cosine[j].
  virtual void add_lat_long_row(const float* rgb, std::size_t columns, const double* sine, const double* cosine,
                                double a, double b, double c, double sum[3]) const;
  // A row of a cube's face: the cosines are (p + q s[j]) / n with n^2 = m + s[j]^2, the solid angles weight[j] / n^3.
  virtual void add_cube_row(const float* rgb, std::size_t columns, const double* s, const double* weight, double p,
                            double q, double m, double sum[3]) const;
  // Points (x,y,z)[j] whose flux is rgb.
  virtual void add_points(const float* rgb, std::size_t points, const double* x, const double* y, const double* z,
                          const double d[3], double sum[3]) const;

 private:
  Edge edge_;
};

// max(0, cos)^E, E >= 0: scale() is (E+1)/(2 pi).
class CosineKernel final : public ZonalKernel {
 public:
  explicit CosineKernel(double exponent) : ZonalKernel({0, kPi / 2}), exponent_(exponent) {}

  bool is_cosine() const override { return exponent_ == 1; }
  double value(double cosine) const override;
  double scale() const override { return (exponent_ + 1) / (2 * kPi); }
  double sharpness() const override;
  double exponent() const override { return exponent_; }
  double support_rad() const override;
  std::vector<double> multipliers(int degree) const override;
  double tail(const std::vector<double>& multipliers) const override;
  double norm_beyond(int degree) const override;
  double variation(double angle_rad) const override;
  double near_edge(double angle_rad) const override;
  bool bends_beside_edge() const override { return exponent_ < 2 && exponent_ != 0 && exponent_ != 1; }
  double linear_mean(double t0, double a, double b) const override;
  double slope(double t, double value) const override { return exponent_ * value / t; }
  double bend(double low, double high, double least, double most) const override;
  double mean_to_edge(double most) const override { return most / (exponent_ + 1); }
  void add_lat_long_row(const float* rgb, std::size_t columns, const double* sine, const double* cosine, double a,
                        double b, double c, double sum[3]) const override;
  void add_cube_row(const float* rgb, std::size_t columns, const double* s, const double* weight, double p, double q,
                    double m, double sum[3]) const override;
  void add_points(const float* rgb, std::size_t points, const double* x, const double* y, const double* z,
                  const double d[3], double sum[3]) const override;

 private:
  double exponent_;
};

// A kernel that is known by its values: a function of the angle in radians, 1 at 0 and falling, smooth up to `edge_rad`
// if it is given, and else everywhere.
class NumericKernel final : public ZonalKernel {
 public:
  explicit NumericKernel(std::function<double(double angle_rad)> of_angle, double edge_rad = Edge{}.angle_rad);

  double value(double cosine) const override;
  double scale() const override { return scale_; }
  double sharpness() const override { return sharpness_; }
  double support_rad() const override { return support_rad_; }

 private:
  double angle_at(double share) const;

  std::function<double(double)> of_angle_;
  double support_rad_ = 0, sharpness_ = 1, scale_ = 1;
};

}  // namespace goniochrome::prefilter
