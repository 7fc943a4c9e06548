#include "brdf/disc_light.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/angles.h"
#include "base/kept_values.h"
#include "base/parallel.h"
#include "math/cosine_power.h"
#include "math/elementary.h"
#include "math/quadrature.h"

namespace goniochrome::brdf {

namespace {

// Below this radius the closed forms lose digits to cancellation, and the disc is taken as a flat one, which errs by
// the square of the radius.
constexpr double kFlat_rad = 3e-4;
// cos^E below exp(-kTail) of its largest value on the disc is left out.
constexpr double kTail = 40;
// Points of Gauss's rule over the rings of a lobe, which are at most 9 standard deviations wide together. The
// substitution of lobe_of_disc() makes the integrand smooth at both ends, so that the error falls exponentially with
// the rings.
constexpr int kRings = 48;
// Points for the nodes of tables, which are floats and between which lines are drawn: they err by less than 1e-6 of the
// largest value.
constexpr int kRingsOfNodes = 20;

// A ring at the part sin^2(x) of the way across the rings, and its weight times the derivative of that.
struct RingPoint {
  double share, weight;
};

std::vector<RingPoint> ring_rule(int rings) {
  std::vector<RingPoint> rule;
  for (const math::QuadraturePoint& point : math::gauss_legendre(rings)) {
    const double x = kPi / 4 * (1 + point.position);
    rule.push_back({math::sin(x) * math::sin(x), kPi / 4 * point.weight * math::sin(2 * x)});
  }
  return rule;
}

double square(double x) {
  return x * x;
}

// Where the rim of the disc meets the horizon, seen from its middle: the angle from straight down.
double rim_azimuth(double sine, double cosine_elevation, double radius) {
  return math::acos(std::clamp(sine * math::cos(radius) / (cosine_elevation * math::sin(radius)), -1.0, 1.0));
}

// Half of the angle about r that the ring of radius t spends within the disc of radius `radius` about l, with r and l
// `between` apart: the half-angle formula of a spherical triangle with the sides t, between and radius. The
// differences of its sides are given, since they lose their digits where they are computed here.
double half_arc(double t, double between, double radius, double inner_gap, double outer_gap) {
  // s - between = (t + radius - between)/2 and so on; of the two gaps one is t - |radius - between|, the other
  // radius + between - t.
  const double s = 0.5 * (t + between + radius);
  double by_between, by_radius;  // s - between, s - radius
  if (between >= radius) {
    by_between = 0.5 * inner_gap, by_radius = between - radius + 0.5 * inner_gap;
  } else {
    by_radius = 0.5 * inner_gap, by_between = radius - between + 0.5 * inner_gap;
  }
  const double above = math::sin(by_between) * math::sin(std::max(0.0, 0.5 * outer_gap)),
               below = math::sin(s) * math::sin(by_radius);
  return 2 * math::atan2(std::sqrt(std::max(0.0, above)), std::sqrt(std::max(0.0, below)));
}

// The largest angle at which cos^E is above exp(-kTail) of its value at the angle `from`.
double reach_from(double from, double exponent) {
  const double log_start = math::log_cosine(from);
  if (std::isinf(log_start)) return from;
  return exponent > 0 ? math::acos(math::exp(std::max(-700.0, log_start - kTail / exponent))) : kPi / 2;
}

}  // namespace

double disc_radiance(double radius_rad) {
  return 1 / (kPi * square(math::sin(radius_rad)));
}

// By Stokes' theorem the irradiance is half the integral of n.(x cross dx) along the border of the part above the
// horizon: the rim from one crossing to the other, and the arc of the horizon between both. With e the elevation of
// the middle, psi_0 the azimuth of a crossing and beta half of that arc:
//   E = (pi - psi_0) sin^2 R sin e - sin R cos R cos e sin psi_0 + beta,   cos beta = cos R / cos e
double disc_irradiance(double cosine, double radius_rad) {
  const double sine_radius = math::sin(radius_rad), cos_elevation = std::sqrt(std::max(0.0, 1 - cosine * cosine));
  if (cosine >= sine_radius) return cosine;
  if (cosine <= -sine_radius) return 0;
  const double u = cosine / sine_radius;
  if (radius_rad < kFlat_rad) {
    const double w = std::sqrt(1 - u * u);
    return sine_radius * (u * (kPi / 2 + math::asin(u)) + w * (2 + u * u) / 3) / kPi;
  }
  const double azimuth = rim_azimuth(cosine, cos_elevation, radius_rad);
  const double sin2_half_arc = std::max(0.0, square(sine_radius) - square(cosine)) / square(cos_elevation);
  const double beta = math::atan2(std::sqrt(sin2_half_arc), math::cos(radius_rad) / cos_elevation);
  const double irradiance = (kPi - azimuth) * square(sine_radius) * cosine -
                            sine_radius * math::cos(radius_rad) * cos_elevation * math::sin(azimuth) + beta;
  return std::max(0.0, irradiance / (kPi * square(sine_radius)));
}

// The part below the horizon is a sector of the disc less a spherical triangle: pi - 2 alpha - 2 psi_0 cos R, with sin
// alpha = sin e / sin R.
double disc_above(double cosine, double radius_rad) {
  const double sine_radius = math::sin(radius_rad);
  if (cosine >= sine_radius) return 1;
  if (cosine <= -sine_radius) return 0;
  const double u = cosine / sine_radius;
  if (radius_rad < kFlat_rad) return 1 - (math::acos(u) - u * std::sqrt(1 - u * u)) / kPi;
  const double azimuth = rim_azimuth(cosine, std::sqrt(1 - cosine * cosine), radius_rad);
  const double below = kPi - 2 * math::asin(u) - 2 * azimuth * math::cos(radius_rad),
               whole = 4 * kPi * square(math::sin(0.5 * radius_rad));
  return std::clamp(1 - below / whole, 0.0, 1.0);
}

double DiscRings::half_arc(double share) const {
  const double inner_gap = share * width, outer_gap = (crossing - width) + (1 - share) * width;
  return brdf::half_arc(first + inner_gap, between_rad, radius_rad, inner_gap, outer_gap);
}

// The width is that of all rings that cross the rim, written so that it keeps its digits where the disc is small.
DiscRings disc_rings(double exponent, double radius_rad, double between_rad) {
  DiscRings rings{0, std::abs(radius_rad - between_rad), 0, radius_rad, between_rad, 0};
  rings.crossing = 2 * std::min(radius_rad, between_rad);
  const bool inside = between_rad < radius_rad;
  const double reach = reach_from(inside ? 0 : rings.first, exponent);
  if (inside) rings.whole = std::min(rings.first, reach);
  rings.width = std::min({rings.crossing, reach - rings.first, kPi / 2 - rings.first});
  return rings;
}

namespace {

// Ring by ring about r. Rings that are whole within the disc have a closed form; of the others the part of the ring
// within the disc is an arc of half-angle psi about the direction to l, so that with e the unit vector from r toward l
//   power = integral of cos^E t sin t 2 psi dt,   moment = integral of cos^E t sin t (2 psi cos t r + 2 sin psi sin t
//   e)
// The arc has the slope of a square root at both ends, which t = a + (b - a) sin^2(x) takes away.
LobeOfDisc lobe_by_rule(const std::vector<RingPoint>& rule, double exponent, double radius_rad, double between_rad) {
  if (!(radius_rad > 0)) {
    const double power = math::cos_power(between_rad, exponent);
    return {power, power, 0};
  }
  const DiscRings rings = disc_rings(exponent, radius_rad, between_rad);
  const double scale = disc_radiance(radius_rad);
  double power = 0, along_r = 0, along_e = 0;
  if (between_rad < radius_rad) {
    const double log_inner = math::log_cosine(rings.first);
    power = 2 * kPi / (exponent + 1) * -math::expm1((exponent + 1) * log_inner);
    along_r = 2 * kPi / (exponent + 2) * -math::expm1((exponent + 2) * log_inner);
  }
  if (rings.width > 0) {
    for (const RingPoint& point : rule) {
      const double t = rings.first + point.share * rings.width, psi = rings.half_arc(point.share);
      const double weight = point.weight * rings.width * math::sin(t) * math::cos_power(t, exponent);
      power += weight * 2 * psi;
      along_r += weight * 2 * psi * math::cos(t);
      along_e += weight * 2 * math::sin(psi) * math::sin(t);
    }
  }
  // e = (l - cos(between) r)/sin(between). Where both directions agree there is no e, and nothing along it.
  LobeOfDisc lobe{scale * power, 0, scale * along_r};
  const double sine_between = math::sin(between_rad);
  if (sine_between > 1e-12) {
    lobe.by_light = scale * along_e / sine_between;
    lobe.by_mirror = std::max(0.0, scale * along_r - lobe.by_light * math::cos(between_rad));
  }
  return lobe;
}

}  // namespace

LobeOfDisc lobe_of_disc(double exponent, double radius_rad, double between_rad) {
  static const std::vector<RingPoint> rule = ring_rule(kRings);
  return lobe_by_rule(rule, exponent, radius_rad, between_rad);
}

DiscLobeTable::Node DiscLobeTable::at(double chord) const {
  const double x = (chord - first_chord) * nodes_per_chord;
  if (x >= kNodes - 1) return {};
  const double from = std::max(0.0, x);
  const auto i = static_cast<std::size_t>(from);
  const auto t = static_cast<float>(from - static_cast<double>(i));
  Node node;
  for (int k = 0; k < 2; ++k) {
    node.cosine[k] = nodes[i].cosine[k] + t * (nodes[i + 1].cosine[k] - nodes[i].cosine[k]);
    node.plain[k] = nodes[i].plain[k] + t * (nodes[i + 1].plain[k] - nodes[i].plain[k]);
  }
  return node;
}

DiscLobeTable::Node disc_lobe_node(double exponent, double radius_rad, double chord) {
  static const std::vector<RingPoint> rule = ring_rule(kRingsOfNodes);
  const LobeOfDisc lobe = lobe_by_rule(rule, exponent, radius_rad, 2 * math::asin(std::min(1.0, 0.5 * chord)));
  const double both = lobe.by_light + lobe.by_mirror;
  DiscLobeTable::Node node;
  node.cosine[0] = static_cast<float>(lobe.by_light), node.cosine[1] = static_cast<float>(lobe.by_mirror);
  if (!(both > 0)) return node;
  node.plain[0] = static_cast<float>(lobe.power * lobe.by_light / both);
  node.plain[1] = static_cast<float>(lobe.power * lobe.by_mirror / both);
  return node;
}

namespace {

// A table is smooth over several nodes nearly everywhere, so that one node of eight is computed and those between
// follow from a polynomial of degree 5 through six of these. What it errs by is at most 5/1024 of the sixth difference
// in the middle; where that is more than kFill of the largest value, as at the horizon of wide lobes, nodes are
// computed.
constexpr int kStride = 8;
constexpr double kFill = 1e-6;
constexpr int kPoints = 6;

using Numbers = std::array<double, 4>;  // of a node

Numbers numbers_of(const DiscLobeTable::Node& node) {
  return {node.cosine[0], node.cosine[1], node.plain[0], node.plain[1]};
}

// Lagrange's weights of points at -2..3 for the places 1/8..7/8.
std::array<std::array<double, kPoints>, kStride> fill_weights() {
  std::array<std::array<double, kPoints>, kStride> weights{};
  for (std::size_t j = 0; j < kStride; ++j) {
    for (std::size_t m = 0; m < kPoints; ++m) {
      double weight = 1;
      for (std::size_t n = 0; n < kPoints; ++n)
        if (n != m)
          weight *= (static_cast<double>(j) / kStride + 2 - static_cast<double>(n)) /
                    (static_cast<double>(m) - static_cast<double>(n));
      weights[j][m] = weight;
    }
  }
  return weights;
}

// Nodes that were computed, at every kStride-th place of a table.
class CoarseNodes {
 public:
  explicit CoarseNodes(const std::vector<DiscLobeTable::Node>& nodes) {
    for (std::size_t i = 0; i < DiscLobeTable::kNodes - 1; i += kStride) {
      coarse_.push_back(numbers_of(nodes[i]));
      const Numbers& v = coarse_.back();
      largest_[0] = std::max(largest_[0], v[0] + v[1]), largest_[1] = std::max(largest_[1], v[2] + v[3]);
    }
  }
  // The intervals between them.
  std::size_t intervals() const { return coarse_.size() - 1; }

