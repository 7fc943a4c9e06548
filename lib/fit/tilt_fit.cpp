#include "fit/tilt_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>

#include "base/angles.h"
#include "base/parallel.h"
#include "brdf/lobe_model.h"
#include "brdf/tilted_lobes.h"
#include "fit/internal/tilt_lights.h"
#include "fit/paint_fit.h"

namespace goniochrome::fit {

namespace {

// Views whose weights a set holds. The last ones lie closer, since the color of a steep view changes fast. Twice as far
// apart, sets of 64 look-ups on two thin films erred by 0.64 and 0.39 half-way between views (mean CIEDE2000) and by
// 0.29 and 0.18 at the views; as close as this, half-way between them by 0.35 and 0.21.
constexpr std::array kViews_deg = {0.0,  4.0,  8.0,  11.5, 15.0, 20.0, 25.0, 30.0, 35.0, 40.0, 45.0, 50.0,
                                   55.0, 60.0, 64.0, 68.0, 72.0, 76.0, 79.0, 82.0, 85.0, 88.0, 90.0};

// Sharper lobes are not tilted: color maps, which leave out what is near specular, have nothing as sharp.
constexpr double kSharpest = 300;
constexpr std::size_t kMostExponents = 8;

// Lobes up to this exponent are always there about the mirror direction itself, to which all axes fall together where
// the viewer is at the normal.
constexpr double kSharpestKept = 100;

// A set is kept where it lowers the mean error of the one before by this part of it.
constexpr double kWorthwhile = 0.05;

constexpr int kSweeps = 60, kFinalSweeps = 400;  // of coordinate descent

// Sets are interpolated between views, and where lobes can stand for each other the weights of two views may differ at
// will. In the end the weights of each view are therefore drawn toward the mean of its neighbors, with this part of
// what keeps them in place, in so many rounds.
constexpr double kPull = 0.003;
constexpr int kPullRounds = 12;

// Exponents of the basis, thinned to a few of different widths.
std::vector<double> tilted_exponents(const formats::Basis& basis) {
  std::vector<double> exponents;
  for (const double exponent : basis.exponents)
    if (exponent > 0 && exponent <= kSharpest) exponents.push_back(exponent);
  while (exponents.size() > kMostExponents) {
    std::size_t closest = 1;
    for (std::size_t i = 1; i + 1 < exponents.size(); ++i)
      if (exponents[i + 1] / exponents[i - 1] < exponents[closest + 1] / exponents[closest - 1]) closest = i;
    exponents.erase(exponents.begin() + static_cast<std::ptrdiff_t>(closest));
  }
  return exponents;
}

// Lobes about axes that stand about as far apart as they are wide. Few of them stay near the mirror direction, no
// farther than twice their width: farther out, few sharp lobes show a small lamp as separate spots. On cayman in a
// studio, 8 look-ups with axes to 3.2 standard deviations erred by 2.07 (mean CIEDE2000), to 2.2 by 1.38, and to 8 by
// more than its plain lobes. Many lobes can stand farther out: under one small lamp, 64 look-ups on film_green_violet
// erred by 0.71 with axes to 4, and by 0.84 to 3.2; 32 look-ups gained nothing by axes to 3.2 there, and lost under a
// sky (1.43 for 1.29). The first one is the diffuse part: a lobe of exponent 1 about the normal.
struct Candidate {
  paint::TiltedLobe lobe;
  std::size_t exponent = 0;  // its number
  bool diffuse = false;
  bool far = false;  // for sets of kManyLookups and more
};
constexpr int kManyLookups = 48;
std::vector<Candidate> candidates_of(const std::vector<double>& exponents) {
  constexpr double kApart = 0.9, kReach = 2.2, kFarReach = 4;  // standard deviations of a lobe
  std::vector<Candidate> all = {{{1, 0, 0}, exponents.size(), true, false}};
  for (std::size_t e = 0; e < exponents.size(); ++e) {
    const double width_deg = 1 / (std::sqrt(exponents[e]) * kDegree);
    const double step = std::clamp(std::round(kApart * width_deg), 5.0, 30.0);
    const double near = std::min(kReach * width_deg, 110.0), reach = std::min(kFarReach * width_deg, 110.0);
    for (double tilt = -step * std::floor(reach / step); tilt <= std::min(reach, 60.0); tilt += step)
      for (double out = 0; out <= std::min(reach, 75.0); out += step)
        all.push_back({{exponents[e], tilt, out}, e, false, std::max(std::abs(tilt), out) > near});
  }
  return all;
}

using Channels = std::array<double, 3>;

// One view of the map: how far a sum of lobes is from it, as a quadratic form of its weights.
class View {
 public:
  View(double view_deg, const TiltLights& lights, const std::vector<Candidate>& candidates, const brdf::ColorMap& map,
       brdf::CriticalAngle treatment)
      : view_deg_(view_deg) {
    const double view_rad = view_deg * kDegree;
    const Vec3 viewer{-std::sin(view_rad), 0, std::max(std::cos(view_rad), 1e-9)};
    const TiltLights::Set set = lights.lights(view_deg);
    target_ = lights.colors(set, [&](const Vec3& light) {
      return light.z / kPi * brdf::reflectance_factor(map, light, viewer, treatment);
    });
    for (std::size_t m = 0; m < target_.size(); ++m) metric_.push_back(lights.metric(set, m, target_[m]));
    columns_.resize(candidates.size());
    blocks_.resize(candidates.size());
    for (std::size_t k = 0; k < candidates.size(); ++k) {
      const Candidate& candidate = candidates[k];
      const Vec3 axis = candidate.diffuse ? Vec3{0, 0, 1} : brdf::tilted_axis(candidate.lobe, view_deg);
      columns_[k] = lights.column(set, candidate.exponent, axis);
      blocks_[k] = block(k, k);
    }
  }

