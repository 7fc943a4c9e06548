#include "sketch/dropper.h"

#include <gtest/gtest.h>

namespace goniochrome::sketch::dropper_test {
namespace {

// sRGB signals and the CIELAB under D65 and the 2 deg observer that is published for them; the working space is seen by
// the 10 deg observer, whose gray axis is the same, so that grays are compared.
TEST(Dropper, GraysHaveTheLightnessOfTheirSignal) {
  // IEC 61966-2-1: the signal 119/255 is a light of .18448, whose L* is 50.03.
  const DropperColor gray = dropper_color({light_of_srgb(119.0 / 255, 119.0 / 255, 119.0 / 255)});
  EXPECT_NEAR(gray.lab.L, 50.03, 0.01);
  EXPECT_NEAR(gray.lab.a, 0, 1e-3);
  EXPECT_NEAR(gray.lab.b, 0, 1e-3);
  EXPECT_NEAR(dropper_color({light_of_srgb(1, 1, 1)}).lab.L, 100, 1e-3);
  EXPECT_EQ(dropper_color({light_of_srgb(0, 0, 0)}).lab.L, 0);
}

// The mean of a checker is the mean of its lights and not of its signals; the control, the mean signal, is L* 53.4.
TEST(Dropper, LightIsAveragedAndNotSignals) {
  const DropperColor checker = dropper_color({light_of_srgb(0, 0, 0), light_of_srgb(1, 1, 1)});
  EXPECT_NEAR(checker.lab.L, 76.07, 0.01);  // of half the light
  EXPECT_EQ(checker.gloss, 100);
  EXPECT_EQ(dropper_color({light_of_srgb(0.3, 0.3, 0.3), light_of_srgb(0.3, 0.3, 0.3)}).gloss, 0);
}

}  // namespace
}  // namespace goniochrome::sketch::dropper_test
