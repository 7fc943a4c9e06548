#include "plots.h"

#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "paint/date.h"
#include "quality/control_chart.h"

namespace goniochrome::tool {

namespace {

using report::Series;

constexpr const char *kInk = "#1c1c1c", *kLimitInk = "#b3261e", *kSigmaInk = "#777777", *kToleranceInk = "#0072b2";
constexpr double kNoLimit_dE = 1;  // the tolerance that is drawn where dE has no limit

// The limit of a quantity at a geometry; that of dE also from the mean and the largest.
std::optional<quality::Limit> limit_of(const Judgement& judgement, const std::string& at,
                                       const std::vector<std::string>& quantities) {
  const auto& limits = judgement.standard->limits;
  for (const std::string& place : {at, std::string("*"), std::string(quality::kLargest)})
    for (const quality::Limit& limit : limits)
      if (limit.at == place && std::ranges::find(quantities, limit.quantity) != quantities.end()) return limit;
  return std::nullopt;
}

std::optional<double> tolerance_of(const Judgement& judgement, const quality::AngleDifference& angle,
                                   const quality::CompareOptions& compare) {
  const auto limit =
      limit_of(judgement, paint::geometry_name(angle.geometry), {"dE", quality::quantity_of(compare.formulas.front())});
  return limit ? limit->high : std::nullopt;
}

// The distance from the standard, in a direction of the a*b* plane, at which the difference reaches `tolerance`.
double reach(const color::DifferenceFormula& formula, const quality::AngleDifference& angle, double direction_rad,
             double tolerance) {
  double low = 0, high = 100;
  for (int step = 0; step < 40; ++step) {
    const double r = (low + high) / 2;
    const color::Lab& s = angle.standard;
    const color::Lab there{s.L, s.a + r * std::cos(direction_rad), s.b + r * std::sin(direction_rad)};
    const double is = color::difference(formula, s, there, paint::aspecular_angle_deg(angle.geometry));
    (is < tolerance ? low : high) = r;
  }
  return low;
}

// Labels of an axis of dates: about six, at whole steps of time.
std::vector<report::Tick> date_ticks(double from_s, double to_s) {
  constexpr double kMost = 6, kMinute = 60, kHour = 3600, kDay = 86400;
  double step_s = kMinute;
  for (const double next : {5 * kMinute, 15 * kMinute, kHour, 3 * kHour, 6 * kHour, 12 * kHour, kDay, 2 * kDay})
    if ((to_s - from_s) / step_s > kMost) step_s = next;
  while ((to_s - from_s) / step_s > kMost) step_s *= 2;
  std::vector<report::Tick> ticks;
  for (double t = std::ceil(from_s / step_s) * step_s; t <= to_s; t += step_s) {
    const std::string date = paint::date_of_seconds(t);
    if (date.empty()) continue;
    constexpr std::size_t kDate = 10, kTimeAt = 11, kTime = 5;
    ticks.push_back({t, date.substr(0, kDate) + (step_s < kDay ? " " + date.substr(kTimeAt, kTime) : "")});
  }
  return ticks;
}

Series level(const std::string& label, double value, double from, double to, Series::Style style, const char* color) {
  return {.label = label, .x = {from, to}, .y = {value, value}, .style = style, .color = color};
}

}  // namespace

report::Plot plane_plot(const Judgement& judgement, const quality::AngleDifference& angle,
                        const quality::CompareOptions& compare, bool small) {
  constexpr int kDirections = 72;
  const color::DifferenceFormula& formula = compare.formulas.front();
  const auto limit = tolerance_of(judgement, angle, compare);
  Series ellipse{.color = kToleranceInk};
  double widest = std::max({std::abs(angle.lab.da), std::abs(angle.lab.db), 0.1});
  for (int i = 0; i <= kDirections; ++i) {
    const double direction = 2 * kPi * i / kDirections;
    const double r = reach(formula, angle, direction, limit.value_or(kNoLimit_dE));
    ellipse.x.push_back(r * std::cos(direction)), ellipse.y.push_back(r * std::sin(direction));
    widest = std::max(widest, r);
  }
  widest *= 1.15;
  // One grid for both axes: 0, and on either side the largest of 1, 2 and 5 times a power of ten.
  const double power = std::pow(10, std::floor(std::log10(widest))), times = widest / power;
  const double outer = power * (times >= 5 ? 5 : times >= 2 ? 2 : 1);
  std::vector<report::Tick> ticks;
  for (const double at : {-outer, 0.0, outer}) ticks.push_back({at, fmt::format("{:g}", at)});
  const std::string name = paint::geometry_name(angle.geometry);
  return {.title = small ? name : fmt::format("{}, dE {:.3g}", name, limit.value_or(kNoLimit_dE)),
          .x = {.label = "da*", .low = -widest, .high = widest, .ticks = ticks},
          .y = {.label = "db*", .low = -widest, .high = widest, .ticks = ticks},
          .series = {ellipse,
                     {.x = {0}, .y = {0}, .style = Series::Style::kRings, .color = kSigmaInk},
                     {.x = {angle.lab.da}, .y = {angle.lab.db}, .style = Series::Style::kPoints, .color = kInk}},
          .width = small ? 170 : 246,
          .height = small ? 172 : 248};
}

report::Plot angle_plot(const Judgement& judgement, const quality::CompareOptions& compare) {
  std::vector<const quality::AngleDifference*> angles;
  for (const quality::AngleDifference& angle : judgement.comparison.angles) angles.push_back(&angle);
  std::ranges::sort(angles, {}, [](const auto* angle) { return angle->geometry.aspecular_deg; });
  report::Plot plot{.title = quality::quantity_of(compare.formulas.front()) + " by angle",
                    .x = {.label = "aspecular angle (deg)"},
                    .y = {.label = "dE", .low = 0},
                    .width = 430,
                    .height = 220};
  Series is{.label = "sample", .style = Series::Style::kLineAndPoints, .color = kInk};
  Series limits{.label = "limit", .style = Series::Style::kDashed, .color = kLimitInk};
  double highest = 0;
  for (const auto* angle : angles) {
    is.x.push_back(angle->geometry.aspecular_deg), is.y.push_back(angle->by_formula.front());
    const auto limit = tolerance_of(judgement, *angle, compare);
    limits.x.push_back(angle->geometry.aspecular_deg), limits.y.push_back(limit.value_or(std::nan("")));
    highest = std::max({highest, is.y.back(), limit.value_or(0)});
  }
  plot.y.high = std::max(1.1 * highest, 0.1);
  plot.series.push_back(is);
  if (std::ranges::any_of(limits.y, [](double y) { return std::isfinite(y); })) plot.series.push_back(limits);
  return plot;
}

std::vector<report::Plot> control_plots(const std::vector<const Judgement*>& judgements, std::size_t angle,
                                        const std::vector<double>& times_s) {
  Series values{.label = "dL", .style = Series::Style::kLineAndPoints, .color = kInk};
  Series ranges{.label = "range", .style = Series::Style::kLineAndPoints, .color = kInk};
  for (std::size_t i = 0; i < judgements.size(); ++i) {
    values.x.push_back(times_s.empty() ? static_cast<double>(i + 1) : times_s[i]);
    values.y.push_back(judgements[i]->comparison.angles[angle].lab.dL);
  }
  const quality::ControlChart chart = quality::control_chart(values.y);
  ranges.x.assign(values.x.begin() + 1, values.x.end()), ranges.y = chart.ranges;
  const double air = times_s.empty() ? 0.5 : std::max(0.03 * (values.x.back() - values.x.front()), 60.0);
  const double from = values.x.front() - air, to = values.x.back() + air;
  const std::string at = paint::geometry_name(judgements.front()->comparison.angles[angle].geometry);
  report::Axis along{.label = times_s.empty() ? "sample, in order" : "date", .low = from, .high = to};
  if (!times_s.empty()) along.ticks = date_ticks(from, to);
  report::Plot individuals{
      .title = fmt::format("dL at {}", at), .x = along, .y = {.label = "dL"}, .width = 738, .height = 175};
  report::Plot moving{.title = fmt::format("moving range at {}", at),
                      .x = along,
                      .y = {.label = "range", .low = 0},
                      .width = 738,
                      .height = 125};
  individuals.series = {values, level("mean", chart.mean, from, to, Series::Style::kLine, kSigmaInk)};
  for (const int k : {1, 2, 3})
    for (const int side : {-1, 1})
      individuals.series.push_back(level(side < 0 || k == 2 ? ""
                                         : k == 1           ? "1, 2 sigma"
                                                            : "3 sigma",
                                         chart.mean + side * k * chart.sigma, from, to, Series::Style::kDashed,
                                         k < 3 ? "#bbbbbb" : kToleranceInk));
  Series beyond{.label = "beyond", .style = Series::Style::kPoints, .color = kLimitInk};
  for (const std::size_t i : chart.beyond) beyond.x.push_back(values.x[i]), beyond.y.push_back(values.y[i]);
  if (!beyond.x.empty()) individuals.series.push_back(beyond);
  if (const auto limit = limit_of(*judgements.front(), at, {"dL"}))
    for (const auto* bound : {&limit->low, &limit->high})
      if (*bound)
        individuals.series.push_back(level(bound == &limit->high && limit->low ? "" : "limit", **bound, from, to,
                                           Series::Style::kLine, kLimitInk));
  moving.series = {ranges, level("mean", chart.mean_range, from, to, Series::Style::kLine, kSigmaInk),
                   level("limit", chart.range_limit, from, to, Series::Style::kDashed, kToleranceInk)};
  const double highest = std::ranges::max(chart.ranges);
  moving.y.high = std::max(1.1 * std::max(highest, chart.range_limit), 0.01);
  return {individuals, moving};
}

}  // namespace goniochrome::tool
