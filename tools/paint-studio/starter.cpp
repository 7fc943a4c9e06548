#include "starter.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/angles.h"
#include "envmap/environment.h"
#include "prefilter/prefilter.h"

namespace goniochrome::tool {

namespace {

// The solid (|x/a|^(2/e2) + |z/c|^(2/e2))^(e2/e1) + |y/b|^(2/e1) <= 1, after Barr, "Superquadrics and Angle-Preserving
// Transformations" (1981). `low` and `high` are elevations in degrees.
struct Superellipsoid {
  Vec3 center, half;
  double up = 1, around = 1;  // the exponents e1 and e2
  double low = -90, high = 90;
  bool on_its_side = false;  // its axis is x instead of y
};

double signed_power(double x, double exponent) {
  return std::copysign(std::pow(std::abs(x), exponent), x);
}

void add(mesh::Mesh& mesh, const char* name, const Superellipsoid& solid) {
  constexpr std::uint32_t kRows = 48, kColumns = 96;
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  const auto placed = [&](const Vec3& v) { return solid.on_its_side ? Vec3{v.y, -v.x, v.z} : v; };
  for (std::uint32_t row = 0; row <= kRows; ++row)
    for (std::uint32_t column = 0; column <= kColumns; ++column) {
      const double t = (solid.low + (solid.high - solid.low) * row / kRows) * kDegree;
      const double p = 2 * kPi * column / kColumns;
      const double ring = std::pow(std::max(0.0, std::cos(t)), solid.up),
                   slope = std::pow(std::max(1e-9, std::cos(t)), 2 - solid.up);
      const Vec3 at = {ring * signed_power(std::sin(p), solid.around), signed_power(std::sin(t), solid.up),
                       ring * signed_power(std::cos(p), solid.around)};
      const Vec3 normal = {slope * signed_power(std::sin(p), 2 - solid.around) / solid.half.x,
                           signed_power(std::sin(t), 2 - solid.up) / solid.half.y,
                           slope * signed_power(std::cos(p), 2 - solid.around) / solid.half.z};
      mesh.positions.push_back(solid.center + placed({at.x * solid.half.x, at.y * solid.half.y, at.z * solid.half.z}));
      mesh.normals.push_back(normalized(placed(normal)));
    }
  const std::size_t begin = mesh.triangles.size();
  for (std::uint32_t row = 0; row < kRows; ++row)
    for (std::uint32_t column = 0; column < kColumns; ++column) {
      const std::uint32_t a = first + row * (kColumns + 1) + column, b = a + kColumns + 1;
      mesh.triangles.push_back({a, a + 1, b + 1});
      mesh.triangles.push_back({a, b + 1, b});
    }
  mesh.parts.push_back({name, "", begin, mesh.triangles.size() - begin});
}

// A soft edge of a light: 1 inside, 0 beyond.
double inside(double distance, double edge) {
  const double t = std::clamp((edge - distance) / (0.15 * edge) + 0.5, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

double radiance(const Vec3& d) {
  const double wall = d.y < 0 ? 0.3 + 0.4 * (1 + d.y) : 0.7 + 0.3 * d.y;
  double light = 0;
  if (d.y > 0) light += 7 * inside(std::abs(d.x) / d.y, 0.55) * inside(std::abs(d.z) / d.y, 1.3);
  for (const double side : {-1.0, 1.0})
    if (side * d.x > 0) {
      const double away = std::abs(d.x);
      light += 5 * inside(std::abs(d.y / away - 0.45), 0.12) * inside(std::abs(d.z / away - 0.2), 1.6);
    }
  return wall + light;
}

paint::Paint paint_of(const char* name, paint::PaintClass kind, const color::Lab& face, const color::Lab& flop,
                      double travel_deg, double gloss_units) {
  paint::Paint paint;
  paint.name = name;
  paint.paint_class = kind;
  paint.appearance = paint::Appearance{face, flop, travel_deg, {}};
  paint.gloss = {{60, gloss_units}};
  return paint;
}

}  // namespace

mesh::Mesh starter_mesh() {
  mesh::Mesh mesh;
  add(mesh, "Body", {{0, 0.62, 0}, {0.92, 0.40, 2.2}, 0.55, 0.5});
  add(mesh, "Glass", {{0, 0.86, -0.25}, {0.74, 0.52, 1.25}, 0.85, 0.75, 5, 42});
  add(mesh, "Roof", {{0, 0.86, -0.25}, {0.74, 0.52, 1.25}, 0.85, 0.75, 42, 90});
  for (const double x : {-0.84, 0.84})
    for (const double z : {-1.35, 1.4}) {
      add(mesh, "Tires", {{x, 0.33, z}, {0.33, 0.12, 0.33}, 0.35, 1, -90, 90, true});
      add(mesh, "Rims", {{x + std::copysign(0.02, x), 0.33, z}, {0.21, 0.12, 0.21}, 0.35, 1, -90, 90, true});
    }
  return mesh;
}

Result<envmap::PrefilteredEnvironment> starter_light(const formats::Basis& basis) {
  constexpr int kHeight = 128;
  const envmap::SphereGrid grid(envmap::SphereGrid::Layout::kLatLong, 2 * kHeight, kHeight);
  image::Image image{2 * kHeight, kHeight, 3, {}, {}};
  for (int row = 0; row < kHeight; ++row)
    for (int column = 0; column < 2 * kHeight; ++column)
      image.data.insert(image.data.end(), 3, static_cast<float>(radiance(grid.direction(column, row))));
  GONIO_ASSIGN(const envmap::Environment env,
               envmap::Environment::from_lat_long(std::move(image), envmap::Environment::BadPixels::kError, "studio"));
  prefilter::PrefilterRequest request;
  request.exponents = prefilter::filter_exponents(basis.exponents);
  request.mirror = basis.mirror;
  return prefilter::prefiltered(env, request, prefilter::prefilter_plan(env, request),
                                [](const envmap::PrefilteredLobe&, double) {});
}

std::vector<paint::Paint> starter_paints() {
  using paint::PaintClass;
  return {paint_of("green to violet", PaintClass::kInterference, {62, -38, 30}, {24, 30, -38}, 55, 90),
          paint_of("candy red", PaintClass::kMetallic, {52, 68, 42}, {14, 34, 18}, 45, 94),
          paint_of("silver", PaintClass::kMetallic, {118, -1, 2}, {38, -1, -2}, 60, 85),
          paint_of("pearl white", PaintClass::kPearl, {104, -2, 6}, {84, -1, 2}, 50, 90),
          paint_of("deep blue", PaintClass::kSolid, {26, 8, -38}, {25, 8, -37}, 60, 92),
          paint_of("matt gray", PaintClass::kSolid, {52, 0, 1}, {50, 0, 1}, 60, 12)};
}

}  // namespace goniochrome::tool
