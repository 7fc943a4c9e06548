#include "sketch/internal/sketch_lobes.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/angles.h"
#include "brdf/lobe_model.h"
#include "display/paint_view.h"
#include "envmap/prefiltered.h"
#include "fit/paint_fit.h"
#include "math/cosine_power.h"
#include "paint/curve.h"
#include "sketch/internal/sketch_solve.h"
#include "sketch/sketch.h"

namespace goniochrome::sketch {

namespace {

constexpr int kRounds = 4, kLastRounds = 8;
constexpr double kLeastGain = 1e-4;  // of the cost, for another round
constexpr int kSections = 10;        // of the interval between two values of gloss
// Between the sharpest lobe and the mirror, the whole range of gloss lies within 2 GU. Twelve sections of this interval
// tell the share of the mirror to half a percent.
constexpr int kLastSections = 12;
constexpr double kGlossReach_gu = 0.5;

// d shown/d rgb, one row for each of L*, a* and b*, by differences of a thousandth.
std::array<Vec3, 3> slopes(const SearchSamples& samples, const color::Rgb& at) {
  std::array<Vec3, 3> rows;
  const color::Lab middle = samples.shown(at);
  for (int c = 0; c < 3; ++c) {
    const double step = 1e-3 * std::max({at.x, at.y, at.z, 1e-3});
    color::Rgb moved = at;
    moved[c] += step;
    const color::Lab there = samples.shown(moved);
    rows[0][c] = (there.L - middle.L) / step, rows[1][c] = (there.a - middle.a) / step;
    rows[2][c] = (there.b - middle.b) / step;
  }
  return rows;
}

}  // namespace

double lobe_at(double aspecular_deg, double exponent) {
  return math::cos_power(aspecular_deg * kDegree, exponent);
}

color::Lab paint_lab(const color::Rgb& rgb) {
  static const color::Xyz white = *color::white_point({});
  return color::lab_from_rgb(rgb, white);
}

color::Lab SearchSamples::shown(const color::Rgb& rgb) const {
  return paint_lab(display ? display::in_display_gamut(rgb) : rgb);
}

color::Rgb shown_light(const Vec3* columns, const std::vector<color::Rgb>& weights,
                       const std::optional<color::ReflectionOperator>& reflection) {
  color::Rgb sum;
  for (std::size_t k = 0; k < weights.size(); ++k) sum += weights[k] * columns[k];
  if (!reflection) return sum;
  std::array<color::Rgb, 3> pairs;  // light of channel d on weights of channel e
  for (std::size_t k = 0; k < weights.size(); ++k)
    for (int d = 0; d < 3; ++d) pairs[d] += columns[k][d] * weights[k];
  sum = {};
  for (int c = 0; c < 3; ++c)
    for (int d = 0; d < 3; ++d)
      for (int e = 0; e < 3; ++e) sum[c] += reflection->k[c][d][e] * pairs[d][e];
  return sum;
}

PaintWeights::Mixed PaintWeights::mixed_at(double view_deg) const {
  if (views_deg.empty()) return {&all, &all, 0};
  const auto above = std::ranges::upper_bound(views_deg, view_deg);
  if (above == views_deg.begin()) return {&at_views.front(), &at_views.front(), 0};
  if (above == views_deg.end()) return {&at_views.back(), &at_views.back(), 0};
  const std::vector<color::Rgb>* high = &at_views[static_cast<std::size_t>(above - views_deg.begin())];
  return {high - 1, high, (view_deg - above[-1]) / (above[0] - above[-1])};
}

// Light is linear in the weights.
color::Rgb shown_light(const Vec3* columns, const PaintWeights::Mixed& weights,
                       const std::optional<color::ReflectionOperator>& reflection) {
  const color::Rgb low = shown_light(columns, *weights.low, reflection);
  return weights.share > 0 ? low + weights.share * (shown_light(columns, *weights.high, reflection) - low) : low;
}

color::Lab SearchSamples::shown_by(const PaintWeights& weights, std::size_t sample) const {
  const Vec3* light_there = columns_of(sample);
  return shown(view_deg.empty() ? shown_light(light_there, weights.all, reflection)
                                : shown_light(light_there, weights.mixed_at(view_deg[sample]), reflection));
}

void differences(const SearchSamples& samples, const std::vector<color::Lab>& target, const PaintWeights& weights,
                 std::vector<double>& out) {
  for (std::size_t i = 0; i < target.size(); ++i) {
    const color::Lab lab = samples.shown_by(weights, i);
    out[3 * i] = lab.L - target[i].L, out[3 * i + 1] = lab.a - target[i].a, out[3 * i + 2] = lab.b - target[i].b;
  }
}

paint::LobeFit lobes_of(const formats::Basis& basis, const std::vector<color::Rgb>& weights, double coat_index) {
  paint::LobeFit fit;
  fit.coat_index = coat_index;
  fit.diffuse = weights.front();
  for (std::size_t j = 0; j < basis.exponents.size(); ++j)
    fit.lobes.push_back({basis.exponents[j], weights[1 + 2 * j], weights[2 + 2 * j]});
  if (basis.mirror) fit.lobes.push_back({paint::kMirrorExponent, {}, weights.back()});
  return fit;
}

std::vector<color::Rgb> weights_of(const formats::Basis& basis, const paint::LobeFit& lobes) {
  std::vector<color::Rgb> w(search_columns(basis));
  w.front() = lobes.diffuse;
  for (const paint::Lobe& lobe : lobes.lobes) {
    if (lobe.is_mirror()) w.back() = lobe.gloss;
    for (std::size_t j = 0; j < basis.exponents.size(); ++j)
      if (lobe.exponent == basis.exponents[j]) w[1 + 2 * j] = lobe.directional_diffuse, w[2 + 2 * j] = lobe.gloss;
  }
  return w;
}

PaintWeights paint_weights(const formats::Basis& basis, const paint::LobeFit& lobes) {
  PaintWeights weights{weights_of(basis, lobes)};
  for (const paint::ViewLobes& view : lobes.views) {
    paint::LobeFit one;
    one.diffuse = view.diffuse, one.lobes = view.lobes;
    weights.views_deg.push_back(view.view_deg);
    weights.at_views.push_back(weights_of(basis, one));
  }
  return weights;
}

color::Lab instrument_lab(const formats::Basis& basis, const PaintWeights& weights, double coat_index,
                          double aspecular_deg) {
  const PaintWeights::Mixed mixed = weights.mixed_at(brdf::instrument_view_deg(aspecular_deg));
  const auto factor = [&](const std::vector<color::Rgb>& of) {
    return brdf::flake_reflectance_factor(lobes_of(basis, of, coat_index), aspecular_deg);
  };
  const color::Rgb low = factor(*mixed.low);
  return paint_lab(mixed.share > 0 ? low + mixed.share * (factor(*mixed.high) - low) : low);
}

bool give_gloss(const brdf::GlossTable& table, double gloss_60_gu, paint::LobeFit& lobes) {
  const std::vector<paint::GlossReading> reading = {{60, gloss_60_gu}};
  const double traced = lobes.coat_index;
  paint::LobeFit own = lobes;
  if (const auto index = brdf::coat_index_of(reading); traced != paint::kNoCoat && index.ok() && *index > traced)
    own = brdf::under_coat(lobes, *index);
  if (!brdf::set_gloss(table, reading, own).ok()) return false;
  lobes = own.coat_index == traced ? own : brdf::under_coat(own, traced);
  return true;
}

FreeLobeFit::FreeLobeFit(const formats::Basis& basis, const brdf::GlossTable& gloss, const SearchSamples& samples,
                         const std::vector<color::Lab>& target)
    : basis_(basis), gloss_(gloss), samples_(samples), target_(target) {
  for (const double exponent : basis.exponents)
    flake_lobes_ += lobe_at(paint::kFaceAngle_deg, exponent) >= fit::kSeenPart ? 1 : 0;
}

std::vector<FreeLobeFit::Unknown> FreeLobeFit::unknowns(bool free_gloss) const {
  std::vector<Unknown> all;
  for (std::size_t k = 0; k < samples_.columns; ++k) {
    const bool flake = k == 0 || (k % 2 == 1 && k / 2 < flake_lobes_);
    for (int c = 0; flake && c < 3; ++c) all.push_back({k, c});
    const bool gloss = k > 0 && (k % 2 == 0 || k + 1 == samples_.columns);
    if (free_gloss && gloss) all.push_back({k, 3});
  }
  return all;
}

// The light that weight 1 of an unknown adds to a sample.
Vec3 FreeLobeFit::effect(const Unknown& unknown, std::size_t sample) const {
  const Vec3& light = samples_.columns_of(sample)[unknown.column];
  if (unknown.channel == 3) return light;  // the operator is coherent
  color::Rgb weight;
  weight[unknown.channel] = 1;
  return samples_.reflection ? color::reflected(*samples_.reflection, light, weight) : light * weight;
}

void FreeLobeFit::set_gloss_of(double gloss, std::vector<color::Rgb>& weights) const {
  paint::LobeFit lobes = lobes_of(basis_, weights, samples_.coat_index);
  if (give_gloss(gloss_, gloss, lobes)) weights = weights_of(basis_, lobes);
}

double FreeLobeFit::cost(const std::vector<color::Rgb>& weights, std::vector<double>& r) const {
  differences(samples_, target_, {weights}, r);
  return robust_cost(r, samples_.importance);
}

// The weights >= 0 of least squares in Lab, linear about the observed color (`first`) or about that of the weights
// `at`. Outliers there count little.
std::vector<color::Rgb> FreeLobeFit::solved(const std::vector<color::Rgb>& at, const std::vector<double>& r,
                                            bool free_gloss, bool first) const {
  const std::vector<Unknown> unknown = unknowns(free_gloss);
  std::vector<color::Rgb> fixed = at, found = at;
  for (const Unknown& u : unknown) fixed[u.column] = found[u.column] = {};
  const std::vector<double> importance = first ? samples_.importance : robust_weights(r, samples_.importance);
  NormalEquations normal(static_cast<int>(unknown.size()));
  std::vector<Vec3> effects(unknown.size());
  std::vector<double> row(unknown.size());
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    const color::Rgb shown = shown_light(samples_.columns_of(i), at, samples_.reflection);
    const color::Rgb about = first ? samples_.seen[i] : shown;
    const color::Rgb wanted = about - shown_light(samples_.columns_of(i), fixed, samples_.reflection);
    const std::array<Vec3, 3> slope = slopes(samples_, about);
    for (std::size_t u = 0; u < unknown.size(); ++u) effects[u] = effect(unknown[u], i);
    for (int c = 0; c < 3; ++c) {
      for (std::size_t u = 0; u < unknown.size(); ++u) row[u] = dot(slope[c], effects[u]);
      normal.add(row.data(), dot(slope[c], wanted) - (first ? 0 : r[3 * i + c]), importance[i]);
    }
  }
  const std::vector<double> x = normal.non_negative();
  for (std::size_t u = 0; u < unknown.size(); ++u)
    for (int c = 0; c < 3; ++c)
      if (unknown[u].channel == 3 || unknown[u].channel == c) found[unknown[u].column][c] = x[u];
  return found;
}

