#include "library/search.h"

#include <algorithm>
#include <bit>
#include <numeric>
#include <string>
#include <tuple>

#include "base/parallel.h"
#include "base/text.h"

namespace goniochrome::library {

namespace {

std::string names_of(const std::vector<paint::Geometry>& geometries) {
  return joined(geometries, ",", paint::geometry_name);
}

std::string condition_name(const color::ViewingCondition& condition) {
  return fmt::format("{}/{}", condition.illuminant, condition.observer_deg);
}

bool contains(const std::vector<paint::Geometry>& set, const paint::Geometry& geometry) {
  return std::ranges::find(set, geometry) != set.end();
}

bool contains_all(const std::vector<paint::Geometry>& set, const std::vector<paint::Geometry>& wanted) {
  return std::ranges::all_of(wanted, [&](const paint::Geometry& geometry) { return contains(set, geometry); });
}

}  // namespace

LibrarySearch::LibrarySearch(const LibraryIndex& index, LibrarySearchOptions options)
    : index_(index), options_(std::move(options)) {
  std::ranges::sort(options_.geometries, geometry_order);
  const auto passes = [&](std::uint32_t paint) {
    return std::ranges::all_of(
               options_.ranges,
               [&](const paint::MetricRange& range) { return range.contains(index_.metric(paint, *range.column)); }) &&
           (options_.classes.empty() ||
            std::ranges::find(options_.classes, index_.paint_class(paint)) != options_.classes.end());
  };
  for (const LibrarySection& section : index_.sections()) {
    const TreeView& tree = section.tree;
    if (options_.ranges.empty() && options_.classes.empty()) {
      passing_.push_back(tree.size);
      continue;
    }
    std::vector<LeafMask>& masks = masks_.emplace_back(tree.leaves());
    parallel_for(tree.leaves(), 256, [&](std::size_t begin, std::size_t end) {
      for (std::size_t leaf = begin; leaf < end; ++leaf)
        for (std::size_t lane = 0; lane < kLeafSize && leaf * kLeafSize + lane < tree.size; ++lane)
          if (passes(tree.labels[leaf * kLeafSize + lane])) masks[leaf] |= LeafMask{1} << lane;
    });
    std::size_t& passing = passing_.emplace_back(0);
    for (const LeafMask mask : masks) passing += static_cast<std::size_t>(std::popcount(mask));
  }
}

// The candidates are the geometries that the query shares with one section, and those that several candidates have in
// common.
std::vector<paint::Geometry> LibrarySearch::shared_geometries(const std::vector<paint::LabReading>& rows) const {
  constexpr std::size_t kEnough = 3, kMostCandidates = 64;
  std::vector<std::vector<paint::Geometry>> candidates;
  const auto add = [&](std::vector<paint::Geometry> set) {
    if (candidates.size() < kMostCandidates && std::ranges::find(candidates, set) == candidates.end())
      candidates.push_back(std::move(set));
  };
  for (const LibrarySection& section : index_.sections()) {
    std::vector<paint::Geometry> shared;
    for (const paint::LabReading& row : rows)
      if (contains(section.geometries, row.geometry)) shared.push_back(row.geometry);
    for (std::size_t i = candidates.size(); i-- > 0;) {
      std::vector<paint::Geometry> common;
      std::ranges::copy_if(candidates[i], std::back_inserter(common),
                           [&](const paint::Geometry& geometry) { return contains(shared, geometry); });
      add(std::move(common));
    }
    add(std::move(shared));
  }
  std::vector<paint::Geometry> best;
  std::tuple<std::size_t, std::size_t, std::size_t> most = {0, 0, 0};
  for (const std::vector<paint::Geometry>& candidate : candidates) {
    std::size_t paints = 0;
    for (const LibrarySection& section : index_.sections())
      if (contains_all(section.geometries, candidate)) paints += section.tree.size;
    const std::tuple value(std::min(candidate.size(), kEnough), paints, candidate.size());
    if (value > most) most = value, best = candidate;
  }
  return best;
}

Result<SearchPlan> LibrarySearch::plan(const paint::Paint& query) const {
  const std::vector<paint::LabReading> rows = comparable_rows(query);
  if (rows.empty()) return input_error("it has no color: give it a measurement or an appearance");
  std::vector<paint::Geometry> own;
  for (const paint::LabReading& row : rows) own.push_back(row.geometry);

  SearchPlan plan;
  plan.geometries = options_.geometries.empty() ? shared_geometries(rows) : options_.geometries;
  if (plan.geometries.empty()) {
    std::vector<paint::Geometry> theirs;
    for (const LibrarySection& section : index_.sections())
      std::ranges::copy_if(section.geometries, std::back_inserter(theirs),
                           [&](const paint::Geometry& geometry) { return !contains(theirs, geometry); });
    std::ranges::sort(theirs, geometry_order);
    return input_error("it has no geometry in common with the library: it was measured at {}, the library at {}",
                       names_of(own), theirs.empty() ? "none" : names_of(theirs));
  }
  for (const paint::Geometry& geometry : plan.geometries) {
    const auto row = std::ranges::find(rows, geometry, &paint::LabReading::geometry);
    if (row == rows.end())
      return input_error("it has no color at {}: it was measured at {}", paint::geometry_name(geometry), names_of(own));
    const double aspecular_deg = paint::aspecular_angle_deg(geometry);
    if (aspecular_deg == 0 && options_.metric.kind == color::DifferenceFormula::Kind::kDin6175)
      return input_error("it is compared at {}, where DIN 6175 has no difference: leave that geometry out",
                         paint::geometry_name(geometry));
    const auto weight = std::ranges::find(options_.weights, geometry, &std::pair<paint::Geometry, double>::first);
    plan.terms.push_back({0, row->lab, weight == options_.weights.end() ? 1 : weight->second, aspecular_deg});
  }
  if (std::ranges::all_of(plan.terms, [](const SearchTerm& term) { return term.weight == 0; }))
    return input_error("every geometry it is compared at, {}, has weight 0", names_of(plan.geometries));
  std::size_t colored = 0, compared = 0;
  for (std::size_t i = 0; i < index_.sections().size(); ++i) {
    const LibrarySection& section = index_.sections()[i];
    colored += section.tree.size;
    if (!contains_all(section.geometries, plan.geometries)) continue;
    plan.sections.push_back(i);
    compared += section.tree.size;
    if (section.condition == paint::condition_of(query)) continue;
    if (!options_.mix_conditions)
      return input_error(
          "its Lab values are for {}, the library has some for {}: measure or convert one of them, or compare the "
          "numbers as they are with colorsnap --mix-observers",
          condition_name(paint::condition_of(query)), condition_name(section.condition));
    plan.mixed = section.condition;
  }
  plan.left_out = colored - compared;
  if (plan.sections.empty())
    return input_error("no paint of the library was measured at all of {}", names_of(plan.geometries));
  return plan;
}

std::size_t LibrarySearch::candidates() const {
  return std::accumulate(passing_.begin(), passing_.end(), std::size_t{0});
}

SearchMethod LibrarySearch::method(std::size_t section) const {
  return options_.method.value_or(faster_method(index_.sections()[section].tree.size, passing_[section]));
}

std::vector<LibraryMatch> LibrarySearch::nearest(const SearchPlan& plan, std::size_t count) const {
  std::vector<LibraryMatch> matches;
  double limit = NearestMatches::kNoLimit;
  for (const std::size_t i : plan.sections) {
    const LibrarySection& section = index_.sections()[i];
    std::vector<SearchTerm> terms = plan.terms;
    for (std::size_t t = 0; t < terms.size(); ++t)
      terms[t].geometry = static_cast<std::size_t>(std::ranges::find(section.geometries, plan.geometries[t]) -
                                                   section.geometries.begin());
    NearestMatches best(count, limit);
    find_nearest(section.tree, terms, options_.metric, method(i),
                 masks_.empty() ? std::span<const LeafMask>() : masks_[i], best);
    for (const Match& match : best.list()) {
      LibraryMatch& found = matches.emplace_back(match.label, match.distance);
      const double* block = section.tree.block(match.place / kLeafSize) + match.place % kLeafSize;
      for (const SearchTerm& term : terms) {
        const double* color = block + 3 * term.geometry * kLeafSize;
        found.lab.push_back({color[0], color[kLeafSize], color[2 * kLeafSize]});
      }
    }
    std::ranges::sort(matches, {}, [](const LibraryMatch& m) { return std::pair(m.distance, m.paint); });
    if (matches.size() >= count) {
      matches.resize(count);
      limit = matches.back().distance;
    }
  }
  return matches;
}

}  // namespace goniochrome::library
