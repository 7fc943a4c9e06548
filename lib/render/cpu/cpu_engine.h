// Shades G-buffers on the processor, without OpenGL: the maps that one direction meets lie interleaved, so that one set
// of addresses and one bilinear fetch serve all of their lobes. goniochrome-theory(7), RENDERING.
#pragma once

#include <vector>

#include "image/image.h"
#include "render/cpu/cpu_kernel.h"
#include "render/effects.h"
#include "render/gbuffer.h"
#include "render/internal/maps.h"
#include "render/internal/product_forms.h"
#include "render/internal/visible_point.h"

namespace goniochrome::render {

class CpuEngine {
 public:
  CpuEngine() = default;
  CpuEngine(const CpuEngine&) = delete;  // the kernel's tables point into it
  CpuEngine& operator=(const CpuEngine&) = delete;

  // Interleaves the maps. Error: more face sizes than there is room for.
  Result<void> load(const Scene& scene, const Effects& effects, const SceneMaps& maps);
  // Other paints, or other lights, for the effects loaded.
  void load_paints(const Scene& scene, const Effects& effects, const WeightTable& table);

  // Shades all pixels, radiance times `gain`; `add` adds to what is there. Bit-identical for any number of threads.
  void shade(const Gbuffer& gbuffer, float gain, bool add, image::Image& rgba) const;
  std::vector<color::Rgb> shade(const std::vector<VisiblePoint>& points) const;

 private:
  struct Stack {
    MapClass shape;  // without its maps
    MapUse use = MapUse::kMirror;
    InterleavedMaps maps() const;
    int blocks = 0, texel_floats = 0;
    std::vector<float> texels;
  };
  static Stack interleaved(const MapClass& maps, MapUse use, const ProductForms& forms);
  void interleave(const MapClass& maps, MapUse use);
  void set_lights(const Scene& scene, const Effects& effects);
  void set_tilts(const Scene& scene, const Effects& effects);
  void shade_row(const Gbuffer& gbuffer, int y, float gain, bool add, float* rgba) const;

  std::vector<Stack> stacks_;
  Stack background_map_;
  ProductForms forms_;
  std::vector<float> weights_, lights_, exponents_, tilts_, colors_of_forms_;
  std::vector<int> first_tilt_;
  CpuShading shading_;
  Background background_ = Background::kNone;
  color::Rgb background_color_;
};

}  // namespace goniochrome::render
