// The library beside a page: which of its paints pass a filter, what their rows show, and where they stand in L*a*b*.
#pragma once

#include <cstdint>
#include <vector>

#include "base/json.h"
#include "base/result.h"
#include "library/index.h"
#include "studio/internal/json_reader.h"

namespace goniochrome::studio {

class LibraryPane {
 public:
  // The index must outlive it.
  explicit LibraryPane(const library::LibraryIndex& index);

  // Fills list() with the paints whose name or code holds `text`, whose class is among `classes` (none: any) and whose
  // metrics lie within `ranges` of {metric, low, high}; ascending by the metric `order`, or in the library's order.
  Result<Json> filter(JsonReader& request);
  const std::vector<std::uint32_t>& list() const { return list_; }

  // For each of `places`: name, code, class and the colors of its in-plane geometries on a screen, by aspecular angle.
  Result<Json> rows(JsonReader& request) const;

  // Fills cloud() with the colors that the paints have at `geometry`, and cloud_colors() with what a screen shows of
  // them: red in the lowest byte, then green, blue and 255. Paints without that geometry are left out.
  struct CloudPoint {
    float L = 0, a = 0, b = 0;
  };
  Result<Json> cloud(JsonReader& request);
  const std::vector<CloudPoint>& cloud() const { return cloud_; }
  const std::vector<std::uint32_t>& cloud_colors() const { return cloud_colors_; }
  const std::vector<std::uint32_t>& cloud_paints() const { return cloud_paints_; }

  // All in-plane geometries of the library, by name, ascending by aspecular angle.
  Json geometries() const;

 private:
  static constexpr std::uint32_t kNowhere = UINT32_MAX;

  const library::LibraryIndex& index_;
  std::vector<std::uint16_t> section_of_;  // of each paint
  std::vector<std::uint32_t> place_of_;    // in the section's tree; kNowhere for a paint without color
  std::vector<std::uint32_t> list_, cloud_colors_, cloud_paints_;
  std::vector<CloudPoint> cloud_;
};

}  // namespace goniochrome::studio
