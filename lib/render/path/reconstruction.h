// Reconstructs light on a surface from noisy samples of it. Several filters of growing reach smooth it along the
// surface; two independent halves of the samples tell which of them errs least at each point, and by how much.
// goniochrome-paths(7), "RECONSTRUCTION".
#pragma once

#include <array>
#include <limits>
#include <vector>

#include "color/color.h"
#include "rays/float3.h"

namespace goniochrome::render {

// A piece of surface that a pixel shows.
struct ShownPiece {
  int part = 0;  // Pieces of different parts are never mixed.
  rays::Float3 normal, position;
  float share = 1;  // of the pixel
};

// At an edge a pixel shows several pieces, and is reconstructed as their sum. Other pixels show one, and are what
// filters learn from.
struct ShownPoint {
  int x = 0, y = 0;  // pixel, from any corner above and left of all points; the nearest takes the least memory
  ShownPiece piece;
  std::vector<ShownPiece> pieces = {};  // at edges
};

// Two independent estimates of one light, from either half of its samples.
using Halves = std::array<color::Rgb, 2>;
// Both of a point without samples, which its neighbors tell.
constexpr color::Rgb kUnknown{std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN(),
                              std::numeric_limits<double>::quiet_NaN()};

// The part of each filter in the light of a point; that of the samples as they are comes first.
constexpr std::size_t kFilterChoices = 6;
using FilterShares = std::array<float, kFilterChoices>;

struct Reconstruction {
  std::vector<color::Rgb> light;  // of each point
  std::vector<float> error_de00;  // its standard error, over the neighborhood; infinite where nothing tells a point
  // The error of samples that have a large part of the variance of their neighborhood, over which filters spread it as
  // a blotch; 0 of all other points.
  std::vector<float> spike_de00;
  std::vector<FilterShares> shares;
};

// None: the light is the mean of its samples, and errors are told by neighborhoods alone, so that the number of samples
// does not depend on what they found.
enum class Filters { kChosen, kNone };

// `beside` is what each point shows beside the light that is reconstructed; with it, errors are seen before a white of
// this luminance. `samples`: how many each point has, or nothing where all have as many. Points come row by row, at
// most one for each pixel. Bit-identical for any number of threads.
Reconstruction reconstruction(const std::vector<ShownPoint>& points, const std::vector<Halves>& halves,
                              const std::vector<color::Rgb>& beside, double white_luminance,
                              const std::vector<float>& samples = {}, Filters filters = Filters::kChosen);

// Smooths two lights of each point by filters that reconstruction() chose for other light there.
std::vector<Halves> smoothed(const std::vector<ShownPoint>& points, const std::vector<Halves>& lights,
                             const std::array<const std::vector<FilterShares>*, 2>& shares);

}  // namespace goniochrome::render
