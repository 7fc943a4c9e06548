// Light at one point, sampled by rays for whatever receives it there: a surface in three channels, or the columns of a
// basis. goniochrome-paths(7), "PATHS".
//
// A receiver knows its own product of light and paint. It has
//   at(direction)                the paint toward a direction, with its density `pdf`, which is 0 below the horizon
//   mirror()                     the paint toward the mirror direction alone
//   wants(ray)                   returns false where a ray adds nothing
//   add_sky(f, scale, ray, light)        the environment along a ray, whether a surface is in its way or not
//   add_light(f, scale, light)           light of an emitter
//   add_floor(f, scale, hit, light)      a floor that shows the environment
//   add_sent(f, scale, hit, direction, sequence, index)  what the surface at a hit passes on
// where f is what the receiver's at() or mirror() returned.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "render/path/transport.h"

namespace goniochrome::render {

class PointSampler {
 protected:
  // `painted` is what directions are drawn by. The transport must outlive the point.
  PointSampler(const Transport& transport, int bounces, const rays::Spot& spot, const PaintedPoint& painted);

  // A direction at the point, and what is met there.
  struct Ray {
    rays::Float3 direction;
    bool above = false;                            // the horizon
    bool occluded = false;                         // by a surface or a floor
    rays::Hit hit;                                 // the surface, where any light may come from one
    std::optional<EnvironmentTable::Place> place;  // where the direction was drawn from the environment
    std::optional<std::uint32_t> place_triangle;   // where it was drawn toward a bright place of the surface
  };
  // Draws and traces rays by the points first, first + 1, ... of a set.
  void trace(const Sequence::Set& numbers, std::uint32_t first, std::span<Ray> rays) const;
  // Adds the light of rays that the first set of the sequence drew, and as many samples of emitters.
  template <class Receiver>
  void add(std::span<const Ray> rays, const Sequence& sequence, std::uint32_t first, Receiver& receiver) const;
  // Both, for so many rays.
  template <class Receiver>
  void sample(const Sequence& sequence, std::uint32_t first, std::uint32_t count, Receiver& receiver) const;
  // True if samples tell what the mirror direction sees.
  bool samples_mirror() const;
  // Adds so many of them, each times `scale`; nothing where they tell nothing.
  template <class Receiver>
  void sample_mirror(const Sequence& sequence, std::uint32_t first, std::uint32_t count, double scale,
                     Receiver& receiver) const;
  // The light from the mirror direction that needs no samples, that of the environment apart.
  struct Mirrored {
    color::Rgb fixed, bounced;
  };
  Mirrored mirrored() const;
  // The light from there if there were no mesh: that of the environment, or of an open floor whose ground is shaded.
  color::Rgb open_light(const rays::Float3& direction, const color::Rgb& of_environment) const;
  // The point reflects light by the scene's product of colors.
  color::Rgb reflect(const rays::Float3& f, const color::Rgb& light) const;

  const Transport& transport_;
  int bounces_;
  rays::Spot spot_;
  PaintedPoint painted_;
  bool on_projected_;                             // on a floor that shows the environment
  bool under_mesh_ = false;                       // of such a point: most light may be occluded
  std::optional<Transport::SeenLamp> mesh_disc_;  // of such a point beside the mesh: only rays within it can meet it
  bool open_ = false;                             // nothing rises above the horizon
  rays::Hit mirror_hit_;
  float light_chance_ = 0;  // of a direction that is drawn from the environment
  BrightPlaces::Receiver places_;

