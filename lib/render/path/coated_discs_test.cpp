// Lamps that are discs, seen by a base that lies under a coat: their light passes the coat on its way in and out.
#include <gtest/gtest.h>

#include <cmath>

#include "base/angles.h"
#include "brdf/lobe_model.h"
#include "render/path/lobe_columns.h"
#include "render/path/traced_paint.h"

namespace goniochrome::render::coated_discs_test {
namespace {

// The mean of a function over the disc, with the weights of its solid angle.
template <class Function>
double over_disc(const Light& light, const Function& function) {
  constexpr int kSteps = 120;
  const double half = std::sin(0.5 * light.radius_rad), sine = std::sin(light.radius_rad);
  double sum = 0;
  for (int i = 0; i < kSteps; ++i)
    for (int j = 0; j < kSteps; ++j)
      sum += function(rays::float3(disc_direction(light, (i + 0.5) / kSteps, (j + 0.5) / kSteps)));
  return 4 * half * half / (sine * sine) * sum / (kSteps * kSteps);
}

// Under a lamp as narrow as the sun the integral over the disc is that of its middle; without the passages in, a base
// is 4 % too bright where light falls straight, and 26 % at 75 deg. Wide discs have their coat at the mean cosine
// alone.
TEST(CoatedDiscs, LoseWhatTheCoatTakes) {
  paint::LobeFit paint;
  paint.coat_index = 1.5;
  paint.diffuse = {0.2, 0.2, 0.2};
  paint.lobes = {{8, {0.3, 0.3, 0.3}, {}}, {60, {0.5, 0.5, 0.5}, {}}};
  const TracedPaint traced = TracedPaint::create(paint, 45, {}).value();
  paint::LobeFit bare = paint;
  bare.coat_index = paint::kNoCoat;
  const TracedPaint uncoated = TracedPaint::create(bare, 45, {}).value();
  const LobeColumns columns{{8, 60}};
  const rays::Float3 normal{0, 0, 1};
  double control = 0;
  for (const double view_deg : {5.0, 40.0, 70.0}) {
    const rays::Float3 viewer = rays::float3({std::sin(view_deg * kDegree), 0, std::cos(view_deg * kDegree)});
    const PaintedPoint point(traced, normal, viewer);
    for (const double light_deg : {0.0, 30.0, 60.0, 75.0}) {
      for (const auto& [radius_rad, tolerance] : {std::pair{0.0047, 1e-3}, std::pair{0.15, 0.02}}) {
        Light light;
        light.direction = {-std::sin(light_deg * kDegree), 0, std::cos(light_deg * kDegree)};
        light.radius_rad = radius_rad;
        const double truth = over_disc(light, [&](const rays::Float3& d) { return point.at(d).f_cos.y; });
        EXPECT_NEAR(point.toward_disc(light).y, truth, tolerance * truth) << view_deg << " " << light_deg;
        // Beside the narrow lamp a paint without a coat, which is what was once drawn but for the way out.
        if (radius_rad < 0.01) {
          const double let_out = brdf::coat_transmission(std::cos(view_deg * kDegree), 1.5);
          control =
              std::max(control, let_out * PaintedPoint(uncoated, normal, viewer).toward_disc(light).y / truth - 1);
        }
        const PaintedPoint basis = point.of_basis(columns.exponents);
        const PaintedPoint::Shares values = basis.disc_shares(light);
        ASSERT_GT(values.diffuse(), 0);
        for (const std::size_t column : {LobeColumns::diffuse(), LobeColumns::flake(0), LobeColumns::flake(1)}) {
          const double expected =
              over_disc(light, [&](const rays::Float3& d) { return static_cast<double>(basis.shares(d).of[column]); });
          // The table of discs is within 2e-6 of a lobe's peak.
          EXPECT_NEAR(values.of[column], expected, tolerance * expected + 1e-5)
              << view_deg << " " << light_deg << " " << column;
        }
      }
    }
  }
  EXPECT_GT(control, 0.2);
}

}  // namespace
}  // namespace goniochrome::render::coated_discs_test
