// Paints whose lobes make given lights look as a picture shows them.
// [Shimizu2009] 3.7.5, goniochrome-sketches(7), "SKETCH FITTING".
#pragma once

#include <optional>
#include <vector>

#include "fit/paint_fit.h"
#include "sketch/internal/sketch_lobes.h"
#include "sketch/internal/sketch_solve.h"
#include "sketch/sketch.h"

namespace goniochrome::sketch {

// Two values of gloss cannot be told apart where the cost of one is at most this share of the other's and this part of
// all.
inline constexpr double kSameCost = 1.05, kSameCostBy = 0.005;

// A paint found: eight numbers (face, flop, travel, gloss), ten (Lab at 15, 45 and 110 deg, gloss), or sixteen (Lab at
// the export angles, gloss), which are read off lobes of any weight.
struct FoundPaint {
  SearchResult search;
  PaintWeights weights;                      // of its lobes
  const fit::PaintFitter* fitter = nullptr;  // that made them of the numbers; null: they are free
  paint::Paint paint() const;
  const char* model() const;
};

// The ways from a paint to its lobes: least squares, whose weights follow a paint smoothly, and least absolute error.
struct SearchFitters {
  SearchFitters(const formats::Basis& basis, double coat_index);
  struct Ways {
    fit::PaintFitter smooth, exact;
  };
  brdf::GlossTable gloss;
  Ways ways;
  // Under a coat: with weights for the views of three readings, as a paint has them whose coat keeps weights for all
  // views from meeting its readings.
  std::optional<Ways> by_view;
};

class LobeSearch {
 public:
  // The fitters must outlive it.
  LobeSearch(const SearchFitters& fitters, SearchSamples samples);

  // For light from everywhere, which tells each lobe. The lobes of any weight that explain the samples best; then, from
  // there, face, flop and travel, which are the answer where they explain the samples as well, or else the colors at
  // three angles, or else those lobes; the errors of their first three numbers are then how far these are from those of
  // face, flop and travel, as lobes of any weight have no errors of their own. Ways are found in the samples of
  // `first`, a part of these.
  FoundPaint find(const LobeSearch& first) const;

  // For one lamp, whose glare is left out, so that wide gloss passes for flake: face, flop and travel, from that start
  // and more until one explains the samples exactly, or the colors at three angles where they explain them better, with
  // weights for all views or, under a coat, for several.
  FoundPaint find_plain(const LobeSearch& first) const;

  // The cost of a paint found, with another gloss (gloss units).
  double cost_with_gloss(const FoundPaint& found, double gloss) const;

  // True if a paint found explains the samples as well with another gloss (gloss units). The samples that show both
  // alike cannot tell them apart, however many there are, so that the others alone are asked.
  bool explains_as_well(const FoundPaint& found, double gloss) const;

  // The matt reflectance factor that explains the samples best.
  color::Rgb matt() const;

 private:
  PaintWeights weights(const fit::PaintFitter& fitter, const std::vector<double>& values) const;
  PaintWeights with_gloss(const FoundPaint& found, double gloss) const;
  double cost(const PaintWeights& weights) const;
  SearchResult run(const fit::PaintFitter& fitter, const std::vector<SearchParameter>& start) const;
  struct Way {
    SearchResult result;
    const fit::PaintFitter* fitter = nullptr;
  };
  Way way(const std::vector<double>& start, const SearchFitters::Ways& ways) const;
  Way best_way() const;
  void scan_gloss(const fit::PaintFitter& fitter, std::vector<double>& start) const;
  FreeLobeFit free_lobes() const { return {basis_, fitters_.gloss, samples_, target_}; }

  const SearchFitters& fitters_;
  const formats::Basis& basis_;
  SearchSamples samples_;
  std::vector<color::Lab> target_;
};

}  // namespace goniochrome::sketch
