// Channels are named LAYER.CHANNEL, where the layer may hold points itself, as in ViewLayer.Combined.R; programs that
// write several parts put the layer into the name of the part instead ("Technical Introduction to OpenEXR").
#include "image/internal/exr_layers.h"

#include <algorithm>
#include <map>
#include <string_view>

#include "base/text.h"

namespace goniochrome::image {

namespace {

struct Layer {
  std::string name;  // before the channels; "" is that of the plain channels
  std::size_t part = 0;
  std::map<std::string, std::string> channels;  // the names in the file, by r, g, b and the like

  bool has(const char* channel) const { return channels.contains(channel); }
  bool is_rgb() const { return has("r") && has("g") && has("b"); }
  // Y beside X and Z is a coordinate; Y beside RY and BY is brightness without its colors.
  bool is_gray() const { return has("y") && !has("x") && !has("z") && !has("ry") && !has("by"); }
  bool is_color() const { return is_rgb() || is_gray(); }
};

std::string short_name(std::string_view channel) {
  std::string name = lower(channel);
  for (const char* word : {"red", "green", "blue", "alpha"})
    if (name == word) name.resize(1);
  return name;
}

// The layers of all parts, those of a part in the order of their names.
std::vector<Layer> layers_of(const std::vector<ExrPartNames>& parts) {
  std::vector<Layer> layers;
  for (std::size_t part = 0; part < parts.size(); ++part) {
    std::map<std::string, Layer> by_name;
    for (const std::string& channel : parts[part].channels) {
      const std::size_t point = channel.rfind('.'), after = point == std::string::npos ? 0 : point + 1;
      const std::string name = after == 0 ? "" : channel.substr(0, point);
      Layer& layer = by_name[name];
      layer.name = name, layer.part = part;
      layer.channels.try_emplace(short_name(std::string_view(channel).substr(after)), channel);
    }
    for (auto& [name, layer] : by_name) layers.push_back(std::move(layer));
  }
  return layers;
}

ExrLayer picture_of(const Layer& layer) {
  ExrLayer picture{layer.part, {}, {}};
  const auto take = [&](const char* channel) {
    const auto found = layer.channels.find(lower(channel));
    if (found != layer.channels.end()) picture.channels.push_back(found->second), picture.as.emplace_back(channel);
  };
  if (layer.is_rgb()) {
    for (const char* channel : {"R", "G", "B", "A"}) take(channel);
  } else {
    for (const char* channel : {"Y", "A"}) take(channel);
  }
  return picture;
}

// A layer in messages and on a command line: its own name behind that of its part, where there are several parts.
std::string full_name(const Layer& layer, const std::vector<ExrPartNames>& parts) {
  const std::string part = parts.size() > 1 ? parts[layer.part].part : "";
  return part + (part.empty() || layer.name.empty() ? "" : ".") + layer.name;
}

// The channel of that name in one of the parts, as gray.
std::vector<ExrLayer> single_channels(const std::vector<ExrPartNames>& parts, const std::string& name) {
  std::vector<ExrLayer> found;
  for (std::size_t part = 0; part < parts.size(); ++part)
    for (const std::string& channel : parts[part].channels)
      if (channel == name || parts[part].part + "." + channel == name) found.push_back({part, {channel}, {"Y"}});
  return found;
}

std::string listed(const std::vector<std::string>& names) {
  constexpr std::size_t kMost = 12;
  if (names.size() <= kMost) return joined(names, ", ");
  return joined({names.begin(), names.begin() + kMost}, ", ") + fmt::format(" and {} more", names.size() - kMost);
}

Error no_color(const std::vector<ExrPartNames>& parts, const std::string& file) {
  std::vector<std::string> all;
  for (const ExrPartNames& part : parts)
    for (const std::string& channel : part.channels)
      all.push_back(parts.size() > 1 ? part.part + "." + channel : channel);
  if (all.empty()) return input_error("{}: holds no channels", file);
  return input_error(
      "{}: none of its layers has R, G and B, or Y alone: its channels are {}: name one to be gray, as in {}[{}]", file,
      listed(all), file, all.front());
}

}  // namespace

Result<ExrLayer> color_layer(const std::vector<ExrPartNames>& parts, const std::string& wanted,
                             const std::string& file) {
  std::vector<Layer> colors = layers_of(parts);
  std::erase_if(colors, [](const Layer& layer) { return !layer.is_color(); });
  if (wanted.empty()) {
    if (colors.empty()) return no_color(parts, file);
    const Layer& first = colors.front();
    if (colors.size() == 1 || (first.part == 0 && first.name.empty())) return picture_of(first);
  } else {
    const std::string name = lower(wanted);
    std::vector<ExrLayer> found;
    for (const Layer& layer : colors)
      if (name == lower(full_name(layer, parts)) || name == lower(layer.name)) found.push_back(picture_of(layer));
    if (found.empty()) found = single_channels(parts, wanted);
    if (found.size() == 1) return found.front();
    if (colors.empty()) return no_color(parts, file);
  }
  std::vector<std::string> names;
  for (const Layer& layer : colors) names.push_back(full_name(layer, parts));
  const std::string problem = wanted.empty()
                                  ? "several layers have colors"
                                  : fmt::format("no layer with colors is called \"{}\", or several are", wanted);
  const std::string example = names.front().empty() && names.size() > 1 ? names[1] : names.front();
  if (names.front().empty()) names.front() = "the one without a name";
  return input_error("{}: {}: {}: name one, as in {}[{}]", file, problem, listed(names), file, example);
}

Image shown_in(const ExrWindow& display, const ExrWindow& data, Image image) {
  const auto channels = static_cast<std::size_t>(image.channels);
  Image shown = even_image(display.width, display.height, image.channels, std::move(image.channel_names));
  const int left = std::max(display.x, data.x), right = std::min(display.x + display.width, data.x + data.width);
  const int top = std::max(display.y, data.y), bottom = std::min(display.y + display.height, data.y + data.height);
  for (int y = top; y < bottom && left < right; ++y)
    std::copy_n(image.pixel(left - data.x, y - data.y), channels * static_cast<std::size_t>(right - left),
                shown.pixel(left - display.x, y - display.y));
  return shown;
}

}  // namespace goniochrome::image
