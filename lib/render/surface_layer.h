// What the lobe model of a part cannot show, added to a picture pixel by pixel on the processor, whatever engine drew
// the rest: textures of generalized cosine lobes, and under lights the colors of a color map. goniochrome-theory(7),
// RENDERING.
#pragma once

#include <memory>
#include <vector>

#include "brdf/color_map.h"
#include "brdf/sbrdf.h"
#include "image/image.h"
#include "render/gbuffer.h"
#include "render/scene.h"
#include "render/visible_point.h"

namespace goniochrome {

// The surface of a part beyond its paint. A part with a texture has a paint without weights.
struct PartSurface {
  const SbrdfTexture* texture = nullptr;
  double repeat = 1;  // how many times the texture is laid where its coordinates run from 0 to 1
  const ColorMap* color_map = nullptr;
};

class SurfaceLayer {
 public:
  // One surface for each part of the scene's mesh; none where there are fewer. All must outlive the layer.
  SurfaceLayer(const Scene& scene, std::vector<PartSurface> surfaces, CriticalAngle treatment);
  ~SurfaceLayer();

  // Whether there is nothing to add, and what there is: textures, and color maps under lights.
  bool empty() const { return !textured_ && !mapped_; }
  bool textured() const { return textured_; }
  bool mapped() const { return mapped_; }
  const PartSurface& surface(int part) const { return surfaces_[static_cast<std::size_t>(part)]; }

  // Adds `weight` times the layer, with or without its color maps, to the RGB of every pixel. `eye` is that of the
  // G-buffer's camera. Of a color map it adds the difference to what the lobe model shows of the same light, gloss
  // apart. Bit-identical for any number of threads.
  void add(const Gbuffer& gbuffer, const Vec3& eye, float weight, Image& rgba, bool with_maps = true) const;

  // The color map's part at one point: radiance under the scene's lights less that of the paint's flake lobes.
  Rgb mapped_difference(int part, const Vec3& normal, const Vec3& to_viewer) const;

  // The radiance of one texel of a textured part, its tangent level.
  Rgb texel_radiance(int part, int column, int row, const Vec3& normal, const Vec3& to_viewer) const;

 private:
  struct Shader;
  const Scene& scene_;
  std::vector<PartSurface> surfaces_;
  CriticalAngle treatment_;
  bool textured_ = false, mapped_ = false;
  std::unique_ptr<Shader> shader_;
};

// Adds what the scene's color maps change under its lights to the colors of these points.
void add_mapped(const Scene& scene, const std::vector<VisiblePoint>& points, std::vector<Rgb>& colors);

// Adds what its textures show. Where on its texture a point lies is not known: each takes another texel, which is
// enough to tell what a texture is worth.
void add_textured(const Scene& scene, const std::vector<VisiblePoint>& points, std::vector<Rgb>& colors);

}  // namespace goniochrome
