#include "render/path/path_tracer.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/clock.h"
#include "base/parallel.h"
#include "render/internal/seen.h"
#include "render/path/gathered_light.h"

namespace goniochrome::render {

namespace {

// Points that one thread takes at a time.
constexpr std::size_t kTogether = 64;
// The batches of the first round: two are the fewest that tell a variance.
constexpr int kFirstBatches = 2;
// A point's own variance counts as its batches less one, that of its neighborhood as so many.
constexpr double kNeighborhood = 4;
constexpr int kReach = 2;  // pixels to each side of the neighborhood
// The part of the tolerance that gathered light may take at first, and what samples of the points may.
constexpr double kGatheredShare = 0.9, kOwnShare = 0.6;

std::uint64_t seed_of(std::uint64_t seed, std::uint64_t point, int batch) {
  return mixed(mixed(seed, point), static_cast<std::uint64_t>(batch));
}

class Picture {
 public:
  Picture(const Transport& transport, const VisibleSurface& surface, const image::Image* base,
          const PathRequest& request)
      : transport_(transport), surface_(surface), base_(base), request_(request), deadline_(request.time_limit_s) {
    const Gbuffer& g = surface.gbuffer;
    shifts_ = sample_shifts(request.pixel_samples);
    if (shifts_.size() > 1) coverage_ = coverage(transport.rays(), g.rays, g.width, g.height, shifts_);
    number_.assign(static_cast<std::size_t>(g.width) * g.height, -1);
    for (int y = 0; y < g.height; ++y)
      for (int x = 0; x < g.width; ++x) add_point(x, y);
    states_.resize(points_.size());
  }

  PathPicture draw() {
    std::vector<int> more(points_.size(), kFirstBatches);
    double noise = 0, target = kGatheredShare * tolerance();
    bool reached = false;
    if (request_.gather) gather(target);
    while (true) {
      sample(more);
      first_round_ = false;  // which no time limit cuts, so that every point is seen
      noise = judge();
      if (request_.progress) request_.progress(noise, clock_.elapsed_s());
      reached = request_.tolerance_de00 > 0 && noise <= request_.tolerance_de00;
      if (reached || deadline_.passed()) break;
      bool any = plan(noise, more);
      if (request_.gather && gathered_p95() > kOwnShare * tolerance()) {
        const bool gathered = gather(target *= 0.8);
        any = gathered || release(target, more) || any;
      }
      if (!any) break;
    }
    PathPicture picture;
    picture.reached = reached;
    picture.noise_p95_de00 = noise;
    const double count = std::max<double>(1, static_cast<double>(points_.size()));
    for (const PathPoint& point : points_) {
      picture.noise_mean_de00 += point.noise_de00;
      picture.samples_mean += point.samples;
      picture.free_share += point.samples == 0 ? 1 : 0;
    }
    picture.noise_mean_de00 /= count, picture.samples_mean /= count, picture.free_share /= count;
    picture.points = std::move(points_);
    picture.time_s = clock_.elapsed_s();
    return picture;
  }

 private:
  void add_point(int x, int y) {
    const std::size_t at = place(x, y);
    PathPoint point;
    point.x = x, point.y = y;
    if (shifts_.size() > 1) {
      const unsigned any = coverage_.any[at];
      point.coverage = static_cast<float>(std::popcount(any)) / static_cast<float>(shifts_.size());
      point.floor = coverage_.floor[at] == any;
    } else {
      point.coverage = surface_.hits[at].any() ? 1 : 0;
      point.floor = surface_.hits[at].triangle == rays::kFloor;
    }
    if (point.coverage == 0) return;
    number_[at] = static_cast<std::int32_t>(points_.size());
    points_.push_back(point);
  }

  struct State {
    Estimates sums;
    color::Rgb sure;
    color::Rgb gathered;  // with `is_gathered`: the diffuse part and the lobes, and what their error is
    Covariance gathered_error{};
    int gathered_samples = 0;
    bool is_gathered = false;  // then `sums` are of what the mirror sees
    double needed = 0;         // batches that bring the noise of the neighborhood to the tolerance
    bool certain = false;
    std::uint16_t uncertain = 0;  // samples of the pixel whose light is not known without paths
  };

