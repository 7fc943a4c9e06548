#include "report/plot.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/text.h"

namespace goniochrome::report {

namespace {

// Okabe and Ito's palette without its yellow, which can hardly be seen on white paper.
constexpr const char* kPalette[] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#e69f00", "#444444"};

constexpr double kLeft = 64, kRight = 16, kTop = 34, kBottom = 48;
constexpr double kLegendLine = 17;
constexpr double kLetter = 6.6;  // mean width of a letter at 12 px

// Where the values of an axis lie in the picture.
class Scale {
 public:
  Scale(const Axis& axis, const std::vector<Series>& series, const std::vector<double> Series::* values, double from,
        double to)
      : given_(axis.ticks), logarithmic_(axis.logarithmic), from_(from), to_(to) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Series& s : series)
      for (const double v : s.*values)
        if (usable(v)) low = std::min(low, v), high = std::max(high, v);
    if (!(low <= high)) low = logarithmic_ ? 0.1 : 0, high = 1;
    widen(low, high);
    low_ = axis.low.value_or(low), high_ = axis.high.value_or(high);
  }

  bool usable(double v) const { return std::isfinite(v) && (!logarithmic_ || v > 0); }
  double at(double v) const {
    // A ratio of the ends of the axis could be larger than any number.
    const double part = logarithmic_ ? (std::log(v) - std::log(low_)) / (std::log(high_) - std::log(low_))
                                     : (v - low_) / (high_ - low_);
    return from_ + (to_ - from_) * part;
  }
  std::vector<Tick> ticks(int count) const;

 private:
  // Leaves some space around the data, and makes room if all values are equal.
  void widen(double& low, double& high) const {
    if (logarithmic_) {
      // Logarithms of numbers that are nearer to each other may be equal.
      constexpr double kLeastSpan = 1e-9;
      const double span = std::log(high) - std::log(low), factor = span > kLeastSpan ? std::exp(0.04 * span) : 2;
      low = std::max(low / factor, std::numeric_limits<double>::denorm_min());
      high = std::min(high * factor, std::numeric_limits<double>::max());
    } else {
      const double air = high > low ? 0.04 * (high - low) : std::max(1.0, 0.1 * std::abs(high));
      // An axis that begins at zero shall be seen to do so.
      low = low >= 0 && low < 0.2 * high ? 0 : low - air;
      high += air;
    }
  }

  std::vector<Tick> given_;
  bool logarithmic_;
  double from_, to_, low_ = 0, high_ = 1;
};

std::string tick_label(double v) {
  const double size = std::abs(v);
  if (size == 0 || (size >= 1e-3 && size < 1e6)) return fmt::format("{:.6g}", v);
  std::string label = fmt::format("{:.3g}", v);
  if (const auto e = label.find('e'); e != std::string::npos) {  // 1e-05 and 1e+06 are read as 1e-5 and 1e6
    if (label[e + 2] == '0') label.erase(e + 2, 1);
    if (label[e + 1] == '+') label.erase(e + 1, 1);
  }
  return label;
}

std::vector<Tick> Scale::ticks(int count) const {
  if (!given_.empty()) return given_;
  std::vector<Tick> result;
  for (const double v : goniochrome::report::ticks(low_, high_, logarithmic_, count))
    result.push_back({v, tick_label(v)});
  return result;
}

// How the points of a series look, and its lines.
struct Ink {
  std::string color;
  Series::Style style = Series::Style::kLine;
  bool hollow = false;

  bool has_line() const { return style != Series::Style::kPoints && style != Series::Style::kRings; }
  bool has_points() const { return style != Series::Style::kLine && style != Series::Style::kDashed; }
  std::string point(double x, double y) const {
    const bool ring = style == Series::Style::kRings;
    if (ring || hollow)
      return fmt::format(
          "<circle cx=\"{:.2f}\" cy=\"{:.2f}\" r=\"{}\" fill=\"{}\" stroke=\"{}\" stroke-width=\"1.6\"/>", x, y,
          ring ? 6.5 : 2.8, ring ? "none" : "#fff", color);
    return fmt::format("<circle cx=\"{:.2f}\" cy=\"{:.2f}\" r=\"3\" fill=\"{}\"/>", x, y, color);
  }
  std::string line(const std::string& path) const {
    return fmt::format("<path class=\"curve\" stroke=\"{}\"{} d=\"{}\"/>", color,
                       style == Series::Style::kDashed ? " stroke-dasharray=\"5 4\"" : "", path);
  }
};

