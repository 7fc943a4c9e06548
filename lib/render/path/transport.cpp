#include "render/path/transport.h"

#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "brdf/lobe_model.h"
#include "render/effects.h"
#include "render/surface_layer.h"

namespace goniochrome::render {

namespace {

using rays::Float3;
using rays::Hit;
using rays::Spot;

// A ray to a point of an emitter ends this part of the way short of it.
constexpr float kShort = 1 - 1e-4F;
constexpr float kInversePi = 1 / static_cast<float>(kPi);
// From the third surface on a path goes on by chance; so many surfaces later never with more than this chance, so that
// paths end between walls that send back everything.
constexpr int kRouletteFrom = 3, kEndlessFrom = 64, kMostBounces = 4096;
constexpr double kEndlessChance = 0.9, kLeastChance = 0.05;
// The most and least chance that a direction is drawn from the environment where there is one.
// Ground of a smaller extent is drawn as PointTransport::shown_over_ground() has it.
constexpr double kEvenGround_sr = 5;
constexpr float kLeastLightChance = 0.1F, kMostLightChance = 0.75F, kLeastWindowLightChance = 0.05F;

color::Rgb rgb(const Float3& c) {
  return rays::vec3(c);
}

// The tilts that draw each part's lobes, as render/reference.h has them for the truth.
std::vector<std::vector<brdf::Tilt>> tilts_for(const PathScene& scene) {
  Effects effects = effects_of(*scene.scene);
  effects.tilt_tolerance = scene.tilt_tolerance;
  if (!effects.anisotropy) return std::vector<std::vector<brdf::Tilt>>(scene.scene->paints.size());
  return tilts_of(*scene.scene, effects);
}

}  // namespace

Result<Transport> Transport::create(const PathScene& path_scene) {
  const Scene& scene = *path_scene.scene;
  if (scene.mesh == nullptr) return input_error("a scene without a mesh: there is nothing to trace");
  if (scene.paints.size() != scene.mesh->parts.size())
    return input_error("{} paints for {} parts of the mesh: each part needs one", scene.paints.size(),
                       scene.mesh->parts.size());
  const std::optional<Ground>& ground = path_scene.ground;
  std::shared_ptr<const rays::RayScene> rays = path_scene.rays;
  if (rays == nullptr) {
    std::optional<rays::Floor> floor;
    if (ground) floor = rays::Floor{ground->height};
    GONIO_ASSIGN(rays::RayScene made, rays::RayScene::create(*scene.mesh, floor));
    rays = std::make_shared<const rays::RayScene>(std::move(made));
  }
  Transport transport(std::move(rays));
  const mesh::Box box = bounding_box(*scene.mesh);
  transport.mesh_box_ = box;
  transport.mesh_radius_ = static_cast<float>(1.0001 * transport.rays_->scale() * length(0.5 * (box.high - box.low)));
  const auto tilts = tilts_for(path_scene);
  for (std::size_t part = 0; part < scene.paints.size(); ++part) {
    const double gloss_deg = part < scene.gloss_deg.size() ? scene.gloss_deg[part] : brdf::kGlossIncidence_deg;
    paint::LobeFit lobes = scene.paints[part];
    // A color map takes the place of the flakes' weights for all views.
    if (is_mapped(scene, part)) lobes.views.clear();
    auto paint = TracedPaint::create(lobes, gloss_deg, tilts[part]);
    if (!paint.ok()) return input_error("part {}: {}", scene.mesh->parts[part].name, paint.error().message);
    if (scene.layer != nullptr) paint->put_surface(*scene.layer, static_cast<int>(part));
    transport.paints_.push_back(*std::move(paint));
  }
  if (ground) {
    auto paint = TracedPaint::create(ground->paint, brdf::kGlossIncidence_deg, {});
    if (!paint.ok()) return input_error("floor: {}", paint.error().message);
    transport.paints_.push_back(*std::move(paint));
  }
  if (path_scene.environment != nullptr) {
    transport.environment_ = path_scene.table != nullptr
                                 ? path_scene.table
                                 : std::make_shared<const EnvironmentTable>(*path_scene.environment);
    if (transport.environment_->dark()) transport.environment_.reset();
    if (ground && ground->kind == Ground::Kind::kShadow) {
      GONIO_ASSIGN(transport.ground_, LaidGround::create(*ground, *path_scene.environment, scene.lights));
      transport.ground_eye_ = transport.rays_->local(ground->probe_eye);
      transport.uneven_ground_ = transport.ground_->ground_extent_sr() < kEvenGround_sr;
    }
  }
  GONIO_ASSIGN(transport.emitters_, Emitters::create(*transport.rays_, path_scene.emission));
  transport.lights_ = scene.lights;
  if (scene.reflection.k != color::component_wise().k) transport.reflection_ = &scene.reflection;
  return transport;
}

void Transport::shade_ground(GroundRequest request, int bounces) {
  if (!ground_) return;
  PathOptions options;
  options.bounces = bounces;
  if (bounces > 0)
    request.sent = [&](const Hit& hit, const Float3& from, const Float3& direction, const Sequence& sequence,
                       std::uint32_t index) { return bounced(hit, from, direction, options, sequence, index, 1); };
  shaded_ = std::make_shared<const ShadedGround>(rays_, *ground_, lights_, mesh_box_, mesh_radius_, request);
}

Float3 Transport::toward_ground(const Float3& from, const Float3& from_eye) const {
  const Float3 place = ground_eye_ + rays_->floor_distance(ground_eye_, from_eye) * from_eye;
  return rays::normalized(place - from);
}

// That of the environment's table where it was seen from, by the ratio of the solid angles of a piece of the floor.
double Transport::ground_pdf(const Float3& from, const Float3& direction) const {
  const float distance = rays_->floor_distance(from, direction);
  const Float3 seen = from + distance * direction - ground_eye_;
  const float eye_distance = rays::length(seen);
  if (!(distance > 0) || !(eye_distance > 0)) return 0;
  const Float3 from_eye = (1 / eye_distance) * seen;
  const double ratio = static_cast<double>(distance) / eye_distance;
  return environment_->at(from_eye).pdf * ratio * ratio * (from_eye.y / direction.y);
}

// Directions even by the cosine. Light from the ground counts by what the mesh leaves of it.
double Transport::open_share(const Spot& spot) const {
  constexpr std::uint32_t kDirections = 16;
  const Sequence sequence(0x09E4, kDirections);
  const rays::Frame frame = rays::frame_about(spot.shading);
  double open = 0;
  for (std::uint32_t first = 0; first < kDirections; first += kFan) {
    rays::Fan fan;
    fan.origin = spot.start;
    Float3 directions[kFan];
    for (std::uint32_t i = 0; i < kFan; ++i) {
      const std::array<double, 4> numbers = sequence.point(first + i, 0);
      const auto across = static_cast<float>(std::sqrt(numbers[0])),
                 phi = 2 * rays::kFloatPi * static_cast<float>(numbers[1]);
      directions[i] = (across * std::cos(phi)) * frame.x + (across * std::sin(phi)) * frame.y +
                      std::sqrt(1 - across * across) * spot.shading;
      fan.x[i] = directions[i].x, fan.y[i] = directions[i].y, fan.z[i] = directions[i].z;
    }
    fan.wanted = (1U << kFan) - 1;
    Hit hits[kFan];
    rays_->closest(fan, hits);
    for (std::uint32_t i = 0; i < kFan; ++i) {
      if (!hits[i].any()) {
        ++open;
      } else if (shaded_ != nullptr && is_laid(hits[i])) {
        const Float3 place = spot.start + hits[i].distance * directions[i];
        open += shaded_->met(place, 0.5).left.y;
      }
    }
  }
  return open / kDirections;
}

LightShares Transport::shaded_ground(const Spot& spot) const {
  if (spot.inside) return {};
  return shown_ground(spot, shaded_->seen(spot.position));
}

LightShares Transport::shown_ground(const Spot& spot, const GroundLight& light) const {
  const color::Rgb open = open_ground(spot);
  return {open * light.left, {}, open * light.bounced};
}

std::vector<int> Transport::gaining_parts() const {
  std::vector<int> parts;
  for (std::size_t part = 0; part < paints_.size(); ++part)
    if (paints_[part].gains_light()) parts.push_back(static_cast<int>(part));
  return parts;
}

// A surface on the way of a path.
struct Transport::Vertex {
  Spot spot;
  PaintedPoint painted;
  double mirror_chance;  // that the path goes on along the mirror direction
  // Whether it is a floor that shows the environment. What that shows in the open is known, and paths add what the mesh
  // changes: along rays that nothing blocks there is nothing to add.
  bool is_laid = false;
  color::Rgb open;  // what such a floor shows in the open