  std::size_t place(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(surface_.gbuffer.width) + static_cast<std::size_t>(x);
  }

  // Of the single sample of a pixel. Most of a floor is easy, so that its first round is half as long.
  int batch_of(const PathPoint& point) const { return point.floor && shifts_.size() == 1 ? kFan : kBatch; }

  // Chunks are taken in a scattered order, so that a picture that time cut short is noisy evenly.
  void sample(const std::vector<int>& more) {
    std::vector<std::uint32_t> wanted;
    for (std::size_t i = 0; i < more.size(); ++i)
      if (more[i] > 0) wanted.push_back(static_cast<std::uint32_t>(i));
    const std::size_t chunks = (wanted.size() + kTogether - 1) / kTogether;
    const std::size_t step = scattering(chunks);
    parallel_for(chunks, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        if (!first_round_ && deadline_.passed()) return;
        const std::size_t chunk = i * step % chunks;
        for (std::size_t k = chunk * kTogether; k < std::min(wanted.size(), (chunk + 1) * kTogether); ++k)
          sample(wanted[k], more[wanted[k]]);
      }
    });
  }

  // A step near the golden section of n that shares no factor with it.
  static std::size_t scattering(std::size_t n) {
    auto step = static_cast<std::size_t>(0.6180339887 * static_cast<double>(n)) + 1;
    const auto common = [](std::size_t a, std::size_t b) {
      while (b != 0) a %= b, std::swap(a, b);
      return a;
    };
    while (n > 1 && common(step, n) != 1) ++step;
    return step;
  }

  void sample(std::size_t i, int batches) {
    if (shifts_.size() > 1) return sample_spread(i, batches);
    State& state = states_[i];
    PathPoint& point = points_[i];
    const Gbuffer& g = surface_.gbuffer;
    if (state.is_gathered && state.certain && state.sums.count() == 0 && !first_round_) return;
    const rays::Spot spot = spot_at(transport_.rays(), surface_, point.x, point.y);
    if (state.is_gathered && transport_.shows_ground(spot.part) && !transport_.has_lights()) {
      state.certain = true, state.sure = transport_.open_ground(spot);
      return;
    }
    const PointTransport at(transport_, request_.options, spot, rays::float3(g.to_viewer(point.x, point.y)));
    state.certain = state.is_gathered ? at.mirror_certain() : at.certain();
    state.sure = at.sure();
    if (state.certain) return;
    const auto count = static_cast<std::uint32_t>(batch_of(point));
    for (int k = 0; k < batches; ++k)
      state.sums.add(batch_part(at, state, seed_of(request_.seed, i, state.sums.count()), 0, count));
  }

  static color::Rgb batch_part(const PointTransport& at, const State& state, std::uint64_t seed, std::uint32_t first,
                               std::uint32_t count) {
    return state.is_gathered ? at.mirror_mean(seed, first, count) : at.part_of_batch(seed, first, count);
  }

  // Light of smooth surface, within the target as far as time allows. Whether anything was done.
  bool gather(double target) {
    const bool first_time = !gathered_;
    if (first_time) {
      GatherRequest request;
      request.options = request_.options, request.tolerance_de00 = tolerance(), request.seed = request_.seed;
      request.white_luminance = request_.white_luminance, request.open = request_.open, request.base = base_;
      gathered_.emplace(transport_, surface_, request);
      gathered_->begin();
    }
    bool any = false;
    while (gathered_->improve(target, deadline_)) {
      any = true;
      if (request_.progress) request_.progress(gathered_->noise_p95_de00(), clock_.elapsed_s());
    }
    if (first_time || any) take_gathered(first_time);
    return any;
  }