  double view_deg() const { return view_deg_; }
  const std::vector<color::Rgb>& target() const { return target_; }

  // Takes one more candidate, with no weight yet.
  void take(std::size_t candidate) {
    chosen_.push_back(candidate);
    weights_.push_back({});
    gram_.emplace_back();
    for (std::size_t i = 0; i < chosen_.size(); ++i) gram_.back().push_back(block(chosen_.back(), chosen_[i]));
    right_.push_back(right(candidate));
  }
  // Takes another one in the place of a chosen one. Its weight starts at 0.
  void replace(std::size_t place, std::size_t candidate) {
    chosen_[place] = candidate;
    weights_[place] = {};
    right_[place] = right(candidate);
    for (std::size_t i = 0; i < chosen_.size(); ++i) {
      const std::size_t row = std::max(i, place), column = std::min(i, place);
      gram_[row][column] = block(chosen_[row], chosen_[column]);
    }
  }
  // Coordinate descent to non-negative weights. `without` has none. With `near`, weights are drawn to those a little.
  void solve(int sweeps, std::size_t without = SIZE_MAX, const std::vector<Channels>* near = nullptr) {
    constexpr double kStill = 1e-7;
    if (without < weights_.size()) weights_[without] = {};
    for (int sweep = 0; sweep < sweeps; ++sweep) {
      double most = 0, moved = 0;
      for (std::size_t i = 0; i < chosen_.size(); ++i) {
        if (i == without) continue;
        Channels slope = right_[i];
        for (std::size_t j = 0; j < chosen_.size(); ++j) subtract(i, j, weights_[j], slope);
        const Metric& own = gram_[i][i];
        for (std::size_t c = 0; c < 3; ++c) {
          if (!(own.at(c, c) > 0)) continue;
          const double pull = near != nullptr ? kPull * own.at(c, c) : 0, before = weights_[i][c];
          const double drawn = near != nullptr ? pull * ((*near)[i][c] - before) : 0;
          const double after = std::max(0.0, before + (slope[c] + drawn) / (own.at(c, c) + pull));
          weights_[i][c] = after;
          for (std::size_t d = 0; d < 3; ++d) slope[d] -= (after - before) * own.at(c, d);
          most = std::max(most, after), moved = std::max(moved, std::abs(after - before));
        }
      }
      if (moved <= kStill * most) break;
    }
  }
  // Squared, weighted by what is seen.
  double error() const {
    double sum = 0;
    for (std::size_t m = 0; m < target_.size(); ++m) sum += metric_[m].squared(residual(m));
    return sum;
  }
  // By how much a candidate could lower that, about, if it were the only one to change.
  std::vector<double> gains() const {
    std::vector<Channels> residuals;
    for (std::size_t m = 0; m < target_.size(); ++m) residuals.push_back(metric_[m].times(residual(m)));
    std::vector<double> gains(columns_.size());
    for (std::size_t k = 0; k < columns_.size(); ++k) {
      Channels slope{};
      for (std::size_t m = 0; m < residuals.size(); ++m)
        for (std::size_t c = 0; c < 3; ++c) slope[c] += columns_[k][m] * residuals[m][c];
      gains[k] = blocks_[k].gain(slope);
    }
    return gains;
  }
  const std::vector<Channels>& weights() const { return weights_; }
  void put_weights(std::vector<Channels> weights) { weights_ = std::move(weights); }

