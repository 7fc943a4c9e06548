#include "brdf/internal/scattered_brdf.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/angles.h"
#include "math/elementary.h"

namespace goniochrome::brdf {

namespace {

constexpr double kSameDirection_deg = 0.05;  // nearer is the sample itself

// A viewing direction as seen from the mirror direction of its light, in degrees: `toward` the normal (signed, the
// aspecular angle in plane) and `across` the plane of incidence (folded to >= 0: the sample is isotropic).
struct Offset {
  double toward = 0, across = 0;
};
double distance(const Offset& a, const Offset& b) {
  return math::hypot(a.toward - b.toward, a.across - b.across);
}

Offset aspecular_offset(const Vec3& light, const Vec3& view) {
  const double sine = math::hypot(light.x, light.y);
  const Vec3 ahead = sine > 0 ? Vec3{light.x / sine, light.y / sine, 0} : Vec3{1, 0, 0};
  const Vec3 mirror = {-light.x, -light.y, light.z};
  const Vec3 toward = light.z * ahead + Vec3{0, 0, sine};
  const double angle_deg = math::atan2(length(cross(mirror, view)), dot(mirror, view)) / kDegree;
  const double along = dot(view, toward), beside = std::abs(dot(view, cross({0, 0, 1}, ahead)));
  const double size = math::hypot(along, beside);
  if (size == 0) return {angle_deg, 0};
  const double across = angle_deg * beside / size;
  constexpr double kInPlane_deg = 1e-3;  // angles in the file are rounded to 1e-6 rad
  return across < kInPlane_deg ? Offset{std::copysign(angle_deg, along), 0} : Offset{angle_deg * along / size, across};
}

struct Share {
  std::size_t index;
  double weight;
};

// The samples of one incidence angle.
struct Ring {
  double incidence_deg = 0;
  std::vector<Offset> offsets;
  std::vector<std::size_t> rows;
};

// The vertices of the Delaunay triangle around `at`, with barycentric weights; fewer on an edge or a vertex, none
// outside the convex hull.
//
// Lift each point onto the paraboloid z = |p - at|^2. The triangle is the facet of the lower convex hull over `at`,
// that is, the vertices of the solution of
//     minimize sum l_i |p_i - at|^2   with   sum l_i (p_i - at) = 0,  sum l_i = 1,  l_i >= 0,
// found by the simplex method from three far and costly points. In plane (across = 0, the border of the hull) only
// points in plane can balance, so there it is the plain interpolation between neighbors in aspecular angle.
std::vector<Share> delaunay_shares(const std::vector<Offset>& points, const Offset& at) {
  struct Vertex {
    double x, y, cost;
  };
  constexpr double kFar_deg = 1e3, kFarCost = 1e9, kInside = 1e-6;
  const std::size_t n = points.size();
  const auto vertex = [&](std::size_t i) -> Vertex {
    if (i < n) {
      const double x = points[i].toward - at.toward, y = points[i].across - at.across;
      return {x, y, x * x + y * y};
    }
    const double turn = 2 * kPi / 3 * static_cast<double>(i - n) + 0.1;
    return {kFar_deg * math::cos(turn), kFar_deg * math::sin(turn), kFarCost};
  };
  std::array<std::size_t, 3> basis = {n, n + 1, n + 2};
  std::array<double, 3> weight{};
  // A few dozen rounds suffice, unless many points lie on one circle, where the search may go round among equals: then
  // any of the triangles is one.
  const std::size_t most_rounds = 100 + 10 * std::min<std::size_t>(n, 20);
  for (std::size_t round = 0; round < most_rounds; ++round) {
    const Vertex a = vertex(basis[0]), b = vertex(basis[1]), c = vertex(basis[2]);
    const double area = (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
    const auto barycentric = [&](double x, double y) -> std::array<double, 3> {
      const double wb = ((x - a.x) * (c.y - a.y) - (c.x - a.x) * (y - a.y)) / area;
      const double wc = ((b.x - a.x) * (y - a.y) - (x - a.x) * (b.y - a.y)) / area;
      return {1 - wb - wc, wb, wc};
    };
    weight = barycentric(0, 0);
    const double slope_x = ((b.cost - a.cost) * (c.y - a.y) - (c.cost - a.cost) * (b.y - a.y)) / area;
    const double slope_y = ((b.x - a.x) * (c.cost - a.cost) - (c.x - a.x) * (b.cost - a.cost)) / area;
    std::size_t entering = n;
    double deepest = -1e-9 * (1 + std::abs(a.cost));
    for (std::size_t i = 0; i < n; ++i) {
      const Vertex p = vertex(i);
      const double below = p.cost - a.cost - slope_x * (p.x - a.x) - slope_y * (p.y - a.y);
      if (below < deepest && i != basis[0] && i != basis[1] && i != basis[2]) deepest = below, entering = i;
    }
    if (entering == n) break;
    const Vertex p = vertex(entering);
    const auto direction = barycentric(p.x, p.y);
    std::size_t leaving = 3;
    double step = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double limit = std::max(weight[k], 0.0) / direction[k];
      if (direction[k] > 1e-10 && (leaving == 3 || limit < step)) leaving = k, step = limit;
    }
    if (leaving == 3) break;
    basis[leaving] = entering;
  }
  std::vector<Share> shares;
  double total = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    if (weight[k] < kInside) continue;
    if (basis[k] >= n) return {};
    shares.push_back({basis[k], weight[k]});
    total += weight[k];
  }
  for (Share& share : shares) share.weight /= total;
  return shares;
}

// Square roots flatten a flake lobe, so that a straight line between samples errs less; the sign survives.
double root(double f) {
  return std::copysign(std::sqrt(std::abs(f)), f);
}
double unroot(double r) {
  return std::copysign(r * r, r);
}

class ScatteredBrdf final : public MeasuredBrdf {
 public:
  ScatteredBrdf(MeasuredTraits traits, std::vector<ScatteredRow> rows)
      : MeasuredBrdf(std::move(traits)), rows_(std::move(rows)) {
    constexpr double kSameIncidence_deg = 0.5;
    std::vector<std::pair<double, std::size_t>> order;
    for (std::size_t i = 0; i < rows_.size(); ++i) order.push_back({polar_angle(rows_[i].pair.light) / kDegree, i});
    std::sort(order.begin(), order.end());
    for (const auto& [incidence_deg, i] : order) {
      if (rings_.empty() || incidence_deg > rings_.back().incidence_deg + kSameIncidence_deg)
        rings_.push_back({incidence_deg, {}, {}});
      rings_.back().offsets.push_back(aspecular_offset(rows_[i].pair.light, rows_[i].pair.view));
      rings_.back().rows.push_back(i);
    }
  }

