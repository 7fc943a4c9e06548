// Meshes and environments with known answers, for the tests of this module.
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>

#include "base/angles.h"
#include "base/random_for_test.h"
#include "render/gbuffer.h"
#include "render/scene.h"

namespace goniochrome::render {

// A sphere of radius 1 with exact normals. The chord between two rows bends away by h^2/8, h = pi/rows.
inline mesh::Mesh sphere_mesh(int rows = 256) {
  mesh::Mesh mesh;
  const int columns = 2 * rows;
  for (int i = 0; i <= rows; ++i) {
    for (int j = 0; j <= columns; ++j) {
      const double t = kPi * i / rows, p = 2 * kPi * j / columns;
      mesh.positions.push_back({std::sin(t) * std::sin(p), std::cos(t), std::sin(t) * std::cos(p)});
    }
  }
  mesh.normals = mesh.positions;
  const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(i * (columns + 1) + j); };
  for (int i = 0; i < rows; ++i) {
    for (int j = 0; j < columns; ++j) {
      if (i > 0) mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
      if (i < rows - 1) mesh.triangles.push_back({at(i, j + 1), at(i + 1, j), at(i + 1, j + 1)});
    }
  }
  mesh.parts = {{"sphere", "", 0, mesh.triangles.size()}};
  return mesh;
}

// Squares side by side along x from -n/2 to n/2, -.5 to .5 in y, facing +Z; one part each, "panel-0" ...
inline mesh::Mesh panels_mesh(int n) {
  mesh::Mesh mesh;
  for (int i = 0; i <= n; ++i) {
    for (const double y : {-0.5, 0.5}) {
      mesh.positions.push_back({i - 0.5 * n, y, 0});
      mesh.normals.push_back({0, 0, 1});
    }
  }
  for (int i = 0; i < n; ++i) {
    const auto v = static_cast<std::uint32_t>(2 * i);
    mesh.parts.push_back({"panel-" + std::to_string(i), "", mesh.triangles.size(), 2});
    mesh.triangles.push_back({v, v + 2, v + 3});
    mesh.triangles.push_back({v, v + 3, v + 1});
  }
  return mesh;
}

// The view of a camera, by the nearest triangle that the ray through each pixel meets: a plain search through all of
// them, without OpenGL.
inline Gbuffer seen_by_rays(const mesh::Mesh& mesh, const Camera& camera, int width, int height) {
  Gbuffer g{width, height, {}, *rays(camera, width, height)};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const Vec3 ray = g.rays.direction(x + 0.5, y + 0.5);
      std::uint32_t nearest = kNoTriangle;
      double distance = std::numeric_limits<double>::infinity();
      for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        // Seen from the eye the ray is within a triangle if it is on the same side of all three edges.
        Vec3 corner[3];
        for (std::size_t k = 0; k < 3; ++k) corner[k] = mesh.positions[mesh.triangles[i][k]] - camera.eye;
        const double a = dot(ray, cross(corner[0], corner[1])), b = dot(ray, cross(corner[1], corner[2])),
                     c = dot(ray, cross(corner[2], corner[0]));
        if (!((a >= 0 && b >= 0 && c >= 0) || (a <= 0 && b <= 0 && c <= 0)) || a + b + c == 0) continue;
        const Vec3 met = (1 / (a + b + c)) * (b * corner[0] + c * corner[1] + a * corner[2]);
        const double along = dot(met, ray);
        if (along > 0 && along < distance) distance = along, nearest = i;
      }
      g.triangles.push_back(nearest);
      if (nearest == kNoTriangle) {
        g.data.insert(g.data.end(), 4, 0.0F);
        continue;
      }
      int part = 0;
      while (nearest >=
             mesh.parts[static_cast<std::size_t>(part)].first + mesh.parts[static_cast<std::size_t>(part)].count)
        ++part;
      Vec3 normal;
      const MeshPoint point = mesh_point(mesh, nearest, camera.eye, ray);
      for (std::size_t k = 0; k < 3; ++k) normal += point.shares[k] * mesh.normals[mesh.triangles[nearest][k]];
      normal = normalized(dot(normal, ray) < 0 ? normal : -normal);
      for (int c = 0; c < 3; ++c) g.data.push_back(static_cast<float>(normal[c]));
      g.data.push_back(static_cast<float>(part + 1));
    }
  }
  return g;
}

