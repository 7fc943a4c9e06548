// A picture beside the reference integrator. goniochrome-plan(7), "REFERENCE INTEGRATOR".
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "math/statistics.h"
#include "render/exact.h"
#include "render/gbuffer.h"
#include "render/renderer.h"
#include "render/scene.h"

namespace goniochrome::render {

// The difference between a picture and the reference.
struct PictureError {
  int checked_pixels = 0;
  double de00_mean = 0, de00_p95 = 0, de00_max = 0;
  math::Range p95_range{0, 0};  // of one standard error of de00_p95, by the choice of pixels
  std::size_t visible_pixels = 0;
  int worst_x = 0, worst_y = 0;
  double time_s = 0;
};

// Random visible pixels that show no panes, `count` of them or all where there are fewer: their places in the picture
// and their points.
struct PixelSample {
  std::vector<std::array<int, 2>> places;
  std::vector<VisiblePoint> points;
  std::size_t visible = 0;  // pixels that may be drawn
  const float* pixel(const image::Image& image, std::size_t i) const { return image.pixel(places[i][0], places[i][1]); }
};
PixelSample sampled_pixels(const Gbuffer& gbuffer, const Scene& scene, int count, std::uint64_t seed);

// The figures of the differences at the places of the sample, but for the time.
PictureError error_of(const PixelSample& sample, const std::vector<double>& de00);

// Compares the centers of `count` random visible pixels (all, where there are fewer) with the reference, as CIEDE2000
// of Lab values relative to `white_luminance`, D65. The frame must hold its centers. The reference has everything that
// the scene calls for.
PictureError picture_error(const Frame& frame, const Scene& scene, const Surroundings& around, double white_luminance,
                           int count, std::uint64_t seed);

}  // namespace goniochrome::render
