// The paints of a library nearest to a paint. [Shimizu2009] 5.3.5; goniochrome-theory(7), NEAREST PAINT.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "base/result.h"
#include "library/internal/search.h"
#include "library/library_index.h"
#include "paint/metrics_filter.h"

namespace goniochrome::library {

struct LibrarySearchOptions {
  std::size_t count = 5;
  ColorMetric metric = ColorMetric::kDe76;
  std::optional<SearchMethod> method = {};                       // the faster one, if not said
  std::vector<paint::Geometry> geometries = {};                  // to compare; empty: those that are shared
  std::vector<std::pair<paint::Geometry, double>> weights = {};  // >= 0; 1 for the others
  std::vector<paint::MetricRange> ranges = {};                   // of the library's paints, all to be met
  std::vector<paint::PaintClass> classes = {};                   // of the library's paints; empty: any
  bool mix_conditions = false;  // compare Lab of different illuminants and observers as they are
};

// What a query is compared by.
struct SearchPlan {
  std::vector<SearchTerm> terms;  // in the order of `geometries`; SearchTerm::geometry is set for each section
  std::vector<paint::Geometry> geometries;       // ascending
  std::vector<std::size_t> sections;             // of the index, those that have all geometries
  std::size_t left_out = 0;                      // library paints that lack one of them
  std::optional<color::ViewingCondition> mixed;  // a condition of the library that is not the query's
};

struct LibraryMatch {
  std::uint32_t paint = 0;      // in the library
  double distance = 0;          // sum of weight times difference
  std::vector<color::Lab> lab;  // at the plan's geometries
};

class LibrarySearch {
 public:
  // The index must outlive the search. Applies the filters to the library once.
  LibrarySearch(const LibraryIndex& index, LibrarySearchOptions options);

  // Paints of all sections, or of one, that pass the filters.
  std::size_t candidates() const;
  std::size_t candidates(std::size_t section) const { return passing_[section]; }

  // The method used for a section.
  SearchMethod method(std::size_t section) const;

  // Which geometries `query` and the library are compared at: those asked for, or else those that it shares with the
  // most paints, of sets of three or more (face, middle and flop) as long as there is one. Error: no color, none in
  // common, another viewing condition.
  Result<SearchPlan> plan(const paint::Paint& query) const;

  // The nearest paints, nearest first, ties in the library's order; fewer than asked for where the filters leave fewer.
  std::vector<LibraryMatch> nearest(const SearchPlan& plan) const;

 private:
  std::vector<paint::Geometry> shared_geometries(const std::vector<paint::LabReading>& rows) const;

  const LibraryIndex& index_;
  LibrarySearchOptions options_;
  std::vector<std::vector<LeafMask>> masks_;  // by section; empty: no filter
  std::vector<std::size_t> passing_;          // by section
};

}  // namespace goniochrome::library