  Vertex(const Transport& transport, const Spot& at, const Float3& to_viewer)
      : spot(at),
        painted(transport.painted(at, to_viewer)),
        is_laid(transport.is_laid(at)),
        open(is_laid ? transport.open_ground(at) : color::Rgb{}) {
    const double mirror = painted.mirror_weight(), lobes = painted.lobes_weight();
    mirror_chance = mirror > 0 ? mirror / (mirror + lobes) : 0;
  }
};

bool Transport::is_laid(const Spot& spot) const {
  return ground_ && spot.triangle == rays::kFloor;
}

// From below the floor is black.
color::Rgb Transport::open_ground(const Spot& spot) const {
  return spot.inside ? color::Rgb{} : ground_->open_radiance(rays_->world(spot.position));
}

PaintedPoint Transport::painted(const Spot& spot, const Float3& to_viewer) const {
  if (is_laid(spot)) return {rays::float3(ground_->paint(open_ground(spot))), spot.shading, to_viewer};
  return {spot, paints_[static_cast<std::size_t>(spot.part)], to_viewer};
}

// Where a path goes on.
struct Transport::Next {
  Float3 start, direction;
  double pdf = 0;  // 0: nowhere; infinite along the mirror direction
  Hit hit;
};

Transport::SeenLamp Transport::seen_lamp(std::size_t lamp, const Float3& from) const {
  SeenLamp seen{lights_[lamp]};
  if (!seen.light.place) return seen;
  const Vec3 position = rays_->world(from);
  const double distance = length(seen.light.place->position - position);
  seen.light = light_at(seen.light, position), seen.is_placed = true;
  const double surface = distance * (1 - std::sin(seen.light.radius_rad));
  seen.reach = kShort * static_cast<float>(rays_->scale() * surface);
  return seen;
}

Transport::LampSample Transport::drawn_from(const SeenLamp& lamp, double u, double v) {
  const Light& light = lamp.light;
  const color::Rgb whole = kPi * light.white;
  if (!(light.radius_rad > 0)) return {rays::float3(light.direction), lamp.reach, whole};
  const double cos_half = std::cos(0.5 * light.radius_rad);
  // The solid angle by pi sin^2 of the radius is 1/cos^2 of half of it.
  return {rays::float3(disc_direction(light, u, v)), lamp.reach, (1 / (cos_half * cos_half)) * whole};
}

Transport::LampSample Transport::drawn_lamp(const Float3& from, double choice, double v) const {
  const auto count = static_cast<double>(lights_.size());
  const double at = choice * count;
  const std::size_t lamp = std::min(lights_.size() - 1, static_cast<std::size_t>(at));
  LampSample sample = drawn_from(seen_lamp(lamp, from), at - static_cast<double>(lamp), v);
  sample.light = count * sample.light;
  return sample;
}

color::Rgb Transport::mirrored_lamps(const Float3& from, const Float3& toward, const Hit& hit) const {
  color::Rgb sum;
  for (std::size_t i = 0; i < lights_.size(); ++i) {
    if (!(lights_[i].radius_rad > 0)) continue;
    const SeenLamp lamp = seen_lamp(i, from);
    if (lamp.light.meets(rays::vec3(toward)) && !(hit.any() && hit.distance < lamp.reach)) sum += lamp.light.radiance();
  }
  return sum;
}

// Light that is drawn at a vertex, weighed against the same light found by the next ray (the balance heuristic,
// [Veach1995] 3.1): together they count it once.
color::Rgb Transport::direct_light(const Vertex& vertex, const PathProduct& path, const std::array<double, 4>& numbers,
                                   double choice) const {
  color::Rgb sum;
  const auto add = [&](const Float3& f_cos, double scale, const color::Rgb& light) {
    PathProduct here = path;
    if (vertex.is_laid) {
      here.reflect_plain(scale * rgb(f_cos));
    } else {
      here.reflect(scale * rgb(f_cos));
    }
    sum += here.shown(light);
  };
  const bool laid = vertex.is_laid;
  const double sign = laid ? -1 : 1;
  const Float3& start = vertex.spot.start;
  if (!lights_.empty()) {
    const LampSample lamp = drawn_lamp(start, numbers[2], numbers[3]);
    const Reflection reflection = vertex.painted.at(lamp.direction);
    if (reflection.pdf > 0 && rays_->blocked(start, lamp.direction, lamp.reach) == laid)
      add(reflection.f_cos, sign, lamp.light);
  }
  if (environment_) {
    const LightSample light = environment_->drawn(numbers[0], numbers[1]);
    if (light.pdf > 0) {
      const Reflection reflection = vertex.painted.at(light.direction);
      if (reflection.pdf > 0 && rays_->blocked(start, light.direction) == laid)
        add(reflection.f_cos, sign / (light.pdf + (1 - vertex.mirror_chance) * reflection.pdf), light.radiance);
    }
  }
  if (!emitters_.empty()) {
    const EmitterSample light = emitters_.drawn(start, choice, numbers[2], numbers[3]);
    if (light.pdf > 0) {
      const Reflection reflection = vertex.painted.at(light.direction);
      if (reflection.pdf > 0 && !rays_->blocked(start, light.direction, kShort * light.distance))
        add(reflection.f_cos, 1 / (light.pdf + (1 - vertex.mirror_chance) * reflection.pdf), light.radiance);
    }
  }
  return sum;
}

Transport::Next Transport::next_ray(const Vertex& vertex, PathProduct& path,
                                    const std::array<double, 4>& numbers) const {
  Next next;
  next.start = vertex.spot.start;
  if (numbers[0] < vertex.mirror_chance) {
    path.reflect((1 / vertex.mirror_chance) * rgb(vertex.painted.mirror()));
    next.direction = vertex.painted.mirrored();
    next.pdf = std::numeric_limits<double>::infinity();
  } else {
    const double others = 1 - vertex.mirror_chance;
    const Reflection drawn = vertex.painted.drawn((numbers[0] - vertex.mirror_chance) / others, numbers[1], numbers[2]);
    if (!(drawn.pdf > 0)) return next;
    next.direction = drawn.direction;
    next.pdf = others * drawn.pdf;
    if (vertex.is_laid) {
      path.reflect_plain((1 / next.pdf) * rgb(drawn.f_cos));
    } else {
      path.reflect((1 / next.pdf) * rgb(drawn.f_cos));
    }
  }
  next.hit = rays_->closest(vertex.spot.start, next.direction);
  return next;
}

// The environment or an emitter that the next ray found.
color::Rgb Transport::light_at_end(const Next& next, const PathProduct& path, bool laid) const {
  const auto share = [&](double light_pdf) { return std::isinf(next.pdf) ? 1 : next.pdf / (next.pdf + light_pdf); };
  color::Rgb sum;
  if (std::isinf(next.pdf) && !lights_.empty()) sum += path.shown(mirrored_lamps(next.start, next.direction, next.hit));
  if (next.hit.any() == laid && environment_) {
    const LightSample light = environment_->at(next.direction);
    sum += (laid ? -1 : 1) * share(light.pdf) * path.shown(light.radiance);
  }
  if (!next.hit.any()) return sum;
  const color::Rgb& emission = emitters_.radiance(rays_->part(next.hit.triangle));
  if (emission == color::Rgb{}) return sum;
  return sum + share(emitters_.pdf(next.hit.triangle, next.direction, next.hit.distance)) * path.shown(emission);
}

// What the surface at `hit` sends back along the ray, its own emission apart.
color::Rgb Transport::bounced(Hit hit, Float3 origin, Float3 direction, const PathOptions& options,
                              const Sequence& sequence, std::uint32_t index, std::uint32_t set) const {
  PathProduct path(reflection_);
  color::Rgb sum;
  const int most = std::min(options.bounces, kMostBounces);
  for (int bounce = 1, surfaces = 0;; ++bounce) {
    const Vertex vertex(*this, rays_->spot(hit, origin, direction), -direction);
    if (vertex.is_laid) {
      if (shaded_ != nullptr) {
        if (vertex.spot.inside) break;
        const double number = sequence.point(index, set)[0];
        return sum + path.shown(shown_ground(vertex.spot, shaded_->met(vertex.spot.position, number)).sum());
      }
      sum += path.shown(vertex.open);
    } else if (++surfaces > most) {
      break;
    }
    if (vertex.painted.black()) break;
    const std::array<double, 4> to_light = sequence.point(index, set++), onward = sequence.point(index, set++);
    sum += direct_light(vertex, path, to_light, onward[3]);
    const Next next = next_ray(vertex, path, onward);
    if (!(next.pdf > 0)) break;
    sum += light_at_end(next, path, vertex.is_laid);
    if (!next.hit.any() || (surfaces == most && !is_laid(next.hit))) break;
    if (bounce >= kRouletteFrom) {
      const double most_chance = bounce >= kEndlessFrom ? kEndlessChance : 1;
      const double chance = std::clamp(path.size(), kLeastChance, most_chance);
      if (sequence.point(index, set++)[0] >= chance) break;
      path.scale(1 / chance);
    }
    hit = next.hit, origin = vertex.spot.start, direction = next.direction;
  }
  return sum;
}

// As bounced() at a vertex on such a floor.
Transport::FloorLight Transport::off_floor(const Hit& hit, const Float3& origin, const Float3& direction, int bounces,
                                           const Sequence& sequence, std::uint32_t index, std::uint32_t set) const {
  const Spot spot = rays_->spot(hit, origin, direction);
  if (shaded_ != nullptr) {
    if (spot.inside) return {};
    const LightShares shown = shown_ground(spot, shaded_->met(spot.position, sequence.point(index, set)[0]));
    return {shown.direct, bounces > 0 ? shown.into_diffuse : color::Rgb{}};
  }
  const Vertex vertex(*this, spot, -direction);
  FloorLight light{vertex.open, {}};
  if (vertex.painted.black()) return light;
  PathProduct path(reflection_);
  const std::array<double, 4> to_light = sequence.point(index, set), onward = sequence.point(index, set + 1);
  light.fixed += direct_light(vertex, path, to_light, onward[3]);
  const Next next = next_ray(vertex, path, onward);
  if (!(next.pdf > 0)) return light;
  light.fixed += light_at_end(next, path, true);
  if (!next.hit.any() || bounces == 0) return light;
  PathOptions further;
  further.bounces = bounces;
  light.bounced = path.shown(bounced(next.hit, vertex.spot.start, next.direction, further, sequence, index, set + 2));
  return light;
}

// A direction at the visible point.
struct PointTransport::Ray {
  Float3 direction;
  bool above = false;
  std::optional<EnvironmentTable::Place> place;  // where the direction was drawn from the environment
  LaidGround::BrightSample bright;               // with a density above 0 where it was drawn from the brightest texels
  bool to_ground = false;                        // whether it goes to where the floor shows that place
  double weight = 1;                             // of the sample in the mean
};

PointTransport::PointTransport(const Transport& transport, const PathOptions& options, const Spot& spot,
                               const Float3& to_viewer)
    : transport_(transport),
      options_(options),
      spot_(spot),
      to_viewer_(to_viewer),
      painted_(options.white ? PaintedPoint(Float3{kInversePi, kInversePi, kInversePi}, spot.shading, to_viewer)
                             : transport.painted(spot, to_viewer)),
      is_laid_(transport.is_laid(spot)),
      correction_(options.correction || is_laid_),
      over_ground_(!is_laid_ && transport.shaded_ != nullptr && transport.environment_ != nullptr) {
  sure_ = is_laid_ ? transport.open_ground(spot) : transport.emitters_.radiance(spot.part);
  if (is_laid_) {
    narrow_to_mesh();
    window_ = transport.ground_->window(transport.rays_->world(spot.position), transport.mesh_box_);
    // Under the mesh most light is blocked: what is left of it is summed, instead of taken from that of the open floor.
    if (window_->half_width_rad >= kPi) correction_ = false, sure_ = {};
    // The environment's own table draws a sun within its texel, but most other directions in vain.
    if (transport.environment_)
      light_chance_ = std::clamp(kMostLightChance * static_cast<float>(transport.ground_->light_share(*window_)),
                                 kLeastWindowLightChance, kMostLightChance);
  } else if (transport.environment_) {
    const float wide = 1 - painted_.narrow_share(transport.environment_->extent_sr());
    light_chance_ = std::clamp(kMostLightChance * wide, kLeastLightChance, kMostLightChance);
  }
  open_ = !transport.rays_->has_floor() && !transport.rays_->any_above(spot.start, spot.shading, 0);
  const bool free = open_ && options.correction;
  if (!free) {
    add_lights();
  }
  if (!free) add_mirror();
  certain_ = free || (!(painted_.lobes_weight() > 0) && mirror_samples_ == 0 && lamps_.empty());
}

color::Rgb PointTransport::reflect(const Float3& f, const color::Rgb& light) const {
  return transport_.reflection_ != nullptr && !is_laid_ ? color::reflected(*transport_.reflection_, rgb(f), light)
                                                        : rgb(f) * light;
}

// The cone from the point about the sphere that holds the mesh, whose middle is the origin of local coordinates.
void PointTransport::narrow_to_mesh() {
  const float distance = rays::length(spot_.start), sine = transport_.mesh_radius_ / distance;
  if (!(sine < 1)) return;
  mesh_axis_ = (-1 / distance) * spot_.start;
  mesh_cosine_ = std::sqrt(1 - sine * sine) - 1e-6F;
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
      const bool blocked = transport_.rays_->blocked(spot_.start, direction, lamp.reach);
      if (blocked == correction_) sure_ += (blocked ? -kPi : kPi) * reflect(reflection.f_cos, light.white);
      continue;
    }
    const double sine = rays::dot(spot_.shading, rays::float3(light.direction));
    if (sine <= -std::sin(light.radius_rad)) continue;
    const color::Rgb whole = reflect(painted_.toward_disc(light, !lamp.is_placed), kPi * light.white);
    constexpr std::uint32_t kProbes = 16;
    std::uint32_t blocked = 0, above = 0;
    const Sequence sequence(mixed(0x1A3B, i), kProbes);
    for (std::uint32_t k = 0; k < kProbes && !open_; ++k) {
      const std::array<double, 4> numbers = sequence.point(k, 0);
      const Transport::LampSample sample = Transport::drawn_from(lamp, numbers[0], numbers[1]);
      if (!(rays::dot(sample.direction, spot_.shading) > 0)) continue;
      ++above;
      if (transport_.rays_->blocked(spot_.start, sample.direction, sample.reach)) ++blocked;
    }
    const bool hidden = 2 * blocked <= above;
    if (hidden != correction_) sure_ += (correction_ ? -1.0 : 1.0) * whole;
    if (!open_) lamps_.push_back({lamp, hidden});
  }
}

