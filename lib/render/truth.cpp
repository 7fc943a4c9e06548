#include "render/truth.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/clock.h"
#include "base/parallel.h"
#include "render/internal/seen.h"
#include "render/path/noise.h"
#include "render/path/point_transport.h"
#include "render/path/ray_correction.h"
#include "render/path/visible_surface.h"
#include "render/picture_error.h"
#include "render/scene_effects.h"

namespace goniochrome::render {

namespace {

constexpr int kFirst = 16;        // batches of a point
constexpr int kBareBatches = 64;  // without the floor, which tell its worth and are no part of the truth
// Points whose noise is still above what is allowed are traced on, with a fifth more than they seem to need.
constexpr int kMoreRounds = 8;
constexpr double kSpare = 1.2;
// The part of the difference that the truth's own error may be, and the noise below which nobody sees any.
constexpr double kPart = 0.1, kUnseen = 0.02;
// The part of the tolerance: a verdict needs no less.
constexpr double kPartOfTolerance = 0.05;

// Independent batches, added one after the other.
struct PointTruth {
  LightShares deterministic, sum;
  LightShares even;  // the sum of every second batch
  Estimates batches;
  bool certain = false;

  void add(const LightShares& batch) {
    if (batches.count() % 2 == 0) even += batch;
    sum += batch;
    batches.add(batch.sum());
  }
  LightShares mean() const {
    LightShares result = deterministic;
    if (batches.count() > 0) result += (1.0 / batches.count()) * sum;
    return result;
  }
  // The mean of every second batch, and of the others; nothing of fewer than two batches.
  std::array<LightShares, 2> halves() const {
    LightShares odd = sum;
    odd += -1.0 * even;
    const int count = batches.count();
    std::array<LightShares, 2> result = {(1.0 / std::max(1, (count + 1) / 2)) * even,
                                         (1.0 / std::max(1, count / 2)) * odd};
    for (LightShares& half : result) half += deterministic;
    return result;
  }
  // The covariance of that mean.
  Covariance covariance() const {
    Covariance result = batches.covariance();
    for (double& value : result) value /= std::max(1, batches.count());
    return result;
  }
};

// The difference of two estimates, less the mean contribution of their noise: goniochrome-plan(7), "Effects of rays".
// `difference` takes the shares of both.
template <class Difference>
double noiseless(const PointTruth& a, const PointTruth& b, const Difference& difference) {
  const auto squared = [&](const LightShares& of_a, const LightShares& of_b) {
    const double d = difference(of_a, of_b);
    return d * d;
  };
  const double whole = squared(a.mean(), b.mean());
  if (std::max(a.batches.count(), b.batches.count()) < 2) return std::sqrt(whole);
  const auto halves_a = a.halves(), halves_b = b.halves();
  const double halves = 0.5 * (squared(halves_a[0], halves_b[0]) + squared(halves_a[1], halves_b[1]));
  return std::sqrt(std::max(0.0, 2 * whole - halves));
}

// A truth that is refined until its noise is small against what it is compared with.
class Judge {
 public:
  Judge(const Frame& frame, const Scene& scene, const RayEffects& drawn, const TruthRequest& request)
      : frame_(frame),
        drawn_(drawn),
        request_(request),
        white_(request.white_luminance > 0 ? request.white_luminance : 1),
        sample_(sampled_pixels(*frame.gbuffer, scene, request.count, request.seed)),
        open_(request.whole ? std::vector<color::Rgb>(sample_.places.size())
                            : exact_radiance(sample_.points, scene, effects_of(scene), request.environment)),
        truth_(sample_.places.size()) {}

  // `bare`, unless null, is the same without the floor of `transport`.
  void refine(const Transport& transport, const Transport* bare) {
    if (bare != nullptr) bare_.resize(truth_.size());
    std::vector<int> batches(truth_.size());
    for (int count = kFirst; count <= request_.batches && !is_sharp(); count *= 4) {
      std::ranges::fill(batches, count);
      trace(transport, batches, truth_);
      if (bare != nullptr && count <= kBareBatches) trace(*bare, batches, bare_);
      judge();
    }
    // By now every point has met its bright paths, so that its noise tells what it needs: that falls with the root of
    // the number of batches.
    for (int round = 0; round < kMoreRounds && !is_sharp(); ++round) {
      for (std::size_t i = 0; i < batches.size(); ++i) {
        const double ratio = noise(i) / allowed_noise();
        const double needed = kSpare * ratio * ratio * truth_[i].batches.count();
        batches[i] = static_cast<int>(std::min<double>(request_.most_batches, needed));
      }
      trace(transport, batches, truth_);
      judge();
    }
  }

