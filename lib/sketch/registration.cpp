#include "sketch/registration.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

#include "base/angles.h"
#include "base/parallel.h"

namespace goniochrome::sketch {

namespace {

constexpr double kSmallestFit = 0.75, kLargestFit = 1.15;  // of the scale at which the buffers just fit
constexpr int kCoarse = 64;     // pixels along the longer side where the whole domain is searched
constexpr int kLeastSide = 24;  // pixels along the shorter side there
constexpr std::size_t kCoarseEdges = 400, kFineEdges = 4000;
constexpr float kLeastEdge = 0.02F, kMostEdge = 0.3F;  // one glaring edge does not outvote all others
constexpr double kGray = 0.18;                         // behind a mesh, of the white of the display
constexpr double kLeastAgreement = 0.72;

// One channel.
struct Plane {
  int width = 0, height = 0;
  double middle_x = 0, middle_y = 0;  // of the picture that it was made from
  std::vector<float> data;

  Plane(int w, int h) : width(w), height(h), data(static_cast<std::size_t>(w) * h, 0) {}
  // Empty, of the size of another one.
  static Plane like(const Plane& other) {
    Plane plane(other.width, other.height);
    plane.middle_x = other.middle_x, plane.middle_y = other.middle_y;
    return plane;
  }
  float& at(int x, int y) { return data[static_cast<std::size_t>(y) * width + x]; }
  float at(int x, int y) const { return data[static_cast<std::size_t>(y) * width + x]; }
  bool holds(double x, double y) const { return x >= 0 && y >= 0 && x < width - 1 && y < height - 1; }
  // At a place inside, in pixels from the middle of the first one.
  float between(double x, double y) const {
    const int ix = static_cast<int>(x), iy = static_cast<int>(y);
    const auto fx = static_cast<float>(x - ix), fy = static_cast<float>(y - iy);
    const float above = at(ix, iy) + fx * (at(ix + 1, iy) - at(ix, iy));
    const float below = at(ix, iy + 1) + fx * (at(ix + 1, iy + 1) - at(ix, iy + 1));
    return above + fy * (below - above);
  }
};

// The root of the luminance, which is near what the eye calls lightness, with a mean of 1, averaged over squares of
// `step` pixels. Steps need not be whole.
Plane lightness(const image::Image& image, double step) {
  Plane plane(std::max(2, static_cast<int>(std::lround(image.width / step))),
              std::max(2, static_cast<int>(std::lround(image.height / step))));
  plane.middle_x = 0.5 * image.width / step - 0.5, plane.middle_y = 0.5 * image.height / step - 0.5;
  parallel_for(static_cast<std::size_t>(plane.height), 16, [&](std::size_t begin, std::size_t end) {
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
      for (int x = 0; x < plane.width; ++x) {
        const int x0 = std::clamp(static_cast<int>(x * step), 0, image.width - 1);
        const int y0 = std::clamp(static_cast<int>(y * step), 0, image.height - 1);
        const int x1 = std::clamp(static_cast<int>(std::ceil((x + 1) * step)), x0 + 1, image.width);
        const int y1 = std::clamp(static_cast<int>(std::ceil((y + 1) * step)), y0 + 1, image.height);
        float sum = 0;
        for (int v = y0; v < y1; ++v)
          for (int u = x0; u < x1; ++u) {
            const float* p = image.pixel(u, v);
            const float luminance = 0.26F * p[0] + 0.68F * p[1] + 0.06F * p[2];
            if (std::isfinite(luminance)) sum += std::max(0.0F, luminance);
          }
        plane.at(x, y) = std::sqrt(sum / static_cast<float>((x1 - x0) * (y1 - y0)));
      }
  });
  double mean = 0;
  for (const float value : plane.data) mean += value / static_cast<double>(plane.data.size());
  if (mean > 0)
    for (float& value : plane.data) value /= static_cast<float>(mean);
  return plane;
}

// The picture of the buffers as a display picture of it would show it, on the gray that render-osmesa puts behind a
// mesh without a background: the outlines of the mesh are edges then, whatever its color.
image::Image on_gray(const image::AovFile& file) {
  const image::Image& from = file.image;
  const auto alpha = file.channel("A");
  const auto gray = static_cast<float>(kGray * std::exp2(file.exposure_stops - file.automatic_stops));
  image::Image to = image::even_image(from.width, from.height, 3);
  for (int y = 0; y < from.height; ++y)
    for (int x = 0; x < from.width; ++x) {
      const float behind = alpha.ok() ? gray * (1 - std::clamp(from.pixel(x, y)[*alpha], 0.0F, 1.0F)) : 0;
      for (int c = 0; c < 3; ++c) to.pixel(x, y)[c] = from.pixel(x, y)[c] + behind;
    }
  return to;
}

// How strongly the lightness changes, by the central differences of the pixels around each.
Plane edges_of(const Plane& from) {
  Plane edges = Plane::like(from);
  for (int y = 1; y + 1 < from.height; ++y)
    for (int x = 1; x + 1 < from.width; ++x)
      edges.at(x, y) = std::min(
          kMostEdge, std::hypot(from.at(x + 1, y) - from.at(x - 1, y), from.at(x, y + 1) - from.at(x, y - 1)) / 2);
  return edges;
}

// Averaged with the weights 1 2 1 in either direction, so that a place near an edge knows of it.
Plane blurred(const Plane& from) {
  Plane across = Plane::like(from), both = Plane::like(from);
  for (int y = 0; y < from.height; ++y)
    for (int x = 1; x + 1 < from.width; ++x)
      across.at(x, y) = (from.at(x - 1, y) + 2 * from.at(x, y) + from.at(x + 1, y)) / 4;
  for (int y = 1; y + 1 < from.height; ++y)
    for (int x = 0; x < from.width; ++x)
      both.at(x, y) = (across.at(x, y - 1) + 2 * across.at(x, y) + across.at(x, y + 1)) / 4;
  return both;
}

// A pixel of the buffers, from their middle: how strong the edge is there.
struct Sample {
  float strength;
  double x, y;
};

// The strength of the weakest of the `most` strongest edges.
float least_of_strongest(const Plane& edges, std::size_t most) {
  std::vector<float> strengths;
  for (const float strength : edges.data)
    if (strength > kLeastEdge) strengths.push_back(strength);
  if (strengths.size() <= most) return kLeastEdge;
  const auto last = strengths.begin() + static_cast<std::ptrdiff_t>(most);
  std::nth_element(strengths.begin(), last, strengths.end(), std::greater<>());
  return *last;
}

// Pixels all over the picture, and the strongest edges: for the search of the whole domain. Without the former, the
// buffers would be shrunk onto the part of the scan that has the most edges.
std::vector<Sample> spread_samples(const Plane& edges) {
  const float least = least_of_strongest(edges, kCoarseEdges);
  std::vector<Sample> samples;
  for (int y = 0; y < edges.height; ++y)
    for (int x = 0; x < edges.width; ++x)
      if (edges.at(x, y) > least || (x % 3 == 1 && y % 3 == 1))
        samples.push_back({edges.at(x, y), x - edges.middle_x, y - edges.middle_y});
  return samples;
}

// Pixels at most two away from the strongest edges: for the last part of the way, on which the noise of places without
// edges would only disturb.
std::vector<Sample> samples_at_edges(const Plane& edges) {
  constexpr int kReach = 2;
  const float least = least_of_strongest(edges, kFineEdges);
  std::vector<std::uint8_t> near(edges.data.size(), 0);
  for (int y = kReach; y < edges.height - kReach; ++y)
    for (int x = kReach; x < edges.width - kReach; ++x)
      if (edges.at(x, y) > least)
        for (int v = y - kReach; v <= y + kReach; ++v)
          std::fill_n(&near[static_cast<std::size_t>(v) * edges.width + x - kReach], 2 * kReach + 1, std::uint8_t{1});
  std::vector<Sample> samples;
  for (int y = 0; y < edges.height; ++y)
    for (int x = 0; x < edges.width; ++x)
      if (near[static_cast<std::size_t>(y) * edges.width + x])
        samples.push_back({edges.at(x, y), x - edges.middle_x, y - edges.middle_y});
  return samples;
}

// Both pictures at one size: a pixel of either is `step` pixels of the buffers.
struct Level {
  double step;
  Plane buffers, scan;  // edges
  std::vector<Sample> samples;
};

Level level_of(const image::Image& shown, const Picture& picture, double fitting_scale, double step, bool coarse) {
  Level level{
      step, edges_of(lightness(shown, step)), blurred(edges_of(lightness(picture.rgb, step * fitting_scale))), {}};
  level.buffers = blurred(level.buffers);
  level.samples = coarse ? spread_samples(level.buffers) : samples_at_edges(level.buffers);
  return level;
}

// A similarity between the two planes of a level: scale (1 where the buffers just fit), turn (rad), and shift (pixels).
using Pose = std::array<double, 4>;

bool is_in_domain(const Pose& pose) {
  constexpr double kRoom = 0.02;  // so that a pose at the edge of the domain can be climbed to
  return pose[0] > kSmallestFit - kRoom && pose[0] < kLargestFit + kRoom &&
         std::abs(pose[1]) < kMostTurn_deg * kDegree + kRoom;
}

// The correlation of the edges at the samples that lie in the scan; -1 where fewer than 3 in 4 do.
double score(const Level& level, const Pose& pose) {
  constexpr double kLeastSeen = 0.75;
  if (!is_in_domain(pose)) return -1;
  const double c = pose[0] * std::cos(pose[1]), s = pose[0] * std::sin(pose[1]);
  const double mx = level.scan.middle_x + pose[2], my = level.scan.middle_y + pose[3];
  double n = 0, a = 0, b = 0, aa = 0, bb = 0, ab = 0;
  for (const Sample& sample : level.samples) {
    const double x = mx + c * sample.x - s * sample.y, y = my + s * sample.x + c * sample.y;
    if (!level.scan.holds(x, y)) continue;
    const double p = sample.strength, q = level.scan.between(x, y);
    n += 1, a += p, b += q, aa += p * p, bb += q * q, ab += p * q;
  }
  const double spread = (n * aa - a * a) * (n * bb - b * b);
  return spread > 0 && n >= kLeastSeen * static_cast<double>(level.samples.size())
             ? (n * ab - a * b) / std::sqrt(spread)
             : -1;
}

// The best pose of a grid over the whole domain, whose steps are about a pixel at the rim.
Pose coarse_pose(const Level& level) {
  const double radius = 0.5 * std::hypot(level.buffers.width, level.buffers.height);
  const int turns = static_cast<int>(std::ceil(kMostTurn_deg * kDegree * radius)),
            scales = static_cast<int>((kLargestFit - kSmallestFit) * radius);
  std::vector<std::pair<double, Pose>> best(static_cast<std::size_t>((2 * turns + 1) * (scales + 1)),
                                            {-1, Pose{1, 0, 0, 0}});
  parallel_for(best.size(), 4, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const int turn = static_cast<int>(i) % (2 * turns + 1) - turns, scale = static_cast<int>(i) / (2 * turns + 1);
      Pose pose = {kSmallestFit + (kLargestFit - kSmallestFit) * scale / scales, kMostTurn_deg * kDegree * turn / turns,
                   0, 0};
      // The buffers stay within the scan but for a rim of 8 % that may be cut off.
      const int reach_x =
          static_cast<int>(0.5 * std::abs(level.scan.width - pose[0] * level.buffers.width) + 0.08 * level.scan.width);
      const int reach_y = static_cast<int>(0.5 * std::abs(level.scan.height - pose[0] * level.buffers.height) +
                                           0.08 * level.scan.height);
      for (int dy = -reach_y; dy <= reach_y; ++dy)
        for (int dx = -reach_x; dx <= reach_x; ++dx) {
          pose[2] = dx, pose[3] = dy;
          const double here = score(level, pose);
          if (here > best[i].first) best[i] = {here, pose};
        }
    }
  });
  return std::ranges::max_element(best, {}, [](const auto& one) { return one.first; })->second;
}

