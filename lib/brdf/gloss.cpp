// The simulated gloss meter.
//
// Source image and receptor window are rectangles seen from the sample, w_par wide in the plane of incidence and w_perp
// across it [ASTM D523]. In the tangent plane of the mirror direction s (u in the plane of incidence, v
// across) a direction is (s + p u + q v)/|...| with dw = dp dq / (1 + p^2 + q^2)^(3/2). The reflected source lies in
// the same plane, so the aspecular angle of a pair is that of two nearby points and
//
//   G = 100 * (integral f cos_i cos_o dw_i dw_o) / (integral F_1.567 cos_i dw_i)
//
// A lobe of exponent E is about a Gaussian of standard deviation 1/sqrt(E) in that plane, so the receptor is cut into
// panels around each source point, at 0, 2.5 and 6.5 deviations (beyond lies 1e-9 of the peak), with five points each;
// what is left is a smooth function of the source point, and 3 x 3 points on half the source are enough: the source is
// narrower than the receptor by more than it would take to see an edge.
#include "brdf/gloss.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>

#include "base/angles.h"
#include "brdf/internal/gloss_meter.h"
#include "brdf/rough_coat.h"
#include "math/cosine_power.h"
#include "math/elementary.h"
#include "math/least_squares.h"
#include "math/quadrature.h"

