#include "render/plan/path_price.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "render/internal/seen.h"
#include "render/path/path_tracer.h"

namespace goniochrome::render {

namespace {

// The windows of each kind, and the pixels along their sides.
constexpr std::size_t kMostWindows = 48;
constexpr int kSide = 4;
// The most samples of a pixel in them, first and then: what the engine has after its second round and its third.
constexpr int kFewSamples = 48, kManySamples = 176;
// The most by which the samples that are needed fall while more are drawn: as this power of their number.
constexpr double kFalling = -0.6;
// What the engine draws of every pixel to begin with, beyond the percentile of all needs, and beyond what it lacks.
constexpr double kFewest = 8, kBeyond = 1.05, kRaised = 1.1;

// Of a pixel: the samples that its neighborhood asks for, and those that its own noise does.
struct Need {
  double samples = 0, own = 0;
};

// Of pixels of one kind.
struct Needs {
  std::vector<Need> pixels;
  double sample_ms = 0;  // on all cores together

  double percentile() const {
    std::vector<double> all;
    for (const Need& need : pixels) all.push_back(need.samples);
    return percentile_95(std::move(all));
  }
  // By how much the noise is above the tolerance where the neighborhoods are content. What needs less than the fewest
  // has samples to spare.
  double lacking(double most) const {
    std::vector<double> all;
    for (const Need& need : pixels)
      if (need.samples > 0) all.push_back(need.own / std::max(kFewest, std::min(need.samples, most)));
    return percentile_95(std::move(all));
  }
  double mean(double most, double scale) const {
    double sum = 0;
    for (const Need& need : pixels)
      if (need.samples > 0) sum += std::max(kFewest, scale * std::min(need.samples, most));
    return pixels.empty() ? 0 : sum / static_cast<double>(pixels.size());
  }
};

// A window of the picture about a pixel, by the rays through it.
VisibleSurface window_about(const Transport& transport, const ProbePixel& at, int pixel_samples) {
  const Gbuffer& g = *at.gbuffer;
  const int width = std::min(kSide, g.width), height = std::min(kSide, g.height);
  const int left = std::clamp(at.x - width / 2, 0, g.width - width),
            top = std::clamp(at.y - height / 2, 0, g.height - height);
  const Rays rays = g.rays.shifted(left, top);
  if (pixel_samples == 1) return visible_surface(transport.eye(), rays, width, height);
  VisibleSurface surface;
  surface.gbuffer.width = width, surface.gbuffer.height = height, surface.gbuffer.rays = rays;
  return surface;
}

Needs needs_of(const Transport& transport, const PathWork& work, const std::vector<ProbePixel>& pixels,
               int most_samples) {
  Needs needs;
  if (pixels.empty()) return needs;
  const std::size_t step = (pixels.size() + kMostWindows - 1) / kMostWindows, count = (pixels.size() + step - 1) / step;
  std::vector<PathPicture> windows(count);
  PathRequest request;
  request.options.bounces = work.bounces;
  request.tolerance_de00 = work.tolerance_de00;
  request.most_samples = most_samples;
  request.white_luminance = work.white_luminance > 0 ? work.white_luminance : 1;
  request.pixel_samples = work.pixel_samples;
  parallel_for(count, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      PathRequest of_window = request;
      of_window.seed = mixed(work.seed, i);
      const VisibleSurface surface = window_about(transport, pixels[i * step], work.pixel_samples);
      windows[i] = path_picture(transport, surface, nullptr, of_window);
    }
  });
  double samples = 0, seconds = 0;
  for (const PathPicture& window : windows) {
    seconds += window.time_s;
    for (const PathPoint& point : window.points) {
      samples += point.samples;
      const double ratio = point.noise_de00 / work.tolerance_de00;
      needs.pixels.push_back({point.samples > 0 ? point.needed_samples : 0, point.samples * ratio * ratio});
    }
  }
  if (samples > 0) needs.sample_ms = 1000 * seconds / samples / threads();
  return needs;
}

// Of all pixels together, as told by windows in so many samples.
struct Told {
  double samples = 0, ms = 0;
};

// As path_picture() shares out its samples: the noise of the mesh and that of the floor each have to be within the
// tolerance, and what needs most gets little more than the worse of their percentiles. Where that does not bring the
// noise to the tolerance, all get more.
Told told_by(const Transport& transport, const PathWork& work, int most_samples) {
  const Needs mesh = needs_of(transport, work, work.mesh, most_samples),
              floor = needs_of(transport, work, work.floor, most_samples);
  const double most = kBeyond * std::max(mesh.percentile(), floor.percentile());
  const double lacking = std::max(mesh.lacking(most), floor.lacking(most)), scale = lacking > 1 ? kRaised * lacking : 1;
  const double of_mesh = work.mesh_pixels * mesh.mean(most, scale),
               of_floor = work.floor_pixels * floor.mean(most, scale);
  return {of_mesh + of_floor, of_mesh * mesh.sample_ms + of_floor * floor.sample_ms};
}

}  // namespace

// The longer sequences are the more evenly they cover what a pixel sees, so that fewer samples do. What needs more of
// them than the windows have goes on falling as it fell from the few to the many: n^p of n samples. That it rose tells
// of single bright paths that were found, and not that it goes on.
PathPrice path_price(const Transport& transport, const PathWork& work) {
  const double pixels = work.mesh_pixels + work.floor_pixels;
  if (!(work.tolerance_de00 > 0) || !(pixels > 0)) return {};
  const Told many = told_by(transport, work, kManySamples);
  const PathPrice price{many.samples / pixels, many.ms};
  if (price.samples <= kManySamples) return price;
  const Told few = told_by(transport, work, kFewSamples);
  const double power =
      std::clamp(std::log(many.samples / few.samples) / std::log(double{kManySamples} / kFewSamples), kFalling, 0.0);
  const double change = std::pow(price.samples / kManySamples, power / (1 - power));
  return {change * price.samples, change * price.ms};
}

}  // namespace goniochrome::render
