// A library as a cloud of points in CIELAB, with the queries and their nearest paints in it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "finding.h"

namespace goniochrome::tool {

// Two projections as one SVG: the a*b* plane, and L* over a*, at one geometry, which is 45as45 where the first query is
// compared there, else the middle one of those at which it is. Queries are rings, each joined to its nearest paint. At
// most kMostPoints paints of the library and kMostQueries queries are drawn, evenly chosen; the title tells how many.
class Cloud {
 public:
  static constexpr std::size_t kMostPoints = 20000, kMostQueries = 500;

  void note(const Finding& finding);
  Result<void> write(const std::string& path, const library::LibraryIndex& index) const;

 private:
  struct Query {
    color::Lab lab, nearest;
  };
  std::optional<paint::Geometry> geometry_;
  std::size_t noted_ = 0;
  std::vector<Query> queries_;
};

}  // namespace goniochrome::tool
