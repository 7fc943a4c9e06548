#include "studio/internal/describe.h"

#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "brdf/lobe_model.h"
#include "display/paint_view.h"
#include "math/elementary.h"
#include "paint/curve.h"
#include "paint/edit.h"
#include "paint/metrics.h"
#include "studio/paint_json.h"

namespace goniochrome::studio {

namespace {

// Degrees at which curves are drawn: close together near the face, where they bend.
std::vector<double> drawn_angles_deg() {
  std::vector<double> angles;
  for (double angle = 10; angle <= 110; angle += angle < 50 ? 1 : 2) angles.push_back(angle);
  return angles;
}

Json rows_json(const paint::Paint& paint, const color::ViewingCondition& condition, display::Screen screen) {
  Json rows = Json::array();
  if (!paint.measurement) return rows;
  for (const paint::LabReading& row : paint.measurement->rows) {
    rows.push_back({{"geometry", paint::geometry_name(row.geometry)},
                    {"angle", paint::aspecular_angle_deg(row.geometry)},
                    {"out_of_plane", row.geometry.out_of_plane},
                    {"lab", lab_json(row.lab)},
                    {"css", css_color(row.lab, condition, screen)}});
  }
  return rows;
}

// How far from an end the screen shows it, and the nearest of its lightness and hue that it shows as it is.
Json screen_json(const color::Lab& lab, const color::Xyz& white, display::Screen screen) {
  const double chroma = color::chroma(lab), most = display::screen_chroma(lab.L, color::hue_deg(lab), white, screen);
  const double share = chroma > most ? most / chroma : 1;
  const color::Lab shown =
      color::lab_from_rgb(display::in_display_gamut(color::rgb_from_lab(lab, white), screen), white);
  return {{"de00", color::delta_e_2000(lab, shown)}, {"nearest", lab_json({lab.L, share * lab.a, share * lab.b})}};
}

// The border of what a screen or a print shows at a lightness, in the plane of a* and b*.
template <class Most>
Json border_json(double lightness, const color::Xyz& white, display::Screen screen, const Most& most_chroma) {
  constexpr int kStep_deg = 5;
  Json border = Json::array();
  for (int hue_deg = 0; hue_deg < 360; hue_deg += kStep_deg) {
    const double chroma = most_chroma(lightness, hue_deg), h = hue_deg * kDegree;
    const color::Lab lab{lightness, chroma * math::cos(h), chroma * math::sin(h)};
    border.push_back({{"a", lab.a}, {"b", lab.b}, {"css", display::css_color(lab, white, screen)}});
  }
  return border;
}

Json print_json(const color::Lab& lab, const color::PrintGamut& print) {
  const color::Lab nearest = print.nearest(lab);
  Json json = {{"de00", color::delta_e_2000(lab, nearest)}, {"nearest", lab_json(nearest)}};
  constexpr int kSteps = 100;
  for (int i = 0; i <= kSteps; ++i) {
    const double lightness = std::lerp(print.darkest, print.lightest, 1.0 * i / kSteps);
    if (print.most(lightness, color::hue_deg(lab)) < color::chroma(lab)) continue;
    if (!json.contains("low")) json["low"] = lightness;
    json["high"] = lightness;
  }
  return json;
}

Json metrics_json(const paint::PaintMetrics& metrics) {
  Json json = Json::object();
  for (const paint::MetricColumn& column : paint::metric_columns())
    json[column.name] = json_number(metrics.*column.value);
  json["flags"] = metrics.flags;
  return json;
}

}  // namespace

color::Xyz screen_white(const color::ViewingCondition& condition) {
  const auto white = color::white_point(condition);
  return white.ok() ? *white : color::Xyz{0.9504, 1, 1.0888};
}

display::Screen screen_of(JsonReader& request) {
  const std::string name = request.text("screen", "srgb");
  if (name != "srgb" && name != "display-p3") request.fail("srgb or display-p3", "screen");
  return name == "srgb" ? display::Screen::kSrgb : display::Screen::kDisplayP3;
}

std::string css_color(const color::Lab& lab, const color::ViewingCondition& condition, display::Screen screen) {
  return display::css_color(lab, screen_white(condition), screen);
}

Result<Json> description(const paint::Paint& paint, display::Screen screen, const color::PrintGamut* print) {
  const color::ViewingCondition condition = paint::condition_of(paint);
  GONIO_TRY([&]() -> Result<void> {
    const auto white = color::white_point(condition);
    return white.ok() ? Result<void>() : Result<void>(white.error());
  }());
  paint::Appearance appearance;
  if (paint.appearance) {
    appearance = *paint.appearance;
  } else {
    GONIO_ASSIGN(
        const paint::AppearanceFit fit,
        paint::appearance_from_rows(paint.measurement ? paint.measurement->rows : std::vector<paint::LabReading>()));
    appearance = fit.appearance;
  }
  GONIO_ASSIGN(const paint::TargetCurve curve, paint::TargetCurve::make(paint, paint::TargetCurve::Kind::kMeasured));
  GONIO_ASSIGN(const paint::PaintMetrics metrics, paint::metrics(paint));
  const paint::AverageColor average = paint::average_color(appearance);
  Json json = {{"name", paint.name}, {"code", paint.code}, {"class", paint::paint_class_name(paint.paint_class)}};
  json["appearance"] = {{"face", lab_json(appearance.face)},
                        {"flop", lab_json(appearance.flop)},
                        {"travel", appearance.travel_deg},
                        {"fitted", !paint.appearance},
                        {"face_css", css_color(appearance.face, condition, screen)},
                        {"flop_css", css_color(appearance.flop, condition, screen)}};
  const color::Xyz white = screen_white(condition);
  json["screen"] = {{"face", screen_json(appearance.face, white, screen)},
                    {"flop", screen_json(appearance.flop, white, screen)},
                    {"border", border_json(appearance.face.L, white, screen, [&](double lightness, double hue_deg) {
                       return display::screen_chroma(lightness, hue_deg, white, screen);
                     })}};
  if (print != nullptr)
    json["print"] = {
        {"name", print->name},
        {"face", print_json(appearance.face, *print)},
        {"flop", print_json(appearance.flop, *print)},
        {"border", border_json(std::clamp(appearance.face.L, print->darkest, print->lightest), white, screen,
                               [&](double lightness, double hue_deg) { return print->most(lightness, hue_deg); })}};
  json["average"] = {{"L", average.L}, {"chroma", average.chroma}, {"hue", average.hue_deg}};
  json["gloss"] = Json::array();
  for (const paint::GlossReading& reading : paint.gloss)
    json["gloss"].push_back({{"angle", reading.angle_deg}, {"units", reading.gloss_units}});
  const paint::Anisotropy brushed = paint.anisotropy.value_or(paint::Anisotropy{});
  json["anisotropy"] = {brushed.alpha_x, brushed.alpha_y};
  if (const auto known = paint::known_flakes(paint)) {
    const auto& [diameter_um, coverage, spread_deg] = known->flakes;
    json["flakes"] = {{"values", {diameter_um, coverage, spread_deg}}, {"assumed", known->assumed}};
  }
  json["rows"] = rows_json(paint, condition, screen);
  json["measured"] = curve.kind() == paint::TargetCurve::Kind::kMeasured;
  json["curve"] = Json::array();
  for (const double angle : drawn_angles_deg()) {
    const color::Lab lab = curve.at(angle);
    json["curve"].push_back({{"angle", angle}, {"lab", lab_json(lab)}, {"css", css_color(lab, condition, screen)}});
  }
  json["metrics"] = metrics_json(metrics);
  return Result(std::move(json));
}

Json curve_json(const paint::LobeFit& fit, const color::ViewingCondition& condition) {
  const color::Xyz white = screen_white(condition);
  Json curve = Json::array();
  for (const double angle : drawn_angles_deg())
    curve.push_back(
        {{"angle", angle}, {"lab", lab_json(color::lab_from_rgb(brdf::flake_reflectance_factor(fit, angle), white))}});
  return curve;
}

}  // namespace goniochrome::studio
