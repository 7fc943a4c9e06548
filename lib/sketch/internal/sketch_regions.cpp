#include "sketch/internal/sketch_regions.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/parallel.h"
#include "paint/curve.h"

namespace goniochrome::sketch {

namespace {

constexpr double kRegionErrors = 4;  // standard errors; what regions share counts as much as what they do not
constexpr double kHalfErrors = 2;    // of halves by height, which share less

// The numbers from 0.
std::vector<std::size_t> all_of(std::size_t count) {
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), 0);
  return order;
}

}  // namespace

// Halves by their column, each of which is quartered by its rows.
Regions regions_of_places(const std::vector<std::uint32_t>& places, int width) {
  constexpr std::size_t kColumns = 2, kRows = 4;
  std::vector<std::size_t> order = all_of(places.size());
  const auto part = [&](std::size_t from, std::size_t to) {
    return std::ranges::subrange(order.begin() + static_cast<std::ptrdiff_t>(from),
                                 order.begin() + static_cast<std::ptrdiff_t>(to));
  };
  const auto column = [&](std::size_t i) { return static_cast<int>(places[i]) % width; };
  const auto row = [&](std::size_t i) { return static_cast<int>(places[i]) / width; };
  std::ranges::stable_sort(order, {}, column);
  Regions regions;
  for (std::size_t c = 0; c < kColumns; ++c) {
    const std::size_t first = c * order.size() / kColumns, count = (c + 1) * order.size() / kColumns - first;
    std::ranges::stable_sort(part(first, first + count), {}, row);
    for (std::size_t r = 0; r < kRows; ++r) {
      const auto region = part(first + r * count / kRows, first + (r + 1) * count / kRows);
      regions.emplace_back(region.begin(), region.end());
    }
  }
  return regions;
}

Regions halves_by_height(const std::vector<double>& up) {
  std::vector<std::size_t> order = all_of(up.size());
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return up[i]; });
  const auto middle = order.begin() + static_cast<std::ptrdiff_t>(order.size() / 2);
  return {{order.begin(), middle}, {middle, order.end()}};
}

std::vector<PaintWeights> without_each_region(const LobeSearch& search, const FoundPaint& found, const Regions& regions,
                                              LobeSearch::Gloss gloss) {
  std::vector<PaintWeights> without(regions.size());
  parallel_for(without.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t left_out = begin; left_out < end; ++left_out) {
      std::vector<std::size_t> rest;
      for (std::size_t r = 0; r < regions.size(); ++r)
        if (r != left_out) rest.insert(rest.end(), regions[r].begin(), regions[r].end());
      std::ranges::sort(rest);
      without[left_out] = search.in_part(found, rest, gloss).weights;
    }
  });
  return without;
}

std::vector<double> apart_by_regions(const formats::Basis& basis, const PaintWeights& found,
                                     const std::vector<PaintWeights>& without, double coat_index) {
  std::vector<double> apart;
  const auto count = static_cast<double>(without.size());
  for (const double angle_deg : paint::kExportAngles_deg) {
    const color::Lab own = instrument_lab(basis, found, coat_index, angle_deg);
    double squares = 0;
    for (const PaintWeights& other : without) {
      const double one = color::delta_e_2000(own, instrument_lab(basis, other, coat_index, angle_deg));
      squares += one * one;
    }
    apart.push_back(std::sqrt((count - 1) / count * squares));
  }
  return apart;
}

std::vector<double> told_by_regions(const LobeSearch& search, const FoundPaint& found, const formats::Basis& basis,
                                    double coat_index, const Regions& places, const Regions& halves) {
  const auto apart = [&](const Regions& regions, LobeSearch::Gloss gloss) {
    return apart_by_regions(basis, found.weights, without_each_region(search, found, regions, gloss), coat_index);
  };
  std::vector<double> told = apart(places, LobeSearch::Gloss::kFound);
  const std::vector<double> by_halves = apart(halves, LobeSearch::Gloss::kAnew);
  for (std::size_t i = 0; i < told.size(); ++i) told[i] = std::max(kRegionErrors * told[i], kHalfErrors * by_halves[i]);
  return told;
}

}  // namespace goniochrome::sketch
