// Meshes and scenes for the tests of paths, whose light is known in closed form.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "render/path/path_estimate_for_test.h"
#include "render/path/path_tracer.h"
#include "render/scenes_for_test.h"

namespace goniochrome::render {

// Adds the rectangle corner + s a + t b, 0 <= s, t <= 1, as a part that faces a x b.
inline void add_rectangle(mesh::Mesh& mesh, const std::string& name, const Vec3& corner, const Vec3& a, const Vec3& b) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  for (const Vec3& p : {corner, corner + a, corner + a + b, corner + b}) mesh.positions.push_back(p);
  mesh.normals.insert(mesh.normals.end(), 4, normalized(cross(a, b)));
  mesh.parts.push_back({name, "", mesh.triangles.size(), 2});
  mesh.triangles.push_back({first, first + 1, first + 2});
  mesh.triangles.push_back({first, first + 2, first + 3});
}

// Adds all of another mesh, as one part more for each of its own.
inline void add_mesh(mesh::Mesh& mesh, const mesh::Mesh& other, double scale, const Vec3& shift) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  for (const Vec3& p : other.positions) mesh.positions.push_back(shift + scale * p);
  mesh.normals.insert(mesh.normals.end(), other.normals.begin(), other.normals.end());
  for (mesh::MeshPart part : other.parts) {
    part.first += mesh.triangles.size();
    mesh.parts.push_back(part);
  }
  for (const auto& t : other.triangles) mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
}

// The walls of the box from -1 to 1, facing inward; without its lid (+Y) it is a cup. One part each.
inline mesh::Mesh box_mesh(bool with_lid) {
  mesh::Mesh mesh;
  add_rectangle(mesh, "bottom", {-1, -1, -1}, {0, 0, 2}, {2, 0, 0});
  add_rectangle(mesh, "left", {-1, -1, -1}, {0, 2, 0}, {0, 0, 2});
  add_rectangle(mesh, "right", {1, -1, -1}, {0, 0, 2}, {0, 2, 0});
  add_rectangle(mesh, "back", {-1, -1, -1}, {2, 0, 0}, {0, 2, 0});
  add_rectangle(mesh, "front", {-1, -1, 1}, {0, 2, 0}, {2, 0, 0});
  if (with_lid) add_rectangle(mesh, "lid", {-1, 1, -1}, {2, 0, 0}, {0, 0, 2});
  return mesh;
}

inline envmap::Environment environment_of(int width, int height,
                                          const std::function<color::Rgb(int column, int row)>& radiance) {
  std::vector<float> rgb;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < 3; ++c) rgb.push_back(static_cast<float>(radiance(x, y)[c]));
  return envmap::Environment::from_lat_long({width, height, 3, rgb, {}}, envmap::Environment::BadPixels::kError, "made")
      .value();
}

// A lamp in a room that is brighter below.
inline envmap::Environment studio() {
  return environment_of(64, 32, [](int x, int y) {
    const double lamp = x > 20 && x < 26 && y > 6 && y < 11 ? 12 : 0;
    return color::Rgb{0.2 + 0.01 * x + lamp, 0.3 + 0.02 * y + lamp, 0.4 + 0.5 * lamp};
  });
}

inline envmap::Environment even_environment(const color::Rgb& radiance = {1, 1, 1}) {
  return environment_of(16, 8, [&](int, int) { return radiance; });
}

// A scene that owns what it refers to.
struct PathStage {
  mesh::Mesh mesh;
  Scene scene;
  std::optional<envmap::Environment> environment, mirrored;
  std::vector<color::Rgb> emission;
  std::optional<Ground> ground;
  std::optional<Transport> transport;
  bool rough_coats = false;

  PathStage(mesh::Mesh m, std::vector<paint::LobeFit> paints) : mesh(std::move(m)) {
    scene.mesh = &mesh;
    scene.paints = std::move(paints);
    scene.paints.resize(mesh.parts.size(), scene.paints.back());
  }
  PathStage(const PathStage&) = delete;

  const Transport& build() {
    PathScene path;
    path.scene = &scene;
    path.environment = environment ? &*environment : nullptr;
    path.mirrored = mirrored ? &*mirrored : nullptr;
    path.emission = emission;
    path.ground = ground;
    path.rough_coats = rough_coats;
    auto made = Transport::create(path);
    if (!made.ok()) throw std::runtime_error(made.error().message);
    transport.emplace(*std::move(made));
    return *transport;
  }

  // The light from `target` at `eye`.
  PathEstimate seen(const PathOptions& options, const Vec3& eye, const Vec3& target, int batches,
                    std::uint64_t seed = 1) const {
    const Vec3 toward = normalized(target - eye);
    const rays::RayScene& rays = transport->rays();
    const rays::Float3 from = rays.local(eye), direction = rays::float3(toward);
    const rays::Hit hit = rays.closest(from, direction);
    if (!hit.any()) throw std::runtime_error("nothing is seen");
    return path_estimate(*transport, options, rays.spot(hit, from, direction), -toward, batches, seed);
  }
};

inline double deviation(const PathEstimate& estimate, int channel = 1) {
  return std::sqrt(estimate.covariance[static_cast<std::size_t>(channel)]);
}

}  // namespace goniochrome::render
