#include "render/internal/samples.h"

#include <cmath>

#include "render/glints.h"
#include "render/surface_layer.h"

namespace goniochrome::render {

namespace {

class Samples {
 public:
  Samples(Sight& sight, Engine& engine, const Scene& scene, const Effects& effects, int count)
      : sight_(sight), engine_(engine), scene_(scene), effects_(effects), gain_(1.0F / static_cast<float>(count)) {}

  Result<void> shade(int first, int count, image::Image& picture) {
    for (int i = first; i < first + count; ++i) GONIO_TRY(engine_.shade(sight_, i, gain_, i > first, picture));
    engine_.finish(picture);
    return {};
  }
  void add_glints_of(int sample, image::Image& picture) {
    if (!engine_.info().traces_rays && effects_.extent && effects_.mirror)
      add_glints(scene_, effects_, *sight_.gbuffer(sample), gain_, picture);
  }
  void add_layer(int sample, image::Image& picture) {
    if (scene_.layer != nullptr && !engine_.shades_layer())
      scene_.layer->add(*sight_.gbuffer(sample), sight_.places(sample), effects_, gain_, picture,
                        sight_.seen_pixels(sample));
  }

 private:
  Sight& sight_;
  Engine& engine_;
  const Scene& scene_;
  const Effects& effects_;
  float gain_;
};

}  // namespace

// Textures dim what lies beneath them in one sample, before it is added to the others.
Result<void> take_samples(Sight& sight, Engine& engine, const Scene& scene, const Effects& effects, int first,
                          int count, image::Image& picture) {
  Samples samples(sight, engine, scene, effects, count);
  const bool dims = scene.layer != nullptr && scene.layer->dims() && !engine.shades_layer();
  if (!dims) {
    GONIO_TRY(samples.shade(first, count, picture));
    for (int i = first; i < first + count; ++i) samples.add_glints_of(i, picture);
    for (int i = first; i < first + count; ++i) samples.add_layer(i, picture);
  }
  image::Image one;
  for (int i = first; dims && i < first + count; ++i) {
    GONIO_TRY(samples.shade(i, 1, one));
    samples.add_glints_of(i, one);
    samples.add_layer(i, one);
    if (i == first) {
      picture = one;
      continue;
    }
    for (std::size_t k = 0; k < one.data.size(); ++k) picture.data[k] += one.data[k];
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
