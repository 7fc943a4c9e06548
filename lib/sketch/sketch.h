// From an edited picture of a painted mesh back to the paint: under one directional light, and under any other light.
// [Shimizu2009] 3.7, goniochrome-sketches(7), "SKETCH FITTING".
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "base/vec3.h"
#include "color/color.h"
#include "color/reflection.h"
#include "formats/basis.h"
#include "paint/paint.h"
#include "sketch/sketch_pixels.h"

namespace goniochrome::sketch {

// Beyond these limits the answer is the matt color that explains the pixels best.
struct SketchLimits {
  double median_de76 = 10;     // the median difference between the pixels and the paint found
  double least_span_deg = 20;  // of aspecular angles
  // The standard error of the color at 15 deg where no pixel shows that angle. Measured paints differ from their mean
  // color there by less than this (RMS), so that a face with a larger error would be worse than one guessed without a
  // picture.
  double face_error_de76 = 50;
};

// A used pixel: the picture, and the paint found there. Lab relative to white.
struct PixelPair {
  color::Lab seen, shown;
  double de76() const { return color::delta_e_76(seen, shown); }
};

// How far the picture is from the paint found at the pixels of ten degrees.
struct AngleResidual {
  double from_deg = 0, to_deg = 0;
  std::size_t pixels = 0;
  double median_de76 = 0;
  color::Lab mean;  // of picture less paint: L is above 0 where the picture is lighter
};

struct SketchFit {
  std::string status = "fitted";  // or "diffuse_fallback"
  std::string reason;             // for the fallback
  std::string model;              // "lobes", "quadratic", "search" or "diffuse"
  paint::Appearance appearance;
  std::vector<paint::LabReading> rows;   // at the export angles
  std::vector<double> extrapolated_deg;  // angles of those rows that no pixel shows
  double gloss_60_gu = 0;
  std::string gloss_from;  // "highlight", "contrast" or "search"; "undetermined" where the pixels cannot tell it
  // The readings that explain the pixels as well, where they were looked for or nothing tells the gloss; else both are
  // 0.
  double gloss_low_gu = 0, gloss_high_gu = 0;
  double condition = 0;
  double rms_de76 = 0, median_de76 = 0;  // edited picture against the paint found, relative to white
  double seen_from_deg = 0, seen_to_deg = 0;
  std::string residual_angle;  // "aspecular", "view" (of the viewer from the normal), or "" where none is known
  std::vector<AngleResidual> residual;  // ascending; where pixels are
  bool by_views = false;                // the paint found has weights for several views
  std::vector<color::Rgb> weights;      // of the lobes found, in the order of search_columns(); none of a point light
  std::vector<PixelPair> pixels;        // every used one, in the order of SketchPixels::used; where asked for
};

// The paint under one directional light, whose effect at each pixel is computed exactly. The answer is the lobe curve
// or the clamped quadratic, whichever explains the pixels better; or the result of a search for face, flop, travel and
// gloss in lobes of `basis`, where that explains them as well.
SketchFit sketch_point(const SketchInput& input, const SketchPixels& pixels, const formats::Basis& basis,
                       const SketchLimits& limits, bool with_differences);

// A light of any kind, by what the renderer's equations make of it.
struct SketchLight {
  formats::Basis basis;
  std::optional<color::ReflectionOperator> reflection;  // of light and paint, in place of the component-wise product
  // The light of each part of the model with weight 1 (1/sr) at a place of the buffers, relative to white: K_D, then
  // K_DD and K_G of every lobe, then the mirror.
  std::function<void(std::uint32_t place, Vec3* columns)> shade;
  double coat_index = paint::kNoCoat;  // of the coat through which K_D and K_DD are lit
};

// The number of those parts.
std::size_t search_columns(const formats::Basis& basis);

// The paint under this light: face, flop, travel and gloss by a nonlinear search.
SketchFit sketch_environment(const SketchInput& input, const SketchPixels& pixels, const SketchLight& light,
                             const SketchLimits& limits, bool with_differences);

// Fits under lamps that are discs: their highlights, glare included, determine the gloss. Few pixels show them, so that
// all of these are looked at. Gloss is "undetermined" where readings more than 10 units apart explain them as well.
SketchFit sketch_lamps(const SketchInput& input, const SketchPixels& pixels, const SketchLight& light,
                       const SketchLimits& limits, bool with_differences);

// The paint found as it is written to a file: rows, face, flop, travel and gloss. A fallback is a solid paint.
paint::Paint sketch_paint(const SketchFit& fit, const std::string& name);

// True if a paint of weights >= 0 can have a color within that distance of this reflectance factor.
bool is_paint_color(const color::Rgb& rgb, double within_de76);

}  // namespace goniochrome::sketch
