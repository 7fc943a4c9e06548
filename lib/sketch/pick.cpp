#include "sketch/pick.h"

#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "paint/curve.h"
#include "sketch/sketch_gloss.h"
#include "sketch/sketch_picture.h"

namespace goniochrome::sketch {

namespace {

// The part of an image that a disc may touch, and where it begins.
struct Window {
  int x = 0, y = 0;
  image::ImagePart part;
};

Window window_about(const image::ImagePart& image, const Dropper& d) {
  const image::Image& all = image.image;
  const int reach = static_cast<int>(std::ceil(d.radius));
  const int x0 = std::max(0, d.x - reach), x1 = std::min(all.width - 1, d.x + reach);
  const int y0 = std::max(0, d.y - reach), y1 = std::min(all.height - 1, d.y + reach);
  Window window{x0, y0, {image.name, {}, image.attributes, image.type}};
  image::Image& piece = window.part.image;
  piece.width = x1 - x0 + 1, piece.height = y1 - y0 + 1, piece.channels = all.channels;
  piece.channel_names = all.channel_names;
  for (int y = y0; y <= y1; ++y)
    piece.data.insert(piece.data.end(), all.pixel(x0, y),
                      all.pixel(x0, y) + static_cast<std::ptrdiff_t>(piece.width) * all.channels);
  return window;
}

}  // namespace

Result<Dropper> parse_dropper(const std::string& text, const std::string& option) {
  const auto error = [&] {
    return usage_error("{} is \"{}\": write IMAGE@X,Y or IMAGE@X,Y,RADIUS, in pixels from the upper left", option,
                       text);
  };
  const auto at = text.rfind('@');
  if (at == std::string::npos || at == 0) return error();
  const auto pieces = split(std::string_view(text).substr(at + 1), ',');
  if (pieces.size() != 2 && pieces.size() != 3) return error();
  const auto x = parse_integer(trimmed(pieces[0])), y = parse_integer(trimmed(pieces[1]));
  const auto radius = pieces.size() == 3 ? parse_number(trimmed(pieces[2])) : std::optional<double>(kPickRadius);
  constexpr std::int64_t kMost = 1 << 20;
  if (!x || !y || !radius || *x < 0 || *y < 0 || *x > kMost || *y > kMost || *radius < 0 || *radius > 4096)
    return error();
  return Dropper{text.substr(0, at), static_cast<int>(*x), static_cast<int>(*y), *radius};
}

Result<PickSample> pick(const image::ImagePart& image, const std::string& path, const Dropper& dropper) {
  if (dropper.x >= image.image.width || dropper.y >= image.image.height)
    return input_error("{}: the point {},{} lies outside its {} x {} pixels", path, dropper.x, dropper.y,
                       image.image.width, image.image.height);
  Window window = window_about(image, dropper);
  GONIO_ASSIGN(const Picture picture, picture_of(std::move(window.part), path, PictureView::kPlain));
  PickSample sample{dropper, path, 0, 0, 0, {}, 0, picture.warnings};
  color::Rgb sum;
  std::vector<double> brightness;
  for (int y = 0; y < picture.rgb.height; ++y)
    for (int x = 0; x < picture.rgb.width; ++x) {
      if (std::hypot(window.x + x - dropper.x, window.y + y - dropper.y) > dropper.radius) continue;
      const auto state = picture.state[static_cast<std::size_t>(y) * picture.rgb.width + x];
      if (state == Picture::kTransparent) {
        ++sample.transparent;
        continue;
      }
      const float* p = picture.pixel(x, y);
      const color::Rgb light{p[0], p[1], p[2]};
      if (!std::isfinite(light.x + light.y + light.z)) continue;
      sample.clipped += state == Picture::kClipped;
      ++sample.pixels, sum += light;
      brightness.push_back(display_brightness(color::xyz_d65_from_rgb(light).Y));
    }
  if (sample.pixels == 0)
    return input_error("{}: every pixel about {},{} is transparent: move the dropper", path, dropper.x, dropper.y);
  sample.lab = color::lab_from_rgb((1.0 / sample.pixels) * sum, *color::white_point({}));
  sample.gloss = contrast_gloss(brightness);
  return sample;
}

PickedPaint picked_paint(const PaintPick& pick, const std::optional<color::Lab>& face,
                         const std::optional<color::Lab>& flop, std::optional<double> gloss) {
  PickedPaint picked;
  paint::Appearance a{face ? *face : *flop, flop ? *flop : *face, pick.travel_deg, std::nullopt};
  if (!pick.retro && a.flop.L > a.face.L) {
    std::swap(a.face, a.flop);
    picked.swapped = true;
  }
  paint::Paint& paint = picked.paint;
  paint.name = pick.name;
  paint.paint_class = face && flop ? paint::PaintClass::kUnknown : paint::PaintClass::kSolid;
  paint.appearance = a;
  paint.measurement = paint::Measurement{{}, "", paint::rows_of(a)};
  if (gloss) paint.gloss.push_back({60, *gloss});
  return picked;
}

}  // namespace goniochrome::sketch