// What lamps that are discs add to sure(), as the mean over samples.
color::Rgb PointTransport::lamp_shadows(const Sequence& sequence, std::uint32_t begin, std::uint32_t count,
                                        bool* any_blocked) const {
  constexpr std::uint32_t kSet = 60;  // that nothing else draws from
  color::Rgb sum;
  for (std::size_t k = 0; k < lamps_.size(); ++k) {
    const Lamp& lamp = lamps_[k];
    for (std::uint32_t i = begin; i < begin + count; ++i) {
      const std::array<double, 4> numbers = sequence.point(i, kSet + static_cast<std::uint32_t>(k));
      const Transport::LampSample sample = Transport::drawn_from(lamp.seen, numbers[0], numbers[1]);
      const Reflection reflection = painted_.at(sample.direction);
      if (!(reflection.pdf > 0)) continue;
      const bool blocked = transport_.rays_->blocked(spot_.start, sample.direction, sample.reach);
      if (any_blocked != nullptr && blocked) *any_blocked = true;
      if (blocked == lamp.hidden) sum += (blocked ? -1.0 : 1.0) * reflect(reflection.f_cos, sample.light);
    }
  }
  return sum;
}

void PointTransport::add_mirror() {
  const Float3& mirror = painted_.mirror();
  const float weight = painted_.mirror_weight();
  if (!(weight > 0)) return;
  mirror_hit_ = transport_.rays_->closest(spot_.start, painted_.mirrored());
  const color::Rgb open =
      transport_.environment_ ? transport_.environment_->radiance(painted_.mirrored()) : color::Rgb{};
  if (!transport_.lights_.empty()) {
    color::Rgb lamps = transport_.mirrored_lamps(spot_.start, painted_.mirrored(), mirror_hit_);
    if (correction_) lamps += -1.0 * transport_.mirrored_lamps(spot_.start, painted_.mirrored(), {});
    sure_ += reflect(mirror, lamps);
  }
  if (!mirror_hit_.any()) {
    if (!correction_) sure_ += reflect(mirror, open);
    return;
  }
  if (correction_) sure_ += -1.0 * reflect(mirror, open);
  sure_ += reflect(mirror, transport_.emitters_.radiance(transport_.rays_->part(mirror_hit_.triangle)));
  if ((options_.bounces == 0 || !options_.into_lobes) && !transport_.is_laid(mirror_hit_)) return;
  const double share = weight / (weight + painted_.lobes_weight());
  mirror_samples_ = static_cast<std::uint32_t>(std::clamp(static_cast<int>(std::lround(kBatch * share)), 1, kBatch));
}

