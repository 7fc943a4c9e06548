#include "render/aov.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "base/angles.h"
#include "base/large_pages.h"
#include "base/parallel.h"
#include "base/text.h"
#include "paint/geometry.h"

namespace goniochrome::render {

namespace {

// One buffer: its channels, and the value of each of them at a pixel of the mesh.
struct Aov {
  std::string name;
  std::vector<std::string> channels;
  float nothing;  // where the mesh is not
  std::function<void(const Gbuffer&, int x, int y, const Vec3& to_light, float* value)> evaluate;
};

const std::vector<Aov>& aovs() {
  static const std::vector<Aov> table = {
      {"normal",
       {"normal.X", "normal.Y", "normal.Z"},
       0,
       [](const Gbuffer& g, int x, int y, const Vec3&, float* value) { std::copy_n(g.at(x, y), 3, value); }},
      {"aspecular",
       {"aspecular"},
       180,
       [](const Gbuffer& g, int x, int y, const Vec3& to_light, float* value) {
         const double angle_rad = paint::aspecular_angle_rad(to_light, g.to_viewer(x, y), g.normal(x, y));
         *value = static_cast<float>(angle_rad / kDegree);
       }},
      {"lambert",
       {"lambert"},
       0,
       [](const Gbuffer& g, int x, int y, const Vec3& to_light, float* value) {
         *value = static_cast<float>(std::max(0.0, dot(g.normal(x, y), to_light)));
       }},
      {"mask", {"mask"}, 0, [](const Gbuffer&, int, int, const Vec3&, float* value) { *value = 1; }},
      {"part",
       {"part"},
       0,
       [](const Gbuffer& g, int x, int y, const Vec3&, float* value) {
         *value = static_cast<float>(g.part(x, y) + 1);
       }},
  };
  return table;
}

// Calls put(x, y, to) for the values of the channels at each pixel.
template <class Put>
void add_channels(image::Image& picture, const std::vector<std::string>& names, const Put& put) {
  const int channels = picture.channels + static_cast<int>(names.size());
  image::Image wider = image::even_image(picture.width, picture.height, channels, picture.channel_names);
  wider.channel_names.insert(wider.channel_names.end(), names.begin(), names.end());
  const float* from = picture.data.data();
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x, from += picture.channels)
      put(x, y, std::copy_n(from, picture.channels, wider.pixel(x, y)));
  picture = std::move(wider);
}

}  // namespace

std::string aov_names() {
  return joined(aovs(), ", ", &Aov::name);
}

Result<void> add_aov(image::Image& picture, const Gbuffer& gbuffer, const std::string& name, const Vec3& to_light) {
  const auto aov = std::ranges::find(aovs(), name, &Aov::name);
  if (aov == aovs().end())
    return usage_error("there is no buffer \"{}\": there are {}, error and transport", name, aov_names());
  add_channels(picture, aov->channels, [&](int x, int y, float* to) {
    if (gbuffer.part(x, y) >= 0) {
      aov->evaluate(gbuffer, x, y, to_light, to);
    } else {
      std::fill_n(to, aov->channels.size(), aov->nothing);
    }
  });
  return {};
}

void add_error(image::Image& picture, const Noise& noise) {
  add_channels(picture, {"error"}, [&](int x, int y, float* to) { *to = *noise.de00.pixel(x, y); });
}

Result<Gbuffer> gbuffer_of(const image::AovFile& buffers) {
  constexpr double kUnit = 1e-3;  // a normal kept in halves is 5e-4 off unit length
  GONIO_ASSIGN(const int normal_x, buffers.channel("normal.X"));
  GONIO_ASSIGN(const int normal_y, buffers.channel("normal.Y"));
  GONIO_ASSIGN(const int normal_z, buffers.channel("normal.Z"));
  GONIO_ASSIGN(const int part_channel, buffers.channel("part"));
  if (!buffers.has_rays || buffers.parts.empty())
    return input_error("{}: its header lacks goniochrome:{}: render the buffers again", buffers.path,
                       buffers.has_rays ? "parts" : "rays");
  const image::Image& image = buffers.image;
  Gbuffer gbuffer{image.width, image.height, {}, {buffers.corner, buffers.right, buffers.down}};
  resize_on_large_pages(gbuffer.data,
                        static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height) * 4);
  const auto take_row = [&](int y) -> Result<void> {
    float* to = &gbuffer.data[4 * gbuffer.index(0, y)];
    for (int x = 0; x < image.width; ++x, to += 4) {
      const float* pixel = image.pixel(x, y);
      const float part = pixel[part_channel];
      if (part == 0) continue;
      if (!(part > 0 && part <= static_cast<float>(buffers.parts.size()) && part == std::floor(part)))
        return input_error(
            "{}: part {} at pixel {},{}: the header names {} parts, counted from 1: render again without "
            "filtering",
            buffers.path, part, x, y, buffers.parts.size());
      const Vec3 normal{pixel[normal_x], pixel[normal_y], pixel[normal_z]};
      if (!(std::abs(length(normal) - 1) < kUnit))
        return input_error("{}: the normal at pixel {},{} has the length {:.4g}, not 1: render again without filtering",
                           buffers.path, x, y, length(normal));
      to[0] = pixel[normal_x], to[1] = pixel[normal_y], to[2] = pixel[normal_z], to[3] = part;
    }
    return {};
  };
  std::vector<char> is_bad(static_cast<std::size_t>(image.height), 0);
  parallel_each(is_bad.size(), 16, [&](std::size_t y) { is_bad[y] = take_row(static_cast<int>(y)).ok() ? 0 : 1; });
  if (const auto bad = std::ranges::find(is_bad, 1); bad != is_bad.end())
    return take_row(static_cast<int>(bad - is_bad.begin())).error();
  return gbuffer;
}

Light light_of(const image::AovLight& light) {
  Light result{light.direction, light.white, 0.5 * light.extent_deg * kDegree};
  if (light.is_placed) result.place = {light.place, light.distance};
  return result;
}

}  // namespace goniochrome::render
