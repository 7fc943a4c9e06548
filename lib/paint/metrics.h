// What can be said of a paint in one number each: how much it travels in lightness, chroma and hue, its gloss, how well
// the curve describes it, how far it lies outside the working space. [Shimizu2009] 5.3.3; goniochrome-theory(7),
// PAINT METRICS.
#pragma once

#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "paint/paint.h"

namespace goniochrome::paint {

// Below this chroma a hue is noise, and what rests on a hue is not applicable.
constexpr double kLeastChroma = 1;

// A flop index that moves by more than this when its L* move by 0.1 is flagged.
constexpr double kLargestFlopSensitivity = 1;

// Flop index (Alman), 2.69 (L15 - L110)^1.11 / L45^0.86, and its sensitivity: the largest change when each L* moves by
// up to 0.1 either way. A flop lighter than the face gives the negative of the mirrored value; 0 for equal ends. L45
// <= 0: the index is NaN. L45 <= 0.1: the sensitivity is infinite.
struct FlopIndex {
  double value = 0, sensitivity = 0;
  bool unstable() const { return !(sensitivity <= kLargestFlopSensitivity); }
};
FlopIndex flop_index(double L15, double L45, double L110);

// Change of chroma from face to flop, CIELAB units, >= 0. [Shimizu2009] 5.3.2
double chroma_index(const color::Lab& at_15, const color::Lab& at_110);

// Distance of the flop's a*b* from the line through the origin and the face's a*b*, CIELAB units. NaN where the face is
// achromatic. Blind to a hue turned by 180 deg. [Shimizu2009] 5.3.3, with its domain
double hue_shift_index(const color::Lab& at_15, const color::Lab& at_110);

// The angle (deg, signed, counterclockwise positive, beyond 180 where the path winds on) by which the hue turns along
// straight steps through the a*b* of `path`. NaN where either end is achromatic or the path has fewer than two colors.
// `through_gray` where a step passes the gray axis so closely that the sense of turning is noise.
struct HueTravel {
  double degrees = 0;
  bool through_gray = false;
};
HueTravel hue_travel(std::span<const color::Lab> path);

// Everything at once. NaN is "not applicable"; `flags` says why where it is not plain.
struct PaintMetrics {
  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  double flop_index = kNone, flop_sensitivity = kNone;
  double chroma_index = kNone, hue_shift_index = kNone, hue_travel_deg = kNone;
  double gloss = kNone, gloss_angle_deg = kNone;
  double travel_deg = kNone, residual_de00 = kNone, gamut_de00 = kNone;
  double L15 = kNone, L45 = kNone, L110 = kNone, chroma15 = kNone, hue15_deg = kNone;

  // Where the colors at 15, 45 and 110 deg come from: the measured rows, the stated curve, or a curve fitted to rows.
  enum class Source { kNone, kRows, kCurve, kFitted } source = Source::kNone;
  // "dark" (flop index unstable), "achromatic" (face without hue), "through_gray", "gamut" (loss above 1), "no_color".
  std::vector<const char*> flags;
};

// Whether a curve is fitted to every paint that states none (some 10 us), or only where the indices cannot be had
// without it. Without a fit such a paint has no travel and no residual.
enum class CurveFit { kAlways, kWhereNeeded };

// Error: a viewing condition without a known white point.
Result<PaintMetrics> metrics(const Paint& paint, CurveFit fit = CurveFit::kAlways);

const char* source_name(PaintMetrics::Source source);

// The numbers of PaintMetrics by name, in the order of tables; those that may take a fit stand last.
struct MetricColumn {
  const char* name;
  double PaintMetrics::*value;
  const char* meaning;
};
std::span<const MetricColumn> metric_columns();
std::span<const MetricColumn> metric_columns_without_fit();

// The column of that name, or null.
const MetricColumn* find_metric(std::string_view name);

}  // namespace goniochrome::paint
