#include "capture/photo_stack.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>

#include "base/parallel.h"
#include "capture/internal/rectify.h"
#include "image/color_space.h"
#include "image/icc.h"
#include "image/image.h"

namespace goniochrome::capture {

namespace {

// The steps of the whole numbers of a picture, 0..1: those of 8 bits where all values are such numbers, else of 16.
double step_of(const image::Image& image) {
  constexpr float k8 = 255;
  const bool eight =
      std::ranges::all_of(image.data, [](float v) { return std::abs(v * k8 - std::round(v * k8)) < 1e-3F; });
  return eight ? 1.0 / 255 : 1.0 / 65535;
}

// The slope of the decoding of sRGB.
double srgb_slope(double v) {
  return v <= 0.04045 ? 1 / 12.92 : 2.4 / 1.055 * std::pow((v + 0.055) / 1.055, 1.4);
}

// A bilinear look-up, that is saturated where a pixel is that has a share in it.
PhotoPixel looked_up(const std::vector<PhotoPixel>& pixels, int width, int height, const ImagePlace& at) {
  const double x = std::clamp(at.x - 0.5, 0.0, width - 1.0), y = std::clamp(at.y - 0.5, 0.0, height - 1.0);
  const int left = static_cast<int>(x), top = static_cast<int>(y);
  PhotoPixel sum;
  bool saturated = false;
  for (int k = 0; k < 4; ++k) {
    const int right = k % 2, down = k / 2;
    const auto share = static_cast<float>((right ? x - left : 1 - (x - left)) * (down ? y - top : 1 - (y - top)));
    if (share == 0) continue;
    const PhotoPixel& pixel = pixels[static_cast<std::size_t>(top + down) * static_cast<std::size_t>(width) +
                                     static_cast<std::size_t>(left + right)];
    sum.r += share * pixel.r, sum.g += share * pixel.g, sum.b += share * pixel.b;
    sum.rounding += share * std::abs(pixel.rounding);
    saturated = saturated || pixel.rounding < 0;
  }
  if (saturated) sum.rounding = -sum.rounding;
  return sum;
}

// The means of the texels of a plate, in linear light.
std::vector<PhotoPixel> rectified(const std::vector<PhotoPixel>& pixels, int width, int height,
                                  const Perspective& perspective, const MapSize& size) {
  std::vector<PhotoPixel> texels(static_cast<std::size_t>(size.columns) * static_cast<std::size_t>(size.rows));
  parallel_for(static_cast<std::size_t>(size.rows), 4, [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row)
      for (int column = 0; column < size.columns; ++column) {
        const int n = perspective.samples(static_cast<double>(column) / size.columns,
                                          static_cast<double>(row) / size.rows, 1.0 / size.columns, 1.0 / size.rows);
        const float share = 1 / static_cast<float>(n * n);
        PhotoPixel mean;
        bool saturated = false;
        for (int k = 0; k < n * n; ++k) {
          const double u = (column + (k % n + 0.5) / n) / size.columns,
                       v = (static_cast<double>(row) + (k / n + 0.5) / n) / size.rows;
          const PhotoPixel one = looked_up(pixels, width, height, perspective.at(u, v));
          mean.r += share * one.r, mean.g += share * one.g, mean.b += share * one.b;
          mean.rounding += share * std::abs(one.rounding);
          saturated = saturated || one.rounding < 0;
        }
        if (saturated) mean.rounding = -mean.rounding;
        texels[row * static_cast<std::size_t>(size.columns) + static_cast<std::size_t>(column)] = mean;
      }
  });
  return texels;
}

}  // namespace

