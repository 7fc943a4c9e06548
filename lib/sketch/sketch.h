// From an edited picture of a painted mesh back to the paint. [Shimizu2009] 3.7, goniochrome-theory(7), SKETCH FITTING.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "base/vec3.h"
#include "color/reflection.h"
#include "formats/basis.h"
#include "paint/paint.h"
#include "sketch/internal/sketch_pixels.h"

namespace goniochrome::sketch {

struct SketchLimits {
  double median_de76 = 10;     // half of the pixels may differ by more than the found paint explains
  double least_span_deg = 20;  // of aspecular angles
  // The standard error of a face that no pixel shows. More is more than measured paints differ from their mean at 15
  // deg, RMS, and tells less of the face than no picture does.
  double face_error_de76 = 50;
};

struct SketchFit {
  std::string status = "fitted";  // or "diffuse_fallback"
  std::string reason;             // for the fallback
  std::string model;              // "lobes", "quadratic", "search" or "diffuse"
  paint::Appearance appearance;
  std::vector<paint::LabReading> rows;   // at the export angles
  std::vector<double> extrapolated_deg;  // angles of those rows that no pixel shows
  double gloss_60_gu = 0;
  std::string gloss_from;  // "highlight", "contrast" or "search"
  double condition = 0;
  double rms_de76 = 0, median_de76 = 0;  // edited picture against the paint found, relative to white
  double seen_from_deg = 0, seen_to_deg = 0;
  std::vector<float> de76;  // of every used pixel, in the order of SketchPixels::used; where asked for
};

// One directional light, exactly: the lobe curve or the clamped quadratic, whichever explains the pixels better. The
// search for face, flop, travel and gloss in lobes of `basis` is preferred where it explains them as well.
SketchFit sketch_point(const SketchInput& input, const SketchPixels& pixels, const formats::Basis& basis,
                       const SketchLimits& limits, bool with_differences);

// Seven lobes and the mirror: the basis of point light where none is named.
formats::Basis sketch_basis();

// What any light makes of the lobe model. The renderer's equations stand behind it.
struct SketchLight {
  formats::Basis basis;
  std::optional<color::ReflectionOperator> reflection;  // of light and paint, in place of the component-wise product
  // The light of each part of the model with weight 1 (1/sr) at a place of the buffers, relative to white: K_D, then
  // K_DD and K_G of every lobe, then the mirror.
  std::function<void(std::uint32_t place, Vec3* columns)> shade;
};
std::size_t search_columns(const formats::Basis& basis);

// Face, flop, travel and gloss by nonlinear search under this light.
SketchFit sketch_environment(const SketchInput& input, const SketchPixels& pixels, const SketchLight& light,
                             const SketchLimits& limits, bool with_differences);

// The found paint as it is written: rows, face, flop, travel and gloss; a fallback is solid.
paint::Paint sketch_paint(const SketchFit& fit, const std::string& name);

// By how many pixels the edited picture seems to lie to the right of and below the buffers' own: the shift, up to 8
// pixels either way, at which the edges of both meet best.
struct SketchShift {
  int x = 0, y = 0;
};
SketchShift sketch_shift(const SketchInput& input);

}  // namespace goniochrome::sketch
