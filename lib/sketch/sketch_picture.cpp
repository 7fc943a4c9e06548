#include "sketch/sketch_picture.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "base/text.h"
#include "display/display.h"
#include "display/paint_view.h"
#include "image/aov_file.h"
#include "image/byte_image.h"
#include "image/color_space.h"
#include "image/icc.h"

namespace goniochrome::sketch {

namespace {

constexpr float kClip = 254.5F / 255;  // a signal from here on may have been any brighter one
constexpr float kOpaque = 0.999F;
constexpr std::size_t kRows = 16;

bool holds_integers(const image::ImagePart& part) {
  const auto found = part.attributes.find("goniochrome:integer");
  const int* value = found == part.attributes.end() ? nullptr : std::get_if<int>(&found->second);
  return value && *value != 0;
}

// The alpha channel's place in a pixel, or -1.
int alpha_channel(const image::Image& image) {
  const auto& names = image.channel_names;
  const auto found = std::find(names.begin(), names.end(), "A");
  if (found != names.end()) return static_cast<int>(found - names.begin());
  return names.empty() && (image.channels == 2 || image.channels == 4) ? image.channels - 1 : -1;
}

// True if a pixel may have been any brighter: a channel that is full, or paper without any ink.
bool is_clipped(const float* pixel, int colors) {
  if (colors == 4) return std::all_of(pixel, pixel + 4, [](float ink) { return ink <= 1 - kClip; });
  return std::any_of(pixel, pixel + colors, [](float signal) { return signal >= kClip; });
}

std::vector<std::uint8_t> states(const image::Image& image, bool display) {
  const int alpha = alpha_channel(image), colors = image::color_channels(image);
  std::vector<std::uint8_t> state(static_cast<std::size_t>(image.width) * image.height, Picture::kGood);
  for (std::size_t i = 0; i < state.size(); ++i) {
    const float* pixel = &image.data[i * image.channels];
    const bool finite = std::all_of(pixel, pixel + colors, [](float signal) { return std::isfinite(signal); });
    if (!finite || (display && is_clipped(pixel, colors))) state[i] = Picture::kClipped;
    if (alpha >= 0 && pixel[alpha] < kOpaque) state[i] = Picture::kTransparent;
  }
  return state;
}

// Gray as three equal channels, so that a color space finds what it expects.
void drop_to_gray(image::Image& image) {
  if (image.channels >= 3) return;
  for (std::size_t i = 0; i < static_cast<std::size_t>(image.width) * image.height; ++i)
    image.data[i] = image.data[i * image.channels];
  image.data.resize(static_cast<std::size_t>(image.width) * image.height);
  image.channels = 1;
  image.channel_names = {"Y"};
}

template <class Function>
void for_pixels(image::Image& image, Function&& change) {
  parallel_for(static_cast<std::size_t>(image.height), kRows, [&](std::size_t begin, std::size_t end) {
    const std::size_t width = static_cast<std::size_t>(image.width);
    for (std::size_t i = begin * width; i < end * width; ++i) change(&image.data[3 * i]);
  });
}

// Inks as RGB signals where nothing tells their colors: each ink takes all light of its channel.
void take_inks_for_filters(image::Image& image) {
  const std::size_t count = static_cast<std::size_t>(image.width) * image.height;
  for (std::size_t i = 0; i < count; ++i) {
    const float* inks = &image.data[i * image.channels];
    const float paper = 1 - inks[3];
    const float rgb[] = {(1 - inks[0]) * paper, (1 - inks[1]) * paper, (1 - inks[2]) * paper};
    std::copy_n(rgb, 3, &image.data[3 * i]);
  }
  image.data.resize(3 * count);
  image.channels = 3, image.channel_names = {"R", "G", "B"};
}

// The color space of a file that states none.
void tag_untagged(image::ImagePart& part, bool integer) {
  if (!image::text_attribute(part, "colorInteropID").empty() || part.attributes.contains("chromaticities")) return;
  if (!image::text_attribute(part, "oiio:ColorSpace").empty()) return;
  part.attributes["colorInteropID"] = std::string(integer ? "srgb_rec709_display" : "lin_rec709_scene");
}

// Brings the picture back to light through the view that it names. The signals of an sRGB display are found again where
// the file has a profile.
Result<void> undo_view(const std::string& view, const image::ImagePart& part, const std::string& name,
                       Picture& picture) {
  auto display = display::Display::make(view);
  if (!display.ok())
    return input_error(
        "{}: was drawn by the view \"{}\": {}; set $OCIO as it was, or draw the picture by the view Paint", name, view,
        display.error().message);
  const bool is_srgb = display->name().starts_with("sRGB");
  if (!is_srgb && !image::text_attribute(part, "ICCProfile").empty())
    return input_error(
        "{}: was drawn by the view \"{}\" and has an ICC profile, behind which the signals of that display are not "
        "known: save it without a profile",
        name, view);
  if (is_srgb || part.image.channels < 3) {
    for_pixels(picture.rgb, [](float* pixel) {
      const color::Rgb shown = color::rec709_from_rec2020({pixel[0], pixel[1], pixel[2]});
      for (int c = 0; c < 3; ++c) pixel[c] = static_cast<float>(display::srgb_signal(shown[c]));
    });
  } else {
    const auto channels = static_cast<std::size_t>(part.image.channels);
    for (std::size_t i = 0; i < picture.rgb.data.size() / 3; ++i)
      std::copy_n(&part.image.data[i * channels], 3, &picture.rgb.data[3 * i]);
  }
  if (auto undone = display->undo(picture.rgb); !undone.ok())
    return input_error("{}: {}: draw the picture by the view Paint", name, undone.error().message);
  picture.space = display->name();
  return {};
}

}  // namespace

Result<Picture> read_picture(const std::string& path, PictureView view, const std::string& named) {
  GONIO_ASSIGN(image::ImagePart part, image::read_image(path, image::Inks::kKept));
  if (!named.empty()) part.attributes[image::kViewAttribute] = named;
  return picture_of(std::move(part), path == "-" ? "standard input" : path, view);
}

Result<Picture> picture_of(image::ImagePart part, const std::string& name, PictureView view) {
  const bool integer = holds_integers(part);
  Picture picture;
  picture.scene_linear = !integer;
  picture.left_out = image::left_out(part);
  if (const auto found = part.attributes.find("goniochrome:samples"); found != part.attributes.end())
    if (const int* samples = std::get_if<int>(&found->second)) picture.samples = *samples;
  if (part.image.channels == 0) return input_error("{}: has no channels", name);
  picture.state = states(part.image, integer);
  drop_to_gray(part.image);
  if (image::color_channels(part.image) == 4 && image::text_attribute(part, "ICCProfile").empty()) {
    picture.warnings.push_back(fmt::format(
        "{} is CMYK without a profile, converted without regard to its inks: for exact color save it with its profile "
        "or as sRGB",
        name));
    take_inks_for_filters(part.image);
    part.attributes["oiio:ColorSpace"] = std::string("sRGB");
  }
  if (!image::text_attribute(part, "ICCProfile").empty() && integer) {
    GONIO_ASSIGN(picture.rgb, image::image_through_icc(part.image, image::text_attribute(part, "ICCProfile"), name));
    picture.space = "its ICC profile";
  } else {
    tag_untagged(part, integer);
    GONIO_ASSIGN(picture.rgb, image::working_space_rgb(part, name));
    picture.space = integer ? "sRGB" : "linear light";
    if (const auto id = image::text_attribute(part, "colorInteropID"); !id.empty()) picture.space = id;
  }
  const std::string named = image::text_attribute(part, image::kViewAttribute);
  const bool by_paint = lower(named) == "paint" || lower(named) == "srgb / paint";  // whatever $OCIO says
  if (integer && view != PictureView::kShown && !named.empty() && !by_paint) {
    GONIO_TRY(undo_view(named, part, name, picture));
  } else if (integer && view != PictureView::kShown && (by_paint || view == PictureView::kPaint))
    for_pixels(picture.rgb, [](float* pixel) {
      const color::Rgb shown = color::rec709_from_rec2020({pixel[0], pixel[1], pixel[2]});
      if (std::max({shown.x, shown.y, shown.z}) <= display::kKnee) return;
      const color::Rgb light = color::rec2020_from_rec709(display::paint_view_undone(shown));
      for (int c = 0; c < 3; ++c) pixel[c] = static_cast<float>(light[c]);
    });
  return picture;
}

}  // namespace goniochrome::sketch
