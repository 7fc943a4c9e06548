// How gathered light is judged, and where more of it is gathered.
#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "render/internal/seen.h"
#include "render/path/covariance.h"
#include "render/path/gathered_light.h"

namespace goniochrome::render {

namespace {

constexpr int kMostSequences = 64;
constexpr std::size_t kLeastHeldOut = 20;  // of the mesh or of the floor; of fewer nothing is concluded
constexpr double kNeighborhood = 4;        // degrees of freedom of the neighbors' variance
constexpr double kLeastScale = 0.25, kMostScale = 10;
constexpr std::size_t kFew = 20000;  // pixels that are all looked at in every round
constexpr double kNoisy = 1.5;  // a lattice is made finer where interpolation errs by so much more than noise, squared
constexpr double kLeastGain = 0.005;            // the share of all directions that a round draws at least
constexpr double kUnknown = 100;                // the noise of a pixel near which there is no point
constexpr std::uint8_t kPoint = 1, kFiner = 2;  // what is asked for at a pixel: a point, and a finer lattice

}  // namespace

// The variance of each point's mean, and what interpolation without it misses it by, beyond the noise of both.
void GatheredLight::judge_points() {
  std::vector<Covariance> own(points_.size());
  for (std::size_t i = 0; i < points_.size(); ++i) own[i] = points_[i].sums.covariance();
  const auto each = [&](const auto& body) {
    parallel_for(points_.size(), 256, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) body(i, points_[i]);
    });
  };
  const auto around = [&](const Point& p, std::int32_t without, Near* found) {
    return near(p.x, p.y, p.position, p.normal, p.part, step_at(p.x, p.y), without, found);
  };
  each([&](std::size_t i, Point& p) {
    const int n = p.sums.count();
    p.variance = {};
    if (n == 0) return;
    Near found[kMostNear];
    const int count = around(p, -1, found);
    Covariance sum{};
    double total = 0;
    for (int k = 0; k < count; ++k) {
      const auto other = static_cast<std::size_t>(found[k].point);
      const double weight = found[k].weight * std::max(0, points_[other].sums.count() - 1);
      add(sum, weight, own[other]), total += weight;
    }
    if (total > 0) add(p.variance, kNeighborhood / total, sum);
    add(p.variance, n - 1, own[i]);
    for (double& element : p.variance) element /= n * (n - 1 + (total > 0 ? kNeighborhood : 0));
  });
  std::vector<Covariance> excess(points_.size());
  each([&](std::size_t i, Point& p) {
    const Mix mix = mixed_at(p.x, p.y, p.position, p.normal, p.part, step_at(p.x, p.y), static_cast<std::int32_t>(i));
    if (mix.count == 0) return;
    excess[i] = outer(p.value() - mix.light);
    add(excess[i], -1, p.variance), add(excess[i], -1, mix.noise);
  });
  // The mean over neighbors, twice: of fewer points it would be noise for the most part.
  for (const bool last : {false, true}) {
    std::vector<Covariance> mean(points_.size());
    each([&](std::size_t i, const Point& p) {
      Near found[kMostNear];
      const int count = around(p, -1, found);
      double total = 0;
      for (int k = 0; k < count; ++k) {
        add(mean[i], found[k].weight, excess[static_cast<std::size_t>(found[k].point)]), total += found[k].weight;
      }
      for (double& element : mean[i]) element = total > 0 ? element / total : 0;
      if (last) mean[i] = not_negative(mean[i]);
    });
    excess = std::move(mean);
  }
  for (std::size_t i = 0; i < points_.size(); ++i) points_[i].error = excess[i];
}

