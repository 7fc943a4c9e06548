#include "prefilter/prefilter.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "base/angles.h"
#include "base/clock.h"
#include "base/parallel.h"
#include "prefilter/exact_lobe.h"
#include "prefilter/internal/bright_texels.h"
#include "prefilter/internal/harmonic_grid.h"
#include "prefilter/internal/harmonics.h"
#include "prefilter/internal/horizon_band.h"
#include "prefilter/internal/local_sums.h"
#include "prefilter/internal/mirror.h"
#include "prefilter/internal/prefilter_cost.h"
#include "prefilter/lobe_tree.h"

namespace goniochrome::prefilter {

namespace {

// The highest degree of harmonics. At the degree L their grid and its rows take 24 bytes at 4 L x 2 L samples and 48 at
// 2 L x L, which are 288 L^2 bytes: 300 MB here.
constexpr int kMostDegree = 1024;
// The degree of harmonics for lobes whose kernel bends at its edge. On two measured rooms at a tolerance of 1e-4, of
// 384 texels of the diffuse lobe the bound left 102 to be done once more at degree 128, 21 at 256 and none at 512; 1024
// took twice the time of 512 at 1e-3.
constexpr int kWideDegree = 512;
// Such lobes have exponents below this. Down to a tolerance of 1e-6, plain harmonics need 280 degrees for 5.3 and 28
// for 19, and fail again beyond 1e4, where the lobe is sharp and not bent.
constexpr double kSharpestWide = 20;
// The tolerance below which kWideDegree degrees do not serve exponent 1. In one room the bound left 4 of 384 texels at
// 5e-5, 49 at 2e-5 and 77 at 1e-5; in another 0, 0 and 10.
constexpr double kBent = 2e-5;
// The tolerance above which such harmonics serve exponents below 1. For 0.3 the bound left 14 of 96 texels at 1e-3, 16
// at 5e-4 and 48 at 2e-4, each to be done by blocks.
constexpr double kFlatLobes = 5e-4;
// The tolerance up to which bands beside the horizon take their place, where the map has rows. For 0 at 1e-2 the bound
// left 412 of 6144 texels in one of five measured maps, and for 0.3 at 1e-4 between 240 and all of them.
constexpr double kBands = 2e-2;
// Radians: larger texels are cut. BrightTexels takes t as linear over a texel of radius r that the edge cuts, and errs
// by r/5 of what the texel adds there, which at this size is 0.4 % of 2 % of its flux for exponent 1.
constexpr double kFlatTexel = 0.03;
// The tolerance that bands beside the horizon keep on texels so large. Their error falls with the square of the texel:
// on white noise it was 8e-7 of the mean with texels of 0.025 rad.
constexpr double kFlatBand = 1e-5;
// Texels along a face of the cube that finds the darkest texels, 7.5 deg each where a lobe of exponent 20 is 26 deg
// wide. They choose the degree alone; a texel that is darker still is done once more.
constexpr int kSketch = 12;
// The rounding of a half float: 11 bits of fraction.
constexpr double kHalfError = 0x1p-11;
// The part of the bound on what harmonics leave out that maps reach; see WideLobe.
constexpr double kCoherence = 1.0 / 16;

// The largest error of what a band leaves out, over its root mean square. In two measured maps at 600 directions it was
// 4 to 10, whatever the width of the band.
constexpr double kPeak = 16;
// Texels below this part of the mean do not say how wide the band beside the horizon of all others is.
constexpr double kDark = 0.03;

using Method = LobePlan::Method;

// The error that the method may have: the tolerance less the rounding of the file.
double method_tolerance(double tolerance) {
  return tolerance >= 2 * kHalfError * 0.999 ? tolerance - kHalfError : tolerance * (1 - 1.0 / 64);
}

double rounding_error(double tolerance) {
  return tolerance - method_tolerance(tolerance);
}

double lookup_error(double exponent, int size) {
  const double h = kPi / (2 * size);
  return std::max(exponent, 1.0) * h * h / 8;
}

// The size that is as fine as the environment at its middle.
int mirror_size(const envmap::Environment& env) {
  if (env.grid().is_cube()) return env.width();
  return std::clamp((env.width() + 3) / 4, 16, 2048);
}

LobePlan lobe_plan(const envmap::Environment& env, const PrefilterRequest& request, KernelPointer kernel, int size) {
  LobePlan plan;
  plan.exponent = kernel->exponent();
  plan.kernel = std::move(kernel);
  plan.size = size > 0 ? size : own_size(plan.exponent, request.tolerance);
  plan.lookup_error = lookup_error(plan.exponent, plan.size);
  const double tolerance = method_tolerance(request.tolerance);
  // Half of the method's share goes to the degrees left out, relative to the floor.
  plan.degree = sufficient_degree(*plan.kernel, 0.5 * tolerance * kErrorFloor, kMostDegree);
  plan.predicted_error = rounding_error(request.tolerance) + tolerance;
  if (plan.degree >= 0) return plan;
  plan.degree = 0;
  const bool bent = plan.exponent < 1 ? tolerance <= kBands : plan.exponent == 1 && tolerance < kBent;
  if (bent && dynamic_cast<const CosineKernel*>(plan.kernel.get()) && HorizonBand::serves(env)) {
    plan.method = Method::kHorizon;
    plan.degree = kWideDegree;
  } else if (plan.kernel->edge().exists() && (plan.exponent >= 1 || tolerance > kFlatLobes) &&
             plan.exponent < kSharpestWide) {
    plan.method = Method::kBrightHarmonics;
    plan.degree = kWideDegree;
  } else {
    plan.method = LocalSums::serve(env, *plan.kernel, tolerance) ? Method::kLocal : Method::kBlocks;
  }
  return plan;
}

// The residual of a clipped map after the harmonics up to each degree: its root mean square, per channel, by Parseval.
std::vector<Vec3> residual_rms(const envmap::Environment& env, const envmap::Clip& clip, const Harmonics& harmonics) {
  std::vector<Vec3> rows(static_cast<std::size_t>(env.height()));
  const envmap::SolidAngles solid_angles(env.grid());
  parallel_for(rows.size(), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row) {
      const int y = static_cast<int>(row);
      for (int column = 0; column < env.width(); ++column) {
        const std::array<float, 3> rgb = clip.left_of(env.radiance(column, y));
        const Vec3 value = {rgb[0], rgb[1], rgb[2]};
        rows[row] += solid_angles.at(column, y) * (value * value);
      }
    }
  });
  std::vector<Vec3> left(static_cast<std::size_t>(harmonics.degree) + 1);
  for (int m = 0; m <= harmonics.degree; ++m) {
    const double* a = harmonics.order(m);
    for (int l = m; l <= harmonics.degree; ++l, a += 6)
      for (int c = 0; c < 3; ++c) left[l][c] -= (m == 0 ? 1 : 2) * (a[c] * a[c] + a[3 + c] * a[3 + c]);
  }
  Vec3 square;
  for (const Vec3& row : rows) square += row;
  for (Vec3& value : left) {
    square += value;
    for (int c = 0; c < 3; ++c) value[c] = std::sqrt(std::max(0.0, square[c]) / (4 * kPi));
  }
  return left;
}

