// Words in pictures: small letters made of dots (capitals, digits and a few signs), and boxes to set them on.
#pragma once

#include <array>
#include <string>

#include "image/image.h"

namespace goniochrome::image {

// Writes `text` with its upper left corner at (x, y), letters of 5 x 7 dots of scale x scale pixels, one dot apart.
// Small letters become capitals. What lies outside the image is cut off.
void draw_label(Image& image, int x, int y, const std::string& text, int scale, const std::array<float, 3>& color);

// The size of a label in pixels.
int label_width(const std::string& text, int scale);
int label_height(int scale);

// A filled rectangle, cut off at the borders of the image.
void fill_box(Image& image, int x, int y, int width, int height, const std::array<float, 3>& color);

}  // namespace goniochrome::image
