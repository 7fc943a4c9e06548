// One step and one loop for all paths, over what carries their light: three channels, classes of light, or bands.
// goniochrome-paths(7), "PATHS".
//
// A carrier knows its own product of light and paints. It has
//   kWeighsLamps                           whether light of discs is weighed against the same light found by the lobes
//   reflected(vertex, to_light)            f cos_i with its density `pdf`, which is 0 below the horizon
//   add_reflected(vertex, f, scale, light) adds light that the path so far and this surface reflect
//   add(scale, light)                      adds light that the path so far reflects
//   reflect(vertex, f, scale), mirror(vertex, scale), scale(factor)   lengthen the path
//   size()                                 the most that light of 1 can show at the end of the path
// or, in the place of scale() and size(), where a path has one surface,
//   add_deeper(light)                      adds light of further surfaces, in three channels, that this one reflects
#pragma once

#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "render/path/transport.h"

namespace goniochrome::render {

// Light that a path found, and its source, by whose number a carrier may know more of it than three channels.
struct PathLight {
  enum class Source { kEnvironment, kLamp, kEmitter };
  color::Rgb rgb;
  Source source = Source::kEnvironment;
  int number = 0;  // of the lamp, or of the part that emits
};

// A surface on the way of a path.
struct Transport::Vertex {
  rays::Spot spot;
  PaintedPoint painted;
  double mirror_chance = 0;  // that the path goes on along the mirror direction
  BrightPlaces::Receiver receiver;
  double lobes_chance = 1;  // that it goes on by the lobes
  // True for a floor that shows the environment. Its unoccluded light is known, and paths add the changes by the mesh:
  // unoccluded rays add nothing.
  bool is_projected = false;
  color::Rgb open;        // unoccluded light of such a floor
  bool is_white = false;  // matt white, whatever its paint is

  Vertex(const Transport& transport, const rays::Spot& at, const rays::Float3& to_viewer)
      : Vertex(transport, at, transport.painted(at, to_viewer)) {}
  Vertex(const Transport& transport, const rays::Spot& at, const PaintedPoint& paint)
      : spot(at),
        painted(paint),
        receiver(transport.receiver(at, painted)),
        is_projected(transport.is_projected(at)),
        open(is_projected ? transport.open_ground(at) : color::Rgb{}) {
    const double mirror = painted.mirror_weight(), lobes = painted.lobes_weight();
    mirror_chance = mirror > 0 ? mirror / (mirror + lobes) : 0;
    lobes_chance = (1 - mirror_chance) * (1 - receiver.chance());
  }
  // Matt white.
  Vertex(const rays::Spot& at, const rays::Float3& to_viewer)
      : spot(at), painted((1 / rays::kFloatPi) * rays::Float3{1, 1, 1}, at.shading, to_viewer), is_white(true) {}
};

// Where a path goes on.
struct Transport::Next {
  rays::Float3 start, direction;
  // By the lobes, which are what finds light that was drawn for itself as well. 0: nowhere; infinite along the mirror
  // direction.
  double pdf = 0;
  rays::Hit hit;

  bool goes_on() const { return pdf > 0; }
  bool is_mirrored() const { return std::isinf(pdf); }
  // The weight of light that it found and that is drawn for itself with this density (the balance heuristic,
  // [Veach1995] 3.1).
  double share(double light_pdf) const { return is_mirrored() ? 1 : pdf / (pdf + light_pdf); }
};

// Light in three channels, by the scene's product of colors.
class Transport::Channels {
 public:
  static constexpr bool kWeighsLamps = false;
  explicit Channels(const color::ReflectionOperator* op) : path_(op) {}

  Reflection reflected(const Vertex& vertex, const rays::Float3& to_light) const { return vertex.painted.at(to_light); }
  void add_reflected(const Vertex& vertex, const Reflection& f, double scale, const PathLight& light) {
    PathProduct here = path_;
    lengthen(here, vertex, scale * rays::vec3(f.f_cos));
    sum_ += here.shown(light.rgb);
  }
  void add(double scale, const PathLight& light) { sum_ += scale * path_.shown(light.rgb); }
  void reflect(const Vertex& vertex, const Reflection& f, double scale) {
    lengthen(path_, vertex, scale * rays::vec3(f.f_cos));
  }
  void mirror(const Vertex& vertex, double scale) { path_.reflect(scale * rays::vec3(vertex.painted.mirror())); }
  void scale(double factor) { path_.scale(factor); }
  double size() const { return path_.size(); }
  void add_deeper(const color::Rgb& light) { deeper_ += path_.shown(light); }