float largest_value(const envmap::Environment& env) {
  float most = 0;
  for (int row = 0; row < env.height(); ++row) {
    const float* rgb = env.radiance(0, row);
    most = std::max(most, *std::max_element(rgb, rgb + 3 * static_cast<std::size_t>(env.width())));
  }
  return most;
}

// Data that the lobes of a plan share: harmonics, bright texels, the tree of blocks, angles. Each of them is made when
// the first lobe asks for it.
class Workshop {
 public:
  Workshop(const envmap::Environment& env, const PrefilterRequest& request, const std::vector<LobePlan>& plan)
      : env_(env),
        turn_(request.turn),
        layout_(request.layout),
        flux_(env.flux()),
        largest_(largest_value(env)),
        band_texel_(kFlatTexel * std::min(1.0, std::sqrt(request.tolerance / kFlatBand))) {
    for (const LobePlan& lobe : plan) {
      if (lobe.method == Method::kHarmonics && lobe.degree > degree_) degree_ = lobe.degree, sharpest_ = lobe.kernel;
      if ((lobe.method == Method::kBrightHarmonics || lobe.method == Method::kHorizon) &&
          (!widest_ || lobe.exponent < widest_->exponent()))
        widest_ = lobe.kernel;  // its k_l are the largest
    }
  }

