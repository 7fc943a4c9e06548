#include "mesh/unit.h"

#include <gtest/gtest.h>

#include <string>

namespace goniochrome::mesh::unit_test {
namespace {

// A box of the proportions of a car that is `length` long.
Box car(double length) {
  return {{0, 0, 0}, {0.4 * length, 0.33 * length, length}};
}

TEST(Unit, CarsAreRecognizedInEveryUnit) {
  for (const double length_m : {3.0, 4.5, 5.6}) {
    for (const double meters : {1.0, 0.0254, 1e-2, 1e-3}) {
      const LengthUnit unit = likely_unit(car(length_m / meters));
      EXPECT_EQ(unit.meters, meters) << length_m / meters;
      EXPECT_EQ(std::string(unit_of(meters).name), unit.name);
    }
  }
}

TEST(Unit, PanelsInMillimetersAndSmallThingsInMetersAreRecognized) {
  EXPECT_EQ(likely_unit(car(1100)).meters, 1e-3);
  EXPECT_EQ(likely_unit(car(0.12)).meters, 1);
  EXPECT_EQ(likely_unit(Box{}).meters, 1);
}

}  // namespace
}  // namespace goniochrome::mesh::unit_test
