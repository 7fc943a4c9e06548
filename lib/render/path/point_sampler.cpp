#include "render/path/point_sampler.h"

#include <algorithm>

namespace goniochrome::render {

using rays::Float3;
using rays::Hit;

PointSampler::PointSampler(const Transport& transport, int bounces, const rays::Spot& spot, const PaintedPoint& painted)
    : transport_(transport),
      bounces_(bounces),
      spot_(spot),
      painted_(painted),
      on_projected_(transport.is_projected(spot)) {
  // The most and least chance that a direction is drawn from the environment where there is one.
  constexpr float kLeastLightChance = 0.1F, kMostLightChance = 0.75F, kFloorLightChance = 0.5F;
  if (transport.spectral_ != nullptr) return;
  if (on_projected_) {
    under_mesh_ = transport.is_under_mesh(spot);
    if (!under_mesh_) mesh_disc_ = transport.mesh_disc(spot);
    if (transport.environment_) light_chance_ = kFloorLightChance;
  } else if (transport.environment_) {
    const float wide = 1 - painted_.narrow_share(transport.environment_->extent_sr());
    light_chance_ = std::clamp(kMostLightChance * wide, kLeastLightChance, kMostLightChance);
  }
  open_ =
      !painted_.is_bent() && !transport.rays_->has_floor() && !transport.rays_->any_above(spot.start, spot.shading, 0);
  if (!open_ && !on_projected_ && painted_.mirror_weight() > 0)
    mirror_hit_ = transport.rays_->closest(spot.start, painted_.mirrored());
}

color::Rgb PointSampler::reflect(const Float3& f, const color::Rgb& light) const {
  return transport_.reflection_ != nullptr && !on_projected_
             ? color::reflected(*transport_.reflection_, rays::vec3(f), light)
             : rays::vec3(f) * light;
}

color::Rgb PointSampler::open_light(const Float3& direction, const color::Rgb& of_environment) const {
  if (transport_.open_floor_ == nullptr || !(direction.y < 0)) return of_environment;
  return rays::vec3(transport_.open_floor_->lit(spot_.start, direction, 0, 0));
}

double PointSampler::pdf(const Float3& direction, double of_environment, double of_paint) const {
  double of_others = (1 - places_.chance()) * of_paint;
  if (mesh_disc_) of_others = mesh_disc_->light.meets(rays::vec3(direction)) ? 1 / mesh_disc_->extent_sr() : 0;
  return light_chance_ * of_environment + (1 - light_chance_) * of_others;
}

PointSampler::Ray PointSampler::drawn_ray(const std::array<double, 4>& numbers) const {
  Ray ray;
  if (numbers[0] < light_chance_) {
    ray.place = transport_.environment_->place(numbers[1], numbers[2]);
    if (!(ray.place->density > 0)) return ray;
    ray.direction = ray.place->direction;
  } else {
    const double choice = (numbers[0] - light_chance_) / (1 - light_chance_);
    const double places = places_.chance();
    if (choice < places) {
      const BrightPlaces::Draw place =
          transport_.places_->drawn(places_, spot_.start, choice / places, numbers[1], numbers[2]);
      ray.place_triangle = place.triangle, ray.direction = place.direction;
    } else {
      ray.direction = mesh_disc_ ? Transport::drawn_from(*mesh_disc_, numbers[1], numbers[2]).direction
                                 : painted_.direction((choice - places) / (1 - places), numbers[1], numbers[2]);
    }
  }
  ray.above = painted_.faces(ray.direction);
  return ray;
}

void PointSampler::trace(const Sequence::Set& numbers, std::uint32_t first, std::span<Ray> rays) const {
  const bool finds_light = bounces_ > 0 || !transport_.emitters_.empty() || transport_.ground_;
  for (; !rays.empty(); first += kFan) {
    const std::span<Ray> fan_rays = rays.first(std::min<std::size_t>(kFan, rays.size()));
    rays = rays.subspan(fan_rays.size());
    std::array<double, 4> drawn[kFan];
    for (std::uint32_t i = 0; i < fan_rays.size(); ++i) {
      drawn[i] = numbers.point(first + i);
      if (drawn[i][0] < light_chance_) transport_.environment_->fetch(drawn[i][1], drawn[i][2]);
    }
    rays::Fan fan;
    fan.origin = spot_.start;
    for (std::uint32_t i = 0; i < fan_rays.size(); ++i) {
      fan_rays[i] = drawn_ray(drawn[i]);
      const Float3& direction = fan_rays[i].direction;
      fan.x[i] = direction.x, fan.y[i] = direction.y, fan.z[i] = direction.z;
      if (fan_rays[i].above && (!mesh_disc_ || mesh_disc_->light.meets(rays::vec3(direction)))) fan.wanted |= 1U << i;
    }
    if (fan.wanted == 0) continue;
    Hit hits[kFan];
    unsigned occluded = 0;
    if (finds_light) {
      transport_.rays_->closest(fan, hits);
    } else {
      occluded = transport_.rays_->occluded(fan);
    }
    for (std::uint32_t i = 0; i < fan_rays.size(); ++i)
      fan_rays[i].hit = hits[i], fan_rays[i].occluded = hits[i].any() || (occluded >> i & 1U) != 0;
  }
}

bool PointSampler::samples_mirror() const {
  if (!mirror_hit_.any()) return false;
  return transport_.is_projected(mirror_hit_) ? transport_.shaded_ == nullptr : bounces_ > 0;
}

PointSampler::Mirrored PointSampler::mirrored() const {
  Mirrored seen;
  if (!transport_.lights_.empty())
    seen.fixed = transport_.mirrored_lamps(spot_.start, painted_.mirrored(), mirror_hit_);
  if (const auto floor = transport_.seen_floor(mirror_hit_, spot_.start, painted_.mirrored())) {
    seen.fixed += floor->direct;
    if (bounces_ > 0) seen.bounced = floor->into_diffuse;
  } else if (mirror_hit_.any()) {
    seen.fixed += transport_.emitters_.radiance(transport_.rays_->part(mirror_hit_.triangle));
  }
  return seen;
}

}  // namespace goniochrome::render
