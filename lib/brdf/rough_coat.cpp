// Light of the direction wi is sent to wo by the facets whose normal is the half vector h, so that
//
//   f cos_i cos_o = F(wi.h) D(h) G(wi,wo) / 4,   D = a^2 / (pi cos^4 t (a^2 + tan^2 t)^2),   t the angle of h
//
// with the masking G = 1/(1 + L(wi) + L(wo)), L = (sqrt(1 + a^2 tan^2) - 1)/2, of heights that belong together
// [Heitz2014], or the D and L of Gaussian slopes (internal/facets.h). Both scales of a coat are such terms of slopes a
// of their own; all that a coat reads or sends is therefore a sum of two values of one table over log a, weighted by
// the shares of the two scales. A reading takes them at the angle of the meter, and each ring at its own mean of
// (wi.h)^2.
#include "brdf/rough_coat.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/angles.h"
#include "base/parallel.h"
#include "brdf/gloss.h"
#include "brdf/internal/facets.h"
#include "brdf/internal/gloss_meter.h"
#include "math/cosine_power.h"
#include "math/elementary.h"
#include "math/quadrature.h"

namespace goniochrome::brdf {

namespace {

constexpr int kSlopes = 29;
constexpr std::size_t kViewCount = std::size(kCoatViews_deg);
constexpr int kCoatRings = 26;  // to 90 deg; one more lies beyond
constexpr double kFirstRing_deg = 0.03;
constexpr double kAll = std::numeric_limits<double>::infinity();
constexpr double kGaussianReach = 4;  // widths, where exp(-16) is left

using Rings = std::array<double, kCoatRings + 1>;

// f cos_i cos_o of one scale; 0 where a direction is below the horizon.
double sent(const Vec3& in, const Vec3& out, const Facets& facets) {
  if (in.z <= 0 || out.z <= 0) return 0;
  const Vec3 half = normalized(in + out);
  const double g = 1 / (1 + facets.masking(std::min(in.z, 1.0)) + facets.masking(std::min(out.z, 1.0)));
  return fresnel_dielectric(std::min(1.0, dot(in, half)), kCoatIndex) * facets.density(half) * g / 4;
}

// Positions and weights of -half..half, dense around `center` on the scale of `width`: x = center + width sinh(t), and
// within so many `widths` of it.
std::vector<math::QuadraturePoint> dense_points(double center, double half, double width, double widths) {
  static const std::vector<math::QuadraturePoint> rule = math::gauss_legendre(8);
  const double cuts[] = {std::asinh(std::max((-half - center) / width, -widths)), 0,
                         std::asinh(std::min((half - center) / width, widths))};
  std::vector<math::QuadraturePoint> points;
  for (int side = 0; side < 2; ++side) {
    const double middle = (cuts[side] + cuts[side + 1]) / 2, reach = (cuts[side + 1] - cuts[side]) / 2;
    for (const auto& [x, w] : rule) {
      const double t = middle + reach * x;
      points.push_back({center + width * math::sinh(t), reach * w * width * math::cosh(t)});
    }
  }
  return points;
}

// The windows at a view: those of the nearest meter.
Meter meter_at(std::size_t view) {
  Meter meter = kMeters[view < 3 ? 0 : view < 8 ? 1 : 2];
  meter.angle_deg = kCoatViews_deg[view];
  return meter;
}

// The reading of a meter in GU for f cos_i cos_o = f(wi, wo), which is about so wide around its peak in the plane of
// incidence and across it, in tangents, and 0 beyond `reach` times that.
template <class Function>
double window_reading(const Meter& meter, double width_par, double width_perp, double reach, const Function& f) {
  static const std::vector<math::QuadraturePoint> rule = math::gauss_legendre(3);
  const double t = meter.angle_deg * kDegree, sine = math::sin(t), cosine = math::cos(t);
  const auto direction = [&](double p, double q) { return Vec3{sine + p * cosine, q, cosine - p * sine}; };
  const auto half = [](double width_deg) { return math::tan(width_deg / 2 * kDegree); };
  double read = 0, standard = 0;
  for (const auto& [x, wx] : rule)
    for (const auto& [y, wy] : rule) {  // one half of the source; the other is its mirror image
      const double p = x * half(kSourcePar_deg), q = (y + 1) / 2 * half(kSourcePerp_deg);
      const Vec3 image = direction(p, q);
      const double size = length(image), weight = wx * wy / (size * size * size);
      const Vec3 in = {-image.x / size, -image.y / size, image.z / size};
      standard += weight * in.z * fresnel_dielectric(in.z, kBlackGlassIndex);
      const auto across = dense_points(q, half(meter.receptor_perp_deg), width_perp, reach);
      for (const auto& [p_out, wp] : dense_points(p, half(meter.receptor_par_deg), width_par, reach))
        for (const auto& [q_out, wq] : across) {
          const Vec3 to = direction(p_out, q_out);
          const double far = length(to);
          read += weight * wp * wq / (far * far * far) * f(in, (1 / far) * to);
        }
    }
  return 100 * read / standard;
}

// The reading of one scale that gets all the light.
double facets_reading(const Meter& meter, const Facets& facets) {
  const double width = 2 * facets.slope, reach = facets.slopes == Slopes::kGaussian ? kGaussianReach : kAll;
  return window_reading(meter, width, width * math::cos(meter.angle_deg * kDegree), reach,
                        [&](const Vec3& in, const Vec3& out) { return sent(in, out, facets); });
}

const std::array<double, kCoatRings + 1>& ring_angles() {
  static const auto made = [] {
    std::array<double, kCoatRings + 1> angles{};
    for (int k = 0; k < kCoatRings; ++k)
      angles[k] = kFirstRing_deg * math::pow(90 / kFirstRing_deg, k / (kCoatRings - 1.0)) * kDegree;
    angles[kCoatRings] = kPi;
    return angles;
  }();
  return made;
}

// The integral of g(angle from the mirror direction, wi) dw over wi, within each ring and all before it, for a viewer
// at that angle. The rings are wider in the plane of incidence than across it by about 1/cos, and so are the steps.
template <class Function>
Rings within_rings(double view_deg, int around, const Function& g) {
  static const std::vector<math::QuadraturePoint> rule = math::gauss_legendre(3);
  const double sine = math::sin(view_deg * kDegree), cosine = math::cos(view_deg * kDegree);
  const Vec3 axis = {-sine, 0, cosine}, toward = {cosine, 0, sine};
  Rings within{};
  double sum = 0, low = 0;
  for (int k = 0; k <= kCoatRings; ++k) {
    const double high = ring_angles()[k];
    for (const auto& [x, w] : rule) {
      const double angle = (low + high) / 2 + (high - low) / 2 * x;
      const double squeeze = std::min(1.0, cosine + angle);
      double ring = 0;
      for (int i = 0; i < around; ++i) {
        const double step = kPi * (i + 0.5) / around, c = math::cos(step), s = squeeze * math::sin(step);
        const double norm = math::hypot(c, s), along = math::sin(angle) * c / norm,
                     beside = math::sin(angle) * s / norm;
        const Vec3 in = math::cos(angle) * axis + along * toward + Vec3{0, beside, 0};
        ring += squeeze / (norm * norm) * g(angle, in);
      }
      sum += w * (high - low) / 2 * math::sin(angle) * 2 * kPi / around * ring;
    }
    within[k] = sum, low = high;
  }
  return within;
}

Vec3 viewer(std::size_t view) {
  const double t = kCoatViews_deg[view] * kDegree;
  return {math::sin(t), 0, math::cos(t)};
}

// Contributions of each ring, without and with (wi.h)^2.
struct FacetRings {
  Rings light, times_cos2;
};

FacetRings facet_rings(const Facets& facets, std::size_t view) {
  const Vec3 out = viewer(view);
  const double smooth = fresnel_dielectric(out.z, kCoatIndex) * out.z;
  const auto each = [&](bool squared) {
    Rings rings = within_rings(kCoatViews_deg[view], 32, [&](double, const Vec3& in) {
      return sent(in, out, facets) / smooth * (squared ? (1 + dot(in, out)) / 2 : 1);
    });
    std::adjacent_difference(rings.begin(), rings.end(), rings.begin());
    return rings;
  };
  return {each(false), each(true)};
}

// The slope at a node of the table of one scale, by log slope.
double node_slope(std::size_t node) {
  return kLeastSlope * math::pow(kMostSlope / kLeastSlope, static_cast<double>(node) / (kSlopes - 1));
}

// Cubic through four nodes around a slope.
struct Place {
  int first;
  std::array<double, 4> weight;
};
Place place(double slope) {
  const double at = math::log(std::clamp(slope, kLeastSlope, kMostSlope) / kLeastSlope) /
                    math::log(kMostSlope / kLeastSlope) * (kSlopes - 1);
  const int first = std::clamp(static_cast<int>(at) - 1, 0, kSlopes - 4);
  const double t = at - first;
  return {first,
          {-(t - 1) * (t - 2) * (t - 3) / 6, t * (t - 2) * (t - 3) / 2, -t * (t - 1) * (t - 3) / 2,
           t * (t - 1) * (t - 2) / 6}};
}

// of_view(facets, view) for all slopes and views.
template <class Value>
using Table = std::array<std::array<Value, kViewCount>, kSlopes>;
template <class Value, class OfView>
Table<Value> tabled(Slopes slopes, const OfView& of_view) {
  Table<Value> table;
  parallel_for(kSlopes, 1, [&](std::size_t node, std::size_t) {
    for (std::size_t v = 0; v < kViewCount; ++v) table[node][v] = of_view(Facets{node_slope(node), slopes}, v);
  });
  return table;
}

const Table<double>& readings(Slopes slopes) {
  const auto made = [](Slopes of) {
    return tabled<double>(of, [](const Facets& facets, std::size_t v) { return facets_reading(meter_at(v), facets); });
  };
  static const Table<double> ggx = made(Slopes::kGgx);
  if (slopes == Slopes::kGgx) return ggx;
  static const Table<double> gaussian = made(Slopes::kGaussian);
  return gaussian;
}

const Table<FacetRings>& rings(Slopes slopes) {
  const auto made = [](Slopes of) { return tabled<FacetRings>(of, facet_rings); };
  static const Table<FacetRings> ggx = made(Slopes::kGgx);
  if (slopes == Slopes::kGgx) return ggx;
  static const Table<FacetRings> gaussian = made(Slopes::kGaussian);
  return gaussian;
}

double reading_of_scale(Slopes slopes, double slope, std::size_t view) {
  const Table<double>& table = readings(slopes);
  const Place at = place(slope);
  double sum = 0;
  for (int n = 0; n < 4; ++n) sum += at.weight[n] * table[at.first + n][view];
  return sum;
}

}  // namespace

double sharp_share(const RoughCoat& coat, double cosine) {
  return math::exp(-coat.k * cosine * cosine);
}

std::optional<std::size_t> view_of_meter(double meter_deg) {
  for (std::size_t v = 0; v < kViewCount; ++v)
    if (kCoatViews_deg[v] == meter_deg && std::ranges::find(kMeters, meter_deg, &Meter::angle_deg) != std::end(kMeters))
      return v;
  return std::nullopt;
}

Result<double> coat_reading(const RoughCoat& coat, double angle_deg, double index) {
  GONIO_ASSIGN(const double smooth, smooth_gloss(angle_deg, index));
  GONIO_ASSIGN(const double usual, smooth_gloss(angle_deg, kCoatIndex));
  return smooth / usual * coat_reading_at(coat, *view_of_meter(angle_deg));
}

std::span<const double> ring_angles_rad() {
  return ring_angles();
}

std::vector<double> coat_within(const RoughCoat& coat, std::size_t view) {
  const Table<FacetRings>& table = rings(coat.slopes);
  std::vector<double> within(kCoatRings + 1, 0.0);
  for (const bool sharp : {true, false}) {
    const Place at = place(sharp ? coat.slope : coat.haze);
    for (std::size_t k = 0; k < within.size(); ++k) {
      double light = 0, times_cos2 = 0;
      for (int n = 0; n < 4; ++n) {
        const FacetRings& scale = table[at.first + n][view];
        light += at.weight[n] * scale.light[k], times_cos2 += at.weight[n] * scale.times_cos2[k];
      }
      if (!(light > 0)) continue;
      const double share = math::exp(-coat.k * std::clamp(times_cos2 / light, 0.0, 1.0));
      within[k] += (sharp ? share : 1 - share) * light;
    }
  }
  std::partial_sum(within.begin(), within.end(), within.begin());
  return within;
}

double coat_reading_at(const RoughCoat& coat, std::size_t view) {
  const double share = sharp_share(coat, viewer(view).z);
  return share * reading_of_scale(coat.slopes, coat.slope, view) +
         (1 - share) * reading_of_scale(coat.slopes, coat.haze, view);
}

double lobe_reading_at(double exponent, std::size_t view) {
  const double width = 1 / std::sqrt(exponent + 1);
  return window_reading(meter_at(view), width, width, kAll, [&](const Vec3& in, const Vec3& out) {
    const Vec3 apart = out - Vec3{-in.x, -in.y, in.z};
    return out.z * math::cos_power_from_versine(dot(apart, apart) / 2, exponent) *
           fresnel_dielectric(std::min(1.0, length(in + out) / 2), kCoatIndex);
  });
}

double mirror_reading_at(std::size_t view) {
  const double cosine = viewer(view).z;
  return 100 * fresnel_dielectric(cosine, kCoatIndex) / fresnel_dielectric(cosine, kBlackGlassIndex);
}

std::vector<double> lobe_within(double exponent, std::size_t view) {
  const Vec3 out = viewer(view);
  const double smooth = fresnel_dielectric(out.z, kCoatIndex);
  const Rings rings = within_rings(kCoatViews_deg[view], 16, [&](double angle, const Vec3& in) {
    if (in.z <= 0) return 0.0;
    const double cos_half = std::min(1.0, length(in + out) / 2);
    return math::cos_power(angle, exponent) * fresnel_dielectric(cos_half, kCoatIndex) / smooth;
  });
  return {rings.begin(), rings.end()};
}

}  // namespace goniochrome::brdf
