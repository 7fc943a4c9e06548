// The engine path follows light on its way: it draws shadows, the body mirrored in itself, light that surfaces pass on,
// floors and parts that shine, without prefiltered maps and without OpenGL. goniochrome-paths(7), "PATHS".
#pragma once

#include <memory>
#include <optional>

#include "render/engine.h"
#include "render/internal/bands.h"
#include "render/path/ray_correction.h"
#include "render/path/transport.h"

namespace goniochrome::render {

// The scene in which the engine follows paths, made of a scene that it can shade. The scene must outlive it. `rays`:
// its mesh with its floor, where they are there already; null: they are made.
PathScene path_scene_of(const Scene& scene, std::shared_ptr<const rays::RayScene> rays);

class PathEngine : public Engine {
 public:
  static const EngineInfo kInfo;

  explicit PathEngine(const Sight& sight) : sight_(sight) {}

  const EngineInfo& info() const override { return kInfo; }
  // Error: no mesh; an environment without the image that it was made from; a floor that shows an environment that is
  // not there.
  Result<void> can_shade(const Scene& scene) const override;
  // Samples are drawn until the noise is within Effects::tolerance_de00. Error: as Transport::create().
  Result<void> load(const Scene& scene, const Effects& effects) override;
  void load_paints(const Scene& scene) override;
  // The samples of a picture are drawn together, with the first of them. Bit-identical for any number of threads,
  // unless Effort::time_limit_s ends it.
  Result<void> shade(Sight& sight, int sample, float gain, bool add, image::Image& rgba) override;
  // Parts that send back more light than they get; a floor above the lowest point of the mesh.
  std::vector<std::string> remarks() const override;
  const Noise* noise() const override { return noise_ ? &*noise_ : nullptr; }
  bool shades_layer() const override { return true; }

 private:
  // With Background::kNone what the scene covers of each pixel, alone.
  void draw_background(const Rays& rays, int samples, image::Image& rgba) const;
  // Draws the kept rows of a band, after those that are drawn.
  void draw_band(const Gbuffer& whole, const Band& band, PathRequest request, CorrectionNoise& drawn,
                 image::Image& rgba);

  const Sight& sight_;
  Scene scene_;
  Effects effects_;
  double white_luminance_ = 1;
  std::optional<Transport> transport_;
  std::optional<std::pair<int, std::uint64_t>> aimed_;  // the bounces and the seed of its bright places; none: not yet
  std::optional<Error> failure_;                        // of load_paints(), which cannot tell it
  std::optional<Noise> noise_;
};

}  // namespace goniochrome::render
