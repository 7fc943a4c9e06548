#include "rays/ray_scene.h"

#include <algorithm>
#include <cmath>
#include <mutex>

#include "rays/internal/embree.h"
#include "rays/internal/vertex_tree.h"

namespace goniochrome::rays {

namespace {

constexpr float kInfinite = std::numeric_limits<float>::infinity();
// From this many triangles on Embree builds its compact tree, which takes a third less memory and is a tenth slower.
constexpr std::size_t kCompactFrom = 1000000;
// How far a point may be lifted above its triangle, in its longest edges: see lifted().
constexpr float kMostLift = 0.25F;

struct DeviceRelease {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
};
struct SceneRelease {
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
using Device = std::unique_ptr<RTCDeviceTy, DeviceRelease>;
using EmbreeScene = std::unique_ptr<RTCSceneTy, SceneRelease>;

struct Placing {
  Vec3 middle;
  double scale = 1;
};

// The power of two that brings the largest half extent of the box between 1/2 and 1.
Placing placing_of(const mesh::Mesh& mesh) {
  const mesh::Box box = bounding_box(mesh);
  int exponent = 0;
  std::frexp(0.5 * box.longest_side(), &exponent);
  return {box.middle(), std::ldexp(1.0, -exponent)};
}

bool is_finite(const Vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

Result<void> check(const mesh::Mesh& mesh, const std::optional<Floor>& floor) {
  if (mesh.triangles.empty()) return input_error("a mesh without triangles: there is nothing that a ray could meet");
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const Vec3& p = mesh.positions[i];
    if (!is_finite(p))
      return input_error("vertex {} of the mesh is at ({}, {}, {}): its coordinates must be finite", i, p.x, p.y, p.z);
  }
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    for (const std::uint32_t vertex : mesh.triangles[i])
      if (vertex >= mesh.positions.size() || vertex >= mesh.normals.size())
        return input_error("triangle {} of the mesh refers to vertex {} of {}", i, vertex, mesh.positions.size());
  }
  std::size_t covered = 0;
  for (const mesh::MeshPart& part : mesh.parts) {
    if (part.first != covered) break;
    covered += part.count;
  }
  if (covered != mesh.triangles.size())
    return input_error("the parts of the mesh hold {} of its {} triangles: every triangle must belong to one part",
                       covered, mesh.triangles.size());
  if (floor && !std::isfinite(floor->height)) return input_error("a floor at height {}: write a number", floor->height);
  return {};
}

RTCRay ray_of(const Float3& origin, const Float3& direction, float distance) {
  RTCRay ray{};
  ray.org_x = origin.x, ray.org_y = origin.y, ray.org_z = origin.z;
  ray.dir_x = direction.x, ray.dir_y = direction.y, ray.dir_z = direction.z;
  ray.tfar = distance;
  ray.mask = ~0U;
  return ray;
}

// A point of a triangle lies below a smooth convex surface through its vertices, so that its neighbors block light that
// the smooth surface would see. Here it is moved to the mean of its projections on the vertices' tangent planes, each
// taken where the point lies below it: above a sphere's surface by as much as it was below. Where the surface is hollow
// it stays. The idea is [Hanika2021]'s.
Float3 lifted(const Float3& p, const std::array<Float3, 3>& corner, const std::array<Float3, 3>& normal,
              const std::array<float, 3>& share) {
  float longest2 = 0;
  Float3 lift;
  for (std::size_t k = 0; k < 3; ++k) {
    const Float3 edge = corner[(k + 1) % 3] - corner[k];
    longest2 = std::max(longest2, dot(edge, edge));
    const float below = -dot(p - corner[k], normal[k]);
    if (below > 0) lift = lift + (share[k] * below) * normal[k];
  }
  const float most = kMostLift * std::sqrt(longest2), size = length(lift);
  return size > most ? p + (most / size) * lift : p + lift;
}

// The normal that shades, never turned away from where the ray came from: the nearest that is not.
Float3 facing(const Float3& normal, const Float3& toward) {
  constexpr float kLeast = 1e-3F;
  const float cosine = dot(normal, toward);
  return cosine < kLeast ? normalized(normal + (kLeast - cosine) * toward) : normal;
}

}  // namespace

struct RayScene::State {
  Device device;
  EmbreeScene scene;
  Placing placing;
  std::vector<Float3> positions, normals;  // local, with one more element: Embree reads 16 bytes of each
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::array<std::uint32_t, 3>> met;  // those triangles where rays pass some of them; else empty
  std::vector<std::uint32_t> part_of;
  int parts = 0;
  mutable std::once_flag tree_made;
  mutable std::unique_ptr<const VertexTree> tree;

