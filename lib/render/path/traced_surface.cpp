// Color maps and textures as paths meet them.
#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "render/path/traced_paint.h"

namespace goniochrome::render {

namespace {

using rays::Float3;
using rays::float3;

// exp of it is finite in floats, with room for the products that it is part of.
constexpr double kLargestLog = 60;
float mean_size(const color::Rgb& c) {
  return static_cast<float>((std::abs(c.x) + std::abs(c.y) + std::abs(c.z)) / 3);
}

}  // namespace

void TracedPaint::put_surface(const SurfaceLayer& layer, int part) {
  const PartSurface& surface = layer.surface(part);
  if (!surface.textures.empty()) layer_ = &layer, part_ = part;
  if (surface.hides_paint()) {
    views_.assign(1, {});
    coat_index_ = paint::kNoCoat;
    tilts_.clear();
    coat_.reset();
    hidden_ = true;
    return;
  }
  if (surface.color_map == nullptr) return;
  map_ = surface.color_map;
  treatment_ = layer.treatment();
  double sum = 0;
  for (const float factor : map_->factors) sum += std::abs(factor);
  map_level_ = static_cast<float>(sum / static_cast<double>(map_->factors.size()));
}

PaintedPoint::PaintedPoint(const rays::Spot& spot, const TracedPaint& paint, const Float3& to_viewer)
    : PaintedPoint(paint, spot.shading, to_viewer) {
  if (paint.layer_ == nullptr) return;
  MeshPoint point;
  point.triangle = spot.triangle;
  point.shares = {1.0 - spot.u - spot.v, spot.u, spot.v};
  wear(paint.layer_->place(paint.part_, point, spot.inside));
}

// Leaves this part of all that the paint shows.
void PaintedPoint::dim(float share) {
  bare_ = share;
  diffuse_ = share * diffuse_, mirror_ = share * mirror_;
  diffuse_chance_ *= share, coat_chance_ *= share, total_ *= share;
  if (share == 0) count_ = 0, coat_ = nullptr, paint_ = nullptr;
  for (int j = 0; j < count_; ++j) {
    lobes_[j].directional_diffuse = share * lobes_[j].directional_diffuse, lobes_[j].gloss = share * lobes_[j].gloss;
    lobes_[j].chance *= share;
  }
}

void PaintedPoint::wear(const SurfaceLayer::Place& place) {
  dim(static_cast<float>(place.bare));
  const Vec3 surface = normalized(rays::vec3(normal_)), viewer = rays::vec3(viewer_);
  color::Rgb diffuse;
  for (const SurfaceLayer::Piece& piece : place.pieces) {
    const Vec3 normal = piece.normal(surface, viewer);
    const brdf::SurfaceFrame frame = brdf::surface_frame(piece.texel, normal, piece.tangent);
    const Vec3 local = frame.local(viewer);
    const bool bent = !(normal == surface);
    const Float3 turned = bent ? float3(normal) : normal_;
    const color::Rgb matt = piece.share * piece.texel.surface.diffuse;
    if (bent) {
      bent_ = true;
      add_texel_lobe(normal, 1, matt, turned, true);
    } else {
      diffuse += matt;
    }
    for (const brdf::LafortuneLobe& lobe : piece.texel.surface.lobes)
      add_texel_lobe(frame.world(lobe.axes * local), lobe.exponent, piece.share * lobe.albedo, turned);
  }
  texel_diffuse_ = float3(diffuse);
  diffuse_chance_ += static_cast<float>(kPi) * mean_size(diffuse);
  total_ += static_cast<float>(kPi) * mean_size(diffuse);
  for (TexelLobe& lobe : texels_) {
    const float wide = 1 / std::sqrt(lobe.exponent + 2), middle = lobe.cosine(lobe.axis);
    const float cosine = middle + (1 - middle) * wide;
    lobe.chance = std::exp(lobe.log_peak) * cosine * mean_size(rays::vec3(lobe.color)) / lobe.normalization;
    total_ += lobe.chance;
  }
}

// Neighboring texels often hold the same lobe in another color.
void PaintedPoint::add_texel_lobe(const Vec3& axis, double exponent, const color::Rgb& albedo, const Float3& normal,
                                  bool matt) {
  const double size = length(axis);
  if (albedo == color::Rgb{} || !(size > 0)) return;
  const Float3 unit = float3((1 / size) * axis);
  const auto e = static_cast<float>(exponent),
             log_peak = static_cast<float>(std::clamp(exponent * std::log(size), -1000.0, kLargestLog));
  for (TexelLobe& lobe : texels_) {
    const Float3 apart = lobe.axis - unit, turned = lobe.normal - normal;
    if (rays::dot(apart, apart) == 0 && lobe.exponent == e && lobe.log_peak == log_peak &&
        rays::dot(turned, turned) == 0 && lobe.matt == matt) {
      lobe.color = lobe.color + float3(albedo);
      return;
    }
  }
  texels_.push_back(
      {unit, e, log_peak, float3(albedo), static_cast<float>((exponent + 1) / (2 * kPi)), 0, normal, matt});
}

// cos_i map/pi: a map holds reflectance factors. Isolines do not change when both directions turn about the normal.
Float3 PaintedPoint::mapped(const Float3& to_light) const {
  const Vec3 light = local(to_light);
  return float3(bare_ * light.z / kPi *
                brdf::reflectance_factor(*paint_->map_, light, local(viewer_), paint_->treatment_));
}

}  // namespace goniochrome::render
