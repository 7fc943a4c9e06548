#include "render/truth.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/clock.h"
#include "base/parallel.h"
#include "render/internal/seen.h"
#include "render/path/noise.h"
#include "render/path/transport.h"
#include "render/plan/ray_probe.h"

namespace goniochrome::render {

namespace {

constexpr int kFirst = 16, kMost = 1024;  // batches of a point
// The part of the difference that the truth's own error may be, and the noise below which nobody sees any.
constexpr double kPart = 0.1, kUnseen = 0.02;

// Independent batches, added one after the other.
struct PointTruth {
  LightShares sure, sum;
  LightShares even;  // the sum of every second batch
  Estimates batches;
  bool certain = false;

  void add(const LightShares& batch) {
    if (batches.count() % 2 == 0) even += batch;
    sum += batch;
    batches.add(batch.sum());
  }
  LightShares mean() const {
    LightShares result = sure;
    if (batches.count() > 0) result += (1.0 / batches.count()) * sum;
    return result;
  }
  // The mean of every second batch, and of the others.
  std::array<LightShares, 2> halves() const {
    LightShares odd = sum;
    odd += -1.0 * even;
    const int count = batches.count();
    std::array<LightShares, 2> result = {(1.0 / std::max(1, (count + 1) / 2)) * even,
                                         (1.0 / std::max(1, count / 2)) * odd};
    for (LightShares& half : result) half += sure;
    return result;
  }
  // Of that mean.
  Covariance covariance() const {
    Covariance result = batches.covariance();
    for (double& value : result) value /= std::max(1, batches.count());
    return result;
  }
};

color::Rgb pixel_of(const image::Image& image, const std::array<int, 2>& place) {
  const float* p = image.pixel(place[0], place[1]);
  return {p[0], p[1], p[2]};
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

  void refine(const Transport& transport, const mesh::Mesh& mesh) {
    for (int batches = kFirst; batches <= kMost; batches *= 4) {
      trace(transport, mesh, batches);
      noise_ = percentile(&Judge::noise);
      total_ = percentile(&Judge::total);
      if (noise_ <= std::max(kUnseen, kPart * total_)) break;
    }
  }

  TruthError error(const Scene& scene) const {
    TruthError error;
    error.total.checked_pixels = static_cast<int>(truth_.size());
    error.total.de00_p95 = total_;
    error.standard_error = noise_;
    error.sharp = noise_ <= std::max(kUnseen, kPart * total_);
    for (std::size_t i = 0; i < truth_.size(); ++i) {
      const double de00 = total(i);
      error.total.de00_mean += de00 / static_cast<double>(truth_.size());
      if (de00 <= error.total.de00_max) continue;
      error.total.de00_max = de00;
      error.total.worst_x = sample_.places[i][0], error.total.worst_y = sample_.places[i][1];
    }
    error.shares.prefilter = percentile(&Judge::prefilter);
    error.shares.occlusion = percentile(&Judge::occlusion);
    error.shares.bounce = percentile(&Judge::bounce);
    error.shares.noise = percentile(&Judge::drawn_noise);
    if (!request_.whole) {
      error.worth.shadow = worth({false, false, false});
      error.worth.self = worth({true, false, true});
      error.worth.bounce = worth({true, true, false});
    }
    std::vector<double> fit;
    for (const VisiblePoint& point : sample_.points)
      fit.push_back(scene.paints[static_cast<std::size_t>(point.part)].mean_de00);
    error.shares.fit = percentile_95(std::move(fit));
    return error;
  }

 private:
  void trace(const Transport& transport, const mesh::Mesh& mesh, int batches) {
    PathOptions options;
    options.bounces = request_.bounces;
    options.correction = !request_.whole;
    const std::uint64_t seed = mixed(request_.seed, 0x7472757468);  // not that of the picture
    parallel_for(truth_.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const auto [x, y] = sample_.places[i];
        const RayPoint at = ray_point(transport.rays(), mesh, *frame_.gbuffer, x, y);
        const PointTransport point(transport, options, at.spot, at.to_viewer);
        PointTruth& truth = truth_[i];
        truth.certain = point.certain();
        truth.sure = {point.sure(), {}, {}};
        while (!truth.certain && truth.batches.count() < batches)
          truth.add(point.batch_shares(mixed(mixed(seed, i), static_cast<std::uint64_t>(truth.batches.count()))));
      }
    });
  }

  double percentile(double (Judge::*of)(std::size_t) const) const {
    std::vector<double> values;
    for (std::size_t i = 0; i < truth_.size(); ++i) values.push_back((this->*of)(i));
    return percentile_95(std::move(values));
  }
  // As plans have it, in the same way free of noise: theory(7), PLAN, Effects of rays.
  double worth(const RayEffects& without) const {
    constexpr RayEffects kAll{true, true, true};
    std::vector<double> values;
    for (std::size_t i = 0; i < truth_.size(); ++i) {
      const auto squared = [&](const LightShares& mean) {
        const double d = seen_difference(open_[i] + mean.shown(kAll), open_[i] + mean.shown(without), white_);
        return d * d;
      };
      const double whole = squared(truth_[i].mean());
      if (truth_[i].batches.count() < 2) {
        values.push_back(std::sqrt(whole));
        continue;
      }
      const auto halves = truth_[i].halves();
      values.push_back(std::sqrt(std::max(0.0, 2 * whole - 0.5 * (squared(halves[0]) + squared(halves[1])))));
    }
    return percentile_95(std::move(values));
  }
  color::Rgb truth(std::size_t i) const { return open_[i] + truth_[i].mean().sum(); }
  color::Rgb picture(std::size_t i) const { return pixel_of(frame_.centers, sample_.places[i]); }
  color::Rgb open_picture(std::size_t i) const {
    return frame_.open_centers.data.empty() ? picture(i) : pixel_of(frame_.open_centers, sample_.places[i]);
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
  std::vector<color::Rgb> open_;  // without the mesh in the way
  std::vector<PointTruth> truth_;
  double noise_ = 0, total_ = 0;
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
  paths.rough_coats = request.whole;
  GONIO_ASSIGN(const Transport transport, Transport::create(paths));
  Judge judge(frame, scene, drawn, request);
  judge.refine(transport, *scene.mesh);
  TruthError error = judge.error(scene);
  error.total.time_s = clock.elapsed_s();
  return error;
}

}  // namespace goniochrome::render
