// Pictures whose rows do not run from the top, or whose pixels do not run from the left, brought upright.
#pragma once

#include <cstddef>
#include <vector>

namespace goniochrome::image {

// The turn that brings stored rows upright: rows become columns, and then columns and rows are mirrored.
struct Turn {
  bool rows_are_columns = false, mirror_columns = false, mirror_rows = false;
  bool any() const { return rows_are_columns || mirror_columns || mirror_rows; }
};

// The turn of the EXIF tag Orientation: which sides the first row and the first column are. 1 to 8; others are upright.
// [Exif 2.32, 4.6.4 A]
inline Turn exif_turn(int orientation) {
  switch (orientation) {
    case 2:  // top, right
      return {false, true, false};
    case 3:  // bottom, right
      return {false, true, true};
    case 4:  // bottom, left
      return {false, false, true};
    case 5:  // left, top
      return {true, false, false};
    case 6:  // right, top
      return {true, true, false};
    case 7:  // right, bottom
      return {true, true, true};
    case 8:  // left, bottom
      return {true, false, true};
    default:
      return {};
  }
}

// The pixels upright. `width` and `height` are those of the stored rows, and then those of the picture.
inline std::vector<float> upright(const std::vector<float>& stored, int& width, int& height, int channels, Turn turn) {
  const auto columns = static_cast<std::size_t>(width), rows = static_cast<std::size_t>(height);
  const auto size = static_cast<std::size_t>(channels);
  const std::size_t across = turn.rows_are_columns ? rows : columns, down = turn.rows_are_columns ? columns : rows;
  std::vector<float> pixels(stored.size());
  for (std::size_t row = 0; row < rows; ++row)
    for (std::size_t column = 0; column < columns; ++column) {
      std::size_t x = turn.rows_are_columns ? row : column, y = turn.rows_are_columns ? column : row;
      if (turn.mirror_columns) x = across - 1 - x;
      if (turn.mirror_rows) y = down - 1 - y;
      for (std::size_t c = 0; c < size; ++c)
        pixels[(y * across + x) * size + c] = stored[(row * columns + column) * size + c];
    }
  width = static_cast<int>(across), height = static_cast<int>(down);
  return pixels;
}

}  // namespace goniochrome::image
