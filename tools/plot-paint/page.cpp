#include "page.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "base/text.h"
#include "brdf/lobe_model.h"
#include "display/paint_view.h"
#include "math/cosine_power.h"
#include "paint/curve.h"
#include "plane.h"
#include "report/lobe_drawings.h"

namespace goniochrome::tool {

namespace {

constexpr double kRadian = M_PI / 180;
constexpr const char* kChannelColors[] = {"#c23b22", "#2e8b57", "#2f5fb3"};
constexpr const char* kChannels[] = {"red", "green", "blue"};
constexpr int kThird = 360, kColumnHeight = 270;

// All that is drawn of a paint.
struct Subject {
  const PageInput& input;
  color::Xyz white;
  std::optional<paint::TargetCurve> curve;
  const paint::LobeFit* lobes = nullptr;
};

Result<Subject> subject_of(const PageInput& input) {
  GONIO_ASSIGN(const color::Xyz white, color::white_point(paint::condition_of(input.paint)));
  Subject subject{input, white, std::nullopt, input.paint.lobes ? &*input.paint.lobes : nullptr};
  const bool has_curve = input.paint.measurement || input.paint.appearance;
  if (has_curve) {
    GONIO_ASSIGN(subject.curve, paint::TargetCurve::make(input.paint, paint::TargetCurve::Kind::kMeasured));
  } else if (!subject.lobes) {
    return input_error("paint \"{}\" has no readings, no appearance and no lobes: there is nothing to draw",
                       input.paint.name);
  }
  return subject;
}

double part(const color::Lab& lab, int channel) {
  return channel == 0 ? lab.L : channel == 1 ? lab.a : lab.b;
}

// The weights that a viewer at that aspecular angle sees, with light from 45 deg.
paint::LobeFit seen_weights(const paint::LobeFit& fit, double aspecular_deg) {
  return brdf::at_view(fit, std::abs(45 - aspecular_deg));
}

report::Plot lab_plot(const Subject& s, int channel, int width, int height) {
  constexpr const char* kNames[] = {"L*", "a*", "b*"};
  const bool legend = channel == 0;  // it holds for all three
  report::Plot plot{.title = kNames[channel],
                    .x = {.label = "aspecular angle (deg)", .low = 0, .high = 115},
                    .y = {.label = ""},
                    .width = width,
                    .height = height};
  // The axis follows the readings, because the rise toward specular would make the rest too small to see.
  double low = std::numeric_limits<double>::infinity(), high = -low;
  const auto note = [&](double v) { low = std::min(low, v), high = std::max(high, v); };
  if (s.input.paint.measurement) {
    report::Series points{
        .label = legend ? "readings" : "", .style = report::Series::Style::kPoints, .color = "#000000"};
    for (const paint::LabReading& row : s.input.paint.measurement->rows) {
      points.x.push_back(paint::aspecular_angle_deg(row.geometry));
      points.y.push_back(part(row.lab, channel));
      note(points.y.back());
    }
    plot.series.push_back(points);
  }
  if (s.curve) {
    report::Series line{.label = legend ? "curve" : "", .style = report::Series::Style::kDashed, .color = "#777777"};
    for (double t = s.curve->known_angles_deg().front(); t <= 110; t += 1) {
      line.x.push_back(t);
      line.y.push_back(part(s.curve->at(t), channel));
      note(line.y.back());
    }
    plot.series.push_back(line);
  }
  if (s.lobes) {
    report::Series line{.label = legend ? "lobes" : "", .color = kChannelColors[channel]};
    for (double t = 0; t <= 112; t += 1) {
      line.x.push_back(t);
      line.y.push_back(
          part(color::lab_from_rgb(brdf::flake_reflectance_factor(seen_weights(*s.lobes, t), t), s.white), channel));
      if (t >= 15) note(line.y.back());
    }
    plot.series.push_back(line);
  }
  const double air = std::max(2.0, 0.15 * (high - low));
  plot.y.low = low - air, plot.y.high = high + air;
  if (channel == 0) plot.y.low = std::max(0.0, *plot.y.low);
  return plot;
}

// Each lobe's part of the luminance.
report::Plot parts_plot(const paint::LobeFit& fit) {
  report::Plot plot{.title = "Parts of the reflectance factor",
                    .x = {.label = "aspecular angle (deg)", .low = 0, .high = 90},
                    .y = {.label = "luminance", .logarithmic = true},
                    .width = kThird,
                    .height = kColumnHeight};
  double highest = 0;
  const auto add = [&](const std::string& label, auto value, report::Series::Style style) {
    constexpr std::size_t kColors = 7;  // beyond them colors repeat
    if (plot.series.size() >= kColors) style = report::Series::Style::kDashed;
    report::Series line{.label = label, .style = style};
    for (double t = 0; t <= 90; t += 1) {
      line.x.push_back(t), line.y.push_back(value(t * kRadian));
      highest = std::max(highest, line.y.back());
    }
    plot.series.push_back(line);
  };
  add("diffuse", [&](double) { return M_PI * color::luminance(fit.diffuse); }, report::Series::Style::kLine);
  for (const paint::Lobe& lobe : fit.lobes) {
    if (lobe.is_mirror()) continue;
    const auto curve_of = [&](const color::Rgb& weight) {
      return [&lobe, y = M_PI * color::luminance(weight)](double t) { return y * math::cos_power(t, lobe.exponent); };
    };
    if (lobe.directional_diffuse != color::Rgb{})
      add(fmt::format("E {:.3g}", lobe.exponent), curve_of(lobe.directional_diffuse), report::Series::Style::kLine);
    if (lobe.gloss != color::Rgb{})
      add(fmt::format("gloss {:.3g}", lobe.exponent), curve_of(lobe.gloss), report::Series::Style::kDashed);
  }
  plot.y.high = 2 * std::max(highest, 1e-6), plot.y.low = 1e-4 * *plot.y.high;
  return plot;
}

// The plane of incidence with light from 45 deg on the left. Readings stand where they were taken.
report::Drawing polar_plot(const Subject& s) {
  std::vector<report::PolarSeries> series;
  double highest = 0;
  for (int c = 0; c < 3; ++c) {
    report::PolarSeries line{.label = kChannels[c], .color = kChannelColors[c]};
    for (double view = -89; view <= 89; view += 1) {
      const double aspecular = std::abs(45 - view);
      line.angle_deg.push_back(view);
      line.radius.push_back(
          brdf::flake_reflectance_factor(brdf::at_view(*s.lobes, std::abs(view)), aspecular, 45, std::abs(view))[c]);
      highest = std::max(highest, line.radius.back());
    }
    series.push_back(line);
  }
  for (int c = 0; c < 3 && s.input.paint.measurement; ++c) {
    report::PolarSeries points{.label = "", .color = kChannelColors[c], .points = true};
    for (const paint::LabReading& row : s.input.paint.measurement->rows) {
      const double value = color::rgb_from_lab(row.lab, s.white)[c];
      if (row.geometry.incidence_deg != 45 || row.geometry.out_of_plane || row.geometry.reversed) continue;
      if (value < 0 || value > highest) continue;
      points.angle_deg.push_back(45 - row.geometry.aspecular_deg);
      points.radius.push_back(value);
    }
    series.push_back(points);
  }
  return report::polar_drawing("Reflectance factor, light at 45 deg", series, kThird, kColumnHeight);
}

// A table of the fit in numbers.
report::Drawing facts(const Subject& s) {
  std::vector<std::string> lines = {
      fmt::format("basis {}, method {}", s.lobes->basis, s.lobes->method),
      fmt::format("dE00 at the readings: mean {:.2f}, largest {:.2f}", s.lobes->mean_de00, s.lobes->max_de00),
      fmt::format("{} lobes{}", s.lobes->lobes.size(),
                  s.lobes->views.empty() ? "" : fmt::format(", {} views", s.lobes->views.size()))};
  for (const paint::Lobe& lobe : s.lobes->lobes) {
    if (lines.size() > 13) break;
    const std::string name = lobe.is_mirror() ? "mirror" : fmt::format("E {:.4g}", lobe.exponent);
    const color::Rgb k = lobe.directional_diffuse;
    lines.push_back(k == color::Rgb{} ? fmt::format("{}: gloss {:.3g}", name, lobe.gloss.y)
                                      : fmt::format("{}: {:.3g} {:.3g} {:.3g} /sr", name, k.x, k.y, k.z));
  }
  std::string out = "<text class=\"title\" x=\"12\" y=\"20\">Fit</text>\n";
  for (std::size_t i = 0; i < lines.size(); ++i)
    out += fmt::format("<text x=\"12\" y=\"{}\">{}</text>\n", 42 + 16 * i, xml_escaped(lines[i], ""));
  return {kThird, kColumnHeight, out};
}

report::Drawing surfaces(const paint::LobeFit& fit) {
  const double t = 45 * kRadian;
  const Vec3 light = {-std::sin(t), 0, std::cos(t)};
  std::vector<report::Drawing> drawings;
  for (int c = 0; c < 3; ++c)
    drawings.push_back(report::surface_drawing(
        fmt::format("Root of the flake, {}", kChannels[c]), kChannelColors[c],
        [&](const Vec3& view) {
          const double view_deg = std::atan2(std::hypot(view.x, view.y), view.z) / kRadian;
          return std::sqrt(brdf::flake_reflectance_factor(brdf::at_view(fit, view_deg),
                                                          paint::aspecular_angle_rad(light, view, {0, 0, 1}) / kRadian,
                                                          45, view_deg)[c]);
        },
        light, kThird, kColumnHeight));
  return report::row_of(drawings);
}

// Reflectance factors of target and fit over the hemisphere of viewers, for one light.
class Slices {
 public:
  Slices(const Subject& subject, double incidence_deg) : s_(subject), incidence_deg_(incidence_deg) {
    const double t = incidence_deg * kRadian;
    light_ = {-std::sin(t), 0, std::cos(t)};
    if (s_.input.brdf)
      if (auto made = brdf::ChannelColorimeter::make(s_.input.brdf->traits(), {"D65", 2}); made.ok())
        meter_ = std::move(*made);
    exposure_ = exposure();
  }

