#include "fit/brdf_target.h"

#include <gtest/gtest.h>

#include "base/angles.h"
#include "brdf/lobe_model.h"

namespace goniochrome::fit::brdf_target_test {
namespace {

// A BRDF that is equal in all directions.
class Gray final : public brdf::MeasuredBrdf {
 public:
  explicit Gray(double reflectance) : brdf::MeasuredBrdf({.format = "test"}), f_(reflectance / kPi) {}
  brdf::MeasuredValue value(const Vec3&, const Vec3&) const override { return {.f = {f_, f_, f_}}; }

 private:
  double f_;
};

TEST(AlbedoError, OfConstantsIsTheirDifference) {
  const auto model = [](const Vec3&, const Vec3&) { return color::Rgb{0.3 / kPi, 0.3 / kPi, 0.3 / kPi}; };
  EXPECT_NEAR(**albedo_error(Gray(0.3), model), 0, 1e-12);
  EXPECT_NEAR(**albedo_error(Gray(0.5), model), 0.2, 0.2 * 0.02);
  EXPECT_NEAR(**albedo_error(Gray(0.1), model), 0.2, 0.2 * 0.02);
  // Files hold negative noise, which no light is.
  EXPECT_NEAR(**albedo_error(Gray(-0.1), model), 0.3, 0.3 * 0.02);
}

TEST(AlbedoError, OfASharpLobeIsItsAlbedo) {
  // cos^E/cos_i reflects 2 pi/(E+1) up to the change of cos_o across it and what is below the horizon.
  constexpr double kExponent = 2000;
  paint::LobeFit lobe;
  lobe.lobes = {{kExponent, {}, {1, 1, 1}}};
  const auto model = [&](const Vec3& light, const Vec3& view) { return brdf::brdf(lobe, light, view, {0, 0, 1}); };
  EXPECT_NEAR(**albedo_error(Gray(0), model), 2 * kPi / (kExponent + 1), 0.02 * 2 * kPi / (kExponent + 1));
}

}  // namespace
}  // namespace goniochrome::fit::brdf_target_test