// Of a direction that is not drawn from the environment.
double PointTransport::drawn_pdf(const Float3& direction, const Reflection& reflection) const {
  return window_ ? transport_.ground_->density(*window_, rays::vec3(direction)) : reflection.pdf;
}

PointTransport::Ray PointTransport::drawn_ray(const std::array<double, 4>& numbers, std::uint32_t of_fan) const {
  Ray ray;
  if (window_ && transport_.ground_->has_bright()) {
    // So many rays of a fan go there, and the others look past them.
    constexpr std::uint32_t kBright = 2;
    ray.weight = static_cast<double>(kFan) / (of_fan < kBright ? kBright : kFan - kBright);
    if (of_fan < kBright) {
      ray.bright = transport_.ground_->drawn_bright(numbers[1], numbers[2], numbers[3]);
      ray.direction = rays::float3(ray.bright.direction);
      ray.above = ray.bright.pdf > 0 && rays::dot(ray.direction, spot_.shading) > 0;
      return ray;
    }
  }
  if (numbers[0] < light_chance_) {
    ray.place = transport_.environment_->place(numbers[1], numbers[2]);
    if (!(ray.place->density > 0)) return ray;
    ray.direction = ray.place->direction;
    if (over_ground_ && transport_.uneven_ground_ && ray.direction.y < 0) {
      ray.to_ground = true;
      ray.direction = transport_.toward_ground(spot_.start, ray.direction);
    }
  } else {
    const double choice = (numbers[0] - light_chance_) / (1 - light_chance_);
    ray.direction = window_ ? rays::float3(transport_.ground_->drawn(*window_, choice, numbers[1], numbers[2]))
                            : painted_.direction(choice, numbers[1], numbers[2]);
  }
  ray.above = rays::dot(ray.direction, spot_.shading) > 0;
  return ray;
}

