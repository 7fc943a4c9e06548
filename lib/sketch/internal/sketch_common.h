// Shared by the ways to fit a sketch. Internal to lib/fit.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "math/statistics.h"
#include "sketch/internal/sketch_search.h"
#include "sketch/sketch.h"

namespace goniochrome::sketch {

// How well a paint explains the pixels: RMS and median of the differences, and all of them where asked for.
// difference(i) is that of the i-th used pixel. At most kJudged pixels are looked at for the figures.
template <class Difference>
void judge_sketch(std::size_t count, bool all, Difference&& difference, SketchFit& fit) {
  constexpr std::size_t kJudged = 20000;
  const std::size_t step = all ? 1 : std::max<std::size_t>(1, count / kJudged);
  std::vector<float> values;
  for (std::size_t i = 0; i < count; i += step) values.push_back(static_cast<float>(difference(i)));
  if (values.empty()) return;
  double squares = 0;
  for (const float value : values) squares += static_cast<double>(value) * value;
  fit.rms_de76 = std::sqrt(squares / static_cast<double>(values.size()));
  if (all) fit.de76 = values;
  fit.median_de76 = math::median(std::move(values));
}

// Lab of a working-space color relative to white 1, as paints carry it.
inline color::Lab paint_lab(const color::Rgb& rgb) {
  static const color::Xyz white = *color::white_point({});
  return color::lab_from_rgb(rgb, white);
}

// What of a color the edited picture could show.
inline color::Rgb as_displayed(const color::Rgb& rgb, const SketchInput& input) {
  return input.edited->scene_linear ? rgb : in_display_gamut(rgb);
}

// Whether a paint of weights >= 0 can have a color within that distance of this reflectance factor.
inline bool is_paint_color(const color::Rgb& rgb, double within_de76) {
  const color::Rgb nearest{std::max(rgb.x, 0.0), std::max(rgb.y, 0.0), std::max(rgb.z, 0.0)};
  return color::delta_e_76(paint_lab(rgb), paint_lab(nearest)) <= within_de76;
}

// Turns `fit` into the matt color, of which `color` is the reflectance factor.
void fall_back(const color::Rgb& color, const std::string& reason, SketchFit& fit);
std::string poor_match(const SketchFit& fit);

// Rows, face, flop, travel, gloss and condition of a search.
void take_found(const FoundPaint& found, SketchFit& fit);

}  // namespace goniochrome::sketch