  std::vector<report::Drawing> drawings(int width, int height) const {
    std::vector<report::Drawing> both;
    if (has_target())
      both.push_back(
          square(s_.input.brdf ? "measured" : "curve", [this](const Vec3& v) { return target(v); }, width, height));
    if (s_.lobes) both.push_back(square("fit", [this](const Vec3& v) { return fit(v); }, width, height));
    return both;
  }

 private:
  static constexpr int kCells = 36;        // from which the exposure is taken
  static constexpr double kFinest_px = 4;  // a cell of a square
  bool has_target() const { return meter_.has_value() || s_.curve.has_value(); }

  color::Rgb target(const Vec3& view) const {
    if (!meter_) {
      const double angle_deg = paint::aspecular_angle_rad(light_, view, {0, 0, 1}) / kRadian;
      return color::rgb_from_lab(s_.curve->at(angle_deg), s_.white);
    }
    brdf::MeasuredValue value = s_.input.brdf->value(light_, view);
    for (double& f : value.f) f *= M_PI;
    return color::rgb_from_xyz_d65(
        color::adapted(meter_->xyz(value.f), meter_->white(), *color::white_point({"D65", 2})));
  }
  color::Rgb fit(const Vec3& view) const {
    const std::vector<paint::GlossReading>& gloss = s_.input.paint.gloss;
    return M_PI * brdf::coated_brdf(*s_.lobes, light_, view, {0, 0, 1},
                                    gloss.empty() ? brdf::kGlossIncidence_deg : gloss.front().angle_deg);
  }

