#include "fit/target_rows.h"

#include <algorithm>
#include <cmath>

#include "brdf/lobe_model.h"
#include "fit/paint_fit.h"

namespace goniochrome {

namespace {

constexpr double kStep_deg = 5;
constexpr double kRadian = M_PI / 180;

// Inferred rows steer the weights between and below the readings without competing with them: all of them together
// weigh about half as much as one reading.
constexpr double kInterpolatedImportance = 0.03;
constexpr double kExtendedImportance = 0.02;

// Adds the row of `lab` and notes the gamut loss.
void add_row(const Lab& lab, const Xyz& white, double angle_deg, double importance, Target& target) {
  Rgb rgb = rgb_from_lab(lab, white);
  if (rgb.x < 0 || rgb.y < 0 || rgb.z < 0) {
    for (int c = 0; c < 3; ++c) rgb[c] = std::max(rgb[c], 0.0);
    target.gamut_de00 = std::max(target.gamut_de00, delta_e_2000(lab, lab_from_rgb(rgb, white)));
  }
  target.rows.push_back({angle_deg, rgb, importance, lab.L});
}

// One row per unsigned aspecular angle: readings that share it (45as15 and 45as-15) are averaged and count together.
// Kept apart, the l1 fit could take its red from one and its green from the other.
void add_readings(const Xyz& white, Target& target) {
  std::vector<std::pair<double, Lab>> sorted;
  for (const LabReading& reading : target.readings)
    sorted.emplace_back(aspecular_angle_deg(reading.geometry), reading.lab);
  std::ranges::stable_sort(sorted, {}, &std::pair<double, Lab>::first);
  for (auto first = sorted.begin(); first != sorted.end();) {
    const auto last = std::find_if(first, sorted.end(), [&](const auto& r) { return r.first > first->first + 1e-6; });
    const auto count = static_cast<double>(last - first);
    Lab mean;
    for (auto r = first; r != last; ++r)
      mean = {mean.L + r->second.L / count, mean.a + r->second.a / count, mean.b + r->second.b / count};
    add_row(mean, white, first->first, count, target);
    first = last;
  }
}

// Below the first known angle a the color goes on as f(t) = f(a) (cos t / cos a)^e, with the e that the curve has
// between a and a + 10 deg. Every sum of non-negative lobes is convex in the logarithm against u = -log cos t (a sum of
// exponentials of linear functions), so it lies on or above this line: the extension is the least highlight that the
// lobes can have, and it leaves no reason for a sharp lobe with an arbitrary weight.
void extend_to_specular(const TargetCurve& curve, const Xyz& white, double steepest, Target& target) {
  const double a = target.first_deg, b = a + 10;
  const double cos_a = std::cos(a * kRadian), cos_b = std::cos(b * kRadian);
  const Rgb at_a = rgb_from_lab(curve.at(a), white), at_b = rgb_from_lab(curve.at(b), white);
  Rgb start, exponent;
  for (int c = 0; c < 3; ++c) {
    start[c] = std::max(at_a[c], 0.0);
    if (start[c] <= at_b[c] || cos_b <= 0) continue;
    exponent[c] = at_b[c] > 0 ? std::min(steepest, std::log(at_a[c] / at_b[c]) / std::log(cos_a / cos_b)) : steepest;
  }
  for (double t = 0; t < a - kStep_deg / 2; t += kStep_deg) {
    TargetRow row = {t, start, kExtendedImportance, 0};
    for (int c = 0; c < 3; ++c) row.reflectance_factor[c] *= std::pow(std::cos(t * kRadian) / cos_a, exponent[c]);
    row.lightness = lab_from_rgb(row.reflectance_factor, white).L;
    target.rows.push_back(row);
  }
}

}  // namespace

Result<Target> target_rows(const Paint& paint, TargetCurve::Kind kind, const Xyz& white,
                           const std::vector<double>& exponents) {
  Target target;
  if (paint.measurement) {
    for (const LabReading& reading : paint.measurement->rows) {
      if (aspecular_angle_deg(reading.geometry) < kGlareAngle_deg)
        ++target.glare_rows;
      else
        target.readings.push_back(reading);
    }
  }
  GONIO_ASSIGN(const TargetCurve curve, TargetCurve::make(paint, kind));
  if (target.readings.empty()) {
    if (!paint.appearance) return input_error("no reading at {} deg or more from specular", kGlareAngle_deg);
    for (const double angle : {15.0, 45.0, 110.0})
      target.readings.push_back({{.aspecular_deg = angle}, lab_at(*paint.appearance, angle)});
  }

  std::vector<double> known;
  for (const LabReading& reading : target.readings) known.push_back(aspecular_angle_deg(reading.geometry));
  const auto [first, last] = std::minmax_element(known.begin(), known.end());
  const bool is_curve = kind == TargetCurve::Kind::kCurve;
  if (!is_curve) add_readings(white, target);
  target.first_deg = is_curve ? kFaceAngle_deg : *first;
  const double end_deg = is_curve ? std::max(*last, 110.0) : *last;
  for (double t = target.first_deg; t <= end_deg; t += kStep_deg) {
    const bool near_known =
        std::any_of(known.begin(), known.end(), [&](double k) { return std::abs(k - t) < kStep_deg / 2; });
    if (is_curve || !near_known) add_row(curve.at(t), white, t, is_curve ? 1 : kInterpolatedImportance, target);
  }

  double steepest = 0;
  for (const double e : exponents)
    if (cos_power(target.first_deg * kRadian, e) >= kSeenPart) steepest = std::max(steepest, e);
  extend_to_specular(curve, white, steepest, target);
  return target;
}

}  // namespace goniochrome
