#include "fit/internal/target_rows.h"

#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "brdf/lobe_model.h"
#include "fit/paint_fit.h"
#include "math/cosine_power.h"

namespace goniochrome::fit {

namespace {

constexpr double kStep_deg = 5;

// Inferred rows steer the weights between and below the readings without competing with them: all of them together
// weigh about half as much as one reading.
constexpr double kInterpolatedImportance = 0.03;
constexpr double kExtendedImportance = 0.02;

// The view of an in-plane geometry at 45 deg.
double usual_view_deg(double aspecular_deg) {
  return std::abs(45 - aspecular_deg);
}

// Adds the row of `lab` and notes the gamut loss.
void add_row(const color::Lab& lab, const color::Xyz& white, double angle_deg, double view_deg, double importance,
             Target& target) {
  color::Rgb rgb = color::rgb_from_lab(lab, white);
  if (rgb.x < 0 || rgb.y < 0 || rgb.z < 0) {
    for (int c = 0; c < 3; ++c) rgb[c] = std::max(rgb[c], 0.0);
    target.gamut_de00 = std::max(target.gamut_de00, color::delta_e_2000(lab, color::lab_from_rgb(rgb, white)));
  }
  target.rows.push_back({angle_deg, view_deg, rgb, importance, lab.L});
}

// One row per unsigned aspecular angle: readings that share it (45as15 and 45as-15) are averaged and count together.
// Kept apart, the l1 fit could take its red from one and its green from the other.
void add_readings(const color::Xyz& white, bool by_view, Target& target) {
  struct Seen {
    double angle_deg, view_deg;
    color::Lab lab;
    bool with(const Seen& other, bool same_view) const {
      return std::abs(angle_deg - other.angle_deg) <= 1e-6 &&
             (!same_view || std::abs(view_deg - other.view_deg) <= 1e-6);
    }
  };
  std::vector<Seen> sorted;
  for (const paint::LabReading& reading : target.readings)
    sorted.push_back({paint::aspecular_angle_deg(reading.geometry), view_angle_deg(reading.geometry), reading.lab});
  std::ranges::stable_sort(sorted, [&](const Seen& a, const Seen& b) {
    return a.angle_deg != b.angle_deg ? a.angle_deg < b.angle_deg : by_view && a.view_deg < b.view_deg;
  });
  for (auto first = sorted.begin(); first != sorted.end();) {
    const auto last = std::find_if(first, sorted.end(), [&](const Seen& s) { return !s.with(*first, by_view); });
    const auto count = static_cast<double>(last - first);
    color::Lab mean;
    for (auto s = first; s != last; ++s)
      mean = {mean.L + s->lab.L / count, mean.a + s->lab.a / count, mean.b + s->lab.b / count};
    add_row(mean, white, first->angle_deg, first->view_deg, count, target);
    first = last;
  }
}

}  // namespace

double view_angle_deg(const paint::Geometry& geometry) {
  const Vec3 view = paint::directions(geometry).view;
  return std::atan2(std::hypot(view.x, view.y), view.z) / kDegree;
}

double steepest_seen(const std::vector<double>& exponents, double first_rad) {
  double steepest = 0;
  for (const double e : exponents)
    if (math::cos_power(first_rad, e) >= kSeenPart) steepest = std::max(steepest, e);
  return steepest;
}

// Below the first known angle a the color goes on as f(t) = f(a) (cos t / cos a)^e, with the e that the curve has
// between a and b. Every sum of non-negative lobes is convex in the logarithm against u = -log cos t (a sum of
// exponentials of linear functions), so it lies on or above this line: the extension is the least highlight that the
// lobes can have, and it leaves no reason for a sharp lobe with an arbitrary weight.
std::vector<TargetRow> extension_to_specular(const HighlightEnd& end, double steepest, const color::Xyz& white,
                                             double importance) {
  const double cos_a = std::cos(end.a_deg * kDegree), cos_b = std::cos(end.b_deg * kDegree);
  color::Rgb exponent;
  for (int c = 0; c < 3; ++c) {
    if (end.at_a[c] <= end.at_b[c] || cos_b <= 0) continue;
    exponent[c] =
        end.at_b[c] > 0 ? std::min(steepest, std::log(end.at_a[c] / end.at_b[c]) / std::log(cos_a / cos_b)) : steepest;
  }
  std::vector<TargetRow> rows;
  for (double t = 0; t < end.a_deg - kStep_deg / 2; t += kStep_deg) {
    TargetRow row = {t, usual_view_deg(t), end.at_a, importance, 0};
    for (int c = 0; c < 3; ++c) row.reflectance_factor[c] *= std::pow(std::cos(t * kDegree) / cos_a, exponent[c]);
    row.lightness = color::lab_from_rgb(row.reflectance_factor, white).L;
    rows.push_back(row);
  }
  return rows;
}

Result<Target> target_rows(const paint::Paint& paint, paint::TargetCurve::Kind kind, const color::Xyz& white,
                           const std::vector<double>& exponents, bool by_view) {
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

  std::vector<double> known;
  for (const paint::LabReading& reading : target.readings)
    known.push_back(paint::aspecular_angle_deg(reading.geometry));
  const auto [first, last] = std::minmax_element(known.begin(), known.end());
  const bool is_curve = kind == paint::TargetCurve::Kind::kCurve;
  if (!is_curve) add_readings(white, by_view, target);
  target.first_deg = is_curve ? paint::kFaceAngle_deg : *first;
  const double end_deg = is_curve ? std::max(*last, 110.0) : *last;
  for (double t = target.first_deg; t <= end_deg; t += kStep_deg) {
    const bool near_known =
        std::any_of(known.begin(), known.end(), [&](double k) { return std::abs(k - t) < kStep_deg / 2; });
    if (is_curve || !near_known)
      add_row(curve.at(t), white, t, usual_view_deg(t), is_curve ? 1 : kInterpolatedImportance, target);
  }

  HighlightEnd end{target.first_deg, target.first_deg + 10, {}, {}};
  const auto color_at = [&](double angle_deg) {
    color::Rgb rgb = color::rgb_from_lab(curve.at(angle_deg), white);
    for (int c = 0; c < 3; ++c) rgb[c] = std::max(rgb[c], 0.0);
    return rgb;
  };
  end.at_a = color_at(end.a_deg), end.at_b = color_at(end.b_deg);
  std::ranges::move(
      extension_to_specular(end, steepest_seen(exponents, target.first_deg * kDegree), white, kExtendedImportance),
      std::back_inserter(target.rows));
  return target;
}

}  // namespace goniochrome::fit