  // The exposure at which only the brightest twentieth of the views is clipped.
  double exposure() const {
    std::vector<double> values;
    for (int i = 0; i < kCells; ++i)
      for (int j = 0; j < kCells; ++j) {
        const Vec3 view = report::hemisphere_direction((2 * i + 1.0) / kCells - 1, (2 * j + 1.0) / kCells - 1);
        if (view.z > 0.05) values.push_back(color::luminance(has_target() ? target(view) : fit(view)));
      }
    const auto at = values.begin() + static_cast<std::ptrdiff_t>(values.size() * 19 / 20);
    std::nth_element(values.begin(), at, values.end());
    return 0.8 / std::max(*at, 1e-4);
  }

  template <class Color>
  report::Drawing square(const char* what, Color color, int width, int height) const {
    return report::square_drawing(
        fmt::format("{:g} deg, {}", incidence_deg_, what), std::clamp(static_cast<int>(width / kFinest_px), kCells, 64),
        [&](double x, double y) {
          const Vec3 view = report::hemisphere_direction(x, y);
          const Vec3 mirror = {-light_.x, -light_.y, light_.z};
          constexpr double kMark_rad = 0.04;
          if (length(cross(view, mirror)) < kMark_rad && dot(view, mirror) > 0) return Vec3{0, 0, 0};
          if (view.z < 0.02) return Vec3{0, 0, 0};
          return displayed(exposure_ * color(view));
        },
        width, height);
  }

