#include "averaging.h"

#include "base/text.h"
#include "paint/date.h"
#include "quality/average.h"

namespace goniochrome::tool {

namespace {

Json average_json(const quality::Average& average, const std::vector<paint::Paint>& readings) {
  Json json = {{"name", average.paint.name},
               {"readings", readings.size()},
               {"kept", average.kept},
               {"date", average.paint.measurement->date},
               {"serial", average.paint.measurement->serial},
               {"geometries", Json::object()},
               {"outliers", Json::array()}};
  for (const quality::Scatter& scatter : average.scatter)
    json["geometries"][paint::geometry_name(scatter.geometry)] = {
        {"readings", scatter.readings},
        {"L", json_number(scatter.deviation.L)},
        {"a", json_number(scatter.deviation.a)},
        {"b", json_number(scatter.deviation.b)},
        {"mean_distance", json_number(scatter.mean_distance)}};
  for (const quality::Outlier& outlier : average.outliers)
    json["outliers"].push_back({{"name", readings[outlier.place].name},
                                {"distance", json_number(outlier.distance)},
                                {"median_distance", json_number(outlier.median_distance)}});
  return json;
}

}  // namespace

Result<void> Averaging::take(paint::Paint reading, const std::string& place) {
  const bool by_code = options_.average == "code";
  if (by_code && reading.code.empty())
    return input_error("{}: paint \"{}\" has no code: give --average name", place, reading.name);
  std::string key = by_code ? reading.code : quality::base_name(reading.name);
  if (options_.average == "date") {
    const std::string date = reading.measurement ? reading.measurement->date : "";
    const auto day = paint::day_of_date(date);
    if (!day)
      return input_error(
          "{}: paint \"{}\" has {}: write it as 2021-11-26, or give --average name", place, reading.name,
          date.empty() ? "no date" : fmt::format("the date \"{}\", whose day is not known", shown(date)));
    key += " (" + *day + ")";
  }
  const auto [found, is_new] = places_.try_emplace(key, groups_.size());
  if (is_new) groups_.push_back({key, place, {}});
  groups_[found->second].readings.push_back(std::move(reading));
  return {};
}

Result<void> Averaging::finish(const std::function<Result<void>(paint::Paint, const std::string&)>& pass,
                               const std::function<Result<void>(const Error&)>& skip) {
  const bool drop = options_.outliers == "drop";
  if (options_.average != "none") session_.begin_list("averages");
  for (Group& group : groups_) {
    auto average = quality::average(group.readings, drop);
    if (!average.ok()) {
      GONIO_TRY(skip(input_error("{}: paint \"{}\": {}", group.place, group.key, average.error().message)));
      continue;
    }
    for (const quality::Outlier& outlier : average->outliers)
      session_.warn(
          fmt::format("paint \"{}\" stands apart from the {} readings of \"{}\", by {:.2f} where their median "
                      "is {:.2f}: {}",
                      group.readings[outlier.place].name, group.readings.size(), group.key, outlier.distance,
                      outlier.median_distance, drop ? "left out" : "kept; --outliers drop leaves it out"));
    average->paint.name = name_of(group);
    session_.add("averages", [&] { return average_json(*average, group.readings); });
    GONIO_TRY(pass(std::move(average->paint), group.place));
    group.readings.clear();
  }
  return {};
}

// The key, or where that is a code the name of the readings, with the code behind it where another code has that name.
std::string Averaging::name_of(const Group& group) {
  if (options_.average != "code") return group.key;
  const std::string name = quality::base_name(group.readings.front().name);
  return names_.insert(name).second ? name : fmt::format("{} ({})", name, group.key);
}

}  // namespace goniochrome::tool