  const Vec3& flux() const { return flux_; }
  float largest() const { return largest_; }
  const Harmonics& harmonics() {
    if (!harmonics_) harmonics_.emplace(harmonics_of(env_, sharpest_->multipliers(degree_)));
    return *harmonics_;
  }
  const LocalSums& local() {
    if (!local_) local_.emplace(env_);
    return *local_;
  }
  const LobeTree& tree() {
    if (!tree_) tree_.emplace(fine());
    return *tree_;
  }
  const BrightTexels& bright() {
    if (!bright_) bright_ = std::make_unique<BrightTexels>(fine(), kMostBright);
    return *bright_;
  }
  const Harmonics& rest() {
    if (!rest_) rest_.emplace(harmonics_of(fine(), widest_->multipliers(kWideDegree), bright().rest()));
    return *rest_;
  }
  const std::vector<Vec3>& rest_rms() {
    if (rest_rms_.empty()) rest_rms_ = residual_rms(fine(), bright().rest(), rest());
    return rest_rms_;
  }
  const HorizonBand& band() {
    if (!band_) band_.emplace(env_.cut_to(band_texel_), bright().rest());
    return *band_;
  }
  // The environment, its texels cut where they are large.
  const envmap::Environment& fine() {
    if (env_.largest_texel_rad() <= kFlatTexel) return env_;
    if (!fine_) fine_.emplace(env_.cut_to(kFlatTexel));
    return *fine_;
  }
  const envmap::Environment& environment() const { return env_; }
  envmap::SphereGrid grid(int size) const { return envmap::map_grid(layout_, size); }
  const GridAngles& angles(int size) {
    if (size != angles_size_) angles_.emplace(grid(size), turn_);
    angles_size_ = size;
    return *angles_;
  }
  const envmap::Rotation& turn() const { return turn_; }
  // Directions of the texels of a size, row by row, in the environment's frame.
  std::vector<Vec3> directions(int size) const {
    const envmap::SphereGrid texels = grid(size);
    const std::size_t width = static_cast<std::size_t>(texels.width());
    std::vector<Vec3> all(width * static_cast<std::size_t>(texels.height()));
    parallel_for(all.size(), 1 << 12, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        all[i] = turn_.to_environment(texels.direction(static_cast<int>(i % width), static_cast<int>(i / width)));
    });
    return all;
  }

 private:
  const envmap::Environment& env_;
  std::optional<envmap::Environment> fine_;
  envmap::Rotation turn_;
  envmap::SphereGrid::Layout layout_;
  Vec3 flux_;
  float largest_;
  double band_texel_;
  int degree_ = -1, angles_size_ = 0;
  KernelPointer sharpest_, widest_;
  std::optional<Harmonics> harmonics_, rest_;
  std::vector<Vec3> rest_rms_;
  std::optional<LobeTree> tree_;
  std::optional<LocalSums> local_;
  std::unique_ptr<BrightTexels> bright_;
  std::optional<HorizonBand> band_;
  std::optional<GridAngles> angles_;
};

// The texels of a grid, in parallel: body(direction in the environment's frame, rgb).
template <class Body>
void for_each_texel(const envmap::SphereGrid& grid, const envmap::Rotation& turn, std::vector<float>& values,
                    const Body& body) {
  const std::size_t width = static_cast<std::size_t>(grid.width());
  parallel_for(values.size() / 3, 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      body(turn.to_environment(grid.direction(static_cast<int>(i % width), static_cast<int>(i / width))),
           &values[3 * i]);
  });
}