// Held-out pixels tell by how much what is told of an error is to be multiplied, so that 95 of 100 are within two
// standard deviations: of the mesh and of the floor by themselves.
void GatheredLight::calibrate() {
  std::vector<double> needed(held_out_.size(), -1);
  parallel_for(held_out_.size(), 32, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Point& p = held_out_[i];
      const Mix mix = mixed_at(p.x, p.y, p.position, p.normal, p.part, step_at(p.x, p.y), -1);
      if (mix.count == 0 || std::abs(p.shelter - mix.shelter) >= kMostUnlike) continue;
      Covariance own = p.sums.covariance(), told = mix.noise;
      for (double& element : own) element /= std::max(1, p.sums.count());
      add(told, 1, mix.error);
      const color::Rgb shown = p.shown();
      const double missed = seen2(shown, scaled(outer(p.value() - mix.light), p.scale)) / 4 -
                            seen2(shown, scaled(own, p.scale)),
                   stated = seen2(shown, scaled(told, p.scale));
      needed[i] = missed > 0 ? missed / std::max(stated, 1e-12) : 0;
    }
  });
  for (const bool floor : {false, true}) {
    std::vector<double> all;
    for (std::size_t i = 0; i < needed.size(); ++i)
      if (is_floor(held_out_[i].part) == floor && needed[i] >= 0) all.push_back(needed[i]);
    const bool enough = all.size() >= kLeastHeldOut;
    error_scale_[floor ? 1 : 0] = enough ? std::clamp(percentile_95(std::move(all)), kLeastScale, kMostScale) : 1;
  }
}

GatheredLight::Judged GatheredLight::judged(int x, int y) const {
  const rays::Spot spot = spot_at(transport_.rays(), surface_, x, y);
  const Mix mix = best_at(x, y, spot, step_at(x, y));
  if (mix.count == 0) return {};
  const color::Rgb scale = points_[static_cast<std::size_t>(mix.points[0])].scale,
                   shown = rays::vec3(beside_[pixel(x, y)]) + transport_.laid_paint(spot) * mix.light;
  const double told = told_scale(mix.single, spot.part);
  return {true, told * seen2(shown, scaled(mix.noise, scale)), told * seen2(shown, scaled(mix.error, scale))};
}

// Asks for the points of the next finer lattice in the cell that holds a pixel, and on its border.
void GatheredLight::refine(int x, int y, std::vector<std::uint8_t>& asked) const {
  const int step = step_at(x, y), half = step / 2;
  const auto first = [&](int at) {
    return kOffset + static_cast<int>(std::floor(static_cast<double>(at - kOffset) / step)) * step;
  };
  const int left = first(x), top = first(y);
  for (int j = 0; j <= 2; ++j) {
    for (int i = 0; i <= 2; ++i) {
      const int column = left + i * half, row = top + j * half;
      if (column < 0 || row < 0 || column >= width_ || row >= height_) continue;
      asked[pixel(column, row)] |= kPoint;
    }
  }
  for (int row = std::max(0, top); row < std::min(height_, top + step); ++row)
    for (int column = std::max(0, left); column < std::min(width_, left + step); ++column)
      asked[pixel(column, row)] |= kFiner;
}

// What these pixels show beside gathered light, once for each.
void GatheredLight::see(const std::vector<Looked>& looked) {
  constexpr std::size_t kTogether = 64;
  parallel_for(looked.size(), kTogether, [&](std::size_t begin, std::size_t end) {
    std::vector<VisiblePoint> open;
    std::vector<std::size_t> places;
    for (std::size_t k = begin; k < end; ++k) {
      const int x = looked[k].x, y = looked[k].y;
      const std::size_t at = pixel(x, y);
      if (beside_[at].x != kNotSeen) continue;
      const rays::Spot spot = spot_at(transport_.rays(), surface_, x, y);
      const Vec3 to_viewer = surface_.gbuffer.to_viewer(x, y);
      color::Rgb seen = PointTransport(transport_, request_.options, spot, rays::float3(to_viewer)).sure();
      if (request_.base != nullptr) {
        const float* rgb = request_.base->pixel(x, y);
        seen += color::Rgb{rgb[0], rgb[1], rgb[2]};
      }
      beside_[at] = rays::float3(seen);
      if (request_.open == nullptr || transport_.shows_ground(spot.part)) continue;
      open.push_back({rays::vec3(spot.shading), to_viewer, spot.part});
      places.push_back(at);
    }
    if (open.empty()) return;
    const std::vector<color::Rgb> quick = request_.open->quick(open);
    for (std::size_t k = 0; k < places.size(); ++k) beside_[places[k]] = beside_[places[k]] + rays::float3(quick[k]);
  });
}