 private:
  Ray drawn_ray(const std::array<double, 4>& numbers) const;
  // The density of a direction, but for those that are drawn toward bright places, by those of its other samplers.
  double pdf(const rays::Float3& direction, double of_environment, double of_paint) const;
  template <class Receiver>
  void add_ray(const Ray& ray, const Sequence& sequence, std::uint32_t index, Receiver& receiver) const;
  template <class Receiver>
  void add_emitter(const std::array<double, 4>& numbers, Receiver& receiver) const;
  template <class Receiver, class Values>
  void add_passed_on(const Values& f, double scale, const rays::Hit& hit, const rays::Float3& direction,
                     const Sequence& sequence, std::uint32_t index, Receiver& receiver) const;
};

// One set of directions serves every lobe and the environment: each is weighed by the density that the mixture gives
// it, which is the balance heuristic.
template <class Receiver>
void PointSampler::add_ray(const Ray& ray, const Sequence& sequence, std::uint32_t index, Receiver& receiver) const {
  const auto f = receiver.at(ray.direction);
  if (!(f.pdf > 0)) return;
  LightSample sky;
  if (ray.place) {
    sky = transport_.environment_->light(*ray.place);
  } else if (transport_.environment_) {
    sky = transport_.environment_->at(ray.direction);
  }
  if (ray.place_triangle && ray.hit.triangle != *ray.place_triangle) return;
  double density = pdf(ray.direction, sky.pdf, f.pdf);
  if (places_.chance() > 0)
    density += (1 - light_chance_) * places_.chance() * transport_.places_->pdf(places_, ray.hit, ray.direction);
  if (!(density > 0)) return;
  receiver.add_sky(f, 1 / density, ray, sky.radiance);
  if (!ray.hit.any()) return;
  const color::Rgb& emission = transport_.emitters_.radiance(transport_.rays_->part(ray.hit.triangle));
  if (emission != color::Rgb{}) {
    const double drawn = transport_.emitters_.pdf(lit_point(spot_), ray.hit.triangle, ray.direction, ray.hit.distance);
    receiver.add_light(f, 1 / (density + drawn), emission);
  }
  add_passed_on(f, 1 / density, ray.hit, ray.direction, sequence, index, receiver);
}

template <class Receiver, class Values>
void PointSampler::add_passed_on(const Values& f, double scale, const rays::Hit& hit, const rays::Float3& direction,
                                 const Sequence& sequence, std::uint32_t index, Receiver& receiver) const {
  if (transport_.is_projected(hit)) {
    receiver.add_floor(f, scale, hit, transport_.off_floor(hit, spot_.start, direction, bounces_, sequence, index, 4));
  } else if (bounces_ > 0) {
    receiver.add_sent(f, scale, hit, direction, sequence, index);
  }
}

template <class Receiver>
void PointSampler::add_emitter(const std::array<double, 4>& numbers, Receiver& receiver) const {
  const EmitterSample light = transport_.emitters_.drawn(lit_point(spot_), numbers[0], numbers[1], numbers[2]);
  if (!(light.pdf > 0)) return;
  const auto f = receiver.at(light.direction);
  if (!(f.pdf > 0) || transport_.rays_->occluded(spot_.start, light.direction, Transport::kShort * light.distance))
    return;
  const double of_environment = transport_.environment_ ? transport_.environment_->at(light.direction).pdf : 0;
  receiver.add_light(f, 1 / (light.pdf + pdf(light.direction, of_environment, f.pdf)), light.radiance);
}

template <class Receiver>
void PointSampler::add(std::span<const Ray> rays, const Sequence& sequence, std::uint32_t first,
                       Receiver& receiver) const {
  for (const Ray& ray : rays) {
    const auto index = first + static_cast<std::uint32_t>(&ray - rays.data());
    if (ray.above && receiver.wants(ray)) add_ray(ray, sequence, index, receiver);
    if (!transport_.emitters_.empty()) add_emitter(sequence.point(index, 1), receiver);
  }
}

template <class Receiver>
void PointSampler::sample(const Sequence& sequence, std::uint32_t first, std::uint32_t count,
                          Receiver& receiver) const {
  const Sequence::Set numbers = sequence.set(0);
  for (const std::uint32_t end = first + count; first < end; first += kFan) {
    Ray rays[kFan];
    const std::span traced(rays, std::min<std::uint32_t>(kFan, end - first));
    trace(numbers, first, traced);
    add(traced, sequence, first, receiver);
  }
}

template <class Receiver>
void PointSampler::sample_mirror(const Sequence& sequence, std::uint32_t first, std::uint32_t count, double scale,
                                 Receiver& receiver) const {
  const auto f = receiver.mirror();
  for (std::uint32_t i = first; samples_mirror() && i < first + count; ++i)
    add_passed_on(f, scale, mirror_hit_, painted_.mirrored(), sequence, i, receiver);
}

}  // namespace goniochrome::render