// What a drawn direction is worth. One set of directions serves every lobe and the environment: each is weighed by the
// density that the mixture gives it, which is the balance heuristic.
LightShares PointTransport::shown(const Ray& ray, bool blocked, const Sequence& sequence, std::uint32_t index) const {
  const Reflection reflection = painted_.at(ray.direction);
  LightSample light;
  if (!(reflection.pdf > 0)) return {};
  if (ray.place) {
    light = transport_.environment_->light(*ray.place);
  } else if (transport_.environment_) {
    light = transport_.environment_->at(ray.direction);
  }
  double pdf = light_chance_ * light.pdf + (1 - light_chance_) * drawn_pdf(ray.direction, reflection);
  if (ray.bright.pdf > 0) {
    pdf = ray.bright.pdf, light.radiance = ray.bright.radiance;
  } else if (window_ && transport_.ground_->is_bright(rays::vec3(ray.direction))) {
    return {};
  }
  if (!(pdf > 0)) return {};
  const auto scaled = static_cast<float>(1 / pdf);
  if (!blocked) return {reflect(scaled * reflection.f_cos, light.radiance), {}, {}};

  color::Rgb arriving = correction_ ? -1.0 * light.radiance : color::Rgb{}, sent;
  LightShares shares;
  if (options_.bounces > 0 || !transport_.emitters_.empty() || transport_.ground_) {
    const Hit hit = transport_.rays_->closest(spot_.start, ray.direction);
    if (transport_.is_laid(hit)) {
      const Transport::FloorLight floor =
          transport_.off_floor(hit, spot_.start, ray.direction, options_.bounces, sequence, index, 4);
      arriving += floor.fixed, sent = floor.bounced;
    } else if (hit.any()) {
      const color::Rgb& emission = transport_.emitters_.radiance(transport_.rays_->part(hit.triangle));
      if (emission != color::Rgb{})
        arriving += pdf / (pdf + transport_.emitters_.pdf(hit.triangle, ray.direction, hit.distance)) * emission;
      if (options_.bounces > 0 && (options_.into_lobes || options_.into_diffuse))
        sent = transport_.bounced(hit, spot_.start, ray.direction, options_, sequence, index, 4);
    }
  }
  add_sent(ray.direction, sent, scaled, shares);
  shares.direct = reflect(scaled * reflection.f_cos, arriving);
  return shares;
}