 private:
  Metric block(std::size_t a, std::size_t b) const {
    Metric sum;
    for (std::size_t m = 0; m < metric_.size(); ++m) sum.add(columns_[a][m] * columns_[b][m], metric_[m]);
    return sum;
  }
  Channels right(std::size_t k) const {
    Channels sum{};
    for (std::size_t m = 0; m < target_.size(); ++m) {
      const Channels t = metric_[m].times({target_[m].x, target_[m].y, target_[m].z});
      for (std::size_t c = 0; c < 3; ++c) sum[c] += columns_[k][m] * t[c];
    }
    return sum;
  }
  void subtract(std::size_t i, std::size_t j, const Channels& weight, Channels& slope) const {
    if (weight == Channels{}) return;
    const Channels product = gram_[std::max(i, j)][std::min(i, j)].times(weight);
    for (std::size_t c = 0; c < 3; ++c) slope[c] -= product[c];
  }
  Channels residual(std::size_t m) const {
    Channels r = {target_[m].x, target_[m].y, target_[m].z};
    for (std::size_t i = 0; i < chosen_.size(); ++i)
      for (std::size_t c = 0; c < 3; ++c) r[c] -= columns_[chosen_[i]][m] * weights_[i][c];
    return r;
  }

  double view_deg_;
  std::vector<color::Rgb> target_;  // the color in each light
  std::vector<Metric> metric_;
  std::vector<std::vector<float>> columns_;  // of each candidate: what a weight of 1 shows in each light
  std::vector<Metric> blocks_;
  std::vector<std::size_t> chosen_;
  std::vector<Channels> weights_, right_;
  std::vector<std::vector<Metric>> gram_;  // lower triangle, symmetric blocks
};

// All views, which share the lobes and differ in their weights.
class TiltSearch {
 public:
  TiltSearch(const brdf::ColorMap& map, const std::vector<double>& exponents, const TiltOptions& options)
      : lights_(exponents), candidates_(candidates_of(exponents)), map_(map), options_(options) {
    std::vector<std::unique_ptr<View>> made(kViews_deg.size());
    parallel_for(kViews_deg.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v)
        made[v] = std::make_unique<View>(kViews_deg[v], lights_, candidates_, map, options.treatment);
    });
    views_ = std::move(made);
    take(0);
    for (std::size_t k = 1; k < candidates_.size(); ++k) {
      const paint::TiltedLobe& lobe = candidates_[k].lobe;
      if (lobe.tilt_deg == 0 && lobe.out_deg == 0 && lobe.exponent <= kSharpestKept) take(k);
    }
    kept_ = chosen_.size();
  }

