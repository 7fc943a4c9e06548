#include "paint/edit.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/angles.h"
#include "base/text.h"
#include "math/elementary.h"
#include "paint/curve.h"
#include "paint/metrics.h"

namespace goniochrome::paint {

namespace {

constexpr std::array kAverageAngles_deg = {15.0, 45.0, 110.0};
constexpr double kHighestGloss = 100;

color::Lab operator+(const color::Lab& x, const color::Lab& y) {
  return {x.L + y.L, x.a + y.a, x.b + y.b};
}
color::Lab operator-(const color::Lab& x, const color::Lab& y) {
  return {x.L - y.L, x.a - y.a, x.b - y.b};
}
color::Lab scaled(const color::Lab& x, double factor) {
  return {x.L * factor, x.a * factor, x.b * factor};
}
color::Lab mixed(const color::Lab& x, const color::Lab& y, double fraction) {
  return {std::lerp(x.L, y.L, fraction), std::lerp(x.a, y.a, fraction), std::lerp(x.b, y.b, fraction)};
}

// The parts of a paint that a move of the color changes: the appearance and the rows, which move together.
struct Locus {
  Appearance appearance;
  std::vector<LabReading> rows;
};

// Every color through one map that is affine in Lab, as the tweaks are: the curve is an affine combination of face and
// flop, so it goes through the same map.
void map_all(Locus& locus, const Tweak& tweak) {
  locus.appearance.face = tweaked(locus.appearance.face, tweak);
  locus.appearance.flop = tweaked(locus.appearance.flop, tweak);
  for (LabReading& row : locus.rows) row.lab = tweaked(row.lab, tweak);
}

// A new curve: each row moves by what the curve moves at its angle. With r = (travel - t)/(travel - 15) a move of the
// face by D moves a row by D r^2 and a move of the flop by D moves it by D (1 - r^2): the weights of the curve itself.
void move_to(Locus& locus, const Appearance& target) {
  for (LabReading& row : locus.rows) {
    const double t = aspecular_angle_deg(row.geometry);
    row.lab = row.lab + (lab_at(target, t) - lab_at(locus.appearance, t));
  }
  locus.appearance = target;
}

// The turn from one angle to another, in (-180, 180].
double turn_deg(double from_deg, double to_deg) {
  const double turn = std::remainder(to_deg - from_deg, 360.0);
  return turn == -180 ? 180 : turn;
}

void move_average(Locus& locus, const Edit& edit, Edited& result) {
  const AverageColor average = average_color(locus.appearance);
  const bool achromatic = average.chroma < kLeastChroma;
  Tweak tweak;
  if (edit.average_hue_deg && !achromatic) tweak.hue_deg = turn_deg(average.hue_deg, *edit.average_hue_deg);
  if (edit.average_chroma && !achromatic) tweak.chroma_factor = *edit.average_chroma / average.chroma;
  if (edit.average_lightness) tweak.lightness = *edit.average_lightness - average.L;
  if (achromatic && (edit.average_hue_deg || edit.average_chroma))
    result.skipped.push_back(
        fmt::format("{}: the average chroma {:.2f} is below 1, and a gray has no hue: move its face and flop",
                    edit.average_hue_deg ? "hue" : "chroma", average.chroma));
  map_all(locus, tweak);
}

// The color that a paint shows at an angle: the mean of its readings there in the plane of incidence, else the curve.
color::Lab shown_at(const Locus& locus, double aspecular_deg) {
  color::Lab sum;
  double count = 0;
  for (const LabReading& row : locus.rows) {
    if (row.geometry.out_of_plane || aspecular_angle_deg(row.geometry) != aspecular_deg) continue;
    sum = sum + row.lab;
    ++count;
  }
  return count > 0 ? scaled(sum, 1 / count) : lab_at(locus.appearance, aspecular_deg);
}

// The least changes dF of the face and dO of the flop, |dF|^2 + |dO|^2, under the condition that the curve changes by D
// at the angle: w dF + (1 - w) dO = D with the weight w of the curve. By Lagrange's multiplier these are
//   dF = D w/(w^2 + (1-w)^2),   dO = D (1-w)/(w^2 + (1-w)^2),
// where the denominator is at least 1/2. At the face dF = D and dO = 0; from the travel on dF = 0 and dO = D. Nearer to
// specular than the face w is above 1 and the flop would move the other way, so the face alone moves there, by D/w.
void move_at(Locus& locus, const Tweak& tweak, double aspecular_deg) {
  const color::Lab now = shown_at(locus, aspecular_deg), change = tweaked(now, tweak) - now;
  const double w = lab_at({{1, 0, 0}, {}, locus.appearance.travel_deg, std::nullopt}, aspecular_deg).L;
  const double squares = w * w + (1 - w) * (1 - w);
  Appearance target = locus.appearance;
  target.face = target.face + scaled(change, w >= 1 ? 1 / w : w / squares);
  target.flop = target.flop + scaled(change, w >= 1 ? 0 : (1 - w) / squares);
  move_to(locus, target);
}

void blend_at(Locus& locus, const Tweak& tweak, double aspecular_deg) {
  const double share = face_share(locus.appearance, aspecular_deg);
  Appearance target = locus.appearance;
  target.face = mixed(target.face, tweaked(target.face, tweak), share);
  target.flop = mixed(target.flop, tweaked(target.flop, tweak), 1 - share);
  move_to(locus, target);
}

void move_ends(Locus& locus, const Edit& edit) {
  Appearance target = locus.appearance;
  target.face = edit.face.value_or(target.face) + edit.face_shift;
  target.flop = edit.flop.value_or(target.flop) + edit.flop_shift;
  move_to(locus, target);
}

void move_travel(Locus& locus, const Edit& edit, Edited& result) {
  if (!edit.travel_deg && edit.travel_shift_deg == 0) return;
  Appearance target = locus.appearance;
  target.travel_deg = edit.travel_deg.value_or(target.travel_deg) + edit.travel_shift_deg;
  if (const auto checked = check(target); checked.ok())
    move_to(locus, target);
  else
    result.skipped.push_back(
        fmt::format("travel: it would go from {} deg to {} deg, but it must be above 15 and at most 180",
                    shortest(locus.appearance.travel_deg), shortest(target.travel_deg)));
}

// A surface that reflects no light has no color: a* and b* end with L*.
void clip(color::Lab& lab, const std::string& what, Edited& result) {
  const bool colored = lab.a != 0 || lab.b != 0;
  if (lab.L > 0 || (lab.L == 0 && !colored)) return;
  if (lab.L < 0) result.clipped.push_back(fmt::format("{}: L* {:.2f} to 0", what, lab.L));
  if (colored)
    result.clipped.push_back(fmt::format("{}: chroma {:.2f} to 0, as black has none", what, color::chroma(lab)));
  lab = {};
}

// The difference of the worst row in the plane of incidence, or of all rows if none is in it, as in
// appearance_from_rows.
double worst_de00(const Locus& locus) {
  const auto in_plane = [](const LabReading& row) { return !row.geometry.out_of_plane; };
  const bool any = std::ranges::any_of(locus.rows, in_plane);
  double worst = 0;
  for (const LabReading& row : locus.rows)
    if (in_plane(row) || !any)
      worst =
          std::max(worst, color::delta_e_2000(row.lab, lab_at(locus.appearance, aspecular_angle_deg(row.geometry))));
  return worst;
}

// The paint's appearance and rows. The appearance is fitted if the paint has none.
Result<Locus> locus_of(const Paint& paint) {
  Locus locus;
  if (paint.measurement) locus.rows = paint.measurement->rows;
  if (paint.appearance) {
    locus.appearance = *paint.appearance;
    return locus;
  }
  auto fit = appearance_from_rows(locus.rows);
  if (!fit.ok()) return Error{fit.error().kind, fmt::format("paint \"{}\": {}", paint.name, fit.error().message)};
  locus.appearance = fit->appearance;
  return locus;
}

bool has_color(const Paint& paint) {
  return paint.appearance || (paint.measurement && !paint.measurement->rows.empty());
}

// The rows of the curve, in place of rows that have a residual.
void restate(Locus& locus, Edited& result) {
  constexpr double kSeen_de00 = 0.005;  // half a unit of the last decimal that instruments print
  if (locus.rows.empty()) return;
  result.restated_de00 = worst_de00(locus);
  if (*result.restated_de00 >= kSeen_de00) result.dropped.push_back("residual of the rows");
  for (LabReading& row : locus.rows) row.lab = lab_at(locus.appearance, aspecular_angle_deg(row.geometry));
}

// Puts readings in the place of rows, or beside them. A paint without rows gets those of its curve first.
Result<void> set_readings(Locus& locus, const Edit& edit, bool has_curve, Edited& result) {
  if (edit.readings.empty()) return {};
  if (locus.rows.empty() && has_curve) locus.rows = rows_of(locus.appearance);
  for (const LabReading& reading : edit.readings) {
    const auto row = std::ranges::find(locus.rows, reading.geometry, &LabReading::geometry);
    if (row == locus.rows.end())
      locus.rows.push_back(reading);
    else
      row->lab = reading.lab;
  }
  if (states_appearance(edit)) return {};
  GONIO_ASSIGN(const AppearanceFit fit, appearance_from_rows(locus.rows));
  locus.appearance = fit.appearance;
  result.fitted_de00 = fit.appearance.residual_de00;
  return {};
}

// Puts a moved locus back. Its residual is that of the rows that it has now.
void put_back(Paint& paint, Locus locus) {
  locus.appearance.residual_de00 = locus.rows.empty() ? std::nullopt : std::optional<double>(worst_de00(locus));
  paint.appearance = locus.appearance;
  if (!paint.measurement && locus.rows.empty()) return;
  if (!paint.measurement) paint.measurement.emplace();
  paint.measurement->rows = std::move(locus.rows);
  // The others are those of the paint before.
  paint.measurement->instrument.clear(), paint.measurement->serial.clear(), paint.measurement->date.clear();
  paint.measurement->spectra.clear();
  paint.measurement->textures.clear();
}

void drop_lobes(Paint& paint, Edited& result) {
  if (paint.lobes) result.dropped.push_back("lobes");
  paint.lobes.reset();
}

// The moves of the curve, in their order; the rows go with it.
void move_color(Locus& locus, const Edit& edit, Edited& result) {
  move_average(locus, edit, result);
  if (!edit.at_deg)
    map_all(locus, edit.tweak);
  else if (edit.share == Share::kExact)
    move_at(locus, edit.tweak, *edit.at_deg);
  else
    blend_at(locus, edit.tweak, *edit.at_deg);
  move_ends(locus, edit);
  move_travel(locus, edit, result);
  if (states_appearance(edit) && !edit.keep_residual) restate(locus, result);
}

Result<void> edit_color(const Edit& edit, Edited& result) {
  Paint& paint = result.paint;
  const bool colored = has_color(paint);
  if (!colored && edit.readings.empty()) {
    result.skipped.push_back("color: it has neither measured rows nor an appearance");
    return {};
  }
  Locus locus;
  if (colored) {
    GONIO_ASSIGN(locus, locus_of(paint));
    if (!paint.appearance) result.fitted_de00 = locus.appearance.residual_de00;
    result.before = locus.appearance;
    move_color(locus, edit, result);
  }
  GONIO_TRY(set_readings(locus, edit, colored, result));
  clip(locus.appearance.face, "face", result);
  clip(locus.appearance.flop, "flop", result);
  for (LabReading& row : locus.rows) clip(row.lab, geometry_name(row.geometry), result);
  result.after = locus.appearance;
  put_back(paint, std::move(locus));
  drop_lobes(paint, result);
  if (paint.color_map) result.dropped.push_back("color map");
  paint.color_map.reset();
  return {};
}

void edit_gloss(const Edit& edit, Edited& result) {
  Paint& paint = result.paint;
  const auto at_angle = [&](const GlossReading& reading) { return reading.angle_deg == edit.gloss_angle_deg; };
  const auto old = std::ranges::find_if(paint.gloss, at_angle);
  if (!edit.gloss && old == paint.gloss.end()) {
    result.skipped.push_back(
        fmt::format("gloss: it has no reading at {} deg to shift: set one", shortest(edit.gloss_angle_deg)));
    return;
  }
  const double start = edit.gloss ? *edit.gloss : old->gloss_units;
  const double wanted = start + edit.gloss_shift;
  const double units = std::clamp(wanted, 0.0, std::max(kHighestGloss, start));
  if (units != wanted) result.clipped.push_back(fmt::format("gloss: {} to {}", shortest(wanted), shortest(units)));
  // One number shapes the whole highlight, so readings at other angles would contradict it.
  for (const GlossReading& reading : paint.gloss)
    if (!at_angle(reading)) result.dropped.push_back(fmt::format("gloss at {} deg", shortest(reading.angle_deg)));
  paint.gloss = {{edit.gloss_angle_deg, units}};
  drop_lobes(paint, result);
}

// The rows of the geometries both paints have, in the first paint's order.
std::vector<LabReading> rows_between(const Measurement& from, const Measurement& to, double fraction) {
  std::vector<LabReading> rows;
  for (const LabReading& row : from.rows) {
    const auto other = std::ranges::find_if(to.rows, [&](const LabReading& r) { return r.geometry == row.geometry; });
    if (other != to.rows.end()) rows.push_back({row.geometry, mixed(row.lab, other->lab, fraction)});
  }
  return rows;
}

// If one of the paints has a single color, the travel is that of the other one.
double travel_between(const Appearance& from, const Appearance& to, double fraction) {
  if (from.face == from.flop) return to.travel_deg;
  if (to.face == to.flop) return from.travel_deg;
  return std::lerp(from.travel_deg, to.travel_deg, fraction);
}

std::vector<GlossReading> gloss_between(const Paint& from, const Paint& to, double fraction) {
  std::vector<GlossReading> readings;
  for (const GlossReading& reading : from.gloss)
    for (const GlossReading& other : to.gloss)
      if (other.angle_deg == reading.angle_deg)
        readings.push_back({reading.angle_deg, std::lerp(reading.gloss_units, other.gloss_units, fraction)});
  return readings;
}

}  // namespace

AverageColor average_color(const Appearance& appearance) {
  AverageColor average;
  color::Lab sum;
  for (const double angle : kAverageAngles_deg) {
    const color::Lab lab = lab_at(appearance, angle);
    average.L += lab.L / kAverageAngles_deg.size();
    average.chroma += color::chroma(lab) / kAverageAngles_deg.size();
    sum = sum + lab;
  }
  average.hue_deg = color::hue_deg(sum);
  return average;
}

color::Lab tweaked(const color::Lab& lab, const Tweak& tweak) {
  const double turn_rad = tweak.hue_deg * kDegree;
  const double c = tweak.chroma_factor * math::cos(turn_rad);
  const double s = tweak.chroma_factor * math::sin(turn_rad);
  return {lab.L + tweak.lightness, c * lab.a - s * lab.b, s * lab.a + c * lab.b};
}

double face_share(const Appearance& appearance, double aspecular_deg) {
  return std::clamp((appearance.travel_deg - aspecular_deg) / (appearance.travel_deg - kFaceAngle_deg), 0.0, 1.0);
}

bool states_appearance(const Edit& edit) {
  return edit.face || edit.flop || edit.travel_deg;
}

bool moves_color(const Edit& edit) {
  return edit.average_hue_deg || edit.average_chroma || edit.average_lightness || edit.tweak != Tweak() ||
         states_appearance(edit) || edit.face_shift != color::Lab() || edit.flop_shift != color::Lab() ||
         edit.travel_shift_deg != 0 || !edit.readings.empty();
}

bool moves_gloss(const Edit& edit) {
  return edit.gloss || edit.gloss_shift != 0;
}

Result<Edited> edited(const Paint& paint, const Edit& edit) {
  Edited result;
  result.paint = paint;
  if (moves_color(edit)) GONIO_TRY(edit_color(edit, result));
  if (moves_gloss(edit)) edit_gloss(edit, result);
  if (edit.anisotropy) {
    result.paint.anisotropy = edit.anisotropy;
    if (edit.anisotropy->alpha_x == 0 && edit.anisotropy->alpha_y == 0) result.paint.anisotropy.reset();
  }
  if (edit.flakes) {
    result.paint.flakes = edit.flakes;
    if (edit.flakes->coverage == 0) result.paint.flakes.reset();
  }
  return result;
}

bool is_distinct(const Edited& neighbor, const Paint& of) {
  if (!neighbor.skipped.empty()) return false;
  const bool same_gloss =
      std::ranges::equal(neighbor.paint.gloss, of.gloss, {}, &GlossReading::gloss_units, &GlossReading::gloss_units);
  if (!same_gloss)
    return std::ranges::none_of(neighbor.clipped, [](const std::string& c) { return c.starts_with("gloss"); });
  return neighbor.before &&
         (neighbor.before->face != neighbor.after->face || neighbor.before->flop != neighbor.after->flop ||
          neighbor.before->travel_deg != neighbor.after->travel_deg);
}

// The six directions in the a*b* plane stand 60 deg apart from 30 deg on, near the hues of the words they are named by,
// and not along the paint's own hue and chroma: a gray has neither, and still has eight distinct neighbors.
std::vector<Neighbor> neighbors(Variation variation, double step) {
  std::vector<Neighbor> result;
  if (variation == Variation::kFace || variation == Variation::kFlop) {
    const bool is_face = variation == Variation::kFace;
    const auto add = [&](const char* name, const color::Lab& shift) {
      Neighbor neighbor{fmt::format("{}-{}", is_face ? "face" : "flop", name), {}};
      (is_face ? neighbor.edit.face_shift : neighbor.edit.flop_shift) = shift;
      result.push_back(neighbor);
    };
    add("lighter", {step, 0, 0});
    add("darker", {-step, 0, 0});
    constexpr std::array kNames = {"red", "yellow", "green", "cyan", "blue", "magenta"};
    for (std::size_t i = 0; i < kNames.size(); ++i) {
      const double hue_rad = (30 + 60.0 * static_cast<double>(i)) * kDegree;
      add(kNames[i], {0, step * math::cos(hue_rad), step * math::sin(hue_rad)});
    }
    return result;
  }
  const bool is_travel = variation == Variation::kTravel;
  for (const int count : {-4, -3, -2, -1, 1, 2, 3, 4}) {
    Neighbor neighbor{
        fmt::format("{}{}{}", is_travel ? "travel" : "gloss", count > 0 ? "+" : "", shortest(count * step)), {}};
    (is_travel ? neighbor.edit.travel_shift_deg : neighbor.edit.gloss_shift) = count * step;
    result.push_back(neighbor);
  }
  return result;
}

Result<Paint> between(const Paint& from, const Paint& to, double fraction) {
  for (const Paint* paint : {&from, &to})
    if (!has_color(*paint))
      return input_error("paint \"{}\" has neither measured rows nor an appearance: a gradient needs its color",
                         paint->name);
  const color::ViewingCondition a = condition_of(from), b = condition_of(to);
  if (a != b)
    return input_error("paint \"{}\" is stated for {}/{} and \"{}\" for {}/{}: convert one of them first", from.name,
                       a.illuminant, a.observer_deg, to.name, b.illuminant, b.observer_deg);
  GONIO_ASSIGN(const Locus start, locus_of(from));
  GONIO_ASSIGN(const Locus end, locus_of(to));

  Locus locus;
  locus.appearance.face = mixed(start.appearance.face, end.appearance.face, fraction);
  locus.appearance.flop = mixed(start.appearance.flop, end.appearance.flop, fraction);
  locus.appearance.travel_deg = travel_between(start.appearance, end.appearance, fraction);

  Paint paint;
  paint.paint_class = from.paint_class == to.paint_class ? from.paint_class : PaintClass::kUnknown;
  paint.gloss = gloss_between(from, to, fraction);
  if (from.anisotropy && to.anisotropy)
    paint.anisotropy = Anisotropy{std::lerp(from.anisotropy->alpha_x, to.anisotropy->alpha_x, fraction),
                                  std::lerp(from.anisotropy->alpha_y, to.anisotropy->alpha_y, fraction)};
  if (from.flakes && to.flakes)
    paint.flakes = Flakes{std::lerp(from.flakes->diameter_um, to.flakes->diameter_um, fraction),
                          std::lerp(from.flakes->coverage, to.flakes->coverage, fraction),
                          std::lerp(from.flakes->spread_deg, to.flakes->spread_deg, fraction)};
  if (from.measurement && to.measurement) locus.rows = rows_between(*from.measurement, *to.measurement, fraction);
  // Only a measurement states a condition. So a paint without rows gets those of its curve, unless its condition is the
  // default one.
  if (locus.rows.empty() && a != color::ViewingCondition()) locus.rows = rows_of(locus.appearance);
  if (!locus.rows.empty()) paint.measurement = Measurement{a, "", {}};
  put_back(paint, std::move(locus));
  return paint;
}

}  // namespace goniochrome::paint
