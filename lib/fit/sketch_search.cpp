#include "fit/sketch_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "base/parallel.h"
#include "brdf/lobe_model.h"
#include "envmap/prefiltered.h"
#include "fit/sketch_common.h"
#include "fit/sketch_picture.h"
#include "paint/curve.h"

namespace goniochrome {

namespace {

constexpr double kRowsGain = 0.8;    // free rows must lower the cost to this part of that of face, flop and travel
constexpr double kExactCost = 1e-3;  // of log(1 + dE^2): RMS 0.03 dE; a wrong valley costs ten times that
constexpr double kNoisyCost = 0.2;   // RMS half a dE
constexpr double kGoodCost = 0.02;   // an agreement that freed rows need not improve
constexpr std::size_t kAtOnce = 2;   // starts; fixed, so that no result depends on the number of threads
constexpr double kDarkest = 0.004;   // of a channel, for its weight; L* 4

FitOptions by(FitMethod method) {
  FitOptions options;
  options.method = method;
  return options;
}

Paint paint_of(const std::vector<double>& v) {
  Paint paint;
  const auto lab = [&](std::size_t i) { return Lab{v[i], v[i + 1], v[i + 2]}; };
  if (v.size() == 8) {
    paint.appearance = Appearance{lab(0), lab(3), v[6], std::nullopt};
  } else {
    paint.measurement = Measurement{{}, "", {{{45, 15}, lab(0)}, {{45, 45}, lab(3)}, {{45, 110}, lab(6)}}};
  }
  paint.gloss.push_back({60, v.back()});
  return paint;
}

void add_lab(const Lab& lab, std::vector<SearchParameter>& p) {
  p.push_back({lab.L, 0.25, 0, 300}), p.push_back({lab.a, 0.25, -250, 250}), p.push_back({lab.b, 0.25, -250, 250});
}

// Where a search begins, with the steps and domains of its numbers.
std::vector<SearchParameter> parameters_of(const std::vector<double>& v) {
  std::vector<SearchParameter> p;
  for (std::size_t i = 0; i + 2 < v.size(); i += 3) add_lab({v[i], v[i + 1], v[i + 2]}, p);
  if (v.size() == 8) p.push_back({v[6], 0.5, 16, 180});
  p.push_back({v.back(), 0.5, 0, 100});
  return p;
}

void take_better(SearchResult result, bool exact, FoundPaint& best) {
  if (best.search.values.empty() || result.cost < best.search.cost) best = {std::move(result), {}, exact};
}

std::vector<SearchParameter> parameters(const Appearance& a, double gloss) {
  return parameters_of({a.face.L, a.face.a, a.face.b, a.flop.L, a.flop.a, a.flop.b, a.travel_deg, gloss});
}

}  // namespace

std::size_t search_columns(const Basis& basis) {
  return 2 * basis.exponents.size() + 2;
}

Rgb shown_light(const Vec3* columns, const std::vector<Rgb>& weights,
                const std::optional<ReflectionOperator>& reflection) {
  Rgb sum;
  for (std::size_t k = 0; k < weights.size(); ++k) sum += weights[k] * columns[k];
  if (!reflection) return sum;
  std::array<Rgb, 3> pairs;  // light of channel d on weights of channel e
  for (std::size_t k = 0; k < weights.size(); ++k)
    for (int d = 0; d < 3; ++d) pairs[d] += columns[k][d] * weights[k];
  sum = {};
  for (int c = 0; c < 3; ++c)
    for (int d = 0; d < 3; ++d)
      for (int e = 0; e < 3; ++e) sum[c] += reflection->k[c][d][e] * pairs[d][e];
  return sum;
}

Paint FoundPaint::paint() const {
  return paint_of(search.values);
}

LobeSearch::LobeSearch(const Basis& basis, SearchSamples samples)
    : basis_(basis),
      smooth_(basis, by(FitMethod::kL2)),
      exact_(basis, by(FitMethod::kL1)),
      samples_(std::move(samples)) {
  for (const Rgb& seen : samples_.seen) target_.push_back(paint_lab(seen));
}

std::vector<Rgb> LobeSearch::weights(const PaintFitter& fitter, const std::vector<double>& values) const {
  std::vector<Rgb> w(samples_.columns);
  const auto fit = fitter.fit(paint_of(values));
  if (!fit.ok()) return w;
  w[0] = fit->lobes.diffuse;
  for (const Lobe& lobe : fit->lobes.lobes) {
    if (!std::isfinite(lobe.exponent)) w.back() = lobe.gloss;
    for (std::size_t j = 0; j < basis_.exponents.size(); ++j)
      if (lobe.exponent == basis_.exponents[j]) w[1 + 2 * j] = lobe.directional_diffuse, w[2 + 2 * j] = lobe.gloss;
  }
  return w;
}

void LobeSearch::residuals(const std::vector<Rgb>& w, std::vector<double>& out) const {
  for (std::size_t i = 0; i < target_.size(); ++i) {
    const Rgb light = shown_light(&samples_.light[i * samples_.columns], w, samples_.reflection);
    const Lab lab = paint_lab(samples_.display ? in_display_gamut(light) : light);
    out[3 * i] = lab.L - target_[i].L, out[3 * i + 1] = lab.a - target_[i].a, out[3 * i + 2] = lab.b - target_[i].b;
  }
}

double LobeSearch::cost(const std::vector<double>& values) const {
  std::vector<double> r(3 * target_.size());
  residuals(weights(smooth_, values), r);
  return robust_cost(r, samples_.importance);
}

SearchResult LobeSearch::run(const PaintFitter& fitter, const std::vector<SearchParameter>& start) const {
  return robust_search(start, samples_.importance,
                       [&](const auto& values, auto& out) { residuals(weights(fitter, values), out); });
}

// One channel's weights, >= 0, by least absolute deviations in lightness (reweighted squares).
std::vector<double> LobeSearch::linear_channel(int channel) const {
  const std::size_t n = samples_.columns;
  std::vector<double> x, row(n);
  for (int round = 0; round < 8; ++round) {
    NormalEquations normal(static_cast<int>(n));
    for (std::size_t i = 0; i < target_.size(); ++i) {
      const double seen = samples_.seen[i][channel];
      const double lightness = 116.0 / 3 * std::pow(std::max(seen, kDarkest), -2.0 / 3);
      for (std::size_t k = 0; k < n; ++k) row[k] = samples_.light[i * n + k][channel];
      double weight = samples_.importance[i];
      if (!x.empty()) {
        double apart = -seen;
        for (std::size_t k = 0; k < n; ++k) apart += x[k] * row[k];
        weight /= std::max(lightness * std::abs(apart), 0.3);
      }
      normal.add(row.data(), seen, weight * lightness * lightness);
    }
    x = normal.non_negative();
  }
  return x;
}

LobeFit LobeSearch::linear() const {
  LobeFit fit;
  for (const double exponent : basis_.exponents) fit.lobes.push_back({exponent, {}, {}});
  if (basis_.mirror) fit.lobes.push_back({kMirrorExponent, {}, {}});
  for (int c = 0; c < 3; ++c) {
    const std::vector<double> x = linear_channel(c);
    fit.diffuse[c] = x[0];
    for (std::size_t j = 0; j < basis_.exponents.size(); ++j)
      fit.lobes[j].directional_diffuse[c] = x[1 + 2 * j], fit.lobes[j].gloss[c] = x[2 + 2 * j];
    if (basis_.mirror) fit.lobes.back().gloss[c] = x.back();
  }
  return fit;
}

Rgb LobeSearch::matt() const {
  Rgb up, down;
  for (std::size_t i = 0; i < target_.size(); ++i) {
    const Vec3& d = samples_.light[i * samples_.columns];
    up += samples_.importance[i] * (samples_.seen[i] * d), down += samples_.importance[i] * (d * d);
  }
  Rgb color;
  for (int c = 0; c < 3; ++c) color[c] = down[c] > 0 ? std::numbers::pi * up[c] / down[c] : 0;
  return color;
}

double LobeSearch::cost_with_gloss(const FoundPaint& found, double gloss) const {
  std::vector<double> values = found.search.values, r(3 * target_.size());
  values.back() = gloss;
  residuals(weights(found.exact ? exact_ : smooth_, values), r);
  return robust_cost(r, samples_.importance);
}

// The gloss of least cost among some, the rest held: the cost has a valley at each lobe of the basis.
void LobeSearch::scan_gloss(std::vector<SearchParameter>& start) const {
  std::vector<double> values;
  for (const SearchParameter& parameter : start) values.push_back(parameter.value);
  double least = cost(values);
  for (const double gloss : {0.0, 5.0, 15.0, 30.0, 50.0, 70.0, 82.0, 88.0, 93.0, 100.0}) {
    values.back() = gloss;
    if (const double now = cost(values); now < least) least = now, start.back().value = gloss;
  }
}

// A paint read off the linear fit, with three values of gloss, and a neutral silver of medium gloss, the start of
// [Shimizu2009] 3.7.5.
std::vector<std::vector<SearchParameter>> LobeSearch::starts() const {
  const LobeFit guess = linear();
  std::vector<LabReading> rows;
  for (const double angle : {15.0, 45.0, 110.0})
    rows.push_back({{45, angle}, paint_lab(flake_reflectance_factor(guess, angle))});
  const GlossTable table(basis_.exponents);
  const double gloss = std::clamp(gloss_units(table, **table.at(60), guess), 0.0, 100.0);
  std::vector<std::vector<SearchParameter>> all = {parameters(appearance_from_rows(rows)->appearance, gloss),
                                                   parameters({{80, 0, 0}, {30, 0, 0}, 60, std::nullopt}, 50)};
  for (auto& start : all) scan_gloss(start);
  for (const double other : {20.0, 90.0}) {  // wide gloss lobes look like flake: the paint read off, with some and none
    all.push_back(all.front());
    all.back().back().value = other;
  }
  return all;
}

// Wide gloss and the rise of a short travel look alike near specular, and lead into valleys of each other: the paint
// read off, with each of some travels and values of gloss.
std::vector<std::vector<SearchParameter>> LobeSearch::further_starts(const std::vector<SearchParameter>& first) {
  std::vector<std::vector<SearchParameter>> all;
  for (const double travel_deg : {38.0, 60.0, 90.0})
    for (const double gloss : {15.0, 50.0, 85.0}) {
      all.push_back(first);
      all.back()[6].value = travel_deg, all.back()[7].value = gloss;
    }
  return all;
}

SearchResult LobeSearch::best_rows(const SearchResult& appearance) const {
  const Appearance a = *paint_of(appearance.values).appearance;
  std::vector<double> values;
  for (const double angle : {15.0, 45.0, 110.0}) {
    const Lab lab = lab_at(a, angle);
    values.insert(values.end(), {lab.L, lab.a, lab.b});
  }
  values.push_back(appearance.values.back());
  return run(smooth_, parameters_of(values));
}

// Which of the two ways made the picture's lobes is not known: each start goes both. A paint that explains the samples
// exactly ends the search; where noise hides what is exact, the further starts are not worth their time.
FoundPaint LobeSearch::best_of_starts() const {
  FoundPaint best;
  const auto try_all = [&](const std::vector<std::vector<SearchParameter>>& starts) {
    for (std::size_t from = 0; from < starts.size(); from += kAtOnce) {
      if (!best.search.values.empty() && best.search.cost <= kExactCost) return;
      const std::size_t count = std::min(kAtOnce, starts.size() - from);
      std::array<SearchResult, kAtOnce> smooth, exact;
      parallel_for(count, 1, [&](std::size_t i, std::size_t) {
        smooth[i] = run(smooth_, starts[from + i]);
        exact[i] = run(exact_, parameters_of(smooth[i].values));
      });
      for (std::size_t i = 0; i < count; ++i)
        take_better(std::move(exact[i]), true, best), take_better(std::move(smooth[i]), false, best);
    }
  };
  const auto first = starts();
  try_all({first.front()});  // mostly the way to an exact answer
  try_all({first.begin() + 1, first.end()});
  if (best.search.cost <= kNoisyCost) try_all(further_starts(first.front()));
  return best;
}

FoundPaint LobeSearch::find(const LobeSearch& first) const {
  const FoundPaint begun = first.best_of_starts();
  FoundPaint best = {run(begun.exact ? exact_ : smooth_, parameters_of(begun.search.values)), {}, begun.exact};
  if (best.search.cost > kGoodCost) {
    SearchResult rows = best_rows(best.search);
    if (rows.cost < kRowsGain * best.search.cost) {
      SearchResult exact = run(exact_, parameters_of(rows.values));
      take_better(std::move(rows), false, best);
      take_better(std::move(exact), true, best);
    }
  }
  best.weights = weights(best.exact ? exact_ : smooth_, best.search.values);
  return best;
}

}  // namespace goniochrome
