#include "render/path/emitters.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "render/path/spherical_triangle.h"

namespace goniochrome::render {

namespace {

using rays::Float3;

// Nodes that are farther than so many of their radii are drawn from by power and evenly by area.
constexpr float kFar = 2;
// The least square of a distance, so that no importance is infinite.
constexpr float kLeastSquare = 1e-24F;
// Cuts whose costs differ by no more than this part are equal: the more even one is taken, so that triangles on one
// place make no deep tree.
constexpr double kTie = 1e-9;
constexpr float kInfinite = std::numeric_limits<float>::infinity();

float along(const Float3& a, int axis) {
  return axis == 0 ? a.x : axis == 1 ? a.y : a.z;
}

}  // namespace

// Balls put together: the box that holds them, and what they send.
struct Emitters::Bunch {
  Float3 low{kInfinite, kInfinite, kInfinite}, high{-kInfinite, -kInfinite, -kInfinite};
  double power = 0;

  Bunch& add(const Node& node) {
    const Float3 &m = node.middle, r{node.radius, node.radius, node.radius};
    const Float3 a = m - r, b = m + r;
    low = {std::min(low.x, a.x), std::min(low.y, a.y), std::min(low.z, a.z)};
    high = {std::max(high.x, b.x), std::max(high.y, b.y), std::max(high.z, b.z)};
    power += static_cast<double>(node.power);
    return *this;
  }
  double cost() const {
    const Float3 size = high - low;
    return power * static_cast<double>(rays::dot(size, size));
  }
};

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
  std::vector<Node> leaves;
  std::vector<double> powers;
  double total = 0;
  for (std::uint32_t triangle = 0; triangle < scene.triangles(); ++triangle) {
    const int part = scene.part(triangle);
    const double power = color::mean(emitters.radiance(part)), area = 0.5 * length(scene.doubled_area(triangle));
    if (!(power > 0)) continue;
    part_area[static_cast<std::size_t>(part)] += area;
    if (!(area > 0)) continue;
    const std::array<Float3, 3> corner = scene.corners(triangle);
    Node leaf;
    leaf.middle = (1.0F / 3) * (corner[0] + corner[1] + corner[2]);
    for (const Float3& c : corner) leaf.radius = std::max(leaf.radius, rays::length(c - leaf.middle));
    leaf.triangle = triangle, powers.push_back(power * area), total += powers.back();
    leaves.push_back(leaf);
  }
  for (std::size_t part = 0; part < part_area.size(); ++part)
    if (color::mean(emitters.radiance_[part]) > 0 && !(part_area[part] > 0))
      return input_error("part {} emits light but has no area: no ray can find it", part);
  if (leaves.empty()) return emitters;
  for (std::size_t i = 0; i < leaves.size(); ++i) leaves[i].power = static_cast<float>(powers[i] / total);
  emitters.leaf_of_.assign(scene.triangles(), kNone);
  emitters.nodes_.reserve(2 * leaves.size());
  emitters.nodes_.emplace_back();
  emitters.split(0, leaves, 0, leaves.size());
  return emitters;
}

// In two across an axis, where the sum over both of the power times the square of the box's diagonal is least.
void Emitters::split(std::uint32_t node, std::vector<Node>& leaves, std::size_t begin, std::size_t end) {
  if (end - begin == 1) {
    const std::uint32_t parent = nodes_[node].parent;
    nodes_[node] = leaves[begin], nodes_[node].parent = parent;
    leaf_of_[leaves[begin].triangle] = node;
    return;
  }
  Node inner = nodes_[node];
  const auto sort = [&](int axis) {
    std::sort(leaves.begin() + static_cast<std::ptrdiff_t>(begin), leaves.begin() + static_cast<std::ptrdiff_t>(end),
              [axis](const Node& a, const Node& b) {
                const float x = along(a.middle, axis), y = along(b.middle, axis);
                return x != y ? x < y : a.triangle < b.triangle;
              });
  };
  std::vector<double> below(end - begin);
  double least = std::numeric_limits<double>::infinity();
  std::size_t middle = begin + 1;
  int across = 0;
  for (int axis = 0; axis < 3; ++axis) {
    sort(axis);
    Bunch bunch;
    for (std::size_t i = begin; i + 1 < end; ++i) below[i - begin] = bunch.add(leaves[i]).cost();
    bunch = {};
    for (std::size_t i = end - 1; i > begin; --i) {
      const double cost = below[i - 1 - begin] + bunch.add(leaves[i]).cost();
      const bool more_even = std::min(i - begin, end - i) > std::min(middle - begin, end - middle);
      if (cost < (1 - kTie) * least || (more_even && cost < (1 + kTie) * least))
        least = cost, middle = i, across = axis;
    }
    bunch.add(leaves[begin]);
    inner.middle = 0.5F * (bunch.low + bunch.high);
  }
  if (across != 2) sort(across);
  for (std::size_t i = begin; i < end; ++i) {
    inner.power += leaves[i].power;
    inner.radius = std::max(inner.radius, rays::length(leaves[i].middle - inner.middle) + leaves[i].radius);
  }
  inner.first = static_cast<std::uint32_t>(nodes_.size());
  nodes_[node] = inner;
  nodes_.resize(nodes_.size() + 2);
  nodes_[inner.first].parent = nodes_[inner.first + 1].parent = node;
  split(inner.first, leaves, begin, middle);
  split(inner.first + 1, leaves, middle, end);
}

