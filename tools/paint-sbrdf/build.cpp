#include "build.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <unordered_map>

#include "base/angles.h"
#include "base/parallel.h"
#include "base/text.h"
#include "fit/surface_refit.h"

namespace goniochrome::tool {

namespace {

constexpr int kUsualSize = 256, kMostLobes = 16;
// Shares add up to 1 but for rounding.
constexpr float kAllCovered = 1 - 1e-6F;
constexpr std::size_t kMostTexels = std::size_t{1} << 24;
constexpr double kGlossIndex = 1.5;

// AxB, both 1 or more.
Result<std::pair<int, int>> pair_of(const std::string& option, const std::string& text, const char* example) {
  const auto words = split(lower(text), 'x');
  if (words.size() == 2) {
    const auto first = parse_integer(words[0]), second = parse_integer(words[1]);
    if (first && second && *first >= 1 && *second >= 1 && *first <= 65536 && *second <= 65536)
      return std::pair(static_cast<int>(*first), static_cast<int>(*second));
  }
  return usage_error("--{} is \"{}\": give two whole numbers from 1 to 65536, as in --{} {}", option, text, option,
                     example);
}

}  // namespace

Result<Layout> layout_of(const Options& o, const Surfaces& surfaces, const Pattern& pattern) {
  Layout layout;
  std::pair<int, int> size = pattern.size();
  for (const Surface& surface : surfaces.all)
    if (static_cast<double>(surface.width()) * surface.height() > static_cast<double>(size.first) * size.second)
      size = {surface.width(), surface.height()};
  if (size.first == 0) size = {kUsualSize, kUsualSize};
  if (!o.size.empty()) {
    GONIO_ASSIGN(size, pair_of("size", o.size, "512x512"));
  }
  layout.width = size.first, layout.height = size.second;
  layout.crop_width = layout.width, layout.crop_height = layout.height;
  if (!o.crop.empty()) {
    const bool whole = std::ranges::all_of(o.crop, [](double number) { return number == std::floor(number); });
    if (o.crop.size() != 4 || !whole || o.crop[2] < 1 || o.crop[3] < 1 || o.crop[0] + o.crop[2] > layout.width ||
        o.crop[1] + o.crop[3] > layout.height)
      return usage_error("--crop: give X,Y,W,H in whole texels of the map, which is {} x {}", layout.width,
                         layout.height);
    layout.left = static_cast<int>(o.crop[0]), layout.top = static_cast<int>(o.crop[1]);
    layout.crop_width = static_cast<int>(o.crop[2]), layout.crop_height = static_cast<int>(o.crop[3]);
  }
  if (!o.tile.empty()) {
    std::pair<int, int> tile;
    GONIO_ASSIGN(tile, pair_of("tile", o.tile, "2x3"));
    layout.columns = tile.first, layout.rows = tile.second;
  }
  const double texels = static_cast<double>(layout.crop_width) * layout.columns * layout.crop_height * layout.rows;
  if (texels > static_cast<double>(kMostTexels))
    return usage_error("the map would have {:.0f} texels: give a smaller --size or --tile, for {} at most", texels,
                       kMostTexels);
  return layout;
}

namespace {

// The changes by --turn, --polish, --wear and --gloss at a place.
class Changes {
 public:
  static Result<Changes> create(const Options& o, double mirror_exponent) {
    Changes changes;
    changes.turn_rad_ = o.turn_deg * kDegree;
    GONIO_ASSIGN(changes.polish_, Amount::parse("polish", o.polish));
    GONIO_ASSIGN(changes.wear_, Amount::parse("wear", o.wear));
    GONIO_ASSIGN(changes.gloss_, Amount::parse("gloss", o.gloss));
    if (!changes.gloss_.empty()) changes.coat_ = brdf::coat_surface(kGlossIndex, 1, mirror_exponent).surface;
    return changes;
  }

  void apply(double u, double v, double alpha, brdf::LobeSurface& surface) const {
    const double steps = 2 * (polish_.at(u, v) - wear_.at(u, v));
    if (steps == 0 && turn_rad_ == 0 && gloss_.empty()) return;
    brdf::LobeSurface changed{surface.diffuse, {}};
    for (brdf::TurnedLobe lobe : surface.lobes) {
      if (steps != 0) brdf::widen(lobe.lobe, std::pow(4.0, steps));
      changed.lobes.push_back(brdf::turned_lobe(lobe.lobe, lobe.turn_rad + turn_rad_));
    }
    brdf::add_surface(changed, coat_, alpha * gloss_.at(u, v));
    surface = std::move(changed);
  }

 private:
  double turn_rad_ = 0;
  Amount polish_, wear_, gloss_;
  brdf::LobeSurface coat_;
};

// Surfaces without repetition: each is refitted once.
class Collection {
 public:
  std::uint32_t number(const brdf::LobeSurface& surface) {
    std::string key;
    const auto put = [&](const void* from, std::size_t bytes) { key.append(static_cast<const char*>(from), bytes); };
    put(&surface.diffuse, sizeof surface.diffuse);
    for (const brdf::TurnedLobe& lobe : surface.lobes) put(&lobe, sizeof lobe);
    const auto [entry, is_new] = numbers_.try_emplace(std::move(key), static_cast<std::uint32_t>(all.size()));
    if (is_new) all.push_back(surface);
    return entry->second;
  }