FreeLobes FreeLobeFit::descend(std::vector<color::Rgb> weights, std::optional<double> gloss, bool first,
                               int rounds) const {
  std::vector<double> r(3 * samples_.size()), tried(r.size());
  if (gloss) set_gloss_of(*gloss, weights);
  double least = cost(weights, r);
  for (int round = 0; round < rounds; ++round) {
    const std::vector<color::Rgb> to = solved(weights, r, !gloss, first && round == 0);
    const double before = least;
    for (double part = 1; part > 0.1 && least == before; part /= 2) {
      std::vector<color::Rgb> moved = weights;
      for (std::size_t k = 0; k < moved.size(); ++k) moved[k] += part * (to[k] - weights[k]);
      if (gloss) set_gloss_of(*gloss, moved);
      if (const double now = cost(moved, tried); now < least) least = now, weights = moved, r.swap(tried);
    }
    if (!(least < (1 - kLeastGain) * before)) break;
  }
  const double reading =
      gloss ? *gloss : brdf::gloss_units(gloss_, **gloss_.at(60), lobes_of(basis_, weights, samples_.coat_index));
  return {weights, std::clamp(reading, 0.0, 100.0), least};
}

FreeLobes FreeLobeFit::with_gloss(const FreeLobes& start, double gloss) const {
  return descend(start.weights, gloss, false, kRounds);
}

