#include "sketch/internal/sketch_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "base/angles.h"
#include "base/parallel.h"
#include "brdf/lobe_model.h"
#include "paint/curve.h"

namespace goniochrome::sketch {

namespace {

constexpr std::array<double, 3> kThree_deg = {15, 45, 110};
constexpr std::size_t kByAppearance = 8, kByThree = 10;  // numbers of a paint found
// A paint of fewer numbers is believed where its cost is at most this part more than that of free lobes, whose gain may
// be the noise's, or where it explains the picture to RMS 0.01 dE.
constexpr double kExactCost = 1e-4;
constexpr double kLessCost = 0.999;     // of a paint of fewer numbers, for more: two numbers gain less from noise
constexpr double kRoundingCost = 1e-6;  // RMS 0.001 dE
constexpr double kHopelessCost = 1.5;   // of enough, in a part of the samples
// Where lobes alone leave much open: log(1 + dE^2) of RMS 0.03, 0.14 and half a dE, and the gain that free rows must
// bring.
constexpr double kFoundCost = 1e-3, kGoodCost = 0.02, kNoisyCost = 0.2, kRowsGain = 0.8;
constexpr std::size_t kAtOnce = 2;  // starts; fixed, so that no result depends on the number of threads

std::span<const double> angles_of(std::size_t numbers) {
  if (numbers == kByThree) return kThree_deg;
  return paint::kExportAngles_deg;
}

paint::Paint paint_of(const std::vector<double>& v) {
  paint::Paint paint;
  const auto lab = [&](std::size_t i) { return color::Lab{v[i], v[i + 1], v[i + 2]}; };
  if (v.size() == kByAppearance) {
    paint.appearance = paint::Appearance{lab(0), lab(3), v[6], std::nullopt};
  } else {
    paint.measurement = paint::Measurement{};
    for (const double angle : angles_of(v.size())) {
      auto& rows = paint.measurement->rows;
      rows.push_back({{45, angle}, lab(3 * rows.size())});
    }
  }
  paint.gloss.push_back({60, v.back()});
  return paint;
}

// Where a search begins, with the steps and domains of its numbers.
std::vector<SearchParameter> parameters_of(const std::vector<double>& v) {
  std::vector<SearchParameter> p;
  for (std::size_t i = 0; i + 2 < v.size(); i += 3) {
    p.push_back({v[i], 0.25, 0, 300});
    for (std::size_t c = i + 1; c < i + 3; ++c) p.push_back({v[c], 0.25, -250, 250});
  }
  if (v.size() == kByAppearance) p.push_back({v[6], 0.5, 16, 180});
  p.push_back({v.back(), 0.5, 0, 100});
  return p;
}

// Lab of lobes at these angles, and their gloss.
std::vector<double> numbers_of(const paint::LobeFit& lobes, std::span<const double> angles_deg, double gloss) {
  std::vector<double> v;
  for (const double angle : angles_deg) {
    const color::Lab lab = paint_lab(brdf::flake_reflectance_factor(lobes, angle));
    v.insert(v.end(), {lab.L, lab.a, lab.b});
  }
  v.push_back(gloss);
  return v;
}

std::vector<double> appearance_of(const std::vector<double>& rows) {
  const paint::Appearance a = paint::appearance_from_rows(paint_of(rows).measurement->rows)->appearance;
  return {a.face.L, a.face.a, a.face.b, a.flop.L, a.flop.a, a.flop.b, a.travel_deg, rows.back()};
}

// Starts of a search of paints by gloss and travel, which differ least from picture to picture: a paint read off lobes
// of any weight, a neutral silver of medium gloss, the start of [Shimizu2009] 3.7.5, and that paint with some and much
// gloss, since wide gloss lobes look like flake.
std::vector<std::vector<double>> first_starts(const std::vector<double>& read_off) {
  std::vector<std::vector<double>> all = {read_off, {80, 0, 0, 30, 0, 0, 60, 50}, read_off, read_off};
  all[2].back() = 20, all[3].back() = 90;
  return all;
}

// Wide gloss and the rise of a short travel look alike near specular, and lead into valleys of each other.
std::vector<std::vector<double>> further_starts(const std::vector<double>& read_off) {
  std::vector<std::vector<double>> all;
  for (const double travel_deg : {38.0, 60.0, 90.0})
    for (const double gloss : {15.0, 50.0, 85.0}) {
      all.push_back(read_off);
      all.back()[6] = travel_deg, all.back()[7] = gloss;
    }
  return all;
}

}  // namespace

std::size_t search_columns(const formats::Basis& basis) {
  return 2 * basis.exponents.size() + 2;
}

paint::Paint FoundPaint::paint() const {
  return paint_of(search.values);
}

const char* FoundPaint::model() const {
  if (search.values.size() == kByAppearance) return "search";
  return search.values.size() == kByThree ? "search with free rows" : "search with free lobes";
}

namespace {

SearchFitters::Ways ways_of(const formats::Basis& basis, double coat_index, const std::vector<double>& views_deg) {
  const auto by = [&](fit::FitMethod method) {
    fit::FitOptions options;
    options.method = method, options.coat_index = coat_index, options.views_deg = views_deg;
    return fit::PaintFitter(basis, options);
  };
  return {by(fit::FitMethod::kL2), by(fit::FitMethod::kL1)};
}

// Those of the instrument at three readings, ascending.
std::vector<double> three_views_deg() {
  std::vector<double> views;
  for (const double angle_deg : kThree_deg) views.push_back(brdf::instrument_view_deg(angle_deg));
  std::ranges::sort(views);
  return views;
}

}  // namespace

SearchFitters::SearchFitters(const formats::Basis& basis, double coat_index)
    : gloss(basis.exponents), ways(ways_of(basis, coat_index, {})) {
  if (coat_index != paint::kNoCoat) by_view = ways_of(basis, coat_index, three_views_deg());
}

LobeSearch::LobeSearch(const SearchFitters& fitters, SearchSamples samples)
    : fitters_(fitters), basis_(fitters.ways.smooth.basis()), samples_(std::move(samples)) {
  for (const color::Rgb& seen : samples_.seen) target_.push_back(paint_lab(seen));
}

PaintWeights LobeSearch::weights(const fit::PaintFitter& fitter, const std::vector<double>& values) const {
  const auto fit = fitter.fit(paint_of(values));
  return fit.ok() ? paint_weights(basis_, fit->lobes) : PaintWeights{std::vector<color::Rgb>(samples_.columns)};
}

// The weights of a paint found with another gloss, which is the same at all views; none where they cannot have it.
PaintWeights LobeSearch::with_gloss(const FoundPaint& found, double gloss) const {
  paint::LobeFit lobes = lobes_of(basis_, found.weights.all, samples_.coat_index);
  if (!give_gloss(fitters_.gloss, gloss, lobes)) return {};
  PaintWeights other = found.weights;
  other.all = weights_of(basis_, lobes);
  for (std::vector<color::Rgb>& view : other.at_views) {
    for (std::size_t k = 2; k < view.size(); k += 2) view[k] = other.all[k];
    view.back() = other.all.back();
  }
  return other;
}

double LobeSearch::cost(const PaintWeights& w) const {
  std::vector<double> r(3 * target_.size());
  differences(samples_, target_, w, r);
  return robust_cost(r, samples_.importance);
}

SearchResult LobeSearch::run(const fit::PaintFitter& fitter, const std::vector<SearchParameter>& start) const {
  return robust_search(start, samples_.importance, [&](const auto& values, auto& out) {
    differences(samples_, target_, weights(fitter, values), out);
  });
}

color::Rgb LobeSearch::matt() const {
  color::Rgb up, down;
  for (std::size_t i = 0; i < target_.size(); ++i) {
    const Vec3& d = *samples_.columns_of(i);
    up += samples_.importance[i] * (samples_.seen[i] * d), down += samples_.importance[i] * (d * d);
  }
  color::Rgb color;
  for (int c = 0; c < 3; ++c) color[c] = down[c] > 0 ? kPi * up[c] / down[c] : 0;
  return color;
}

double LobeSearch::cost_with_gloss(const FoundPaint& found, double gloss) const {
  const PaintWeights other = with_gloss(found, gloss);
  return other.all.empty() ? found.search.cost : cost(other);
}

bool LobeSearch::explains_as_well(const FoundPaint& found, double gloss) const {
  constexpr double kApart_de76 = 0.5;
  const PaintWeights other = with_gloss(found, gloss);
  if (other.all.empty()) return false;
  double own = 0, cost = 0, all = 0;
  for (std::size_t i = 0; i < target_.size(); ++i) {
    const color::Lab here = samples_.shown_by(found.weights, i), there = samples_.shown_by(other, i);
    if (color::delta_e_76(here, there) < kApart_de76) continue;
    const auto off = [&](const color::Lab& lab) {
      const double de = color::delta_e_76(lab, target_[i]);
      return samples_.importance[i] * std::log1p(de * de);
    };
    own += off(here), cost += off(there), all += samples_.importance[i];
  }
  return cost <= kSameCost * own + kSameCostBy * all;
}

// The two ways from a paint to its lobes make different pictures, and which of them made this one is not known: both
// are gone, the second from where the first arrived.
LobeSearch::Way LobeSearch::way(const std::vector<double>& start, const SearchFitters::Ways& ways) const {
  SearchResult smooth = run(ways.smooth, parameters_of(start));
  if (smooth.cost < kRoundingCost) return {std::move(smooth), &ways.smooth};
  SearchResult exact = run(ways.exact, parameters_of(smooth.values));
  return exact.cost < smooth.cost ? Way{std::move(exact), &ways.exact} : Way{std::move(smooth), &ways.smooth};
}

// A paint of fewer numbers is the answer where it explains the samples as well as free lobes. Under a coat, a paint of
// three readings may have weights for several views, and then explains what free lobes cannot. It is sought with such
// weights for every trial: if only trials with a lost reading had them, the cost would jump between trials.
FoundPaint LobeSearch::find(const LobeSearch& first) const {
  const auto enough = [](const FreeLobes& free) { return std::max(kSameCost * free.cost, kExactCost); };
  const FreeLobes begun = first.free_lobes().find(), free = free_lobes().sharpened(begun);
  const paint::LobeFit lobes = lobes_of(basis_, free.weights, samples_.coat_index);
  const std::vector<double> three = numbers_of(lobes, kThree_deg, free.gloss_60_gu);
  std::optional<FoundPaint> fewer;
  const auto take = [&](const Way& way) {
    if (way.result.cost > kHopelessCost * enough(begun)) return;
    FoundPaint found{run(*way.fitter, parameters_of(way.result.values)), {}, way.fitter};
    if (found.search.cost > (fewer ? kLessCost * fewer->search.cost : enough(free))) return;
    found.weights = weights(*way.fitter, found.search.values);
    fewer = std::move(found);
  };
  const Way designed = first.way(appearance_of(three), fitters_.ways);
  take(designed);
  if (!fewer) take(first.way(three, fitters_.ways));
  const bool has_views = fitters_.by_view && !samples_.view_deg.empty();
  if (has_views && !(fewer && fewer->search.cost <= kExactCost)) take(first.way(three, *fitters_.by_view));
  if (fewer) return *fewer;
  std::vector<double> apart;  // of the face, from that of a paint of few numbers
  for (std::size_t i = 0; i < 3; ++i) apart.push_back(std::abs(three[i] - designed.result.values[i]));
  return {{numbers_of(lobes, paint::kExportAngles_deg, free.gloss_60_gu), free.cost, 0, 0, apart}, {free.weights}};
}

// The gloss of least cost among some, the rest held: the cost has a valley at each lobe of the basis.
void LobeSearch::scan_gloss(const fit::PaintFitter& fitter, std::vector<double>& start) const {
  std::vector<double> values = start;
  double least = cost(weights(fitter, values));
  for (const double gloss : {0.0, 5.0, 15.0, 30.0, 50.0, 70.0, 82.0, 88.0, 93.0, 100.0}) {
    values.back() = gloss;
    if (const double now = cost(weights(fitter, values)); now < least) least = now, start.back() = gloss;
  }
}

// A paint that explains the samples exactly ends the search; where noise hides what is exact, the further starts are
// not worth their time.
LobeSearch::Way LobeSearch::best_way() const {
  const FreeLobes free = free_lobes().with_any_gloss();
  const auto read_off =
      appearance_of(numbers_of(lobes_of(basis_, free.weights, samples_.coat_index), kThree_deg, free.gloss_60_gu));
  Way best{{{}, std::numeric_limits<double>::infinity(), 0, 0}, nullptr};
  const auto try_all = [&](std::span<const std::vector<double>> starts) {
    for (std::size_t from = 0; from < starts.size() && best.result.cost > kFoundCost; from += kAtOnce) {
      const std::size_t count = std::min(kAtOnce, starts.size() - from);
      std::array<Way, kAtOnce> ways;
      parallel_for(count, 1, [&](std::size_t i, std::size_t) { ways[i] = way(starts[from + i], fitters_.ways); });
      for (std::size_t i = 0; i < count; ++i)
        if (ways[i].result.cost < best.result.cost) best = std::move(ways[i]);
    }
  };
  std::vector<std::vector<double>> starts = first_starts(read_off);
  scan_gloss(fitters_.ways.smooth, starts[0]);
  try_all({starts.data(), 1});  // mostly the way to an exact answer
  scan_gloss(fitters_.ways.smooth, starts[1]);
  try_all(std::span(starts).subspan(1));
  if (best.result.cost <= kNoisyCost) try_all(further_starts(read_off));
  return best;
}

FoundPaint LobeSearch::find_plain(const LobeSearch& first) const {
  const Way begun = first.best_way();
  Way best{run(*begun.fitter, parameters_of(begun.result.values)), begun.fitter};
  if (best.result.cost > kGoodCost) {
    const paint::Appearance a = *paint_of(best.result.values).appearance;
    std::vector<double> three;
    for (const double angle : kThree_deg) {
      const color::Lab lab = paint::lab_at(a, angle);
      three.insert(three.end(), {lab.L, lab.a, lab.b});
    }
    three.push_back(best.result.values.back());
    const auto take = [&](Way rows) {
      if (rows.result.cost < kRowsGain * best.result.cost) best = std::move(rows);
    };
    take(way(three, fitters_.ways));
    if (fitters_.by_view && !samples_.view_deg.empty()) {
      scan_gloss(fitters_.by_view->smooth, three);
      take(way(three, *fitters_.by_view));
    }
  }
  return {best.result, weights(*best.fitter, best.result.values), best.fitter};
}

}  // namespace goniochrome::sketch
