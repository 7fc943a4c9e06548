#include "render/path/transport.h"

#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "base/clock.h"
#include "brdf/lobe_model.h"
#include "render/effects.h"
#include "render/internal/wear.h"
#include "render/panes.h"
#include "render/scene_effects.h"
#include "render/surface_layer.h"

namespace goniochrome::render {

namespace {

using rays::Float3;
using rays::Hit;
using rays::Spot;

// The tilts that draw each part's lobes, as render/reference.h has them for the truth.
std::vector<std::vector<brdf::Tilt>> tilts_for(const PathScene& scene) {
  Effects effects = effects_of(*scene.scene);
  effects.tilt_tolerance = scene.tilt_tolerance;
  if (!effects.anisotropy) return std::vector<std::vector<brdf::Tilt>>(scene.scene->paints.size());
  return tilts_of(*scene.scene, effects);
}

}  // namespace

Result<Transport> Transport::in_channels(const PathScene& path_scene) {
  const Scene& scene = *path_scene.scene;
  if (scene.paints.size() != scene.mesh->parts.size())
    return input_error("{} paints for {} parts of the mesh: each part needs one", scene.paints.size(),
                       scene.mesh->parts.size());
  const std::optional<Ground>& ground = path_scene.ground;
  std::optional<rays::Floor> floor;
  if (ground) floor = rays::Floor{ground->height};
  std::shared_ptr<const rays::RayScene> rays = path_scene.rays, eye = path_scene.eye;
  if (rays == nullptr) {
    GONIO_ASSIGN(rays::RayScene made, rays::RayScene::create(*scene.mesh, floor, scene.panes));
    rays = std::make_shared<const rays::RayScene>(std::move(made));
  }
  if (has_panes(scene) && eye == nullptr) {
    GONIO_ASSIGN(rays::RayScene made, rays::RayScene::create(*scene.mesh, floor));
    eye = std::make_shared<const rays::RayScene>(std::move(made));
  }
  Transport transport(std::move(rays));
  if (has_panes(scene)) {
    transport.eye_ = std::move(eye);
    for (std::size_t part = 0; part < scene.mesh->parts.size(); ++part)
      transport.panes_.push_back(is_pane(scene, part));
  }
  const mesh::Box box = bounding_box(*scene.mesh);
  transport.mesh_box_ = box;
  transport.mesh_radius_ = static_cast<float>(1.0001 * transport.rays_->scale() * length(0.5 * box.size()));
  const auto tilts = tilts_for(path_scene);
  for (std::size_t part = 0; part < scene.paints.size(); ++part) {
    const double gloss_deg = gloss_deg_of(scene, part);
    // A color map takes the place of diffuse and flake weights at all views; the gloss of each view stays.
    auto paint = TracedPaint::create(scene.paints[part], gloss_deg, tilts[part]);
    if (!paint.ok()) return input_error("part {}: {}", scene.mesh->parts[part].name, paint.error().message);
    if (scene.layer != nullptr) paint->put_surface(*scene.layer, static_cast<int>(part));
    if (path_scene.rough_coats) paint->put_coat(scene.paints[part], gloss_deg);
    transport.paints_.push_back(*std::move(paint));
  }
  if (ground) {
    auto paint = TracedPaint::create(ground->paint, brdf::kGlossIncidence_deg, {});
    if (!paint.ok()) return input_error("floor: {}", paint.error().message);
    if (path_scene.rough_coats) paint->put_coat(ground->paint, brdf::kGlossIncidence_deg);
    transport.paints_.push_back(*std::move(paint));
  }
  if (path_scene.environment != nullptr) {
    transport.environment_ = path_scene.table != nullptr
                                 ? path_scene.table
                                 : std::make_shared<const EnvironmentTable>(*path_scene.environment);
    if (transport.environment_->dark()) transport.environment_.reset();
    transport.mirrored_ = path_scene.mirrored != nullptr ? path_scene.mirrored : path_scene.environment;
    if (ground && ground->kind == Ground::Kind::kShadow) {
      GONIO_ASSIGN(transport.ground_, ProjectedGround::create(*ground, *path_scene.environment, scene.lights));
      transport.ground_eye_ = transport.rays_->local(ground->probe_eye);
    }
  }
  GONIO_ASSIGN(transport.emitters_, Emitters::create(*transport.rays_, path_scene.emission));
  transport.lights_ = scene.lights;
  if (scene.reflection.k != color::component_wise().k) transport.reflection_ = &scene.reflection;
  return transport;
}

double Transport::clear_share(const Float3& from, const Float3& direction) const {
  double share = 1;
  Hit hit = eye().closest(from, direction);
  while (meets_pane(hit) && share > kLeastPassed) {
    const PassedPane passed = through_pane(eye(), eye().spot(hit, from, direction), direction);
    share *= passed.passed, hit = passed.hit;
  }
  return hit.any() ? 0 : share;
}

std::shared_ptr<const BrightPlaces> Transport::find_bright_places(int bounces, std::uint64_t seed) const {
  if (emitters_.empty() || bounces == 0) return nullptr;
  Transport by_lobes = *this;
  by_lobes.draw_toward(nullptr);
  const auto sent = [&](const Hit& hit, const Float3& direction, const Sequence& sequence, std::uint32_t index) {
    return color::mean(by_lobes.bounced(hit, {}, direction, bounces, sequence, index, 2));
  };
  return BrightPlaces::find(*rays_, emitters_, sent, seed);
}

void Transport::shade_ground(GroundRequest request, int bounces) {
  if (!ground_) return;
  if (bounces > 0)
    request.sent = [&](const Hit& hit, const Float3& from, const Float3& direction, const Sequence& sequence,
                       std::uint32_t index) { return bounced(hit, from, direction, bounces, sequence, index, 1); };
  const int most = request.directions;
  if (request.longest_s > 0) request.directions = std::min(most, kFewestGroundDirections);
  request.bounced_directions /= most / request.directions;
  for (const Deadline deadline(request.longest_s);; request.directions *= 2, request.bounced_directions *= 2) {
    const Stopwatch clock;
    shaded_ = std::make_shared<const ShadedGround>(rays_, *ground_, lights_, mesh_box_, mesh_radius_, request);
    constexpr double kTwice = 3;  // times as long take twice the directions, which divide more cells
    if (request.directions >= most || kTwice * clock.elapsed_s() > deadline.left_s()) break;
  }
  if (!environment_) return;
  open_floor_ = std::make_shared<const OpenFloor>(
      *rays_, ground_eye_, [&](const Float3& direction) { return environment_->at(direction).radiance; },
      [&](const Float3& direction) { return ground_->seen(rays::vec3(direction)); },
      [&](const Float3& place) {
        const GroundLight light = shaded_->seen(place);
        return light.left + light.bounced;
      });
}

LightShares Transport::shaded_ground(const Spot& spot) const {
  if (spot.inside) return {};
  return shown_ground(spot, shaded_->seen(spot.position));
}

LightShares Transport::shown_ground(const Spot& spot, const GroundLight& light) const {
  const color::Rgb open = open_ground(spot);
  return {open * light.left, {}, open * light.bounced};
}

std::optional<LightShares> Transport::seen_floor(const Hit& hit, const Float3& origin, const Float3& direction) const {
  if (shaded_ == nullptr || !is_projected(hit)) return std::nullopt;
  return shaded_ground(rays_->spot(hit, origin, direction));
}

GroundReceiver ground_receiver(const Spot& spot, const PaintedPoint& painted) {
  return {spot.start, painted.normal(), painted.to_viewer(), painted.mirrored(),
          static_cast<float>(painted.coat_index())};
}

LightShares Transport::met_ground(const Hit& hit, const Float3& origin, const Float3& direction, double number) const {
  const Spot spot = rays_->spot(hit, origin, direction);
  return spot.inside ? LightShares{} : shown_ground(spot, shaded_->met(spot.position, number));
}

bool Transport::is_projected(const Spot& spot) const {
  return ground_ && spot.triangle == rays::kFloor;
}

// From below the floor is black.
color::Rgb Transport::open_ground(const Spot& spot) const {
  return spot.inside ? color::Rgb{} : ground_->open_radiance(rays_->world(spot.position));
}

PaintedPoint Transport::painted(const Spot& spot, const Float3& to_viewer) const {
  if (is_projected(spot)) return {rays::float3(ground_->paint(open_ground(spot))), spot.shading, to_viewer};
  return {spot, paints_[static_cast<std::size_t>(spot.part)], to_viewer};
}

Transport::SeenLamp::SeenLamp(const Light& of) : light(of) {
  const double half = std::sin(0.5 * light.radius_rad);
  versine = 2 * half * half;
}

Transport::SeenLamp Transport::seen_lamp(std::size_t lamp, const Float3& from) const {
  if (!lights_[lamp].place) return SeenLamp(lights_[lamp]);
  const Vec3 position = rays_->world(from);
  const double distance = length(lights_[lamp].place->position - position);
  SeenLamp seen(light_at(lights_[lamp], position));
  seen.is_placed = true;
  const double surface = distance * (1 - std::sin(seen.light.radius_rad));
  seen.reach = kShort * static_cast<float>(rays_->scale() * surface);
  return seen;
}

// Its middle is the origin of local coordinates.
std::optional<Transport::SeenLamp> Transport::mesh_disc(const Spot& spot) const {
  const float distance = rays::length(spot.start), sine = mesh_radius_ / distance;
  if (!(sine < 1)) return {};
  return SeenLamp({rays::vec3((-1 / distance) * spot.start), {}, std::asin(static_cast<double>(sine)) + 1e-6});
}

bool Transport::is_under_mesh(const Spot& spot) const {
  const Vec3 at = rays_->world(spot.position);
  const mesh::Box& box = mesh_box_;
  return at.x >= box.low.x && at.x <= box.high.x && at.z >= box.low.z && at.z <= box.high.z && at.y < box.high.y;
}

// The solid angle by pi sin^2 of the radius, which is 1/cos^2 of half of it.
Transport::LampSample Transport::drawn_from(const SeenLamp& lamp, double u, double v) {
  const Light& light = lamp.light;
  const color::Rgb whole = kPi * light.white;
  if (!(light.radius_rad > 0)) return {rays::float3(light.direction), lamp.reach, whole, 0, 0};
  const Float3 middle = rays::float3(light.direction);
  const rays::Frame frame = rays::frame_about(middle);
  const auto versine = static_cast<float>(lamp.versine * u), phi = 2 * rays::kFloatPi * static_cast<float>(v);
  const float ring = std::sqrt(versine * (2 - versine));
  const Float3 direction = (1 - versine) * middle + (ring * std::cos(phi)) * frame.x + (ring * std::sin(phi)) * frame.y;
  return {direction, lamp.reach, (2 / (2 - lamp.versine)) * whole, 0, lamp.extent_sr()};
}

Transport::LampSample Transport::drawn_lamp(const Float3& from, double choice, double v) const {
  const auto count = static_cast<double>(lights_.size());
  const double at = choice * count;
  const std::size_t lamp = std::min(lights_.size() - 1, static_cast<std::size_t>(at));
  LampSample sample = drawn_from(seen_lamp(lamp, from), at - static_cast<double>(lamp), v);
  sample.light = count * sample.light, sample.extent_sr *= count, sample.number = static_cast<int>(lamp);
  return sample;
}

color::Rgb Transport::mirrored_environment(const Float3& direction) const {
  return mirrored_->blended(rays::vec3(direction));
}

color::Rgb Transport::mirrored_lamps(const Float3& from, const Float3& toward, const Hit& hit) const {
  color::Rgb sum;
  for (std::size_t i = 0; i < lights_.size(); ++i) {
    if (!(lights_[i].radius_rad > 0) || !lights_[i].mirrored) continue;
    const SeenLamp lamp = seen_lamp(i, from);
    if (lamp.light.meets(rays::vec3(toward)) && !(hit.any() && hit.distance < lamp.reach)) sum += lamp.light.radiance();
  }
  return sum;
}

// A direction that was drawn toward a place counts only where the ray meets that place first, so that its density is
// that of what rays meet. Directions to the sky and to emitters have none but that of the lobes.
Transport::Onward Transport::onward(const Spot& spot, const BrightPlaces::Receiver& receiver,
                                    const PaintedPoint& painted, double choice, double u, double v) const {
  const double chance = receiver.chance();
  Onward onward;
  BrightPlaces::Draw place;
  if (choice < chance) {
    place = places_->drawn(receiver, spot.start, choice / chance, u, v);
    if (place.triangle == rays::kNothing) return onward;
    onward.direction = place.direction;
  } else {
    onward.direction = painted.direction((choice - chance) / (1 - chance), u, v);
  }
  if (!painted.faces(onward.direction)) return onward;
  onward.hit = rays_->closest(spot.start, onward.direction);
  if (choice < chance && onward.hit.triangle != place.triangle) return onward;
  onward.lobes_chance = 1 - chance;
  if (chance > 0) onward.places_pdf = chance * places_->pdf(receiver, onward.hit, onward.direction);
  return onward;
}

}  // namespace goniochrome::render