  Result<void> build() {
    device.reset(rtcNewDevice(nullptr));
    if (!device) {
      const RTCError error = rtcGetDeviceError(nullptr);
      if (error == RTC_ERROR_OUT_OF_MEMORY) return input_error("there is not enough memory to begin to trace rays");
      return input_error("rays cannot be traced: Embree cannot be started, its error is {}", static_cast<int>(error));
    }
    scene.reset(rtcNewScene(device.get()));
    const bool compact = triangles.size() >= kCompactFrom;
    rtcSetSceneFlags(scene.get(), compact ? RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_COMPACT : RTC_SCENE_FLAG_ROBUST);
    // Spatial splits (quality high) were no faster here.
    rtcSetSceneBuildQuality(scene.get(), RTC_BUILD_QUALITY_MEDIUM);
    RTCGeometry geometry = rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, positions.data(), 0,
                               sizeof(Float3), positions.size() - 1);
    const auto& traced = met.empty() ? triangles : met;
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, traced.data(), 0,
                               sizeof(traced[0]), traced.size());
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene.get(), geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene.get());
    const RTCError error = rtcGetDeviceError(device.get());
    if (error == RTC_ERROR_OUT_OF_MEMORY)
      return input_error("Embree needs more memory for a mesh of {} triangles", triangles.size());
    if (error != RTC_ERROR_NONE)
      return input_error("Embree's error {} while building its tree", static_cast<int>(error));
    return {};
  }
};

Result<RayScene> RayScene::create(const mesh::Mesh& mesh, const std::optional<Floor>& floor,
                                  const std::vector<bool>& passed) {
  GONIO_TRY(check(mesh, floor));
  auto state = std::make_shared<State>();
  state->placing = placing_of(mesh);
  const auto local = [&](const Vec3& p) { return float3(state->placing.scale * (p - state->placing.middle)); };
  state->positions.reserve(mesh.positions.size() + 1);
  for (const Vec3& p : mesh.positions) state->positions.push_back(local(p));
  state->positions.push_back({});
  state->normals.reserve(mesh.normals.size());
  for (const Vec3& n : mesh.normals) state->normals.push_back(float3(n));
  state->triangles = mesh.triangles;
  state->parts = static_cast<int>(mesh.parts.size());
  for (std::size_t part = 0; part < mesh.parts.size(); ++part)
    state->part_of.insert(state->part_of.end(), mesh.parts[part].count, static_cast<std::uint32_t>(part));
  if (std::ranges::find(passed, true) != passed.end()) {
    // A triangle whose corners are one point is met by no ray, and the others keep their numbers.
    state->met = state->triangles;
    for (std::size_t i = 0; i < state->met.size(); ++i) {
      const std::size_t part = state->part_of[i];
      if (part < passed.size() && passed[part]) state->met[i].fill(state->met[i].front());
    }
  }
  GONIO_TRY(state->build());
  const RayScene bare(std::move(state), std::nullopt);
  return floor ? bare.over(*floor) : RayScene(bare.state_, std::nullopt);
}

RayScene RayScene::over(const Floor& floor) const {
  return {state_, local({0, floor.height, 0}).y};
}

RayScene::RayScene(std::shared_ptr<const State> state, std::optional<float> floor)
    : state_(std::move(state)), floor_(floor) {}
