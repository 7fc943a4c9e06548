// Paints whose lobes make given lights look as a picture shows them. Internal to lib/fit.
// [Shimizu2009] 3.7.5, goniochrome-theory(7), SKETCH FITTING.
#pragma once

#include <vector>

#include "fit/paint_fit.h"
#include "fit/sketch.h"
#include "fit/sketch_solve.h"

namespace goniochrome {

// What was seen, and the light of each part of the lobe model with weight 1 (1/sr) there, all relative to white.
struct SearchSamples {
  std::size_t columns = 0;  // K_D, then K_DD and K_G of every lobe of the basis, then the mirror
  std::vector<Vec3> light;  // `columns` for each sample
  std::vector<Rgb> seen;
  std::vector<double> importance;                     // of each sample; more than 0
  std::optional<ReflectionOperator> reflection = {};  // as that of a SketchLight
  bool display = false;  // seen on an sRGB display, whose gamut is then part of the picture
};

// A paint found: eight numbers (face, flop, travel, gloss), or ten (Lab at 15, 45 and 110 deg, gloss).
struct FoundPaint {
  SearchResult search;
  std::vector<Rgb> weights;  // of its lobes, in the order of the columns
  bool exact = false;        // those of least absolute error
  Paint paint() const;
  bool has_free_rows() const { return search.values.size() == 10; }
};

class LobeSearch {
 public:
  LobeSearch(const Basis& basis, SearchSamples samples);

  // From four starts, and nine more where they find no exact agreement in a clean picture, all in the samples of
  // `first`, a part of these; the best goes on in all samples, and then, unless face, flop and travel explain them as
  // well, with the colors at three angles freed.
  FoundPaint find(const LobeSearch& first) const;

  // The cost of a paint found, with another gloss (gloss units).
  double cost_with_gloss(const FoundPaint& found, double gloss) const;

  // The matt reflectance factor that explains the samples best.
  Rgb matt() const;

 private:
  std::vector<Rgb> weights(const PaintFitter& fitter, const std::vector<double>& values) const;
  void residuals(const std::vector<Rgb>& weights, std::vector<double>& out) const;
  double cost(const std::vector<double>& values) const;
  SearchResult run(const PaintFitter& fitter, const std::vector<SearchParameter>& start) const;
  LobeFit linear() const;
  std::vector<double> linear_channel(int channel) const;
  void scan_gloss(std::vector<SearchParameter>& start) const;
  std::vector<std::vector<SearchParameter>> starts() const;
  static std::vector<std::vector<SearchParameter>> further_starts(const std::vector<SearchParameter>& first);
  FoundPaint best_of_starts() const;
  SearchResult best_rows(const SearchResult& appearance) const;

  Basis basis_;
  PaintFitter smooth_, exact_;  // least squares, whose weights follow a paint smoothly; least absolute error
  SearchSamples samples_;
  std::vector<Lab> target_;
};

// The light that weights make of one sample's columns.
Rgb shown_light(const Vec3* columns, const std::vector<Rgb>& weights,
                const std::optional<ReflectionOperator>& reflection);

}  // namespace goniochrome