// Climbs to the nearest best pose: steps of a pixel at the rim in each of the four numbers, halved where none helps.
Pose climbed(const Level& level, Pose pose) {
  const double radius = 0.5 * std::hypot(level.buffers.width, level.buffers.height);
  const Pose unit = {1 / radius, 1 / radius, 1, 1};
  double best = score(level, pose);
  for (double step = 1; step > 0.02; step /= 2) {
    for (bool better = true; better;) {
      better = false;
      for (std::size_t i = 0; i < pose.size(); ++i)
        for (const double sign : {-1.0, 1.0}) {
          Pose next = pose;
          next[i] += sign * step * unit[i];
          const double here = score(level, next);
          if (here > best + 1e-9) best = here, pose = next, better = true;
        }
    }
  }
  return pose;
}

// The place of a pixel of the buffers in the scan, and the sum or worst of what is there.
class Placer {
 public:
  Placer(const Registration& r, int scan_width, int scan_height, int width, int height)
      : c_(r.scale * std::cos(r.turn_deg * kDegree)),
        s_(r.scale * std::sin(r.turn_deg * kDegree)),
        middle_x_(0.5 * scan_width + r.shift_x),
        middle_y_(0.5 * scan_height + r.shift_y),
        half_x_(0.5 * width),
        half_y_(0.5 * height),
        samples_(std::clamp(static_cast<int>(std::ceil(r.scale)), 1, 16)) {}