  // Each measured incidence answers at the same offset from its own mirror direction; two neighbors are blended.
  MeasuredValue value(const Vec3& light, const Vec3& view) const override {
    const double incidence_deg = polar_angle(light) / kDegree;
    const Offset at = aspecular_offset(light, view);
    std::size_t high = 0;
    while (high + 1 < rings_.size() && rings_[high].incidence_deg < incidence_deg) ++high;
    const std::size_t low = high > 0 && rings_[high].incidence_deg > incidence_deg ? high - 1 : high;
    const double step_deg = rings_[high].incidence_deg - rings_[low].incidence_deg;
    const double share = step_deg > 0 ? (incidence_deg - rings_[low].incidence_deg) / step_deg : 1;

    MeasuredValue result;
    result.outside_deg = std::max({0.0, rings_.front().incidence_deg - incidence_deg - kSameDirection_deg,
                                   incidence_deg - rings_.back().incidence_deg - kSameDirection_deg});
    std::vector<double> sum(traits().wavelengths_nm.size(), 0.0);
    const bool both = std::min(share, 1 - share) * step_deg > kSameDirection_deg;
    if (both) result.gap_deg = step_deg;
    if (both || share <= 0.5) add(rings_[low], at, both ? 1 - share : 1, sum, result);
    if (both || share > 0.5) add(rings_[high], at, both ? share : 1, sum, result);
    for (double& r : sum) r = unroot(r);
    result.f = std::move(sum);
    return result;
  }

  std::vector<paint::DirectionPair> samples() const override {
    std::vector<paint::DirectionPair> result;
    for (const ScatteredRow& row : rows_) result.push_back(row.pair);
    return result;
  }

  // The measured rows themselves, away from specular and grazing. Of very many, which each cost a search among all,
  // some are taken throughout the file.
  std::vector<paint::DirectionPair> probes() const override {
    constexpr std::size_t kMostProbes = 1000;
    const std::size_t every = (rows_.size() + kMostProbes - 1) / kMostProbes;
    std::vector<paint::DirectionPair> result;
    for (std::size_t i = 0; i < rows_.size(); i += every) {
      const ScatteredRow& row = rows_[i];
      const Offset offset = aspecular_offset(row.pair.light, row.pair.view);
      const double steepest = std::max(polar_angle(row.pair.light), polar_angle(row.pair.view));
      if (math::hypot(offset.toward, offset.across) > 15 && steepest < 75 * kDegree) result.push_back(row.pair);
    }
    return result;
  }

 private:
  void add(const Ring& ring, const Offset& at, double weight, std::vector<double>& sum, MeasuredValue& result) const {
    auto shares = delaunay_shares(ring.offsets, at);
    if (shares.empty()) {
      const auto nearest =
          std::ranges::min_element(ring.offsets, {}, [&](const auto& offset) { return distance(offset, at); });
      result.outside_deg = std::max(result.outside_deg, distance(*nearest, at));
      shares.push_back({static_cast<std::size_t>(nearest - ring.offsets.begin()), 1.0});
    }
    const bool hit = std::ranges::any_of(
        shares, [&](const Share& share) { return distance(ring.offsets[share.index], at) < kSameDirection_deg; });
    for (const Share& a : shares) {
      for (const Share& b : shares)
        if (!hit) result.gap_deg = std::max(result.gap_deg, distance(ring.offsets[a.index], ring.offsets[b.index]));
      const std::vector<double>& f = rows_[ring.rows[a.index]].f;
      for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += weight * a.weight * root(f[k]);
    }
  }

  std::vector<ScatteredRow> rows_;
  std::vector<Ring> rings_;
};

}  // namespace

MeasuredPointer scattered_brdf(MeasuredTraits traits, std::vector<ScatteredRow> rows) {
  return std::make_unique<ScatteredBrdf>(std::move(traits), std::move(rows));
}

Vec3 direction(double polar_rad, double azimuth_rad) {
  return {math::sin(polar_rad) * math::cos(azimuth_rad), math::sin(polar_rad) * math::sin(azimuth_rad),
          math::cos(polar_rad)};
}

}  // namespace goniochrome::brdf