  bool is_smooth(std::size_t interval) const {
    constexpr std::array<double, kPoints + 1> kSixth = {1, -6, 15, -20, 15, -6, 1};
    if (interval < 3 || interval + 4 >= coarse_.size()) return false;
    for (const std::size_t first : {interval - 3, interval - 2}) {
      for (std::size_t k = 0; k < 4; ++k) {
        double difference = 0;
        for (std::size_t m = 0; m <= kPoints; ++m) difference += kSixth[m] * coarse_[first + m][k];
        if (!(5.0 / 1024 * std::abs(difference) <= kFill * largest_[k / 2])) return false;
      }
    }
    return true;
  }
  DiscLobeTable::Node between(std::size_t interval, std::size_t j) const {
    static const auto weights = fill_weights();
    Numbers sum{};
    for (std::size_t m = 0; m < kPoints; ++m)
      for (std::size_t k = 0; k < 4; ++k) sum[k] += weights[j][m] * coarse_[interval - 2 + m][k];
    DiscLobeTable::Node node;
    for (std::size_t k = 0; k < 2; ++k) {
      node.cosine[k] = static_cast<float>(std::max(0.0, sum[k]));
      node.plain[k] = static_cast<float>(std::max(0.0, sum[k + 2]));
    }
    return node;
  }

