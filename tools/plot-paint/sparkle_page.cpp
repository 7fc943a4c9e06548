#include "sparkle_page.h"

#include <cmath>

#include "base/angles.h"
#include "base/text.h"
#include "brdf/disc_light.h"
#include "brdf/flakes.h"
#include "brdf/lobe_model.h"

namespace goniochrome::tool {

namespace {

constexpr double kIncidence_deg = 45, kAcuity_rad = kDegree / 60;
constexpr double kNearest_m = 0.1, kFarthest_m = 30;
constexpr int kSteps = 60;

// The variance of what a square meter shows, relative to the mean squared, under the sun and seen at that angle from
// the mirror direction; luminance.
double variance_m2(const paint::LobeFit& fit, const paint::Flakes& flakes, double aspecular_deg) {
  const Vec3 normal{0, 0, 1};
  const double view_rad = (kIncidence_deg - aspecular_deg) * kDegree, light_rad = kIncidence_deg * kDegree;
  const Vec3 to_viewer{std::sin(view_rad), 0, std::cos(view_rad)},
      to_light{-std::sin(light_rad), 0, std::cos(light_rad)};
  const Vec3 mirrored = 2 * dot(normal, to_viewer) * normal - to_viewer;
  const paint::LobeFit seen = brdf::at_view(fit, std::abs(view_rad) / kDegree);
  const auto luminance = [](const color::Rgb& rgb) { return color::xyz_d65_from_rgb(rgb).Y; };
  const double mean = kPi * to_light.z * luminance(brdf::brdf(seen, to_light, to_viewer, normal));
  const std::vector<double> shares = brdf::flake_shares(fit);
  std::vector<brdf::FlakeLamp::Lobe> lobes;
  for (std::size_t j = 0; j < shares.size(); ++j) lobes.push_back({fit.lobes[j].exponent, shares[j], nullptr, nullptr});
  std::erase_if(lobes, [](const brdf::FlakeLamp::Lobe& lobe) { return lobe.share == 0; });
  const brdf::FlakeLamp sun(lobes, 0.5 * brdf::kSunExtent_deg * kDegree, flakes.spread_deg);
  double light = 0;
  for (std::size_t j = 0; j < sun.lobes.size(); ++j)
    for (const paint::Lobe& lobe : seen.lobes)
      if (lobe.exponent == sun.lobes[j].exponent)
        light += brdf::disc_light(sun, j, normal, mirrored, to_light, seen.coat_index) *
                 brdf::coat_transmission(to_viewer.z, seen.coat_index) * luminance(lobe.directional_diffuse);
  const double variance = light * light * brdf::disc_variance(sun, normal, mirrored, to_light) / flakes.per_m2();
  return mean > 0 ? variance * to_viewer.z / (mean * mean) : 0;
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
    const double variance = variance_m2(*paint.lobes, known.flakes, aspecular_deg);
    report::Series series{.label = fmt::format("{} deg from specular", aspecular_deg)};
    for (int i = 0; i <= kSteps; ++i) {
      const double distance = kNearest_m * std::pow(kFarthest_m / kNearest_m, static_cast<double>(i) / kSteps);
      series.x.push_back(distance);
      series.y.push_back(std::sqrt(variance) / (distance * kAcuity_rad));
    }
    plot.series.push_back(std::move(series));
  }
  const std::string lines[] = {
      "flakes of " + paint::flakes_text(paint, known),
      fmt::format("sun at {} deg, {} deg wide; patches of 1 minute of arc; none under an even sky",
                  shortest(kIncidence_deg), shortest(brdf::kSunExtent_deg)),
      readings_text(paint)};
  report::Drawing caption{plot.width, 66, ""};
  int y = 16;
  for (const std::string& line : lines) {
    if (line.empty()) continue;
    caption.body +=
        fmt::format("<text x=\"12\" y=\"{}\" style=\"font-size:12px\">{}</text>\n", y, xml_escaped(line, ""));
    y += 18;
  }
  return report::column_of({report::drawing(plot), caption});
}

}  // namespace goniochrome::tool