// The power over the square of the distance, of the radius where that is more, times a bound of the cosine at the lit
// point.
float Emitters::importance(const Node& node, const LitPoint& at) {
  const Float3 apart = node.middle - at.position;
  const float height = rays::dot(apart, at.normal) + node.radius;
  if (!(height > 0)) return 0;
  const float square = std::max({rays::dot(apart, apart), node.radius * node.radius, kLeastSquare});
  return node.power * std::min(1.0F, height / std::sqrt(square)) / square;
}

float Emitters::first_share(const Node& node, const LitPoint& at) const {
  const float first = importance(nodes_[node.first], at), second = importance(nodes_[node.first + 1], at);
  return first + second > 0 ? first / (first + second) : -1;
}

bool Emitters::is_far(const Node& node, const Float3& from) {
  const Float3 apart = node.middle - from;
  return rays::dot(apart, apart) > kFar * kFar * node.radius * node.radius;
}

// d^2/(A cos).
double Emitters::even_by_area(std::uint32_t triangle, const Float3& direction, float distance) const {
  const double across = std::abs(dot(scene_->doubled_area(triangle), rays::vec3(direction)));
  return across > 0 ? 2 * static_cast<double>(distance) * distance / across : 0;
}

EmitterSample Emitters::drawn(const LitPoint& at, double choice, double u, double v) const {
  std::uint32_t number = 0;
  double chance = 1;
  const Node* far = nullptr;
  while (true) {
    const Node& node = nodes_[number];
    if (far == nullptr && is_far(node, at.position)) far = &node;
    if (node.triangle != kNone) break;
    const Node& first = nodes_[node.first];
    const double share = far != nullptr ? static_cast<double>(first.power) / node.power : first_share(node, at);
    if (share < 0) return {};
    const bool second = choice >= share;
    choice = second ? (choice - share) / (1 - share) : choice / share;
    if (far == nullptr) chance *= second ? 1 - share : share;
    number = node.first + (second ? 1 : 0);
  }
  const Node& leaf = nodes_[number];
  const std::array<Float3, 3> corner = scene_->corners(leaf.triangle);
  const int part = scene_->part(leaf.triangle);
  EmitterSample sample;
  sample.radiance = radiance(part), sample.part = part;
  if (far == nullptr) {
    const SphericalTriangle seen(at.position, corner);
    if (!(seen.extent_sr() > 0)) return {};
    const Vec3 direction = seen.direction(u, v), normal = scene_->doubled_area(leaf.triangle);
    const double distance = dot(normal, rays::vec3(corner[0] - at.position)) / dot(normal, direction);
    if (!(distance > 0) || std::isinf(distance)) return {};
    sample.direction = rays::float3(direction), sample.distance = static_cast<float>(distance);
    sample.pdf = static_cast<float>(chance / seen.extent_sr());
    return sample;
  }
  chance *= static_cast<double>(leaf.power) / far->power;
  // Even over the triangle: the square folded along its diagonal by way of the root.
  const double root = std::sqrt(u);
  const auto b = static_cast<float>(root * (1 - v)), c = static_cast<float>(root * v);
  const Float3 apart = corner[0] + b * (corner[1] - corner[0]) + c * (corner[2] - corner[0]) - at.position;
  sample.distance = rays::length(apart);
  sample.direction = (1 / sample.distance) * apart;
  sample.pdf = static_cast<float>(chance * even_by_area(leaf.triangle, sample.direction, sample.distance));
  return sample;
}

float Emitters::pdf(const LitPoint& at, std::uint32_t triangle, const Float3& direction, float distance) const {
  if (triangle >= leaf_of_.size() || leaf_of_[triangle] == kNone) return 0;
  const std::uint32_t number = leaf_of_[triangle];
  const Node& leaf = nodes_[number];
  double chance = 1;
  bool far = is_far(leaf, at.position);
  for (std::uint32_t child = number; child != 0; child = nodes_[child].parent) {
    const Node& parent = nodes_[nodes_[child].parent];
    if (is_far(parent, at.position)) {
      far = true, chance = static_cast<double>(leaf.power) / parent.power;
      continue;
    }
    const double share = first_share(parent, at);
    if (share < 0) return 0;
    chance *= child == parent.first ? share : 1 - share;
  }
  if (!far) {
    const double extent = SphericalTriangle(at.position, scene_->corners(triangle)).extent_sr();
    return extent > 0 ? static_cast<float>(chance / extent) : 0;
  }
  return static_cast<float>(chance * even_by_area(triangle, direction, distance));
}

}  // namespace goniochrome::render
