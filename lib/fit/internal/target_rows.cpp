#include "fit/internal/target_rows.h"

#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "brdf/lobe_model.h"
#include "fit/internal/color_floor.h"
#include "math/elementary.h"

namespace goniochrome::fit {

namespace {

constexpr double kStep_deg = 5;

// Inferred rows steer the weights between and below the readings. The few ones below the first reading must not bend
// what is between readings. Among the weights by which a search for the paint of a picture finds its way, these predict
// left-out readings best, at no loss at the others: goniochrome-fitting(7), "FITTING".
constexpr double kInterpolatedImportance = 0.1;
constexpr double kExtendedImportance = 0.007;

// The view of an in-plane geometry at 45 deg.
double usual_view_deg(double aspecular_deg) {
  return std::abs(45 - aspecular_deg);
}

double usual_passages(double aspecular_deg, double coat_index) {
  return brdf::coat_passages(coat_index, math::cos(45 * kDegree), math::cos(usual_view_deg(aspecular_deg) * kDegree));
}

// The color of the base of which a coat leaves `lab`.
color::Lab base_lab(const color::Lab& lab, double passages, const color::Xyz& white) {
  return passages == 1 ? lab : color::lab_from_rgb((1 / passages) * color::rgb_from_lab(lab, white), white);
}

// Adds the row of the base's color, `lightness` being that of what is seen, and notes the gamut loss.
void add_row(const color::Lab& base, const color::Xyz& white, TargetRow row, Target& target) {
  const color::Rgb rgb = color::rgb_from_lab(base, white), seen = row.passages * rgb;
  const color::Lab lab = row.passages == 1 ? base : color::lab_from_rgb(seen, white);
  target.gamut_de00 = std::max(target.gamut_de00, gamut_loss(lab, seen, white));
  row.reflectance_factor = non_negative(rgb);
  target.rows.push_back(row);
}

color::Lab mean_of(const std::vector<color::Lab>& colors) {
  const auto count = static_cast<double>(colors.size());
  color::Lab mean;
  for (const color::Lab& lab : colors) mean = {mean.L + lab.L / count, mean.a + lab.a / count, mean.b + lab.b / count};
  return mean;
}

// One row per unsigned aspecular angle: readings that share it (45as15 and 45as-15) are averaged and count together.
// Kept apart, the l1 fit could take its red from one and its green from the other.
void add_readings(const color::Xyz& white, double coat_index, bool by_view, Target& target) {
  struct Seen {
    double angle_deg, view_deg, passages;
    color::Lab lab;
    bool with(const Seen& other, bool same_view) const {
      return std::abs(angle_deg - other.angle_deg) <= 1e-6 &&
             (!same_view || std::abs(view_deg - other.view_deg) <= 1e-6);
    }
  };
  std::vector<Seen> sorted;
  for (const paint::LabReading& reading : target.readings)
    sorted.push_back({paint::aspecular_angle_deg(reading.geometry), view_angle_deg(reading.geometry),
                      coat_passages_at(reading.geometry, coat_index), reading.lab});
  std::ranges::stable_sort(sorted, [&](const Seen& a, const Seen& b) {
    return a.angle_deg != b.angle_deg ? a.angle_deg < b.angle_deg : by_view && a.view_deg < b.view_deg;
  });
  for (auto first = sorted.begin(); first != sorted.end();) {
    const auto last = std::find_if(first, sorted.end(), [&](const Seen& s) { return !s.with(*first, by_view); });
    std::vector<color::Lab> same, base;
    double passages = 0;
    for (auto seen = first; seen != last; ++seen) {
      same.push_back(seen->lab), base.push_back(base_lab(seen->lab, seen->passages, white));
      passages += seen->passages / static_cast<double>(last - first);
    }
    add_row(mean_of(base), white,
            {first->angle_deg, first->view_deg, {}, static_cast<double>(same.size()), mean_of(same).L, passages},
            target);
    first = last;
  }
}

// The channel of the base that grows most from a smaller aspecular angle to that of `at`, or from there to a larger
// one, and by which part of itself it grows. Sums of lobes never grow so.
std::pair<int, double> steepest_rise(const std::vector<paint::LabReading>& readings, const paint::LabReading& at,
                                     const color::Xyz& white, double coat_index) {
  std::pair<int, double> most = {0, 0};
  const double angle = paint::aspecular_angle_deg(at.geometry);
  const auto base = [&](const paint::LabReading& reading) {
    return (1 / coat_passages_at(reading.geometry, coat_index)) * color::rgb_from_lab(reading.lab, white);
  };
  const color::Rgb here = base(at);
  for (const paint::LabReading& other : readings) {
    const double step = paint::aspecular_angle_deg(other.geometry) - angle;
    const color::Rgb there = base(other);
    for (int c = 0; c < 3; ++c) {
      const double low = step > 0 ? here[c] : there[c], high = step > 0 ? there[c] : here[c];
      if (std::abs(step) > 0.5 && low > 0 && high / low - 1 > most.second) most = {c, high / low - 1};
    }
  }
  return most;
}

}  // namespace

double view_angle_deg(const paint::Geometry& geometry) {
  const Vec3 view = paint::directions(geometry).view;
  return math::atan2(math::hypot(view.x, view.y), view.z) / kDegree;
}

double named_view_deg(const paint::Geometry& geometry) {
  return std::round(1e6 * view_angle_deg(geometry)) / 1e6;
}

double coat_passages_at(const paint::Geometry& geometry, double coat_index) {
  const paint::DirectionPair at = paint::directions(geometry);
  return brdf::coat_passages(coat_index, std::clamp(at.light.z, 0.0, 1.0), std::clamp(at.view.z, 0.0, 1.0));
}

FlakeReading flake_reading(const paint::LabReading& reading, double coat_index) {
  return {{paint::aspecular_angle_deg(reading.geometry) * kDegree, view_angle_deg(reading.geometry)},
          reading.lab,
          coat_passages_at(reading.geometry, coat_index)};
}

double gamut_loss(const color::Lab& lab, const color::Rgb& rgb, const color::Xyz& white) {
  const color::Rgb shown = non_negative(rgb);
  return shown == rgb ? 0 : color::delta_e_2000(lab, color::lab_from_rgb(shown, white));
}

FlakeRow flake_row(const TargetRow& row, const FitOptions& options, bool inferred) {
  return {{row.angle_deg * kDegree, row.view_deg},
          row.reflectance_factor,
          row.importance * row.passages * (options.perceptual_weights ? color::lightness_slope(row.lightness) : 1),
          inferred};
}

std::vector<TargetRow> extension_to_specular(const HighlightEnd& end, double steepest, const color::Xyz& white,
                                             double importance, double coat_index) {
  const color::Rgb exponents = highlight_exponents(end, steepest);
  std::vector<TargetRow> rows;
  for (double t = 0; t < end.a_deg - kStep_deg / 2; t += kStep_deg) {
    TargetRow row = {t, usual_view_deg(t), highlight_at(end, exponents, t), importance, 0};
    row.passages = usual_passages(t, coat_index);
    row.lightness = color::lab_from_rgb(row.passages * row.reflectance_factor, white).L;
    rows.push_back(row);
  }
  return rows;
}

Result<Target> target_rows(const paint::Paint& paint, paint::TargetCurve::Kind kind, const color::Xyz& white,
                           const std::vector<double>& exponents, double coat_index, bool by_view) {
  // The readings beyond glare, or what a designed paint would read.
  Target target;
  if (paint.measurement) {
    for (const paint::LabReading& reading : paint.measurement->rows) {
      if (paint::aspecular_angle_deg(reading.geometry) < kGlareAngle_deg)
        ++target.glare_rows;
      else
        target.readings.push_back(reading);
    }
  }
  GONIO_ASSIGN(const paint::TargetCurve curve, paint::TargetCurve::make(paint, kind));
  if (target.readings.empty()) {
    if (!paint.appearance) return input_error("no reading at {} deg or more from specular", kGlareAngle_deg);
    for (const double angle : {15.0, 45.0, 110.0})
      target.readings.push_back({{.aspecular_deg = angle}, paint::lab_at(*paint.appearance, angle)});
  }

  // The rows that are known, and those of the curve between them.
  std::vector<double> known;
  for (const paint::LabReading& reading : target.readings)
    known.push_back(paint::aspecular_angle_deg(reading.geometry));
  const auto [first, last] = std::minmax_element(known.begin(), known.end());
  const bool is_curve = kind == paint::TargetCurve::Kind::kCurve;
  if (!is_curve) add_readings(white, coat_index, by_view, target);
  target.first_deg = is_curve ? paint::kFaceAngle_deg : *first;
  const double end_deg = is_curve ? std::max(*last, 110.0) : *last;
  for (double t = target.first_deg; t <= end_deg; t += kStep_deg) {
    const bool near_known =
        std::any_of(known.begin(), known.end(), [&](double k) { return std::abs(k - t) < kStep_deg / 2; });
    if (!is_curve && near_known) continue;
    const color::Lab lab = curve.at(t);
    const double passages = usual_passages(t, coat_index);
    add_row(base_lab(lab, passages, white), white,
            {t, usual_view_deg(t), {}, is_curve ? 1 : kInterpolatedImportance, lab.L, passages}, target);
  }

  // The rows toward specular.
  const auto color_at = [&](double angle_deg) {
    const double passages = usual_passages(angle_deg, coat_index);
    return (1 / passages) * non_negative(color::rgb_from_lab(curve.at(angle_deg), white));
  };
  const double a_deg = target.first_deg, b_deg = target.first_deg + 10;
  const HighlightEnd end{a_deg, b_deg, color_at(a_deg), color_at(b_deg)};
  std::ranges::move(extension_to_specular(end, steepest_seen(exponents, target.first_deg * kDegree), white,
                                          kExtendedImportance, coat_index),
                    std::back_inserter(target.rows));
  return target;
}

Twins twins_of(const std::vector<paint::LabReading>& readings) {
  constexpr double kSame_deg = 1e-6;
  Twins twins;
  std::vector<char> taken(readings.size(), 0);
  for (std::size_t i = 0; i < readings.size(); ++i) {
    const double angle = paint::aspecular_angle_deg(readings[i].geometry);
    std::vector<const paint::LabReading*> same;
    for (std::size_t k = i; k < readings.size(); ++k)
      if (!taken[k] && std::abs(paint::aspecular_angle_deg(readings[k].geometry) - angle) <= kSame_deg)
        same.push_back(&readings[k]), taken[k] = 1;
    double apart = 0;
    const auto note_view = [&](const paint::LabReading& reading) {
      twins.views_deg.push_back(named_view_deg(reading.geometry));
    };
    for (std::size_t m = 0; m < same.size(); ++m)
      for (std::size_t n = m + 1; n < same.size(); ++n) {
        const double de00 = color::delta_e_2000(same[m]->lab, same[n]->lab);
        apart = std::max(apart, de00);
        if (de00 > kVisible_de00) note_view(*same[m]), note_view(*same[n]);
      }
    twins.apart_de00 = std::max(twins.apart_de00, apart);
    if (apart == 0) continue;
    std::vector<color::Lab> colors;
    for (const paint::LabReading* reading : same) colors.push_back(reading->lab);
    const ColorFloor floor = color_floor(colors, apart);
    twins.sum_de00 += floor.sum_de00;
    twins.largest_de00.push_back(floor.largest_de00);
  }
  std::ranges::sort(twins.views_deg);
  twins.views_deg.erase(std::ranges::unique(twins.views_deg).begin(), twins.views_deg.end());
  return twins;
}

std::string fit_limit(const std::vector<paint::LabReading>& readings, const std::vector<GeometryError>& errors,
                      const color::Xyz& white, double coat_index, bool by_view) {
  const auto worst = std::ranges::max_element(errors, {}, &GeometryError::de00) - errors.begin();
  const paint::LabReading& reading = readings[static_cast<std::size_t>(worst)];
  const double error = errors[static_cast<std::size_t>(worst)].de00,
               angle = paint::aspecular_angle_deg(reading.geometry);
  const double outside = gamut_loss(reading.lab, color::rgb_from_lab(reading.lab, white), white);
  if (outside >= error / 2) return fmt::format("outside the working space by dE00 {:.2f}", outside);
  double apart = 0;
  for (const paint::LabReading& other : readings)
    if (std::abs(paint::aspecular_angle_deg(other.geometry) - angle) < 0.5)
      apart = std::max(apart, color::delta_e_2000(other.lab, reading.lab));
  if (!by_view && apart >= error) return fmt::format("its two sides of specular differ by dE00 {:.2f}", apart);
  constexpr double kClearRise = 0.02;
  const auto [channel, rise] = steepest_rise(readings, reading, white, coat_index);
  constexpr const char* kChannels[] = {"red", "green", "blue"};
  if (rise > kClearRise)
    return fmt::format("its {}{} grows by {:.0f} % away from specular, which no lobes do", kChannels[channel],
                       coat_index == paint::kNoCoat ? "" : " under the coat", 100 * rise);
  return "";
}

}  // namespace goniochrome::fit
