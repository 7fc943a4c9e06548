#include "brdf/color_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "base/hard_case_for_test.h"

namespace goniochrome::brdf::color_map_test {
namespace {

TEST(ColorMap, TexelsStandForTheirDirections) {
  constexpr int kSize = 16;
  for (int row = 0; row < 2 * kSize; ++row) {
    for (int column = 0; column < kSize; ++column) {
      const MapDirections d = map_directions(kSize, column, row);
      EXPECT_NEAR(length(d.light), 1, 1e-15);
      EXPECT_EQ(row < kSize, d.view.x < 0);
      // Only one order of the pair is looked up: the steeper direction is the column.
      if (d.light.z > d.view.z) continue;
      const MapPlace place = map_place(equivalent_in_plane(d.light, d.view, 1.5, CriticalAngle::kClip), kSize);
      EXPECT_NEAR(place.x, column + 0.5, 1e-12);
      EXPECT_NEAR(place.y, row + 0.5, 1e-12);
    }
  }
}

TEST(ColorMap, GlossLineIsTheDiagonalOfTheUpperHalf) {
  for (const double t : {0.1, 0.7, 1.4}) {
    const Vec3 light = {std::sin(t), 0, std::cos(t)}, mirror = {-std::sin(t), 0, std::cos(t)};
    const MapPlace place = map_place(equivalent_in_plane(light, mirror, 1.5, CriticalAngle::kClip), 100);
    EXPECT_NEAR(place.x, place.y, 1e-10);
  }
}

// A map that is linear in both cosines comes back as it is, between texels too.
TEST(ColorMap, FetchIsBilinear) {
  ColorMap map = color_map_of_size(8, 1.5);
  for (int row = 0; row < 16; ++row)
    for (int column = 0; column < 8; ++column) {
      float* t = map.texel(column, row);
      t[0] = static_cast<float>(column + 0.5), t[1] = static_cast<float>(row + 0.5), t[2] = 1;
    }
  const color::Rgb value = fetched(map, {3.3, 9.75});
  EXPECT_NEAR(value.x, 3.3, 1e-6);
  EXPECT_NEAR(value.y, 9.75, 1e-6);
  EXPECT_NEAR(value.z, 1, 1e-6);
  EXPECT_EQ(fetched(map, {-4, 99}), (color::Rgb{0.5, 15.5, 1}));
  EXPECT_EQ(fetched(color_map_of_size(1, 1.5), {0.4, 1.7}), color::Rgb{});
  EXPECT_EQ(reflectance_factor(map, {0, 0, -1}, {0, 0, 1}, CriticalAngle::kClip), color::Rgb{});
  EXPECT_GT(reflectance_factor(map, {0, 0, 1}, {0, 0, 1}, CriticalAngle::kClip).x, 7);
}

// An extreme interference paint: green where flakes are met steeply, blue and purple where they are met at grazing
// angles, red where they stand. Its map is filled from the function itself.
color::Lab traveling_paint(const FlakeAngles& f) {
  const double flop = std::exp(-std::pow(f.flake_rad / 0.3, 2)),
               hue = (140 + 230 * f.incidence_rad - 200 * f.flake_rad) * kDegree;
  const double chroma = 20 + 30 * flop;
  return {25 + 50 * flop, chroma * std::cos(hue), chroma * std::sin(hue)};
}

ColorMap interference_map(int size, double index) {
  const color::Xyz white = *color::white_point({"D65", 10});
  ColorMap map = color_map_of_size(size, index);
  for (int row = 0; row < 2 * size; ++row)
    for (int column = 0; column < size; ++column) {
      const MapDirections d = map_directions(size, column, row);
      // The colors are those of the coat whatever index the isolines are followed with.
      const color::Rgb color = color::rgb_from_lab(traveling_paint(flake_angles(d.light, d.view, 1.5)), white);
      for (int c = 0; c < 3; ++c) map.texel(column, row)[c] = static_cast<float>(color[c]);
    }
  return map;
}

// The points of a sphere seen from +z, in the frame of their normals, under light from `light`.
template <class Visit>
void each_lit_point(const Vec3& light, int size, const Visit& visit) {
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      const double u = 2 * (x + 0.5) / size - 1, v = 1 - 2 * (y + 0.5) / size;
      if (u * u + v * v >= 1) continue;
      const Vec3 n = {u, v, std::sqrt(1 - u * u - v * v)};
      if (dot(n, light) <= 0) continue;
      const Vec3 t = normalized(cross({0, 1, 0}, n)), b = cross(n, t);
      const auto local = [&](const Vec3& d) { return Vec3{dot(d, t), dot(d, b), dot(d, n)}; };
      visit(x, y, local(light), local({0, 0, 1}));
    }
  }
}

