#include "brdf/lobe_merge.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "base/angles.h"

namespace goniochrome::brdf {

namespace {

// Lobes are compared as these viewers see them: one along the normal, and four at each of two slopes. A lobe looks the
// same from the other side.
struct Viewer {
  Vec3 direction;
  double weight;  // the cosine-weighted part of the hemisphere that it stands for
};
constexpr std::size_t kViewers = 9;

const std::array<Viewer, kViewers>& viewers() {
  static const auto all = [] {
    std::array<Viewer, kViewers> result{};
    result[0] = {{0, 0, 1}, 0.1};
    std::size_t next = 1;
    for (const auto& [slope_deg, weight] : {std::pair{35.0, 0.5}, std::pair{65.0, 0.4}}) {
      const double sine = std::sin(slope_deg * kDegree), cosine = std::cos(slope_deg * kDegree);
      for (int i = 0; i < 4; ++i, ++next) {
        const double azimuth = 0.25 * kPi * i;
        result[next] = {{sine * std::cos(azimuth), sine * std::sin(azimuth), cosine}, 0.25 * weight};
      }
    }
    return result;
  }();
  return all;
}

// The matrix of a lobe's axes in the frame of the surface: even I + odd (cos 2a, sin 2a; sin 2a, -cos 2a), and z.
struct AxesMatrix {
  double even, odd_c, odd_s, z;

  explicit AxesMatrix(const TurnedLobe& turned)
      : even(0.5 * (turned.lobe.axes.x + turned.lobe.axes.y)), z(turned.lobe.axes.z) {
    const double half = 0.5 * (turned.lobe.axes.x - turned.lobe.axes.y);
    odd_c = half * std::cos(2 * turned.turn_rad), odd_s = half * std::sin(2 * turned.turn_rad);
  }
  Vec3 operator*(const Vec3& d) const {
    return {(even + odd_c) * d.x + odd_s * d.y, odd_s * d.x + (even - odd_c) * d.y, z * d.z};
  }
};

// A lobe as the viewers see it: with p = A wo, what it reflects to each, 2 pi/(n+1) rho |p|^n, and its middle p/|p|.
struct Part {
  TurnedLobe lobe;
  AxesMatrix axes;
  double log_n1 = 0, energy = 0;
  std::array<double, kViewers> strength{};
  std::array<Vec3, kViewers> middle{};

  explicit Part(const TurnedLobe& of) : lobe(of), axes(of), log_n1(std::log1p(of.lobe.exponent)) {
    const double whole = lobe_energy(of.lobe);
    for (std::size_t v = 0; v < kViewers; ++v) {
      const Vec3 p = axes * viewers()[v].direction;
      const double size2 = dot(p, p);
      if (!(size2 > 1e-30)) continue;
      middle[v] = (1 / std::sqrt(size2)) * p;
      strength[v] = whole * std::exp(std::clamp(0.5 * of.lobe.exponent * std::log(size2), -200.0, 200.0));
      energy += viewers()[v].weight * strength[v];
    }
  }
};

// The error of the union of two lobes: for each viewer the energy that is not where it was. Lobes whose widths or
// middles differ by little are hardly told apart; where they differ by more than a width, all of the weaker is lost.
double loss(const Part& a, const Part& b) {
  const double width = a.log_n1 - b.log_n1, n1 = std::exp(0.5 * (a.log_n1 + b.log_n1)), wide = 0.5 * width * width;
  double sum = 0;
  for (std::size_t v = 0; v < kViewers; ++v) {
    const double both = a.strength[v] + b.strength[v];
    if (!(both > 0)) continue;
    const Vec3 apart = a.middle[v] - b.middle[v];
    const double differ = wide + 0.5 * n1 * dot(apart, apart);
    sum += viewers()[v].weight * a.strength[v] * b.strength[v] / both * differ / (1 + differ);
  }
  return sum;
}

// The symmetric form m(d) = m0 dx^2 + m1 dy^2 + m2 dz^2 + 2 m3 dx dy that is nearest to the values at the viewers, by
// weighted least squares; the normal equations are solved by Cholesky's factors.
std::array<double, 4> nearest_form(const std::array<double, kViewers>& values,
                                   const std::array<double, kViewers>& weights) {
  double a[4][4] = {}, x[4] = {};
  for (std::size_t v = 0; v < kViewers; ++v) {
    const Vec3& d = viewers()[v].direction;
    const double row[4] = {d.x * d.x, d.y * d.y, d.z * d.z, 2 * d.x * d.y};
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j <= i; ++j) a[i][j] += weights[v] * row[i] * row[j];
      x[i] += weights[v] * row[i] * values[v];
    }
  }
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j <= i; ++j) {
      for (int k = 0; k < j; ++k) a[i][j] -= a[i][k] * a[j][k];
      a[i][j] = i == j ? std::sqrt(std::max(a[i][i], 1e-300)) : a[i][j] / a[j][j];
    }
    for (int k = 0; k < i; ++k) x[i] -= a[i][k] * x[k];
    x[i] /= a[i][i];
  }
  for (int i = 3; i >= 0; --i) {
    for (int k = i + 1; k < 4; ++k) x[i] -= a[k][i] * x[k];
    x[i] /= a[i][i];
  }
  return {x[0], x[1], x[2], x[3]};
}

