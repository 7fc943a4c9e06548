#include "residual.h"

#include <algorithm>
#include <array>

#include "image/label.h"

namespace goniochrome::tool {

namespace {

using Color = std::array<float, 3>;

constexpr double kMost_de76 = 20;
constexpr Color kBackground{0.5F, 0.5F, 0.5F}, kLeftOut{0.10F, 0.14F, 0.34F}, kInk{0.05F, 0.05F, 0.05F};

// Black, red, yellow, white, evenly over 0..1.
Color heat(double x) {
  const auto ramp = [](double v) { return static_cast<float>(std::clamp(v, 0.0, 1.0)); };
  return {ramp(3 * x), ramp(3 * x - 1), ramp(3 * x - 2)};
}

void draw_scale(image::Image& image) {
  const int scale = image.width < 500 ? 1 : 2, height = 8 * scale;
  const int width = std::min(100 * scale, image.width / 3), x = 6 * scale, y = image.height - 3 * height;
  for (int i = 0; i < width; ++i) image::fill_box(image, x + i, y, 1, height, heat(i / static_cast<double>(width)));
  const int text_y = y + height + 3 * scale;
  image::draw_label(image, x, text_y, "0", scale, kInk);
  const std::string end = fmt::format("{:.0f} dE76", kMost_de76);
  image::draw_label(image, x + width - image::label_width("20", scale) / 2, text_y, end, scale, kInk);
}

}  // namespace

Result<void> write_residual(const std::string& path, const image::AovFile& buffers, const sketch::SketchPixels& pixels,
                            const sketch::SketchFit& fit) {
  image::Image image{buffers.image.width, buffers.image.height, 3, {}, {}};
  image.data.resize(pixels.use.size() * 3);
  const auto paint = [&](std::size_t place, const Color& color) {
    std::copy_n(color.data(), 3, &image.data[3 * place]);
  };
  for (std::size_t i = 0; i < pixels.use.size(); ++i)
    paint(i, pixels.use[i] == sketch::PixelUse::kBackground ? kBackground : kLeftOut);
  for (std::size_t i = 0; i < pixels.used.size(); ++i) paint(pixels.used[i], heat(fit.de76[i] / kMost_de76));
  draw_scale(image);
  return image::write_png(path, image);
}

}  // namespace goniochrome::tool
