// Color maps and textures as paths meet them, and the balance of light of all paints.
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
// Below it, alpha is as it may be rounded.
constexpr double kLeastAlpha = 1e-3;

float mean_size(const color::Rgb& c) {
  return static_cast<float>((std::abs(c.x) + std::abs(c.y) + std::abs(c.z)) / 3);
}

// The most of even light that a texel may send back: each lobe at its longest axis, without its cosine.
double most_reflected(const brdf::Lafortune& surface) {
  color::Rgb sum = kPi * surface.diffuse;
  for (const brdf::LafortuneLobe& lobe : surface.lobes) {
    const double longest = std::max({std::abs(lobe.axes.x), std::abs(lobe.axes.y), std::abs(lobe.axes.z)});
    const double power = lobe.exponent > 0 ? std::exp(std::min(lobe.exponent * std::log(longest), kLargestLog)) : 1;
    sum += 2 * kPi / (lobe.exponent + 1) * power * lobe.albedo;
  }
  return std::max({sum.x, sum.y, sum.z});
}

// The texels of a texture that may send back the most, each of which could send back more than all; at most `count`.
// Of a texel that does not cover all, what it would send back if it did.
std::vector<SurfaceLayer::Place> brightest_texels(const brdf::SbrdfTexture& texture, std::size_t count) {
  struct Candidate {
    double most;
    int column, row;
  };
  std::vector<Candidate> candidates;
  const auto scale_of = [&](int column, int row) {
    if (texture.alpha.empty()) return 1.0;
    const auto at =
        static_cast<std::size_t>(row) * static_cast<std::size_t>(texture.width) + static_cast<std::size_t>(column);
    return 1 / std::max<double>(texture.alpha[at], kLeastAlpha);
  };
  for (int row = 0; row < texture.height; ++row) {
    for (int column = 0; column < texture.width; ++column) {
      const double most = scale_of(column, row) * most_reflected(brdf::sbrdf_texel(texture, column, row).surface);
      if (most > 1) candidates.push_back({most, column, row});
    }
  }
  std::ranges::stable_sort(candidates, std::greater<>(), &Candidate::most);
  if (candidates.size() > count) candidates.resize(count);
  std::vector<SurfaceLayer::Place> places;
  for (const Candidate& c : candidates) {
    SurfaceLayer::Place& place = places.emplace_back();
    for (const brdf::SbrdfTexel& texel : brdf::sbrdf_texels(texture, c.column, c.row))
      place.pieces.push_back({texel, scale_of(c.column, c.row), {1, 0, 0}});
    place.bare = 0;
  }
  return places;
}

}  // namespace

