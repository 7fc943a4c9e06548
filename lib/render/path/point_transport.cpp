#include <algorithm>
#include <bit>
#include <cmath>

#include "base/angles.h"
#include "render/effects.h"
#include "render/path/spectral_paths.h"
#include "render/path/transport.h"

namespace goniochrome::render {

namespace {

using rays::Float3;
using rays::Hit;
using rays::Spot;

using rays::kInversePi;
// Sharp lobes gather the light of an open floor along directions, of which each has the mean over its part of so many;
// with an eighth of that part a picture of a room was .833 dE00 (p95) beside a long one, for .838. There is one
// direction for each ray, and for points without sums so many.
constexpr float kFloorParts = 32;
constexpr std::uint32_t kFloorDirections = 4;
// The most and least chance that a direction is drawn from the environment where there is one.
constexpr float kLeastLightChance = 0.1F, kMostLightChance = 0.75F, kFloorLightChance = 0.5F;

}  // namespace

// A direction at the visible point.
struct PointTransport::Ray {
  Float3 direction;
  bool above = false;
  std::optional<EnvironmentTable::Place> place;  // where the direction was drawn from the environment
  std::optional<std::uint32_t> place_triangle;   // where it was drawn toward a bright place of the surface
};

PointTransport::PointTransport(const Transport& transport, const PathOptions& options, const Spot& spot,
                               const Float3& to_viewer)
    : transport_(transport),
      options_(options),
      spot_(spot),
      to_viewer_(to_viewer),
      painted_(options.white ? PaintedPoint(Float3{kInversePi, kInversePi, kInversePi}, spot.shading, to_viewer)
                             : transport.painted(spot, to_viewer)),
      on_projected_(transport.is_projected(spot)),
      correction_(options.correction || on_projected_),
      over_ground_(!on_projected_ && transport.shaded_ != nullptr && transport.environment_ != nullptr) {
  if (transport.spectral_ != nullptr) {
    deterministic_ = transport.spectral_->emitted(spot);
    certain_ = painted_.black();
    return;
  }
  deterministic_ = on_projected_ ? transport.open_ground(spot) : transport.emitters_.radiance(spot.part);
  if (on_projected_) {
    // Under the mesh most light is occluded: what is left of it is summed, instead of taken from that of the open
    // floor.
    if (transport.is_under_mesh(spot)) {
      correction_ = false, deterministic_ = {};
    } else {
      mesh_disc_ = transport.mesh_disc(spot);
    }
    if (transport.environment_) light_chance_ = kFloorLightChance;
  } else if (transport.environment_) {
    const float wide = 1 - painted_.narrow_share(transport.environment_->extent_sr());
    light_chance_ = std::clamp(kMostLightChance * wide, kLeastLightChance, kMostLightChance);
  }
  if (options.bounces > 0 && !correction_ && !over_ground_) receiver_ = transport.receiver(spot, painted_);
  open_ =
      !painted_.is_bent() && !transport.rays_->has_floor() && !transport.rays_->any_above(spot.start, spot.shading, 0);
  const bool free = open_ && options.correction;
  if (!free) {
    add_lights();
  }
  if (!free) add_mirror();
  certain_ = free || (!(painted_.lobes_weight() > 0) && mirror_samples_ == 0 && lamps_.empty());
}

color::Rgb PointTransport::reflect(const Float3& f, const color::Rgb& light) const {
  return transport_.reflection_ != nullptr && !on_projected_
             ? color::reflected(*transport_.reflection_, rays::vec3(f), light)
             : rays::vec3(f) * light;
}

// A point is either seen or hidden. Of a disc the light without the mesh is known, and samples tell what the mesh takes
// from it, without bias; where it takes most of it, they tell what is left. Which of both is decided by a few rays and
// has no part in the expectation.
void PointTransport::add_lights() {
  for (std::size_t i = 0; i < transport_.lights_.size(); ++i) {
    const Transport::SeenLamp lamp = transport_.seen_lamp(i, spot_.start);
    const Light& light = lamp.light;
    if (!(light.radius_rad > 0)) {
      const Float3 direction = rays::float3(light.direction);
      const Reflection reflection = painted_.at(direction);
      if (!(reflection.pdf > 0)) continue;
      const bool occluded = transport_.rays_->occluded(spot_.start, direction, lamp.reach);
      if (occluded == correction_) deterministic_ += (occluded ? -kPi : kPi) * reflect(reflection.f_cos, light.white);
      continue;
    }
    const double sine = rays::dot(spot_.shading, rays::float3(light.direction));
    if (!painted_.is_bent() && sine <= -std::sin(light.radius_rad)) continue;
    const color::Rgb whole = reflect(painted_.toward_disc(light, !lamp.is_placed), kPi * light.white);
    const Sequence::Set probes = Sequence(mixed(0x1A3B, i), kFan).set(0);
    rays::Fan fan = lamp_fan(lamp);
    for (std::uint32_t k = 0; k < kFan && !open_; ++k) {
      const std::array<double, 4> numbers = probes.point(k);
      aim(fan, k, Transport::drawn_from(lamp, numbers[0], numbers[1]).direction);
    }
    const int above = std::popcount(fan.wanted);
    const int occluded = above > 0 ? std::popcount(transport_.rays_->occluded(fan)) : 0;
    const bool hidden = 2 * occluded <= above;
    if (hidden != correction_) deterministic_ += (correction_ ? -1.0 : 1.0) * whole;
    if (!open_) lamps_.push_back({lamp, hidden});
  }
}

rays::Fan PointTransport::lamp_fan(const Transport::SeenLamp& lamp) const {
  constexpr double kNarrow_rad = 0.2;
  rays::Fan fan;
  fan.origin = spot_.start;
  fan.reach = lamp.reach;
  fan.narrow = lamp.light.radius_rad < kNarrow_rad;
  return fan;
}

void PointTransport::aim(rays::Fan& fan, std::uint32_t ray, const Float3& direction) const {
  fan.x[ray] = direction.x, fan.y[ray] = direction.y, fan.z[ray] = direction.z;
  if (painted_.faces(direction)) fan.wanted |= 1U << ray;
}

// The light that lamps with an extent add to deterministic(), as the mean over samples. A place on the disc is drawn
// and, where the paint has lobes narrower than the disc, a direction of the lobes, which may meet it too; together they
// count the light once (the balance heuristic, [Veach1995] 3.1). By places alone, gloss beside a wide lamp would be
// specks: few of them lie in a narrow lobe, and those are bright. The paint is asked for those rays alone that add
// anything.
color::Rgb PointTransport::lamp_shadows(const Sequence& sequence, std::uint32_t begin, std::uint32_t count) const {
  constexpr std::uint32_t kSet = 60;         // that nothing else draws from
  constexpr float kLeastNarrowShare = 0.1F;  // below it, what is reflected hardly changes across the disc
  const auto lamps = static_cast<std::uint32_t>(lamps_.size());
  color::Rgb sum;
  if (!(painted_.lobes_weight() > 0)) return sum;
  for (std::uint32_t k = 0; k < lamps; ++k) {
    const Lamp& lamp = lamps_[k];
    const Light& light = lamp.seen.light;
    const double extent_sr = 2 * kPi * lamp.seen.versine;
    const bool by_lobes = painted_.narrow_share(extent_sr) > kLeastNarrowShare;
    const Sequence::Set places = sequence.set(kSet + k), lobes = sequence.set(kSet + lamps + k);
    // Calls visit(what the paint shows) for the rays of a fan that add anything.
    const auto visit = [&](const rays::Fan& fan, const auto& visit_one) {
      if (fan.wanted == 0) return;
      const unsigned occluded = transport_.rays_->occluded(fan);
      for (unsigned left = fan.wanted & (lamp.hidden ? occluded : ~occluded); left != 0; left &= left - 1) {
        const auto i = static_cast<std::uint32_t>(std::countr_zero(left));
        const Reflection reflection = painted_.at({fan.x[i], fan.y[i], fan.z[i]});
        if (reflection.pdf > 0) visit_one(reflection);
      }
    };
    for (std::uint32_t first = begin; first < begin + count; first += kFan) {
      rays::Fan to_places = lamp_fan(lamp.seen), to_lobes = to_places;
      for (std::uint32_t i = 0; i < std::min<std::uint32_t>(kFan, begin + count - first); ++i) {
        const std::array<double, 4> numbers = places.point(first + i);
        aim(to_places, i, Transport::drawn_from(lamp.seen, numbers[0], numbers[1]).direction);
        if (!by_lobes) continue;
        const Float3 direction = painted_.direction(numbers[2], numbers[3], lobes.point(first + i)[0]);
        aim(to_lobes, i, direction);
        if (!light.meets(rays::vec3(direction))) to_lobes.wanted &= ~(1U << i);
      }
      const color::Rgb whole = Transport::drawn_from(lamp.seen, 0, 0).light;  // the same for every place
      const double sign = lamp.hidden ? -1.0 : 1.0;
      visit(to_places, [&](const Reflection& place) {
        const double share = by_lobes ? 1 / (1 + extent_sr * place.pdf) : 1;
        sum += sign * reflect(place.f_cos, share * whole);
      });
      visit(to_lobes, [&](const Reflection& lobe) {
        sum += sign * reflect(lobe.f_cos, (extent_sr / (1 + extent_sr * lobe.pdf)) * light.radiance());
      });
    }
  }
  return sum;
}

void PointTransport::add_mirror() {
  const Float3& mirror = painted_.mirror();
  const float weight = painted_.mirror_weight();
  if (!(weight > 0)) return;
  mirror_hit_ = transport_.rays_->closest(spot_.start, painted_.mirrored());
  const color::Rgb open = transport_.environment_ ? transport_.mirrored_environment(painted_.mirrored()) : color::Rgb{};
  if (!transport_.lights_.empty()) {
    color::Rgb lamps = transport_.mirrored_lamps(spot_.start, painted_.mirrored(), mirror_hit_);
    if (correction_) lamps += -1.0 * transport_.mirrored_lamps(spot_.start, painted_.mirrored(), {});
    deterministic_ += reflect(mirror, lamps);
  }
  if (!mirror_hit_.any()) {
    if (!correction_) deterministic_ += reflect(mirror, open);
    return;
  }
  if (correction_) deterministic_ += -1.0 * reflect(mirror, open);
  if (const auto floor = transport_.seen_floor(mirror_hit_, spot_.start, painted_.mirrored())) {
    deterministic_ += reflect(mirror, floor->direct);
    if (options_.bounces > 0 && options_.into_lobes) deterministic_ += reflect(mirror, floor->into_diffuse);
    return;
  }
  deterministic_ += reflect(mirror, transport_.emitters_.radiance(transport_.rays_->part(mirror_hit_.triangle)));
  if ((options_.bounces == 0 || !options_.into_lobes) && !transport_.is_projected(mirror_hit_)) return;
  const double share = weight / (weight + painted_.lobes_weight());
  mirror_samples_ = static_cast<std::uint32_t>(std::clamp(static_cast<int>(std::lround(kBatch * share)), 1, kBatch));
}

// The density of a direction that is not drawn from the environment, by the samplers of lights.
double PointTransport::drawn_pdf(const Float3& direction, const Reflection& reflection) const {
  if (mesh_disc_) return mesh_disc_->light.meets(rays::vec3(direction)) ? 1 / mesh_disc_->extent_sr() : 0;
  return (1 - receiver_.chance()) * reflection.pdf;
}

PointTransport::Ray PointTransport::drawn_ray(const std::array<double, 4>& numbers) const {
  Ray ray;
  if (numbers[0] < light_chance_) {
    ray.place = transport_.environment_->place(numbers[1], numbers[2]);
    if (!(ray.place->density > 0)) return ray;
    ray.direction = ray.place->direction;
  } else {
    const double choice = (numbers[0] - light_chance_) / (1 - light_chance_);
    const double places = receiver_.chance();
    if (choice < places) {
      const BrightPlaces::Draw place =
          transport_.places_->drawn(receiver_, spot_.start, choice / places, numbers[1], numbers[2]);
      ray.place_triangle = place.triangle, ray.direction = place.direction;
    } else {
      ray.direction = mesh_disc_ ? Transport::drawn_from(*mesh_disc_, numbers[1], numbers[2]).direction
                                 : painted_.direction((choice - places) / (1 - places), numbers[1], numbers[2]);
    }
  }
  ray.above = painted_.faces(ray.direction);
  return ray;
}

// The contribution of a drawn direction. One set of directions serves every lobe and the environment: each is weighed
// by the density that the mixture gives it, which is the balance heuristic.
LightShares PointTransport::shown(const Ray& ray, bool occluded, const Sequence& sequence, std::uint32_t index) const {
  const Reflection reflection = painted_.at(ray.direction);
  LightSample light;
  if (!(reflection.pdf > 0)) return {};
  if (ray.place) {
    light = transport_.environment_->light(*ray.place);
  } else if (transport_.environment_) {
    light = transport_.environment_->at(ray.direction);
  }
  const bool passes_on = options_.bounces > 0 || !transport_.emitters_.empty() || transport_.ground_;
  const Hit hit = occluded && passes_on ? transport_.rays_->closest(spot_.start, ray.direction) : Hit();
  if (ray.place_triangle && hit.triangle != *ray.place_triangle) return {};
  double pdf = light_chance_ * light.pdf + (1 - light_chance_) * drawn_pdf(ray.direction, reflection);
  if (receiver_.chance() > 0)
    pdf += (1 - light_chance_) * receiver_.chance() * transport_.places_->pdf(receiver_, hit, ray.direction);
  if (!(pdf > 0)) return {};
  const auto scaled = static_cast<float>(1 / pdf);
  if (!occluded) return {reflect(scaled * reflection.f_cos, light.radiance), {}, {}};

  color::Rgb arriving = correction_ ? -1.0 * light.radiance : color::Rgb{}, sent;
  LightShares shares;
  if (passes_on) {
    if (transport_.is_projected(hit)) {
      const Transport::FloorLight floor =
          transport_.off_floor(hit, spot_.start, ray.direction, options_.bounces, sequence, index, 4);
      arriving += floor.fixed, sent = floor.bounced;
    } else if (hit.any()) {
      const color::Rgb& emission = transport_.emitters_.radiance(transport_.rays_->part(hit.triangle));
      if (emission != color::Rgb{})
        arriving += pdf /
                    (pdf + transport_.emitters_.pdf(lit_point(spot_), hit.triangle, ray.direction, hit.distance)) *
                    emission;
      if (options_.bounces > 0 && (options_.into_lobes || options_.into_diffuse))
        sent = transport_.bounced(hit, spot_.start, ray.direction, options_.bounces, sequence, index, 4);
    }
  }
  add_sent(ray.direction, sent, scaled, shares);
  shares.direct = reflect(scaled * reflection.f_cos, arriving);
  return shares;
}

// Over a floor that shows the environment. In a correction floor_light() and sharp_floor_light() tell the open floor,
// and rays tell what the mesh takes from there and sends instead.
LightShares PointTransport::shown_over_ground(const Ray& ray, const Hit& hit, const Sequence& sequence,
                                              std::uint32_t index) const {
  LightShares shares;
  const bool meets_floor = transport_.is_projected(hit);
  if (!ray.above || (correction_ && (!hit.any() || meets_floor))) return shares;
  const Reflection reflection = painted_.at(ray.direction);
  if (!(reflection.pdf > 0)) return shares;
  const LightSample light =
      ray.place ? transport_.environment_->light(*ray.place) : transport_.environment_->at(ray.direction);
  const auto scaled = static_cast<float>(1 / (light_chance_ * light.pdf + (1 - light_chance_) * reflection.pdf));
  const Float3 f_cos = scaled * reflection.f_cos;
  if (meets_floor) {
    const Transport::FloorLight floor =
        transport_.off_floor(hit, spot_.start, ray.direction, options_.bounces, sequence, index, 4);
    shares.from_floor = reflect(f_cos, floor.fixed);
    add_sent(ray.direction, floor.bounced, scaled, shares);
    return shares;
  }
  if (correction_ && ray.direction.y < 0) {
    const Float3 taken = transport_.open_floor_->lit(spot_.start, ray.direction, 0, 0);
    shares.from_floor = -1.0 * reflect(f_cos, rays::vec3(taken));
  } else if (hit.any() == correction_) {
    shares.direct = (correction_ ? -1.0 : 1.0) * reflect(f_cos, light.radiance);
  }
  if (hit.any() && options_.bounces > 0 && (options_.into_lobes || options_.into_diffuse))
    add_sent(ray.direction, transport_.bounced(hit, spot_.start, ray.direction, options_.bounces, sequence, index, 4),
             scaled, shares);
  return shares;
}

color::Rgb PointTransport::floor_light() const {
  if (certain_ || !over_ground_ || !correction_) return {};
  const auto lobes = painted_.wide_lobes(kWidestShared, GroundReceiver::kMostLobes);
  if (!lobes) return {};
  GroundReceiver receiver = ground_receiver(spot_, painted_);
  for (const PaintedPoint::WideLobe& lobe : *lobes) receiver.exponents[receiver.lobes++] = lobe.exponent;
  const GroundColumns columns = transport_.open_floor_->columns(receiver);
  color::Rgb light = reflect(painted_.diffuse(), rays::vec3(columns.diffuse));
  for (std::size_t j = 0; j < lobes->size(); ++j)
    light += reflect((*lobes)[j].directional_diffuse, rays::vec3(columns.flakes[j])) +
             reflect((*lobes)[j].gloss, rays::vec3(columns.gloss[j]));
  return light;
}

// The light of the open floor beside floor_light(): the sum over these samples along directions that each gather the
// mean about them.
color::Rgb PointTransport::sharp_floor_light(const Sequence& sequence, std::uint32_t begin, std::uint32_t count) const {
  constexpr std::uint32_t kSet = 40;  // that nothing else draws from
  const OpenFloor& floor = *transport_.open_floor_;
  color::Rgb sum;
  std::optional<PaintedPoint> rest;
  if (const auto lobes = painted_.wide_lobes(kWidestShared, GroundReceiver::kMostLobes))
    rest = painted_.without_wide(lobes->size());
  const PaintedPoint& point = rest ? *rest : painted_;
  if (!(point.lobes_weight() > 0)) return sum;
  const std::uint32_t directions = rest ? 1 : kFloorDirections;
  for (std::uint32_t k = 0; k < directions; ++k) {
    const Sequence::Set set = sequence.set(kSet + k);
    for (std::uint32_t i = begin; i < begin + count; ++i) {
      const std::array<double, 4> numbers = set.point(i);
      const Float3 direction = point.direction(numbers[0], numbers[1], numbers[2]);
      if (!(direction.y < 0)) continue;
      const Reflection reflection = point.at(direction);
      if (!(reflection.pdf > 0)) continue;
      const float extent = 1 / (kFloorParts * reflection.pdf), number = static_cast<float>(numbers[3]);
      const Float3 more = floor.lit(spot_.start, direction, extent, number) - floor.hidden(direction, extent, number);
      sum += reflect((1 / (static_cast<float>(directions) * reflection.pdf)) * reflection.f_cos, rays::vec3(more));
    }
  }
  return sum;
}

// Adds the light that surfaces send along a direction, times `scale`: one over the density of the direction.
void PointTransport::add_sent(const Float3& direction, const color::Rgb& sent, float scale, LightShares& shares) const {
  if (sent == color::Rgb{}) return;
  const PaintedPoint::Parts parts = painted_.parts(direction);
  if (options_.into_lobes) shares.into_lobes = reflect(scale * parts.lobes, sent);
  if (options_.into_diffuse) shares.into_diffuse = reflect(scale * parts.diffuse, sent);
}

color::Rgb PointTransport::emitter_sample(const std::array<double, 4>& numbers) const {
  const EmitterSample light = transport_.emitters_.drawn(lit_point(spot_), numbers[0], numbers[1], numbers[2]);
  if (!(light.pdf > 0)) return {};
  const Reflection reflection = painted_.at(light.direction);
  if (!(reflection.pdf > 0) ||
      transport_.rays_->occluded(spot_.start, light.direction, Transport::kShort * light.distance))
    return {};
  const double open_pdf = transport_.environment_ ? transport_.environment_->at(light.direction).pdf : 0;
  const double pdf =
      light.pdf + light_chance_ * open_pdf + (1 - light_chance_) * drawn_pdf(light.direction, reflection);
  return reflect(static_cast<float>(1 / pdf) * reflection.f_cos, light.radiance);
}

// The light that the mirror lobe sees, summed over these samples.
LightShares PointTransport::mirrored(const Sequence& sequence, std::uint32_t begin, std::uint32_t count) const {
  color::Rgb fixed, sent;
  for (std::uint32_t i = begin; i < begin + count; ++i) {
    if (transport_.is_projected(mirror_hit_)) {
      const Transport::FloorLight floor =
          transport_.off_floor(mirror_hit_, spot_.start, painted_.mirrored(), options_.bounces, sequence, i, 4);
      fixed += floor.fixed, sent += floor.bounced;
    } else {
      sent += transport_.bounced(mirror_hit_, spot_.start, painted_.mirrored(), options_.bounces, sequence, i, 4);
    }
  }
  LightShares shares;
  shares.direct = reflect(painted_.mirror(), fixed);
  if (options_.into_lobes) shares.into_lobes = reflect(painted_.mirror(), sent);
  return shares;
}

LightShares PointTransport::shares_of(const Sequence& sequence, std::uint32_t begin, std::uint32_t count) const {
  if (certain_) return {};
  LightShares sum;
  if (transport_.spectral_ != nullptr) {
    sum.direct = transport_.spectral_->shown(transport_, options_, spot_, to_viewer_, sequence, begin, count);
    return sum;
  }
  sum.direct += lamp_shadows(sequence, begin, count);
  if (painted_.lobes_weight() > 0) {
    const Sequence::Set numbers = sequence.set(0);
    for (std::uint32_t first = begin; first < begin + count; first += kFan) {
      Ray rays[kFan];
      rays::Fan fan;
      fan.origin = spot_.start;
      const std::uint32_t traced = std::min<std::uint32_t>(kFan, begin + count - first);
      std::array<double, 4> drawn[kFan];
      for (std::uint32_t i = 0; i < traced; ++i) {
        drawn[i] = numbers.point(first + i);
        if (drawn[i][0] < light_chance_) transport_.environment_->fetch(drawn[i][1], drawn[i][2]);
      }
      for (std::uint32_t i = 0; i < traced; ++i) {
        rays[i] = drawn_ray(drawn[i]);
        fan.x[i] = rays[i].direction.x, fan.y[i] = rays[i].direction.y, fan.z[i] = rays[i].direction.z;
        if (rays[i].above && (!mesh_disc_ || mesh_disc_->light.meets(rays::vec3(rays[i].direction))))
          fan.wanted |= 1U << i;
      }
      if (over_ground_) {
        Hit hits[kFan];
        if (fan.wanted != 0) transport_.rays_->closest(fan, hits);
        if (correction_) sum.from_floor += sharp_floor_light(sequence, first, traced);
        for (std::uint32_t i = 0; i < traced; ++i) {
          sum += shown_over_ground(rays[i], hits[i], sequence, first + i);
        }
        continue;
      }
      const unsigned occluded = fan.wanted != 0 ? transport_.rays_->occluded(fan) : 0;
      for (std::uint32_t i = 0; i < traced; ++i) {
        const bool is_occluded = (occluded >> i & 1U) != 0;
        if (!rays[i].above || (!is_occluded && (correction_ || !transport_.environment_))) continue;
        sum += shown(rays[i], is_occluded, sequence, first + i);
      }
    }
    if (!transport_.emitters_.empty())
      for (std::uint32_t i = begin; i < begin + count; ++i) sum.direct += emitter_sample(sequence.point(i, 1));
  }
  const std::uint32_t mirrors = mirror_samples_ > 0 ? std::max(1U, mirror_samples_ * count / kBatch) : 0;
  if (mirrors > 0) sum += static_cast<double>(count) / mirrors * mirrored(sequence.other(0x4D), begin, mirrors);
  return (1.0 / count) * sum;
}

}  // namespace goniochrome::render