// A floor that shows the environment hides what is below the horizon, and shows the same light from elsewhere. Both are
// drawn together: a direction that is drawn from the environment below the horizon is what is hidden, and the way to
// the place of the floor that shows it is what is seen instead. Light by density is the same for both, so that the
// brightest texels add no more noise than others.
LightShares PointTransport::shown_over_ground(const Ray& ray, const Hit& hit, const Sequence& sequence,
                                              std::uint32_t index) const {
  LightShares shares;
  const bool blocked = hit.any();
  const auto light_from = [&](const Float3& direction) {
    return ray.place ? transport_.environment_->light(*ray.place) : transport_.environment_->at(direction);
  };
  const auto scale = [&](double light_pdf, const Reflection& reflection) {
    return static_cast<float>(1 / (light_chance_ * light_pdf + (1 - light_chance_) * reflection.pdf));
  };
  const Float3& hidden = ray.to_ground ? ray.place->direction : ray.direction;
  if (correction_ && hidden.y < 0) {
    const Reflection reflection = painted_.at(hidden);
    if (reflection.pdf > 0) {
      const LightSample light = light_from(hidden);
      shares.direct = -1.0 * reflect(scale(light.pdf, reflection) * reflection.f_cos, light.radiance);
    }
  }
  if (!ray.above || (!blocked && correction_)) return shares;
  const Reflection reflection = painted_.at(ray.direction);
  if (!(reflection.pdf > 0)) return shares;
  color::Rgb arriving, sent;
  double light_pdf = 0;
  if (ray.direction.y < 0 && transport_.uneven_ground_) {
    light_pdf = transport_.ground_pdf(spot_.start, ray.direction);
  } else if (ray.direction.y < 0) {
    light_pdf = light_from(ray.direction).pdf;
  } else {
    const LightSample light = light_from(ray.direction);
    light_pdf = light.pdf;
    if (blocked == correction_) arriving = (blocked ? -1.0 : 1.0) * light.radiance;
  }
  const float scaled = scale(light_pdf, reflection);
  if (transport_.is_laid(hit)) {
    const Transport::FloorLight floor =
        transport_.off_floor(hit, spot_.start, ray.direction, options_.bounces, sequence, index, 4);
    arriving += floor.fixed, sent = floor.bounced;
  } else if (blocked && options_.bounces > 0 && (options_.into_lobes || options_.into_diffuse)) {
    sent = transport_.bounced(hit, spot_.start, ray.direction, options_, sequence, index, 4);
  }
  shares.direct += reflect(scaled * reflection.f_cos, arriving);
  add_sent(ray.direction, sent, scaled, shares);
  return shares;
}