  // Mean color difference over the lights, at the views and half-way between them.
  double error_of(const std::function<color::Rgb(const Vec3& light, double view_deg)>& model) const {
    constexpr std::size_t kBetween = kViews_deg.size() - 1;
    std::vector<double> errors(kBetween);
    parallel_for(kBetween, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v) {
        const double view_deg = 0.5 * (kViews_deg[v] + kViews_deg[v + 1]), view_rad = view_deg * kDegree;
        const Vec3 viewer{-std::sin(view_rad), 0, std::cos(view_rad)};
        const TiltLights::Set set = lights_.lights(view_deg);
        const auto truth = lights_.colors(set, [&](const Vec3& light) {
          return light.z / kPi * brdf::reflectance_factor(map_, light, viewer, options_.treatment);
        });
        errors[v] = lights_.mean_difference(
            set, truth, lights_.colors_all(set, [&](const Vec3& light) { return model(light, view_deg); }));
      }
    });
    // Pictures of round bodies show a view in proportion to sin cos.
    double sum = 0, weights = 0;
    for (std::size_t v = 0; v < kBetween; ++v) {
      const double weight =
          std::pow(std::sin(kViews_deg[v + 1] * kDegree), 2) - std::pow(std::sin(kViews_deg[v] * kDegree), 2);
      sum += weight * errors[v], weights += weight;
    }
    return sum / weights;
  }

  // Takes lobes as long as there are look-ups left for them, and then looks for better ones in the place of each.
  void grow_to(int lookups) {
    far_too_ = lookups >= kManyLookups;
    while (true) {
      const std::size_t best = best_candidate(lookups - this->lookups());
      if (best == 0) break;
      take(best);
    }
    constexpr int kRounds = 2;
    for (int round = 0; round < kRounds; ++round) {
      bool changed = false;
      for (std::size_t place = kept_; place < chosen_.size(); ++place) changed = improved(place) || changed;
      if (!changed) break;
    }
  }

  int lookups() const {
    int sum = 0;
    for (const std::size_t k : chosen_) sum += candidates_[k].diffuse ? 0 : candidates_[k].lobe.lookups();
    return sum;
  }

  paint::TiltedLobes set() const {
    paint::TiltedLobes set;
    for (std::size_t i = 1; i < chosen_.size(); ++i) set.lobes.push_back(candidates_[chosen_[i]].lobe);
    for (const View& solved : smoothed()) {
      const auto rgb = [&](std::size_t i, double scale) {
        const Channels& w = solved.weights()[i];
        return color::Rgb{rounded(scale * w[0]), rounded(scale * w[1]), rounded(scale * w[2])};
      };
      paint::TiltedView& of = set.views.emplace_back();
      of.view_deg = solved.view_deg();
      of.diffuse = rgb(0, 1 / kPi);
      for (std::size_t i = 1; i < chosen_.size(); ++i) of.weights.push_back(rgb(i, 1));
    }
    set.mean_de00 = rounded(
        error_of([&](const Vec3& light, double view_deg) { return brdf::reflected_part(set, light, view_deg); }));
    return set;
  }

 private:
  // To 5 significant digits, so that files stay short; weights below a visible size are 0 and take no look-up.
  static double rounded(double value) {
    constexpr double kUnseen = 1e-5;
    if (!(value > kUnseen)) return 0;
    const double scale = std::pow(10.0, 4 - std::floor(std::log10(value)));
    return std::round(value * scale) / scale;
  }

  // The views with their final weights.
  std::vector<View> smoothed() const {
    std::vector<View> views;
    for (const auto& view : views_) views.push_back(*view);
    for (int round = 0; round < kPullRounds; ++round) {
      std::vector<std::vector<Channels>> near(views.size());
      for (std::size_t v = 0; v < views.size(); ++v) {
        const auto &low = views[v > 0 ? v - 1 : 1].weights(),
                   &high = views[v + 1 < views.size() ? v + 1 : v - 1].weights();
        for (std::size_t i = 0; i < low.size(); ++i) {
          near[v].push_back({});
          for (std::size_t c = 0; c < 3; ++c) near[v][i][c] = 0.5 * (low[i][c] + high[i][c]);
        }
      }
      parallel_for(views.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t v = begin; v < end; ++v) views[v].solve(kFinalSweeps, SIZE_MAX, &near[v]);
      });
    }
    return views;
  }

  template <class Each>
  void for_views(const Each& each) {
    parallel_for(views_.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v) each(*views_[v]);
    });
  }
  double error() const {
    std::vector<double> errors(views_.size());
    parallel_for(views_.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v) errors[v] = views_[v]->error();
    });
    double sum = 0;
    for (const double error : errors) sum += error;
    return sum;
  }
  void take(std::size_t candidate) {
    chosen_.push_back(candidate);
    for_views([&](View& view) {
      view.take(candidate);
      view.solve(kSweeps);
    });
  }
  // The candidate of so many look-ups or fewer that gains most for each; 0: none gains.
  std::size_t best_candidate(int lookups) const {
    std::vector<std::vector<double>> gains(views_.size());
    parallel_for(views_.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v) gains[v] = views_[v]->gains();
    });
    std::size_t best = 0;
    double most = 0;
    for (std::size_t k = 1; k < candidates_.size(); ++k) {
      const int count = candidates_[k].lobe.lookups();
      if (count > lookups || (candidates_[k].far && !far_too_)) continue;
      if (std::ranges::find(chosen_, k) != chosen_.end()) continue;
      double gain = 0;
      for (const std::vector<double>& of : gains) gain += of[k] / count;
      if (gain > most) most = gain, best = k;
    }
    return best;
  }
  // True if another candidate serves better in the place of a chosen one, which it then takes.
  bool improved(std::size_t place) {
    const double before = error();
    const std::size_t old = chosen_[place];
    std::vector<std::vector<Channels>> weights;
    for (const auto& view : views_) weights.push_back(view->weights());
    for_views([&](View& view) { view.solve(kSweeps, place); });
    chosen_[place] = 0;
    const std::size_t best = best_candidate(candidates_[old].lobe.lookups());
    if (best != 0 && best != old) {
      chosen_[place] = best;
      for_views([&](View& view) {
        view.replace(place, best);
        view.solve(kSweeps);
      });
      if (error() < (1 - 1e-4) * before) return true;
      for_views([&](View& view) { view.replace(place, old); });
    }
    chosen_[place] = old;
    for (std::size_t v = 0; v < views_.size(); ++v) views_[v]->put_weights(weights[v]);
    return false;
  }

  TiltLights lights_;
  std::vector<Candidate> candidates_;
  const brdf::ColorMap& map_;
  const TiltOptions& options_;
  std::vector<std::unique_ptr<View>> views_;
  std::vector<std::size_t> chosen_;
  std::size_t kept_ = 0;  // of these, that are never replaced
  bool far_too_ = false;  // whether candidates that are far may be taken
};

}  // namespace