FreeLobes FreeLobeFit::refined(const FreeLobes& start) const {
  return descend(start.weights, start.gloss_60_gu, false, kLastRounds);
}

FreeLobes FreeLobeFit::with_any_gloss() const {
  return descend(std::vector<color::Rgb>(samples_.columns), std::nullopt, true, kLastRounds);
}

FreeLobes FreeLobeFit::find() const {
  const FreeLobes any = with_any_gloss();
  std::vector<double> values = {0, 5, 10, 20, 30, 40, 50, 60, 70, 76, 80, 83, 86, 88, 90, 92, 94, 97, 100};
  values.push_back(any.gloss_60_gu);
  std::ranges::sort(values);
  std::vector<FreeLobes> found;
  for (const double gloss : values) found.push_back(with_gloss(any, gloss));
  const auto best = std::ranges::min_element(found, {}, &FreeLobes::cost);
  const auto at = static_cast<std::size_t>(best - found.begin());
  return between(values[at > 0 ? at - 1 : 0], values[std::min(at + 1, values.size() - 1)], *best, kSections);
}

FreeLobes FreeLobeFit::sharpened(const FreeLobes& start) const {
  const FreeLobes least = refined(start);
  if (least.weights.back() == color::Rgb{}) return least;
  return between(std::max(0.0, least.gloss_60_gu - kGlossReach_gu), std::min(100.0, least.gloss_60_gu + kGlossReach_gu),
                 least, kLastSections);
}

// Golden sections of the interval of gloss that holds the best so far.
FreeLobes FreeLobeFit::between(double low, double high, FreeLobes least, int sections) const {
  const double golden = 0.5 * (std::sqrt(5.0) - 1);
  FreeLobes left = with_gloss(least, high - golden * (high - low)),
            right = with_gloss(least, low + golden * (high - low));
  for (int section = 0; section < sections; ++section) {
    if (left.cost < right.cost) {
      high = right.gloss_60_gu, right = left, left = with_gloss(left, high - golden * (high - low));
    } else {
      low = left.gloss_60_gu, left = right, right = with_gloss(right, low + golden * (high - low));
    }
  }
  for (const FreeLobes& other : {left, right})
    if (other.cost < least.cost) least = other;
  return least;
}

}  // namespace goniochrome::sketch
