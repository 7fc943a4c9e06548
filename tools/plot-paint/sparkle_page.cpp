#include "sparkle_page.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/angles.h"
#include "base/encode.h"
#include "base/text.h"
#include "brdf/disc_light.h"
#include "brdf/flake_tree.h"
#include "brdf/flakes.h"
#include "brdf/lobe_model.h"
#include "display/paint_view.h"
#include "image/byte_image.h"

namespace goniochrome::tool {

namespace {

constexpr double kIncidence_deg = 45, kAcuity_rad = kDegree / 60;
constexpr double kNearest_m = 0.1, kFarthest_m = 30;
constexpr int kSteps = 60;
constexpr int kPlate = 96;  // pixels
constexpr double kMiddleGray = 0.18;

// The light of a level panel. Its varying part has a variance over square meters, relative to its square.
struct PanelLight {
  color::Rgb all, varying;
  double variance_m2 = 0;

  double contrast_m() const {
    return color::luminance(all) > 0 ? std::sqrt(variance_m2) * color::luminance(varying) / color::luminance(all) : 0;
  }
};

// The lobes that have flakes, and their shares of these.
std::vector<brdf::FlakeLamp::Lobe> flake_lobes(const paint::LobeFit& fit) {
  const std::vector<double> shares = brdf::flake_shares(fit);
  std::vector<brdf::FlakeLamp::Lobe> lobes;
  for (std::size_t j = 0; j < shares.size(); ++j)
    if (shares[j] > 0) lobes.push_back({fit.lobes[j].exponent, shares[j], nullptr, nullptr});
  return lobes;
}

color::Rgb weight_of(const paint::LobeFit& fit, double exponent) {
  for (const paint::Lobe& lobe : fit.lobes)
    if (lobe.exponent == exponent) return lobe.directional_diffuse;
  return {};
}

// The panel in the sun, seen at that angle from the mirror direction.
PanelLight in_sun(const paint::LobeFit& fit, const paint::Flakes& flakes, double aspecular_deg) {
  const Vec3 normal{0, 0, 1};
  const double view_rad = (kIncidence_deg - aspecular_deg) * kDegree, light_rad = kIncidence_deg * kDegree;
  const Vec3 to_viewer{std::sin(view_rad), 0, std::cos(view_rad)},
      to_light{-std::sin(light_rad), 0, std::cos(light_rad)};
  const Vec3 mirrored = 2 * dot(normal, to_viewer) * normal - to_viewer;
  const paint::LobeFit seen = brdf::at_view(fit, std::abs(view_rad) / kDegree);
  const brdf::FlakeLamp sun(flake_lobes(fit), 0.5 * brdf::kSunExtent_deg * kDegree, flakes.spread_deg);
  PanelLight light;
  light.all = kPi * to_light.z * brdf::brdf(seen, to_light, to_viewer, normal);
  for (std::size_t j = 0; j < sun.lobes.size(); ++j)
    light.varying += brdf::disc_light(sun, j, normal, mirrored, to_light, seen.coat_index) *
                     brdf::coat_transmission(to_viewer.z, seen.coat_index) * weight_of(seen, sun.lobes[j].exponent);
  light.variance_m2 = to_viewer.z * brdf::disc_variance(sun, normal, mirrored, to_light) / flakes.per_m2();
  return light;
}

// The panel under a cloud, three times as bright above as at the horizon, seen from above. Lobes share out the flakes,
// and their variances add.
PanelLight under_cloud(const paint::LobeFit& fit, const paint::Flakes& flakes) {
  constexpr int kRings = 512;
  const Vec3 normal{0, 0, 1};
  const paint::LobeFit seen = brdf::at_view(fit, 0);
  const auto over_sky = [&](const auto& value) {
    auto sum = 0.0 * value(normal, 1.0);
    for (int i = 0; i < kRings; ++i) {
      const double angle = (i + 0.5) * kPi / (2 * kRings), cosine = std::cos(angle);
      sum +=
          kPi * kPi / kRings * std::sin(angle) * cosine * value(Vec3{std::sin(angle), 0, cosine}, (1 + 2 * cosine) / 3);
    }
    return sum;
  };
  PanelLight light;
  light.all = over_sky([&](const Vec3& d, double sky) { return sky * brdf::brdf(seen, d, normal, normal); });
  double variance = 0;
  for (const brdf::FlakeLamp::Lobe& lobe : flake_lobes(fit)) {
    const auto moment = [&](int order) {
      return over_sky([&](const Vec3& d, double sky) { return std::pow(d.z, lobe.exponent) * std::pow(sky, order); });
    };
    const color::Rgb of_lobe = over_sky([&](const Vec3& d, double sky) {
      return sky * std::pow(d.z, lobe.exponent) * brdf::coat_transmission(d.z, seen.coat_index) *
             brdf::coat_transmission(1, seen.coat_index) * weight_of(seen, lobe.exponent);
    });
    light.varying += of_lobe;
    variance += std::pow(color::luminance(of_lobe), 2) * (moment(2) * moment(0) / std::pow(moment(1), 2) - 1) /
                (lobe.share * flakes.per_m2());
  }
  if (color::luminance(light.varying) > 0) light.variance_m2 = variance / std::pow(color::luminance(light.varying), 2);
  return light;
}

// A square of the panel as an eye sees it: a pixel is one minute of arc, and the mean a middle gray.
report::Drawing plate(const PanelLight& light, const paint::Flakes& flakes, double distance_m,
                      const std::string& name) {
  image::ByteImage picture{kPlate, kPlate, {}};
  const brdf::FlakeTree tree(flakes.per_m2(), 0);
  brdf::FlakeBox box;
  box.size = {distance_m * kAcuity_rad, distance_m * kAcuity_rad};
  const double of_flake = light.variance_m2 * flakes.per_m2();
  box.shown = std::min(1.0, 1 / std::max(1e-9, of_flake));
  const double varying = std::sqrt(box.shown * of_flake), expected = flakes.per_m2() * box.area() * box.shown,
               exposure = kMiddleGray / std::max(1e-9, color::luminance(light.all));
  for (int i = 0; i < kPlate * kPlate; ++i) {
    box.place = {(i % kPlate) * box.size[0], (i / kPlate) * box.size[1]};
    const color::Rgb shown = light.all + varying * (tree.count(box) / expected - 1) * light.varying;
    for (int c = 0; c < 3; ++c)
      picture.rgb.push_back(static_cast<std::uint8_t>(
          std::lround(255 * display::srgb_signal(std::clamp(exposure * shown[c], 0.0, 1.0)))));
  }
  return {kPlate + 10, kPlate + 24,
          fmt::format("<text x=\"8\" y=\"14\" style=\"font-size:12px\">{}, {} m</text>"
                      "<image x=\"8\" y=\"20\" width=\"{}\" height=\"{}\" href=\"data:image/png;base64,{}\"/>\n",
                      name, shortest(distance_m), kPlate, kPlate, base64(image::png_content(picture)))};
}

// Readings of sparkle by instruments, on their own scales.
std::string readings_text(const paint::Paint& paint) {
  std::string text;
  if (paint.measurement)
    for (const paint::TextureReading& reading : paint.measurement->textures)
      text += fmt::format("{}{} {} {}", text.empty() ? "" : ", ", reading.quantity, reading.geometry,
                          shortest(reading.value));
  return text.empty() ? "" : "instrument, on its own scale: " + text;
}

}  // namespace

report::Drawing sparkle_page(const paint::Paint& paint, const paint::KnownFlakes& known) {
  report::Plot plot;
  plot.title = paint.name;
  plot.x = {.label = "distance (m)", .logarithmic = true, .low = kNearest_m, .high = kFarthest_m};
  plot.y = {.label = "contrast of grain in the sun", .logarithmic = true};
  for (const double aspecular_deg : {15.0, 25.0, 45.0}) {
    const double contrast_m = in_sun(*paint.lobes, known.flakes, aspecular_deg).contrast_m();
    report::Series series{.label = fmt::format("{} deg from specular", aspecular_deg)};
    for (int i = 0; i <= kSteps; ++i) {
      const double distance = kNearest_m * std::pow(kFarthest_m / kNearest_m, static_cast<double>(i) / kSteps);
      series.x.push_back(distance);
      series.y.push_back(contrast_m / (distance * kAcuity_rad));
    }
    plot.series.push_back(std::move(series));
  }
  const std::string lines[] = {
      "flakes of " + paint::flakes_text(paint, known),
      fmt::format("sun at {} deg, {} deg wide; patches of 1 minute of arc; none under an even sky",
                  shortest(kIncidence_deg), shortest(brdf::kSunExtent_deg)),
      "below, a pixel is one patch: sun 25 deg from specular, and a cloud that is brightest above",
      readings_text(paint)};
  report::Drawing caption{plot.width, 84, ""};
  int y = 16;
  for (const std::string& line : lines) {
    if (line.empty()) continue;
    caption.body +=
        fmt::format("<text x=\"12\" y=\"{}\" style=\"font-size:12px\">{}</text>\n", y, xml_escaped(line, ""));
    y += 18;
  }
  std::vector<report::Drawing> plates;
  for (const auto& [light, name] :
       {std::pair(in_sun(*paint.lobes, known.flakes, 25), "sun"), {under_cloud(*paint.lobes, known.flakes), "cloud"}})
    for (const double distance_m : {0.3, 1.0, 3.0}) plates.push_back(plate(light, known.flakes, distance_m, name));
  return report::column_of({report::drawing(plot), caption, report::row_of(plates)});
}

}  // namespace goniochrome::tool