std::string text(double x, double y, const char* anchor, const std::string& words, const std::string& more = "") {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\"{}>{}</text>\n", x, y, anchor, more,
                     xml_escaped(words, ""));
}

std::string axes(const Plot& plot, const Scale& x, const Scale& y, double right, double bottom) {
  std::string out;
  for (const auto& [v, label] : x.ticks(static_cast<int>((right - kLeft) / 70))) {
    out += fmt::format("<path class=\"grid\" d=\"M{:.1f} {:.1f}V{:.1f}\"/>\n", x.at(v), kTop, bottom);
    out += text(x.at(v), bottom + 16, "middle", label);
  }
  for (const auto& [v, label] : y.ticks(static_cast<int>((bottom - kTop) / 40))) {
    out += fmt::format("<path class=\"grid\" d=\"M{:.1f} {:.1f}H{:.1f}\"/>\n", kLeft, y.at(v), right);
    out += text(kLeft - 6, y.at(v) + 4, "end", label);
  }
  out += fmt::format("<rect class=\"frame\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\"/>\n", kLeft,
                     kTop, right - kLeft, bottom - kTop);
  out += text((kLeft + right) / 2, bottom + 36, "middle", plot.x.label);
  out += text(0, 0, "middle", plot.y.label,
              fmt::format(" transform=\"translate(14 {:.1f}) rotate(-90)\"", (kTop + bottom) / 2));
  out += text(kLeft, kTop - 12, "start", plot.title, " class=\"title\"");
  return out;
}

std::string curve(const Series& series, const Scale& x, const Scale& y, const Ink& ink) {
  std::string path, points;
  bool pen_down = false;
  for (std::size_t i = 0; i < std::min(series.x.size(), series.y.size()); ++i) {
    if (!x.usable(series.x[i]) || !y.usable(series.y[i])) {
      pen_down = false;
      continue;
    }
    path += fmt::format("{}{:.2f} {:.2f}", pen_down ? "L" : "M", x.at(series.x[i]), y.at(series.y[i]));
    points += ink.point(x.at(series.x[i]), y.at(series.y[i]));
    pen_down = true;
  }
  std::string out;
  if (ink.has_line()) out += ink.line(path) + "\n";
  if (ink.has_points()) out += points + "\n";
  return out;
}

// One plot with its upper left corner at the origin.
std::string body(const Plot& plot) {
  std::size_t longest = 0;
  for (const Series& s : plot.series) longest = std::max(longest, s.label.size());
  const double legend = longest ? 34 + kLetter * static_cast<double>(longest) : 0;
  const double right = plot.width - kRight - legend, bottom = plot.height - kBottom;
  const Scale x(plot.x, plot.series, &Series::x, kLeft, right), y(plot.y, plot.series, &Series::y, bottom, kTop);

  std::string out = axes(plot, x, y, right, bottom);
  std::size_t next = 0;
  double line = kTop + 10;
  // Nested, so that curves end at the frame where an axis is narrower than the data.
  std::string curves = fmt::format(
      "<svg x=\"{0:.1f}\" y=\"{1:.1f}\" width=\"{2:.1f}\" height=\"{3:.1f}\" viewBox=\"{0:.1f} {1:.1f} {2:.1f} "
      "{3:.1f}\">\n",
      kLeft, kTop, right - kLeft, bottom - kTop);
  for (const Series& s : plot.series) {
    Ink ink{s.color, s.style};
    if (s.color.empty()) {
      ink.hollow = next / std::size(kPalette) % 2 == 1;
      ink.color = kPalette[next++ % std::size(kPalette)];
    }
    curves += curve(s, x, y, ink);
    if (s.label.empty()) continue;
    if (ink.has_line()) out += ink.line(fmt::format("M{:.1f} {:.1f}h18", right + 10, line - 4));
    if (ink.has_points()) out += ink.point(right + 19, line - 4);
    out += text(right + 33, line, "start", s.label);
    line += kLegendLine;
  }
  return out + curves + "</svg>\n";
}

