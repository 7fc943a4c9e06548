#include "render/path/emitters.h"

#include <algorithm>
#include <cmath>

namespace goniochrome::render {

namespace {

using rays::Float3;

double mean_of(const color::Rgb& c) {
  return (c.x + c.y + c.z) / 3;
}

}  // namespace

Result<Emitters> Emitters::create(const rays::RayScene& scene, std::vector<color::Rgb> radiance) {
  Emitters emitters;
  emitters.scene_ = &scene;
  std::vector<double> part_area(radiance.size(), 0.0);
  for (std::size_t part = 0; part < radiance.size(); ++part) {
    const color::Rgb& light = radiance[part];
    for (int c = 0; c < 3; ++c)
      if (!(light[c] >= 0) || std::isinf(light[c]))
        return input_error("part {} emits ({}, {}, {}): a radiance must be finite and not negative", part, light.x,
                           light.y, light.z);
  }
  emitters.radiance_ = std::move(radiance);
  for (std::uint32_t triangle = 0; triangle < scene.triangles(); ++triangle) {
    const int part = scene.part(triangle);
    const double power = mean_of(emitters.radiance(part)), area = 0.5 * length(scene.doubled_area(triangle));
    if (!(power > 0)) continue;
    part_area[static_cast<std::size_t>(part)] += area;
    if (!(area > 0)) continue;
    emitters.total_ += power * area;
    emitters.triangles_.push_back(triangle);
    emitters.cumulative_.push_back(emitters.total_);
  }
  for (std::size_t part = 0; part < part_area.size(); ++part)
    if (mean_of(emitters.radiance_[part]) > 0 && !(part_area[part] > 0))
      return input_error("part {} emits light but has no area: no ray can find it", part);
  for (double& share : emitters.cumulative_) share /= emitters.total_;
  return emitters;
}

double Emitters::part_density(int part) const {
  return mean_of(radiance(part)) / total_;
}

EmitterSample Emitters::drawn(const Float3& from, double choice, double u, double v) const {
  const auto at = std::ranges::upper_bound(cumulative_, choice);
  const std::uint32_t triangle = triangles_[static_cast<std::size_t>(
      std::min<std::ptrdiff_t>(at - cumulative_.begin(), static_cast<std::ptrdiff_t>(triangles_.size()) - 1))];
  const std::array<Float3, 3> corner = scene_->corners(triangle);
  // Even over the triangle: the square folded along its diagonal by way of the root.
  const double root = std::sqrt(u);
  const auto b = static_cast<float>(root * (1 - v)), c = static_cast<float>(root * v);
  const Float3 point = corner[0] + b * (corner[1] - corner[0]) + c * (corner[2] - corner[0]);
  const Float3 apart = point - from;
  const float distance = rays::length(apart);
  if (!(distance > 0)) return {};
  const Float3 direction = (1 / distance) * apart;
  const int part = scene_->part(triangle);
  return {direction, distance, pdf(triangle, direction, distance), radiance(part), part};
}

float Emitters::pdf(std::uint32_t triangle, const Float3& direction, float distance) const {
  if (triangle >= rays::kFloor || empty()) return 0;
  return static_cast<float>(part_density(scene_->part(triangle)) *
                            scene_->by_solid_angle(triangle, direction, distance));
}

}  // namespace goniochrome::render
