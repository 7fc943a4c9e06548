#include "prefilter/internal/horizon_table.h"

#include <algorithm>
#include <cmath>

#include "base/angles.h"

// Let k_l be the multipliers of K = max(0, t)^E and s(x) a taper that falls from 1 at x <= kUntouched to 0 at x = 1.
// The smooth part has the multipliers s(l/L) k_l, so that harmonics up to L give its map exactly. The other part is
// D = K - smooth part. It is of the order L^-E at the horizon and falls as fast as the taper is smooth: with u = L t,
// the integral of |D| beyond |u| = 12 is a hundredth of the whole for the taper below, beyond 16 a three-hundredth.
//
// A band that ends at |t| = r leaves out T, which is D beyond r less two bumps within r that have the integrals of D
// beyond either end; without these an even map would change. The mean square of what T makes of a map is, by Parseval,
// the sum over l of d_l^2 times the mean square of the map's degree l, where d_l are the multipliers of T.

namespace goniochrome::prefilter {

namespace {

constexpr double kUntouched = 0.2;
// Widths of bands in units of 1 / L, from the widest.
constexpr double kReaches[] = {40, 32, 26, 22, 19, 16, 14, 12, 10, 8, 6, 4, 0};
constexpr double kBeyond = 100;    // where D is looked at
constexpr double kBump = 6;        // width of a bump
constexpr double kCut = 0.9;       // of a side: half of the diagonal, and the reach of the differences
constexpr double kFarTexel = 3.5;  // side of a texel for which means by variance serve
constexpr int kNodes = 16;         // to such a unit; D has about 10 units to a wave

// The integral of (1 - y^2)^3 over y = -1..1, run from the end: three derivatives are continuous.
double taper(double x) {
  if (x <= kUntouched) return 1;
  const double y = 2 * (x - kUntouched) / (1 - kUntouched) - 1, y2 = y * y;
  return 0.5 - 35.0 / 32 * y * (1 - y2 * (1 - y2 * (3.0 / 5 - y2 / 7)));
}

// The first and the second antiderivative of a bump of the integral 1 over 0..width: (1 - cos(2 pi x/width))/width.
struct Bump {
  double once, twice;
};
Bump bump(double x, double width) {
  if (x <= 0) return {0, 0};
  if (x >= width) return {1, x - width / 2};
  const double turn = 2 * kPi * x / width, sine = std::sin(turn / 2);
  return {(turn - std::sin(turn)) / (2 * kPi), x * x / (2 * width) - width * sine * sine / (2 * kPi * kPi)};
}

// The sum of c_l P_l(t), by Clenshaw's recurrence.
double legendre_sum(const std::vector<double>& c, double t) {
  double next = 0, after = 0;
  for (std::size_t l = c.size(); l-- > 1;) {
    const double n = static_cast<double>(l);
    const double here = c[l] + (2 * n + 1) / (n + 1) * t * next - (n + 1) / (n + 2) * after;
    after = next, next = here;
  }
  return c[0] + t * next - after / 2;
}

// Adds weight P_l(t), for every l of the table.
void add_degrees(double t, double weight, std::vector<double>& degrees) {
  double p = 1, before = 0;
  for (std::size_t l = 0; l < degrees.size(); ++l) {
    const double n = static_cast<double>(l);
    degrees[l] += weight * p;
    const double next = ((2 * n + 1) * t * p - n * before) / (n + 1);
    before = p, p = next;
  }
}

// The root mean square of what multipliers d_l make of a map. Beyond the degrees of the table the largest d_l counts.
Vec3 filtered_rms(const std::vector<double>& d, const std::vector<Vec3>& rms_beyond) {
  double largest = 0;
  for (std::size_t l = rms_beyond.size(); l < d.size(); ++l) largest = std::max(largest, std::fabs(d[l]));
  Vec3 result;
  for (int c = 0; c < 3; ++c) {
    double square = std::pow(largest * rms_beyond.back()[c], 2);
    for (std::size_t l = 1; l < rms_beyond.size(); ++l) {
      const double beyond = rms_beyond[l][c], with = rms_beyond[l - 1][c];
      square += d[l] * d[l] * std::max(0.0, with * with - beyond * beyond);
    }
    result[c] = std::sqrt(square);
  }
  return result;
}

// K, its smooth part and D at the nodes, and where the band ends.
struct Parting {
  double exponent, scale, step;  // between nodes, in the cosine
  std::vector<double> smooth;    // c_l of the smooth part