  // Calls take(x, y) with the places in the scan (pixels from its corner) of a grid of samples over one pixel.
  template <class Take>
  void for_samples(int x, int y, Take&& take) const {
    for (int j = 0; j < samples_; ++j)
      for (int i = 0; i < samples_; ++i) {
        const double qx = x + (i + 0.5) / samples_ - half_x_, qy = y + (j + 0.5) / samples_ - half_y_;
        take(middle_x_ + c_ * qx - s_ * qy, middle_y_ + s_ * qx + c_ * qy);
      }
  }
  int count() const { return samples_ * samples_; }

 private:
  double c_, s_, middle_x_, middle_y_, half_x_, half_y_;
  int samples_;
};

// The four pixels around a place and their weights; false where it is beyond the picture.
struct Around {
  std::array<std::size_t, 4> place;
  std::array<float, 4> weight;
};
bool around(double x, double y, int width, int height, Around& four) {
  if (!(x >= 0 && y >= 0 && x <= width && y <= height)) return false;
  const double px = std::clamp(x - 0.5, 0.0, width - 1.0), py = std::clamp(y - 0.5, 0.0, height - 1.0);
  const int x0 = static_cast<int>(px), y0 = static_cast<int>(py);
  const int x1 = std::min(x0 + 1, width - 1), y1 = std::min(y0 + 1, height - 1);
  const auto fx = static_cast<float>(px - x0), fy = static_cast<float>(py - y0);
  const auto at = [&](int u, int v) { return static_cast<std::size_t>(v) * width + u; };
  four = {{at(x0, y0), at(x1, y0), at(x0, y1), at(x1, y1)},
          {(1 - fx) * (1 - fy), fx * (1 - fy), (1 - fx) * fy, fx * fy}};
  return true;
}

