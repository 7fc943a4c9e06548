#include "sketch/internal/sketch_trust.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "brdf/lobe_model.h"
#include "paint/curve.h"

namespace goniochrome::sketch {

namespace {

constexpr double kApart_de00 = 1;        // of rows by two models; lobes fitted to a designed curve miss it by less
constexpr double kOpen_de00 = 1;         // of a color, from which it is told
constexpr double kReach_deg = 2;         // about an angle, for the pixels that show it
constexpr double kExplained_de76 = 2;    // of a pixel that shows the paint found
constexpr std::size_t kFewestNear = 20;  // of these pixels; the noise of three numbers is then a quarter of a pixel's
constexpr double kLeastShare = 0.3;      // of the pixels about an angle that must show the paint found
constexpr double kLeastLobe = 0.05;      // of a lobe's peak, from which an angle is said to feel it

bool is_extrapolated(const SketchFit& fit, double angle_deg) {
  return std::ranges::find(fit.extrapolated_deg, angle_deg) != fit.extrapolated_deg.end();
}

}  // namespace

void take_shown(const formats::Basis& basis, const PaintWeights& weights, double coat_index,
                const std::function<bool(double angle_deg)>& is_told, SketchFit& fit) {
  for (paint::LabReading& row : fit.rows) {
    const double angle_deg = row.geometry.aspecular_deg;
    if (!is_told(angle_deg)) continue;
    const color::Lab shown = instrument_lab(basis, weights, coat_index, angle_deg);
    if (color::delta_e_2000(shown, row.lab) > kApart_de00) row.lab = shown;
  }
  for (const double angle_deg : paint::kExportAngles_deg) {
    const auto behind = std::ranges::find_if(
        fit.rows, [&](const paint::LabReading& row) { return row.geometry.aspecular_deg >= angle_deg; });
    if (behind != fit.rows.end() && behind->geometry.aspecular_deg == angle_deg) continue;
    fit.rows.insert(behind, {{45, angle_deg}, instrument_lab(basis, weights, coat_index, angle_deg)});
  }
}

void take_open_by_gloss(const formats::Basis& basis, const FreeLobes& found, const std::vector<FreeLobes>& others,
                        double coat_index, SketchFit& fit) {
  for (const paint::LabReading& row : fit.rows) {
    const double angle_deg = row.geometry.aspecular_deg;
    if (is_extrapolated(fit, angle_deg)) continue;
    const color::Lab own = instrument_lab(basis, {found.weights}, coat_index, angle_deg);
    double most_de00 = 0, gloss = 0;
    for (const FreeLobes& other : others) {
      const double apart = color::delta_e_2000(own, instrument_lab(basis, {other.weights}, coat_index, angle_deg));
      if (apart > most_de00) most_de00 = apart, gloss = other.gloss_60_gu;
    }
    if (most_de00 > kOpen_de00)
      fit.unsure.push_back(
          {angle_deg, most_de00,
           fmt::format("{:.0f} GU of gloss and another color there explain the pixels as well", gloss)});
  }
}

std::vector<TrustPixel> trust_pixels(const SketchInput& input, const SketchPixels& pixels,
                                     const std::function<double(std::size_t)>& difference) {
  constexpr std::size_t kMostNear = 300;
  const image::Image& image = input.buffers->image;
  const int aspecular = *input.buffers->channel("aspecular");
  std::vector<TrustPixel> shown;
  for (const double angle_deg : paint::kExportAngles_deg) {
    std::vector<std::size_t> near;
    for (std::size_t i = 0; i < pixels.used.size(); ++i) {
      const float at = image.data[static_cast<std::size_t>(pixels.used[i]) * image.channels + aspecular];
      if (std::abs(at - angle_deg) <= kReach_deg) near.push_back(i);
    }
    const std::size_t step = std::max<std::size_t>(1, near.size() / kMostNear);
    for (std::size_t i = 0; i < near.size(); i += step) shown.push_back({angle_deg, difference(near[i])});
  }
  return shown;
}

void take_thinly_seen(const std::vector<TrustPixel>& pixels, SketchFit& fit) {
  for (const paint::LabReading& row : fit.rows) {
    const double angle_deg = row.geometry.aspecular_deg;
    if (is_extrapolated(fit, angle_deg)) continue;
    std::size_t near = 0, explained = 0;
    for (const TrustPixel& pixel : pixels) {
      if (!(std::abs(pixel.aspecular_deg - angle_deg) <= kReach_deg)) continue;
      ++near, explained += pixel.de76 <= kExplained_de76 ? 1 : 0;
    }
    const bool few = explained < kFewestNear;
    if (!few && static_cast<double>(explained) >= kLeastShare * static_cast<double>(near)) continue;
    fit.unsure.push_back({angle_deg, std::nullopt,
                          fmt::format("{} of the {} pixels within {:.0f} deg of it show the paint found, too few",
                                      explained, near, kReach_deg)});
  }
}

void take_left_out(const std::vector<std::string>& left_out, SketchFit& fit) {
  constexpr std::string_view kLobe = "lobe-";
  for (const std::string& effect : left_out) {
    if (!effect.starts_with(kLobe)) continue;
    const auto exponent = parse_number(effect.substr(kLobe.size()));
    if (!exponent) continue;
    for (const paint::LabReading& row : fit.rows)
      if (lobe_at(row.geometry.aspecular_deg, *exponent) >= kLeastLobe)
        fit.unsure.push_back(
            {row.geometry.aspecular_deg, std::nullopt, fmt::format("the picture was drawn without {}", effect)});
  }
}

}  // namespace goniochrome::sketch
