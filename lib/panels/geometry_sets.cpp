#include "panels/geometry_sets.h"

#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "base/text.h"

namespace goniochrome::panels {

namespace {

struct View {
  double deg = 0;
  bool aspecular = false;
};

constexpr std::size_t kMostAngles = 10000;

// One piece of a list: a number, or FIRST:LAST:STEP.
Result<std::vector<double>> expanded(const char* option, std::string_view piece) {
  const auto error = [&] {
    return usage_error("{} has \"{}\": write a number of degrees, FIRST:LAST:STEP or set:NAME", option, piece);
  };
  const auto words = split(piece, ':');
  std::vector<double> numbers;
  for (const std::string_view word : words) {
    const auto number = parse_number(trimmed(word));
    if (!number) return error();
    numbers.push_back(*number);
  }
  if (numbers.size() == 1) return numbers;
  if (numbers.size() != 3) return error();
  const double first = numbers[0], last = numbers[1], step = std::abs(numbers[2]);
  if (!(step > 0)) return usage_error("{} has the range \"{}\" with step 0: give a step above 0", option, piece);
  const double count = std::floor(std::abs(last - first) / step + 1e-9);
  if (count > kMostAngles) return usage_error("{} has \"{}\", {} angles: give fewer", option, piece, count);
  std::vector<double> range;
  for (int i = 0; i <= count; ++i) range.push_back(first + (last < first ? -i : i) * step);
  return range;
}

Result<std::vector<View>> views_of(const char* option, const std::string& text, const char* GeometrySet::*member) {
  std::vector<View> views;
  for (const std::string_view raw : split(text, ',')) {
    std::string_view piece = trimmed(raw);
    if (piece.starts_with("set:")) {
      const std::string_view name = piece.substr(4);
      const auto& sets = geometry_sets();
      const auto set = std::ranges::find(sets, name, &GeometrySet::name);
      if (set == sets.end())
        return usage_error("{} names the set \"{}\": there are {}", option, name,
                           joined(sets, ", ", &GeometrySet::name));
      GONIO_ASSIGN(const std::vector<View> more, views_of(option, (*set).*member, member));
      views.insert(views.end(), more.begin(), more.end());
      continue;
    }
    const bool aspecular = piece.starts_with("as") && member == &GeometrySet::views;
    if (aspecular) piece.remove_prefix(2);
    GONIO_ASSIGN(const std::vector<double> angles, expanded(option, piece));
    for (const double angle : angles) views.push_back({angle, aspecular});
  }
  return views;
}

// One weight for each of `count` lights or views; 1 where none is given.
Result<std::vector<double>> weights_for(const char* option, std::size_t count, const std::vector<double>& given) {
  if (given.empty()) return std::vector<double>(count, 1.0);
  if (given.size() != count)
    return usage_error("{} has {} weights for {} angles: give one for each", option, given.size(), count);
  for (const double weight : given)
    if (!(weight > 0)) return usage_error("{} has the weight {}: give numbers above 0", option, shortest(weight));
  return given;
}

}  // namespace

const std::vector<GeometrySet>& geometry_sets() {
  static const std::vector<GeometrySet> sets = {
      {"instrument", "45", "as15,as25,as45,as75,as110", "what a multi-angle instrument measures"},
      {"showroom", "15,30,45,60", "-60:60:15", "rows of ceiling lights over a panel that people walk around"},
      {"outdoor", "20:80:15", "-75:75:15", "a sun from high to low, and viewers down to a grazing look"},
  };
  return sets;
}

Result<std::vector<double>> light_angles(const std::string& text) {
  GONIO_ASSIGN(const std::vector<View> lights, views_of("--lights", text, &GeometrySet::lights));
  std::vector<double> angles;
  for (const View& light : lights) {
    if (light.deg >= 90)
      return usage_error("--lights has {}: that light is below the horizon of the panel: give 0 up to less than 90",
                         shortest(light.deg));
    if (light.deg < 0)
      return usage_error("--lights has {}: lights are counted from the normal, 0 up to less than 90",
                         shortest(light.deg));
    angles.push_back(light.deg);
  }
  return angles;
}

double aspecular_deg(const LightView& geometry) {
  const paint::DirectionPair pair = directions(geometry);
  return paint::aspecular_angle_rad(pair.light, pair.view, {0, 0, 1}) / kDegree;
}

Result<GeometryList> geometry_list(const GeometryTexts& texts) {
  GONIO_ASSIGN(const std::vector<double> lights, light_angles(texts.lights));
  GONIO_ASSIGN(const std::vector<View> views, views_of("--views", texts.views, &GeometrySet::views));
  std::vector<double> azimuths;
  for (const std::string_view piece : split(texts.azimuths, ',')) {
    GONIO_ASSIGN(const std::vector<double> angles, expanded("--out-of-plane", trimmed(piece)));
    azimuths.insert(azimuths.end(), angles.begin(), angles.end());
  }
  GONIO_ASSIGN(const auto light_weights, weights_for("--light-weights", lights.size(), texts.light_weights));
  GONIO_ASSIGN(const auto view_weights, weights_for("--view-weights", views.size(), texts.view_weights));
  GeometryList list;
  for (std::size_t l = 0; l < lights.size(); ++l) {
    for (std::size_t v = 0; v < views.size(); ++v) {
      const double light = lights[l];
      const View& view = views[v];
      const double view_deg = view.aspecular ? light - view.deg : view.deg;
      if (!view.aspecular && std::abs(view_deg) >= 90)
        return usage_error("--views has {}: that viewer is below the horizon of the panel: give -90 to 90, exclusive",
                           shortest(view.deg));
      for (const double azimuth : azimuths) {
        const LightView pair{light, view_deg, azimuth};
        if (std::abs(view_deg) >= 90) {
          ++list.below_horizon;
        } else if (aspecular_deg(pair) < kIndexGlare_deg - 1e-9) {
          ++list.glare;
          list.left_out.push_back(pair);
        } else {
          list.pairs.push_back(pair);
          list.weights.push_back(light_weights[l] * view_weights[v]);
        }
      }
    }
  }
  if (list.pairs.empty())
    return usage_error(
        "no pair of light and viewer is left: {} within {} deg of the mirror direction, where gloss covers the color "
        "of "
        "any paint, and {} below the horizon: move the viewers, as by --views as20; a solid paint shows the same there",
        list.glare, kIndexGlare_deg, list.below_horizon);
  return list;
}

}  // namespace goniochrome::panels