// [Kirchner] 1 to 8 as printed: whether an in-plane pair comes out.
bool printed_equations_answer(const Vec3& wi, const Vec3& wo) {
  const double s1 = std::hypot(wi.x, wi.y) / 1.5, s2 = std::hypot(wo.x, wo.y) / 1.5;
  const double c1 = std::sqrt(1 - s1 * s1), c2 = std::sqrt(1 - s2 * s2);
  const double mixed = (wi.x * wo.x + wi.y * wo.y) / 2.25 + c1 * c2;
  const double flake = std::acos((c1 + c2) / std::sqrt(2 + 2 * mixed)), incidence = 0.5 * std::acos(mixed);
  const double cos1 = std::cos(flake + incidence),
               sin1 = (std::cos(incidence) - std::cos(flake) * cos1) / std::sin(flake);
  const double cos2 = -cos1 + 2 * (std::sin(flake) * sin1 + std::cos(flake) * cos1) * std::cos(flake);
  return std::isfinite(std::asin(1.5 * sin1)) && std::isfinite(std::asin(1.5 * std::sin(std::acos(cos2))));
}

TEST(HardCase, IsolineCriticalSphereHasNoErrorPixels) {
  const color::Xyz white = *color::white_point({"D65", 10});
  int all_broken = 0, all_undefined = 0;
  for (const double from_viewer_deg : {10.0, 45.0, 75.0}) {
    const Vec3 light = {std::sin(from_viewer_deg * kDegree), 0, std::cos(from_viewer_deg * kDegree)};
    for (const CriticalAngle treatment : {CriticalAngle::kClip, CriticalAngle::kSlide, CriticalAngle::kIndexOne}) {
      const ColorMap map = interference_map(64, treatment == CriticalAngle::kIndexOne ? 1 : 1.5);
      int lit = 0, broken = 0, control = 0;
      double least_hue = 360, most_hue = 0, largest_step = 0;
      color::Lab left{};
      int left_x = -2;
      each_lit_point(light, 128, [&](int x, int, const Vec3& wi, const Vec3& wo) {
        const color::Rgb color = reflectance_factor(map, wi, wo, treatment);
        const color::Lab lab = color::lab_from_rgb(color, white);
        ++lit;
        broken += !std::isfinite(color.x + color.y + color.z) || lab.L < 20;
        control += !printed_equations_answer(wi, wo);
        least_hue = std::min(least_hue, color::hue_deg(lab)), most_hue = std::max(most_hue, color::hue_deg(lab));
        // Away from the outline, where a pixel turns the normal by a few degrees only.
        if (x == left_x + 1 && wo.z > 0.5) largest_step = std::max(largest_step, color::delta_e_76(lab, left));
        left = lab, left_x = x;
      });
      EXPECT_GT(lit, 4000);
      all_broken += broken, all_undefined += control;
      EXPECT_LT(largest_step, 8) << critical_angle_name(treatment);
      EXPECT_GT(most_hue - least_hue, 50) << "no hue gradient";
    }
  }
  // The control are the error pixels of the source's figure 4, more of them the further aside the light is.
  hard_case("isoline-critical", {.what = "spheres in interference paint, three treatments, light 10 to 75 deg aside",
                                 .textbook = static_cast<double>(all_undefined),
                                 .ours = static_cast<double>(all_broken),
                                 .bound = 0,
                                 .unit = "pixels"});
}

}  // namespace
}  // namespace goniochrome::brdf::color_map_test
