#include "render/internal/lobe_curves.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "base/vec3.h"
#include "brdf/lobe_model.h"

namespace goniochrome::render::lobe_curves_test {
namespace {

// The whole integral over the hemisphere by a plain sum of many directions, as the failing control's yardstick.
LobeIntegrals summed(double exponent, double cos_o, double coat_index = paint::kNoCoat) {
  constexpr int kRings = 2000, kAround = 400;
  const double sin_o = std::sqrt(1 - cos_o * cos_o);
  const Vec3 wo{sin_o, 0, cos_o}, r{-sin_o, 0, cos_o};
  LobeIntegrals sum;
  for (int i = 0; i < kRings; ++i) {
    const double z = (i + 0.5) / kRings, s = std::sqrt(1 - z * z);
    for (int j = 0; j < kAround; ++j) {
      const double phi = 2 * kPi * (j + 0.5) / kAround;
      const Vec3 w{s * std::cos(phi), s * std::sin(phi), z};
      const double power = std::pow(std::max(0.0, dot(r, w)), exponent) * 2 * kPi / kRings / kAround;
      sum.cosine += power * z * brdf::coat_transmission(z, coat_index);
      sum.plain += power;
      sum.fresnel += power * brdf::fresnel_dielectric(length(w + wo) / 2, brdf::kCoatIndex);
    }
  }
  return sum;
}

TEST(LobeCurves, HorizonIntegralsAreThoseOfTheHemisphere) {
  bool apart = false;
  for (const double exponent : {1.3, 6.0, 40.0, 100.0}) {
    for (const double cos_o : {0.02, 0.2, 0.5, 0.8, 1.0}) {
      const LobeIntegrals wanted = summed(exponent, cos_o), got = lobe_integrals(exponent, cos_o, true);
      const LobeIntegrals textbook = lobe_integrals(exponent, cos_o, false);
      EXPECT_NEAR(got.cosine / wanted.cosine, 1, 3e-3) << exponent << " " << cos_o;
      EXPECT_NEAR(got.plain / wanted.plain, 1, 3e-3) << exponent << " " << cos_o;
      EXPECT_NEAR(got.fresnel / wanted.fresnel, 1, 1e-2) << exponent << " " << cos_o;
      apart |= textbook.plain / wanted.plain > 1.5;
    }
  }
  EXPECT_TRUE(apart) << "the whole lobe would have been wrong somewhere";
}

// The control is what the coat lets in from the mirror direction alone, for all of the lobe.
TEST(LobeCurves, ACoatLetsInLessFromGrazingDirections) {
  bool apart = false;
  for (const double exponent : {1.3, 6.0, 40.0, 100.0}) {
    for (const double cos_o : {0.02, 0.2, 0.5, 0.8, 1.0}) {
      const double wanted = summed(exponent, cos_o, 1.5).cosine;
      EXPECT_NEAR(lobe_integrals(exponent, cos_o, true, 1.5).cosine / wanted, 1, 3e-3) << exponent << " " << cos_o;
      apart |= std::abs(lobe_integrals(exponent, cos_o, true).cosine * brdf::coat_transmission(cos_o, 1.5) / wanted -
                        1) > 0.1;
    }
  }
  EXPECT_TRUE(apart);
}

}  // namespace
}  // namespace goniochrome::render::lobe_curves_test
