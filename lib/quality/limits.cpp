#include "quality/limits.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/csv_records.h"
#include "base/text.h"
#include "paint/edit.h"

namespace goniochrome::quality {

namespace {

constexpr std::string_view kHead = "geometry,quantity,low,high";

constexpr std::array kAngleQuantities = {"dL", "da", "db", "dC", "dH"};
constexpr std::array kWholeQuantities = {"flop_index", "chroma_index", "hue_shift_index", "hue_travel_deg",
                                         "gloss20",    "gloss60",      "gloss85"};

bool is_one_of(const auto& names, std::string_view name) {
  return std::ranges::find(names, name) != names.end();
}

bool is_difference(std::string_view quantity) {
  return quantity == "dE" || (quantity.starts_with("dE_") && color::parse_formula(quantity.substr(3)).ok());
}

Result<void> check_quantity(const Limit& limit) {
  const std::string& name = limit.quantity;
  const bool whole = is_one_of(kWholeQuantities, name), angle = is_one_of(kAngleQuantities, name);
  const auto has_word_behind = [&](std::string_view prefix) {
    return name.starts_with(prefix) && name.size() > prefix.size();
  };
  const bool other = has_word_behind("metamerism_") || has_word_behind("texture:");
  if (!whole && !angle && !other && !is_difference(name))
    return input_error(
        "there is no quantity \"{}\": use dL, da, db, dC, dH, dE, dE_FORMULA, {}, metamerism_ILLUMINANT or "
        "texture:NAME",
        shown(name), joined({kWholeQuantities.begin(), kWholeQuantities.end()}, ", "));
  if (limit.at == kWhole && (angle || is_difference(name) || name.starts_with("metamerism_")))
    return input_error("{} belongs to a geometry: write one, or *, in place of {}", name, kWhole);
  if ((limit.at == kMean || limit.at == kLargest) && !is_difference(name))
    return input_error("{} is for dE alone, and not for {}", limit.at, name);
  if (whole && limit.at != "*" && limit.at != kWhole)
    return input_error("{} belongs to the whole paint: write * for the geometry", name);
  return {};
}

// A cell of a number; nothing where it is empty.
Result<std::optional<double>> bound_in(std::string_view cell, const char* column) {
  if (cell.empty()) return std::optional<double>();
  const auto value = number_in_cell(cell);
  if (!value) return input_error("{} is \"{}\", which is no number", column, shown(cell));
  return value;
}

Result<Limit> limit_in(std::vector<std::string> cells) {
  while (cells.size() > 4 && cells.back().empty()) cells.pop_back();
  if (cells.size() != 4) return input_error("has {} cells: write {}", cells.size(), kHead);
  Limit limit{cells[0], cells[1]};
  if (!is_one_of(std::array{"*", kMean, kLargest, kWhole}, limit.at)) {
    const auto geometry = paint::parse_geometry(limit.at);
    if (geometry.ok())
      limit.at = paint::geometry_name(*geometry);
    else if (!limit.quantity.starts_with("texture:"))
      return input_error("{}", geometry.error().message);
  }
  GONIO_TRY(check_quantity(limit));
  if (limit.quantity.starts_with("dE_")) {
    GONIO_ASSIGN(const color::DifferenceFormula formula, color::parse_formula(limit.quantity.substr(3)));
    limit.quantity = quantity_of(formula);
  }
  GONIO_ASSIGN(limit.low, bound_in(cells[2], "low"));
  GONIO_ASSIGN(limit.high, bound_in(cells[3], "high"));
  if (!limit.low && !limit.high) return input_error("has neither low nor high: give one of them");
  if (limit.low && limit.high && *limit.low > *limit.high)
    return input_error("low is {}, above high, which is {}", shortest(*limit.low), shortest(*limit.high));
  return Result(std::move(limit));
}

// The painter's word for the region of a geometry between mirror direction and flop.
const char* place_of(const paint::Geometry& geometry) {
  const double angle_deg = paint::aspecular_angle_deg(geometry);
  return angle_deg <= 30 ? " near gloss" : angle_deg <= 60 ? " in the face" : " in the flop";
}

// The color to which a hue turns, counterclockwise or clockwise.
const char* hue_word(double hue_deg, bool up) {
  constexpr std::array kUp = {"yellow", "green", "blue", "red"}, kDown = {"red", "yellow", "green", "blue"};
  return (up ? kUp : kDown)[static_cast<std::size_t>(hue_deg / 90) % 4];
}

std::string fault_of(const Deviation& d, const AngleDifference* angle, bool up) {
  const std::string& q = d.quantity;
  if (q == "dL") return up ? "too light" : "too dark";
  if (q == "da") return up ? "too red" : "too green";
  if (q == "db") return up ? "too yellow" : "too blue";
  if (q == "dC") return up ? "too colorful" : "too gray";
  if (q == "dH") return std::string("too ") + hue_word(angle ? color::hue_deg(angle->standard) : 0, up);
  if (q.starts_with("dE")) return up ? "too far off" : "nearer than the limit allows";
  if (q.starts_with("gloss")) return up ? "too glossy" : "too matt";
  if (q.starts_with("metamerism")) return "matches in the light of the readings alone";
  if (q.starts_with("texture:")) return (up ? "too much " : "too little ") + q.substr(8);
  const char* word = q == "flop_index"        ? "flop"
                     : q == "chroma_index"    ? "chroma travel"
                     : q == "hue_shift_index" ? "hue shift"
                     : q == "hue_travel_deg"  ? "hue travel"
                                              : q.c_str();
  return (up ? "too much " : "too little ") + std::string(word);
}

// Two numbers with as few decimals as tell them apart, two at least.
std::pair<std::string, std::string> told_apart(double value, double limit) {
  for (int decimals = 2; decimals < 9; ++decimals) {
    std::string a = fmt::format("{:.{}f}", value, decimals), b = fmt::format("{:.{}f}", limit, decimals);
    if (a == b) continue;
    for (std::string* text : {&a, &b}) {
      text->erase(text->find_last_not_of('0') + 1);
      if (text->ends_with('.')) text->pop_back();
    }
    return {a, b};
  }
  return {shortest(value), shortest(limit)};
}

Excess excess_of(const Deviation& d, const Limit& limit, bool up, const Comparison& comparison) {
  const double bound = up ? *limit.high : *limit.low;
  const auto [value, passed] = told_apart(d.value, bound);
  const auto angle = std::ranges::find_if(
      comparison.angles, [&](const AngleDifference& a) { return paint::geometry_name(a.geometry) == d.at; });
  const AngleDifference* at = angle == comparison.angles.end() ? nullptr : &*angle;
  std::string where = at ? place_of(at->geometry) : "";
  // The largest dE names its angle.
  for (const AngleDifference& a : comparison.angles)
    if (d.at == kLargest && where.empty() && std::ranges::find(a.by_formula, d.value) != a.by_formula.end())
      where = " at " + paint::geometry_name(a.geometry);
  std::string words =
      fmt::format("{}: {} {}, limit {}: {}{}", d.at, d.quantity, value, passed, fault_of(d, at, up), where);
  return {d, up ? std::nullopt : limit.low, up ? limit.high : std::nullopt, std::move(words)};
}

// The words for a quantity that has a limit and no value. Mean and largest name the geometries that they lack.
std::string words_of_missing(const Deviation& d, const Comparison& comparison) {
  const auto spans = [](const Deviation& deviation) { return deviation.at == kMean || deviation.at == kLargest; };
  std::vector<std::string> places;
  for (const Deviation& other : comparison.missing)
    if (other.quantity == d.quantity && !spans(other)) places.push_back(other.at);
  if (!spans(d) || places.empty()) return fmt::format("{}: {} has a limit and was not measured", d.at, d.quantity);
  return fmt::format("{}: {} has a limit, and {} {} not measured", d.at, d.quantity, joined(places, ", "),
                     places.size() == 1 ? "was" : "were");
}

bool concerns(const Limit& limit, const Deviation& d, const std::string& first_formula) {
  if ((limit.quantity == "dE" ? first_formula : limit.quantity) != d.quantity) return false;
  return limit.at == "*" ? d.at != kMean && d.at != kLargest : limit.at == d.at;
}

bool keeps(double value, const Limit& limit) {
  return !(limit.low && !(value >= *limit.low - kLimitSlack)) && !(limit.high && !(value <= *limit.high + kLimitSlack));
}

std::string unescaped(std::string text) {
  for (const auto& [entity, letter] : {std::pair{"&lt;", "<"}, {"&gt;", ">"}, {"&quot;", "\""}, {"&amp;", "&"}})
    for (std::size_t at = 0; (at = text.find(entity, at)) != std::string::npos; at += 1)
      text.replace(at, std::string_view(entity).size(), letter);
  return text;
}

bool is_limits_element(const std::string& element) {
  return is_quality_element(element, "limits");
}

}  // namespace

bool is_quality_element(std::string_view element, std::string_view name) {
  const std::string_view tag = element.substr(0, element.find('>'));
  return tag.find(kQualityNamespace) != std::string_view::npos && tag.find(name) < tag.find(' ');
}

Result<std::vector<Limit>> parse_limits(std::string_view table, const std::string& name) {
  GONIO_ASSIGN(const std::vector<TableRow> rows, table_rows(CsvRecords(name, table), true));
  std::vector<Limit> limits;
  for (const auto& [line, cells] : rows) {
    if (line == rows.front().line) {
      if (lower(joined(cells, ",")) != kHead)
        return input_error("{}:{}: the columns of limits are {}", name, line, kHead);
      continue;
    }
    auto limit = limit_in(cells);
    if (!limit.ok()) return input_error("{}:{}: {}", name, line, limit.error().message);
    limits.push_back(std::move(*limit));
  }
  if (limits.empty()) return input_error("{}: there is no limit in it", name);
  return Result(std::move(limits));
}

std::string limits_table(const std::vector<Limit>& limits) {
  std::string text = std::string(kHead) + "\n";
  const auto cell = [](const std::optional<double>& bound) { return bound ? shortest(*bound) : ""; };
  for (const Limit& limit : limits)
    text += fmt::format("{},{},{},{}\n", limit.at, limit.quantity, cell(limit.low), cell(limit.high));
  return text;
}

Result<std::vector<Limit>> limits_of(const paint::Paint& paint) {
  const auto found = std::ranges::find_if(paint.foreign, is_limits_element);
  if (found == paint.foreign.end()) return std::vector<Limit>();
  const std::size_t begin = found->find('>') + 1, end = found->rfind("</");
  if (end == std::string::npos || end < begin) return input_error("paint \"{}\": its limits are empty", paint.name);
  return parse_limits(unescaped(found->substr(begin, end - begin)), fmt::format("limits of paint \"{}\"", paint.name));
}

paint::Paint with_limits(paint::Paint paint, const std::vector<Limit>& limits) {
  std::erase_if(paint.foreign, is_limits_element);
  paint.foreign.push_back(
      fmt::format("<limits xmlns=\"{}\">\n{}</limits>", kQualityNamespace, xml_escaped(limits_table(limits), "")));
  return paint;
}

Result<void> add_needed(const std::vector<Limit>& limits, CompareOptions& options) {
  for (const Limit& limit : limits) {
    if (limit.quantity.starts_with("dE_")) {
      GONIO_ASSIGN(const color::DifferenceFormula formula, color::parse_formula(limit.quantity.substr(3)));
      if (std::ranges::find(options.formulas, formula) == options.formulas.end()) options.formulas.push_back(formula);
    } else if (limit.quantity.starts_with("metamerism_")) {
      const std::string name = limit.quantity.substr(11);
      if (std::ranges::find(options.illuminants, name) == options.illuminants.end())
        options.illuminants.push_back(name);
    }
  }
  return {};
}

Judged judged(const Comparison& comparison, const CompareOptions& options, const std::vector<Limit>& limits) {
  Judged result;
  if (limits.empty()) return result;
  const std::vector<Deviation> all = deviations(comparison, options);
  const std::string first_formula = quantity_of(options.formulas.front());
  std::vector<Deviation> missing = comparison.missing;
  for (const Deviation& d : all)
    if (std::isnan(d.value) && std::ranges::none_of(missing, [&](const Deviation& other) {
          return other.at == d.at && other.quantity == d.quantity;
        }))
      missing.push_back(d);
  std::vector<Excess> unmeasured;
  for (const Limit& limit : limits) {
    bool met = false;
    const auto meet = [&](const std::string& at) {
      met = true;
      if (std::ranges::find(result.places, at) == result.places.end()) result.places.push_back(at);
    };
    const auto lacks = [&](const Deviation& d) {
      meet(d.at);
      unmeasured.push_back({d, limit.low, limit.high, words_of_missing(d, comparison)});
    };
    for (const Deviation& d : all) {
      if (!concerns(limit, d, first_formula) || std::isnan(d.value)) continue;
      meet(d.at);
      if (!keeps(d.value, limit))
        result.excesses.push_back(excess_of(d, limit, limit.high && d.value > *limit.high, comparison));
    }
    for (const Deviation& d : missing)
      if (concerns(limit, d, first_formula)) lacks(d);
    if (!met) lacks({limit.at == "*" ? kWhole : limit.at, limit.quantity, std::numeric_limits<double>::quiet_NaN()});
  }
  std::ranges::move(unmeasured, std::back_inserter(result.excesses));
  return result;
}

const char* Judged::verdict(const std::string& at) const {
  const auto is_there = [&](const std::string& place) { return at == kWhole || place == at; };
  if (std::ranges::none_of(places, is_there)) return "-";
  const auto first = std::ranges::find_if(excesses, [&](const Excess& e) { return is_there(e.deviation.at); });
  return first == excesses.end() ? "pass" : std::isnan(first->deviation.value) ? "incomplete" : "fail";
}

}  // namespace goniochrome::quality
