// A paint library made ready for searching: its colors in trees by geometry, its names and its metrics. The index is
// kept in a file beside the library, which later runs map into memory instead of reading the library again.
// goniochrome-search(7), "NEAREST PAINT".
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "library/internal/tree.h"
#include "paint/metrics.h"
#include "paint/paint.h"

namespace goniochrome::library {

// The colors by which a paint is compared, ascending by geometry_order(), each geometry once. They are its measured
// rows, or, if it has none, its curve at 15, 25, 45, 75 and 110 deg; none if it has neither.
std::vector<paint::LabReading> comparable_rows(const paint::Paint& paint);

// A total order of geometries: incidence, aspecular angle, azimuth.
bool geometry_order(const paint::Geometry& x, const paint::Geometry& y);

// The paints of a library that were measured at the same geometries under the same condition.
struct LibrarySection {
  color::ViewingCondition condition;
  std::vector<paint::Geometry> geometries;  // ascending
  TreeView tree;                            // three channels a geometry, labels are places in the library
};

class LibraryIndex {
 public:
  // How an index came to be.
  enum class Origin { kMapped, kBuilt, kInMemory };

  // The index of the paint file `library_path`, in any format that formats::open_paints() reads. The file
  // `<library_path>.snapindex` is mapped if it belongs to this state of the library: size and time of its last
  // change agree, or size and checksum, and a program of the same `version` made it. Otherwise the library is read, and
  // the index is written there, whole or not at all. If that cannot be done, it stays in memory and note() says why; so
  // does that of FILE#NAMES, some paints of a file. `progress` is told the number of paints read so far. Error: the
  // library cannot be read, or it is no plain file.
  static Result<LibraryIndex> open(const std::string& library_path,
                                   const std::function<void(std::size_t)>& progress = {},
                                   const std::string& version = "");

  // An index in memory over the paints that `next` gives until it gives none.
  static Result<LibraryIndex> from_paints(const std::function<Result<std::optional<paint::Paint>>()>& next);

  // An index over bytes that content() gave, in this program or in another one. Error: they are damaged.
  static Result<LibraryIndex> from_bytes(std::string bytes);
  std::string_view content() const;

  LibraryIndex(LibraryIndex&&) noexcept;
  LibraryIndex& operator=(LibraryIndex&&) noexcept;
  ~LibraryIndex();

  std::size_t size() const { return size_; }
  std::string_view name(std::size_t paint) const { return text(2 * paint); }
  std::string_view code(std::size_t paint) const { return text(2 * paint + 1); }
  paint::PaintClass paint_class(std::size_t paint) const { return static_cast<paint::PaintClass>(classes_[paint]); }
  // `column` is one of metric_columns_without_fit().
  double metric(std::size_t paint, const paint::MetricColumn& column) const;
  const std::vector<LibrarySection>& sections() const { return sections_; }

  Origin origin() const { return origin_; }
  const std::string& note() const { return note_; }  // why it was built, or not kept; empty when mapped
  const std::vector<std::string>& warnings() const { return warnings_; }  // of the file, where it was read
  std::size_t bytes() const;
  double read_s() const { return read_s_; }    // reading the library; 0 when mapped
  double build_s() const { return build_s_; }  // metrics, trees and writing, or mapping

 private:
  class Bytes;
  LibraryIndex();
  static Result<LibraryIndex> view_of(std::unique_ptr<Bytes> bytes);
  std::string_view text(std::size_t i) const { return {texts_ + offsets_[i], offsets_[i + 1] - offsets_[i]}; }

  std::unique_ptr<Bytes> bytes_;
  std::size_t size_ = 0;
  const std::uint32_t* offsets_ = nullptr;  // of name and code of each paint in texts_
  const char* texts_ = nullptr;
  const std::uint8_t* classes_ = nullptr;
  const double* metrics_ = nullptr;  // column by column
  std::vector<LibrarySection> sections_;
  Origin origin_ = Origin::kInMemory;
  std::string note_;
  std::vector<std::string> warnings_;
  double read_s_ = 0, build_s_ = 0;
};

// The file that keeps the index of a library.
std::string index_path(const std::string& library_path);

}  // namespace goniochrome::library
