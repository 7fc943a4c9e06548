// Meshes and environments with known answers, for the tests of this module.
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>

#include "base/random_for_test.h"
#include "render/scene.h"

namespace goniochrome::render {

// A sphere of radius 1 with exact normals. The chord between two rows bends away by h^2/8, h = pi/rows.
inline mesh::Mesh sphere_mesh(int rows = 256) {
  mesh::Mesh mesh;
  const int columns = 2 * rows;
  for (int i = 0; i <= rows; ++i) {
    for (int j = 0; j <= columns; ++j) {
      const double t = std::numbers::pi * i / rows, p = 2 * std::numbers::pi * j / columns;
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

// The same everywhere, for these exponents: prefiltering leaves it alone.
inline envmap::PrefilteredEnvironment constant_env(const Vec3& radiance, const std::vector<double>& exponents) {
  const envmap::CubeMap map = cube_of(4, [&](const Vec3&) { return radiance; });
  envmap::PrefilteredEnvironment env;
  env.diffuse.map = env.mirror.map = map;
  env.mirror.exponent = envmap::kMirrorExponent;
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
  paint.diffuse = (1 / std::numbers::pi) * reflectance;
  return paint;
}

inline paint::LobeFit only_mirror(double weight = 1) {
  paint::LobeFit paint;
  paint.lobes.push_back({envmap::kMirrorExponent, {}, {weight, weight, weight}});
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
