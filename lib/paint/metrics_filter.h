// Conditions on paints: `flop_index>=17 && (class==metallic or chroma_index<5)`.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "paint/metrics.h"

namespace goniochrome::paint {

// An expression over the numbers of metric_columns() and the texts name, code, class, source and flags.
// Comparisons: < <= > >= == !=. A text is compared by == and != alone, with a bare word or a quoted text; flags==dark
// asks whether that flag is among them. Joined by && || ! (or: and, or, not) and parentheses. A number that is not
// applicable makes every comparison false but name==na, so `not (hue_shift_index<3)` keeps the paints without one.
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

// `flop_index=3:10`: a metric between two bounds, both included, either left out for none.
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