// The share of a lobe that local sums leave out: a tenth of the tolerance at the floor, were it the brightest texel's.
double left_out_by_local_sums(const Vec3& flux, double most, double tolerance) {
  const double mean = std::max({flux.x, flux.y, flux.z}) / (4 * kPi);
  return 0.1 * tolerance * kErrorFloor * kErrorFloor * (mean > 0 ? std::min(1.0, mean / most) : 1);
}

// How many taps keep the interpolation below a tenth of the tolerance at the floor: the largest value of a lobe map is
// at most that of the environment and of all its flux in the middle of the lobe.
int taps(const Vec3& flux, double most, const ZonalKernel& kernel, double tolerance) {
  const double mean = std::max({flux.x, flux.y, flux.z}) / (4 * kPi);
  if (!(mean > 0)) return taps_for(1);
  const double peak = std::min(most / mean, 4 * kPi * kernel.scale());
  return taps_for(0.1 * tolerance * kErrorFloor / std::max(peak, 1.0));
}

// A lobe whose kernel bends at its edge: harmonics of the rest to the degree that the darkest texels need, and the
// bright texels one by one.
//
// The error of harmonics beyond a degree is, by Cauchy and Schwarz, at most norm_beyond() of the kernel times
// residual_rms() of the map, reached only by a map whose every degree peaks in phase at one point. Maps come nowhere
// near: the worst texels of measured maps reach a thirtieth to a fiftieth of it, so a sixteenth is allowed for. A texel
// that could be off by more than its tolerance all the same (it is dark, or the map is black and white) is done by
// blocks.
class WideLobe {
 public:
  WideLobe(const LobePlan& plan, double tolerance, Workshop& shop)
      : plan_(plan), tolerance_(tolerance), shop_(shop), mean_((1 / (4 * kPi)) * shop.flux()) {}

  std::vector<float> values() {
    const Vec3 darkest = darkest_value();
    if (plan_.method == Method::kHorizon) return with_band(darkest);
    const std::vector<int> degrees = {64, 96, 128, 192, 256, 384, kWideDegree};
    Vec3 bound;
    int degree = 0;
    for (const int candidate : degrees) {
      degree = candidate;
      bound = kCoherence * plan_.kernel->norm_beyond(degree) * shop_.rest_rms()[degree];
      if (fits(0.9 * darkest, bound)) break;
    }
    std::vector<float> texels =
        sum(plan_.kernel->multipliers(degree), shop_.grid(plan_.size), shop_.angles(plan_.size));
    patch_up(texels, bound);
    return texels;
  }

 private:
  // The darkest value of each channel, on the coarse cube.
  Vec3 darkest_value() {
    const envmap::SphereGrid coarse(envmap::SphereGrid::Layout::kCube, kSketch, 6 * kSketch);
    const std::vector<float> sketch = sum(plan_.kernel->multipliers(32), coarse, GridAngles(coarse, shop_.turn()));
    Vec3 darkest = {1e300, 1e300, 1e300};
    for (std::size_t i = 0; i < sketch.size(); ++i) {
      double& channel = darkest[static_cast<int>(i % 3)];
      channel = std::min<double>(channel, sketch[i]);
    }
    return darkest;
  }