// The similarity at which the edges of `shown`, a picture of the buffers' size, and of the scan meet best. The whole
// domain is searched where a picture has some fifty pixels, by the correlation of how strong the edges of both are.
// From there the correlation is climbed in pictures twice as large, and so on up to the buffers' own pixels.
Registration best_of(const image::Image& shown, const Picture& scan) {
  const double fitting =
      std::min(scan.rgb.width / static_cast<double>(shown.width), scan.rgb.height / static_cast<double>(shown.height));
  // The pixels of the coarser picture are not divided.
  const double finest = std::max(1.0, 1 / fitting);
  const double coarse = std::min(std::max(shown.width, shown.height) / static_cast<double>(kCoarse),
                                 std::min(shown.width, shown.height) / static_cast<double>(kLeastSide));
  double step = std::max(finest, coarse);
  // Where so few pixels are left that any two pictures agree, nothing is found.
  if (std::min(shown.width, shown.height) / step < kLeastSide - 0.5) return {};
  Level level = level_of(shown, scan, fitting, step, true);
  Pose pose = climbed(level, coarse_pose(level));
  const double agreement = score(level, pose);
  while (step > finest && agreement >= kLeastAgreement) {
    const double finer = std::max(finest, step / 2);
    pose[2] *= step / finer, pose[3] *= step / finer;
    step = finer;
    level = level_of(shown, scan, fitting, step, false);
    pose = climbed(level, pose);
  }
  return {pose[0] * fitting, pose[1] / kDegree, pose[2] * step * fitting, pose[3] * step * fitting, agreement};
}

}  // namespace

