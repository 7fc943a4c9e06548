#include "paint/paint.h"

#include <algorithm>
#include <array>

namespace goniochrome::paint {

namespace {

constexpr std::array kClassNames = {"unknown", "solid", "metallic", "pearl", "interference"};

}  // namespace

const char* paint_class_name(PaintClass paint_class) {
  return kClassNames[static_cast<std::size_t>(paint_class)];
}

std::optional<PaintClass> paint_class_of(std::string_view name) {
  const auto found = std::ranges::find(kClassNames, name);
  if (found == kClassNames.end()) return std::nullopt;
  return static_cast<PaintClass>(found - kClassNames.begin());
}

color::ViewingCondition condition_of(const Paint& paint) {
  return paint.measurement ? paint.measurement->condition : color::ViewingCondition{};
}

}  // namespace goniochrome::paint
