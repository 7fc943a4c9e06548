#include "brdf/ward.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/angles.h"
#include "math/elementary.h"

namespace goniochrome::brdf {

// With h = (wi+wo)/|wi+wo|, c_h = h.n and c = h.wi,
//
//   f = 1/(c c_h) / (4 pi ax ay) exp(-2 [ (h.x/ax)^2 + (h.y/ay)^2 ] / (1 + c_h))
//
// Ward's own form has sqrt(cos_i cos_o) for c c_h. The two are the geometric and the arithmetic mean of the cosines,
// since cos_i + cos_o = |wi+wo| c_h = 2 c c_h: they are equal, with equal slope, for every mirror pair, and the latter
// does not vanish while either direction is above the surface.
//
// Energy: u = (h.x, h.y) sqrt(2/(1+c_h)) is the equal-area map of the hemisphere of h into the plane, so that
// G(u) = exp(-(u.x/ax)^2 - (u.y/ay)^2)/(pi ax ay) integrates to at most 1. With dwi = 4 c dh the albedo is the mean of
// max(0, cos_i)/c_h over G, and cos_i/c_h = 2 c - cos_o/c_h. For h and its twin (-h.x, -h.y), equally likely, c is
// c_h cos_o +- x with x^2 <= (1-c_h^2)(1-cos_o^2). Their mean is cos_o (2 c_h - 1/c_h) <= 1 where both count, and where
// one counts at most half of 2 c - cos_o/c_h <= 2.
double ward(const Vec3& to_light, const Vec3& to_viewer, const paint::Anisotropy& alpha) {
  if (to_light.z <= 0 || to_viewer.z <= 0) return 0;
  const Vec3 sum = to_light + to_viewer;
  const double size = math::hypot(sum.x, sum.y, sum.z), x = sum.x / size / alpha.alpha_x,
               y = sum.y / size / alpha.alpha_y;
  const double exponent = 2 * (x * x + y * y) / (1 + sum.z / size);
  return math::exp(-exponent) / (2 * kPi * alpha.alpha_x * alpha.alpha_y * sum.z);
}

double lobe_alpha(double exponent) {
  return std::sqrt(0.5 / exponent);
}

namespace {

// In the plane u of ward()'s derivation the wide lobe is a Gaussian of widths (narrow, wide), the narrow one a Gaussian
// of width narrow all round. The wide one is their convolution with g(t) = exp(-(t/s)^2)/(s sqrt pi) along the wide
// axis, s^2 = wide^2 - narrow^2, and n tilts sample this integral at equal steps over -reach..reach.
//
// At any u the integrand is a Gaussian in t of width w = s narrow/wide. Equal steps miss its frequencies m/step, hence
// at most 2 sum_m exp(-(pi w m/step)^2) of its integral. What lies beyond the outermost tilts is at most
// g(reach)/(narrow sqrt pi), that is (wide/s) exp(-(reach/s)^2) of the peak 1/(pi narrow wide), and as much again when
// the weights are scaled to sum 1. One tilt alone errs by wide/narrow - 1, at the peak.
struct Sampling {
  double narrow, wide;
  double spread() const { return std::sqrt((wide - narrow) * (wide + narrow)); }

  double missed(double step) const {
    const double q = math::exp(-math::pow(kPi * spread() * narrow / (wide * step), 2));
    return 2 * q / (1 - q);
  }
  double beyond(double reach) const { return 2 * (wide / spread()) * math::exp(-math::pow(reach / spread(), 2)); }

  // The reach at which both errors of `count` tilts are equal, where their sum is about least.
  double reach(int count) const {
    double low = 0, high = 40 * spread();
    for (int k = 0; k < 60; ++k) {
      const double middle = 0.5 * (low + high);
      (missed(2 * middle / count) < beyond(middle) ? low : high) = middle;
    }
    return low;
  }
  double error(int count) const {
    if (count == 1) return wide / narrow - 1;
    const double r = reach(count);
    return missed(2 * r / count) + beyond(r);
  }
  // The fewest up to `most` that are within `tolerance`, or `most`. The error falls with every tilt.
  int count(double tolerance, int most) const {
    int low = 0, high = most;
    while (high - low > 1) {
      const int middle = low + (high - low) / 2;
      (error(middle) <= tolerance ? high : low) = middle;
    }
    return high;
  }
};

// The half vector at t on the y axis of the plane u (|u| = 2 sin(angle/2)), or on the x axis.
Vec3 tilted(double t, bool along_x) {
  const double half = 0.5 * t, sine = t * std::sqrt(1 - half * half), cosine = 1 - 0.5 * t * t;
  return along_x ? Vec3{sine, 0, cosine} : Vec3{0, sine, cosine};
}

}  // namespace

Result<TiltSet> ward_tilts(const paint::Anisotropy& alpha, double narrow_alpha, double tolerance, int max_count) {
  if (!(alpha.alpha_x > 0) || !(alpha.alpha_y > 0) || std::isinf(alpha.alpha_x) || std::isinf(alpha.alpha_y))
    return input_error("anisotropy alphaX={} alphaY={}: both must be positive numbers", alpha.alpha_x, alpha.alpha_y);
  const double wide = std::max(alpha.alpha_x, alpha.alpha_y);
  const double narrow = std::max(narrow_alpha, std::min(alpha.alpha_x, alpha.alpha_y));
  TiltSet set = {{{{0, 0, 1}, 1}}, narrow, 0};
  if (narrow >= wide) return set;
  const Sampling sampling = {narrow, wide};
  const int count = sampling.count(tolerance, std::max(max_count, 1));
  set.error = sampling.error(count);
  if (count == 1) return set;
  set.tilts.clear();
  const double step = 2 * sampling.reach(count) / count;
  double total = 0;
  for (int k = 0; k < count; ++k) {
    const double t = (k - 0.5 * (count - 1)) * step;
    if (std::abs(t) >= std::numbers::sqrt2) continue;  // below the horizon
    const double weight = math::exp(-math::pow(t / sampling.spread(), 2));
    set.tilts.push_back({tilted(t, alpha.alpha_x > alpha.alpha_y), weight});
    total += weight;
  }
  for (Tilt& tilt : set.tilts) tilt.weight /= total;
  return set;
}

}  // namespace goniochrome::brdf
