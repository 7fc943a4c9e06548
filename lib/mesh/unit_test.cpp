#include "mesh/unit.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>

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

// A unit that a file states was guessed from the size of the mesh.
TEST(Unit, CommentsStateIt) {
  const std::pair<const char*, double> files[] = {
      {"# Alias OBJ Model File\r\n# File units = inches\r\nv 0 0 0\n", 0.0254},
      {"# units: MM\nv 0 0 0\n", 1e-3},
      {"# Units : feet\n", 0.3048},
      {"# 12 units tall\n# units = unknown\nv 0 0 0\n", 0},
      {"v 0 0 0\n# units = mm\n", 0},
      {"ply\nformat ascii 1.0\ncomment unit: cm\nelement vertex 3\n", 1e-2},
      {"UNITS=mm  COLOR=\1\1\1", 1e-3},
      {"solid x units = m\nfacet", 1}};
  for (const auto& [text, meters] : files) EXPECT_EQ(stated_unit_m(text), meters) << text;
  for (const double meters : {1.0, 0.3048, 0.0254, 1e-2, 1e-3}) EXPECT_EQ(unit_of(meters).meters, meters);
}

}  // namespace
}  // namespace goniochrome::mesh::unit_test
