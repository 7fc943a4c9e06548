// A paint in numbers: how much its lightness, chroma and hue change from face to flop, its gloss, how well the curve
// describes it, and how far it lies outside the working space; and conditions on these numbers, such as
// `flop_index>=17 && (class==metallic or chroma_index<5)`. [Shimizu2009] 5.3.3; goniochrome-paint(7), "PAINT METRICS".
#pragma once

#include <functional>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "paint/paint.h"

namespace goniochrome::paint {

// Below this chroma a hue is noise, and whatever depends on a hue does not apply.
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

// Distance of the flop's a*b* from the line through the origin and the face's a*b*, CIELAB units. NaN if the face is
// achromatic. A hue that turns by 180 deg gives 0. [Shimizu2009] 5.3.3, with its domain
double hue_shift_index(const color::Lab& at_15, const color::Lab& at_110);

// The angle by which the hue turns along straight steps through the a*b* of `path`, in degrees, counterclockwise
// positive, and more than 180 if the path winds on. NaN if either end is achromatic or the path has fewer than two
// colors. `through_gray`: a step passes the gray axis so closely that the sense of turning is noise.
struct HueTravel {
  double degrees = 0;
  bool through_gray = false;
};
HueTravel hue_travel(std::span<const color::Lab> path);

// All numbers of a paint. NaN means "does not apply"; `flags` says why, if that is not obvious.
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

// Fits a curve to every paint that states none (this takes some 10 us), or only where the indices need it. Without a
// fit such a paint has no travel and no residual.
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

// A condition on the numbers of metric_columns() and on the texts name, code, class, source and flags. The comparisons
// are < <= > >= == !=. A text is only compared by == and !=, with a word or a quoted text; flags==dark asks whether
// that flag is among them. Comparisons are joined by && || ! (or: and, or, not) and parentheses. If a number does not
// apply, every comparison with it is false except name==na, so `not (hue_shift_index<3)` keeps the paints without one.
class PaintFilter {
 public:
  using Test = std::function<bool(const Paint&, const PaintMetrics&)>;

  // Error (kUsage): the place, what stands there and what was expected.
  static Result<PaintFilter> parse(std::string_view expression);
  bool matches(const Paint& paint, const PaintMetrics& numbers) const { return test_(paint, numbers); }

 private:
  explicit PaintFilter(Test test) : test_(std::move(test)) {}
  Test test_;
};

// A metric between two bounds, both included, as in `flop_index=3:10`. Either bound may be left out.
struct MetricRange {
  const MetricColumn* column = nullptr;
  double low = 0, high = 0;
  bool contains(double value) const { return value >= low && value <= high; }
};
// Error (kUsage): the text and what would be right.
Result<MetricRange> parse_metric_range(std::string_view text);

// "; did you mean flop_index?" or the list of all, for a metric that does not exist.
std::string metric_advice(std::string_view unknown);

}  // namespace goniochrome::paint
