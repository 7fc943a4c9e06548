#include "cloud.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/angles.h"
#include "base/file.h"
#include "base/text.h"
#include "report/plot.h"

namespace goniochrome::tool {

namespace {

// The sRGB colors of L* 60 and chroma 45 at the hues 15, 45, ... 345 deg, and a gray for chromas below kGrayChroma.
constexpr std::array kHues = {"#db707e", "#d2795a", "#b98743", "#959541", "#689e56", "#24a37b",
                              "#00a5a4", "#00a2c8", "#009add", "#728edd", "#ad7ec9", "#d072a6"};
constexpr const char* kGray = "#999999";
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

// What one projection shows of a color.
struct Projection {
  const char *title, *x_label, *y_label;
  double (*x)(const color::Lab&);
  double (*y)(const color::Lab&);
};

}  // namespace

void Cloud::note(const Finding& finding) {
  if (finding.no_match()) return;
  const auto& geometries = finding.plan.geometries;
  if (!geometry_) {
    const paint::Geometry usual{.aspecular_deg = 45};
    geometry_ = std::ranges::find(geometries, usual) != geometries.end() ? usual : geometries[geometries.size() / 2];
  }
  const auto found = std::ranges::find(geometries, *geometry_);
  if (found == geometries.end() || ++noted_ > kMostQueries) return;
  const auto place = static_cast<std::size_t>(found - geometries.begin());
  queries_.push_back({finding.plan.terms[place].lab, finding.neighbors.front().match.lab[place]});
}

Result<void> Cloud::write(const std::string& path, const library::LibraryIndex& index) const {
  if (!geometry_) return input_error("{}: no query has a match: there is nothing to draw", path);
  const std::vector<color::Lab> colors = colors_at(index, *geometry_);
  const std::size_t stride = (colors.size() + kMostPoints - 1) / kMostPoints;
  const std::string what = fmt::format("{} of {} paints at {}, {} of {} queries",
                                       (colors.size() + stride - 1) / std::max<std::size_t>(stride, 1), colors.size(),
                                       paint::geometry_name(*geometry_), queries_.size(), noted_);
  const std::array projections = {Projection{"from above", "a*", "b*", [](const color::Lab& c) { return c.a; },
                                             [](const color::Lab& c) { return c.b; }},
                                  Projection{"from the side", "a*", "L*", [](const color::Lab& c) { return c.a; },
                                             [](const color::Lab& c) { return c.L; }}};
  std::vector<report::Plot> plots;
  for (const Projection& projection : projections) {
    report::Plot plot{.title = fmt::format("{}: {}", projection.title, what),
                      .x = {.label = projection.x_label},
                      .y = {.label = projection.y_label},
                      .width = 620,
                      .height = 560};
    std::vector<report::Series> groups(kHues.size() + 1);
    for (std::size_t i = 0; i < colors.size(); i += stride) {
      report::Series& group = groups[group_of(colors[i])];
      group.x.push_back(projection.x(colors[i])), group.y.push_back(projection.y(colors[i]));
    }
    for (std::size_t g = 0; g < groups.size(); ++g) {
      groups[g].style = report::Series::Style::kPoints;
      groups[g].color = g < kHues.size() ? kHues[g] : kGray;
      plot.series.push_back(std::move(groups[g]));
    }
    report::Series lines{.color = "#000000"}, rings{.style = report::Series::Style::kRings, .color = "#000000"};
    for (const Query& query : queries_) {
      for (const color::Lab& end : {query.lab, query.nearest})
        lines.x.push_back(projection.x(end)), lines.y.push_back(projection.y(end));
      lines.x.push_back(std::nan("")), lines.y.push_back(std::nan(""));  // the next line stands apart
      rings.x.push_back(projection.x(query.lab)), rings.y.push_back(projection.y(query.lab));
    }
    plot.series.push_back(std::move(lines)), plot.series.push_back(std::move(rings));
    plots.push_back(std::move(plot));
  }
  return write_file(path, report::svg(plots, 2));
}

}  // namespace goniochrome::tool
