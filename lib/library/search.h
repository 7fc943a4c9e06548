// Finds the paints of a library that look most like a given paint. [Shimizu2009] 5.3.5;
// goniochrome-search(7), "NEAREST PAINT".
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "base/result.h"
#include "library/index.h"
#include "library/internal/nearest.h"
#include "paint/metrics.h"

namespace goniochrome::library {

struct LibrarySearchOptions {
  std::size_t count = 5;
  color::DifferenceFormula metric = kDe76;
  std::optional<SearchMethod> method = {};                       // empty: the faster one
  std::vector<paint::Geometry> geometries = {};                  // to compare at; empty: those that are shared
  std::vector<std::pair<paint::Geometry, double>> weights = {};  // 0 or more; geometries that are not listed have 1
  std::vector<paint::MetricRange> ranges = {};                   // all to be met by the library's paints
  std::vector<paint::PaintClass> classes = {};                   // of the library's paints; empty: any
  bool mix_conditions = false;  // compare Lab of different illuminants and observers as they are
};

// At which geometries, and with which paints, a query is compared.
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

  // At which geometries `query` and the library are compared: those asked for, or else those that the query shares with
  // the most paints. Sets of three or more geometries (face, middle and flop) come before smaller ones. Error: the
  // query has no color, no geometry in common with the library, or another viewing condition.
  Result<SearchPlan> plan(const paint::Paint& query) const;

  // The nearest paints, nearest first; equal distances come in the library's order. They are fewer than asked for if
  // the filters leave fewer.
  std::vector<LibraryMatch> nearest(const SearchPlan& plan) const { return nearest(plan, options_.count); }
  // The nearest `count` instead of as many as the options say.
  std::vector<LibraryMatch> nearest(const SearchPlan& plan, std::size_t count) const;

 private:
  std::vector<paint::Geometry> shared_geometries(const std::vector<paint::LabReading>& rows) const;

  const LibraryIndex& index_;
  LibrarySearchOptions options_;
  std::vector<std::vector<LeafMask>> masks_;  // by section; empty: no filter
  std::vector<std::size_t> passing_;          // by section
};

}  // namespace goniochrome::library
