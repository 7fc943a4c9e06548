// Plots as SVG: lines and points on linear or logarithmic axes, which stay readable on paper. All tools and reports
// draw their plots with this.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace goniochrome::report {

struct Tick {
  double at = 0;
  std::string label;
};

struct Axis {
  std::string label;                          // with its unit: "aspecular angle (deg)"
  bool logarithmic = false;                   // then only values > 0 are drawn
  std::optional<double> low = {}, high = {};  // taken from the data where they are not given
  std::vector<Tick> ticks = {};               // none: round numbers
};

struct Series {
  std::string label = {};              // in the legend; empty: not listed
  std::vector<double> x = {}, y = {};  // a y (or x) that is not finite breaks the line
  enum class Style { kLine, kPoints, kLineAndPoints, kDashed, kRings } style = Style::kLine;
  // A CSS color. Empty: the next color of a palette that color-blind readers can tell apart; when all of its colors
  // have been used, they come again with hollow points.
  std::string color = {};
};

struct Plot {
  std::string title = {};
  Axis x, y;
  std::vector<Series> series = {};
  int width = 640, height = 400;  // of the whole picture, in px
};

// SVG elements with their upper left corner at the origin.
struct Drawing {
  int width = 0, height = 0;
  std::string body = {};
};
Drawing drawing(const Plot& plot);

// An SVG document of one plot, or of several plots or drawings in rows of `columns`.
std::string svg(const Plot& plot);
std::string svg(const std::vector<Plot>& plots, int columns);
std::string svg(const std::vector<Drawing>& drawings, int columns);

// One drawing that shows the given ones side by side, or one below the other.
Drawing row_of(const std::vector<Drawing>& drawings);
Drawing column_of(const std::vector<Drawing>& drawings);

// The values at which an axis from low to high is labeled: about `count` multiples of 1, 2 or 5 times a power of ten.
// On a logarithmic axis they are the powers of ten, and 2 and 5 times these where the powers alone would be few.
std::vector<double> ticks(double low, double high, bool logarithmic, int count);

}  // namespace goniochrome::report