  // The power of K and of its antiderivatives.
  static double power(double t, double e) { return t > 0 ? std::pow(t, e) : 0.0; }
  double smooth_at(double node) const { return legendre_sum(smooth, node * step); }
  double rest(int node) const { return power(node * step, exponent) - smooth_at(node); }
};

// The integrals of D beyond a node on either side; its own half step counts.
struct Beyond {
  int end;
  double below, above;
};

// From the widest band inward: D at the nodes that are left out is added to the multipliers d_l, then what the bumps
// take away, until more is left out than allowed.
Beyond narrowest_band(const Parting& parting, const std::vector<Vec3>& rms_beyond, const Vec3& allowed,
                      Vec3& left_out) {
  const double degree = static_cast<double>(rms_beyond.size()) - 1, step = parting.step;
  const double weight = 2 * kPi * parting.scale * step;
  const int far = static_cast<int>(std::min(kBeyond, 0.99 * degree) * kNodes);
  std::vector<double> degrees(rms_beyond.size() * 3 / 2);
  Beyond best = {far, 0, 0}, sums = {far + 1, 0, 0};
  for (const double units : kReaches) {
    const int end = std::min(far, static_cast<int>(units * kNodes));
    for (; sums.end > end + 1; --sums.end) {
      const int node = sums.end - 1;
      const double below = parting.rest(-node), above = parting.rest(node);
      add_degrees(-node * step, weight * below, degrees), add_degrees(node * step, weight * above, degrees);
      sums.below += below * step, sums.above += above * step;
    }
    const double below = parting.rest(-end), above = end > 0 ? parting.rest(end) : 0;
    const Beyond here = {end, sums.below + below * step / 2, sums.above + above * step / 2};
    std::vector<double> tail = degrees;
    add_degrees(-end * step, weight * below / 2, tail), add_degrees(end * step, weight * above / 2, tail);
    const int width = std::min(static_cast<int>(kBump * kNodes), end);
    for (int node = 1; node < width; ++node) {
      const double share = 2 * kPi * parting.scale * (1 - std::cos(2 * kPi * node / width)) / width;
      add_degrees((node - end) * step, -share * here.below, tail);
      add_degrees((end - width + node) * step, -share * here.above, tail);
    }
    const Vec3 rms = filtered_rms(tail, rms_beyond);
    const bool fits = rms.x <= allowed.x && rms.y <= allowed.y && rms.z <= allowed.z;
    if (!fits && units != kReaches[0]) break;
    best = here, left_out = rms;
    if (!fits) break;
  }
  return best;
}

}  // namespace

double SecondIntegral::at(double cosine) const {
  const double last = static_cast<double>(coefficients.size() / 4 - 1);
  const double y = (cosine - begin) * per_unit, interval = std::clamp(std::floor(y), 0.0, last), z = y - interval;
  const double* c = &coefficients[4 * static_cast<std::size_t>(interval)];
  return c[0] + z * (c[1] + z * (c[2] + z * c[3]));
}

// The mean as of CosineKernel::linear_mean().
double SecondIntegral::mean(double middle, double along, double down) const {
  const double wide = (along + down) / 2, narrow = (along - down) / 2;
  return (at(middle + wide) - at(middle + narrow) - at(middle - narrow) + at(middle - wide)) / (along * down);
}

// A mean over a texel that no edge cuts depends on little but its variance v = (along^2 + down^2)/12: to the fourth
// order in the side h it is D + v D''/2 + h^4 D/1920 .. h^4 D/1440, as the texel is turned, which leaves 0.3 % of D
// where h is a third of a wave; larger texels do without. m0 is half way between texels on a side and on a corner, and
// m1 is half of its second derivative, by differences over half a unit.
void SecondIntegral::make_means(double side_rad) {
  cut = 1e300;
  if (side_rad * per_unit > kFarTexel * kNodes) return;
  const double corner = side_rad / std::sqrt(2.0);
  variance = side_rad * side_rad / 12;
  cut = kCut * side_rad;
  means_begin = -reach - side_rad;
  const int count = static_cast<int>(std::ceil(2 * (reach + side_rad) * per_unit)) + 1, wide = kNodes / 2;
  std::vector<double> m0, m1;
  for (int n = -wide; n <= count + wide; ++n) {
    const double t = means_begin + n / per_unit;
    m0.push_back((mean(t, side_rad, 1e-3 * side_rad) + mean(t, corner, corner)) / 2);
  }
  for (int n = 0; n <= count; ++n) {
    const double* here = &m0[static_cast<std::size_t>(n + wide)];
    m1.push_back((here[wide] - 2 * here[0] + here[-wide]) * std::pow(per_unit / wide, 2) / 2);
  }
  means.clear();
  for (int n = 0; n < count; ++n) {
    const double* level = &m0[static_cast<std::size_t>(n + wide)];
    const double* bend = &m1[static_cast<std::size_t>(n)];
    for (const double m : {level[0], level[1] - level[0], bend[0], bend[1] - bend[0]}) means.push_back(m);
  }
}

double SecondIntegral::far_mean(double middle, double along, double down) const {
  const double last = static_cast<double>(means.size() / 4 - 1);
  const double y = std::clamp((middle - means_begin) * per_unit, 0.0, last), interval = std::floor(y), z = y - interval;
  const double* m = &means[4 * static_cast<std::size_t>(interval)];
  return m[0] + z * m[1] + ((along * along + down * down) / 12 - variance) * (m[2] + z * m[3]);
}

// Step 1: the two antiderivatives at the nodes of the band: of K in closed form, of the smooth part by Simpson's rule,
// which errs by (0.65/kNodes)^4/2880 of D. Step 2: cubics through them and their slopes, and the means.
HorizonParts::HorizonParts(const CosineKernel& kernel, const std::vector<Vec3>& rms_beyond, const Vec3& allowed,
                           double side_rad)
    : multipliers_(kernel.multipliers(static_cast<int>(rms_beyond.size()) - 1)) {
  const double degree = static_cast<double>(rms_beyond.size()) - 1, e = kernel.exponent();
  Parting parting = {e, kernel.scale(), 1 / (kNodes * degree), std::vector<double>(multipliers_.size())};
  for (std::size_t l = 0; l < multipliers_.size(); ++l) {
    multipliers_[l] *= taper(static_cast<double>(l) / degree);
    parting.smooth[l] = (2 * static_cast<double>(l) + 1) / (4 * kPi * kernel.scale()) * multipliers_[l];
  }
  const auto [end, below, above] = narrowest_band(parting, rms_beyond, allowed, left_out_);
  const double step = parting.step, reach = end * step, width = std::min(kBump * kNodes * step, reach);
  std::vector<double> f = {0}, slope = {0};  // F and F' at the nodes from one end to the other
  double before = parting.smooth_at(-end), once = 0, twice = 0;
  for (int node = -end; node < end; ++node) {
    const double middle = parting.smooth_at(node + 0.5), after = parting.smooth_at(node + 1), t = (node + 1) * step;
    twice += step * once + step * step / 6 * (before + 2 * middle);
    once += step / 6 * (before + 4 * middle + after);
    const Bump low = bump(t + reach, width), high = bump(t - reach + width, width);
    f.push_back(Parting::power(t, e + 2) / ((e + 1) * (e + 2)) - twice + below * low.twice + above * high.twice);
    slope.push_back(Parting::power(t, e + 1) / (e + 1) - once + below * low.once + above * high.once);
    before = after;
  }
  band_.reach = reach;
  band_.begin = -reach - step;
  band_.per_unit = 1 / step;
  band_.coefficients = {0, 0, 0, 0};
  for (std::size_t n = 0; n + 1 < f.size(); ++n) {
    const double rise = f[n + 1] - f[n], s0 = step * slope[n], s1 = step * slope[n + 1];
    for (const double c : {f[n], s0, 3 * rise - 2 * s0 - s1, s0 + s1 - 2 * rise}) band_.coefficients.push_back(c);
  }
  for (const double c : {f.back(), step * slope.back(), 0.0, 0.0}) band_.coefficients.push_back(c);
  if (end > 0) band_.make_means(side_rad);
}

}  // namespace goniochrome::prefilter