 private:
  std::vector<Numbers> coarse_;
  std::array<double, 2> largest_{};
};

DiscLobeTable made_table(double exponent, double radius) {
  DiscLobeTable table;
  // Nine standard deviations of the lobe to both sides of the rim.
  const double reach = 9 / std::sqrt(exponent + 0.5);
  const double first = std::max(0.0, radius - reach), last = std::min({kPi, radius + reach, radius + kPi / 2});
  const double last_chord = 2 * math::sin(0.5 * last);
  table.first_chord = 2 * math::sin(0.5 * first);
  table.nodes_per_chord = (DiscLobeTable::kNodes - 1) / (last_chord - table.first_chord);
  table.nodes.resize(DiscLobeTable::kNodes + 1);
  const auto compute = [&](std::size_t i) {
    table.nodes[i] =
        disc_lobe_node(exponent, radius, table.first_chord + static_cast<double>(i) / table.nodes_per_chord);
  };
  constexpr std::size_t kComputed = DiscLobeTable::kNodes - 1;
  parallel_for((kComputed + kStride - 1) / kStride, 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) compute(i * kStride);
  });
  const CoarseNodes coarse(table.nodes);
  parallel_for(coarse.intervals() + 1, 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t interval = begin; interval < end; ++interval) {
      const bool smooth = coarse.is_smooth(interval);
      for (std::size_t j = 1; j < kStride; ++j) {
        const std::size_t i = interval * kStride + j;
        if (smooth) {
          table.nodes[i] = coarse.between(interval, j);
        } else if (i < kComputed) {
          compute(i);
        }
      }
    }
  });
  return table;
}

}  // namespace

