#include "curve.h"

#include <cmath>
#include <limits>

#include "base/text.h"
#include "panels/geometry_sets.h"
#include "report/plot.h"

namespace goniochrome::tool {

namespace {

constexpr int kLastView_deg = 85;

// The difference at a misalignment. It is NaN in glare, and where the viewer does not see the second panel.
double value(const DifferenceCurves& what, const panels::FlakeCurve& curve, const panels::LightView& geometry,
             double b_deg) {
  const panels::TiltedPair pair = panels::TiltedPair::make(geometry, what.seam_deg);
  if (panels::aspecular_deg(geometry) < panels::kIndexGlare_deg ||
      std::abs(b_deg) >= pair.range_deg(b_deg < 0 ? -1 : 1))
    return std::numeric_limits<double>::quiet_NaN();
  return panels::difference_at(curve, pair, b_deg, what.metric);
}

}  // namespace

std::string csv(const DifferenceCurves& what, const panels::FlakeCurve& curve) {
  std::string text = "light_deg,view_deg,aspecular_deg,misalignment_deg,de\n";
  for (const double light : what.lights_deg)
    for (const double b : what.misalignments_deg)
      for (int view = -kLastView_deg; view <= kLastView_deg; ++view) {
        const panels::LightView geometry{light, static_cast<double>(view), 0};
        const double de = value(what, curve, geometry, b);
        text += fmt::format("{},{},{:.9g},{},{}\n", shortest(light), view, panels::aspecular_deg(geometry), shortest(b),
                            std::isnan(de) ? "" : fmt::format("{:.9g}", de));
      }
  return text;
}

std::string svg(const DifferenceCurves& what, const panels::FlakeCurve& curve) {
  std::vector<report::Plot> plots;
  double highest = what.threshold;
  for (const double light : what.lights_deg) {
    report::Plot plot;
    plot.title = fmt::format("{}, light {} deg from the normal", what.paint, shortest(light));
    plot.x = {.label = "viewing angle from the normal (deg; the light's side is negative)", .low = -90, .high = 90};
    plot.y = {.label = what.metric == panels::DifferenceMetric::kDe76 ? "difference of the panels (dE76)"
                                                                      : "difference of the panels (dE00)",
              .low = 0};
    for (const double b : what.misalignments_deg) {
      report::Series series{.label = fmt::format("{} deg", shortest(b)), .x = {}, .y = {}};
      for (int view = -kLastView_deg; view <= kLastView_deg; ++view) {
        series.x.push_back(view);
        series.y.push_back(value(what, curve, {light, static_cast<double>(view), 0}, b));
        highest = std::fmax(highest, series.y.back());
      }
      plot.series.push_back(std::move(series));
    }
    plot.series.push_back({.label = fmt::format("threshold {}", shortest(what.threshold)),
                           .x = {-90, 90},
                           .y = {what.threshold, what.threshold},
                           .style = report::Series::Style::kDashed,
                           .color = "#666666"});
    plots.push_back(std::move(plot));
  }
  for (report::Plot& plot : plots) plot.y.high = highest;
  return report::svg(plots, plots.size() == 1 ? 1 : 2);
}

}  // namespace goniochrome::tool
