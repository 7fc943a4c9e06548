// The surface layer holds what the lobe model of a part cannot show: textures of generalized cosine lobes, and the
// colors of a color map under directional lights. It is added to a picture pixel by pixel on the processor.
// goniochrome-surfaces(7), "Drawing".
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "brdf/color_map.h"
#include "brdf/sbrdf.h"
#include "image/image.h"
#include "render/effects.h"
#include "render/gbuffer.h"
#include "render/scene.h"
#include "render/textures/sbrdf.h"
#include "render/textures/seen_pixels.h"
#include "render/textures/texture_places.h"

namespace goniochrome::render {

// A texture and how it lies on a part.
struct LaidTexture {
  const brdf::SbrdfTexture* texture = nullptr;
  double repeat = 1;  // how many times the texture is laid where its coordinates run from 0 to 1
  TextureLaying laying = {};
  // True if it is one more projection of the texture beneath it: what they show is added up by their shares, and not
  // laid over each other.
  bool blends = false;
};

// The surface of a part beyond its paint. A part whose paint is not seen has one without weights.
struct PartSurface {
  std::vector<LaidTexture> textures = {};     // from the lowest one on
  const brdf::ColorMap* color_map = nullptr;  // of the paint

  // True if no place of the part shows the paint: the lowest texture has no alpha.
  bool hides_paint() const { return !textures.empty() && textures.front().texture->alpha.empty(); }
};

// The most textures of a part.
constexpr std::size_t kMostLaid = 12;

class SurfaceLayer {
 public:
  // One surface for each part of the scene's mesh; none where there are fewer. All must outlive the layer. With `mip`
  // the lobes of textures are fetched from there, else from the maps of the scene's environment.
  SurfaceLayer(const Scene& scene, std::vector<PartSurface> surfaces, brdf::CriticalAngle treatment,
               const MipCube* mip = nullptr);
  ~SurfaceLayer();

  // True if no part has a surface beyond its paint.
  bool empty() const { return empty_; }
  // True if there is anything to add to a picture that an engine drew by lobes: textures, and color maps under lights.
  // Paths evaluate color maps under every light.
  bool textured() const { return textured_; }
  // True if a paint is seen through a texture, so that the picture beneath the layer is dimmed. It must then hold one
  // sample alone.
  bool dims() const { return dims_; }
  bool mapped() const { return mapped_; }
  const PartSurface& surface(int part) const { return surfaces_[static_cast<std::size_t>(part)]; }
  brdf::CriticalAngle treatment() const { return treatment_; }
  // No other layer has it.
  std::uint64_t id() const { return id_; }
  // The textures, and then the mean texel of each; null where there are none.
  const SbrdfShader* shader() const { return shader_.get(); }
  // The most lobes of a texture.
  int lobes() const;

  // One texture that a point shows: its number, the place in it (as it is, and with the repetition), its probes, and
  // its part of what is seen.
  struct Shown {
    std::size_t number = 0;
    const TexturePlace* place = nullptr;
    double repeat = 1;
    TexturePlace repeated = {};
    FilterProbes probes = {};
    double share = 1;
  };
  // The light of all textures at a point, and the part of the paint beneath that is seen. `places` are those on each
  // texture of the part, `step` apart. A sample covers `scale` times their footprints along each side.
  struct Stack {
    std::size_t count = 0;
    std::array<Shown, kMostLaid> shown;
    double bare = 1;
  };
  void stack(int part, const TexturePlace* places, std::size_t step, const Effects& effects, double scale,
             Stack& result) const;

  // Where the textured parts of a G-buffer's pixels lie on their textures, those of all pixels on the lowest texture
  // first, see Gbuffer::point(); empty without textures.
  std::vector<TexturePlace> places(const Gbuffer& gbuffer) const;
  // Places with footprints, whose middles lie so far from the points, in pixels to the right and downward.
  std::vector<TexturePlace> filtered_places(const Gbuffer& gbuffer, const std::array<double, 2>& middle = {}) const;
  // Puts those of one pixel, with their footprints, which are `scale` times as large, on a point. They count as known
  // where it matters which place is covered. Leaves it alone where it shows no texture or the G-buffer has no
  // triangles.
  void put_places(const Gbuffer& gbuffer, int x, int y, double scale, VisiblePoint& point) const;
  // How many texels its footprint covers, 1 or more.
  double covered_texels(const VisiblePoint& point) const;