  static Vec3 displayed(const color::Rgb& scene) {
    color::Rgb rgb = color::rec709_from_rec2020(scene);
    for (int c = 0; c < 3; ++c) rgb[c] = display::srgb_signal(rgb[c]);
    return rgb;
  }

  const Subject& s_;
  double incidence_deg_, exposure_ = 1;
  Vec3 light_;
  std::optional<brdf::ChannelColorimeter> meter_;
};

report::Drawing squares(const Subject& s, int width, int height) {
  std::vector<report::Drawing> all;
  for (const double incidence : s.input.incidence_deg)
    for (report::Drawing& drawing : Slices(s, incidence).drawings(width, height)) all.push_back(std::move(drawing));
  return report::row_of(all);
}

report::Drawing heading(const paint::Paint& paint, int width) {
  const color::ViewingCondition condition = paint::condition_of(paint);
  const std::string brushed = paint.anisotropy ? fmt::format(", brushed {} x {}", shortest(paint.anisotropy->alpha_x),
                                                             shortest(paint.anisotropy->alpha_y))
                                               : "";
  const std::string text = fmt::format("{}{}, {}/{} deg{}", paint.name,
                                       paint.paint_class == paint::PaintClass::kUnknown
                                           ? ""
                                           : fmt::format(", {}", paint::paint_class_name(paint.paint_class)),
                                       condition.illuminant, condition.observer_deg, brushed);
  return {width, 34,
          fmt::format("<text x=\"12\" y=\"24\" style=\"font-size:18px;font-weight:bold\">{}</text>\n",
                      xml_escaped(text, ""))};
}

report::Drawing lab_row(const Subject& s, int width, int height) {
  std::vector<report::Drawing> drawings;
  for (int channel = 0; channel < 3; ++channel)
    drawings.push_back(report::drawing(lab_plot(s, channel, width, height)));
  return report::row_of(drawings);
}

}  // namespace

Result<report::Drawing> page_of(const PageInput& input) {
  GONIO_ASSIGN(const Subject s, subject_of(input));
  constexpr int kWidth = 3 * kThird;
  std::vector<report::Drawing> rows = {heading(input.paint, kWidth), lab_row(s, kThird, kColumnHeight)};
  if (s.curve) {
    constexpr int kPlaneHeight = 380;
    rows.push_back(report::row_of({plane_drawing(input.paint, *s.curve, s.white, kThird, kPlaneHeight),
                                   travel_bar(*s.curve, s.white, kWidth - kThird, kPlaneHeight)}));
  }
  if (s.lobes) {
    rows.push_back(report::row_of({report::drawing(parts_plot(*s.lobes)), polar_plot(s), facts(s)}));
    rows.push_back(surfaces(*s.lobes));
  }
  const int squares_wide = static_cast<int>(input.incidence_deg.size()) * (s.lobes && (s.curve || input.brdf) ? 2 : 1);
  const int side = std::clamp(kWidth / std::max(1, squares_wide), 100, 260);
  rows.push_back(squares(s, side, side + 24));
  return report::column_of(rows);
}

Result<report::Drawing> row_of_sheet(const PageInput& input) {
  GONIO_ASSIGN(const Subject s, subject_of(input));
  constexpr int kPlotWidth = 300, kPlotHeight = 190, kSquare = 130;
  const report::Drawing plots = lab_row(s, kPlotWidth, kPlotHeight);
  const report::Drawing below = report::row_of({plots, squares(s, kSquare, kPlotHeight)});
  return report::column_of({heading(input.paint, below.width), below});
}

}  // namespace goniochrome::tool
