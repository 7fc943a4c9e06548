#include "render/internal/samples.h"

#include <algorithm>
#include <cmath>

#include "render/glints.h"
#include "render/surface_layer.h"

namespace goniochrome::render {

namespace {

// The mean of a pixel may be off its center by this part of its light and of white for each dE00 of the tolerance: a
// tenth of it in middle grays. goniochrome-plan(7), "Samples of a pixel".
constexpr double kOfLight = 0.0045, kOfWhite = 0.03 * kOfLight;

// True if the picture bends too much about a pixel. A value that bends by two second differences has a mean over the
// pixel which is a 24th of their sum off its center.
bool bends(const image::Image& picture, std::size_t at, double of_light, double of_white) {
  const auto channels = static_cast<std::size_t>(picture.channels),
             row = channels * static_cast<std::size_t>(picture.width);
  for (std::size_t c = 0; c < channels; ++c) {
    const float* value = &picture.data[channels * at + c];
    const auto second = [&](std::size_t step) { return std::abs(value[step] + *(value - step) - 2 * *value); };
    if (!(second(channels) + second(row) <= 24 * (of_light * std::abs(*value) + of_white))) return true;
  }
  return false;
}

}  // namespace

// Textures dim what lies beneath them in one sample, before it is added to the others.
Result<void> take_samples(Sight& sight, Engine& engine, const Scene& scene, const Effects& effects, int first,
                          int count, image::Image& picture) {
  const float gain = 1.0F / static_cast<float>(count);
  const bool has_layer = scene.layer != nullptr && !engine.shades_layer();
  const bool has_glints = !engine.info().traces_rays && effects.extent && effects.mirror;
  const int together = has_layer && scene.layer->dims() ? 1 : count;
  image::Image one;
  for (int begin = first; begin < first + count; begin += together) {
    image::Image& into = begin == first ? picture : one;
    const int end = begin + together;
    for (int i = begin; i < end; ++i) GONIO_TRY(engine.shade(sight, i, gain, i > begin, into));
    engine.finish(into);
    for (int i = begin; has_glints && i < end; ++i) add_glints(scene, effects, *sight.gbuffer(i), gain, into);
    for (int i = begin; has_layer && i < end; ++i)
      scene.layer->add(*sight.gbuffer(i), sight.places(i), effects, gain, into, sight.seen_pixels(i));
    for (std::size_t k = 0; begin > first && k < one.data.size(); ++k) picture.data[k] += one.data[k];
  }
  picture.channel_names = {"R", "G", "B", "A"};
  return {};
}

PixelFlags wanted_centers(const PixelFlags& edges, const Gbuffer& centers) {
  PixelFlags wanted(edges.size(), 0);
  for_pixels(centers.width, centers.height, [&](int x, int y) {
    const auto is_even = [&](int u, int v) {
      return u >= 0 && v >= 0 && u < centers.width && v < centers.height && edges[centers.index(u, v)] == 0;
    };
    if (is_even(x, y) || is_even(x - 1, y) || is_even(x + 1, y) || is_even(x, y - 1) || is_even(x, y + 1))
      wanted[centers.index(x, y)] = 1;
  });
  return wanted;
}

PixelFlags wanted_pixels(const PixelFlags& edges, const image::Image& centers, double white_luminance,
                         double tolerance_de00) {
  const double of_light = kOfLight * tolerance_de00, of_white = kOfWhite * tolerance_de00 * white_luminance;
  PixelFlags wanted(edges.size());
  parallel_each(edges.size(), 4096,
                [&](std::size_t at) { wanted[at] = edges[at] != 0 || bends(centers, at, of_light, of_white) ? 1 : 0; });
  return wanted;
}

void put_wanted(const PixelFlags& wanted, const image::Image& closer, image::Image& picture) {
  const auto channels = static_cast<std::size_t>(picture.channels);
  parallel_each(wanted.size(), 4096, [&](std::size_t at) {
    if (wanted[at] != 0) std::copy_n(&closer.data[channels * at], channels, &picture.data[channels * at]);
  });
}

std::array<double, 2> to_middle_of_part(int sample, int samples) {
  if (sample == 0) return {0, 0};
  std::array<double, 2> result = sample_shifts(samples)[static_cast<std::size_t>(sample - 1)];
  const double squares = std::round(std::sqrt(samples));
  for (double& shift : result) shift = (std::floor((shift + 0.5) * squares) + 0.5) / squares - 0.5 - shift;
  return result;
}

}  // namespace goniochrome::render