  // Adds `weight` times the layer, as far as the effects have it, to the RGB of every pixel; a part whose texture is
  // left out shows its mean texel. `places` are those of the G-buffer. Of a color map it adds the difference to what
  // the lobe model shows of the same light, gloss apart. What is in the picture is dimmed where textures cover it.
  // With the effect texture_filter, the weight is also the part of its pixel that a sample stands for.
  // What the pixels show of textures is taken from `kept` as far as it is there, and left there, if it is not null; the
  // caller lets it forget what belongs to another G-buffer. Bit-identical for any number of threads.
  void add(const Gbuffer& gbuffer, const std::vector<TexturePlace>& places, const Effects& effects, float weight,
           image::Image& rgba, SeenPixels* kept = nullptr) const;

  // The color map's part at one point: radiance under the scene's lights less that of the paint's flake lobes, drawn
  // with the effect `coat` or without it.
  color::Rgb mapped_difference(int part, const Vec3& normal, const Vec3& to_viewer, bool coat = true,
                               const Vec3& position = {}) const;

  // Adds to the colors of these points what color maps change under the scene's lights.
  void add_mapped(const std::vector<VisiblePoint>& points, bool coat, std::vector<color::Rgb>& colors) const;

  // Adds the layer to the colors of these points. One whose place on its texture is not known takes another place for
  // each, which is enough to tell what a texture is worth.
  void add(const std::vector<VisiblePoint>& points, const Effects& effects, std::vector<color::Rgb>& colors) const;

  // Texels, in the frame of normal and tangent, and their shares: what a textured point consists of, besides a part of
  // its paint.
  struct Piece {
    brdf::SbrdfTexel texel;
    double share = 1;
    Vec3 tangent = {};
    Vec3 own = {0, 0, 1};  // its normal, for brdf::texel_normal()
    Vec3 normal(const Vec3& surface, const Vec3& to_viewer) const {
      return brdf::texel_normal(own, surface, tangent, to_viewer);
    }
  };
  struct Place {
    std::vector<Piece> pieces;
    double bare = 0;
  };
  // The place of the point of this number; its lobes that the effects have.
  Place place(const VisiblePoint& point, std::size_t number, const Effects& effects) const;
  // The place of a point of the mesh on a part that has a texture: all its lobes. Of the point the triangle and the
  // shares are read. `inside`: whether it is seen from its back.
  Place place(int part, const MeshPoint& point, bool inside) const;

 private:
  static constexpr std::size_t kRowsOfBand = 8;
  // Finds what a band shows, in all pixels or in those that are wanted.
  void see(const Gbuffer& gbuffer, int first_row, int end_row, const std::vector<TexturePlace>& places,
           const Effects& effects, double scale, bool all, SeenBand& band) const;
  void shade(const Gbuffer& gbuffer, const SeenBand::Bin& bin, const std::vector<TexturePlace>& places,
             const SbrdfLight& light, bool placed, float weight, image::Image& rgba) const;
  void add_mapped(const Gbuffer& gbuffer, int first_row, int end_row, const Effects& effects, float weight,
                  image::Image& rgba) const;
  struct Laid {
    std::size_t texture = 0;
    double repeat = 1;
    bool blends = false;
  };
  std::size_t shading_of(const Laid& laid, const Effects& effects) const;
  double coverage(const Shown& shown, double scale, std::uint32_t lobes) const;
  Place place(int part, const std::vector<TexturePlace>& places, const Effects& effects) const;
  std::vector<TexturePlace> placed(const VisiblePoint& point, std::size_t number) const;

  const Scene& scene_;
  std::vector<PartSurface> surfaces_;
  brdf::CriticalAngle treatment_;
  std::uint64_t id_;
  bool empty_ = true, textured_ = false, mapped_ = false, dims_ = false;
  std::vector<const brdf::SbrdfTexture*> textures_;  // each once
  std::vector<brdf::SbrdfTexture> means_;            // of the same
  std::unique_ptr<const SbrdfShader> shader_;        // of the textures, then of the means
  std::vector<std::vector<Laid>> laid_;              // on each part, the lowest first
  std::vector<std::unique_ptr<const TextureLayout>>
      layouts_;  // of the lowest textures of all parts, of those over them
};

}  // namespace goniochrome::render