namespace goniochrome::brdf {

namespace {

struct Aperture {
  double half_par, half_perp;  // in the tangent plane
};
Aperture aperture(double par_deg, double perp_deg) {
  return {math::tan(par_deg / 2 * kDegree), math::tan(perp_deg / 2 * kDegree)};
}

struct Sample {
  double p, q, weight;  // weight holds the solid angle
  double cos_normal;
};

Sample sample(double p, double q, double weight, double angle_deg) {
  const double length = std::sqrt(1 + p * p + q * q);
  const double cos_normal = (math::cos(angle_deg * kDegree) - p * math::sin(angle_deg * kDegree)) / length;
  return {p, q, weight / (length * length * length), cos_normal};
}

// 1 - cos of the angle between two points of the tangent plane: |a - b|^2/2 of the unit vectors, whose difference along
// s is taken from p and q so that near points keep their digits.
double versine(const Sample& a, const Sample& b) {
  const double la = std::sqrt(1 + a.p * a.p + a.q * a.q), lb = std::sqrt(1 + b.p * b.p + b.q * b.q);
  const double ds = (b.p * b.p - a.p * a.p + b.q * b.q - a.q * a.q) / (la * lb * (la + lb));
  const double dp = a.p / la - b.p / lb, dq = a.q / la - b.q / lb;
  return 0.5 * (ds * ds + dp * dp + dq * dq);
}

// The quadrature points of one axis: panels around `center` clipped to [-half, half].
std::vector<math::QuadraturePoint> panels(double center, double half, double exponent) {
  static const std::vector<math::QuadraturePoint> rule = math::gauss_legendre(5);
  constexpr std::array<double, 5> kCuts = {-6.5, -2.5, 0, 2.5, 6.5};
  const double deviation = 1 / std::sqrt(exponent + 1);
  std::vector<math::QuadraturePoint> points;
  for (std::size_t k = 0; k + 1 < kCuts.size(); ++k) {
    const double low = std::max(-half, center + kCuts[k] * deviation);
    const double high = std::min(half, center + kCuts[k + 1] * deviation);
    if (low >= high) continue;
    for (const auto& [x, w] : rule) points.push_back({(low + high) / 2 + (high - low) / 2 * x, (high - low) / 2 * w});
  }
  return points;
}

std::vector<Sample> source_samples(double angle_deg) {
  const std::vector<math::QuadraturePoint> rule = math::gauss_legendre(3);
  const Aperture source = aperture(kSourcePar_deg, kSourcePerp_deg);
  std::vector<Sample> samples;
  for (const auto& [x, wx] : rule)
    for (const auto& [y, wy] : rule)  // q > 0 only; the other half is its mirror image
      samples.push_back(sample(x * source.half_par, (y + 1) / 2 * source.half_perp,
                               wx * wy * source.half_par * source.half_perp, angle_deg));
  return samples;
}

struct LobeReading {
  double directional_diffuse, gloss;
};

// The numerator integrals of one lobe with weight 1: K_DD cos_i cos_o cos^E and K_G cos_o cos^E.
LobeReading lobe_integrals(const Meter& meter, const std::vector<Sample>& source, double exponent) {
  const Aperture receptor = aperture(meter.receptor_par_deg, meter.receptor_perp_deg);
  LobeReading sum = {0, 0};
  for (const Sample& in : source) {
    double received = 0;
    const auto across = panels(in.q, receptor.half_perp, exponent);
    for (const auto& [p, wp] : panels(in.p, receptor.half_par, exponent)) {
      for (const auto& [q, wq] : across) {
        const Sample out = sample(p, q, wp * wq, meter.angle_deg);
        received += out.weight * out.cos_normal * math::cos_power_from_versine(versine(in, out), exponent);
      }
    }
    sum.directional_diffuse += in.weight * in.cos_normal * received;
    sum.gloss += in.weight * received;
  }
  return sum;
}

Error no_meter(double angle_deg) {
  return input_error("gloss angle {} deg: gloss meters have 20, 60 or 85", angle_deg);
}

bool is_meter(double angle_deg) {
  return std::ranges::find(kGlossAngles_deg, angle_deg) != std::end(kGlossAngles_deg);
}

// The reading of a smooth surface of that index.
double smooth_reading(double angle_deg, double index) {
  double standard = 0, smooth = 0;
  for (const Sample& in : source_samples(angle_deg)) {
    standard += in.weight * in.cos_normal * fresnel_dielectric(in.cos_normal, kBlackGlassIndex);
    smooth += in.weight * in.cos_normal * fresnel_dielectric(in.cos_normal, index);
  }
  return 100 * smooth / standard;
}

// The least index of a coat, up to that of black glass, that is high enough.
template <class Enough>
double least_index(const Enough& enough) {
  double low = kCoatIndex, high = kBlackGlassIndex;
  if (enough(low)) return low;
  while (high - low > 1e-12) {
    const double middle = 0.5 * (low + high);
    (enough(middle) ? high : low) = middle;
  }
  return high;
}

double mirror_reading(const GlossColumns& meter, double coat_index) {
  const double index = mirror_index(coat_index);
  return index == kCoatIndex ? meter.mirror : smooth_reading(meter.angle_deg, index);
}

// K_G and mirror for one reading of `gu`, already free of flake light; weights ordered as the basis, the mirror last,
// which reads `mirror` alone.
std::vector<double> one_reading(const GlossTable& table, const GlossColumns& meter, double mirror, double gu,
                                bool has_mirror) {
  const std::size_t lobes = table.exponents().size();
  std::vector<double> weights(lobes + 1, 0.0);
  if (gu <= 0) return weights;
  // Each column with the energy of the smooth coat, in the order of rising readings.
  const double energy = fresnel_dielectric(math::cos(meter.angle_deg * kDegree), kCoatIndex);
  const auto full_weight = [&](std::size_t j) {
    return j == lobes ? 1.0 : energy * (table.exponents()[j] + 1) / (2 * kPi);
  };
  const auto full_reading = [&](std::size_t j) { return full_weight(j) * (j == lobes ? mirror : meter.gloss[j]); };
  const std::size_t end = lobes + (has_mirror ? 1 : 0);
  if (end == 0) return weights;
  std::size_t sharper = 0;
  while (sharper < end && full_reading(sharper) < gu) ++sharper;
  if (sharper == 0 || sharper == end) {
    const std::size_t only = sharper == 0 ? 0 : end - 1;
    const double share = gu / full_reading(only);
    weights[only] = full_weight(only) * (only == lobes ? share : std::min(share, 1.0));
    return weights;
  }
  const double wide = full_reading(sharper - 1), sharp = full_reading(sharper);
  const double share = (gu - wide) / (sharp - wide);
  weights[sharper] = share * full_weight(sharper);
  weights[sharper - 1] = (1 - share) * full_weight(sharper - 1);
  return weights;
}

// The readings less what the base reflects into the meter.
Result<std::vector<paint::GlossReading>> without_base(const GlossTable& table,
                                                      const std::vector<paint::GlossReading>& readings,
                                                      paint::LobeFit fit) {
  fit.views.clear();
  for (paint::Lobe& lobe : fit.lobes) lobe.gloss = {};
  std::vector<paint::GlossReading> rest = readings;
  for (paint::GlossReading& reading : rest) {
    GONIO_ASSIGN(const GlossColumns* meter, table.at(reading.angle_deg));
    if (!(reading.gloss_units >= 0)) return input_error("gloss {} GU: a reading is 0 or more", reading.gloss_units);
    reading.gloss_units = std::min(reading.gloss_units, 100.0) - gloss_units(table, *meter, fit);
  }
  return rest;
}

void put_gloss(const std::vector<double>& weights, std::vector<paint::Lobe>& lobes) {
  for (std::size_t j = 0; j < lobes.size(); ++j) lobes[j].gloss = {weights[j], weights[j], weights[j]};
}

std::size_t view_of(double angle_deg) {
  return static_cast<std::size_t>(std::ranges::find(kCoatViews_deg, angle_deg) - std::begin(kCoatViews_deg));
}

// Moves a small share of the light from all lobes to the widest lobe or to the sharpest one, so that the simulated
// reading is exactly `gu`, where that is possible. Weights hold at the incidence `gloss_deg`.
void meet_reading(const GlossTable& table, const GlossColumns& meter, double gu, double gloss_deg, bool has_mirror,
                  double coat_index, std::vector<double>& weights) {
  const std::size_t lobes = table.exponents().size();
  if (weights.empty() || (lobes == 0 && !has_mirror)) return;
  const double fresnel = coat_fresnel(math::cos(meter.angle_deg * kDegree), gloss_deg),
               at_meter = fresnel_dielectric(math::cos(meter.angle_deg * kDegree), kCoatIndex);
  const double mirror = mirror_reading(meter, coat_index);
  const auto energy = [&](std::size_t j) {
    return j == lobes ? at_meter : fresnel * 2 * kPi / (table.exponents()[j] + 1);
  };
  const auto reading = [&](std::size_t j) { return j == lobes ? mirror : fresnel * meter.gloss[j]; };
  double read = 0, all = 0;
  for (std::size_t j = 0; j <= lobes; ++j)
    if (weights[j] > 0) read += weights[j] * reading(j), all += weights[j] * energy(j);
  const std::size_t to = read > gu ? 0 : has_mirror ? lobes : lobes - 1;
  const double there = all / energy(to) * reading(to), share = (gu - read) / (there - read);
  if (!(share > 0 && share <= 1)) return;
  for (double& weight : weights) weight *= 1 - share;
  weights[to] += share * all / energy(to);
}

// K_G and mirror for one view of a rough coat. Rows are the shares within rings, relative to the reflectance of a
// smooth surface of index 1.5, of which the last is all the light, and the reading of the nearest meter. These two
// count so much that the other rings bend to them. Unknowns are energies, so that the columns are of one size.
std::vector<double> coat_weights(const GlossTable& table, const RoughCoat& coat, std::size_t view, double gloss_deg,
                                 bool has_mirror, double coat_index) {
  constexpr double kAllWeight = 30, kReadingWeight = 3;  // of 1 GU
  const double cosine = math::cos(kCoatViews_deg[view] * kDegree), smooth = fresnel_dielectric(cosine, kCoatIndex),
               brighter = fresnel_dielectric(cosine, mirror_index(coat_index)) / smooth;
  const auto& lobes = table.within(view);
  std::vector<double> wanted = coat_within(coat, view);
  wanted.push_back(coat_reading_at(coat, view));
  const int rows = static_cast<int>(wanted.size()), count = static_cast<int>(lobes.size());
  math::Matrix m(rows, count + (has_mirror ? 1 : 0));
  for (int k = 0; k < rows; ++k) {
    const double weight = k == rows - 1 ? kReadingWeight : k == rows - 2 ? kAllWeight : 1;
    for (int j = 0; j < count; ++j) m(k, j) = weight * (table.exponents()[j] + 1) / (2 * kPi) * lobes[j][k];
    if (has_mirror) m(k, count) = weight * brighter * (k == rows - 1 ? mirror_reading_at(view) : 1);
    wanted[k] *= weight * brighter;
  }
  const std::vector<double> best = math::nnls(m, wanted).x;
  double energy = 0;
  for (int j = 0; j < m.columns; ++j) energy += m(rows - 2, j) / kAllWeight * best[j];
  const double bound = std::min(1.0, brighter / std::max(energy, 1e-300));
  std::vector<double> weights(lobes.size() + 1, 0.0);
  const double fresnel = fresnel_dielectric(math::cos(gloss_deg * kDegree), kCoatIndex);
  for (int j = 0; j < m.columns; ++j)
    weights[j] = bound * best[j] * (j < count ? fresnel * (table.exponents()[j] + 1) / (2 * kPi) : 1);
  if (const Result<const GlossColumns*> meter = table.at(kCoatViews_deg[view]); meter.ok())
    meet_reading(table, **meter, *coat_reading(coat, kCoatViews_deg[view], mirror_index(coat_index)), gloss_deg,
                 has_mirror, coat_index, weights);
  return weights;
}

}  // namespace

struct GlossTable::CoatColumns {
  std::once_flag once;
  std::vector<std::vector<std::vector<double>>> within;  // by view, by exponent
};

const std::vector<std::vector<double>>& GlossTable::within(std::size_t view) const {
  std::call_once(coat_->once, [&] {
    for (std::size_t v = 0; v < std::size(kCoatViews_deg); ++v) {
      std::vector<std::vector<double>>& lobes = coat_->within.emplace_back();
      for (const double exponent : exponents_) {
        lobes.push_back(lobe_within(exponent, v));
        lobes.back().push_back(lobe_reading_at(exponent, v));
      }
    }
  });
  return coat_->within[view];
}

GlossTable::GlossTable(const std::vector<double>& exponents)
    : exponents_(exponents), coat_(std::make_shared<CoatColumns>()) {
  for (const Meter& meter : kMeters) {
    const std::vector<Sample> source = source_samples(meter.angle_deg);
    double standard = 0;
    for (const Sample& in : source)
      standard += in.weight * in.cos_normal * fresnel_dielectric(in.cos_normal, kBlackGlassIndex);
    GlossColumns columns;
    columns.angle_deg = meter.angle_deg;
    columns.mirror = smooth_reading(meter.angle_deg, kCoatIndex);
    columns.diffuse = 100 * lobe_integrals(meter, source, 0).directional_diffuse / standard;
    for (const double exponent : exponents) {
      const LobeReading lobe = lobe_integrals(meter, source, exponent);
      columns.directional_diffuse.push_back(100 * lobe.directional_diffuse / standard);
      columns.gloss.push_back(100 * lobe.gloss / standard);
    }
    columns_.push_back(std::move(columns));
  }
}

Result<const GlossColumns*> GlossTable::at(double angle_deg) const {
  for (const GlossColumns& columns : columns_)
    if (columns.angle_deg == angle_deg) return &columns;
  return no_meter(angle_deg);
}

Result<double> smooth_gloss(double angle_deg, double coat_index) {
  if (!is_meter(angle_deg)) return no_meter(angle_deg);
  return smooth_reading(angle_deg, mirror_index(coat_index));
}

double coat_index_of_mirror(double brighter, double cosine) {
  const double wanted = brighter * fresnel_dielectric(cosine, kCoatIndex);
  return least_index([&](double tried) { return fresnel_dielectric(cosine, tried) >= wanted; });
}

Result<double> coat_index_of(const std::vector<paint::GlossReading>& readings) {
  double index = paint::kNoCoat;
  for (const paint::GlossReading& reading : readings) {
    if (!(reading.gloss_units > 0)) continue;
    const double gu = std::min(reading.gloss_units, 100.0);
    if (!is_meter(reading.angle_deg)) return no_meter(reading.angle_deg);
    index = std::max(index, least_index([&](double tried) { return smooth_reading(reading.angle_deg, tried) >= gu; }));
  }
  return index;
}

Result<double> coat_index_of_paint(const paint::Paint& paint, const std::vector<paint::GlossReading>& assumed) {
  if (paint.coat_index == paint::kNoCoat) return paint::kNoCoat;
  GONIO_ASSIGN(const double asked, coat_index_of(paint.gloss.empty() ? assumed : paint.gloss));
  return std::max(asked, paint.coat_index.value_or(paint::kNoCoat));
}

double gloss_units(const GlossTable& table, const GlossColumns& meter, const paint::LobeFit& fit, double gloss_deg) {
  const double cosine = math::cos(meter.angle_deg * kDegree), base = coat_passages(fit.coat_index, cosine, cosine);
  const double fresnel = gloss_deg == meter.angle_deg ? 1 : coat_fresnel(cosine, gloss_deg);
  const paint::LobeFit seen = at_view(fit, meter.angle_deg);
  double gu = base * meter.diffuse * color::luminance(seen.diffuse);
  for (const paint::Lobe& lobe : seen.lobes) {
    if (lobe.is_mirror()) {
      if (lobe.gloss != color::Rgb{}) gu += mirror_reading(meter, fit.coat_index) * color::luminance(lobe.gloss);
      continue;
    }
    const auto found = std::find(table.exponents().begin(), table.exponents().end(), lobe.exponent);
    if (found == table.exponents().end()) continue;
    const std::size_t j = found - table.exponents().begin();
    gu += base * meter.directional_diffuse[j] * color::luminance(lobe.directional_diffuse) +
          fresnel * meter.gloss[j] * color::luminance(lobe.gloss);
  }
  return gu;
}

double gloss_units(const GlossTable& table, const GlossColumns& meter, const paint::LobeFit& fit) {
  return gloss_units(table, meter, fit, meter.angle_deg);
}

Result<std::vector<double>> set_gloss(const GlossTable& table, const std::vector<paint::GlossReading>& readings,
                                      paint::LobeFit& fit) {
  for (paint::Lobe& lobe : fit.lobes) lobe.gloss = {};
  if (readings.empty()) return std::vector<double>();
  GONIO_ASSIGN(const std::vector<paint::GlossReading> wanted, without_base(table, readings, fit));
  GONIO_ASSIGN(const GlossColumns* meter, table.at(readings.front().angle_deg));
  std::optional<RoughCoat> coat;
  if (readings.size() > 1) {
    GONIO_ASSIGN(coat, rough_coat_of(wanted, mirror_index(fit.coat_index)));
  }
  const bool has_mirror = fit.lobes.size() > table.exponents().size();
  const std::vector<double> weights =
      coat ? coat_weights(table, *coat, view_of(meter->angle_deg), meter->angle_deg, has_mirror, fit.coat_index)
           : one_reading(table, *meter, mirror_reading(*meter, fit.coat_index), wanted[0].gloss_units, has_mirror);
  put_gloss(weights, fit.lobes);

  std::vector<double> misfit_gu;
  paint::LobeFit all = fit;
  all.views.clear();
  for (const paint::GlossReading& reading : readings)
    misfit_gu.push_back(gloss_units(table, **table.at(reading.angle_deg), all, meter->angle_deg) - reading.gloss_units);
  return misfit_gu;
}

Result<void> set_gloss_views(const GlossTable& table, const std::vector<paint::GlossReading>& readings,
                             paint::LobeFit& fit) {
  std::optional<RoughCoat> coat;
  if (!readings.empty()) {
    GONIO_ASSIGN(const std::vector<paint::GlossReading> wanted, without_base(table, readings, fit));
    GONIO_ASSIGN(coat, rough_coat_of(wanted, mirror_index(fit.coat_index)));
  }
  if (!coat) {
    for (paint::ViewLobes& view : fit.views)
      for (std::size_t j = 0; j < view.lobes.size(); ++j) view.lobes[j].gloss = fit.lobes[j].gloss;
    return {};
  }
  paint::LobeFit gloss = fit;
  gloss.views.clear();
  for (std::size_t v = 0; v < std::size(kCoatViews_deg); ++v) {
    gloss.views.push_back({kCoatViews_deg[v], {}, fit.lobes});
    put_gloss(coat_weights(table, *coat, v, readings.front().angle_deg, fit.lobes.size() > table.exponents().size(),
                           fit.coat_index),
              gloss.views.back().lobes);
  }
  std::vector<double> angles(std::begin(kCoatViews_deg), std::end(kCoatViews_deg));
  for (const paint::ViewLobes& view : fit.views) angles.push_back(view.view_deg);
  std::ranges::sort(angles);
  angles.erase(std::ranges::unique(angles).begin(), angles.end());
  std::vector<paint::ViewLobes> views;
  for (const double angle : angles) {
    const paint::LobeFit base = at_view(fit, angle), coated = at_view(gloss, angle);
    views.push_back({angle, base.diffuse, base.lobes});
    for (std::size_t j = 0; j < base.lobes.size(); ++j) views.back().lobes[j].gloss = coated.lobes[j].gloss;
  }
  fit.views = std::move(views);
  return {};
}

Result<std::optional<CoatRange>> coat_range(const GlossTable& table, const std::vector<paint::GlossReading>& readings,
                                            const paint::LobeFit& fit) {
  GONIO_ASSIGN(const std::vector<paint::GlossReading> wanted, without_base(table, readings, fit));
  return rough_coat_range(wanted, mirror_index(fit.coat_index));
}

}  // namespace goniochrome::brdf
