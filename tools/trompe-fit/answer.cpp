#include "answer.h"

#include <cmath>

#include "base/text.h"

namespace goniochrome::tool {

namespace {

Json errors_json(const panels::TrompeErrors& errors) {
  return {{"rms", json_number(errors.rms)}, {"max", json_number(errors.max)}};
}

}  // namespace

paint::Paint painted(const paint::Paint& paint, const Answer& answer) {
  paint::Paint b = paint;
  b.name = answer.name;
  b.code.clear();
  b.appearance = answer.fit.b;
  b.measurement = paint::Measurement{paint::condition_of(paint), "", paint::rows_of(answer.fit.b)};
  b.lobes.reset(), b.color_map.reset();
  return b;
}

Json answer_json(const Answer& answer) {
  Json json = {{"name", answer.name}};
  if (answer.light_deg) json["light_deg"] = *answer.light_deg;
  json["status"] = answer.fit.converged ? "converged" : "not_converged";
  json["before"] = errors_json(answer.before);
  json["after"] = errors_json(answer.after);
  const panels::TrompeValues from = panels::values_of(answer.a), to = panels::values_of(answer.fit.b);
  for (int p = 0; p < panels::kTrompeParameters; ++p) json["delta"][panels::parameter_name(p)] = to[p] - from[p];
  json["geometries"] = Json::array();
  for (std::size_t i = 0; i < answer.judged.size(); ++i) {
    const TrompeGeometry& g = *answer.judged[i];
    json["geometries"].push_back({{"light_deg", g.geometry.light_deg},
                                  {"view_deg", g.geometry.view_deg},
                                  {"azimuth_deg", g.geometry.azimuth_deg},
                                  {"aspecular_deg", g.view.aspecular_a_deg},
                                  {"aspecular_b_deg", g.view.aspecular_b_deg},
                                  {"weight", g.view.weight},
                                  {"de_before", json_number(answer.before.de[i])},
                                  {"de_after", json_number(answer.after.de[i])}});
  }
  json["undetermined"] = answer.fit.undetermined;
  json["at_bound"] = answer.fit.at_bound;
  json["solid"] = answer.fit.solid;
  json["starts"] = answer.fit.starts;
  json["time_ms"] = answer.fit.time_ms;
  return json;
}

std::string answer_line(const Answer& answer) {
  std::string line = fmt::format("{}: dE rms {:.2f} to {:.2f}, max {:.2f} to {:.2f}", answer.name, answer.before.rms,
                                 answer.after.rms, answer.before.max, answer.after.max);
  const panels::TrompeValues from = panels::values_of(answer.a), to = panels::values_of(answer.fit.b);
  std::string changes;
  for (int p = 0; p < panels::kTrompeParameters; ++p)
    if (std::abs(to[p] - from[p]) >= 0.005)
      changes += fmt::format("{}{} {:+.2f}", changes.empty() ? "; " : ", ", panels::parameter_name(p), to[p] - from[p]);
  line += changes;
  if (!answer.fit.undetermined.empty())
    line += fmt::format("; not determined by these views: {}", joined(answer.fit.undetermined, ", "));
  if (!answer.fit.at_bound.empty()) line += fmt::format("; held by a bound: {}", joined(answer.fit.at_bound, ", "));
  if (answer.fit.solid) line += "; solid: face and flop as one, travel left alone";
  return line;
}

Json results_of(const std::vector<Json>& fits) {
  return fits.size() == 1 ? fits.front() : Json{{"fits", fits}};
}

bool is_improved(const Answer& answer, const panels::TrompeOptions& options) {
  return options.least_maximum ? answer.fit.after.max < answer.fit.before.max
                               : answer.fit.after.rms < answer.fit.before.rms;
}

}  // namespace goniochrome::tool