// What surfaces send along a direction, times `scale`: one over the density of the direction.
void PointTransport::add_sent(const Float3& direction, const color::Rgb& sent, float scale, LightShares& shares) const {
  if (sent == color::Rgb{}) return;
  const PaintedPoint::Parts parts = painted_.parts(direction);
  if (options_.into_lobes) shares.into_lobes = reflect(scale * parts.lobes, sent);
  if (options_.into_diffuse) shares.into_diffuse = reflect(scale * parts.diffuse, sent);
}

color::Rgb PointTransport::emitter_sample(const std::array<double, 4>& numbers) const {
  const EmitterSample light = transport_.emitters_.drawn(spot_.start, numbers[0], numbers[1], numbers[2]);
  if (!(light.pdf > 0)) return {};
  const Reflection reflection = painted_.at(light.direction);
  if (!(reflection.pdf > 0) || transport_.rays_->blocked(spot_.start, light.direction, kShort * light.distance))
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
    if (transport_.is_laid(mirror_hit_)) {
      const Transport::FloorLight floor =
          transport_.off_floor(mirror_hit_, spot_.start, painted_.mirrored(), options_.bounces, sequence, i, 4);
      fixed += floor.fixed, sent += floor.bounced;
    } else {
      sent += transport_.bounced(mirror_hit_, spot_.start, painted_.mirrored(), options_, sequence, i, 4);
    }
  }
  LightShares shares;
  shares.direct = reflect(painted_.mirror(), fixed);
  if (options_.into_lobes) shares.into_lobes = reflect(painted_.mirror(), sent);
  return shares;
}

