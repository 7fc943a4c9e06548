#include "mesh/unit.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace goniochrome::mesh {

namespace {

constexpr LengthUnit kMeters = {"meters", 1}, kInches = {"inches", 0.0254}, kCentimeters = {"centimeters", 1e-2},
                     kMillimeters = {"millimeters", 1e-3};

}  // namespace

LengthUnit likely_unit(const Box& box) {
  const double size = length(box.high - box.low);
  return size <= 30 ? kMeters : size <= 300 ? kInches : size <= 900 ? kCentimeters : kMillimeters;
}

LengthUnit length_unit(const Mesh& mesh) {
  return mesh.unit_m > 0 ? unit_of(mesh.unit_m) : likely_unit(bounding_box(mesh));
}

LengthUnit unit_of(double meters) {
  constexpr std::array kAll = {kMeters, kInches, kCentimeters, kMillimeters};
  return *std::ranges::min_element(kAll, {}, [&](const LengthUnit& u) { return std::abs(u.meters - meters); });
}

}  // namespace goniochrome::mesh