  // The gathered light of all points, the mean over the samples of each pixel. Which points are gathered is decided
  // once, since the others have samples of their own. Interpolation errs alike at all samples of a pixel.
  void take_gathered(bool decide) {
    const Gbuffer& g = surface_.gbuffer;
    const auto count = static_cast<double>(shifts_.size());
    std::vector<std::uint8_t> missing(points_.size(), 0);
    for (State& state : states_) state.gathered = {}, state.gathered_error = {}, state.gathered_samples = 0;
    image::Image quick{g.width, g.height, 4, std::vector<float>(4 * number_.size(), 0.0F), {}};
    for (std::size_t sample = 0; sample < shifts_.size(); ++sample) {
      const auto [dx, dy] = shifts_[sample];
      VisibleSurface shifted;
      if (shifts_.size() > 1) {
        Rays through = g.rays;
        through.corner += dx * through.right + dy * through.down;
        shifted = visible_surface(transport_.rays(), through, g.width, g.height);
      }
      const VisibleSurface& seen = shifts_.size() > 1 ? shifted : surface_;
      if (request_.open != nullptr) request_.open->add_quick(seen.gbuffer, static_cast<float>(1 / count), quick);
      parallel_for(points_.size(), 256, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
          const PathPoint& point = points_[i];
          if (!seen.hits[place(point.x, point.y)].any() || (!decide && !states_[i].is_gathered)) continue;
          const rays::Spot spot = spot_at(transport_.rays(), seen, point.x, point.y);
          const GatheredLight::Light light = gathered_->at(point.x + dx, point.y + dy, spot);
          missing[i] |= light.known ? 0 : 1;
          if (light.samples == 0 && light.light == color::Rgb{}) continue;
          const color::Rgb scale = (1 / count) * transport_.laid_paint(spot);
          State& state = states_[i];
          state.gathered += scale * light.light;
          state.gathered_samples += static_cast<int>(light.samples / count);
          const double terms[6] = {scale.x * scale.x, scale.y * scale.y, scale.z * scale.z,
                                   scale.x * scale.y, scale.x * scale.z, scale.y * scale.z};
          for (std::size_t k = 0; k < 6; ++k) state.gathered_error[k] += count * terms[k] * light.covariance[k];
        }
      });
    }
    for (std::size_t i = 0; i < points_.size(); ++i) {
      State& state = states_[i];
      if (decide) state.is_gathered = missing[i] == 0;
      const float* rgb = quick.pixel(points_[i].x, points_[i].y);
      state.gathered += color::Rgb{rgb[0], rgb[1], rgb[2]};
    }
  }

  // Points whose gathered light cannot be brought to the target get samples of their own. Whether there are any.
  bool release(double target, std::vector<int>& more) {
    bool any = false;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      State& state = states_[i];
      if (!state.is_gathered || noise_of(i, points_[i].radiance, state.gathered_error) <= target) continue;
      state = {};
      more[i] = kFirstBatches;
      any = true;
    }
    return any;
  }

  double gathered_p95() const {
    return worse_percentile([this](std::size_t i) {
      return states_[i].is_gathered ? noise_of(i, points_[i].radiance, states_[i].gathered_error) : 0;
    });
  }

  // What a sample of a pixel sees, which is something.
  PointTransport transport_at(const PathPoint& point, std::size_t sample, rays::Spot& spot) const {
    const rays::RayScene& scene = transport_.rays();
    const Rays& through = surface_.gbuffer.rays;
    const Vec3 toward = through.direction(point.x + 0.5 + shifts_[sample][0], point.y + 0.5 + shifts_[sample][1]);
    const rays::Float3 eye = scene.local(through.eye), direction = rays::float3(toward);
    spot = scene.spot(scene.closest(eye, direction), eye, direction);
    return {transport_, request_.options, spot, -direction};
  }

  // Each batch is shared by two samples of the pixel, half of it each, and the batches take the samples in turn from
  // one drawn by chance: the mean over all batches has the right expectation, and the differences between samples count
  // as noise while not all have been seen.
  void sample_spread(std::size_t i, int batches) {
    State& state = states_[i];
    const PathPoint& point = points_[i];
    const auto count = static_cast<unsigned>(shifts_.size());
    const unsigned covered = coverage_.any[place(point.x, point.y)];
    const bool first_time = state.sums.count() == 0;
    if (first_time) state.uncertain = 0, state.sure = {};
    std::vector<color::Rgb> values(static_cast<std::size_t>(batches));
    const auto first = static_cast<unsigned>(state.sums.count());
    const auto start = static_cast<unsigned>(mixed(request_.seed, i) >> 32);
    for (unsigned sample = 0; sample < count; ++sample) {
      if ((covered >> sample & 1U) == 0) continue;
      if (!first_time && (state.uncertain >> sample & 1U) == 0) continue;
      rays::Spot spot;
      const PointTransport at = transport_at(point, sample, spot);
      if (first_time) {
        state.sure += (1.0 / count) * at.sure();
        if (!(state.is_gathered ? at.mirror_certain() : at.certain()))
          state.uncertain = static_cast<std::uint16_t>(state.uncertain | 1U << sample);
      }
      if ((state.uncertain >> sample & 1U) == 0) continue;
      for (unsigned k = 0; k < values.size(); ++k) {
        for (unsigned half = 0; half < 2; ++half) {
          if ((start + 2 * (first + k) + half) % count != sample) continue;
          const std::uint64_t seed = seed_of(request_.seed, i, static_cast<int>(first + k));
          values[k] += 0.5 * batch_part(at, state, seed, kFan * half, kFan);
        }
      }
    }
    state.certain = state.uncertain == 0;
    if (state.certain) return;
    for (const color::Rgb& value : values) state.sums.add(value);
  }

  // Radiance, error and noise of every point from its sums; the 95th percentile of the noise.
  double judge() {
    std::vector<Covariance> own(points_.size());
    parallel_for(points_.size(), 1024, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        own[i] = states_[i].sums.covariance();
        const State& state = states_[i];
        points_[i].radiance = state.sure + state.sums.mean();
        points_[i].samples = batch_of(points_[i]) * state.sums.count();
        if (!state.is_gathered) continue;
        points_[i].radiance += state.gathered;
        points_[i].samples += state.gathered_samples;
      }
    });
    parallel_for(points_.size(), 1024, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) judge(i, own);
    });
    return worse_percentile([this](std::size_t i) { return points_[i].noise_de00; });
  }

  // The larger of the 95th percentiles over the mesh and over the floor.
  template <class Value>
  double worse_percentile(const Value& value) const {
    std::vector<double> mesh, floor;
    for (std::size_t i = 0; i < points_.size(); ++i) (points_[i].floor ? floor : mesh).push_back(value(i));
    return std::max(percentile_95(std::move(mesh)), percentile_95(std::move(floor)));
  }

  // Few estimates tell little of their variance, and a point none of whose rays was blocked knows nothing of its
  // neighbor's shadow: the mean over the neighborhood stands in.
  void judge(std::size_t i, const std::vector<Covariance>& own) {
    PathPoint& point = points_[i];
    State& state = states_[i];
    point.covariance = {};
    point.noise_de00 = state.needed = 0;
    if (state.is_gathered) {
      point.covariance = state.gathered_error;
      point.noise_de00 = noise_of(i, point.radiance, point.covariance);
    }
    const int n = state.sums.count();
    if (n < 2) return;
    Covariance around{};
    color::Rgb light;
    int count = 0;
    for (int y = std::max(0, point.y - kReach); y <= std::min(surface_.gbuffer.height - 1, point.y + kReach); ++y) {
      for (int x = std::max(0, point.x - kReach); x <= std::min(surface_.gbuffer.width - 1, point.x + kReach); ++x) {
        const std::int32_t number = number_[place(x, y)];
        const auto other = static_cast<std::size_t>(number);
        if (number < 0 || other == i || states_[other].sums.count() < 2) continue;
        if (states_[other].is_gathered != state.is_gathered) continue;
        ++count;
        light += points_[other].radiance;
        for (std::size_t k = 0; k < 6; ++k) around[k] += own[other][k];
      }
    }
    for (std::size_t k = 0; k < 6; ++k)
      point.covariance[k] +=
          ((n - 1) * own[i][k] + kNeighborhood * (around[k] + own[i][k]) / (count + 1)) / (n - 1 + kNeighborhood) / n;
    point.noise_de00 = noise_of(i, point.radiance, point.covariance);
    // How many samples a point is to get is decided by its neighbors alone: were its own sums asked, it would stop
    // where they happen to be bright, and the mean would be too.
    if (count == 0) around = own[i], light = point.radiance, count = 1;
    for (double& element : around) element /= count;
    const double share = state.is_gathered ? kOwnShare : 1;
    const double excess = noise_of(i, (1.0 / count) * light, around) / (share * tolerance());
    state.needed = excess * excess;
  }

  double noise_of(std::size_t i, color::Rgb radiance, const Covariance& covariance) const {
    if (base_ != nullptr) {
      const float* rgb = base_->pixel(points_[i].x, points_[i].y);
      radiance += color::Rgb{rgb[0], rgb[1], rgb[2]};
    }
    return noise_de00(radiance, covariance, request_.white_luminance);
  }

  double tolerance() const { return request_.tolerance_de00 > 0 ? request_.tolerance_de00 : 1e-9; }

  // How many batches each point is to get next: as many as its neighborhood's noise asks for, at most as many as it
  // has. The twentieth part of the points that would need most get no more than the rest. Where the neighborhoods are
  // content but the picture is not, all is scaled by what it lacks. Whether there are any.
  bool plan(double noise, std::vector<int>& more) const {
    const double typical = worse_percentile([this](std::size_t i) { return states_[i].needed; });
    const double limit = request_.most_samples / kBatch, lacking = noise / tolerance();
    for (double scale = 1;; scale *= 1.1 * std::max(1.0, lacking * lacking)) {
      const double most = std::min(std::ceil(1.05 * scale * typical), limit);
      bool any = false, limited = true;
      for (std::size_t i = 0; i < points_.size(); ++i) {
        const double n = states_[i].sums.count(), wanted = std::min(std::ceil(scale * states_[i].needed), most) - n;
        more[i] = static_cast<int>(std::clamp(wanted, 0.0, n));
        any = any || more[i] > 0;
        limited = limited && (n == 0 || states_[i].needed == 0 || n >= limit);
      }
      if (any) return true;
      if (limited || scale > 1e6) return false;
    }
  }

  const Transport& transport_;
  const VisibleSurface& surface_;
  const image::Image* base_;
  const PathRequest& request_;
  Deadline deadline_;
  Stopwatch clock_;
  bool first_round_ = true;
  std::vector<std::array<double, 2>> shifts_;  // of the pixels' samples
  Coverage coverage_;                          // empty where the centers alone are seen
  std::vector<std::int32_t> number_;           // of the point of each pixel, or -1
  std::vector<PathPoint> points_;
  std::vector<State> states_;
  std::optional<GatheredLight> gathered_;
};

}  // namespace

PathPicture path_picture(const Transport& transport, const VisibleSurface& surface, const image::Image* base,
                         const PathRequest& request) {
  return Picture(transport, surface, base, request).draw();
}

PathEstimate path_estimate(const Transport& transport, const PathOptions& options, const rays::Spot& spot,
                           const Vec3& to_viewer, int batches, std::uint64_t seed) {
  const PointTransport at(transport, options, spot, rays::float3(to_viewer));
  if (at.certain()) return {at.sure(), {}};
  Estimates sums;
  for (int k = 0; k < batches; ++k) sums.add(at.batch(seed_of(seed, 0, k)));
  Covariance covariance = sums.covariance();
  for (double& element : covariance) element /= batches;
  return {at.sure() + sums.mean(), covariance};
}

}  // namespace goniochrome::render
