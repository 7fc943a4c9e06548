// Light of the direction wi is sent to wo by the facets whose normal is the half vector h, so that
//
//   f cos_i cos_o = F(wi.h) D(h) G(wi,wo) / 4,   D = a^2 / (pi cos^4 t (a^2 + tan^2 t)^2),   t the angle of h
//
// with the masking G = 1/(1 + L(wi) + L(wo)), L = (sqrt(1 + a^2 tan^2) - 1)/2, of heights that belong together
// [Heitz2014]. Both scales of a coat are such terms of slopes a of their own; all that a coat reads or sends is
// therefore a sum of two values of one table over log a, weighted by the shares of the two scales. A reading takes them
// at the angle of the meter, and each ring at its own mean of (wi.h)^2.
#include "brdf/rough_coat.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "base/angles.h"
#include "base/parallel.h"
#include "brdf/gloss.h"
#include "brdf/internal/gloss_meter.h"
#include "math/cosine_power.h"
#include "math/elementary.h"
#include "math/quadrature.h"

namespace goniochrome::brdf {

namespace {

constexpr double kLeastSlope = 5e-4, kMostSlope = 0.8;  // of the tables
constexpr int kSlopes = 29;
constexpr std::size_t kViewCount = std::size(kCoatViews_deg);
constexpr int kRings = 26;  // to 90 deg; one more lies beyond
constexpr double kFirstRing_deg = 0.03;

using Rings = std::array<double, kRings + 1>;

double masking(double cosine, double slope) {
  const double tangent2 = (1 - cosine * cosine) / (cosine * cosine);
  return 0.5 * (std::sqrt(1 + slope * slope * tangent2) - 1);
}

// f cos_i cos_o of one scale; 0 where a direction is below the horizon.
double facets(const Vec3& in, const Vec3& out, double slope) {
  if (in.z <= 0 || out.z <= 0) return 0;
  const Vec3 half = normalized(in + out);
  const double z2 = half.z * half.z, a2 = slope * slope, spread = a2 * z2 + half.x * half.x + half.y * half.y;
  const double d = a2 / (kPi * spread * spread);  // spread = cos^2 (a^2 + tan^2)
  const double g = 1 / (1 + masking(std::min(in.z, 1.0), slope) + masking(std::min(out.z, 1.0), slope));
  return fresnel_dielectric(std::min(1.0, dot(in, half)), kCoatIndex) * d * g / 4;
}

// Positions and weights of -half..half, dense around `center` on the scale of `width`: x = center + width sinh(t).
std::vector<math::QuadraturePoint> dense_points(double center, double half, double width) {
  static const std::vector<math::QuadraturePoint> rule = math::gauss_legendre(8);
  const double cuts[] = {std::asinh((-half - center) / width), 0, std::asinh((half - center) / width)};
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

// The view at which a meter stands.
std::optional<std::size_t> view_of(double meter_deg) {
  for (std::size_t v = 0; v < kViewCount; ++v)
    if (kCoatViews_deg[v] == meter_deg && std::ranges::find(kMeters, meter_deg, &Meter::angle_deg) != std::end(kMeters))
      return v;
  return std::nullopt;
}

// What a meter reads in GU of f cos_i cos_o = f(wi, wo), which is about so wide around its peak in the plane of
// incidence and across it, in tangents.
template <class Function>
double window_reading(const Meter& meter, double width_par, double width_perp, const Function& f) {
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
      const auto across = dense_points(q, half(meter.receptor_perp_deg), width_perp);
      for (const auto& [p_out, wp] : dense_points(p, half(meter.receptor_par_deg), width_par))
        for (const auto& [q_out, wq] : across) {
          const Vec3 to = direction(p_out, q_out);
          const double far = length(to);
          read += weight * wp * wq / (far * far * far) * f(in, (1 / far) * to);
        }
    }
  return 100 * read / standard;
}

// Of one scale that gets all the light.
double facets_reading(const Meter& meter, double slope) {
  return window_reading(meter, 2 * slope, 2 * slope * math::cos(meter.angle_deg * kDegree),
                        [&](const Vec3& in, const Vec3& out) { return facets(in, out, slope); });
}

const std::array<double, kRings + 1>& ring_angles() {
  static const auto made = [] {
    std::array<double, kRings + 1> angles{};
    for (int k = 0; k < kRings; ++k)
      angles[k] = kFirstRing_deg * math::pow(90 / kFirstRing_deg, k / (kRings - 1.0)) * kDegree;
    angles[kRings] = kPi;
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
  for (int k = 0; k <= kRings; ++k) {
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

// What each ring adds, without and with (wi.h)^2.
struct FacetRings {
  Rings light, times_cos2;
};

FacetRings facet_rings(double slope, std::size_t view) {
  const Vec3 out = viewer(view);
  const double smooth = fresnel_dielectric(out.z, kCoatIndex) * out.z;
  const auto each = [&](bool squared) {
    Rings rings = within_rings(kCoatViews_deg[view], 32, [&](double, const Vec3& in) {
      return facets(in, out, slope) / smooth * (squared ? (1 + dot(in, out)) / 2 : 1);
    });
    std::adjacent_difference(rings.begin(), rings.end(), rings.begin());
    return rings;
  };
  return {each(false), each(true)};
}

// Readings and rings of one scale, by log slope.
struct Tables {
  std::array<std::array<double, kViewCount>, kSlopes> readings;
  std::array<std::array<FacetRings, kViewCount>, kSlopes> rings;

  static double slope(int node) {
    return kLeastSlope * math::pow(kMostSlope / kLeastSlope, static_cast<double>(node) / (kSlopes - 1));
  }
  Tables() {
    parallel_for(kSlopes, 1, [&](std::size_t node, std::size_t) {
      const double a = slope(static_cast<int>(node));
      for (std::size_t v = 0; v < kViewCount; ++v) {
        readings[node][v] = facets_reading(meter_at(v), a);
        rings[node][v] = facet_rings(a, v);
      }
    });
  }

  // Cubic through four nodes around a slope.
  struct Place {
    int first;
    std::array<double, 4> weight;
  };
  static Place place(double a) {
    const double at = math::log(std::clamp(a, kLeastSlope, kMostSlope) / kLeastSlope) /
                      math::log(kMostSlope / kLeastSlope) * (kSlopes - 1);
    const int first = std::clamp(static_cast<int>(at) - 1, 0, kSlopes - 4);
    const double t = at - first;
    return {first,
            {-(t - 1) * (t - 2) * (t - 3) / 6, t * (t - 2) * (t - 3) / 2, -t * (t - 1) * (t - 3) / 2,
             t * (t - 1) * (t - 2) / 6}};
  }
  double reading(std::size_t view, double a) const {
    const Place at = place(a);
    double sum = 0;
    for (int n = 0; n < 4; ++n) sum += at.weight[n] * readings[at.first + n][view];
    return sum;
  }
};

const Tables& tables() {
  static const Tables made;
  return made;
}

double reading_at(const RoughCoat& coat, std::size_t view) {
  const double share = sharp_share(coat, viewer(view).z);
  return share * tables().reading(view, coat.slope) + (1 - share) * tables().reading(view, coat.haze);
}

// The coats of one reading lie on this series. Its satin (60 GU) reads 16 and 84 GU at 20 and 85 deg.
// [MPI gloss levels] pair 60 with 85 deg: below 5 with below 10, 10 to 25 with 10 to 35, 20 to 35 with 35 and more.
constexpr double kSeriesSlope = 0.009, kSeriesPower = 1.5, kSeriesMost = 13;

RoughCoat of_series(double k) {
  const double slope = kSeriesSlope * math::pow(k, kSeriesPower);
  return {k, slope, std::max(RoughCoat::kHaze, slope)};
}

// The coat of the series that reads so much; readings fall with k.
RoughCoat series_coat(std::size_t view, double gu) {
  double low = 0, high = kSeriesMost;
  while (high - low > 1e-13 * high) {
    const double middle = 0.5 * (low + high);
    (reading_at(of_series(middle), view) > gu ? low : high) = middle;
  }
  return of_series(0.5 * (low + high));
}

// A coat near given readings: least squares in log slope, k and log haze, by Gauss-Newton steps that are damped
// [Marquardt]. How far a coat lies from the series counts a little, so that readings that leave something open take
// what is usual.
class CoatSearch {
 public:
  struct Wanted {
    std::size_t view;
    double gu;
  };
  explicit CoatSearch(std::vector<Wanted> wanted) : wanted_(std::move(wanted)) {}

  struct Found {
    RoughCoat coat;
    double cost;
  };
  Found from(const RoughCoat& start) const {
    Point x = {math::log(start.slope), start.k, math::log(start.haze)};
    std::vector<double> r = residuals(x);
    double cost = squares(r), damping = 1e-3;
    for (int round = 0; round < 60 && damping < 1e9; ++round) {
      const Point next = clamped(step(x, r, damping));
      const std::vector<double> tried = residuals(next);
      const double now = squares(tried);
      if (!(now < cost)) {
        damping *= 8;
        continue;
      }
      const bool done = cost - now < 1e-12 * cost;
      x = next, r = tried, cost = now, damping /= 4;
      if (done) break;
    }
    return {coat(x), cost};
  }

 private:
  using Point = std::array<double, 3>;
  static constexpr double kReading_gu = 0.2, kApart[] = {2, 0.7};  // standard deviations: a reading, k, log haze

  static RoughCoat coat(const Point& x) { return {x[1], math::exp(x[0]), math::exp(x[2])}; }
  static Point clamped(const Point& x) {
    return {std::clamp(x[0], math::log(kLeastSlope), math::log(kMostSlope)), std::clamp(x[1], 0.0, kSeriesMost),
            std::clamp(x[2], math::log(0.03), math::log(kMostSlope))};
  }
  static double squares(const std::vector<double>& r) {
    double sum = 0;
    for (const double x : r) sum += x * x;
    return sum;
  }
  std::vector<double> residuals(const Point& x) const {
    const RoughCoat here = coat(x);
    std::vector<double> r;
    for (const Wanted& wanted : wanted_) r.push_back((reading_at(here, wanted.view) - wanted.gu) / kReading_gu);
    r.push_back((here.k - math::pow(here.slope / kSeriesSlope, 1 / kSeriesPower)) / kApart[0]);
    r.push_back((x[2] - math::log(RoughCoat::kHaze)) / kApart[1]);
    return r;
  }
  // The solution of (J'J + d diag) s = -J'r, by elimination: three unknowns.
  Point step(const Point& x, const std::vector<double>& r, double damping) const {
    constexpr double kDifference = 1e-5;
    std::array<std::vector<double>, 3> j;
    for (std::size_t c = 0; c < 3; ++c) {
      Point moved = x;
      moved[c] += kDifference;
      j[c] = residuals(moved);
      for (std::size_t i = 0; i < r.size(); ++i) j[c][i] = (j[c][i] - r[i]) / kDifference;
    }
    double a[3][4] = {};
    for (std::size_t c = 0; c < 3; ++c)
      for (std::size_t i = 0; i < r.size(); ++i) {
        for (std::size_t d = 0; d < 3; ++d) a[c][d] += j[c][i] * j[d][i];
        a[c][3] -= j[c][i] * r[i];
      }
    for (std::size_t c = 0; c < 3; ++c) a[c][c] *= 1 + damping;
    for (std::size_t c = 0; c < 3; ++c)
      for (std::size_t row = 0; row < 3; ++row)
        if (row != c && a[c][c] > 0) {
          const double part = a[row][c] / a[c][c];
          for (std::size_t d = c; d < 4; ++d) a[row][d] -= part * a[c][d];
        }
    Point next = x;
    for (std::size_t c = 0; c < 3; ++c) next[c] += a[c][c] > 0 ? a[c][3] / a[c][c] : 0;
    return next;
  }

  std::vector<Wanted> wanted_;
};

}  // namespace

double sharp_share(const RoughCoat& coat, double cosine) {
  return math::exp(-coat.k * cosine * cosine);
}

Result<double> coat_reading(const RoughCoat& coat, double angle_deg, double index) {
  GONIO_ASSIGN(const double smooth, smooth_gloss(angle_deg, index));
  GONIO_ASSIGN(const double usual, smooth_gloss(angle_deg, kCoatIndex));
  return smooth / usual * reading_at(coat, *view_of(angle_deg));
}

Result<std::optional<RoughCoat>> rough_coat_of(const std::vector<paint::GlossReading>& readings, double index) {
  constexpr double kSmooth_gu = 1;
  std::vector<CoatSearch::Wanted> wanted;
  bool smooth = true;
  for (const paint::GlossReading& reading : readings) {
    GONIO_ASSIGN(const double of_index, smooth_gloss(reading.angle_deg, index));
    GONIO_ASSIGN(const double usual, smooth_gloss(reading.angle_deg, kCoatIndex));
    smooth = smooth && reading.gloss_units > of_index - kSmooth_gu;
    wanted.push_back({*view_of(reading.angle_deg), std::max(0.0, reading.gloss_units) * usual / of_index});
  }
  if (wanted.empty()) return std::optional<RoughCoat>();
  const auto matt = [](const CoatSearch::Wanted& w) { return w.gu <= reading_at(of_series(kSeriesMost), w.view); };
  if (smooth || std::ranges::all_of(wanted, matt)) return std::optional<RoughCoat>();
  if (wanted.size() == 1) return std::optional(series_coat(wanted[0].view, wanted[0].gu));
  const CoatSearch search(wanted);
  std::optional<CoatSearch::Found> best;
  for (const CoatSearch::Wanted& w : wanted) {
    const RoughCoat usual = series_coat(w.view, w.gu);
    for (const RoughCoat& start :
         {usual, RoughCoat{0, std::max(usual.slope, 2 * kLeastSlope)}, RoughCoat{usual.k, 2 * kLeastSlope}}) {
      const CoatSearch::Found found = search.from(start);
      if (!best || found.cost < best->cost) best = found;
    }
  }
  return std::optional(best->coat);
}

std::span<const double> ring_angles_rad() {
  return ring_angles();
}

std::vector<double> coat_within(const RoughCoat& coat, std::size_t view) {
  std::vector<double> within(kRings + 1, 0.0);
  for (const bool sharp : {true, false}) {
    const Tables::Place at = Tables::place(sharp ? coat.slope : coat.haze);
    for (std::size_t k = 0; k < within.size(); ++k) {
      double light = 0, times_cos2 = 0;
      for (int n = 0; n < 4; ++n) {
        const FacetRings& rings = tables().rings[at.first + n][view];
        light += at.weight[n] * rings.light[k], times_cos2 += at.weight[n] * rings.times_cos2[k];
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
  return reading_at(coat, view);
}

double lobe_reading_at(double exponent, std::size_t view) {
  const double width = 1 / std::sqrt(exponent + 1);
  return window_reading(meter_at(view), width, width, [&](const Vec3& in, const Vec3& out) {
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
