// The photographs of a surface, decoded once and read in bands of rows, so that any number of them takes constant
// memory.
#pragma once

#include <cstdio>
#include <functional>
#include <limits>
#include <memory>
#include <vector>

#include "base/result.h"
#include "capture/photo_table.h"

namespace goniochrome::capture {

// A pixel: linear working-space RGB, and the standard deviation that its rounding in the file makes, negative where the
// photograph is saturated there.
struct PhotoPixel {
  float r = 0, g = 0, b = 0, rounding = 0;
};

// The size of a map.
struct MapSize {
  int columns = 0, rows = 0;
};

struct PhotoShares {
  double saturated = 0, black = 0;  // of the pixels
};

class PhotoStack {
 public:
  // Reads all images of a table into a temporary file without a name. Photographs with corners are rectified to `size`,
  // which all others have already; without it none has corners, and all have one size. `saturated` is the value from
  // which a pixel of floats is taken for saturated; whole numbers are at the largest one. `progress` is called after
  // each image with their number so far. Error: an image that cannot be read, that is not finite or of another size;
  // corners that no plate has, or no size for them; no image in which enough pixels are neither saturated nor black; or
  // the temporary file cannot be written.
  static Result<PhotoStack> open(const PhotoTable& table, double saturated, const MapSize& size = {},
                                 const std::function<void(int)>& progress = {});

  int width() const { return width_; }
  int height() const { return height_; }
  int count() const { return static_cast<int>(shares_.size()); }
  const std::vector<PhotoShares>& shares() const { return shares_; }

  // Rows of all photographs, one photograph behind the other. Several threads may read at once.
  Result<void> read_rows(int first, int rows, std::vector<PhotoPixel>& to) const;

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  PhotoStack() = default;
  Result<void> add(const Photo& photo, const PhotoTable& table, double saturated);

  int width_ = 0, height_ = 0;
  std::vector<PhotoShares> shares_;
  std::unique_ptr<std::FILE, Close> file_;
};

}  // namespace goniochrome::capture
