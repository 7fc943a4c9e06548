// The nearest paints of a library under several illuminants at once: those whose largest distance in any of the lights
// is least. goniochrome-search(7), "NEAREST PAINT".
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "library/search.h"

namespace goniochrome::library {

// A query, and how it is compared in each light.
struct LightsPlan {
  SearchPlan first;                            // in the first light
  std::vector<std::vector<SearchTerm>> terms;  // for each light, in the order of first.geometries
};

struct LightsMatch {
  LibraryMatch match;     // with the largest distance, and the colors in that light
  std::size_t light = 0;  // which that is; the first of equals
};

class LightsSearch {
 public:
  // Reads the library, brings its paints to each of the illuminants (one or more, known) by their spectra, and indexes
  // them in memory. Paints without spectra have no color here. The metrics that filters ask for are those in the first
  // light. Error: the library cannot be read.
  static Result<LightsSearch> open(const std::string& library_path, std::vector<std::string> illuminants,
                                   LibrarySearchOptions options, const std::function<void(std::size_t)>& progress = {});
  // Searches the paints that `next_paint` gives until it gives none, as open() does those of a file.
  static Result<LightsSearch> from_paints(const std::function<Result<std::optional<paint::Paint>>()>& next_paint,
                                          std::vector<std::string> illuminants, LibrarySearchOptions options,
                                          const std::function<void(std::size_t)>& progress = {});

  const LibraryIndex& index() const { return *index_; }
  const LibrarySearch& first() const { return *search_; }
  const std::vector<std::string>& illuminants() const { return illuminants_; }
  std::size_t without_spectra() const { return without_spectra_; }
  const std::vector<std::string>& warnings() const { return warnings_; }  // of the file of the library

  // Error: as LibrarySearch::plan(), and a query without spectra.
  Result<LightsPlan> plan(const paint::Paint& query) const;

  // The nearest paints, nearest first, in the library's order where distances are equal. The answer is exact: no paint
  // that is farther away in the first light alone can be nearer in all of them.
  std::vector<LightsMatch> nearest(const LightsPlan& plan) const;

 private:
  LightsSearch() = default;
  LightsMatch measured(LibraryMatch match, const LightsPlan& plan) const;

  std::vector<std::string> illuminants_;
  LibrarySearchOptions options_;
  std::unique_ptr<LibraryIndex> index_;                            // of the paints in the first light
  std::unique_ptr<LibrarySearch> search_;                          // of that index
  std::vector<std::vector<std::vector<paint::LabReading>>> rows_;  // in each later light, of each paint
  std::size_t without_spectra_ = 0;
  std::vector<std::string> warnings_;
};

}  // namespace goniochrome::library