std::shared_ptr<const DiscLobeTable> disc_lobe_table(double exponent, double radius_rad) {
  static KeptValues<std::pair<double, double>, DiscLobeTable> kept;
  return kept.get({exponent, radius_rad}, [&] { return made_table(exponent, radius_rad); });
}

std::shared_ptr<const DiscHorizonTable> disc_horizon_table(double radius_rad) {
  static KeptValues<double, DiscHorizonTable> kept;
  return kept.get(radius_rad, [&] {
    DiscHorizonTable table;
    for (int i = 0; i <= DiscHorizonTable::kNodes; ++i) {
      const double sine = math::sin(radius_rad * std::min(1.0, 2.0 * i / (DiscHorizonTable::kNodes - 1) - 1));
      table.nodes.push_back(
          {static_cast<float>(disc_irradiance(sine, radius_rad)), static_cast<float>(disc_above(sine, radius_rad))});
    }
    return table;
  });
}

DiscLobeTable::Node disc_lobe(double exponent, double radius_rad, double chord) {
  struct Known {
    double exponent = 0, radius_rad = 0;
    std::shared_ptr<const DiscLobeTable> table;
  };
  constexpr std::size_t kKnown = 32;
  thread_local std::array<Known, kKnown> known;
  thread_local std::size_t next = 0;
  for (const Known& one : known)
    if (one.table != nullptr && one.exponent == exponent && one.radius_rad == radius_rad) return one.table->at(chord);
  Known& one = known[next++ % kKnown];
  one = {exponent, radius_rad, disc_lobe_table(exponent, radius_rad)};
  return one.table->at(chord);
}

}  // namespace goniochrome::brdf
