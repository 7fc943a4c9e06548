// The color of a paint against aspecular angle, from the pixels of a picture under one point light.
// [Shimizu2009] 3.7.3, goniochrome-sketches(7), "SKETCH FITTING".
#pragma once

#include <array>
#include <vector>

#include "color/color.h"
#include "paint/paint.h"

namespace goniochrome::sketch {

// The common color of many pixels of nearly the same angles, without the outliers among them.
struct SketchCell {
  double aspecular_deg = 0, cos_i = 0, count = 0;
  color::Rgb seen;      // light relative to a white that faces the lamp
  double view_deg = 0;  // mean angle of the viewer from the normal
};

// How much a cell counts, 0..1: the root of its number of samples over 64, at most 1, so that the few pixels near
// specular count beside the many of a flat roof.
double cell_importance(const SketchCell& cell);

// The step between cells that takes about `most` of `count` cells. Cells stand in rows of twelve cosines, and the step
// shares no factor with twelve, so that all cosines are met.
std::size_t sketch_step(std::size_t count, std::size_t most);

struct SketchSample {
  float aspecular_deg, cos_i;
  std::array<float, 3> seen;
  float view_deg = 0;  // of the viewer from the normal
};

// Sorts samples into cells of a quarter of a degree and a twelfth of the cosine.
std::vector<SketchCell> sketch_cells(const std::vector<SketchSample>& samples);

// seen = cos_i reflectance(t) + gloss(t), per channel.
struct SketchCurve {
  // The clamped quadratic of the source, in u = min(t, travel)/travel: a u^2 + b u + c.
  double travel_deg = 0;  // 0: lobes
  std::array<color::Rgb, 3> quadratic{};
  // A constant and cosine lobes, all weights >= 0.
  color::Rgb diffuse;
  std::vector<double> exponents;
  std::vector<color::Rgb> flake, glare;
  // The index of the coat that these flake weights are lit through; reflectance() is then as an instrument reads it.
  double coat_index = paint::kNoCoat;

  color::Rgb reflectance(double aspecular_deg) const;
  color::Rgb gloss(double aspecular_deg) const;
};

// The share of the base's light that a coat leaves where an instrument reads that aspecular angle, see
// brdf::flake_reflectance_factor().
double instrument_passages(double aspecular_deg, double coat_index);

struct CurveFit {
  SketchCurve curve;
  double cost = 0;       // robust, comparable between curves of the same cells
  double condition = 0;  // of the quadratic's columns, each of length 1
};

// The clamped quadratic whose travel costs least. Channels are fitted by weighted least squares, and cells reweighted
// by how well they agree. There must be at least three cells.
CurveFit fit_quadratic(const std::vector<SketchCell>& cells);

// Non-negative cosine lobes, for flake light times cos_i and for gloss without it, likewise reweighted.
CurveFit fit_lobes(const std::vector<SketchCell>& cells);

// The matt color that explains the cells best: mean of seen/cos_i, weighted.
color::Rgb mean_diffuse(const std::vector<SketchCell>& cells);

}  // namespace goniochrome::sketch
