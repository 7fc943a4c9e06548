#include "judgement.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/text.h"

namespace goniochrome::tool {

namespace {

// The other quantities at a place.
std::string others_at(const quality::Comparison& comparison, const std::string& at, int decimals) {
  std::string text;
  for (const quality::Deviation& d : comparison.others) {
    if (d.at != at) continue;
    if (!text.empty()) text += ',';
    text += table_field(d.quantity), text += '=', text += table_number(d.value, decimals);
  }
  return text.empty() ? "-" : text;
}

// Appends the line of a place; `names` are those of sample and standard with their tabs.
void add_line(const Judgement& judgement, const std::string& names, const std::string& at,
              const quality::AngleDifference& angle, int decimals, std::string& text) {
  text += names, text += at;
  const color::LabDifference& d = angle.lab;
  for (const double value : {d.dL, d.da, d.db, d.dC, d.dH}) text += '\t', text += table_number(value, decimals);
  for (const double value : angle.by_formula) text += '\t', text += table_number(value, decimals);
  text += '\t', text += others_at(judgement.comparison, at, decimals);
  text += '\t', text += judgement.judged.verdict(at), text += '\n';
}

// The places of a sample: its geometries, mean, largest and the paint; further ones, such as the instrument's own words
// for its light; and those that were not measured and have a limit.
std::vector<std::string> places_of(const Judgement& judgement) {
  const quality::Comparison& comparison = judgement.comparison;
  std::vector<std::string> places;
  const auto add = [&](const std::string& place) {
    if (std::ranges::find(places, place) == places.end()) places.push_back(place);
  };
  for (const quality::AngleDifference& angle : comparison.angles) add(paint::geometry_name(angle.geometry));
  for (const char* place : {quality::kMean, quality::kLargest, quality::kWhole}) add(place);
  for (const quality::Deviation& d : comparison.others) add(d.at);
  for (const std::string& place : judgement.judged.places) add(place);
  return places;
}

std::string table_lines(const Judgement& judgement, const quality::CompareOptions& compare) {
  const quality::Comparison& comparison = judgement.comparison;
  std::vector<color::Lab> colors;
  for (const quality::AngleDifference& angle : comparison.angles)
    colors.insert(colors.end(), {angle.standard, angle.sample});
  const int decimals = decimals_of(colors);
  const std::string names = table_field(comparison.sample) + "\t" + table_field(comparison.standard) + "\t";
  std::string text;
  for (const quality::AngleDifference& angle : comparison.angles)
    add_line(judgement, names, paint::geometry_name(angle.geometry), angle, decimals, text);
  add_line(judgement, names, quality::kMean, comparison.mean, decimals, text);
  add_line(judgement, names, quality::kLargest, comparison.largest, decimals, text);
  std::string blank;
  for (std::size_t i = 0; i < 5 + compare.formulas.size(); ++i) blank += "\t-";
  std::vector<std::string> further = places_of(judgement);
  further.erase(further.begin(), std::ranges::find(further, quality::kWhole));
  for (const std::string& place : further)
    text += names + table_field(place) + blank + "\t" + others_at(comparison, place, decimals) + "\t" +
            judgement.judged.verdict(place) + "\n";
  return text;
}

Json angle_json(const quality::AngleDifference& angle, const quality::CompareOptions& compare) {
  const color::LabDifference& d = angle.lab;
  Json json = {{"dL", json_number(d.dL)},
               {"da", json_number(d.da)},
               {"db", json_number(d.db)},
               {"dC", json_number(d.dC)},
               {"dH", json_number(d.dH)}};
  for (std::size_t i = 0; i < compare.formulas.size(); ++i)
    json[quality::quantity_of(compare.formulas[i])] = json_number(angle.by_formula[i]);
  return json;
}

}  // namespace

std::vector<std::string> Judgement::words(std::size_t most) const {
  std::vector<std::string> words;
  std::map<std::string, std::vector<std::string>> missing;  // quantities by geometry
  for (const quality::Excess& excess : judged.excesses)
    if (std::isnan(excess.deviation.value)) missing[excess.deviation.at].push_back(excess.deviation.quantity);
  for (const char* place : {quality::kMean, quality::kLargest}) missing.erase(place);  // they name the geometries
  for (const quality::Excess& excess : judged.excesses) {
    const auto found = missing.find(excess.deviation.at);
    if (!std::isnan(excess.deviation.value) || found == missing.end() || found->second.size() == 1)
      words.push_back(excess.words);
    else if (excess.deviation.quantity == found->second.front())
      words.push_back(
          fmt::format("{}: {} have limits and were not measured", found->first, joined(found->second, ", ")));
  }
  if (words.size() > most) {
    const std::size_t more = words.size() - most;
    words.resize(most);
    words.push_back(fmt::format("and {} more", more));
  }
  return words;
}

void VerdictCount::add(const Judgement& judgement) {
  const std::string verdict = judgement.verdict();
  ++(verdict == "pass" ? passed : verdict == "fail" ? failed : verdict == "incomplete" ? incomplete : without);
}

std::string VerdictCount::words() const {
  std::string text = fmt::format("{} pass, {} fail", passed, failed);
  if (incomplete > 0) text += fmt::format(", {} incomplete", incomplete);
  if (without > 0) text += fmt::format(", {} not judged: their standards have no limits", without);
  return text;
}

Json judgement_json(const Judgement& judgement, const quality::CompareOptions& compare) {
  const quality::Comparison& comparison = judgement.comparison;
  Json json = {
      {"sample", comparison.sample},    {"standard", comparison.standard}, {"direction", "sample minus standard"},
      {"verdict", judgement.verdict()}, {"failures", Json::array()},       {"geometries", Json::object()}};
  for (const quality::Excess& excess : judgement.judged.excesses)
    json["failures"].push_back({{"at", excess.deviation.at},
                                {"quantity", excess.deviation.quantity},
                                {"value", json_number(excess.deviation.value)},
                                {"limit", json_number(excess.low.value_or(excess.high.value_or(0)))},
                                {"words", excess.words}});
  for (const quality::AngleDifference& angle : comparison.angles)
    json["geometries"][paint::geometry_name(angle.geometry)] = angle_json(angle, compare);
  json["mean"] = angle_json(comparison.mean, compare);
  json["max"] = angle_json(comparison.largest, compare);
  for (const quality::Deviation& d : comparison.others) json["others"][d.at][d.quantity] = json_number(d.value);
  for (const std::string& place : places_of(judgement)) json["verdicts"][place] = judgement.judged.verdict(place);
  return json;
}

std::string table_head(const quality::CompareOptions& compare) {
  std::string text = "sample\tminus_standard\tgeometry\tdL\tda\tdb\tdC\tdH";
  for (const color::DifferenceFormula& formula : compare.formulas) text += "\t" + quality::quantity_of(formula);
  return text + "\tother\tverdict\n";
}

std::string text_of(const Judgement& judgement, const quality::CompareOptions& compare, Format format) {
  if (format == Format::kTable) return table_lines(judgement, compare);
  if (format == Format::kPaints) return "";
  return json_text(judgement_json(judgement, compare)) + "\n";
}

paint::Paint with_verdict(paint::Paint sample, const Judgement& judgement) {
  std::erase_if(sample.foreign,
                [](const std::string& element) { return quality::is_quality_element(element, "verdict"); });
  sample.foreign.push_back(fmt::format("<verdict xmlns=\"{}\" standard=\"{}\" result=\"{}\">{}</verdict>",
                                       quality::kQualityNamespace, xml_escaped(judgement.comparison.standard),
                                       judgement.verdict(), xml_escaped(joined(judgement.words(), "; "), "")));
  return sample;
}

}  // namespace goniochrome::tool
