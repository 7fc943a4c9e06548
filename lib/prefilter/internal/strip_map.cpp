#include "prefilter/internal/strip_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "base/angles.h"
#include "base/parallel.h"
#include "prefilter/internal/lobe_rows.h"

namespace goniochrome::prefilter {

void Strips::add(int row, int column, const float* weights, std::size_t columns) {
  for (std::size_t begin = 0; begin < columns; begin += rows::kStrip) {
    const std::size_t at = rows::kStrip * columns_.size(), count = std::min(columns - begin, rows::kStrip);
    if (at + rows::kStrip > forward_.size())
      forward_.resize(2 * (at + rows::kStrip)), backward_.resize(2 * (at + rows::kStrip));
    row_starts_.push_back(row * stride_), columns_.push_back(column + static_cast<int>(begin));
    float *const forward = &forward_[at], *const end = forward + rows::kStrip;
    std::fill(std::copy_n(weights + begin, count, forward), end, 0.0F);
    std::reverse_copy(forward, end, &backward_[at]);
  }
}

StripMap::StripMap(const envmap::Environment& env, const envmap::Clip& clip)
    : width_(env.width()),
      height_(env.height()),
      stride_(env.width() + static_cast<int>(rows::kStrip)),
      rgb_(3 * static_cast<std::size_t>(stride_) * static_cast<std::size_t>(env.height())) {
  const std::size_t stride = static_cast<std::size_t>(stride_);
  parallel_for(static_cast<std::size_t>(height_), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row)
      for (std::size_t column = 0; column < stride; ++column) {
        const std::array<float, 3> left =
            clip.left_of(env.radiance(static_cast<int>(column) % width_, static_cast<int>(row)));
        std::copy(left.begin(), left.end(), &rgb_[3 * (row * stride + column)]);
      }
  });
}

std::vector<Vec3> StripMap::sums(const std::vector<Vec3>& directions, const Weigh& weigh) const {
  const std::vector<Orbit> orbits = orbits_of(directions);
  std::vector<Vec3> result(directions.size());
  parallel_for(orbits.size(), 16, [&](std::size_t begin, std::size_t end) {
    Strips strips(stride_);
    std::vector<int> at;
    for (std::size_t i = begin; i < end; ++i) {
      strips.clear();
      weigh(orbits[i].seat, strips);
      for (const Member& member : orbits[i].members) result[member.index] = sum_for(member, strips, at);
    }
  });
  return result;
}

// Step 1: a key of every direction, which is its height to 1e-11 and its place within its column to 1e-8, each from the
// nearer side. Step 2: directions of one key are an orbit. The orbits follow each other as their first directions do,
// so that neighbors find the texels in the cache.
std::vector<StripMap::Orbit> StripMap::orbits_of(const std::vector<Vec3>& directions) const {
  struct Keyed {
    std::uint64_t key;
    std::size_t index;
  };
  constexpr int kPlaceBits = 27;
  constexpr double kHeights = 1ULL << 36, kPlaces = 1ULL << kPlaceBits, kBetween = 0.37;  // no round number at a limit
  const auto column_of = [&](const Vec3& d) { return (0.5 - std::atan2(d.x, d.z) / (2 * kPi)) * width_; };
  std::vector<Keyed> keyed(directions.size());
  for (std::size_t i = 0; i < directions.size(); ++i) {
    const double column = column_of(directions[i]), place = column - std::floor(column);
    const auto height = static_cast<std::uint64_t>(std::fabs(directions[i].y) * kHeights + kBetween);
    const auto folded = static_cast<std::uint64_t>(std::min(place, 1 - place) * kPlaces + kBetween);
    keyed[i] = {height << kPlaceBits | folded, i};
  }
  std::sort(keyed.begin(), keyed.end(),
            [](const Keyed& a, const Keyed& b) { return a.key != b.key ? a.key < b.key : a.index < b.index; });
  std::vector<Orbit> orbits;
  for (std::size_t i = 0; i < keyed.size(); ++i) {
    const Vec3& d = directions[keyed[i].index];
    const double column = column_of(d), whole = std::floor(column), place = column - whole;
    if (i == 0 || keyed[i].key != keyed[i - 1].key) {
      const double folded = std::min(place, 1 - place), longitude = 2 * kPi * (0.5 - folded / width_);
      const double across = std::hypot(d.x, d.z);
      orbits.push_back({{{across * std::sin(longitude), std::fabs(d.y), across * std::cos(longitude)}, folded}, {}});
    }
    orbits.back().members.push_back({keyed[i].index, d.y<0, place> 0.5, static_cast<int>(whole) % width_});
  }
  std::sort(orbits.begin(), orbits.end(),
            [](const Orbit& a, const Orbit& b) { return a.members.front().index < b.members.front().index; });
  return orbits;
}

// Column j of the seat is column shift + j of the member, or shift - j where the columns run the other way. The loop
// has no branches, so that compilers take several strips at a time.
Vec3 StripMap::sum_for(const Member& member, const Strips& strips, std::vector<int>& at) const {
  const int along = member.reversed ? -1 : 1, down = member.below ? -1 : 1;
  const int first_start = member.below ? (height_ - 1) * stride_ : 0;
  int first_column = member.reversed ? member.shift - static_cast<int>(rows::kStrip) + 1 : member.shift;
  while (first_column < 0) first_column += width_;
  const std::size_t count = strips.columns_.size();
  at.resize(count);
  const int *const starts = strips.row_starts_.data(), *const columns = strips.columns_.data();
  int* const to = at.data();
  for (std::size_t i = 0; i < count; ++i) {
    int column = first_column + along * columns[i];
    column += column < 0 ? width_ : 0;
    column -= column >= width_ ? width_ : 0;
    to[i] = first_start + down * starts[i] + column;
  }
  double total[3] = {0, 0, 0};
  rows::add_strips(rgb_.data(), at.data(), (member.reversed ? strips.backward_ : strips.forward_).data(), at.size(),
                   total);
  return {total[0], total[1], total[2]};
}

}  // namespace goniochrome::prefilter
