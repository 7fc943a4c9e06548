#include "render/panes.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/angles.h"
#include "base/parallel.h"
#include "brdf/lobe_model.h"

namespace goniochrome::render {

namespace {

constexpr std::size_t kMostPanes = 64;  // one behind the other; ten let less than half of the light through

struct Rectangle {
  int left = 0, top = 0, right = -1, bottom = -1;  // the last pixels are in it
  bool empty() const { return right < left; }
};

// The pixels that show a pane through which enough is seen. `passed` is empty for the front.
Rectangle around_panes(const Scene& scene, const Gbuffer& g, const std::vector<float>& passed) {
  Rectangle box{g.width, g.height, -1, -1};
  for_seen(g, [&](int x, int y, int part) {
    if (!is_pane(scene, static_cast<std::size_t>(part))) return;
    if (!passed.empty() && passed[g.index(x, y)] < kLeastPassed) return;
    box = {std::min(box.left, x), std::min(box.top, y), std::max(box.right, x), std::max(box.bottom, y)};
  });
  return box;
}

rays::Spot spot_of(const rays::RayScene& whole, const Scene& scene, const Gbuffer& g, int x, int y,
                   const rays::Float3& eye, const rays::Float3& direction) {
  const MeshPoint at = mesh_point(*scene.mesh, g, x, y);
  return whole.spot({at.triangle, static_cast<float>(at.shares[1]), static_cast<float>(at.shares[2]), 0}, eye,
                    direction);
}

// One pane deeper than these pixels; nothing where they show no pane.
std::optional<BehindPanes> one_deeper(const rays::RayScene& whole, const Scene& scene, const Gbuffer& before,
                                      const std::vector<float>& passed, int left, int top) {
  const Rectangle box = around_panes(scene, before, passed);
  if (box.empty()) return std::nullopt;
  BehindPanes deeper;
  deeper.x = left + box.left, deeper.y = top + box.top;
  Gbuffer& g = deeper.gbuffer;
  g.width = box.right - box.left + 1, g.height = box.bottom - box.top + 1;
  g.rays = before.rays;
  g.rays.corner += static_cast<double>(box.left) * g.rays.right + static_cast<double>(box.top) * g.rays.down;
  const std::size_t pixels = static_cast<std::size_t>(g.width) * static_cast<std::size_t>(g.height);
  g.data.assign(4 * pixels, 0.0F), g.triangles.assign(pixels, kNoTriangle);
  deeper.passed.assign(pixels, 0.0F);
  const rays::Float3 eye = whole.local(g.rays.eye);
  for_pixels(g.width, g.height, [&](int x, int y) {
    const int u = box.left + x, v = box.top + y, part = before.part(u, v);
    const float left_so_far = passed.empty() ? 1.0F : passed[before.index(u, v)];
    if (part < 0 || !is_pane(scene, static_cast<std::size_t>(part)) || left_so_far < kLeastPassed) return;
    const rays::Float3 direction = -rays::float3(g.to_viewer(x, y));
    const rays::Spot pane = spot_of(whole, scene, before, u, v, eye, direction);
    const double cosine = std::clamp(dot(before.normal(u, v), before.to_viewer(u, v)), 0.0, 1.0);
    const rays::Hit hit = through_pane(whole, pane, direction).hit;
    const std::size_t at = g.index(x, y);
    deeper.passed[at] = left_so_far * static_cast<float>(1 - pane_reflectance(cosine));
    if (!hit.any() || hit.triangle == rays::kFloor) return;
    const rays::Spot spot = whole.spot(hit, pane.position, direction);
    g.data[4 * at] = spot.shading.x, g.data[4 * at + 1] = spot.shading.y, g.data[4 * at + 2] = spot.shading.z;
    g.data[4 * at + 3] = static_cast<float>(spot.inside ? -(spot.part + 1) : spot.part + 1);
    g.triangles[at] = hit.triangle;
  });
  return deeper;
}

}  // namespace

// The light (1-F) passes the first face; the other face sends F of it back, and so on between both: the reflected parts
// F + (1-F)^2 F (1 + F^2 + F^4 + ...) sum to 2F/(1+F), and (1-F)/(1+F) passes. Both together are 1.
double pane_reflectance(double cosine) {
  const double face = brdf::fresnel_dielectric(cosine, brdf::kCoatIndex);
  return 2 * face / (1 + face);
}

// Engines draw a mirror of weight K_M as K_M F, so that K_M = 2/(1+F). It is linear between views: steps of half a
// degree toward grazing, where F rises, keep what is drawn within 3e-4 of pane_reflectance().
paint::LobeFit pane_finish() {
  const auto mirror = [](double view_deg) {
    const double weight = 2 / (1 + brdf::fresnel_dielectric(std::cos(view_deg * kDegree), brdf::kCoatIndex));
    return paint::Lobe{paint::kMirrorExponent, {}, {weight, weight, weight}};
  };
  paint::LobeFit finish;
  finish.lobes = {mirror(brdf::kGlossIncidence_deg)};
  for (double view = 0; view <= 90; view += view < 50 ? 5 : view < 70 ? 2 : view < 80 ? 1 : 0.5)
    finish.views.push_back({view, {}, {mirror(view)}});
  return finish;
}

bool is_pane(const Scene& scene, std::size_t part) {
  return part < scene.panes.size() && scene.panes[part];
}

bool has_panes(const Scene& scene) {
  return std::ranges::find(scene.panes, true) != scene.panes.end();
}

// The ray goes on from the other side of the triangle, as far below it as rays that leave it start above.
PassedPane through_pane(const rays::RayScene& whole, const rays::Spot& pane, const rays::Float3& direction) {
  const double cosine = std::clamp(static_cast<double>(-rays::dot(pane.shading, direction)), 0.0, 1.0);
  const rays::Float3 beyond = pane.position - rays::kLift * pane.geometric;
  return {whole.closest(beyond, direction), static_cast<float>(1 - pane_reflectance(cosine))};
}

std::vector<BehindPanes> behind_panes(const rays::RayScene& whole, const Scene& scene, const Gbuffer& front) {
  std::vector<BehindPanes> all;
  if (!has_panes(scene)) return all;
  std::optional<BehindPanes> next = one_deeper(whole, scene, front, {}, 0, 0);
  while (next) {
    all.push_back(*std::move(next));
    const BehindPanes& last = all.back();
    if (all.size() == kMostPanes) break;
    next = one_deeper(whole, scene, last.gbuffer, last.passed, last.x, last.y);
  }
  return all;
}

}  // namespace goniochrome::render
