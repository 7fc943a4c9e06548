#include "cloud.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "base/angles.h"
#include "base/file.h"
#include "base/text.h"
#include "report/plot.h"

namespace goniochrome::tool {

namespace {

// The sRGB colors of L* 60 and chroma 45 at the hues 15, 45, ... 345 deg, and a gray for chromas below kGrayChroma.
constexpr std::array kHues = {"#db707e", "#d2795a", "#b98743", "#959541", "#689e56", "#24a37b",
                              "#00a5a4", "#00a2c8", "#009add", "#728edd", "#ad7ec9", "#d072a6"};
constexpr const char *kGray = "#999999", *kInk = "#000000", *kMatch = "#8b0000";
constexpr double kGrayChroma = 5;

std::size_t group_of(const color::Lab& lab) {
  if (color::chroma(lab) < kGrayChroma) return kHues.size();
  return static_cast<std::size_t>(color::hue_deg(lab) / 30) % kHues.size();
}

// The colors of a library at a geometry, in the order of its trees.
std::vector<color::Lab> colors_at(const library::LibraryIndex& index, const paint::Geometry& geometry) {
  std::vector<color::Lab> colors;
  for (const library::LibrarySection& section : index.sections()) {
    const auto found = std::ranges::find(section.geometries, geometry);
    if (found == section.geometries.end()) continue;
    const auto channel = 3 * static_cast<std::size_t>(found - section.geometries.begin());
    for (std::size_t i = 0; i < section.tree.size; ++i) {
      const double* block = section.tree.block(i / library::kLeafSize) + i % library::kLeafSize;
      const auto value = [&](std::size_t c) { return block[(channel + c) * library::kLeafSize]; };
      colors.push_back({value(0), value(1), value(2)});
    }
  }
  return colors;
}

}  // namespace

// The place of a color in one projection.
struct Projection {
  const char *title, *x_label, *y_label;
  double (*x)(const color::Lab&);
  double (*y)(const color::Lab&);

  void add(const color::Lab& lab, report::Series& series) const {
    series.x.push_back(x(lab)), series.y.push_back(y(lab));
  }
  // A line of its own.
  void add_path(const std::vector<color::Lab>& path, report::Series& lines) const {
    for (const color::Lab& lab : path) add(lab, lines);
    lines.x.push_back(std::nan("")), lines.y.push_back(std::nan(""));
  }
};

namespace {

constexpr std::array kProjections = {Projection{"from above", "a*", "b*", [](const color::Lab& c) { return c.a; },
                                                [](const color::Lab& c) { return c.b; }},
                                     Projection{"from the side", "a*", "L*", [](const color::Lab& c) { return c.a; },
                                                [](const color::Lab& c) { return c.L; }}};

// The points of a library, each in the color of its hue.
void add_library(const std::vector<color::Lab>& colors, std::size_t stride, const Projection& projection,
                 report::Plot& plot) {
  std::vector<report::Series> groups(kHues.size() + 1);
  for (std::size_t i = 0; i < colors.size(); i += stride) projection.add(colors[i], groups[group_of(colors[i])]);
  for (std::size_t g = 0; g < groups.size(); ++g) {
    groups[g].style = report::Series::Style::kPoints;
    groups[g].color = g < kHues.size() ? kHues[g] : kGray;
    plot.series.push_back(std::move(groups[g]));
  }
}

// The geometries of rows: the first, the middle or usual one, and the last of those from face to flop.
std::vector<paint::Geometry> rows_of(const std::vector<paint::Geometry>& geometries) {
  const paint::Geometry usual{.aspecular_deg = 45};
  const bool has_usual = std::ranges::find(geometries, usual) != geometries.end();
  std::vector<paint::Geometry> rows;
  for (const paint::Geometry& geometry :
       {geometries.front(), has_usual ? usual : geometries[geometries.size() / 2], geometries.back()})
    if (std::ranges::find(rows, geometry) == rows.end()) rows.push_back(geometry);
  return rows;
}

}  // namespace

void Cloud::note(const Finding& finding) {
  if (finding.no_match()) return;
  const library::SearchPlan& plan = finding.plan;
  std::vector<std::size_t> order(plan.geometries.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return paint::aspecular_angle_deg(plan.geometries[i]); });
  Query query;
  for (const std::size_t i : order)
    query.geometries.push_back(plan.geometries[i]), query.lab.push_back(plan.terms[i].lab);
  for (const Neighbor& neighbor : finding.neighbors) {
    std::vector<color::Lab>& match = query.matches.emplace_back();
    for (const std::size_t i : order) match.push_back(neighbor.match.lab[i]);
  }
  if (rows_.empty()) rows_ = rows_of(query.geometries);
  if (++noted_ <= kMostQueries) queries_.push_back(std::move(query));
}

report::Plot Cloud::plot(const Projection& projection, const paint::Geometry& geometry,
                         const library::LibraryIndex& index) const {
  const std::vector<color::Lab> colors = colors_at(index, geometry);
  const std::size_t most = kMostPoints / rows_.size();
  const std::size_t stride = std::max<std::size_t>((colors.size() + most - 1) / most, 1);
  report::Plot plot{.title = fmt::format("{}: {} of {} paints at {}, {} of {} queries", projection.title,
                                         (colors.size() + stride - 1) / stride, colors.size(),
                                         paint::geometry_name(geometry), queries_.size(), noted_),
                    .x = {.label = projection.x_label},
                    .y = {.label = projection.y_label},
                    .width = 620,
                    .height = 560};
  add_library(colors, stride, projection, plot);
  using Style = report::Series::Style;
  report::Series travel{.label = "design, face to flop", .color = kInk}, rings{.style = Style::kRings, .color = kInk},
      matches{.label = "matches, face to flop", .style = Style::kDashed, .color = kMatch},
      nearest{.style = Style::kRings, .color = kMatch}, gap{.color = kMatch};
  for (const Query& query : queries_) {
    for (const std::vector<color::Lab>& match : query.matches) projection.add_path(match, matches);
    projection.add_path(query.lab, travel);
    const auto found = std::ranges::find(query.geometries, geometry);
    if (found == query.geometries.end()) continue;
    const auto place = static_cast<std::size_t>(found - query.geometries.begin());
    projection.add(query.lab[place], rings), projection.add(query.matches.front()[place], nearest);
    projection.add_path({query.lab[place], query.matches.front()[place]}, gap);
  }
  for (report::Series* series : {&matches, &gap, &nearest, &travel, &rings}) plot.series.push_back(std::move(*series));
  return plot;
}

Result<void> Cloud::write(const std::string& path, const library::LibraryIndex& index) const {
  if (rows_.empty()) return input_error("{}: no query has a match: there is nothing to draw", path);
  std::vector<report::Plot> plots;
  for (const paint::Geometry& geometry : rows_)
    for (const Projection& projection : kProjections) plots.push_back(plot(projection, geometry, index));
  return write_file(path, report::svg(plots, 2));
}

}  // namespace goniochrome::tool
