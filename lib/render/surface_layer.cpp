#include "render/surface_layer.h"

#include <cmath>
#include <numbers>

#include "base/parallel.h"
#include "brdf/lobe_model.h"
#include "render/sbrdf.h"
#include "render/texture_places.h"

namespace goniochrome {

struct SurfaceLayer::Shader {
  SbrdfShader sbrdf;
};

SurfaceLayer::SurfaceLayer(const Scene& scene, std::vector<PartSurface> surfaces, CriticalAngle treatment)
    : scene_(scene), surfaces_(std::move(surfaces)), treatment_(treatment) {
  surfaces_.resize(scene.mesh->parts.size());
  for (const PartSurface& surface : surfaces_) {
    textured_ = textured_ || surface.texture != nullptr;
    mapped_ = mapped_ || (surface.color_map != nullptr && !scene.lights.empty());
  }
  if (textured_)
    shader_ = std::make_unique<Shader>(Shader{SbrdfShader(scene.env, nullptr, scene.lights, scene.reflection)});
}

SurfaceLayer::~SurfaceLayer() = default;

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
Rgb SurfaceLayer::mapped_difference(int part, const Vec3& normal, const Vec3& to_viewer) const {
  Rgb sum;
  const auto at = static_cast<std::size_t>(part);
  for (const Light& light : scene_.lights) {
    const auto [wi, wo] = about_normal(normal, light.direction, to_viewer);
    if (wi.z <= 0 || wo.z <= 0) continue;
    const double aspecular_rad = aspecular_angle_rad(wi, wo, {0, 0, 1});
    const Rgb map = reflectance_factor(*surfaces_[at].color_map, wi, wo, treatment_);
    const Rgb lobes = flake_reflectance_factor(scene_.paints[at], aspecular_rad * 180 / std::numbers::pi);
    sum += wi.z * reflected(scene_.reflection, light.white, map - lobes);
  }
  return sum;
}

void add_mapped(const Scene& scene, const std::vector<VisiblePoint>& points, std::vector<Rgb>& colors) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (scene.layer->surface(points[i].part).color_map == nullptr) continue;
    colors[i] += scene.layer->mapped_difference(points[i].part, points[i].normal, points[i].to_viewer);
  }
}

Rgb SurfaceLayer::texel_radiance(int part, int column, int row, const Vec3& normal, const Vec3& to_viewer) const {
  const SbrdfTexel texel = sbrdf_texel(*surface(part).texture, column, row);
  return shader_->sbrdf.shade(texel, normal, cross({0, 1, 0}, normal), to_viewer);
}

void add_textured(const Scene& scene, const std::vector<VisiblePoint>& points, std::vector<Rgb>& colors) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    const VisiblePoint& p = points[i];
    const SbrdfTexture* texture = scene.layer->surface(p.part).texture;
    if (texture == nullptr) continue;
    // Steps of the golden section cover both sides evenly.
    const auto step = [i](double share, int n) {
      const double at = share * static_cast<double>(i);
      return static_cast<int>((at - std::floor(at)) * n);
    };
    colors[i] += scene.layer->texel_radiance(p.part, step(0.61803398875, texture->width),
                                             step(0.7548776662, texture->height), p.normal, p.to_viewer);
  }
}

void SurfaceLayer::add(const Gbuffer& gbuffer, const Vec3& eye, float weight, Image& rgba, bool with_maps) const {
  if (empty()) return;
  std::vector<TexturePlace> places;
  if (textured_) places = texture_places(*scene_.mesh, gbuffer.rays, eye, gbuffer.width, gbuffer.height, 1);
  const auto rows = static_cast<std::size_t>(gbuffer.height);
  parallel_for(rows, 4, [&](std::size_t begin, std::size_t end) {
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
      for (int x = 0; x < gbuffer.width; ++x) {
        const int part = gbuffer.part(x, y);
        if (part < 0) continue;
        const PartSurface& surface = surfaces_[static_cast<std::size_t>(part)];
        Rgb color;
        if (surface.texture != nullptr) {
          const TexturePlace& place = places[static_cast<std::size_t>(y) * gbuffer.width + x];
          color = shader_->sbrdf.shade(*surface.texture, surface.repeat * place.u, surface.repeat * place.v,
                                       gbuffer.normal(x, y), {place.tangent[0], place.tangent[1], place.tangent[2]},
                                       gbuffer.to_viewer(x, y));
        } else if (with_maps && surface.color_map != nullptr) {
          color = mapped_difference(part, gbuffer.normal(x, y), gbuffer.to_viewer(x, y));
        }
        for (int c = 0; c < 3; ++c) rgba.pixel(x, y)[c] += weight * static_cast<float>(color[c]);
      }
    }
  });
}

}  // namespace goniochrome
