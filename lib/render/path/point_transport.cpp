#include "render/path/point_transport.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/angles.h"
#include "render/effects.h"
#include "render/path/spectral_paths.h"

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

}  // namespace

// Receives light in three channels. In a correction floor_light() and sharp_floor_light() tell the floor whose ground
// is shaded, and rays tell what the mesh takes from there and sends instead.
class PointTransport::Surface {
 public:
  explicit Surface(const PointTransport& point) : point_(point) {}
  LightShares shares;

  PaintedPoint::Parts at(const Float3& direction) const { return point_.painted_.parts(direction); }
  PaintedPoint::Parts mirror() const { return {{}, point_.painted_.mirror(), {}, 0}; }
  bool wants(const Ray& ray) const {
    if (!point_.correction_) return ray.occluded || point_.transport_.environment_;
    return ray.occluded && !(point_.over_ground_ && point_.transport_.is_projected(ray.hit));
  }
  void add_sky(const PaintedPoint::Parts& f, double scale, const Ray& ray, const color::Rgb& light) {
    if (ray.occluded != point_.correction_) return;
    if (!point_.correction_) return add_light(f, scale, light);
    color::Rgb& share = point_.over_ground_ && ray.direction.y < 0 ? shares.from_floor : shares.direct;
    share += -scale * reflect(f.diffuse + f.lobes, point_.open_light(ray.direction, light));
  }
  void add_light(const PaintedPoint::Parts& f, double scale, const color::Rgb& light) {
    shares.direct += scale * reflect(f.diffuse + f.lobes, light);
  }
  void add_floor(const PaintedPoint::Parts& f, double scale, const Hit&, const Transport::FloorLight& light) {
    (point_.over_ground_ ? shares.from_floor : shares.direct) += scale * reflect(f.diffuse + f.lobes, light.fixed);
    add_sent(f, scale, light.bounced);
  }
  void add_sent(const PaintedPoint::Parts& f, double scale, const Hit& hit, const Float3& direction,
                const Sequence& sequence, std::uint32_t index) {
    const Transport& t = point_.transport_;
    add_sent(f, scale, t.bounced(hit, point_.spot_.start, direction, point_.bounces_, sequence, index, 4));
  }

 private:
  color::Rgb reflect(const Float3& f, const color::Rgb& light) const { return point_.reflect(f, light); }
  void add_sent(const PaintedPoint::Parts& f, double scale, const color::Rgb& light) {
    if (light == color::Rgb{}) return;
    if (point_.options_.into_lobes) shares.into_lobes += scale * reflect(f.lobes, light);
    if (point_.options_.into_diffuse) shares.into_diffuse += scale * reflect(f.diffuse, light);
  }
  const PointTransport& point_;
};

PointTransport::PointTransport(const Transport& transport, const PathOptions& options, const Spot& spot,
                               const Float3& to_viewer)
    : PointSampler(transport, options.into_lobes || options.into_diffuse ? options.bounces : 0, spot,
                   options.white ? PaintedPoint(Float3{kInversePi, kInversePi, kInversePi}, spot.shading, to_viewer)
                                 : transport.painted(spot, to_viewer)),
      options_(options),
      correction_(on_projected_ ? !under_mesh_ : options.correction),
      over_ground_(!on_projected_ && transport.shaded_ != nullptr && transport.environment_ != nullptr) {
  if (transport.spectral_ != nullptr) {
    deterministic_ = transport.spectral_->emitted(spot);
    certain_ = painted_.black();
    return;
  }
  // Under the mesh most light of a floor is occluded: what is left of it is summed, instead of taken from that of the
  // open floor.
  if (!on_projected_) deterministic_ = transport.emitters_.radiance(spot.part);
  if (on_projected_ && !under_mesh_) deterministic_ = transport.open_ground(spot);
  if (bounces_ > 0 && !correction_ && !over_ground_) places_ = transport.receiver(spot, painted_);
  const bool free = open_ && correction_;
  if (!free) add_lights(), add_mirror();
  certain_ = free || (!(painted_.lobes_weight() > 0) && mirror_samples_ == 0 && lamps_.empty());
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
  const float weight = painted_.mirror_weight();
  if (!(weight > 0)) return;
  const Mirrored seen = mirrored();
  color::Rgb light = seen.fixed;
  if (correction_) light += -1.0 * transport_.mirrored_lamps(spot_.start, painted_.mirrored(), {});
  if (transport_.environment_ && mirror_hit_.any() == correction_)
    light += (correction_ ? -1.0 : 1.0) * transport_.mirrored_environment(painted_.mirrored());
  if (options_.into_lobes) light += seen.bounced;
  deterministic_ += reflect(painted_.mirror(), light);
  if (!samples_mirror() || (!options_.into_lobes && !transport_.is_projected(mirror_hit_))) return;
  const double share = weight / (weight + painted_.lobes_weight());
  mirror_samples_ = static_cast<std::uint32_t>(std::clamp(static_cast<int>(std::lround(kBatch * share)), 1, kBatch));
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

LightShares PointTransport::shares_of(const Sequence& sequence, std::uint32_t begin, std::uint32_t count) const {
  if (certain_) return {};
  Surface surface(*this);
  if (transport_.spectral_ != nullptr) {
    surface.shares.direct =
        transport_.spectral_->shown(transport_, options_, spot_, painted_.to_viewer(), sequence, begin, count);
    return surface.shares;
  }
  surface.shares.direct = lamp_shadows(sequence, begin, count);
  if (painted_.lobes_weight() > 0) {
    if (correction_ && over_ground_) surface.shares.from_floor = sharp_floor_light(sequence, begin, count);
    sample(sequence, begin, count, surface);
  }
  const std::uint32_t mirrors = mirror_samples_ > 0 ? std::max(1U, mirror_samples_ * count / kBatch) : 0;
  if (mirrors > 0) sample_mirror(sequence.other(0x4D), begin, mirrors, static_cast<double>(count) / mirrors, surface);
  return (1.0 / count) * surface.shares;
}

}  // namespace goniochrome::render
