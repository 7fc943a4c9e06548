#include "render/internal/bands.h"

#include <algorithm>
#include <cmath>

namespace goniochrome::render {

namespace {

// The bytes of a band: all of 1280 x 720 with 16 samples or, where rays change a car, with 4. Measured there: those of
// a pixel in pictures, in each G-buffer, and in what rays change where the mesh is seen.
constexpr double kMostBytes = 3.3e8;
constexpr double kOfPictures = 32, kOfGbuffer = 20, kOfRays = 600;
constexpr int kRowsBeside = 16;

}  // namespace

std::vector<Band> bands_of(const Gbuffer& picture, int samples, bool rayed) {
  std::vector<double> bytes = {0};  // of all rows above
  for (int y = 0; y < picture.height; ++y) {
    int seen = 0;
    for (int x = 0; x < picture.width; ++x) seen += picture.part(x, y) >= 0 ? 1 : 0;
    const double of_pixels = picture.width * (kOfPictures + samples * kOfGbuffer);
    bytes.push_back(bytes.back() + of_pixels + (rayed ? seen * kOfRays : 0));
  }
  const double count = std::ceil(bytes.back() / kMostBytes);
  const int beside = rayed ? kRowsBeside : 0;
  std::vector<Band> bands;
  for (int k = 1, begin = 0; k <= count; ++k) {
    const auto end = static_cast<int>(std::ranges::lower_bound(bytes, bytes.back() * k / count) - bytes.begin());
    if (end > begin) bands.push_back({std::max(0, begin - beside), std::min(picture.height, end + beside), begin, end});
    begin = end;
  }
  for (std::size_t i = 0; i < bands.size(); ++i)
    bands[i].number = static_cast<int>(i), bands[i].count = static_cast<int>(bands.size());
  return bands;
}

Gbuffer rows_of(const Gbuffer& picture, const Band& band) {
  Gbuffer rows;
  rows.width = picture.width, rows.height = band.height(), rows.rays = picture.rays.shifted(0, band.first);
  const auto begin = static_cast<std::ptrdiff_t>(picture.index(0, band.first)),
             end = static_cast<std::ptrdiff_t>(picture.index(0, band.last));
  rows.data.assign(picture.data.begin() + 4 * begin, picture.data.begin() + 4 * end);
  rows.triangles.assign(picture.triangles.begin() + begin, picture.triangles.begin() + end);
  return rows;
}

void put_band(const image::Image& drawn, const Band& band, int height, image::Image& picture) {
  if (drawn.data.empty()) return;
  const std::size_t row = static_cast<std::size_t>(drawn.width) * static_cast<std::size_t>(drawn.channels);
  picture.width = drawn.width, picture.height = height, picture.channels = drawn.channels;
  picture.channel_names = drawn.channel_names;
  picture.data.resize(row * static_cast<std::size_t>(height));
  const auto begin = static_cast<std::ptrdiff_t>(row) * (band.first_kept - band.first),
             to = static_cast<std::ptrdiff_t>(row) * band.first_kept;
  std::copy_n(drawn.data.begin() + begin, row * static_cast<std::size_t>(band.last_kept - band.first_kept),
              picture.data.begin() + to);
}

}  // namespace goniochrome::render