  std::vector<brdf::LobeSurface> all;

 private:
  std::unordered_map<std::string, std::uint32_t> numbers_;
};

// A texel and how far it is from what it stands for, by refit_error().
struct MadeTexel {
  brdf::LobeSurface surface;  // multiplied by alpha
  Vec3 normal;                // the mean of those that the texel is made of
  double error = 0, alpha = 0;
};

// At most so many lobes. With frames of their own, as many lobes as that are kept whatever their directions are.
fit::Refit fitted_to(const brdf::LobeSurface& sum, int most, bool own_frames) {
  if (own_frames && sum.lobes.size() <= static_cast<std::size_t>(most)) return {sum, 0};
  return fit::refit(sum, most);
}

class Builder {
 public:
  Builder(const Options& options, const Surfaces& surfaces, const Pattern& pattern, const Layout& layout,
          const Changes& changes)
      : most_lobes_(options.lobes), surfaces_(surfaces), pattern_(pattern), layout_(layout), changes_(changes) {}

  // The texels of a row of what is kept.
  std::vector<MadeTexel> row(int row, std::vector<double>& share) const {
    std::vector<MadeTexel> texels(static_cast<std::size_t>(layout_.crop_width));
    for (int i = 0; i < layout_.crop_width; ++i) {
      const int column = layout_.left + i, line = layout_.top + row;
      MadeTexel& texel = texels[static_cast<std::size_t>(i)];
      for (const auto& [number, part] : pattern_.shares(column, line, layout_.width, layout_.height)) {
        share[number] += part;
        add(surfaces_.all[number], column, line, part, texel);
      }
      for (brdf::TurnedLobe& lobe : texel.surface.lobes) brdf::widen_by_normals(lobe.lobe, length(texel.normal));
      changes_.apply((column + 0.5) / layout_.width, 1 - (line + 0.5) / layout_.height, texel.alpha, texel.surface);
    }
    return texels;
  }

 private:
  // A map of another size is resampled first: the mixture of its texels has as many lobes as it has itself.
  void add(const Surface& surface, int column, int row, double part, MadeTexel& texel) const {
    if (surface.width() == 0) {
      brdf::add_surface(texel.surface, surface.paint, part);
      texel.normal += part * surface.normal(0, 0);
      texel.alpha += part * surface.alpha(0, 0);
      return;
    }
    brdf::LobeSurface sum;
    for (const auto& [y, high] : brdf::covered_texels(row, layout_.height, surface.height()))
      for (const auto& [x, wide] : brdf::covered_texels(column, layout_.width, surface.width())) {
        brdf::add_surface(sum, surface.texel(x, y), wide * high);
        texel.alpha += part * wide * high * surface.alpha(x, y);
        texel.normal += (part * wide * high) * surface.normal(x, y);
      }
    const int most = most_lobes_ > 0 ? std::min(most_lobes_, surface.lobes()) : surface.lobes();
    fit::Refit fitted = fitted_to(sum, most, most_lobes_ == 0);
    texel.error = std::max(texel.error, fitted.error);
    brdf::add_surface(texel.surface, fitted.surface, part);
  }

  int most_lobes_;
  const Surfaces& surfaces_;
  const Pattern& pattern_;
  const Layout& layout_;
  const Changes& changes_;
};

// The most lobes of a texel: those that are asked for, or all that the surfaces have together.
int most_lobes(const Options& options, const Surfaces& surfaces) {
  if (options.lobes > 0) return options.lobes;
  int sum = options.gloss.empty() ? 0 : 2;
  for (const Surface& surface : surfaces.all) sum += surface.lobes();
  return std::min(sum, kMostLobes);
}

double albedo_along_normal(const brdf::LobeSurface& surface) {
  color::Rgb albedo = kPi * surface.diffuse;
  for (const brdf::TurnedLobe& lobe : surface.lobes) albedo += brdf::environment_fetch(lobe.lobe, {0, 0, 1}).weight;
  return std::max({albedo.x, albedo.y, albedo.z});
}

// Fits what has too many lobes, in parts so that progress can be told.
std::vector<double> refit_all(std::vector<brdf::LobeSurface>& all, int most, bool own_frames, cli::Session& session) {
  std::vector<double> errors(all.size(), 0.0);
  constexpr std::size_t kAtOnce = 256;
  for (std::size_t first = 0; first < all.size(); first += kAtOnce) {
    const std::size_t count = std::min(kAtOnce, all.size() - first);
    parallel_for(count, 4, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = first + begin; i < first + end; ++i) {
        fit::Refit refit = fitted_to(all[i], most, own_frames);
        all[i] = std::move(refit.surface), errors[i] = refit.error;
      }
    });
    session.progress(fmt::format("lobes: {} of {} kinds of texels", first + count, all.size()));
  }
  return errors;
}

}  // namespace

