#include "render/surface_layer.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>
#include <optional>

#include "base/angles.h"
#include "base/parallel.h"
#include "brdf/lobe_model.h"

namespace goniochrome::render {

namespace {

std::uint64_t next_id() {
  static std::atomic<std::uint64_t> last = 0;
  return ++last;
}

}  // namespace

SurfaceLayer::SurfaceLayer(const Scene& scene, std::vector<PartSurface> surfaces, brdf::CriticalAngle treatment,
                           const MipCube* mip)
    : scene_(scene), surfaces_(std::move(surfaces)), treatment_(treatment), id_(next_id()) {
  surfaces_.resize(scene.mesh->parts.size());
  std::vector<bool> parts;
  std::vector<TextureLaying> layings;
  for (const PartSurface& surface : surfaces_) {
    parts.push_back(surface.texture != nullptr);
    layings.push_back(surface.laying);
    empty_ = empty_ && surface.texture == nullptr && surface.color_map == nullptr;
    mapped_ = mapped_ || (surface.color_map != nullptr && !scene.lights.empty());
    if (surface.texture == nullptr) continue;
    textured_ = true;
    if (std::ranges::find(textures_, surface.texture) == textures_.end()) textures_.push_back(surface.texture);
  }
  if (!textured_) return;
  for (const brdf::SbrdfTexture* texture : textures_) means_.push_back(brdf::mean_texture(*texture));
  std::vector<const brdf::SbrdfTexture*> all = textures_;
  for (const brdf::SbrdfTexture& mean : means_) all.push_back(&mean);
  shader_ = std::make_unique<const SbrdfShader>(scene.env, mip, all);
  layout_ = std::make_unique<const TextureLayout>(*scene.mesh, parts, std::move(layings));
}

SurfaceLayer::~SurfaceLayer() = default;

int SurfaceLayer::lobes() const {
  int most = 0;
  for (const brdf::SbrdfTexture* texture : textures_) most = std::max(most, texture->lobes);
  return most;
}

std::vector<TexturePlace> SurfaceLayer::places(const Gbuffer& gbuffer) const {
  return textured_ ? layout_->places(gbuffer) : std::vector<TexturePlace>();
}

std::vector<TexturePlace> SurfaceLayer::filtered_places(const Gbuffer& gbuffer,
                                                        const std::array<double, 2>& middle) const {
  return textured_ ? layout_->filtered_places(gbuffer, middle) : std::vector<TexturePlace>();
}

std::optional<TexturePlace> SurfaceLayer::place(const Gbuffer& gbuffer, int x, int y) const {
  const int part = gbuffer.part(x, y);
  if (part < 0 || gbuffer.triangles.empty() || surface(part).texture == nullptr) return std::nullopt;
  return layout_->place(gbuffer, x, y);
}

double SurfaceLayer::filter_cost(const std::vector<VisiblePoint>& points) const {
  double sum = 0, count = 0;
  for (const VisiblePoint& point : points) {
    const brdf::SbrdfTexture* texture = surface(point.part).texture;
    if (texture == nullptr) continue;
    const auto which = static_cast<std::size_t>(std::ranges::find(textures_, texture) - textures_.begin());
    const FilterProbes probes = shader_->probes(which, repeated(point.place, surface(point.part).repeat), 1);
    sum += probes.count() * (1.0 + shader_->packed(which, probes.level).lobes) / (1.0 + shader_->packed(which).lobes);
    ++count;
  }
  return count > 0 ? sum / count : 1;
}

double SurfaceLayer::covered_texels(const VisiblePoint& point) const {
  const PartSurface& of = surface(point.part);
  if (of.texture == nullptr) return 1;
  const auto texels = [&](const float* step) {
    return std::max(1.0, of.repeat * std::hypot(step[0] * of.texture->width, step[1] * of.texture->height));
  };
  return texels(point.place.across) * texels(point.place.down);
}

namespace {

// The frame of isolines needs only the normal: they do not change when both directions turn about it.
struct LocalPair {
  Vec3 light, viewer;
};
LocalPair about_normal(const Vec3& normal, const Vec3& light, const Vec3& viewer) {
  const Vec3 other = std::abs(normal.x) < 0.7 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  const Vec3 x = normalized(cross(other, normal)), y = cross(normal, x);
  return {{dot(light, x), dot(light, y), dot(light, normal)}, {dot(viewer, x), dot(viewer, y), dot(viewer, normal)}};
}

}  // namespace

// The lobe model under a light is pi W f cos_i; the flakes' part of f, K_D and K_DD, is taken out and the map's
// reflectance factor, pi f by definition, put in.
color::Rgb SurfaceLayer::mapped_difference(int part, const Vec3& normal, const Vec3& to_viewer, bool coat) const {
  color::Rgb sum;
  const auto at = static_cast<std::size_t>(part);
  for (const Light& light : scene_.lights) {
    for (const DiscDirection& part_of : disc_directions(light)) {
      const auto [wi, wo] = about_normal(normal, part_of.direction, to_viewer);
      if (wi.z <= 0 || wo.z <= 0) continue;
      const double aspecular_rad = paint::aspecular_angle_rad(wi, wo, {0, 0, 1});
      const color::Rgb map = brdf::reflectance_factor(*surfaces_[at].color_map, wi, wo, treatment_);
      const paint::LobeFit& paint = scene_.paints[at];
      const color::Rgb lobes = brdf::flake_reflectance_factor(
          coat ? paint : brdf::under_coat(paint, paint::kNoCoat), aspecular_rad / kDegree,
          std::acos(std::min(wi.z, 1.0)) / kDegree, std::acos(std::min(wo.z, 1.0)) / kDegree);
      sum += part_of.weight * wi.z * color::reflected(scene_.reflection, light.white, map - lobes);
    }
  }
  return sum;
}

namespace {

SbrdfLight light_of(const Scene& scene, const Effects& effects) {
  return {effects.environment, lights_of(scene, effects),
          effects.reflection ? scene.reflection : color::component_wise(), true, effects.texture_lobes};
}

}  // namespace

std::size_t SurfaceLayer::shading_of(int part, const Effects& effects) const {
  const auto which = static_cast<std::size_t>(std::ranges::find(textures_, surface(part).texture) - textures_.begin());
  return effects.texture ? which : textures_.size() + which;
}

std::vector<std::size_t> SurfaceLayer::drawn(const Effects& effects) const {
  std::vector<std::size_t> numbers;
  for (std::size_t i = 0; i < textures_.size(); ++i) numbers.push_back(effects.texture ? i : textures_.size() + i);
  return numbers;
}

// Steps of the golden section cover a texture evenly.
TexturePlace SurfaceLayer::placed(const VisiblePoint& point, std::size_t number) const {
  const double repeat = surface(point.part).repeat;
  const auto step = [&](double share) {
    const double at = share * static_cast<double>(number);
    return static_cast<float>(at - std::floor(at));
  };
  if (!point.placed) {
    const Vec3 level = cross({0, 1, 0}, point.normal);
    TexturePlace place = repeated(point.place, repeat);
    place.u = step(0.61803398875), place.v = step(0.7548776662);
    for (int c = 0; c < 3; ++c) place.tangent[c] = static_cast<float>(level[c]);
    return place;
  }
  return repeated(point.place, repeat);
}

namespace {

void add_seen_texels(const brdf::SbrdfTexture& texture, const TexturePlace& at, double share,
                     SurfaceLayer::Place& result) {
  for (const brdf::TextureTap& tap : brdf::texture_taps(texture.width, texture.height, at.u, at.v)) {
    if (tap.weight == 0) continue;
    result.pieces.push_back({brdf::sbrdf_texel(texture, tap.column, tap.row), share * tap.weight});
  }
}

// The texels themselves at places that are spread over the whole footprint, up to 16 x 16.
SurfaceLayer::Place seen_texels(const brdf::SbrdfTexture& texture, const TexturePlace& at, bool filtered) {
  SurfaceLayer::Place result{{at.tangent[0], at.tangent[1], at.tangent[2]}, {}};
  const auto places = [&](const float* step) {
    const double texels = std::hypot(step[0] * texture.width, step[1] * texture.height);
    return filtered ? static_cast<int>(std::clamp(std::ceil(texels), 1.0, 16.0)) : 1;
  };
  const FilterProbes all{0, places(at.across), places(at.down)};
  for (int i = 0; i < all.count(); ++i) add_seen_texels(texture, probe_place(at, 1, all, i), 1.0 / all.count(), result);
  return result;
}

}  // namespace

SurfaceLayer::Place SurfaceLayer::place(const VisiblePoint& point, std::size_t number, const Effects& effects) const {
  const std::size_t which = shading_of(point.part, effects);
  const brdf::SbrdfTexture& texture = which < textures_.size() ? *textures_[which] : means_[which - textures_.size()];
  Place result = seen_texels(texture, placed(point, number), effects.texture_filter);
  for (Piece& piece : result.pieces) {
    std::vector<brdf::LafortuneLobe>& lobes = piece.texel.surface.lobes;
    for (std::size_t i = 0; i < lobes.size(); ++i)
      if ((effects.texture_lobes >> i & 1U) == 0) lobes[i].albedo = {};
  }
  return result;
}

SurfaceLayer::Place SurfaceLayer::place(int part, const MeshPoint& point) const {
  return seen_texels(*surface(part).texture, repeated(layout_->place(part, point), surface(part).repeat), false);
}

void SurfaceLayer::add_mapped(const std::vector<VisiblePoint>& points, bool coat,
                              std::vector<color::Rgb>& colors) const {
  for (std::size_t i = 0; i < points.size(); ++i) {
    const VisiblePoint& p = points[i];
    if (surface(p.part).color_map != nullptr) colors[i] += mapped_difference(p.part, p.normal, p.to_viewer, coat);
  }
}

void SurfaceLayer::add(const std::vector<VisiblePoint>& points, const Effects& effects,
                       std::vector<color::Rgb>& colors) const {
  if (effects.maps) add_mapped(points, effects.coat, colors);
  // Those of one texture and one of its levels, with the shares of the points that they are probes of.
  struct Probes {
    std::vector<VisiblePoint> points;
    std::vector<std::pair<std::size_t, double>> shares;
  };
  std::map<std::pair<std::size_t, int>, Probes> all;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (surface(points[i].part).texture == nullptr) continue;
    const std::size_t which = shading_of(points[i].part, effects);
    const TexturePlace place = placed(points[i], i);
    const FilterProbes probes = effects.texture_filter ? shader_->probes(which, place, 1) : FilterProbes{};
    for (int k = 0; k < probes.count(); ++k) {
      Probes& into = all[{which, probes.level}];
      into.points.push_back(points[i]);
      into.points.back().place = probe_place(place, 1, probes, k);
      into.shares.emplace_back(i, 1.0 / probes.count());
    }
  }
  const SbrdfLight light = light_of(scene_, effects);
  for (const auto& [of, probes] : all) {
    const std::vector<color::Rgb> shown = shader_->shade(of.first, light, probes.points, of.second);
    for (std::size_t i = 0; i < shown.size(); ++i) colors[probes.shares[i].first] += probes.shares[i].second * shown[i];
  }
}