LightShares PointTransport::batch_shares(std::uint64_t seed, std::uint32_t begin, std::uint32_t count,
                                         bool* any_blocked) const {
  if (any_blocked != nullptr) *any_blocked = mirror_samples_ > 0;
  if (certain_) return {};
  const Sequence sequence(seed, kBatch);
  LightShares sum;
  sum.direct += lamp_shadows(sequence, begin, count, any_blocked);
  if (painted_.lobes_weight() > 0) {
    for (std::uint32_t first = begin; first < begin + count; first += kFan) {
      Ray rays[kFan];
      rays::Fan fan;
      fan.origin = spot_.start;
      for (std::uint32_t i = 0; i < 8; ++i) {
        rays[i] = drawn_ray(sequence.point(first + i, 0), i);
        fan.x[i] = rays[i].direction.x, fan.y[i] = rays[i].direction.y, fan.z[i] = rays[i].direction.z;
        if (rays[i].above && rays::dot(rays[i].direction, mesh_axis_) >= mesh_cosine_) fan.wanted |= 1U << i;
      }
      if (over_ground_) {
        Hit hits[kFan];
        if (fan.wanted != 0) transport_.rays_->closest(fan, hits);
        for (std::uint32_t i = 0; i < kFan; ++i) {
          if (any_blocked != nullptr && hits[i].any()) *any_blocked = true;
          sum += shown_over_ground(rays[i], hits[i], sequence, first + i);
        }
        continue;
      }
      const unsigned blocked = fan.wanted != 0 ? transport_.rays_->blocked(fan) : 0;
      if (any_blocked != nullptr && blocked != 0) *any_blocked = true;
      for (std::uint32_t i = 0; i < 8; ++i) {
        const bool is_blocked = (blocked >> i & 1U) != 0;
        if (!rays[i].above || (!is_blocked && (correction_ || !transport_.environment_))) continue;
        if (rays[i].weight == 1) {
          sum += shown(rays[i], is_blocked, sequence, first + i);
        } else {
          sum += rays[i].weight * shown(rays[i], is_blocked, sequence, first + i);
        }
      }
    }
    if (!transport_.emitters_.empty())
      for (std::uint32_t i = begin; i < begin + count; ++i) sum.direct += emitter_sample(sequence.point(i, 1));
  }
  const std::uint32_t mirrors = mirror_samples_ > 0 ? std::max(1U, mirror_samples_ * count / kBatch) : 0;
  if (mirrors > 0)
    sum += static_cast<double>(count) / mirrors * mirrored(Sequence(mixed(seed, 0x4D), kBatch), begin, mirrors);
  return (1.0 / count) * sum;
}

}  // namespace goniochrome::render
