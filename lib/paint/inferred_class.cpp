#include "paint/inferred_class.h"

#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "paint/curve.h"

namespace goniochrome::paint {

namespace {

// The limits were set by 241 panels of refinish solids, the measured BRDFs of MERL, Cornell and RGL, and designed
// paints; between them lie paints that readings alone do not tell apart.
constexpr double kSolidFlop = 2.5, kSolidTurn = 6, kSolidDark = 10;
constexpr double kWhite_L = 80, kWhiteChroma = 20, kWhiteChromaIndex = 2.5;
constexpr double kMetallicFlop = 8, kMetallicTurn = 10, kMetallicFace_L = 40;
constexpr double kPearlFlop[] = {3, 7.5}, kPearlChroma = 15;
constexpr double kSteadyHue_deg = 25, kTurningHue_deg = 45, kTurningChroma = 10;
constexpr double kSparkle = 1;

std::optional<color::Lab> color_at(const Paint& paint, double aspecular_deg) {
  if (paint.measurement)
    for (const LabReading& row : paint.measurement->rows)
      if (row.geometry == Geometry{.aspecular_deg = aspecular_deg}) return row.lab;
  if (paint.appearance) return lab_at(*paint.appearance, aspecular_deg);
  return std::nullopt;
}

bool sparkles(const Paint& paint) {
  return paint.measurement && std::ranges::any_of(paint.measurement->textures, [](const TextureReading& texture) {
           return lower(texture.quantity).find("sparkle") != std::string::npos && texture.value > kSparkle;
         });
}

bool has_flag(const PaintMetrics& numbers, std::string_view flag) {
  return std::ranges::any_of(numbers.flags, [&](const char* each) { return each == flag; });
}

}  // namespace

std::optional<PaintClass> inferred_class(const Paint& paint, const PaintMetrics& n) {
  const auto at_15 = color_at(paint, 15), at_45 = color_at(paint, 45), at_110 = color_at(paint, 110);
  if (!at_15 || !at_45 || !at_110) return std::nullopt;
  const double turn = color::delta_e_76(*at_45, *at_110), flop = n.flop_index;
  const bool steady =
      !(std::abs(n.hue_travel_deg) > kSteadyHue_deg) || (has_flag(n, "through_gray") && n.chroma15 < kTurningChroma);
  if (turn <= kSolidTurn && !sparkles(paint)) {
    const bool light_pearl =
        at_45->L > kWhite_L && (at_15->L > 100 || (n.chroma15 < kWhiteChroma && n.chroma_index > kWhiteChromaIndex));
    const bool flat = std::abs(flop) <= kSolidFlop || at_15->L <= kSolidDark;
    if (flat && !light_pearl) return PaintClass::kSolid;
    return std::nullopt;
  }
  const double least_chroma = std::min(color::chroma(*at_15), color::chroma(*at_110));
  if (std::abs(n.hue_travel_deg) >= kTurningHue_deg && !has_flag(n, "through_gray") && least_chroma >= kTurningChroma)
    return PaintClass::kInterference;
  if (!steady || has_flag(n, "dark")) return std::nullopt;
  if (flop >= kMetallicFlop && turn >= kMetallicTurn && at_15->L >= kMetallicFace_L) return PaintClass::kMetallic;
  if (flop >= kPearlFlop[0] && flop <= kPearlFlop[1] && n.chroma15 >= kPearlChroma) return PaintClass::kPearl;
  return std::nullopt;
}

}  // namespace goniochrome::paint
