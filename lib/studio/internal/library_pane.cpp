#include "studio/internal/library_pane.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <set>
#include <string>
#include <utility>

#include "display/paint_view.h"
#include "paint/metrics.h"
#include "studio/internal/describe.h"

namespace goniochrome::studio {

namespace {

char lower(char c) {
  return static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
}

// True if `text` holds `part`, which is in lower case; letters beyond ASCII are compared as they are.
bool holds(std::string_view text, std::string_view part) {
  return std::ranges::search(text, part, [](char x, char y) { return lower(x) == y; }).begin() != text.end() ||
         part.empty();
}

color::Lab lab_at(const library::TreeView& tree, std::size_t place, std::size_t geometry) {
  const double* values = tree.block(place / library::kLeafSize) + place % library::kLeafSize;
  const auto channel = [&](std::size_t c) { return values[(3 * geometry + c) * library::kLeafSize]; };
  return {channel(0), channel(1), channel(2)};
}

struct FilterRange {
  const paint::MetricColumn* metric = nullptr;
  double low = -INFINITY, high = INFINITY;
};

const paint::MetricColumn* indexed_metric(std::string_view name) {
  const auto all = paint::metric_columns_without_fit();
  const auto found = std::ranges::find_if(all, [&](const paint::MetricColumn& column) { return column.name == name; });
  return found == all.end() ? nullptr : &*found;
}

std::vector<FilterRange> ranges_of(JsonReader& request) {
  std::vector<FilterRange> ranges;
  for (const Json& element : request.list("ranges")) {
    JsonReader of(element);
    FilterRange range{indexed_metric(of.text("metric"))};
    range.low = of.number("low", range.low), range.high = of.number("high", range.high);
    if (!of.status().ok() || range.metric == nullptr) request.fail("metrics with a low and a high", "ranges");
    ranges.push_back(range);
  }
  return ranges;
}

}  // namespace

LibraryPane::LibraryPane(const library::LibraryIndex& index)
    : index_(index), section_of_(index.size()), place_of_(index.size(), kNowhere) {
  for (std::size_t s = 0; s < index.sections().size(); ++s) {
    const library::TreeView& tree = index.sections()[s].tree;
    for (std::size_t place = 0; place < tree.size; ++place) {
      section_of_[tree.labels[place]] = static_cast<std::uint16_t>(s);
      place_of_[tree.labels[place]] = static_cast<std::uint32_t>(place);
    }
  }
}

Result<Json> LibraryPane::filter(JsonReader& request) {
  std::string part = request.text("text", "");
  std::ranges::transform(part, part.begin(), lower);
  std::vector<bool> classes(static_cast<std::size_t>(paint::PaintClass::kInterference) + 1,
                            request.list("classes").empty());
  for (const Json& name : request.list("classes"))
    if (const auto known = paint::paint_class_of(name.is_string() ? name.get<std::string>() : ""))
      classes[static_cast<std::size_t>(*known)] = true;
  const std::vector<FilterRange> ranges = ranges_of(request);
  const paint::MetricColumn* order = nullptr;
  if (request.has("order")) {
    order = indexed_metric(request.text("order"));
    if (order == nullptr) request.fail("a metric", "order");
  }
  GONIO_TRY(request.status());
  list_.clear();
  for (std::size_t i = 0; i < index_.size(); ++i) {
    if (!classes[static_cast<std::size_t>(index_.paint_class(i))]) continue;
    const bool within = std::ranges::all_of(ranges, [&](const FilterRange& range) {
      const double value = index_.metric(i, *range.metric);
      return value >= range.low && value <= range.high;
    });
    if (within && (holds(index_.name(i), part) || holds(index_.code(i), part)))
      list_.push_back(static_cast<std::uint32_t>(i));
  }
  if (order != nullptr) {
    // Paints to which the metric does not apply come last.
    const auto value = [&](std::uint32_t i) {
      const double of = index_.metric(i, *order);
      return std::isnan(of) ? INFINITY : of;
    };
    std::ranges::stable_sort(list_, {}, value);
  }
  return Json{{"count", list_.size()}};
}

Result<Json> LibraryPane::rows(JsonReader& request) const {
  const display::Screen screen = screen_of(request);
  Json list = Json::array();
  for (const double number : request.numbers("places")) {
    if (!(number >= 0 && number < static_cast<double>(index_.size()))) return input_error("there is no such paint");
    const auto i = static_cast<std::size_t>(number);
    Json colors = Json::array();
    if (place_of_[i] != kNowhere) {
      const library::LibrarySection& section = index_.sections()[section_of_[i]];
      std::vector<std::pair<double, std::size_t>> in_plane;
      for (std::size_t g = 0; g < section.geometries.size(); ++g)
        if (!section.geometries[g].out_of_plane)
          in_plane.emplace_back(paint::aspecular_angle_deg(section.geometries[g]), g);
      std::ranges::sort(in_plane);
      for (const auto& [angle, g] : in_plane)
        colors.push_back(css_color(lab_at(section.tree, place_of_[i], g), section.condition, screen));
    }
    list.push_back({{"name", index_.name(i)},
                    {"code", index_.code(i)},
                    {"class", paint::paint_class_name(index_.paint_class(i))},
                    {"colors", std::move(colors)}});
  }
  GONIO_TRY(request.status());
  return Json{{"list", std::move(list)}};
}

Result<Json> LibraryPane::cloud(JsonReader& request) {
  GONIO_ASSIGN(const paint::Geometry geometry, paint::parse_geometry(request.text("geometry")));
  const display::Screen screen = screen_of(request);
  GONIO_TRY(request.status());
  cloud_.clear(), cloud_colors_.clear(), cloud_paints_.clear();
  for (const library::LibrarySection& section : index_.sections()) {
    const auto found = std::ranges::find(section.geometries, geometry);
    if (found == section.geometries.end()) continue;
    const auto g = static_cast<std::size_t>(found - section.geometries.begin());
    const color::Xyz white = screen_white(section.condition);
    for (std::size_t place = 0; place < section.tree.size; ++place) {
      const color::Lab lab = lab_at(section.tree, place, g);
      cloud_.push_back({static_cast<float>(lab.L), static_cast<float>(lab.a), static_cast<float>(lab.b)});
      const std::array<int, 3> rgb = display::screen_color(lab, white, screen);
      cloud_colors_.push_back(static_cast<std::uint32_t>(rgb[0]) | static_cast<std::uint32_t>(rgb[1]) << 8 |
                              static_cast<std::uint32_t>(rgb[2]) << 16 | 0xff000000U);
      cloud_paints_.push_back(section.tree.labels[place]);
    }
  }
  return Json{{"count", cloud_.size()}};
}

Json LibraryPane::geometries() const {
  std::set<std::pair<double, std::string>> all;
  for (const library::LibrarySection& section : index_.sections())
    for (const paint::Geometry& geometry : section.geometries)
      if (!geometry.out_of_plane) all.insert({paint::aspecular_angle_deg(geometry), paint::geometry_name(geometry)});
  Json list = Json::array();
  for (const auto& [angle, name] : all) list.push_back({{"geometry", name}, {"angle", angle}});
  return list;
}

}  // namespace goniochrome::studio
