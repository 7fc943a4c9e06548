// A library as a cloud of points in CIELAB, with the queries and their nearest paints in it.
#pragma once

#include <string>
#include <vector>

#include "base/result.h"
#include "finding.h"
#include "report/plot.h"

namespace goniochrome::tool {

struct Projection;

// The library in two projections, the a*b* plane and L* over a*, as one SVG with a row for each of at most three
// geometries: the first, the middle one, which is 45as45 where that is compared, and the last of the first query. Lines
// show travel from face to flop: solid with rings that of queries, dashed that of their matches. A ring at the geometry
// of the row is joined to the nearest paint. At most kMostPoints paints and kMostQueries queries are drawn, evenly
// chosen; the title tells how many.
class Cloud {
 public:
  static constexpr std::size_t kMostPoints = 20000, kMostQueries = 500;

  void note(const Finding& finding);
  Result<void> write(const std::string& path, const library::LibraryIndex& index) const;

 private:
  struct Query {
    std::vector<paint::Geometry> geometries;       // from face to flop
    std::vector<color::Lab> lab;                   // at each of them
    std::vector<std::vector<color::Lab>> matches;  // the same, nearest first
  };
  std::vector<paint::Geometry> rows_;
  report::Plot plot(const Projection& projection, const paint::Geometry& geometry,
                    const library::LibraryIndex& index) const;

  std::size_t noted_ = 0;
  std::vector<Query> queries_;
};

}  // namespace goniochrome::tool
