#include "studio/internal/edit_json.h"

#include <algorithm>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "base/text.h"
#include "studio/internal/json_reader.h"
#include "studio/paint_json.h"

namespace goniochrome::studio {

namespace {

using Take = std::function<void(JsonReader&, const char* key, paint::Edit&)>;

// A number within the domain of its option.
double within(JsonReader& reader, const char* key, double low, double high) {
  const double value = reader.number(key);
  if (!(value >= low && value <= high)) reader.fail("a number within the domain of the option", key);
  return value;
}

color::Lab lab_within(JsonReader& reader, const char* key, double least_lightness) {
  const color::Lab lab = reader.lab(key);
  for (const double value : {lab.L, lab.a, lab.b})
    if (!(value >= -300 && value <= 300)) reader.fail("numbers from -300 to 300", key);
  if (lab.L < least_lightness) reader.fail("an L* of 0 or more", key);
  return lab;
}

void take_readings(JsonReader& reader, const char* key, paint::Edit& edit) {
  for (const Json& element : reader.list(key)) {
    JsonReader of(element);
    const auto geometry = paint::parse_geometry(of.text("geometry"));
    if (!geometry.ok()) return reader.fail("geometries such as 45as15", key);
    edit.readings.push_back({*geometry, lab_within(of, "lab", 0)});
    if (!of.status().ok()) reader.fail("readings of three numbers each", key);
  }
}

// The options by name; their domains are those of paint-edit.
const std::map<std::string, Take, std::less<>>& moves() {
  static const std::map<std::string, Take, std::less<>> all = {
      {"hue", [](JsonReader& r, const char* k, paint::Edit& e) { e.average_hue_deg = within(r, k, -360, 360); }},
      {"chroma", [](JsonReader& r, const char* k, paint::Edit& e) { e.average_chroma = within(r, k, 0, 300); }},
      {"lightness", [](JsonReader& r, const char* k, paint::Edit& e) { e.average_lightness = within(r, k, 0, 300); }},
      {"hue-shift", [](JsonReader& r, const char* k, paint::Edit& e) { e.tweak.hue_deg = within(r, k, -360, 360); }},
      {"chroma-factor",
       [](JsonReader& r, const char* k, paint::Edit& e) { e.tweak.chroma_factor = within(r, k, 0, 100); }},
      {"lightness-shift",
       [](JsonReader& r, const char* k, paint::Edit& e) { e.tweak.lightness = within(r, k, -300, 300); }},
      {"at", [](JsonReader& r, const char* k, paint::Edit& e) { e.at_deg = within(r, k, 0, 180); }},
      {"face", [](JsonReader& r, const char* k, paint::Edit& e) { e.face = lab_within(r, k, 0); }},
      {"flop", [](JsonReader& r, const char* k, paint::Edit& e) { e.flop = lab_within(r, k, 0); }},
      {"face-shift", [](JsonReader& r, const char* k, paint::Edit& e) { e.face_shift = lab_within(r, k, -300); }},
      {"flop-shift", [](JsonReader& r, const char* k, paint::Edit& e) { e.flop_shift = lab_within(r, k, -300); }},
      {"travel", [](JsonReader& r, const char* k, paint::Edit& e) { e.travel_deg = within(r, k, 15, 180); }},
      {"travel-shift",
       [](JsonReader& r, const char* k, paint::Edit& e) { e.travel_shift_deg = within(r, k, -165, 165); }},
      {"keep-residual", [](JsonReader& r, const char* k, paint::Edit& e) { e.keep_residual = r.flag(k); }},
      {"set", take_readings},
      {"gloss", [](JsonReader& r, const char* k, paint::Edit& e) { e.gloss = within(r, k, 0, 100); }},
      {"gloss-shift", [](JsonReader& r, const char* k, paint::Edit& e) { e.gloss_shift = within(r, k, -100, 100); }},
      {"anisotropy",
       [](JsonReader& r, const char* k, paint::Edit& e) {
         const std::vector<double> alpha = r.numbers(k, 2);
         const bool within = std::ranges::all_of(alpha, [](double a) { return a >= 0 && a <= 10; });
         if (!within || (alpha[0] == 0) != (alpha[1] == 0))
           return r.fail("two numbers above 0 and up to 10, or 0,0", k);
         e.anisotropy = paint::Anisotropy{alpha[0], alpha[1]};
       }},
      {"flakes",
       [](JsonReader& r, const char* k, paint::Edit& e) {
         const std::vector<double> of = r.numbers(k, 3);
         const double most[] = {paint::kMostFlake_um, 1, paint::kMostFlakeSpread_deg};
         const bool within = std::ranges::equal(of, most, [](double x, double limit) { return x >= 0 && x <= limit; });
         if (!within || (of[0] == 0) != (of[1] == 0))
           return r.fail("diameter, coverage and spread of flakes, or 0,0 and a spread", k);
         e.flakes = paint::Flakes{of[0], of[1], of[2]};
       }},
      {"gloss-angle", [](JsonReader& r, const char* k, paint::Edit& e) { e.gloss_angle_deg = within(r, k, 20, 85); }}};
  return all;
}

}  // namespace

Result<paint::Edit> edit_of_json(const Json& json) {
  JsonReader reader(json);
  GONIO_TRY(reader.status());
  paint::Edit edit;
  for (const auto& [key, value] : json.items()) {
    const auto move = moves().find(key);
    if (move == moves().end()) return input_error("\"{}\" is no move of paint-edit", key);
    move->second(reader, key.c_str(), edit);
  }
  GONIO_TRY(reader.status());
  if (edit.travel_deg && *edit.travel_deg <= 15)
    return input_error("the travel is {}: it lies above 15 and up to 180", shortest(*edit.travel_deg));
  return Result(std::move(edit));
}

Json shifts_json(const paint::Edit& edit) {
  Json json = Json::object();
  if (edit.face_shift != color::Lab()) json["face-shift"] = lab_json(edit.face_shift);
  if (edit.flop_shift != color::Lab()) json["flop-shift"] = lab_json(edit.flop_shift);
  if (edit.travel_shift_deg != 0) json["travel-shift"] = edit.travel_shift_deg;
  if (edit.gloss_shift != 0) json["gloss-shift"] = edit.gloss_shift;
  if (edit.gloss_shift != 0 && edit.gloss_angle_deg != 60) json["gloss-angle"] = edit.gloss_angle_deg;
  return json;
}

}  // namespace goniochrome::studio
