#include "stated.h"

#include <algorithm>

#include "base/text.h"

namespace goniochrome::tool {

namespace {

Result<paint::LabReading> reading_of(const std::string& text) {
  const auto wrong = [&] {
    return usage_error("--set is \"{}\": write GEOMETRY=L,A,B with numbers from -300 to 300, as in 45as45=50,12.5,-3",
                       text);
  };
  const auto equals = text.find('=');
  if (equals == std::string::npos) return wrong();
  const auto geometry = paint::parse_geometry(trimmed(std::string_view(text).substr(0, equals)));
  if (!geometry.ok()) return usage_error("--set: {}", geometry.error().message);
  std::vector<double> numbers;
  for (const std::string_view part : split(std::string_view(text).substr(equals + 1), ',')) {
    const auto number = parse_number(trimmed(part));
    if (!number || !(*number >= -300 && *number <= 300)) return wrong();
    numbers.push_back(*number);
  }
  if (numbers.size() != 3) return wrong();
  if (numbers[0] < 0) return usage_error("--set has L* {}: give 0 or more", shortest(numbers[0]));
  return paint::LabReading{*geometry, {numbers[0], numbers[1], numbers[2]}};
}

}  // namespace

Result<std::vector<paint::LabReading>> stated_readings(const std::vector<std::string>& texts) {
  std::vector<paint::LabReading> readings;
  for (const std::string& text : texts) {
    GONIO_ASSIGN(const paint::LabReading reading, reading_of(text));
    if (std::ranges::find(readings, reading.geometry, &paint::LabReading::geometry) != readings.end())
      return usage_error("--set names {} twice: give it once", paint::geometry_name(reading.geometry));
    readings.push_back(reading);
  }
  return readings;
}

Result<paint::Paint> stated_paint(const Options& options, const paint::Edit& edit) {
  paint::Paint paint;
  paint.name = options.new_name;
  if (!edit.face && edit.readings.empty()) return usage_error("--new lacks a color: give --face, or readings by --set");
  if (!edit.face && (edit.flop || edit.travel_deg))
    return usage_error("--flop and --travel of a --new paint need --face");
  if (!edit.face) return paint;
  if (edit.flop && !edit.travel_deg)
    return usage_error("--new has a flop and no travel: give --travel, the angle where the flop begins");
  if (!edit.flop) paint.paint_class = paint::PaintClass::kSolid;
  paint.appearance = paint::Appearance{*edit.face, edit.flop.value_or(*edit.face),
                                       edit.travel_deg.value_or(paint::Appearance().travel_deg), std::nullopt};
  return paint;
}

}  // namespace goniochrome::tool