Result<BuiltMap> built_map(const Options& options, const Surfaces& surfaces, const Pattern& pattern,
                           const Layout& layout, cli::Session& session) {
  GONIO_ASSIGN(const Changes changes, Changes::create(options, surfaces.mirror_exponent));
  const Builder builder(options, surfaces, pattern, layout, changes);
  const auto rows = static_cast<std::size_t>(layout.crop_height), wide = static_cast<std::size_t>(layout.crop_width);
  std::vector<std::vector<double>> shares(rows, std::vector<double>(surfaces.all.size(), 0.0));
  std::vector<std::uint32_t> numbers(rows * wide);
  std::vector<float> resampled(rows * wide);  // errors
  std::vector<float> alpha(rows * wide);
  std::vector<Vec3> normals(rows * wide);
  bool covers = true;
  Collection kinds;
  constexpr std::size_t kRowsAtOnce = 32;
  for (std::size_t first = 0; first < rows; first += kRowsAtOnce) {
    const std::size_t count = std::min(kRowsAtOnce, rows - first);
    std::vector<std::vector<MadeTexel>> made(count);
    parallel_for(count, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) made[i] = builder.row(static_cast<int>(first + i), shares[first + i]);
    });
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t column = 0; column < wide; ++column) {
        const std::size_t place = (first + i) * wide + column;
        numbers[place] = kinds.number(made[i][column].surface);
        resampled[place] = static_cast<float>(made[i][column].error);
        alpha[place] = static_cast<float>(std::min(made[i][column].alpha, 1.0));
        normals[place] = normalized(made[i][column].normal);
        covers = covers && alpha[place] > kAllCovered;
      }
    }
    session.progress(fmt::format("texels: {} of {} rows", first + count, rows));
  }
  const std::vector<double> errors = refit_all(kinds.all, most_lobes(options, surfaces), options.lobes == 0, session);

  BuiltMap map;
  map.lowest = std::numeric_limits<double>::infinity();
  map.share.assign(surfaces.all.size(), 0.0);
  for (const std::vector<double>& row : shares)
    for (std::size_t i = 0; i < row.size(); ++i) map.share[i] += row[i] / static_cast<double>(rows * wide);
  std::size_t most = 0;
  for (const brdf::LobeSurface& surface : kinds.all) {
    most = std::max(most, surface.lobes.size());
    map.albedo_max = std::max(map.albedo_max, albedo_along_normal(surface));
    for (const brdf::TurnedLobe& lobe : surface.lobes)
      map.lowest = std::min(map.lowest, lobe.lobe.exponent), map.highest = std::max(map.highest, lobe.lobe.exponent);
  }
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const double error = std::max<double>(errors[numbers[i]], resampled[i]);
    map.refitted += error > 0;
    map.error_mean += error, map.error_max = std::max(map.error_max, error);
  }
  if (map.refitted > 0) map.error_mean /= static_cast<double>(map.refitted);

  brdf::SbrdfTexture& texture = map.texture;
  texture = {layout.crop_width * layout.columns, layout.crop_height * layout.rows, static_cast<int>(most), {}};
  const auto stride = static_cast<std::size_t>(texture.stride()), turned = std::size_t{2} * most;
  const bool bent = std::ranges::any_of(
      surfaces.all, [](const Surface& surface) { return surface.map && !surface.map->normals.empty(); });
  map.frames = !std::ranges::all_of(kinds.all, brdf::has_one_frame);
  std::vector<float> texels(kinds.all.size() * stride), turns(map.frames ? kinds.all.size() * turned : 0);
  for (std::size_t i = 0; i < kinds.all.size(); ++i)
    brdf::write_texel(kinds.all[i], texture.lobes, map.lowest, &texels[i * stride],
                      map.frames ? &turns[i * turned] : nullptr);
  texture.values.reserve(stride * static_cast<std::size_t>(texture.width) * static_cast<std::size_t>(texture.height));
  for (int row = 0; row < texture.height; ++row) {
    for (int column = 0; column < texture.width; ++column) {
      const std::size_t place = static_cast<std::size_t>(row % layout.crop_height) * wide +
                                static_cast<std::size_t>(column % layout.crop_width);
      const float* from = &texels[stride * numbers[place]];
      texture.values.insert(texture.values.end(), from, from + stride);
      if (map.frames) {
        const auto turn = turns.begin() + static_cast<std::ptrdiff_t>(turned * numbers[place]);
        texture.turns.insert(texture.turns.end(), turn, turn + static_cast<std::ptrdiff_t>(turned));
      }
      if (!covers) texture.alpha.push_back(alpha[place]);
      for (int c = 0; c < 3 && bent; ++c) texture.normals.push_back(static_cast<float>(normals[place][c]));
    }
  }
  for (const float value : alpha) map.alpha_mean += value / static_cast<double>(alpha.size());
  return map;
}

}  // namespace goniochrome::tool
