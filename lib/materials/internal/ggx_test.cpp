#include "materials/internal/ggx.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/angles.h"
#include "materials/internal/shown.h"

namespace goniochrome::materials::ggx_test {
namespace {

// The sum over all lights, midpoints of 1 deg by 2 deg, which resolves a roughness of 0.25 and more to 1e-3.
TEST(Ggx, ItsAlbedoIsTheSumOverAllLights) {
  for (const double alpha : {0.25, 0.5, 1.0})
    for (const double view_deg : {0.0, 40.0, 70.0}) {
      const Vec3 view = direction(view_deg * kDegree, 0);
      double all = 0, grazing = 0;
      for (int i = 0; i < 90; ++i)
        for (int j = 0; j < 180; ++j) {
          const Vec3 light = direction((i + 0.5) * kDegree, (2 * j + 1) * kDegree);
          const double share =
              ggx(alpha, light, view) * light.z * std::sin((i + 0.5) * kDegree) * kDegree * 2 * kDegree;
          all += share;
          grazing += share * schlick(half_cosine(light, view));
        }
      const FacetAlbedo albedo = facet_albedo(alpha, view.z);
      EXPECT_NEAR(albedo.all, all, 3e-3) << alpha << " at " << view_deg;
      EXPECT_NEAR(albedo.grazing, grazing, 3e-3) << alpha << " at " << view_deg;
    }
}

TEST(Ggx, TheTableIsNearTheSum) {
  for (double alpha = 0.003; alpha < 1; alpha *= 1.7)
    for (double cosine = 0.15; cosine < 1; cosine += 0.07) {
      EXPECT_NEAR(quick_facet_albedo(alpha, cosine).all, facet_albedo(alpha, cosine).all, 5e-3)
          << alpha << " " << cosine;
      EXPECT_NEAR(quick_facet_albedo(alpha, cosine).grazing, facet_albedo(alpha, cosine).grazing, 5e-3);
    }
}

TEST(Ggx, TheMeanIsThatOfAllViewers) {
  for (double alpha = 0.003; alpha < 1; alpha *= 1.7) {
    FacetAlbedo sum{0, 0};
    for (int j = 0; j < 500; ++j) {
      const double cosine = (j + 0.5) / 500;
      const FacetAlbedo albedo = facet_albedo(alpha, cosine);
      sum.all += albedo.all * cosine / 250, sum.grazing += albedo.grazing * cosine / 250;
    }
    EXPECT_NEAR(quick_facet_average(alpha).all, sum.all, 5e-3) << alpha;
    EXPECT_NEAR(quick_facet_average(alpha).grazing, sum.grazing, 5e-3) << alpha;
  }
}

TEST(Ggx, IsReciprocal) {
  const Vec3 a = direction(0.3, 0.2), b = direction(1.1, 2.5);
  EXPECT_DOUBLE_EQ(ggx(0.3, a, b), ggx(0.3, b, a));
}

TEST(Ggx, SharpFacetsAreAMirror) {
  EXPECT_NEAR(facet_albedo(1e-3, 0.5).all, 1, 1e-3);
  EXPECT_NEAR(facet_albedo(1e-3, 0.5).grazing, schlick(0.5), 1e-3);
  EXPECT_EQ(facet_albedo(0, 0.5).all, 1);
}

}  // namespace
}  // namespace goniochrome::materials::ggx_test
