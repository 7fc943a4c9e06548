// Plots as SVG: lines and points on linear or logarithmic axes, readable on paper. Every tool and report draws with
// this.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace goniochrome::report {

struct Axis {
  std::string label;                          // with its unit: "aspecular angle (deg)"
  bool logarithmic = false;                   // then only values > 0 are drawn
  std::optional<double> low = {}, high = {};  // from the data where not given
};

struct Series {
  std::string label = {};              // in the legend; empty: not listed
  std::vector<double> x = {}, y = {};  // a y (or x) that is not finite breaks the line
  enum class Style { kLine, kPoints, kLineAndPoints, kDashed, kRings } style = Style::kLine;
  // CSS; empty: the next of a palette that color-blind readers can tell apart, after whose end points are hollow.
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

// One SVG document, or several plots or drawings as one document in rows of `columns`.
std::string svg(const Plot& plot);
std::string svg(const std::vector<Plot>& plots, int columns);
std::string svg(const std::vector<Drawing>& drawings, int columns);

// Drawings beside each other, or below each other, as one.
Drawing row_of(const std::vector<Drawing>& drawings);
Drawing column_of(const std::vector<Drawing>& drawings);

// Text with the characters that markup gives a meaning replaced.
std::string escaped(const std::string& text);

// Where an axis from low to high is labeled: multiples of 1, 2 or 5 times a power of ten, about `count` of them; on a
// logarithmic axis the powers of ten, and 2 and 5 times them where those alone would be few.
std::vector<double> ticks(double low, double high, bool logarithmic, int count);

}  // namespace goniochrome::report
