#include "render/glints.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/angles.h"
#include "base/parallel.h"
#include "brdf/lobe_model.h"
#include "render/surface_layer.h"

namespace goniochrome::render {

namespace {

constexpr double kSmall = 0.18;      // of the lamp's radius: narrower spreads change nothing that is seen
constexpr double kWidest_rad = 0.3;  // at outlines the spread is no measure
constexpr double kWidened = 2;       // the image holds at least so many samples

class Mirrors {
 public:
  explicit Mirrors(const Gbuffer& gbuffer) : g_(gbuffer) {}

  Vec3 at(int x, int y) const {
    const Vec3 n = g_.normal(x, y), viewer = g_.to_viewer(x, y);
    return 2 * dot(n, viewer) * n - viewer;
  }
  double spread(int x, int y) const {
    const auto direction = [&](int i, int j) { return at(i, j); };
    const auto same = [&](int i, int j) {
      return i >= 0 && j >= 0 && i < g_.width && j < g_.height && g_.part(i, j) == g_.part(x, y);
    };
    return mirror_spread(change_beside(direction, same, x, y, 1, 0), change_beside(direction, same, x, y, 0, 1));
  }

 private:
  const Gbuffer& g_;
};

}  // namespace

double mirror_spread(const Vec3& right, const Vec3& down) {
  return std::sqrt(length(cross(right, down)) / kPi);
}

double mirrored_share(const Light& light, const Vec3& mirrored, double spread_rad) {
  const double radius = light.radius_rad;
  if (!(radius > 0)) return 0;
  if (spread_rad <= kSmall * radius || spread_rad > kWidest_rad) return light.meets(mirrored) ? 1 : 0;
  Light wide = light;
  wide.radius_rad = std::min(kPi / 2, std::sqrt(radius * radius + kWidened * spread_rad * spread_rad));
  const double share = std::sin(0.5 * radius) / std::sin(0.5 * wide.radius_rad);
  return wide.meets(mirrored) ? share * share : 0;
}

void add_glints(const Scene& scene, const Effects& effects, const Gbuffer& gbuffer, float weight, image::Image& rgba) {
  if (!effects.mirror || !effects.extent || effects.lights == 0) return;
  std::vector<paint::LobeFit> paints;
  for (const paint::LobeFit& paint : scene.paints)
    paints.push_back(effects.coat ? paint : brdf::under_coat(paint, paint::kNoCoat));
  const Mirrors mirrors(gbuffer);
  const double of_sample = std::sqrt(static_cast<double>(weight));
  for_pixels(gbuffer.width, gbuffer.height, [&](int x, int y) {
    const int part = gbuffer.part(x, y);
    if (part < 0) return;
    if (scene.layer != nullptr && scene.layer->surface(part).hides_paint()) return;
    const paint::LobeFit& paint = paints[static_cast<std::size_t>(part)];
    if (!wears_lobe(paint, paint::kMirrorExponent, LobeWeight::kGloss)) return;
    const Vec3 r = mirrors.at(x, y);
    color::Rgb sum;
    double spread = -1;
    for (const Light& light : scene.lights) {
      if (!(light.radius_rad > 0) || length(r - light.direction) > 2 * (light.radius_rad + kWidest_rad)) continue;
      if (spread < 0) spread = of_sample * mirrors.spread(x, y);
      const double missing = mirrored_share(light, r, spread) - (light.meets(r) ? 1 : 0);
      if (missing == 0) continue;
      const double cos_o = std::clamp(dot(gbuffer.normal(x, y), gbuffer.to_viewer(x, y)), 0.0, 1.0);
      const paint::LobeFit here = effects.views ? brdf::at_view(paint, std::acos(cos_o) / kDegree) : paint;
      const double fresnel = brdf::fresnel_dielectric(effects.fresnel ? cos_o : std::numbers::sqrt2 / 2,
                                                      brdf::mirror_index(paint.coat_index));
      const paint::Lobe* mirror = find_lobe(here, paint::kMirrorExponent);
      if (mirror == nullptr) continue;
      const color::Rgb k = fresnel * mirror->gloss;
      const color::Rgb light_seen = missing * light.radiance();
      sum += effects.reflection ? color::reflected(scene.reflection, k, light_seen) : k * light_seen;
    }
    for (int c = 0; c < 3; ++c) rgba.pixel(x, y)[c] += weight * static_cast<float>(sum[c]);
  });
}

}  // namespace goniochrome::render
