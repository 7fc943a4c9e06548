#include "tilts.h"

#include <filesystem>

#include "base/clock.h"
#include "base/json.h"
#include "base/text.h"
#include "fit/tilt_fit.h"
#include "image/surface_file.h"

namespace goniochrome::tool {

Result<std::vector<int>> tilt_lookups(const std::string& text) {
  std::vector<int> counts;
  if (text == "none") return counts;
  for (const std::string_view part : split(text, ',')) {
    const auto count = parse_integer(part);
    if (!count || *count < 1 || *count > fit::kMostTiltLookups || (!counts.empty() && *count <= counts.back()))
      return usage_error("--tilts \"{}\": give none, or numbers of look-ups from 1 to {}, ascending, as in 8,16,32",
                         text, fit::kMostTiltLookups);
    counts.push_back(static_cast<int>(*count));
  }
  return counts;
}

Tilts::Tilts(const Options& options, const formats::Basis& basis, cli::Session& session)
    : options_(options), basis_(basis), session_(session) {}

Result<void> Tilts::begin() {
  GONIO_ASSIGN(lookups_, tilt_lookups(options_.tilts));
  return {};
}

void Tilts::add(paint::Paint& paint, const std::optional<MadeMap>& made, const std::string& input,
                const std::string& where) {
  if (lookups_.empty() || !paint.lobes || !paint.color_map) return;
  if (made && !made->supported) {
    ++unsupported_;
    return;
  }
  std::optional<brdf::ColorMap> map;
  if (made) map = made->map;
  if (!map) {
    const std::string path = (std::filesystem::path(input).parent_path() / paint.color_map->href).string();
    auto read = image::read_color_map(path);
    if (!read.ok()) {
      session_.warn(fmt::format("{}: paint \"{}\" gets no tilted lobes: {}", where, paint.name, read.error().message));
      return;
    }
    map = std::move(*read);
    map->index = paint.color_map->index;
  }
  const Stopwatch clock;
  fit::TiltOptions asked;
  asked.lookups = lookups_;
  fit::TiltFit fit = fit::fit_tilts(*map, *paint.lobes, basis_, asked);
  time_s_ += clock.elapsed_s();
  ++maps_;
  if (!fit.sets.empty()) ++tilted_;
  session_.add("tilts", [&] {
    Json sets = Json::array();
    for (const paint::TiltedLobes& set : fit.sets)
      sets.push_back({{"lookups", set.lookups()}, {"de00_mean", json_number(set.mean_de00)}});
    return Json{{"name", paint.name}, {"lobes_de00", json_number(fit.lobes_de00)}, {"sets", sets}};
  });
  paint.lobes->tilts = std::move(fit.sets);
}

void Tilts::finish() {
  if (unsupported_ > 0)
    session_.say(
        fmt::format("{}: no tilted lobes for {} paints, as left-out readings do not tell that their maps are "
                    "better than the aspecular angle; --color-map-model isolines makes them",
                    session_.tool(), unsupported_));
  session_.results()["without_tilts"] = unsupported_;
  if (maps_ == 0) return;
  session_.say(fmt::format("{}: tilted lobes for {} of {} paints with color maps, {:.2f} s each", session_.tool(),
                           tilted_, maps_, time_s_ / maps_));
}

}  // namespace goniochrome::tool