// Each drawing stands behind the one before it: to its right, or below it.
Drawing joined(const std::vector<Drawing>& drawings, bool in_a_row) {
  Drawing all;
  for (const Drawing& each : drawings) {
    int& along = in_a_row ? all.width : all.height;
    int& across = in_a_row ? all.height : all.width;
    all.body += fmt::format("<g transform=\"translate({} {})\">\n{}</g>\n", in_a_row ? along : 0, in_a_row ? 0 : along,
                            each.body);
    along += in_a_row ? each.width : each.height;
    across = std::max(across, in_a_row ? each.height : each.width);
  }
  return all;
}

}  // namespace

std::vector<double> ticks(double low, double high, bool logarithmic, int count) {
  std::vector<double> at;
  if (!(low < high)) return at;
  if (logarithmic) {
    const double decades = std::log10(high) - std::log10(low);
    const int every = std::max(1, static_cast<int>(std::ceil(decades / std::max(count, 1))));
    for (const bool dense : {decades < 2, true}) {
      at.clear();
      for (int decade = static_cast<int>(std::floor(std::log10(low))); decade <= std::ceil(std::log10(high)); ++decade)
        for (const double part : {1.0, 2.0, 5.0}) {
          const double v = part * std::pow(10.0, decade);
          if ((part == 1 ? decade % every == 0 : dense) && v >= low * (1 - 1e-12) && v <= high * (1 + 1e-12))
            at.push_back(v);
        }
      if (at.size() > 2) return at;
    }
    at.clear();  // within a decade, round steps tell more
  }
  const double rough = (high - low) / std::max(count, 1), power = std::pow(10.0, std::floor(std::log10(rough)));
  const double step = power * (rough / power <= 1 ? 1 : rough / power <= 2 ? 2 : rough / power <= 5 ? 5 : 10);
  if (!(step > 0) || !std::isfinite(step)) return at;
  // Where the ends of the axis are neighbors, one step more does not change a number, so the steps are counted.
  const double first = std::ceil(low / step - 1e-9), most = 2 * std::max(count, 1) + 2;
  for (double k = 0; k < most && first + k <= high / step + 1e-9; ++k) {
    const double v = (first + k) * step + 0.0;  // -0 becomes 0
    if (at.empty() || v > at.back()) at.push_back(v);
  }
  return at;
}

Drawing drawing(const Plot& plot) {
  return {plot.width, plot.height, body(plot)};
}

Drawing row_of(const std::vector<Drawing>& drawings) {
  return joined(drawings, true);
}

Drawing column_of(const std::vector<Drawing>& drawings) {
  return joined(drawings, false);
}

std::string svg(const std::vector<Drawing>& drawings, int columns) {
  std::vector<Drawing> rows;
  for (std::size_t i = 0; i < drawings.size(); i += static_cast<std::size_t>(columns)) {
    const auto end = std::min(drawings.size(), i + static_cast<std::size_t>(columns));
    rows.push_back(row_of(
        {drawings.begin() + static_cast<std::ptrdiff_t>(i), drawings.begin() + static_cast<std::ptrdiff_t>(end)}));
  }
  const Drawing page = column_of(rows);
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\">\n"
      "<style>text{{font:12px sans-serif;fill:#222}}.title{{font-size:14px;font-weight:bold}}"
      ".grid{{stroke:#ddd;fill:none}}.frame{{stroke:#555;fill:none}}"
      ".curve{{fill:none;stroke-width:1.8;stroke-linejoin:round}}</style>\n"
      "<rect width=\"{0}\" height=\"{1}\" fill=\"#fff\"/>\n{2}</svg>\n",
      page.width, page.height, page.body);
}

std::string svg(const std::vector<Plot>& plots, int columns) {
  std::vector<Drawing> drawings;
  for (const Plot& plot : plots) drawings.push_back(drawing(plot));
  return svg(drawings, columns);
}

std::string svg(const Plot& plot) {
  return svg(std::vector<Plot>{plot}, 1);
}

}  // namespace goniochrome::report
