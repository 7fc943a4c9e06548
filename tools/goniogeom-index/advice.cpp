#include "advice.h"

#include <algorithm>
#include <cmath>

#include "base/text.h"

namespace goniochrome::tool {

namespace {

constexpr double kLowAspecular_deg = 45;  // smaller angles are on the highlight's side of the curve
constexpr std::size_t kMostFitted = 600;  // views for the trial fits

struct Rms {
  double squares = 0, weight = 0;
  void add(double de, double w) { squares += w * de * de, weight += w; }
  bool any() const { return weight > 0; }
  double value() const { return std::sqrt(squares / weight); }
};

// The RMS difference that the best paint for the second panel leaves over these views.
std::optional<double> best_left(const paint::Appearance& a, const paint::Paint& paint,
                                const std::vector<panels::PanelView>& views) {
  if (views.empty()) return std::nullopt;
  std::vector<panels::PanelView> some;
  for (const std::size_t i : panels::spread_places(views.size(), kMostFitted)) some.push_back(views[i]);
  const auto fit = panels::trompe_fit(a, paint.paint_class == paint::PaintClass::kSolid, some, {});
  return fit.ok() ? std::optional<double>(fit->after.rms) : std::nullopt;
}

double largest_solid_difference(const paint::Appearance& a, const std::vector<panels::PanelView>& views,
                                panels::DifferenceMetric metric) {
  const color::Lab solid = paint::lab_at(a, 45);
  double most = 0;
  for (const panels::PanelView& view : views)
    most = std::max(most, panels::difference(metric, panels::panel_color(solid, view.cos_a),
                                             panels::panel_color(solid, view.cos_b)));
  return most;
}

}  // namespace

std::vector<std::string> advice(const paint::Paint& paint, const SeamRequest& request, const mesh::Seam& seam,
                                const std::vector<panels::SeamView>& views, const std::vector<double>& de) {
  const auto appearance = panels::appearance_of(paint);
  if (!appearance.ok()) return {};
  const panels::FlakeCurve curve = *panels::FlakeCurve::make(paint, paint::TargetCurve::Kind::kCurve);
  std::vector<double> folds;
  for (const mesh::SeamPoint& p : seam.points) folds.push_back(std::abs(p.fold_deg));
  std::ranges::sort(folds);
  const double fold = folds[folds.size() * 95 / 100];

  // Under an environment there is no single aspecular angle, so that the views of an instrument are used instead.
  const bool has_lights = !views.empty() && views.front().light.has_value();
  std::vector<panels::PanelView> seen, near_side, far_side;
  Rms low, high;
  for (std::size_t i = 0; has_lights && i < views.size(); ++i) {
    const panels::PanelView view = panels::panel_view(seam, views[i]).under_coat(curve.coat_index());
    seen.push_back(view);
    (view.aspecular_a_deg <= kLowAspecular_deg ? low : high).add(de[i], view.weight);
    // Views where the second panel is turned toward the highlight, and views where it is turned away from it.
    (view.aspecular_b_deg < view.aspecular_a_deg ? near_side : far_side).push_back(view);
  }
  double index = std::numeric_limits<double>::infinity();
  const panels::GeometryList set =
      has_lights && !request.world.in_world ? request.geometries : *panels::geometry_list({});
  for (const panels::LightView& g : set.pairs)
    index = std::min(index,
                     panels::geometry_index(curve, panels::TiltedPair::make(g, 90), request.threshold, request.metric)
                         .smallest_deg());
  const double most = *std::ranges::max_element(de);
  const std::string shown = shortest(request.threshold);
  const auto verdict = [](bool applies) { return applies ? "applies" : "is met"; };

  std::vector<std::string> lines;
  lines.push_back(
      fmt::format("1 high travel only on parallel panels: {}; {} is seen from {:.2g} deg on, the seam is out by {:.2g} "
                  "deg (95 % of it less)",
                  verdict(index < fold), paint.name, index, fold));
  if (has_lights) {
    const double solid = largest_solid_difference(*appearance, seen, request.metric);
    lines.push_back(
        fmt::format("2 solid or low travel where panels are not flush: {}; a solid of this paint's color at 45 deg "
                    "would show dE {:.2g} at most, this paint shows {:.2g}",
                    verdict(most >= request.threshold && solid < 0.7 * most), solid, most));
  }
  if (low.any() && high.any()) {
    lines.push_back(fmt::format(
        "3 no seams that are seen at low aspecular angles: {}; rms dE {:.2g} up to {} deg aspecular, {:.2g} beyond",
        verdict(low.value() >= request.threshold && low.value() > 1.5 * high.value()), low.value(), kLowAspecular_deg,
        high.value()));
  }
  lines.push_back(
      fmt::format("4 tolerances by paint: {}; for dE {} this paint allows {:.2g} deg, the seam has up to {:.2g}",
                  verdict(index < folds.back()), shown, index, folds.back()));
  const auto all = best_left(*appearance, paint, seen), near = best_left(*appearance, paint, near_side),
             far = best_left(*appearance, paint, far_side);
  if (all && near && far) {
    const double limited = std::min(*near, *far);
    lines.push_back(
        fmt::format("5 a limited range of views: {}; with another paint on the second panel rms dE {:.2g} is left for "
                    "all views, {:.2g} for those on one side of the highlight (trompe-fit)",
                    verdict(*all >= request.threshold && limited < 0.7 * *all), *all, limited));
  }
  return lines;
}

}  // namespace goniochrome::tool