// The textured points of one row of a picture, gathered until the kernel has enough of one texture.
class SurfaceLayer::Row {
 public:
  Row(const SbrdfShader& shader, const SbrdfLight& light, float weight, bool filtered, image::Image& rgba)
      : shader_(shader), light_(light), weight_(weight), filtered_(filtered), rgba_(rgba) {}

  void put(std::size_t texture, int x, int y, const float* normal, const Vec3& to_viewer, const TexturePlace& place,
           double repeat) {
    const float toward[3] = {static_cast<float>(to_viewer.x), static_cast<float>(to_viewer.y),
                             static_cast<float>(to_viewer.z)};
    float* pixel = rgba_.pixel(x, y);
    // A sample stands for its share of the area of the pixel.
    const double scale = std::sqrt(weight_);
    const TexturePlace whole = filtered_ ? repeated(place, repeat) : place;
    const FilterProbes probes = filtered_ ? shader_.probes(texture, whole, scale) : FilterProbes{};
    if (probes.level == 0 && probes.count() == 1)
      return put_one(texture, 0, pixel, weight_, normal, toward, place, repeat);
    for (int i = 0; i < probes.count(); ++i) {
      put_one(texture, probes.level, pixel, weight_ / static_cast<float>(probes.count()), normal, toward,
              probe_place(whole, scale, probes, i), 1);
    }
  }
  void flush() {
    if (!batch_) return;
    const int count = batch_->count();
    if (count == 0) return;
    const float* shown = batch_->shade();
    for (int i = 0; i < count; ++i)
      for (int c = 0; c < 3; ++c) pixels_[i][c] += weights_[i] * shown[4 * i + c];
  }

