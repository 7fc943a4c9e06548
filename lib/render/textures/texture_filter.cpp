#include "render/textures/texture_filter.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>
#include <utility>

#include "base/parallel.h"
#include "brdf/lobe_merge.h"

namespace goniochrome::render {

namespace {

using TexelAt = std::function<brdf::LobeSurface(int column, int row)>;

TextureLevel half_size(int width, int height, const TexelAt& texel, const std::vector<float>& alpha,
                       const std::vector<float>& normals, int most_lobes) {
  TextureLevel level{std::max(width / 2, 1), std::max(height / 2, 1), {}};
  const std::size_t texels = static_cast<std::size_t>(level.width) * static_cast<std::size_t>(level.height);
  if (!alpha.empty()) level.alpha.resize(texels);
  if (!normals.empty()) level.normals.resize(3 * texels);
  level.texels.resize(texels);
  const auto alpha_at = [&](int column, int row) {
    return alpha.empty() ? 1.0
                         : alpha[static_cast<std::size_t>(row) * static_cast<std::size_t>(width) +
                                 static_cast<std::size_t>(column)];
  };
  for_pixels(level.width, level.height, [&](int column, int row) {
    brdf::LobeSurface sum;
    double covered = 0;
    Vec3 normal;
    for (const auto& [y, high] : brdf::covered_texels(row, level.height, height)) {
      for (const auto& [x, wide] : brdf::covered_texels(column, level.width, width)) {
        brdf::add_surface(sum, texel(x, y), wide * high), covered += wide * high * alpha_at(x, y);
        const std::size_t from = 3 * static_cast<std::size_t>(y * width + x);
        for (int c = 0; c < 3 && !normals.empty(); ++c)
          normal[c] += wide * high * normals[from + static_cast<std::size_t>(c)];
      }
    }
    const auto at = static_cast<std::size_t>(row * level.width + column);
    level.texels[at] = brdf::merged(std::move(sum), most_lobes);
    if (!alpha.empty()) level.alpha[at] = static_cast<float>(covered);
    if (normals.empty()) return;
    const double size = length(normal);
    for (brdf::TurnedLobe& lobe : level.texels[at].lobes) brdf::widen_by_normals(lobe.lobe, size);
    for (int c = 0; c < 3; ++c)
      level.normals[3 * at + static_cast<std::size_t>(c)] = static_cast<float>(size > 0 ? normal[c] / size : c == 2);
  });
  return level;
}

}  // namespace

std::vector<TextureLevel> texture_levels(const brdf::SbrdfTexture& texture, std::uint32_t lobes) {
  const int most = std::max(kMostLevelLobes, texture.lobes);
  std::vector<TextureLevel> levels;
  int width = texture.width, height = texture.height;
  TexelAt texel = [&](int column, int row) { return brdf::lobe_surface(texture, column, row, lobes); };
  while (width > 1 || height > 1) {
    levels.push_back(levels.empty()
                         ? half_size(width, height, texel, texture.alpha, texture.normals, most)
                         : half_size(width, height, texel, levels.back().alpha, levels.back().normals, most));
    width = levels.back().width, height = levels.back().height;
    texel = [&levels, width](int column, int row) {
      return levels.back().texels[static_cast<std::size_t>(row * width + column)];
    };
  }
  return levels;
}

TexturePlace repeated(const TexturePlace& place, double repeat) {
  constexpr double kFarthest = 1e30;  // which a float and its multiples hold
  TexturePlace result = place;
  if (repeat == 1 && std::max(std::abs(place.u), std::abs(place.v)) <= 1) return result;
  for (float* value : {&result.u, &result.v, &result.across[0], &result.across[1], &result.down[0], &result.down[1]})
    *value = static_cast<float>(std::clamp(repeat * *value, -kFarthest, kFarthest));
  return result;
}

namespace {

// How much wider than a footprint of so many texels the row of its probes is, so that what they see together has the
// variance of the footprint. Of level 0 each probe shows what it would show without a filter. A texel of a coarser
// level is the mean of `size` texels, of the variance (size^2-1)/12, and blending of two such texels adds
// (size^2-1)/6. The probes themselves, in the middles of equal parts, have (1 - 1/count^2)/12 of their row's square.
double stretch(double texels, int count, double size) {
  if (count == 1) return 1;
  const double rest = texels * texels - 3 * (size * size - 1);
  return std::sqrt(std::max(rest, 0.0) / (1 - 1.0 / (count * count))) / texels;
}

// Between texels the colors are blended, so that in the middle of each texel the blend has an edge. Of a row that is
// shorter than a texel and lies across an edge, N probes miss 1/N^2 of what one probe misses. Long rows have several
// edges, whose errors differ in sign, so that a few more probes than texels are enough for them. On a floor of maps
// whose texels are about as large as pixels, one probe a texel was measured to leave 1.4 to 4.3 (CIEDE2000, 95th
// percentile), two .4 to 1.4, and four more .2 to 1.1.
int fine_probes(double texels, int more) {
  return std::max(static_cast<int>(std::ceil(std::min(24 * texels, texels + more))), 1);
}

}  // namespace

bool is_between_texels(const TexturePlace& place, double scale, int width, int height) {
  const auto has_no_middle = [&](float at, float across, float down, int count) {
    const double middle = static_cast<double>(at) * count - 0.5;
    const double reach =
        0.5 * scale * (std::abs(static_cast<double>(across)) + std::abs(static_cast<double>(down))) * count;
    return count == 1 || std::floor(middle - reach) == std::floor(middle + reach);
  };
  return has_no_middle(place.u, place.across[0], place.down[0], width) &&
         has_no_middle(place.v, place.across[1], place.down[1], height);
}

FilterProbes filter_probes(const TexturePlace& place, double scale, int width, int height, int levels) {
  if (is_between_texels(place, scale, width, height)) return {};
  const auto texels = [&](const float* step) {
    const double x = scale * step[0] * width, y = scale * step[1] * height;
    return std::sqrt(x * x + y * y);
  };
  const double across = texels(place.across), down = texels(place.down);
  const auto probes = [](double along) { return static_cast<int>(std::clamp(std::ceil(along), 1.0, 1e4)); };
  FilterProbes result;
  double size = 1;  // of a texel of the level
  while (true) {
    result.across = probes(across / size), result.down = probes(down / size);
    if (result.count() <= kMostProbes) {
      for (int more = 5; result.level == 0 && more > 0; --more) {
        const FilterProbes fine{0, fine_probes(across, more), fine_probes(down, more)};
        if (fine.count() > kMostProbes) continue;
        result = fine;
        break;
      }
      result.wide = stretch(across, result.across, size), result.high = stretch(down, result.down, size);
      return result;
    }
    if (result.level == levels) return {levels, 1, 1};
    ++result.level, size *= 2;
  }
}

TexturePlace probe_place(const TexturePlace& place, double scale, const FilterProbes& probes, int number) {
  const double x = scale * probes.wide * ((number % probes.across + 0.5) / probes.across - 0.5),
               y = scale * probes.high * ((number / probes.across + 0.5) / probes.down - 0.5);
  TexturePlace result = place;
  result.u = static_cast<float>(place.u + x * place.across[0] + y * place.down[0]);
  result.v = static_cast<float>(place.v + x * place.across[1] + y * place.down[1]);
  return result;
}

namespace {

// A place along one side of a texture that repeats, the middles of texels at whole numbers, and the probes' steps.
class Side {
 public:
  // A place that is too far away for a number is taken for the corner, as texture_taps() does.
  Side(double at, double step_across, double step_down, const FilterProbes& probes, int texels)
      : texels_(texels), across_(step_across), down_(step_down) {
    const double place = (std::isfinite(at) ? at - texels * std::floor(at / texels) : 0) - 0.5;
    const double wide = 0.5 * (probes.across - 1) * across_, high = 0.5 * (probes.down - 1) * down_;
    const double reach = std::abs(wide) + std::abs(high);
    first_ = static_cast<int>(std::floor(place - reach));
    from_ = place - wide - high - first_;
    window_ = std::min(static_cast<int>(std::floor(place + reach)) + 2 - first_, texels);
    first_ = ((first_ % texels) + texels) % texels;
  }
  int window() const { return window_; }
  // The texel before a probe, from the first one on, and the share of the next.
  std::pair<int, float> before(int across, int down) const {
    const double at = from_ + across * across_ + down * down_;
    const int low = std::max(static_cast<int>(at), 0);
    return {low, static_cast<float>(at - low)};
  }
  int in_window(int at) const { return at < window_ ? at : at % window_; }
  std::uint32_t texel(int at) const { return static_cast<std::uint32_t>((first_ + at) % texels_); }

