#include "contact_sheet.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/angles.h"
#include "base/parallel.h"
#include "base/text.h"
#include "color/color.h"
#include "display/paint_view.h"
#include "image/label.h"

namespace goniochrome::tool {

namespace {

constexpr int kWidth = 320, kHeight = 160;  // of a panorama, in pixels
constexpr int kGap = 8, kColumns = 3, kLetters = 2;
constexpr double kMiddleGray = 0.18;

std::vector<const envmap::PrefilteredLobe*> maps_of(const envmap::PrefilteredEnvironment& env) {
  std::vector<const envmap::PrefilteredLobe*> maps;
  if (env.diffuse.map.size > 0) maps.push_back(&env.diffuse);
  for (const envmap::PrefilteredLobe& lobe : env.lobes) maps.push_back(&lobe);
  if (env.mirror.map.size > 0) maps.push_back(&env.mirror);
  return maps;
}

// The mean of a map whose texels are all taken for equally large; the texels of a cube differ by 5 at most.
double mean_luminance(const envmap::CubeMap& map) {
  double sum = 0;
  for (std::size_t i = 0; i < map.texels.size(); i += 3)
    sum += color::luminance({map.texels[i], map.texels[i + 1], map.texels[i + 2]});
  return 3 * sum / static_cast<double>(map.texels.size());
}

std::string caption_of(const envmap::PrefilteredEnvironment& env, const envmap::PrefilteredLobe& map) {
  if (&map == &env.diffuse) return fmt::format("diffuse  {0}x{0}", map.map.size);
  if (map.is_mirror()) return fmt::format("mirror  {0}x{0}", map.map.size);
  return fmt::format("lobe {}  {}x{}", shortest(map.exponent), map.map.size, map.map.size);
}

void draw_panorama(const envmap::CubeMap& map, double gain, int left, int top, image::Image& sheet) {
  parallel_for(kHeight, 8, [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row) {
      const double polar = kPi * (static_cast<double>(row) + 0.5) / kHeight;
      for (int column = 0; column < kWidth; ++column) {
        const double azimuth = 2 * kPi * (0.5 - (column + 0.5) / kWidth);  // from +Z toward +X
        const Vec3 direction{std::sin(polar) * std::sin(azimuth), std::cos(polar), std::sin(polar) * std::cos(azimuth)};
        const color::Rgb light = gain * envmap::bilinear(map, direction);
        const color::Rgb shown = display::paint_view(color::rec709_from_rec2020(light));
        float* pixel = sheet.pixel(left + column, top + static_cast<int>(row));
        for (int c = 0; c < 3; ++c) pixel[c] = static_cast<float>(display::srgb_signal(shown[c]));
      }
    }
  });
}

}  // namespace

image::Image contact_sheet(const envmap::PrefilteredEnvironment& env) {
  const std::vector<const envmap::PrefilteredLobe*> maps = maps_of(env);
  const int count = static_cast<int>(maps.size()), columns = std::min(count, kColumns);
  const int rows = (count + columns - 1) / columns;
  const int line = image::label_height(kLetters) + kGap, cell = kHeight + line + kGap;
  image::Image sheet =
      image::even_image(columns * (kWidth + kGap) + kGap, rows * cell + kGap, 3, {"R", "G", "B"}, 0.13F);
  const double mean = mean_luminance(maps.front()->map), gain = mean > 0 ? kMiddleGray / mean : 1;
  constexpr std::array<float, 3> kWords = {0.85F, 0.85F, 0.85F};
  for (int i = 0; i < count; ++i) {
    const int left = kGap + (i % columns) * (kWidth + kGap), top = kGap + (i / columns) * cell;
    image::draw_label(sheet, left, top, caption_of(env, *maps[static_cast<std::size_t>(i)]), kLetters, kWords);
    draw_panorama(maps[static_cast<std::size_t>(i)]->map, gain, left, top + line, sheet);
  }
  return sheet;
}

}  // namespace goniochrome::tool