// One lobe that reflects to each viewer what two do, as far as a lobe can. Since it reflects |A wo|^n, the quadratic
// form of A^2 is fitted to the power 2/n of what both reflect together; its energy, channel by channel, is theirs.
Part united(const Part& a, const Part& b) {
  const double whole = a.energy + b.energy, share = whole > 0 ? b.energy / whole : 0.5;
  std::array<double, kViewers> both{}, weights{};
  double spread = 0, most = 0;
  for (std::size_t v = 0; v < kViewers; ++v) {
    both[v] = a.strength[v] + b.strength[v];
    if (!(both[v] > 0)) continue;
    const Vec3 apart = a.middle[v] - b.middle[v];
    spread += viewers()[v].weight * a.strength[v] * b.strength[v] / both[v] * dot(apart, apart) / whole;
    most = std::max(most, both[v]);
  }
  if (!(most > 0)) return a;
  const double log_n1 = a.log_n1 + share * (b.log_n1 - a.log_n1);
  LafortuneLobe lobe;
  lobe.exponent = std::max(1 / (std::exp(-log_n1) + 0.5 * spread) - 1, 0.05);
  // An error of the form counts as it changes the strength. No viewer is quite without weight, so that the form is
  // determined.
  std::array<double, kViewers> values{};
  for (std::size_t v = 0; v < kViewers; ++v) {
    const double relative = both[v] / most;
    values[v] = relative > 0 ? std::pow(relative, 2 / lobe.exponent) : 0;
    const double slope = values[v] > 1e-6 ? relative / values[v] : 0;
    weights[v] = viewers()[v].weight * (slope * slope + 1e-6);
  }
  const std::array<double, 4> form = nearest_form(values, weights);
  const double even = 0.5 * (form[0] + form[1]), odd_c = 0.5 * (form[0] - form[1]), odd_s = form[3],
               half = std::hypot(odd_c, odd_s), turn = half > 1e-12 ? 0.5 * std::atan2(odd_s, odd_c) : 0;
  const double z = std::sqrt(std::max(form[2], 1e-12));
  // A lobe keeps the side to which its parts send light.
  const auto side = [&](double cosine, double sine) {
    const auto along = [&](const AxesMatrix& m) {
      return m.even + m.odd_c * (cosine * cosine - sine * sine) + 2 * m.odd_s * cosine * sine;
    };
    return (1 - share) * along(a.axes) + share * along(b.axes) > 0 ? 1.0 : -1.0;
  };
  const double c = std::cos(turn), s = std::sin(turn), long_side = std::sqrt(std::max(even + half, 0.0)) / z,
               short_side = half > 1e-12 ? std::sqrt(std::max(even - half, 0.0)) / z : long_side;
  lobe.axes = {side(c, s) * long_side, half > 1e-12 ? side(-s, c) * short_side : side(c, s) * short_side,
               (1 - share) * a.axes.z + share * b.axes.z < 0 ? -1.0 : 1.0};
  lobe.albedo = color::Rgb{1, 1, 1};
  Part result(turned_lobe(lobe, turn));
  const double gray_a = color::mean(a.lobe.lobe.albedo), gray_b = color::mean(b.lobe.lobe.albedo);
  color::Rgb albedo;
  if (gray_a > 0) albedo += (a.energy / (gray_a * result.energy)) * a.lobe.lobe.albedo;
  if (gray_b > 0) albedo += (b.energy / (gray_b * result.energy)) * b.lobe.lobe.albedo;
  result.lobe.lobe.albedo = albedo;
  const double scale = color::mean(albedo);
  for (double& strength : result.strength) strength *= scale;
  result.energy *= scale;
  return result;
}

// More viewers than those by which lobes are chosen, evenly over the cosine-weighted half of the hemisphere.
constexpr std::size_t kWitnesses = 24;
const std::array<Vec3, kWitnesses>& witnesses() {
  static const auto all = [] {
    std::array<Vec3, kWitnesses> result{};
    for (std::size_t i = 0; i < kWitnesses; ++i) {
      const double at = static_cast<double>(i), sine = std::sqrt((at + 0.5) / kWitnesses),
                   azimuth = kPi * (0.61803398874989485 * at - std::floor(0.61803398874989485 * at));
      result[i] = {sine * std::cos(azimuth), sine * std::sin(azimuth), std::sqrt(1 - sine * sine)};
    }
    return result;
  }();
  return all;
}