RayScene::RayScene(RayScene&&) noexcept = default;
RayScene& RayScene::operator=(RayScene&&) noexcept = default;
RayScene::~RayScene() = default;

float RayScene::floor_distance(const Float3& origin, const Float3& direction) const {
  if (!floor_) return kInfinite;
  const float distance = (*floor_ - origin.y) / direction.y;
  return distance > 0 ? distance : kInfinite;  // NaN where the ray lies in the floor
}

int RayScene::parts() const {
  return state_->parts + (floor_ ? 1 : 0);
}
bool RayScene::has_floor() const {
  return floor_.has_value();
}
std::size_t RayScene::triangles() const {
  return state_->triangles.size();
}
double RayScene::scale() const {
  return state_->placing.scale;
}
const Vec3& RayScene::middle() const {
  return state_->placing.middle;
}
int RayScene::part(std::uint32_t triangle) const {
  return triangle == kFloor ? state_->parts : static_cast<int>(state_->part_of[triangle]);
}
std::array<Float3, 3> RayScene::corners(std::uint32_t triangle) const {
  const auto& [a, b, c] = state_->triangles[triangle];
  return {state_->positions[a], state_->positions[b], state_->positions[c]};
}
// In doubles: the cross product of a sliver's edges has few digits in floats.
Vec3 RayScene::doubled_area(std::uint32_t triangle) const {
  const std::array<Float3, 3> corner = corners(triangle);
  return goniochrome::cross(vec3(corner[1] - corner[0]), vec3(corner[2] - corner[0]));
}
double RayScene::by_solid_angle(std::uint32_t triangle, const Float3& direction, float distance) const {
  const Vec3 area = doubled_area(triangle);
  const double size = goniochrome::length(area), cosine = std::abs(goniochrome::dot(area, vec3(direction))) / size;
  return cosine > 0 ? static_cast<double>(distance) * distance / cosine : 0;
}

Hit RayScene::closest(const Float3& origin, const Float3& direction) const {
  RTCRayHit query{};
  const float floor = floor_distance(origin, direction);
  query.ray = ray_of(origin, direction, floor);
  query.hit.geomID = query.hit.primID = RTC_INVALID_GEOMETRY_ID;
  intersect(state_->scene.get(), ray_query(false), query);
  if (query.hit.geomID != RTC_INVALID_GEOMETRY_ID) return {query.hit.primID, query.hit.u, query.hit.v, query.ray.tfar};
  if (floor < kInfinite) return {kFloor, 0, 0, floor};
  return {};
}

bool RayScene::occluded(const Float3& origin, const Float3& direction, float distance) const {
  if (floor_distance(origin, direction) < distance) return true;
  RTCRay ray = ray_of(origin, direction, distance);
  occlude(state_->scene.get(), ray_query(false), ray);
  return ray.tfar < 0;
}

unsigned RayScene::occluded(const Fan& fan) const {
  RTCRay8 rays{};
  alignas(32) int valid[8];
  unsigned result = 0;
  for (unsigned i = 0; i < 8; ++i) {
    bool trace = (fan.wanted >> i & 1U) != 0;
    if (trace && floor_distance(fan.origin, {fan.x[i], fan.y[i], fan.z[i]}) < fan.reach) {
      result |= 1U << i;
      trace = false;
    }
    valid[i] = trace ? -1 : 0;
    rays.org_x[i] = fan.origin.x, rays.org_y[i] = fan.origin.y, rays.org_z[i] = fan.origin.z;
    rays.dir_x[i] = fan.x[i], rays.dir_y[i] = fan.y[i], rays.dir_z[i] = fan.z[i];
    rays.tfar[i] = fan.reach;
    rays.mask[i] = ~0U;
  }
  occlude(state_->scene.get(), ray_query(fan.narrow), valid, rays);
  for (unsigned i = 0; i < 8; ++i)
    if (valid[i] != 0 && rays.tfar[i] < 0) result |= 1U << i;
  return result;
}

