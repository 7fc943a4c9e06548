// The engine cpu shades G-buffers on the processor, without OpenGL. Maps that are looked up in one direction lie
// interleaved in memory, so that one set of addresses and one bilinear fetch serve all of their lobes.
// goniochrome-rendering(7), "Engines".
#pragma once

#include <memory>
#include <vector>

#include "base/unset_array.h"
#include "image/image.h"
#include "render/cpu/cpu_kernel.h"
#include "render/cpu/tilt_kernel.h"
#include "render/engine.h"
#include "render/internal/maps.h"
#include "render/internal/placed_lamps.h"
#include "render/scene_effects.h"

namespace goniochrome::render {

class CpuEngine : public Engine {
 public:
  static const EngineInfo kInfo;

  CpuEngine() = default;
  CpuEngine(const CpuEngine&) = delete;  // the kernel's tables point into it
  CpuEngine& operator=(const CpuEngine&) = delete;

  const EngineInfo& info() const override { return kInfo; }
  // Error: a paint shows the extent of a lamp at a place.
  Result<void> can_shade(const Scene& scene) const override { return draws_placed_lamps(scene, kInfo.name); }
  // Interleaves the maps. Error: as scene_maps(), and more face sizes than there is room for.
  Result<void> load(const Scene& scene, const Effects& effects) override;
  // The next load() is of the environment that an engine, or this one, was loaded with: interleaved maps are shared.
  void share_maps(const CpuEngine& loaded) { shared_ = loaded.stacks_; }
  void load_paints(const Scene& scene) override { load_paints(scene, effects_); }
  Result<void> shade(Sight& sight, int sample, float gain, bool add, image::Image& rgba) override;

  // Takes other paints and some of the effects that were loaded: lobes and effects whose weights are 0 cost time, but
  // are not drawn.
  void load_paints(const Scene& scene, const Effects& effects);
  // Shades all pixels of a G-buffer, as shade() above. Bit-identical for any number of threads.
  void shade(const Gbuffer& gbuffer, float gain, bool add, image::Image& rgba) const;
  // The radiance of single points, each of which gets the color of its pixel.
  std::vector<color::Rgb> colors(const std::vector<VisiblePoint>& points) const;
  // Each point in the paints of so many parts, from its own on: paint by paint. These have no tilted lobes, and one
  // coat and one brushing.
  std::vector<color::Rgb> colors(const std::vector<VisiblePoint>& points, std::size_t paints) const;

 private:
  struct Stack {
    MapClass shape;
    MapUse use = MapUse::kMirror;
    InterleavedMaps maps() const;
    int blocks = 0, texel_floats = 0;
    std::shared_ptr<const UnsetArray<float>> texels;  // maps without bright spots may be those with them
  };
  static Stack interleaved(const MapClass& maps, MapUse use);
  void stack(const SceneMaps& maps, const std::vector<Stack>& known);
  void take_out_spots(const Scene& scene, std::size_t spots);
  void set_lights(const Scene& scene, const Effects& effects);
  void set_discs(const std::vector<Light>& lights, const Effects& effects);
  void set_tilts(const Scene& scene, const Effects& effects);
  // Where a pixel lies, as PointArrays has it; 0 where no lamp stands at a place.
  std::array<float, 3> position(const Gbuffer& gbuffer, int x, int y) const;
  void shade_row(const Gbuffer& gbuffer, int y, float gain, bool add, float* rgba) const;

  Effects effects_;
  std::vector<Stack> stacks_, other_stacks_;  // those with other spots; none: not yet
  std::vector<Stack> shared_;                 // see share_maps()
  Stack background_map_;
  ProductColumns product_{};
  std::vector<float> weights_, lights_, exponents_, tilts_;
  std::vector<int> rows_, first_tilt_;
  std::vector<std::uint64_t> lit_lobes_, shown_blocks_;
  std::vector<bool> bare_;  // parts whose paint shows nothing, as it lies under a texture
  CpuShading shading_;
  TiltStore tilt_store_;
  TiltShading tilt_shading_;  // of tilted lobes
  Background background_ = Background::kNone;
  color::Rgb background_color_;
  std::vector<PlacedLamp> placed_;
  const mesh::Mesh* mesh_ = nullptr;  // which lamps at a place need
  Vec3 origin_;
  std::vector<CpuShading::Disc> discs_;
  std::vector<std::shared_ptr<const brdf::DiscLobeTable>> disc_tables_;
  std::vector<std::shared_ptr<const brdf::DiscHorizonTable>> disc_horizons_;
  std::vector<const brdf::DiscLobeTable*> disc_lobes_;
};

}  // namespace goniochrome::render