Result<void> PhotoStack::add(const Photo& photo, const PhotoTable& table, double saturated) {
  auto read = image::read_image(photo.image);
  if (!read.ok()) return input_error("{}:{}: {}", table.path, photo.line, read.error().message);
  image::ImagePart part = std::move(*read);
  const int width = part.image.width, height = part.image.height, channels = part.image.channels;
  if (photo.corners && width_ == 0)
    return input_error("{}:{}: {} has corners: give the texels of the map, as --texels 512x256", table.path, photo.line,
                       photo.image);
  if (width_ == 0) width_ = width, height_ = height;
  if (!photo.corners && (width != width_ || height != height_)) {
    if (shares_.empty())
      return input_error("{}:{}: {} is {} x {}, but the map is {} x {}: mark the corners of the surface", table.path,
                         photo.line, photo.image, width, height, width_, height_);
    return input_error("{}:{}: {} is {} x {}, but {} is {} x {}: register all photographs to one size", table.path,
                       photo.line, photo.image, width, height, table.photos.front().image, width_, height_);
  }
  const bool whole = image::attribute_or(part.attributes, "goniochrome:integer", 0) != 0;
  const double step = whole ? step_of(part.image) : 0, limit = whole ? 1 - step / 2 : saturated;
  std::vector<PhotoPixel> pixels(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  const int colors = image::color_channels(part.image);
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const float* stored = &part.image.data[i * static_cast<std::size_t>(channels)];
    float most = 0, sum = 0;
    for (int c = 0; c < colors; ++c) {
      if (!std::isfinite(stored[c]))
        return input_error("{}:{}: pixel ({},{}) of {} is {}: every value must be a finite number", table.path,
                           photo.line, i % static_cast<std::size_t>(width), i / static_cast<std::size_t>(width),
                           photo.image, stored[c]);
      most = std::max(most, stored[c]), sum += stored[c] / static_cast<float>(colors);
    }
    const double rounding = step * srgb_slope(sum) / std::sqrt(12.0);
    pixels[i].rounding = static_cast<float>(rounding);
    if (most >= limit) pixels[i].rounding = -static_cast<float>(std::max(rounding, 1e-9));
  }
  GONIO_ASSIGN(const image::Image rgb, image::working_space_rgb(std::move(part), photo.image));
  for (std::size_t i = 0; i < pixels.size(); ++i)
    pixels[i].r = rgb.data[3 * i], pixels[i].g = rgb.data[3 * i + 1], pixels[i].b = rgb.data[3 * i + 2];
  if (photo.corners) {
    const auto perspective = Perspective::of(*photo.corners, width, height);
    if (!perspective.ok())
      return input_error("{}:{}: {}: {}", table.path, photo.line, photo.image, perspective.error().message);
    pixels = rectified(pixels, width, height, *perspective, {width_, height_});
  }
  const auto full = std::ranges::count_if(pixels, [](const PhotoPixel& p) { return p.rounding < 0; });
  const auto black = std::ranges::count_if(pixels, [](const PhotoPixel& p) { return std::max({p.r, p.g, p.b}) <= 0; });
  if (std::fwrite(pixels.data(), sizeof(PhotoPixel), pixels.size(), file_.get()) != pixels.size())
    return input_error("the temporary file of the photographs: {}", std::strerror(errno));
  const auto all = static_cast<double>(pixels.size());
  shares_.push_back({static_cast<double>(full) / all, static_cast<double>(black) / all});
  return {};
}

Result<PhotoStack> PhotoStack::open(const PhotoTable& table, double saturated, const MapSize& size,
                                    const std::function<void(int)>& progress) {
  PhotoStack stack;
  stack.width_ = size.columns, stack.height_ = size.rows;
  stack.file_.reset(std::tmpfile());
  if (!stack.file_) return input_error("a temporary file cannot be made: {}", std::strerror(errno));
  for (const Photo& photo : table.photos) {
    GONIO_TRY(stack.add(photo, table, saturated));
    if (progress) progress(stack.count());
  }
  if (std::fflush(stack.file_.get()) != 0)
    return input_error("the temporary file of the photographs: {}", std::strerror(errno));
  double full = 0, black = 0;
  for (const PhotoShares& share : stack.shares_) full += share.saturated, black += share.black;
  full /= stack.count(), black /= stack.count();
  constexpr double kMost = 0.8;
  if (full > kMost)
    return input_error("{}: {:.0f} % of all pixels are saturated: photograph with a shorter exposure", table.path,
                       100 * full);
  if (black > kMost)
    return input_error("{}: {:.0f} % of all pixels are black: photograph with a longer exposure", table.path,
                       100 * black);
  return stack;
}

Result<void> PhotoStack::read_rows(int first, int rows, std::vector<PhotoPixel>& to) const {
  const std::size_t band = static_cast<std::size_t>(rows) * static_cast<std::size_t>(width_);
  to.resize(band * static_cast<std::size_t>(count()));
  const std::size_t photo_bytes =
      sizeof(PhotoPixel) * static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
  for (int k = 0; k < count(); ++k) {
    char* at = reinterpret_cast<char*>(&to[static_cast<std::size_t>(k) * band]);
    std::size_t left = band * sizeof(PhotoPixel);
    std::size_t from = static_cast<std::size_t>(k) * photo_bytes +
                       sizeof(PhotoPixel) * static_cast<std::size_t>(first) * static_cast<std::size_t>(width_);
    while (left > 0) {
      const ssize_t got = pread(fileno(file_.get()), at, left, static_cast<off_t>(from));
      if (got < 0 && errno == EINTR) continue;
      if (got <= 0) return input_error("the temporary file of the photographs: {}", std::strerror(errno));
      at += got, left -= static_cast<std::size_t>(got), from += static_cast<std::size_t>(got);
    }
  }
  return {};
}

}  // namespace goniochrome::capture
