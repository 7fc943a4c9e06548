// The result of a search for one paint, and its verdict on the design. [Shimizu2009] 5.3.5
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "library/lights.h"
#include "library/search.h"
#include "library/verdict.h"

namespace goniochrome::tool {

// One library paint beside the query. dL, dC and dH are the values of the query minus those of the match, as means
// over the geometries.
struct Neighbor {
  library::LibraryMatch match;
  std::string illuminant;         // in which the distance is largest; "" where there is one light alone
  double mean_de = 0;             // distance per unit of weight
  double dL = 0, dC = 0, dH = 0;  // CIELAB lightness, chroma and hue difference
  std::vector<double> de;         // at each geometry, without weight
};

struct Finding {
  std::string query;
  library::SearchPlan plan;
  std::vector<Neighbor> neighbors;                        // nearest first
  double hue_shift = 0, matched_hue_shift = 0;            // NaN where there is none
  double hue_travel_deg = 0, matched_hue_travel_deg = 0;  // the same
  bool outside = false, off_radial = false, turns = false;
  double search_s = 0;

  bool no_match() const { return neighbors.empty(); }
  // "ok", "no_match", or those of "outside", "off_radial" and "hue_travel" that hold, joined by commas.
  std::string status() const;
};

// How a query is compared: in the light of the readings, or in several.
struct QueryPlan {
  library::SearchPlan plan;  // in the first light
  std::optional<library::LightsPlan> lights;
};

// The library that is searched, in one of the two ways.
class Searched {
 public:
  // Both must outlive it.
  Searched(const library::LibraryIndex& index, const library::LibrarySearch& search) : index_(index), search_(search) {}
  explicit Searched(const library::LightsSearch& lights)
      : index_(lights.index()), search_(lights.first()), lights_(&lights) {}

  const library::LibraryIndex& index() const { return index_; }
  // The search in the first light.
  const library::LibrarySearch& search() const { return search_; }
  Result<QueryPlan> plan(const paint::Paint& query) const;
  std::vector<Neighbor> nearest(const QueryPlan& plan, const color::DifferenceFormula& metric) const;

 private:
  const library::LibraryIndex& index_;
  const library::LibrarySearch& search_;
  const library::LightsSearch* lights_ = nullptr;
};

// Searches the library and judges the design. `query` must be the paint of the plan. Several threads may call it at
// once.
Finding finding_of(const paint::Paint& query, QueryPlan plan, const Searched& library,
                   const color::DifferenceFormula& metric, const library::VerdictLimits& limits);

}  // namespace goniochrome::tool