void TracedPaint::put_surface(const SurfaceLayer& layer, int part) {
  const PartSurface& surface = layer.surface(part);
  if (surface.texture != nullptr) layer_ = &layer, part_ = part;
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

bool TracedPaint::gains_light() const {
  if (!hidden_ && gains_light(nullptr)) return true;
  if (layer_ == nullptr) return false;
  constexpr std::size_t kMostTexels = 20;
  return std::ranges::any_of(layer_->surface(part_).textures(), [&](const LaidTexture& laid) {
    return std::ranges::any_of(brightest_texels(*laid.texture, kMostTexels),
                               [&](const SurfaceLayer::Place& place) { return gains_light(&place); });
  });
}

// The share of even light that comes to the viewer: diffuse part, lobes and mirror. A texel may look another way from
// every side.
bool TracedPaint::gains_light(const SurfaceLayer::Place* place) const {
  constexpr int kViews = 12, kSides = 4, kRows = 96, kColumns = 48;
  constexpr double kQuadratureError = 0.01, kRounding = 3e-8, kTwoPi = 2 * kPi;
  for (int view = 0; view < kViews * (place != nullptr ? kSides : 1); ++view) {
    const double cos_o = (view % kViews + 0.5) / kViews, sin_o = std::sqrt(1 - cos_o * cos_o);
    const double side = kPi * (view / kViews) / kSides;  // the other half is the same turned by 180 deg
    PaintedPoint point(*this, {0, 0, 1}, float3({sin_o * std::cos(side), sin_o * std::sin(side), cos_o}));
    if (place != nullptr) point.wear(*place);
    const auto sharpest = std::ranges::max_element(point.texels_, {}, &PaintedPoint::TexelLobe::exponent);
    const Float3 axis = sharpest == point.texels_.end() ? point.mirrored() : sharpest->axis;
    const rays::Frame frame = rays::frame_about(axis);
    Vec3 lobes;
    // Rows about the mirror direction lie even in the sixth root of 1 - cos, which suits lobes up to 1e4.
    for (int i = 0; i < kRows; ++i) {
      const double x = (i + 0.5) / kRows, versine = 2 * std::pow(x, 6), step = 12 * std::pow(x, 5) / kRows,
                   sine = std::sqrt(versine * (2 - versine));
      for (int j = 0; j < kColumns; ++j) {
        const double phi = kTwoPi * (j + 0.5) / kColumns;
        const Float3 d = static_cast<float>(sine * std::cos(phi)) * frame.x +
                         static_cast<float>(sine * std::sin(phi)) * frame.y + static_cast<float>(1 - versine) * axis;
        lobes += (step * kTwoPi / kColumns) * rays::vec3(point.parts(d).lobes);
      }
    }
    const Vec3 rest = rays::vec3(point.diffuse_albedo()) + rays::vec3(point.mirror());
    for (int c = 0; c < 3; ++c)
      if (rest[c] + (1 - kQuadratureError) * lobes[c] > 1 + kRounding) return true;
  }
  return false;
}

PaintedPoint::PaintedPoint(const rays::Spot& spot, const TracedPaint& paint, const Float3& to_viewer)
    : PaintedPoint(paint, spot.shading, to_viewer) {
  if (paint.layer_ == nullptr) return;
  MeshPoint point;
  point.triangle = spot.triangle;
  point.shares = {1.0 - spot.u - spot.v, spot.u, spot.v};
  wear(paint.layer_->place(paint.part_, point));
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
  const Vec3 normal = normalized(rays::vec3(normal_)), viewer = rays::vec3(viewer_);
  color::Rgb diffuse;
  for (const SurfaceLayer::Piece& piece : place.pieces) {
    const brdf::SurfaceFrame frame = brdf::surface_frame(piece.texel, normal, piece.tangent);
    const Vec3 local = frame.local(viewer);
    diffuse += piece.share * piece.texel.surface.diffuse;
    for (const brdf::LafortuneLobe& lobe : piece.texel.surface.lobes)
      add_texel_lobe(frame.world(lobe.axes * local), lobe.exponent, piece.share * lobe.albedo);
  }
  texel_diffuse_ = float3(diffuse);
  diffuse_chance_ += static_cast<float>(kPi) * mean_size(diffuse);
  total_ += static_cast<float>(kPi) * mean_size(diffuse);
  for (TexelLobe& lobe : texels_) {
    const float wide = 1 / std::sqrt(lobe.exponent + 2), middle = std::max(rays::dot(lobe.axis, normal_), 0.0F);
    const float cosine = middle + (1 - middle) * wide;
    lobe.chance = std::exp(lobe.log_peak) * cosine * mean_size(rays::vec3(lobe.color)) / lobe.normalization;
    total_ += lobe.chance;
  }
}

// Neighboring texels often hold the same lobe in another color.
void PaintedPoint::add_texel_lobe(const Vec3& axis, double exponent, const color::Rgb& albedo) {
  const double size = length(axis);
  if (albedo == color::Rgb{} || !(size > 0)) return;
  const Float3 unit = float3((1 / size) * axis);
  const auto e = static_cast<float>(exponent),
             log_peak = static_cast<float>(std::clamp(exponent * std::log(size), -1000.0, kLargestLog));
  for (TexelLobe& lobe : texels_) {
    const Float3 apart = lobe.axis - unit;
    if (rays::dot(apart, apart) == 0 && lobe.exponent == e && lobe.log_peak == log_peak) {
      lobe.color = lobe.color + float3(albedo);
      return;
    }
  }
  texels_.push_back({unit, e, log_peak, float3(albedo), static_cast<float>((exponent + 1) / (2 * kPi)), 0});
}

// cos_i map/pi: a map holds reflectance factors. Isolines do not change when both directions turn about the normal.
Float3 PaintedPoint::mapped(const Float3& to_light) const {
  const Vec3 light = local(to_light);
  return float3(bare_ * light.z / kPi *
                brdf::reflectance_factor(*paint_->map_, light, local(viewer_), paint_->treatment_));
}

}  // namespace goniochrome::render