inline envmap::CubeMap cube_of(int size, const std::function<Vec3(const Vec3& direction)>& radiance) {
  envmap::CubeMap map(size);
  for (int face = 0; face < 6; ++face) {
    for (int row = 0; row < size; ++row) {
      for (int column = 0; column < size; ++column) {
        const Vec3 value = radiance(envmap::cube_direction(face, column + 0.5, row + 0.5, size));
        for (int c = 0; c < 3; ++c) map.at(face, row, column)[c] = static_cast<float>(value[c]);
      }
    }
  }
  return map;
}

// An environment of one radiance everywhere, for these exponents: prefiltering leaves it alone.
inline envmap::PrefilteredEnvironment constant_env(const Vec3& radiance, const std::vector<double>& exponents) {
  const envmap::CubeMap map = cube_of(4, [&](const Vec3&) { return radiance; });
  envmap::PrefilteredEnvironment env;
  env.diffuse.map = env.mirror.map = map;
  env.mirror.exponent = paint::kMirrorExponent;
  for (const double exponent : exponents) {
    env.lobes.emplace_back();
    env.lobes.back().exponent = exponent;
    env.lobes.back().map = map;
  }
  env.source = "constant.exr";
  return env;
}

inline paint::LobeFit matt(const color::Rgb& reflectance) {
  paint::LobeFit paint;
  paint.diffuse = (1 / kPi) * reflectance;
  return paint;
}

inline paint::LobeFit only_mirror(double weight = 1) {
  paint::LobeFit paint;
  paint.lobes.push_back({paint::kMirrorExponent, {}, {weight, weight, weight}});
  return paint;
}

// Maps of many sizes, smooth but far from constant, so that wrong faces, seams, weights and classes all show.
inline envmap::PrefilteredEnvironment uneven_env(const std::vector<double>& exponents, const std::vector<int>& sizes) {
  envmap::PrefilteredEnvironment env = constant_env({1, 1, 1}, exponents);
  const auto radiance = [](double k) {
    return [k](const Vec3& d) {
      return Vec3{1 + 0.5 * std::sin(k * d.x), 0.7 + 0.3 * d.y * d.z + 0.2 * std::cos(k * d.z), 0.5 + 0.3 * d.x * d.y};
    };
  };
  env.diffuse.map = cube_of(12, radiance(1));
  env.mirror.map = cube_of(40, radiance(9));
  for (std::size_t i = 0; i < exponents.size(); ++i)
    env.lobes[i].map = cube_of(sizes[i], radiance(2.0 + static_cast<double>(i)));
  return env;
}

inline paint::LobeFit rich_paint() {
  paint::LobeFit paint = matt({0.05, 0.1, 0.2});
  paint.lobes = {{1.3, {0.02, 0.01, 0.03}, {}},
                 {6, {0.05, 0.1, 0.2}, {0.01, 0.01, 0.01}},
                 {40, {0.3, 0.2, 0.1}, {0.2, 0.2, 0.2}},
                 {300, {0.5, 0.6, 0.1}, {}},
                 {3000, {}, {9, 9, 9}},
                 {paint::kMirrorExponent, {}, {0.6, 0.6, 0.6}}};
  return paint;
}

// The product of polynomials in s up to s^2, with s^3 = 0, needs five forms; in coordinates where 1 is white.
inline color::ReflectionOperator five_form_operator() {
  const color::Matrix3 to_rgb = {{{1, 0, 0}, {1, 1, 0}, {1, 0, 1}}}, from_rgb = {{{1, 0, 0}, {-1, 1, 0}, {-1, 0, 1}}};
  color::ReflectionOperator op;
  for (std::size_t d = 0; d < 3; ++d) {
    for (std::size_t e = 0; e < 3; ++e) {
      color::Rgb polynomial;
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; i + j < 3; ++j) polynomial[static_cast<int>(i + j)] += from_rgb[i][d] * from_rgb[j][e];
      const color::Rgb color = color::product(to_rgb, polynomial);
      for (std::size_t c = 0; c < 3; ++c) op.k[c][d][e] = color[static_cast<int>(c)];
    }
  }
  return op;
}

}  // namespace goniochrome::render