  // Harmonics of the smooth part of the kernel, and the band beside the horizon, which is as narrow as the darkest
  // texels allow. Texels that are much darker than the mean get the widest band instead.
  std::vector<float> with_band(const Vec3& darkest) {
    Vec3 wanted;
    for (int c = 0; c < 3; ++c) wanted[c] = allowed(std::max(0.9 * darkest[c], kDark * mean_[c]), c) / kPeak;
    const CosineKernel kernel(plan_.exponent);
    const HorizonBand& band = shop_.band();
    const HorizonParts narrow(kernel, shop_.rest_rms(), wanted, band.side_rad());
    const HorizonParts wide(kernel, shop_.rest_rms(), {}, band.side_rad());
    const envmap::SphereGrid grid = shop_.grid(plan_.size);
    std::vector<float> texels = sum(narrow.multipliers(), grid, shop_.angles(plan_.size));
    const std::vector<Vec3> directions = shop_.directions(plan_.size);
    const auto smooth = [&](std::size_t i) { return Vec3{texels[3 * i], texels[3 * i + 1], texels[3 * i + 2]}; };
    const std::vector<Vec3> sums = band.sums(directions, narrow.band());
    std::vector<Vec3> values(directions.size()), dark_directions;
    std::vector<std::size_t> dark;
    for (std::size_t i = 0; i < values.size(); ++i) {
      values[i] = smooth(i) + kernel.scale() * sums[i];
      if (!fits(values[i], kPeak * narrow.left_out())) dark.push_back(i), dark_directions.push_back(directions[i]);
    }
    const std::vector<Vec3> wider = band.sums(dark_directions, wide.band());
    for (std::size_t i = 0; i < dark.size(); ++i) values[dark[i]] = smooth(dark[i]) + kernel.scale() * wider[i];
    for (std::size_t i = 0; i < values.size(); ++i)
      for (int c = 0; c < 3; ++c) texels[3 * i + c] = static_cast<float>(std::max(0.0, values[i][c]));
    Vec3 least;
    for (int c = 0; c < 3; ++c) least[c] = kPeak * std::min(narrow.left_out()[c], wide.left_out()[c]);
    patch_up(texels, least);
    return texels;
  }

  // The error that a texel of that value may have in a channel.
  double allowed(double value, int channel) const {
    const double gray = kErrorFloor * kErrorFloor * std::max({mean_.x, mean_.y, mean_.z});
    return 0.8 * tolerance_ * std::max({value, kErrorFloor * mean_[channel], gray});
  }

  bool fits(const Vec3& value, const Vec3& bound) const {
    for (int c = 0; c < 3; ++c)
      if (bound[c] > allowed(value[c], c)) return false;
    return true;
  }

  // The bright texels at d, beside what the rest gives there.
  Vec3 bright_lobe(const Vec3& d, const Vec3& rest) {
    double most = 1e300;
    for (int c = 0; c < 3; ++c) most = std::min(most, allowed(rest[c], c));
    return shop_.bright().lobe(d, *plan_.kernel, 0.1 * most);
  }

  // By harmonics of the given multipliers, and the bright texels.
  std::vector<float> sum(const std::vector<double>& k, const envmap::SphereGrid& grid, const GridAngles& angles) {
    std::vector<float> texels =
        lobe_values(shop_.rest(), k, angles, taps(shop_.flux(), shop_.largest(), *plan_.kernel, tolerance_));
    if (shop_.bright().count() > 0)
      for_each_texel(grid, shop_.turn(), texels, [&](const Vec3& d, float* rgb) {
        const Vec3 extra = bright_lobe(d, vec3(rgb));
        for (int c = 0; c < 3; ++c) rgb[c] += static_cast<float>(extra[c]);
      });
    return texels;
  }

  // The texels that the bound does not serve, once more.
  void patch_up(std::vector<float>& texels, const Vec3& bound) {
    std::vector<std::size_t> unfit;
    for (std::size_t i = 0; i < texels.size() / 3; ++i)
      if (!fits({texels[3 * i], texels[3 * i + 1], texels[3 * i + 2]}, bound)) unfit.push_back(i);
    if (!unfit.empty()) one_by_one(unfit, texels);
  }

