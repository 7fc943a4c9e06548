#include "render/path/summed_light.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "brdf/lobe_model.h"
#include "render/exact.h"
#include "render/integral/integral_engine.h"

namespace goniochrome::render::summed_light_test {
namespace {

const LobeColumns kColumns{{1.3, 20, 300}};  // the last lobe is none of the wide ones

// A bright horizon over dark ground, a colored window, and a lamp.
envmap::Environment dusk() {
  image::Image image{64, 32, 3, {}, {}};
  for (int row = 0; row < 32; ++row)
    for (int column = 0; column < 64; ++column) {
      const bool lamp = row == 6 && column == 40, window = row > 10 && row < 15 && column < 8;
      const float sky = row < 16 ? 0.2F + 0.1F * static_cast<float>(row) : 0.08F;
      const float value = lamp ? 200 : sky;
      image.data.insert(image.data.end(), {window ? 4 : value, value, window ? 0 : value});
    }
  return *envmap::Environment::from_lat_long(std::move(image), envmap::Environment::BadPixels::kError, "made");
}

// The columns of a point as the engine integral sums them over the same blocks, of one paint for each.
std::vector<color::Rgb> integrated(const Surroundings& around, const Vec3& n, const Vec3& wo, double coat_index) {
  const color::Rgb one{1, 1, 1};
  ExactModel model;
  model.fresnel = true;
  const double reflectance = brdf::fresnel_dielectric(std::cos(model.gloss_deg * kDegree), brdf::kCoatIndex);
  paint::LobeFit blank;
  blank.coat_index = coat_index;
  blank.lobes = {{kColumns.exponents[0], {}, {}}, {kColumns.exponents[1], {}, {}}};
  std::vector<paint::LobeFit> paints(5, blank);
  paints[0].diffuse = one;
  for (std::size_t j = 0; j < 2; ++j) {
    paints[LobeColumns::flake(j)].lobes[j].directional_diffuse = one;
    paints[LobeColumns::gloss(j)].lobes[j].gloss = reflectance * one;
  }
  std::vector<SurfacePoint> points;
  for (const paint::LobeFit& paint : paints) points.push_back({n, wo, &paint, &model});
  return reference_radiance(points, around, {});
}

// The largest error of a column over normals and views that look everywhere, relative to that column.
double largest_difference(double tolerance_de00, double wanted_de00, double coat_index) {
  const envmap::Environment env = dusk();
  const envmap::BlockTree tree(env);
  const SummedLight summed(tree, tolerance_de00, kColumns);
  const Surroundings around(tree, spread_for(wanted_de00));
  double largest = 0;
  int points = 0;
  for (const double y : {-0.9, -0.4, 0.0, 0.5, 0.9}) {
    for (const double cos_o : {0.1, 0.5, 0.95}) {
      const double turn = 2.4 * points++;
      const Vec3 n{std::sqrt(1 - y * y) * std::cos(turn), y, std::sqrt(1 - y * y) * std::sin(turn)};
      const Vec3 wo = cos_o * n + std::sqrt(1 - cos_o * cos_o) * normalized(cross(n, {0.3, 0.1, 1}));
      std::vector<color::Rgb> got(kColumns.count(), {-1, -1, -1});
      summed.at(n, wo, {{2 * cos_o * n - wo, 1}}, coat_index, got.data());
      const std::vector<color::Rgb> wanted = integrated(around, n, wo, coat_index);
      for (std::size_t k = 0; k < wanted.size(); ++k)
        for (int c = 0; c < 3; ++c) largest = std::max(largest, std::abs(got[k][c] / wanted[k][c] - 1));
      EXPECT_EQ(got[5], (color::Rgb{-1, -1, -1})) << "a column of a sharp lobe was written";
    }
  }
  return largest;
}

// In double precision. The control: coarser blocks.
TEST(SummedLight, IsWhatTheEngineIntegralSums) {
  for (const double coat_index : {paint::kNoCoat, brdf::kCoatIndex}) {
    EXPECT_LT(largest_difference(0.5, 0.5, coat_index), 1e-9);
    EXPECT_GT(largest_difference(4, 0.5, coat_index), 1e-3);
  }
}

}  // namespace
}  // namespace goniochrome::render::summed_light_test