  TruthError error(const Scene& scene) const {
    TruthError error;
    error.total = error_of(sample_, values(&Judge::total));
    error.standard_error = noise_;
    error.sharp = is_sharp();
    error.shares.prefilter = percentile(&Judge::prefilter);
    error.shares.occlusion = percentile(&Judge::occlusion);
    error.shares.bounce = percentile(&Judge::bounce);
    error.shares.noise = percentile(&Judge::drawn_noise);
    if (!request_.whole) {
      error.worth.shadow = worth({false, false, false});
      error.worth.self = worth({true, false, true});
      error.worth.bounce = worth({true, true, false});
      error.worth.floor = std::max(floor_on_mesh(), floor_beside_);
    }
    std::vector<double> fit;
    for (const VisiblePoint& point : sample_.points)
      fit.push_back(scene.paints[static_cast<std::size_t>(point.part)].mean_de00);
    error.shares.fit = percentile_95(std::move(fit));
    return error;
  }

  // Compares the floor beside the mesh with what pixels there show without it.
  void look_beside(const Transport& over_floor, const Scene& scene) {
    const std::vector<RayPoint> points =
        floor_points(over_floor.rays(), *frame_.gbuffer, static_cast<std::size_t>(request_.count));
    const Backdrop backdrop{scene.background, scene.background_color, request_.environment};
    PathOptions options;
    options.bounces = request_.bounces;
    std::vector<double> values(points.size());
    parallel_each(values.size(), 1, [&](std::size_t i) {
      PointTruth truth;
      add_batches(over_floor, options, points[i], mixed(seed(), ~i), kFloorBatches, truth);
      values[i] = noiseless(truth, truth, [&](const LightShares& shown, const LightShares&) {
        return seen_difference(shown.sum(), backdrop.at(-points[i].to_viewer), white_);
      });
    });
    floor_beside_ = percentile_95(std::move(values));
  }

 private:
  static constexpr int kFloorBatches = 64;

  std::uint64_t seed() const { return mixed(request_.seed, 0x7472757468); }  // not that of the picture

  static void add_batches(const Transport& transport, const PathOptions& options, const RayPoint& at,
                          std::uint64_t seed, int batches, PointTruth& truth) {
    const PointTransport point(transport, options, at.spot, at.to_viewer);
    truth.certain = point.certain();
    truth.deterministic = {point.deterministic(), {}, {}};
    while (!truth.certain && truth.batches.count() < batches)
      truth.add(point.batch_shares(mixed(seed, static_cast<std::uint64_t>(truth.batches.count()))));
  }

  double allowed_noise() const {
    return std::max({kUnseen, kPart * total_, kPartOfTolerance * request_.tolerance_de00});
  }
  bool is_sharp() const { return judged_ && noise_ <= allowed_noise(); }
  void judge() {
    judged_ = true;
    noise_ = percentile(&Judge::noise);
    total_ = percentile(&Judge::total);
  }

  // Every point, until it has that many batches.
  void trace(const Transport& transport, const std::vector<int>& batches, std::vector<PointTruth>& truth) const {
    PathOptions options;
    options.bounces = request_.bounces;
    options.correction = !request_.whole;
    parallel_each(truth.size(), 1, [&](std::size_t i) {
      const auto [x, y] = sample_.places[i];
      const RayPoint at{spot_at(transport.rays(), *frame_.gbuffer, x, y),
                        rays::float3(frame_.gbuffer->to_viewer(x, y))};
      add_batches(transport, options, at, mixed(seed(), i), batches[i], truth[i]);
    });
  }