// On fine lattices all pixels are looked at, since each decides about its own point; of coarser ones some in each cell,
// which stand for more.
std::vector<GatheredLight::Looked> GatheredLight::looked_at() {
  constexpr int kStrides[kFirstLevel + 1] = {1, 1, 5, 20};
  std::vector<Looked> looked;
  const bool all = surface_.hits.size() <= kFew;
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x) {
      const int stride = all ? 1 : kStrides[level_[pixel(x, y)]];
      if ((x + 7 * y) % stride != 0 || !gatherable(x, y)) continue;
      looked.push_back({x, y, stride, surface_.hits[pixel(x, y)].triangle == rays::kFloor, {}});
    }
  }
  see(looked);
  parallel_for(looked.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) looked[k].judged = judged(looked[k].x, looked[k].y);
  });
  return looked;
}

// The noise that this share of the pixels of the mesh or of the floor does not exceed.
double GatheredLight::percentile(const std::vector<Looked>& looked, bool floor, double share) {
  std::vector<std::pair<double, int>> noise;
  double total = 0;
  for (const Looked& l : looked) {
    if (l.floor != floor) continue;
    noise.emplace_back(l.judged.known ? l.judged.de00() : kUnknown, l.weight), total += l.weight;
  }
  std::ranges::sort(noise);
  double below = 0;
  for (const auto& [value, weight] : noise)
    if ((below += weight) >= share * total) return value;
  return 0;
}

// More sequences at the points that a pixel is interpolated from.
void GatheredLight::want_more(const Looked& looked, double target_de00) {
  const rays::Spot spot = spot_at(transport_.rays(), surface_, looked.x, looked.y);
  const Mix mix = best_at(looked.x, looked.y, spot, step_at(looked.x, looked.y));
  const double target2 = target_de00 * target_de00;
  const double lacking = looked.judged.noise2 / std::max(0.5 * target2, target2 - looked.judged.error2);
  for (int i = 0; i < mix.count; ++i) {
    Point& p = points_[static_cast<std::size_t>(mix.points[i])];
    const double n = p.sums.count(), wanted = std::min(n * std::clamp(lacking - 1, 0.25, 3.0), kMostSequences - n);
    p.wanted = std::max(p.wanted, static_cast<int>(std::ceil(wanted)));
  }
}

bool GatheredLight::improve(double target_de00, const Deadline& deadline) {
  judge_points();
  calibrate();
  const std::vector<Looked> looked = looked_at();
  noise_p95_ = std::max(percentile(looked, false, 0.95), percentile(looked, true, 0.95));
  if (noise_p95_ <= target_de00 || deadline.passed()) return false;
  // The worst few pixels get no more than the others.
  const double cap[2] = {percentile(looked, false, 0.97), percentile(looked, true, 0.97)};
  std::vector<std::uint8_t> asked(level_.size(), 0);
  for (const Looked& l : looked) {
    const Judged& j = l.judged;
    const bool finest = step_at(l.x, l.y) == 1;
    if (!j.known && finest) {
      asked[pixel(l.x, l.y)] |= kPoint;
    } else if (!j.known) {
      refine(l.x, l.y, asked);
    } else if (j.de00() > target_de00 && j.de00() <= cap[l.floor ? 1 : 0]) {
      if (kNoisy * j.noise2 > j.error2) {
        want_more(l, target_de00);
      } else if (!finest) {
        refine(l.x, l.y, asked);
      } else {
        asked[pixel(l.x, l.y)] |= kPoint;
      }
    }
  }
  const std::vector<std::uint8_t> levels = level_;
  std::vector<std::size_t> more;
  std::size_t finer = 0;
  for (std::size_t at = 0; at < asked.size(); ++at) {
    if (asked[at] == 0) continue;
    const auto width = static_cast<std::size_t>(width_);
    if ((asked[at] & kFiner) != 0 && level_[at] > 0) --level_[at], ++finer;
    if ((asked[at] & kPoint) != 0 && number_[at] >= 0 && level_[at] == 0) {
      Point& p = points_[static_cast<std::size_t>(number_[at])];
      p.wanted = std::max(p.wanted, kTrusted - p.sums.count());
    }
    if ((asked[at] & kPoint) != 0 && number_[at] < 0 &&
        gatherable(static_cast<int>(at % width), static_cast<int>(at / width)))
      more.push_back(at);
  }
  const double before = directions();
  draw(points_, &deadline);
  add_points(more, &deadline);
  if (deadline.passed()) level_ = levels;  // the finer lattices have gaps
  return finer > asked.size() / 1000 || directions() > (1 + kLeastGain) * before;
}

}  // namespace goniochrome::render
