#include "render/internal/samples.h"

#include <cmath>

#include "render/glints.h"
#include "render/surface_layer.h"

namespace goniochrome::render {

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

std::array<double, 2> shift_of(int sample, int samples) {
  if (sample == 0) return {0, 0};
  return sample_shifts(samples)[static_cast<std::size_t>(sample - 1)];
}

std::array<double, 2> to_middle_of_part(int sample, int samples) {
  std::array<double, 2> result = shift_of(sample, samples);
  const double squares = std::round(std::sqrt(samples));
  for (double& shift : result)
    shift = sample == 0 ? 0 : (std::floor((shift + 0.5) * squares) + 0.5) / squares - 0.5 - shift;
  return result;
}

}  // namespace goniochrome::render
