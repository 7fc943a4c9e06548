#include "paint/paint.h"

#include <algorithm>
#include <array>

#include "base/angles.h"
#include "base/text.h"

namespace goniochrome::paint {

namespace {

constexpr std::array kClassNames = {"unknown", "solid", "metallic", "pearl", "interference"};

}  // namespace

double Flakes::per_m2() const {
  const double radius_m = diameter_um / 2e6;
  return coverage / (kPi * radius_m * radius_m);
}

std::optional<KnownFlakes> known_flakes(const Paint& paint) {
  if (paint.flakes) return KnownFlakes{*paint.flakes, false};
  switch (paint.paint_class) {
    case PaintClass::kMetallic:
      return KnownFlakes{{30, 0.5, 0.5}, true};
    case PaintClass::kPearl:
    case PaintClass::kInterference:
      return KnownFlakes{{20, 0.3, 0.5}, true};
    default:
      return std::nullopt;
  }
}

std::string flakes_text(const Paint& paint, const KnownFlakes& known) {
  const Flakes& flakes = known.flakes;
  return fmt::format("{} um, coverage {}, spread {} deg{}", shortest(flakes.diameter_um), shortest(flakes.coverage),
                     shortest(flakes.spread_deg),
                     known.assumed ? fmt::format(" (assumed for class {})", paint_class_name(paint.paint_class)) : "");
}

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