  void one_by_one(const std::vector<std::size_t>& chosen, std::vector<float>& texels) {
    const envmap::SphereGrid grid = shop_.grid(plan_.size);
    const std::size_t width = static_cast<std::size_t>(grid.width());
    std::vector<Vec3> directions;
    for (const std::size_t i : chosen)
      directions.push_back(
          shop_.turn().to_environment(grid.direction(static_cast<int>(i % width), static_cast<int>(i / width))));
    const LobeTree& tree = shop_.tree();
    parallel_for(chosen.size(), 256, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const Vec3 value = tree.lobe(directions[i], *plan_.kernel, tolerance_);
        for (int c = 0; c < 3; ++c) texels[3 * chosen[i] + c] = static_cast<float>(std::max(0.0, value[c]));
      }
    });
  }

  const LobePlan& plan_;
  double tolerance_;
  Workshop& shop_;
  Vec3 mean_;
};

bool is_named_by_exponent(const LobePlan& plan) {
  return !plan.kernel || dynamic_cast<const CosineKernel*>(plan.kernel.get());
}

std::vector<float> local_lobe(const LobePlan& plan, double tolerance, Workshop& shop) {
  const std::vector<Vec3> directions = shop.directions(plan.size);
  const std::vector<Vec3> lobe = shop.local().lobe(directions, CosineKernel(plan.exponent),
                                                   left_out_by_local_sums(shop.flux(), shop.largest(), tolerance));
  std::vector<float> values;
  values.reserve(3 * lobe.size());
  for (const Vec3& value : lobe)
    for (int c = 0; c < 3; ++c) values.push_back(static_cast<float>(value[c]));
  return values;
}

std::vector<float> lobe_by_plan(const LobePlan& plan, double tolerance, Workshop& shop) {
  switch (plan.method) {
    case Method::kMirror:
      return mirror_values(shop.environment(), shop.grid(plan.size), shop.turn());
    case Method::kHarmonics:
      return lobe_values(shop.harmonics(), plan.kernel->multipliers(plan.degree), shop.angles(plan.size),
                         taps(shop.flux(), shop.largest(), *plan.kernel, tolerance));
    case Method::kBrightHarmonics:
    case Method::kHorizon:
      return WideLobe(plan, tolerance, shop).values();
    case Method::kLocal:
      return local_lobe(plan, tolerance, shop);
    case Method::kBlocks:
      break;
  }
  const envmap::SphereGrid grid = shop.grid(plan.size);
  std::vector<float> values(3 * static_cast<std::size_t>(grid.width()) * grid.height());
  const LobeTree& tree = shop.tree();
  for_each_texel(grid, shop.turn(), values, [&](const Vec3& d, float* rgb) {
    const Vec3 value = tree.lobe(d, *plan.kernel, tolerance);
    for (int c = 0; c < 3; ++c) rgb[c] = static_cast<float>(value[c]);
  });
  return values;
}

}  // namespace

std::vector<double> filter_exponents(std::vector<double> exponents, bool diffuse) {
  std::ranges::sort(exponents);
  exponents.erase(std::unique(exponents.begin(), exponents.end()), exponents.end());
  if (diffuse) std::erase(exponents, 1.0);
  return exponents;
}

const char* method_name(Method method) {
  switch (method) {
    case Method::kHarmonics:
      return "harmonics";
    case Method::kBrightHarmonics:
      return "harmonics+bright";
    case Method::kHorizon:
      return "harmonics+horizon";
    case Method::kLocal:
      return "local sums";
    case Method::kBlocks:
      return "blocks";
    case Method::kMirror:
      return "overlaps";
  }
  return "";
}

// Bilinear lookup between texels 2/N apart errs by E h^2/8 with h = pi/(2N): the face that keeps ten times the
// tolerance. goniochrome-prefiltering(7), "Lookup".
int own_size(double exponent, double tolerance) {
  const double wanted = kPi / 2 * std::sqrt(std::max(exponent, 1.0) / (8 * 10 * tolerance));
  const int least = exponent < 8 ? 32 : 16;  // kinks of a wide lobe at the horizon of a sun
  return std::clamp((static_cast<int>(std::ceil(wanted)) + 3) / 4 * 4, least, 1024);
}

