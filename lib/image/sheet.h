// A contact sheet: pictures of one size in rows and columns, each with its name below.
#pragma once

#include <cstddef>
#include <string>

#include "image/byte_image.h"

namespace goniochrome::image {

class ContactSheet {
 public:
  // For pictures of that many pixels. The letters below are as large as the pictures are wide.
  ContactSheet(int columns, int rows, int picture_width, int picture_height);

  int cells() const { return columns_ * rows_; }

  // Puts a picture of the sheet's size, or none where a paint has no picture, into a cell, counted from 0 by rows. A
  // label that is too long for its cell ends with two points.
  void put(int cell, const ByteImage* picture, const std::string& label);

  // The sheet; cells where nothing was put are empty.
  const ByteImage& picture() const { return picture_; }

 private:
  int columns_, rows_, width_, height_, scale_, gap_, strip_;
  ByteImage picture_;
};

// `text` as draw_label() can draw it in that many pixels: a character outside ASCII is one sign, and what is too long
// is cut and ends with two points.
std::string fitted_label(const std::string& text, int scale, int width);

// A cell of one of several sheets.
struct SheetPlace {
  std::size_t sheet = 0;  // from 0
  int cell = 0;           // from 0, by rows
};

// Places things of a list one after the other. On sheets of 3 x 3, a thing whose followers are called by its own name
// with a point and a word behind, as variations of a paint are, stands in the middle of a sheet of its own, and its
// followers around it.
class SheetPlaces {
 public:
  SheetPlaces(int columns, int rows) : cells_(columns * rows), in_middle_(columns == 3 && rows == 3) {}

  // The place of the next thing. `follower` is the name of the one after it; "" at the end.
  SheetPlace next(const std::string& name, const std::string& follower);

 private:
  SheetPlace begin_sheet(int cell);

  int cells_;
  bool in_middle_;
  std::string leader_;     // of the sheet, in its middle; "" where there is none
  int used_ = 0;           // cells of the sheet
  bool is_begun_ = false;  // whether there is a sheet
  std::size_t sheet_ = 0;
};

}  // namespace goniochrome::image
