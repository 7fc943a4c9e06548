#include "residual.h"

#include <algorithm>
#include <array>

#include "color/color.h"
#include "display/paint_view.h"
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

// The signals of an sRGB display whose white is that of the light.
Color displayed(const color::Lab& lab) {
  const color::Rgb rgb = color::rec709_from_rec2020(color::rgb_from_lab(lab, *color::white_point({})));
  Color shown;
  for (int c = 0; c < 3; ++c) shown[static_cast<std::size_t>(c)] = static_cast<float>(display::srgb_signal(rgb[c]));
  return shown;
}

}  // namespace

Result<void> write_residual(const std::string& path, const image::AovFile& buffers, const sketch::SketchPixels& pixels,
                            const sketch::SketchFit& fit) {
  const int width = buffers.image.width, height = buffers.image.height;
  const auto pane = [&](const auto& color_of) {
    image::Image image = image::even_image(width, height, 3);
    const auto put = [&](std::size_t place, const Color& color) {
      std::copy_n(color.data(), 3, &image.data[3 * place]);
    };
    for (std::size_t i = 0; i < pixels.use.size(); ++i)
      put(i, pixels.use[i] == sketch::PixelUse::kBackground ? kBackground : kLeftOut);
    for (std::size_t i = 0; i < pixels.used.size(); ++i) put(pixels.used[i], color_of(fit.pixels[i]));
    return image;
  };
  image::Image panes[] = {pane([](const sketch::PixelPair& p) { return displayed(p.seen); }),
                          pane([](const sketch::PixelPair& p) { return displayed(p.shown); }),
                          pane([](const sketch::PixelPair& p) { return heat(p.de76() / kMost_de76); })};
  draw_scale(panes[2]);
  image::Image all{3 * width, height, 3, {}, {}};
  for (int y = 0; y < height; ++y)
    for (const image::Image& one : panes) all.data.insert(all.data.end(), one.pixel(0, y), one.pixel(0, y) + 3 * width);
  return image::write_png(path, all);
}

}  // namespace goniochrome::tool
