// Shading of spatially varying surfaces under lights and a prefiltered environment.
// goniochrome-surfaces(7), "SPATIALLY VARYING SURFACES"; [McAllister2002] 4.1 and 6.1
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <map>
#include <mutex>
#include <span>
#include <vector>

#include "base/result.h"
#include "brdf/sbrdf.h"
#include "envmap/prefiltered.h"
#include "render/gbuffer.h"
#include "render/scene.h"
#include "render/textures/sbrdf_kernel.h"
#include "render/textures/texture_filter.h"

namespace goniochrome::render {

// Lobe maps in one cube with levels: a quarter of the exponent and half the texels at each step from the finest.
struct MipCube {
  double finest_exponent = 1;
  std::vector<envmap::CubeMap> levels;  // sharpest first
};

// Made from an environment that holds such a chain of exponents. Error: the exponents that are missing, and the command
// that makes them.
Result<MipCube> mip_cube(const envmap::PrefilteredEnvironment& env);

// The light in which textures are seen, and its share.
struct SbrdfLight {
  bool environment = true;  // as far as there is one
  std::vector<Light> lights = {};
  color::ReflectionOperator reflection = color::component_wise();
  bool horizon = true;        // lobes under the environment end at the horizon
  std::uint32_t lobes = ~0U;  // by bits
  Vec3 origin = {};           // of the positions of points, see origin_of(); for lamps at a place
};

// Segments of a row of the horizon table.
constexpr int kTextureHorizonSegments = 64;

// A texture packed for the kernel: see kShapeFloats.
struct PackedTexture {
  int width = 0, height = 0, lobes = 0;
  std::vector<float> colors;
  std::vector<std::uint32_t> shape;  // the number of each texel's
  std::vector<float> shapes;
  std::vector<float> normals;  // 3 a shape, in the frame of the surface; empty where all texels are flat
  bool covers = true;          // whether alpha is 1 everywhere

  std::size_t color_floats() const { return 4 * (1 + static_cast<std::size_t>(lobes)); }
  std::size_t shape_floats() const { return kShapeFloats * static_cast<std::size_t>(lobes); }
  const float* colors_of(std::size_t texel) const { return colors.data() + texel * color_floats(); }
  const float* shape_of(std::size_t texel) const { return shapes.data() + shape[texel] * shape_floats(); }
};

// Puts texels of one shape side by side.
void sort_by_shape(const PackedTexture& texture, std::span<TexelShare> texels);

// Calls put(lobed, diffuse) for each shape of texels that are sorted by shape: those of the shape, and with the first
// of them all texels, whose diffuse parts are shaded together unless they have normals of their own.
template <class Put>
void each_shape(const PackedTexture& texture, std::span<const TexelShare> texels, const Put& put) {
  for (std::size_t first = 0, end = 0; first < texels.size(); first = end) {
    while (end < texels.size() && texture.shape[texels[end].texel] == texture.shape[texels[first].texel]) ++end;
    const std::span<const TexelShare> lobed = texels.subspan(first, end - first);
    put(lobed, !texture.normals.empty() ? lobed : first == 0 ? texels : std::span<const TexelShare>());
  }
}

// Textures packed for the kernel, and the maps that their lobes need.
class SbrdfShader {
 public:
  // With `mip` lobes are fetched there (trilinearly), else from the environment's own maps, two neighbors in exponent
  // blended. Both may be null, and all must outlive the shader.
  SbrdfShader(const envmap::PrefilteredEnvironment* env, const MipCube* mip,
              const std::vector<const brdf::SbrdfTexture*>& textures);

  // Error: lobes of the textures are sharper or wider than all maps that there are, with the command that makes those
  // that are missing. Such lobes would be drawn as those of the nearest map.
  Result<void> has_all_maps() const;

  // Radiance in the working space of points on one texture, or on one of its levels, at their places; 0 seen from
  // below. The four texels around a place are shaded one by one, and their colors blended. Single precision; the same
  // for any company of points.
  std::vector<color::Rgb> shade(std::size_t texture, const SbrdfLight& light, const std::vector<VisiblePoint>& points,
                                int level = 0) const;

  // The part of what lies beneath a texture, or one of its levels, that it covers at a place: its alpha, interpolated.
  // Levels have these lobes of the texture alone.
  double coverage(std::size_t texture, const TexturePlace& place, int level = 0, std::uint32_t lobes = ~0U) const;

  // How a texture is shaded whose footprint is `scale` times that of the place. Levels are made when they are first
  // called for, and that may be on many threads.
  FilterProbes probes(std::size_t texture, const TexturePlace& place, double scale) const;

  // Returns a texture as the kernel reads it. Levels have these lobes of the texture alone, since theirs stand for
  // several.
  const PackedTexture& packed(std::size_t texture, int level = 0, std::uint32_t lobes = ~0U) const;

  // Shades up to kPointsAtOnce points that were put.
  class Batch {
   public:
    Batch(const SbrdfShader& shader, std::size_t texture, const SbrdfLight& light, int level = 0);
    Batch(const Batch&) = delete;  // the kernel's tables point into it
    Batch& operator=(const Batch&) = delete;
    // `normal` and `to_viewer` on the same side, the first unit; the position from SbrdfLight::origin. The point shows
    // the lobes of some texels of one shape, and the diffuse parts of others or the same. They must be there until the
    // batch is shaded. Of the place the tangent is read.
    void put(const float* normal, const std::array<float, 3>& to_viewer, const std::array<float, 3>& position,
             const TexturePlace& place, std::span<const TexelShare> lobed, std::span<const TexelShare> diffuse);
    int count() const { return count_; }
    bool full() const { return count_ == kPointsAtOnce; }
    // The colors of all, 4 floats each; the batch is empty again.
    const float* shade();
    const PackedTexture& texture() const { return packed_; }  // or its level

   private:
    const PackedTexture& packed_;
    SbrdfShading shading_;
    std::vector<float> lights_;
    ProductColumns product_;
    std::vector<PlacedLamp> placed_;
    SbrdfPoints points_;
    int count_ = 0;
    alignas(64) float rgba_[4 * kPointsAtOnce];
  };

 private:
  int levels(std::size_t texture) const;  // coarser ones
  void make_maps(const envmap::PrefilteredEnvironment& env, const MipCube* mip, double low, double high, double widest);
  void make_horizon(double low, double high);
  PackedTexture pack(const brdf::SbrdfTexture& texture) const;
  PackedTexture pack(const TextureLevel& level) const;
  // One lobe of a shape, of this largest albedo and this direction of the x axis.
  void pack_lobe(const brdf::LafortuneLobe& lobe, double largest, const brdf::SbrdfAxis& axis, float* to) const;

  struct Levels {
    std::mutex mutex;
    std::map<std::uint32_t, std::vector<PackedTexture>> packed;  // by the lobes that they have; from 1 on
  };

  std::vector<const brdf::SbrdfTexture*> given_;
  std::vector<PackedTexture> textures_;
  mutable std::deque<Levels> levels_;
  std::string missing_;            // see has_all_maps()
  std::vector<double> exponents_;  // of the maps, ascending
  std::vector<SingleMap> maps_;
  SingleMap diffuse_;
  std::vector<std::vector<float>> texels_;  // of the maps and of the diffuse one
  std::vector<double> horizon_exponents_;
  std::vector<float> horizon_;
};

}  // namespace goniochrome::render