std::vector<LobePlan> prefilter_plan(const envmap::Environment& env, const PrefilterRequest& request) {
  std::vector<LobePlan> plan;
  const auto add = [&](KernelPointer kernel, int size) {
    plan.push_back(lobe_plan(env, request, std::move(kernel), size));
  };
  if (request.diffuse) add(std::make_shared<CosineKernel>(1), request.size);
  for (std::size_t i = 0; i < request.exponents.size(); ++i)
    add(std::make_shared<CosineKernel>(request.exponents[i]), request.sizes.empty() ? request.size : request.sizes[i]);
  for (const KernelPointer& kernel : request.kernels) add(kernel, request.size);
  if (request.mirror) {
    LobePlan mirror;
    mirror.exponent = paint::kMirrorExponent;
    mirror.method = Method::kMirror;
    mirror.size = request.size > 0 ? request.size : mirror_size(env);
    mirror.predicted_error = rounding_error(request.tolerance);
    plan.push_back(mirror);
  }
  predict_times(env, request, plan);
  return plan;
}

envmap::PrefilteredEnvironment prefiltered(
    const envmap::Environment& env, const PrefilterRequest& request, const std::vector<LobePlan>& plan,
    const std::function<void(const envmap::PrefilteredLobe&, double time_s)>& done, const LobeSource& known) {
  envmap::PrefilteredEnvironment result;
  result.source = env.source();
  result.mirror.exponent = paint::kMirrorExponent;
  const double tolerance = method_tolerance(request.tolerance);
  std::vector<std::optional<envmap::PrefilteredLobe>> there(plan.size());
  std::vector<LobePlan> missing;
  for (std::size_t i = 0; i < plan.size(); ++i) {
    if (known && is_named_by_exponent(plan[i])) there[i] = known(plan[i]);
    if (!there[i]) missing.push_back(plan[i]);
  }
  Workshop shop(env, request, missing);
  for (std::size_t i = 0; i < plan.size(); ++i) {
    const Stopwatch clock;
    envmap::PrefilteredLobe lobe;
    if (there[i]) {
      lobe = std::move(*there[i]);
      lobe.tolerance = request.tolerance;
    } else {
      lobe.exponent = plan[i].exponent;
      lobe.layout = request.layout;
      lobe.tolerance = request.tolerance;
      lobe.predicted_error = plan[i].predicted_error;
      lobe.lookup_error = plan[i].lookup_error;
      lobe.method = method_name(plan[i].method);
      lobe.map.size = plan[i].size;
      lobe.map.texels = lobe_by_plan(plan[i], tolerance, shop);
      envmap::round_to_storage(lobe);
    }
    done(lobe, clock.elapsed_s());
    if (i == 0 && request.diffuse)
      result.diffuse = std::move(lobe);
    else if (plan[i].method == Method::kMirror)
      result.mirror = std::move(lobe);
    else
      result.lobes.push_back(std::move(lobe));
  }
  result.spots = envmap::bright_spots(env, request.spots);
  for (envmap::Spot& spot : result.spots) spot.direction = request.turn.to_world(spot.direction);
  return result;
}

double energy_ratio(const Vec3& flux, const envmap::PrefilteredLobe& lobe) {
  const envmap::SphereGrid grid = envmap::map_grid(lobe.layout, lobe.map.size);
  const envmap::SolidAngles solid_angles(grid);
  std::vector<Vec3> sums(static_cast<std::size_t>(grid.height()));
  parallel_for(sums.size(), 8, [&](std::size_t begin, std::size_t end) {
    const std::size_t width = static_cast<std::size_t>(grid.width());
    for (std::size_t row = begin; row < end; ++row)
      for (std::size_t column = 0; column < width; ++column) {
        sums[row] += solid_angles.at(static_cast<int>(column), static_cast<int>(row)) *
                     vec3(&lobe.map.texels[3 * (row * width + column)]);
      }
  });
  Vec3 sum;
  for (const Vec3& row : sums) sum += row;
  const double all = flux.x + flux.y + flux.z;
  return all > 0 ? (sum.x + sum.y + sum.z) / all : 1;
}

}  // namespace goniochrome::prefilter