  const color::Rgb& sum() const { return sum_; }
  const color::Rgb& deeper() const { return deeper_; }

 private:
  static void lengthen(PathProduct& path, const Vertex& vertex, const color::Rgb& paint) {
    if (vertex.is_projected) {
      path.reflect_plain(paint);
    } else {
      path.reflect(paint);
    }
  }
  PathProduct path_;
  color::Rgb sum_, deeper_;
};

// Light that is drawn at a vertex, weighed against the same light found by the next ray: together they count it once. A
// floor that shows the environment loses what is occluded.
template <class Carrier>
void Transport::add_direct(const Vertex& vertex, const std::array<double, 4>& numbers, double choice,
                           Carrier& carrier) const {
  const bool projected = vertex.is_projected;
  const double sign = projected ? -1 : 1;
  const rays::Float3& start = vertex.spot.start;
  if (!lights_.empty()) {
    const LampSample lamp = drawn_lamp(start, numbers[2], numbers[3]);
    const auto f = carrier.reflected(vertex, lamp.direction);
    if (f.pdf > 0 && rays_->occluded(start, lamp.direction, lamp.reach) == projected) {
      const double share = Carrier::kWeighsLamps ? 1 / (1 + lamp.extent_sr * vertex.lobes_chance * f.pdf) : 1;
      carrier.add_reflected(vertex, f, sign * share, {lamp.light, PathLight::Source::kLamp, lamp.number});
    }
  }
  if (environment_) {
    const LightSample light = environment_->drawn(numbers[0], numbers[1]);
    if (light.pdf > 0) {
      const auto f = carrier.reflected(vertex, light.direction);
      if (f.pdf > 0 && rays_->occluded(start, light.direction) == projected)
        carrier.add_reflected(vertex, f, sign / (light.pdf + vertex.lobes_chance * f.pdf), {light.radiance});
    }
  }
  if (emitters_.empty()) return;
  const EmitterSample light = emitters_.drawn(lit_point(vertex.spot), choice, numbers[2], numbers[3]);
  if (!(light.pdf > 0)) return;
  const auto f = carrier.reflected(vertex, light.direction);
  if (f.pdf > 0 && !rays_->occluded(start, light.direction, kShort * light.distance))
    carrier.add_reflected(vertex, f, 1 / (light.pdf + vertex.lobes_chance * f.pdf),
                          {light.radiance, PathLight::Source::kEmitter, light.part});
}

template <class Carrier>
Transport::Next Transport::next_ray(const Vertex& vertex, const std::array<double, 4>& numbers,
                                    Carrier& carrier) const {
  Next next;
  next.start = vertex.spot.start;
  if (numbers[0] < vertex.mirror_chance) {
    carrier.mirror(vertex, 1 / vertex.mirror_chance);
    next.direction = vertex.painted.mirrored();
    next.pdf = std::numeric_limits<double>::infinity();
    next.hit = rays_->closest(next.start, next.direction);
    return next;
  }
  if (!(vertex.painted.lobes_weight() > 0)) return next;
  const double others = 1 - vertex.mirror_chance;
  const Onward onward = this->onward(vertex.spot, vertex.receiver, vertex.painted,
                                     (numbers[0] - vertex.mirror_chance) / others, numbers[1], numbers[2]);
  if (!(onward.lobes_chance > 0)) return next;
  const auto f = carrier.reflected(vertex, onward.direction);
  if (!(f.pdf > 0)) return next;
  next.direction = onward.direction, next.hit = onward.hit;
  next.pdf = vertex.lobes_chance * f.pdf;
  carrier.reflect(vertex, f, 1 / (next.pdf + others * onward.places_pdf));
  return next;
}

// Lamps, the environment or an emitter that the next ray found.
template <class Carrier>
void Transport::add_found(const Vertex& vertex, const Next& next, Carrier& carrier) const {
  for (std::size_t i = 0; (next.is_mirrored() || Carrier::kWeighsLamps) && i < lights_.size(); ++i) {
    if (!(lights_[i].radius_rad > 0) || !lights_[i].mirrored) continue;
    const SeenLamp lamp = seen_lamp(i, next.start);
    if (!lamp.light.meets(rays::vec3(next.direction)) || (next.hit.any() && next.hit.distance < lamp.reach)) continue;
    carrier.add(next.share(1 / (static_cast<double>(lights_.size()) * lamp.extent_sr())),
                {lamp.light.radiance(), PathLight::Source::kLamp, static_cast<int>(i)});
  }
  const bool projected = vertex.is_projected;
  if (next.hit.any() == projected && environment_) {
    const LightSample light = environment_->at(next.direction);
    const color::Rgb radiance = next.is_mirrored() ? mirrored_environment(next.direction) : light.radiance;
    carrier.add((projected ? -1 : 1) * next.share(light.pdf), {radiance});
  }
  if (!next.hit.any()) return;
  const int part = rays_->part(next.hit.triangle);
  const color::Rgb& emission = emitters_.radiance(part);
  if (emission != color::Rgb{})
    carrier.add(next.share(emitters_.pdf(lit_point(vertex.spot), next.hit.triangle, next.direction, next.hit.distance)),
                {emission, PathLight::Source::kEmitter, part});
}

// The light that a surface gets from lamps, environment and emitters, and where the path goes on from there, by two
// sets of numbers.
template <class Carrier>
Transport::Next Transport::step(const Vertex& vertex, const std::array<double, 4>& to_light,
                                const std::array<double, 4>& onward, Carrier& carrier) const {
  add_direct(vertex, to_light, onward[3], carrier);
  const Next next = next_ray(vertex, onward, carrier);
  if (next.goes_on()) add_found(vertex, next, carrier);
  return next;
}

// Adds the light that one surface sends back: what it gets of lights and floors, and what up to `further` surfaces pass
// on to it.
template <class Carrier>
void Transport::send(const Vertex& vertex, int further, const Sequence& sequence, std::uint32_t index,
                     std::uint32_t set, Carrier& carrier) const {
  if (vertex.painted.black()) return;
  const Next next = step(vertex, sequence.point(index, set), sequence.point(index, set + 1), carrier);
  if (!next.goes_on() || !next.hit.any()) return;
  if (is_projected(next.hit)) {
    const FloorLight floor = off_floor(next.hit, next.start, next.direction, further, sequence, index, set + 2);
    carrier.add(1, {floor.fixed});
    carrier.add_deeper(floor.bounced);
  } else if (further > 0) {
    carrier.add_deeper(bounced(next.hit, next.start, next.direction, further, sequence, index, set + 2));
  }
}

// Adds the light that the surface at `hit` sends back along the ray, its own emission apart.
template <class Carrier>
void Transport::follow(rays::Hit hit, rays::Float3 origin, rays::Float3 direction, int bounces,
                       const Sequence& sequence, std::uint32_t index, std::uint32_t set, Carrier& carrier) const {
  // From the third surface on a path goes on by chance; so many surfaces later never with more than this chance, so
  // that paths end between walls that send back everything.
  constexpr int kRouletteFrom = 3, kEndlessFrom = 64, kMostBounces = 4096;
  constexpr double kEndlessChance = 0.9, kLeastChance = 0.05;
  const int most = std::min(bounces, kMostBounces);
  for (int bounce = 1, surfaces = 0;; ++bounce) {
    if (shaded_ != nullptr && is_projected(hit)) {
      carrier.add(1, {met_ground(hit, origin, direction, sequence.point(index, set)[0]).sum()});
      return;
    }
    const std::array<double, 4> to_light = sequence.point(index, set), onward = sequence.point(index, set + 1);
    if (environment_) environment_->fetch(to_light[0], to_light[1]);
    const Vertex vertex(*this, rays_->spot(hit, origin, direction), -direction);
    if (vertex.is_projected) {
      carrier.add(1, {vertex.open});
    } else if (++surfaces > most) {
      return;
    }
    if (vertex.painted.black()) return;
    set += 2;
    const Next next = step(vertex, to_light, onward, carrier);
    if (!next.goes_on() || !next.hit.any() || (surfaces == most && !is_projected(next.hit))) return;
    if (bounce >= kRouletteFrom) {
      const double most_chance = bounce >= kEndlessFrom ? kEndlessChance : 1;
      const double chance = std::clamp(carrier.size() * brightness(next.hit), kLeastChance, most_chance);
      if (sequence.point(index, set++)[0] >= chance) return;
      carrier.scale(1 / chance);
    }
    hit = next.hit, origin = next.start, direction = next.direction;
  }
}

}  // namespace goniochrome::render