TiltFit fit_tilts(const brdf::ColorMap& map, const paint::LobeFit& lobes, const formats::Basis& basis,
                  const TiltOptions& options) {
  TiltFit fit;
  const std::vector<double> exponents = tilted_exponents(basis);
  if (map.aspecular || options.lookups.empty() || exponents.empty()) return fit;
  TiltSearch search(map, exponents, options);
  paint::LobeFit flake = lobes;
  const auto bare = [](std::vector<paint::Lobe>& of) {
    for (paint::Lobe& lobe : of) lobe.gloss = {};
  };
  bare(flake.lobes);
  for (paint::ViewLobes& view : flake.views) bare(view.lobes);
  fit.lobes_de00 = search.error_of([&](const Vec3& light, double view_deg) {
    const double view_rad = view_deg * kDegree;
    const Vec3 viewer{-std::sin(view_rad), 0, std::cos(view_rad)};
    return std::max(0.0, light.z) * brdf::brdf(flake, light, viewer, {0, 0, 1});
  });
  if (fit.lobes_de00 < kVisible_de00) return fit;
  double least = fit.lobes_de00;
  for (const int lookups : options.lookups) {
    search.grow_to(lookups);
    paint::TiltedLobes set = search.set();
    if (set.mean_de00 > (1 - kWorthwhile) * least) continue;
    least = set.mean_de00;
    fit.sets.push_back(std::move(set));
  }
  return fit;
}

}  // namespace goniochrome::fit