 private:
  void put_one(std::size_t texture, int level, float* pixel, float weight, const float* normal, const float* to_viewer,
               const TexturePlace& place, double repeat) {
    const bool other = texture != texture_ || level != level_;
    if (batch_ && (other || batch_->full())) flush();
    if (!batch_ || other) batch_.emplace(shader_, texture, light_, level), texture_ = texture, level_ = level;
    pixels_[batch_->count()] = pixel, weights_[batch_->count()] = weight;
    batch_->put(normal, to_viewer, place, repeat);
  }

  const SbrdfShader& shader_;
  const SbrdfLight& light_;
  float weight_;
  bool filtered_;
  image::Image& rgba_;
  std::size_t texture_ = 0;
  int level_ = 0;
  std::optional<SbrdfShader::Batch> batch_;
  float* pixels_[kPointsAtOnce] = {};
  float weights_[kPointsAtOnce] = {};
};

void SurfaceLayer::add(const Gbuffer& gbuffer, const std::vector<TexturePlace>& places, const Effects& effects,
                       float weight, image::Image& rgba, bool with_textures) const {
  with_textures = with_textures && textured_;
  if (!with_textures && !(mapped_ && effects.maps)) return;
  const SbrdfLight light = light_of(scene_, effects);
  parallel_for(static_cast<std::size_t>(gbuffer.height), 8, [&](std::size_t begin, std::size_t end) {
    std::optional<Row> textured;
    if (with_textures) textured.emplace(*shader_, light, weight, effects.texture_filter, rgba);
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
      const Rays& rays = gbuffer.rays;
      const Vec3 first = rays.corner + (y + 0.5) * rays.down;
      for (int x = 0; x < gbuffer.width; ++x) {
        const int part = gbuffer.part(x, y);
        if (part < 0) continue;
        const PartSurface& surface = surfaces_[static_cast<std::size_t>(part)];
        if (surface.texture != nullptr) {
          if (with_textures)
            textured->put(shading_of(part, effects), x, y, gbuffer.at(x, y), -(first + (x + 0.5) * rays.right),
                          places[static_cast<std::size_t>(y) * gbuffer.width + x], surface.repeat);
        } else if (effects.maps && surface.color_map != nullptr) {
          const color::Rgb color = mapped_difference(part, gbuffer.normal(x, y), gbuffer.to_viewer(x, y), effects.coat);
          for (int c = 0; c < 3; ++c) rgba.pixel(x, y)[c] += weight * static_cast<float>(color[c]);
        }
      }
    }
    if (textured) textured->flush();
  });
}

}  // namespace goniochrome::render
