// The color of a paint against aspecular angle from the pixels of a picture under one point light. Internal to lib/fit.
// [Shimizu2009] 3.7.3, goniochrome-theory(7), SKETCH FITTING.
#pragma once

#include <array>
#include <vector>

#include "color/color.h"

namespace goniochrome::sketch {

// What many pixels of nearly the same angles show, outliers among them put aside.
struct SketchCell {
  double aspecular_deg = 0, cos_i = 0, count = 0;
  color::Rgb seen;  // light relative to a white that faces the lamp
};

// How much a cell counts, 0..1: the root of its samples' number, so that the few pixels near specular are heard beside
// the many of a flat roof; 64 samples have their full say.
double cell_importance(const SketchCell& cell);

// Every how many-th of `count` cells to take for about `most` of them. Cells stand in rows of twelve cosines, of which
// all are to be met: the step shares no factor with twelve.
std::size_t sketch_step(std::size_t count, std::size_t most);

struct SketchSample {
  float aspecular_deg, cos_i;
  std::array<float, 3> seen;
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

  color::Rgb reflectance(double aspecular_deg) const;
  color::Rgb gloss(double aspecular_deg) const;
};

struct CurveFit {
  SketchCurve curve;
  double cost = 0;       // robust, comparable between curves of the same cells
  double condition = 0;  // of the quadratic's columns, each of length 1
};

// The clamped quadratic whose travel, scanned, costs least; channels by weighted least squares, cells reweighted by how
// well they agree. At least three cells.
CurveFit fit_quadratic(const std::vector<SketchCell>& cells);

// Non-negative cosine lobes, for flake light times cos_i and for gloss without it, likewise reweighted.
CurveFit fit_lobes(const std::vector<SketchCell>& cells);

// The matt color that explains the cells best: mean of seen/cos_i, weighted.
color::Rgb mean_diffuse(const std::vector<SketchCell>& cells);

}  // namespace goniochrome::sketch
