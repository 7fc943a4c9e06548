#include "at_pixel.h"

#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "brdf/highlight.h"
#include "image/aov_file.h"
#include "sketch/traced_light.h"

namespace goniochrome::tool {

namespace {

Result<SeenPixel> seen(const image::AovFile& file, const std::string& option, const std::vector<double>& place) {
  const bool whole = place.size() == 2 && std::floor(place[0]) == place[0] && std::floor(place[1]) == place[1];
  if (!whole) return usage_error("{} takes a pixel: write {} X,Y, whole numbers from the upper left", option, option);
  SeenPixel pixel{option, static_cast<int>(place[0]), static_cast<int>(place[1]), 0};
  if (pixel.x >= file.image.width || pixel.y >= file.image.height)
    return usage_error("{} is {},{}: {} has {} x {} pixels", option, pixel.x, pixel.y, file.path, file.image.width,
                       file.image.height);
  GONIO_ASSIGN(const int aspecular, file.channel("aspecular"));
  GONIO_ASSIGN(const int mask, file.channel("mask"));
  const float* values = file.image.pixel(pixel.x, pixel.y);
  if (values[mask] < 0.5F)
    return usage_error("{} is {},{}: no mesh is seen there in {}", option, pixel.x, pixel.y, file.path);
  pixel.aspecular_deg = values[aspecular];
  return pixel;
}

Result<void> check_places(const Options& o) {
  const bool places = !o.at_pixel.empty() || !o.travel_to.empty() || !o.gloss_to.empty();
  if (o.image.empty() && places) return usage_error("--at-pixel, --travel-to and --gloss-to need --image");
  if (!o.image.empty() && !places)
    return usage_error("--image lacks a place in it: give --at-pixel, --travel-to or --gloss-to");
  if (o.at_pixel.empty() && o.lighter != 0) return usage_error("--lighter is for --at-pixel: use --lightness-shift");
  if (!o.at_pixel.empty() && !o.at_deg.empty()) return usage_error("--at and --at-pixel name two places: give one");
  if (!o.travel_to.empty() && !o.travel_deg.empty()) return usage_error("--travel and --travel-to exclude each other");
  if (!o.gloss_to.empty() && !o.gloss.empty()) return usage_error("--gloss and --gloss-to exclude each other");
  return {};
}

// At a place, --chroma is a factor and --hue is a turn, because a color at one angle has no average to set.
Result<void> place_tweak(Options& o) {
  if ((!o.chroma.empty() && o.chroma_factor != 1) || (!o.hue_deg.empty() && o.hue_shift_deg != 0) ||
      (o.lighter != 0 && o.lightness_shift != 0))
    return usage_error("--at-pixel is told one move twice: --lighter, --chroma and --hue are its shifts");
  if (o.chroma.size() > 1 || o.hue_deg.size() > 1)
    return usage_error("--at-pixel takes one --chroma factor and one --hue turn");
  if (!o.chroma.empty()) o.chroma_factor = o.chroma.front();
  if (!o.hue_deg.empty()) o.hue_shift_deg = o.hue_deg.front();
  if (o.lighter != 0) o.lightness_shift = o.lighter;
  if (o.lightness_shift == 0 && o.chroma_factor == 1 && o.hue_shift_deg == 0)
    return usage_error("--at-pixel lacks its move: add --lighter, --chroma or --hue");
  o.chroma.clear(), o.hue_deg.clear();
  return {};
}

}  // namespace

Result<PlacedOptions> placed(const Options& options) {
  GONIO_TRY(check_places(options));
  PlacedOptions result{options, {}, ""};
  if (options.image.empty()) return result;
  Options& o = result.options;
  GONIO_ASSIGN(const image::AovFile file, image::read_aov_file(options.image));
  result.drawn_by_rays = file.drawn_by_rays;
  std::optional<sketch::TracedLight> traced;
  if (!file.transport.empty()) {
    GONIO_ASSIGN(traced, sketch::TracedLight::of(file));
    result.drawn_by_rays.clear();  // the light is known
  }
  const auto look = [&](const char* option, const std::vector<double>& place, bool of_lamp = false) -> Result<double> {
    GONIO_ASSIGN(SeenPixel pixel, seen(file, option, place));
    if (traced && traced->shows_floor(pixel.x, pixel.y))
      return usage_error("{} is {},{}: the floor is seen there in {}, which wears no paint: take a pixel of the mesh",
                         option, pixel.x, pixel.y, file.path);
    if (traced && !of_lamp) {
      if (const auto angle = traced->aspecular_deg(pixel.x, pixel.y)) pixel.aspecular_deg = *angle, pixel.traced = true;
    }
    result.pixels.push_back(pixel);
    return pixel.aspecular_deg;
  };
  if (!o.at_pixel.empty()) {
    GONIO_ASSIGN(const double angle, look("--at-pixel", o.at_pixel));
    o.at_deg = {angle};
    GONIO_TRY(place_tweak(o));
  }
  if (!o.travel_to.empty()) {
    GONIO_ASSIGN(const double angle, look("--travel-to", o.travel_to));
    if (angle <= 15)
      return usage_error(
          "--travel-to is {},{}, {:.1f} deg from specular: a travel lies above 15: go farther from the light",
          o.travel_to[0], o.travel_to[1], angle);
    o.travel_deg = {angle};
  }
  if (!o.gloss_to.empty()) {
    GONIO_ASSIGN(const double angle, look("--gloss-to", o.gloss_to, true));
    GONIO_ASSIGN(const double gloss, brdf::gloss_of_edge(angle, *parse_number(o.gloss_angle_deg),
                                                         file.lights.empty() ? 0 : file.lights.front().extent_deg));
    o.gloss = {gloss};
  }
  return result;
}

}  // namespace goniochrome::tool