  std::vector<double> values(double (Judge::*of)(std::size_t) const) const {
    std::vector<double> values;
    for (std::size_t i = 0; i < truth_.size(); ++i) values.push_back((this->*of)(i));
    return values;
  }
  double percentile(double (Judge::*of)(std::size_t) const) const { return percentile_95(values(of)); }
  // The change as plans have it.
  double worth(const RayEffects& without) const {
    constexpr RayEffects kAll{true, true, true};
    std::vector<double> values;
    for (std::size_t i = 0; i < truth_.size(); ++i)
      values.push_back(noiseless(truth_[i], truth_[i], [&](const LightShares& mean, const LightShares&) {
        return seen_difference(open_[i] + mean.shown(kAll), open_[i] + mean.shown(without), white_);
      }));
    return percentile_95(std::move(values));
  }
  double floor_on_mesh() const {
    std::vector<double> values;
    for (std::size_t i = 0; i < bare_.size(); ++i)
      values.push_back(noiseless(truth_[i], bare_[i], [&](const LightShares& over, const LightShares& bare) {
        return seen_difference(open_[i] + over.sum(), open_[i] + bare.sum(), white_);
      }));
    return values.empty() ? 0 : percentile_95(std::move(values));
  }
  color::Rgb truth(std::size_t i) const { return open_[i] + truth_[i].mean().sum(); }
  color::Rgb picture(std::size_t i) const { return vec3(sample_.pixel(frame_.centers, i)); }
  color::Rgb open_picture(std::size_t i) const {
    return frame_.open_centers.data.empty() ? picture(i) : vec3(sample_.pixel(frame_.open_centers, i));
  }
  double changed(std::size_t i, const color::Rgb& by) const { return seen_difference(truth(i) + by, truth(i), white_); }

  double noise(std::size_t i) const { return noise_de00(truth(i), truth_[i].covariance(), white_); }
  double total(std::size_t i) const { return seen_difference(picture(i), truth(i), white_); }
  double prefilter(std::size_t i) const { return request_.whole ? 0 : changed(i, open_picture(i) - open_[i]); }
  double occlusion(std::size_t i) const {
    if (request_.whole) return 0;
    const LightShares mean = truth_[i].mean();
    color::Rgb left_out;
    if (!drawn_.shadow) left_out += mean.direct;
    if (!drawn_.shadow || !drawn_.self) left_out += mean.into_lobes;
    return changed(i, -1.0 * left_out);
  }
  double bounce(std::size_t i) const {
    return request_.whole || (drawn_.shadow && drawn_.bounce) ? 0 : changed(i, -1.0 * truth_[i].mean().into_diffuse);
  }
  double drawn_noise(std::size_t i) const {
    if (request_.whole) return total(i);
    return drawn_.any() ? changed(i, picture(i) - open_picture(i) - truth_[i].mean().shown(drawn_)) : 0;
  }

  const Frame& frame_;
  RayEffects drawn_;
  const TruthRequest& request_;
  double white_;
  PixelSample sample_;
  std::vector<color::Rgb> open_;          // without the mesh in the way
  std::vector<PointTruth> truth_, bare_;  // bare: without the floor; empty where there is none
  bool judged_ = false;
  double noise_ = 0, total_ = 0, floor_beside_ = 0;
};

}  // namespace

Result<TruthError> truth_error(const Frame& frame, const Scene& scene, const RayEffects& drawn,
                               const TruthRequest& request) {
  const Stopwatch clock;
  PathScene paths;
  paths.scene = &scene;
  paths.environment = request.environment;
  paths.emission = scene.emission;
  paths.ground = scene.ground;
  paths.rough_coats = true;
  GONIO_ASSIGN(const Transport transport, Transport::create(paths));
  std::optional<Transport> bare;
  if (scene.ground && !request.whole) {
    paths.ground.reset();
    paths.rays = nullptr;
    GONIO_ASSIGN(bare, Transport::create(paths));
  }
  Judge judge(frame, scene, drawn, request);
  judge.refine(transport, bare ? &*bare : nullptr);
  if (bare) judge.look_beside(transport, scene);
  TruthError error = judge.error(scene);
  error.total.time_s = clock.elapsed_s();
  return error;
}

}  // namespace goniochrome::render