void RayScene::closest(const Fan& fan, Hit* hits) const {
  RTCRayHit8 rays{};
  alignas(32) int valid[8];
  for (unsigned i = 0; i < 8; ++i) {
    valid[i] = (fan.wanted >> i & 1U) != 0 ? -1 : 0;
    rays.ray.org_x[i] = fan.origin.x, rays.ray.org_y[i] = fan.origin.y, rays.ray.org_z[i] = fan.origin.z;
    rays.ray.dir_x[i] = fan.x[i], rays.ray.dir_y[i] = fan.y[i], rays.ray.dir_z[i] = fan.z[i];
    rays.ray.tfar[i] = floor_distance(fan.origin, {fan.x[i], fan.y[i], fan.z[i]});
    rays.ray.mask[i] = ~0U;
    rays.hit.geomID[i] = rays.hit.primID[i] = RTC_INVALID_GEOMETRY_ID;
  }
  intersect(state_->scene.get(), ray_query(false), valid, rays);
  for (unsigned i = 0; i < 8; ++i) {
    if (valid[i] == 0) continue;
    if (rays.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID) {
      hits[i] = {rays.hit.primID[i], rays.hit.u[i], rays.hit.v[i], rays.ray.tfar[i]};
    } else {
      hits[i] = rays.ray.tfar[i] < kInfinite ? Hit{kFloor, 0, 0, rays.ray.tfar[i]} : Hit{};
    }
  }
}

Spot RayScene::spot(const Hit& hit, const Float3& origin, const Float3& direction) const {
  Spot spot;
  spot.triangle = hit.triangle;
  spot.u = hit.u, spot.v = hit.v;
  spot.part = part(hit.triangle);
  if (hit.triangle == kFloor) {
    spot.position = origin + hit.distance * direction;
    spot.position.y = *floor_;
    spot.inside = direction.y > 0;
    spot.geometric = spot.shading = {0, spot.inside ? -1.0F : 1.0F, 0};
    spot.start = spot.position + kLift * spot.geometric;
    return spot;
  }
  const auto& vertex = state_->triangles[hit.triangle];
  const std::array<Float3, 3> corner = corners(hit.triangle);
  const Float3 e1 = corner[1] - corner[0], e2 = corner[2] - corner[0];
  const std::array<float, 3> share = {1 - hit.u - hit.v, hit.u, hit.v};
  spot.position = corner[0] + hit.u * e1 + hit.v * e2;
  const Vec3 area = doubled_area(hit.triangle);
  const double size = goniochrome::length(area);
  Float3 geometric = size > 0 ? float3((1 / size) * area) : -direction;
  spot.inside = dot(geometric, direction) > 0;
  const float side = spot.inside ? -1.0F : 1.0F;
  spot.geometric = side * geometric;
  std::array<Float3, 3> normal;
  Float3 sum;
  for (std::size_t k = 0; k < 3; ++k) {
    normal[k] = side * state_->normals[vertex[k]];
    sum = sum + share[k] * normal[k];
  }
  const float length_of_sum = length(sum);
  spot.shading = facing(length_of_sum > 0 ? (1 / length_of_sum) * sum : spot.geometric, -direction);
  spot.start = lifted(spot.position, corner, normal, share) + kLift * spot.geometric;
  return spot;
}

bool RayScene::any_above(const Float3& point, const Float3& normal, float margin) const {
  std::call_once(state_->tree_made, [this] {
    std::vector<Float3> points(state_->positions.begin(), state_->positions.end() - 1);
    state_->tree = std::make_unique<const VertexTree>(std::move(points));
  });
  return state_->tree->any_above(point, normal, margin);
}

bool RayScene::is_convex() const {
  for (std::uint32_t triangle = 0; triangle < triangles(); ++triangle) {
    const Vec3 area = doubled_area(triangle);
    const double size = length(area);
    if (size > 0 && any_above(corners(triangle)[0], float3((1 / size) * area), kLift)) return false;
  }
  return true;
}

}  // namespace goniochrome::rays