 private:
  int texels_, first_ = 0, window_ = 1;
  double across_, down_, from_ = 0;
};

void merge_same(std::vector<TexelShare>& texels) {
  std::ranges::sort(texels, {}, &TexelShare::texel);
  std::size_t last = 0;
  for (std::size_t i = 1; i < texels.size(); ++i) {
    if (texels[i].texel == texels[last].texel) {
      texels[last].share += texels[i].share;
    } else {
      texels[++last] = texels[i];
    }
  }
  texels.resize(std::min(last + 1, texels.size()));
}

}  // namespace

// A window that is as wide as the texture holds each texel once, as a narrower one does. Where it is too large to be
// emptied for each footprint, texels that are met again are found by sorting.
std::span<TexelShare> SeenTexels::of(const TexturePlace& place, double scale, const FilterProbes& probes, int width,
                                     int height) {
  const auto step = [&](double stretched, float along, int count, int texels) {
    return count > 1 ? scale * stretched * along / count * texels : 0.0;
  };
  const Side x(static_cast<double>(place.u) * width, step(probes.wide, place.across[0], probes.across, width),
               step(probes.high, place.down[0], probes.down, width), probes, width);
  const Side y((1 - static_cast<double>(place.v)) * height, -step(probes.wide, place.across[1], probes.across, height),
               -step(probes.high, place.down[1], probes.down, height), probes, height);
  seen_.clear();
  constexpr std::size_t kMostSlots = 1 << 16;
  const std::size_t window = static_cast<std::size_t>(x.window()) * static_cast<std::size_t>(y.window());
  const bool sorts = window > kMostSlots;
  slots_.assign(sorts ? 0 : window, 0);
  const auto add = [&](int column, int row, float share) {
    if (share == 0) return;
    const std::uint32_t texel = y.texel(row) * static_cast<std::uint32_t>(width) + x.texel(column);
    if (sorts) {
      seen_.push_back({texel, share});
      return;
    }
    std::uint16_t& slot = slots_[static_cast<std::size_t>(y.in_window(row) * x.window() + x.in_window(column))];
    if (slot == 0) {
      seen_.push_back({texel, 0});
      slot = static_cast<std::uint16_t>(seen_.size());
    }
    seen_[slot - 1U].share += share;
  };
  const float each = 1.0F / static_cast<float>(probes.count());
  for (int j = 0; j < probes.down; ++j) {
    for (int i = 0; i < probes.across; ++i) {
      const auto [column, s] = x.before(i, j);
      const auto [row, t] = y.before(i, j);
      const float lower = each * t, upper = each - lower;
      add(column, row, (1 - s) * upper), add(column + 1, row, s * upper);
      add(column, row + 1, (1 - s) * lower), add(column + 1, row + 1, s * lower);
    }
  }
  if (sorts) merge_same(seen_);
  return seen_;
}

}  // namespace goniochrome::render
