#include "materials/internal/enterprise_model.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/angles.h"

namespace goniochrome::materials::enterprise_model_test {
namespace {

// The share of even light that goes to a viewer, by midpoints of 1 deg by 2 deg.
double reflected(const OneLobe& p, const Vec3& view) {
  double sum = 0;
  for (int i = 0; i < 90; ++i)
    for (int j = 0; j < 180; ++j) {
      const Vec3 light = direction((i + 0.5) * kDegree, (2 * j + 1) * kDegree);
      sum += enterprise_seen(p, light, view).y * light.z * std::sin((i + 0.5) * kDegree) * kDegree * 2 * kDegree;
    }
  return sum;
}

OneLobe white(double roughness, double specular, double metalness) {
  OneLobe p;
  p.base = {1, 1, 1}, p.specular = {specular, specular, specular};
  p.roughness = roughness, p.metalness = metalness;
  return p;
}

// Facets return the light that they lose, and the diffuse part takes the rest, so that white is white in even light, as
// the furnace of the specification shows.
TEST(EnterpriseModel, WhiteReflectsAllLight) {
  for (const double roughness : {0.6, 0.9})
    for (const double view_deg : {0.0, 40.0, 70.0}) {
      const Vec3 view = direction(view_deg * kDegree, 0);
      EXPECT_NEAR(reflected(white(roughness, 0.04 / 0.9, 0), view), 1, 0.01) << roughness << " at " << view_deg;
      EXPECT_NEAR(reflected(white(roughness, 0.5, 0), view), 1, 0.01) << roughness << " at " << view_deg;
      EXPECT_NEAR(reflected(white(roughness, 0.04, 1), view), 1, 0.01) << roughness << " at " << view_deg;
    }
}

TEST(EnterpriseModel, WithoutSpecularIsLambert) {
  OneLobe p = white(0.5, 0.5, 0);
  p.base = {0.2, 0.4, 0.6}, p.strength = 0;
  const color::Rgb f = enterprise_seen(p, direction(0.5, 1), direction(1, 0));
  EXPECT_NEAR(kPi * f.x, 0.2, 1e-12);
  EXPECT_NEAR(kPi * f.z, 0.6, 1e-12);
}

TEST(EnterpriseModel, IsReciprocal) {
  OneLobe p = white(0.4, 0.3, 0.3);
  p.clearcoat = 1, p.clearcoat_roughness = 0.2;
  const Vec3 a = direction(0.3, 0.2), b = direction(1.1, 2.5);
  EXPECT_NEAR(enterprise_seen(p, a, b).x, enterprise_seen(p, b, a).x, 1e-12);
}

}  // namespace
}  // namespace goniochrome::materials::enterprise_model_test
