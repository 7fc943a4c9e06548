// Bands of rows that are drawn one after the other, so that a large picture takes no more memory than a small one.
// goniochrome-paths(7), "Smoothed light".
#pragma once

#include <vector>

#include "image/image.h"
#include "render/gbuffer.h"

namespace goniochrome::render {

// Rows that are drawn together, from the first up to the last, and those of them that are kept.
struct Band {
  int first = 0, last = 0, first_kept = 0, last_kept = 0;
  int number = 0, count = 1;  // The bands of a picture are numbered from 0, from the top.
  int height() const { return last - first; }
  bool operator==(const Band&) const = default;
};
inline Band whole_band(int height) {
  return {0, height, 0, height};
}

// Bands that take about the same memory; one where there is enough for all of them. `rayed`: what rays change is
// reconstructed from neighbors, so that rows on either side are drawn with those that are kept.
std::vector<Band> bands_of(const Gbuffer& picture, int samples, bool rayed);

// The rows of a band, those beside it among them.
Gbuffer rows_of(const Gbuffer& picture, const Band& band);

// Puts the kept rows into a picture of that height.
void put_band(const image::Image& drawn, const Band& band, int height, image::Image& picture);

}  // namespace goniochrome::render