// The mean over a lobe of the cosine of its light to the normal, where that is above the surface. A lobe of exponent n
// sends its light (n+1)/(n+2) along its middle and with the variance 1/(n+3) to each side, here as a normal
// distribution.
double mean_cosine(double middle, double exponent) {
  const double mean = middle * (exponent + 1) / (exponent + 2),
               deviation = std::sqrt(std::max(1 - middle * middle, 1e-12) / (exponent + 3)), at = mean / deviation;
  return 0.5 * mean * std::erfc(-at / std::numbers::sqrt2) + deviation * std::exp(-0.5 * at * at) / std::sqrt(2 * kPi);
}

// The reflection of a lobe of albedo 1 to each witness, in light from all around.
std::array<double, kWitnesses> reflected(const TurnedLobe& turned) {
  const AxesMatrix axes(turned);
  const double n = turned.lobe.exponent;
  std::array<double, kWitnesses> result{};
  for (std::size_t v = 0; v < kWitnesses; ++v) {
    const Vec3 p = axes * witnesses()[v];
    const double size2 = dot(p, p);
    if (!(size2 > 1e-30)) continue;
    result[v] = 2 * kPi / (n + 1) * mean_cosine(p.z / std::sqrt(size2), n) *
                std::exp(std::clamp(0.5 * n * std::log(size2), -200.0, 200.0));
  }
  return result;
}

// Scales the albedos of `few` so that they reflect to each witness what `all` do, channel by channel, by the iteration
// of Richardson and Lucy: it keeps the whole, stays close to where it starts, and has no negative values.
void keep_energy(const std::vector<TurnedLobe>& all, std::vector<TurnedLobe>& few) {
  constexpr int kSteps = 20;
  std::array<color::Rgb, kWitnesses> wanted{};
  for (const TurnedLobe& lobe : all) {
    const auto seen = reflected(lobe);
    for (std::size_t v = 0; v < kWitnesses; ++v) wanted[v] += seen[v] * lobe.lobe.albedo;
  }
  std::vector<std::array<double, kWitnesses>> seen;
  for (const TurnedLobe& lobe : few) seen.push_back(reflected(lobe));
  for (int step = 0; step < kSteps; ++step) {
    std::array<color::Rgb, kWitnesses> ratio{};
    for (std::size_t v = 0; v < kWitnesses; ++v) {
      color::Rgb shown;
      for (std::size_t k = 0; k < few.size(); ++k) shown += seen[k][v] * few[k].lobe.albedo;
      for (int c = 0; c < 3; ++c) ratio[v][c] = shown[c] > 0 ? wanted[v][c] / shown[c] : 1;
    }
    for (std::size_t k = 0; k < few.size(); ++k) {
      color::Rgb sum;
      double whole = 0;
      for (std::size_t v = 0; v < kWitnesses; ++v) sum += seen[k][v] * ratio[v], whole += seen[k][v];
      if (whole > 0) few[k].lobe.albedo = (1 / whole) * (few[k].lobe.albedo * sum);
    }
  }
}

}  // namespace

LobeSurface merged(LobeSurface surface, int most) {
  if (surface.lobes.size() <= static_cast<std::size_t>(most)) return surface;
  std::vector<Part> parts;
  for (const TurnedLobe& lobe : surface.lobes) parts.emplace_back(lobe);
  // The nearest later part of each, and what their union loses.
  std::vector<std::size_t> partner(parts.size());
  std::vector<double> least(parts.size());
  const auto look = [&](std::size_t i) {
    least[i] = std::numeric_limits<double>::infinity();
    for (std::size_t j = i + 1; j < parts.size(); ++j)
      if (const double l = loss(parts[i], parts[j]); l < least[i]) least[i] = l, partner[i] = j;
  };
  for (std::size_t i = 0; i < parts.size(); ++i) look(i);
  while (parts.size() > static_cast<std::size_t>(most)) {
    const auto i = static_cast<std::size_t>(std::min_element(least.begin(), least.end()) - least.begin());
    const std::size_t j = partner[i], last = parts.size() - 1;
    parts[i] = united(parts[i], parts[j]);
    parts[j] = parts[last];
    parts.pop_back(), least.pop_back(), partner.pop_back();
    for (std::size_t k = 0; k < parts.size(); ++k)
      if (k == i || k == j || partner[k] == i || partner[k] == j || partner[k] == last || partner[k] >= parts.size()) {
        look(k);
      } else {
        for (const std::size_t changed : {i, j})
          if (changed > k && changed < parts.size())
            if (const double l = loss(parts[k], parts[changed]); l < least[k]) least[k] = l, partner[k] = changed;
      }
  }
  std::vector<TurnedLobe> few;
  for (const Part& part : parts) few.push_back(part.lobe);
  keep_energy(surface.lobes, few);
  surface.lobes = std::move(few);
  return surface;
}

}  // namespace goniochrome::brdf