Result<Registration> registration_of(const image::AovFile& buffers, const Picture& scan) {
  // The background behind the mesh in the scan is not known: the picture as it is stored, or the gray of a display
  // picture.
  Registration found = best_of(on_gray(buffers), scan);
  if (const Registration stored = best_of(buffers.image, scan); stored.agreement > found.agreement) found = stored;
  if (found.agreement >= kLeastAgreement) return found;
  return input_error(
      "the picture is {} x {} pixels, the buffers of {} are {} x {}, and their edges do not meet at any scale, turn up "
      "to {:.0f} deg and shift (correlation {:.2f}): bring both to one size",
      scan.rgb.width, scan.rgb.height, buffers.path, buffers.image.width, buffers.image.height, kMostTurn_deg,
      found.agreement);
}

Picture registered(const Picture& scan, const Registration& registration, int width, int height) {
  Picture result;
  result.rgb = image::even_image(width, height, 3);
  result.state.assign(static_cast<std::size_t>(width) * height, Picture::kGood);
  result.scene_linear = scan.scene_linear, result.space = scan.space, result.warnings = scan.warnings;
  const Placer placer(registration, scan.rgb.width, scan.rgb.height, width, height);
  parallel_for(static_cast<std::size_t>(height), 16, [&](std::size_t begin, std::size_t end) {
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
      for (int x = 0; x < width; ++x) {
        float* to = result.rgb.pixel(x, y);
        std::uint8_t& state = result.state[static_cast<std::size_t>(y) * width + x];
        placer.for_samples(x, y, [&](double sx, double sy) {
          Around four;
          if (!around(sx, sy, scan.rgb.width, scan.rgb.height, four)) {
            state = Picture::kTransparent;
            return;
          }
          for (int k = 0; k < 4; ++k) {
            if (four.weight[k] == 0) continue;
            state = std::max(state, scan.state[four.place[k]]);
            for (int c = 0; c < 3; ++c) to[c] += four.weight[k] * scan.rgb.data[3 * four.place[k] + c];
          }
        });
        for (int c = 0; c < 3; ++c) to[c] /= static_cast<float>(placer.count());
      }
  });
  return result;
}

image::Image registered(const image::Image& mask, const Registration& registration, int width, int height) {
  image::Image result = image::even_image(width, height, 1);
  const Placer placer(registration, mask.width, mask.height, width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      placer.for_samples(x, y, [&](double sx, double sy) {
        Around four;
        if (!around(sx, sy, mask.width, mask.height, four)) return;
        for (int k = 0; k < 4; ++k)
          *result.pixel(x, y) +=
              four.weight[k] * mask.data[four.place[k] * mask.channels] / static_cast<float>(placer.count());
      });
  return result;
}

}  // namespace goniochrome::sketch
