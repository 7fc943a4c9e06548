// Angles that no reading saw: each reading at 25, 45 and 75 deg in turn is left out, and the color there is predicted
// from the others, by the measured curve and by lobes that were fitted without it. The truth is the reading itself.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <functional>

#include "brdf/lobe_model.h"
#include "fit/paint_fit.h"
#include "formats/csv.h"
#include "math/statistics.h"
#include "paint/curve.h"

namespace goniochrome::fit::held_out_angles_test {
namespace {

const formats::Basis kBasis = {"b7", {1.3, 6, 20, 70, 250, 900, 3000}, true};
constexpr std::array kLeftOut_deg = {25.0, 45.0, 75.0};

std::vector<paint::Paint> paints_of(const std::string& name) {
  std::vector<paint::Paint> paints;
  auto reader = formats::CsvPaintReader::open(std::getenv("GONIOCHROME_DATA") + ("/lab/" + name));
  EXPECT_TRUE(reader.ok());
  while (reader.ok()) {
    auto paint = reader->next();
    EXPECT_TRUE(paint.ok());
    if (!paint.ok() || !*paint) break;
    paints.push_back(**paint);
  }
  return paints;
}

using Predictor = std::function<color::Lab(const paint::Paint&, double angle_deg)>;

// The color differences of all readings that were left out, or of those of every second paint.
enum class Which { kAll, kEven, kOdd };
std::vector<double> errors_of(const std::vector<paint::Paint>& paints, const Predictor& predicted,
                              Which which = Which::kAll) {
  std::vector<double> errors;
  for (std::size_t i = 0; i < paints.size(); ++i) {
    if (which != Which::kAll && (i % 2 == 0) != (which == Which::kEven)) continue;
    for (const double angle : kLeftOut_deg) {
      paint::Paint others = paints[i];
      std::vector<paint::LabReading>& rows = others.measurement->rows;
      const auto left_out =
          std::ranges::find_if(rows, [&](const auto& r) { return r.geometry.aspecular_deg == angle; });
      const color::Lab truth = left_out->lab;
      rows.erase(left_out);
      errors.push_back(color::delta_e_2000(truth, predicted(others, angle)));
    }
  }
  return errors;
}

// The monotone cubic in another function of the angle: the measured curve of a paint whose readings are moved to where
// that function puts them on the axis of the curve.
Predictor cubic_in(const std::function<double(double angle_deg)>& place) {
  return [=](const paint::Paint& paint, double angle_deg) {
    const auto moved = [&](double angle) { return paint::angle_of_place_deg(place(angle)); };
    paint::Paint other = paint;
    for (paint::LabReading& row : other.measurement->rows)
      row.geometry = {.aspecular_deg = moved(std::abs(row.geometry.aspecular_deg))};
    return paint::TargetCurve::make(other, paint::TargetCurve::Kind::kMeasured)->at(moved(angle_deg));
  };
}

color::Lab by_curve(const paint::Paint& paint, double angle_deg) {
  return paint::TargetCurve::make(paint, paint::TargetCurve::Kind::kMeasured)->at(angle_deg);
}

Predictor by_lobes(FitMethod method) {
  return [=](const paint::Paint& paint, double angle_deg) {
    const auto fit = PaintFitter(kBasis, {.method = method}).fit(paint);
    EXPECT_TRUE(fit.ok());
    const color::Xyz white = *color::white_point(paint::condition_of(paint));
    return color::lab_from_rgb(brdf::flake_reflectance_factor(fit->lobes, angle_deg), white);
  };
}

// Readings of which the angle itself moves evenly to its place. The scale keeps moved angles within 0..180 deg.
double by_angle(double angle_deg) {
  return 2 + angle_deg / 60;
}

// The curve by place against the same curve by angle, on both tables and on both halves of the larger one: 80
// reconstructed materials, from whose 37 paints and wraps and 43 others the offset of the place was chosen, and ten
// measured ones. On each of them the mean falls by a tenth at least; it fell by 17, 33, 20 and 14 %.
TEST(HeldOutAngles, TheCurveByPlacePredictsBetterRealData) {
  if (!std::getenv("GONIOCHROME_DATA")) GTEST_SKIP() << "GONIOCHROME_DATA is not set";
  const struct {
    const char* name;
    Which which;
  } sets[] = {{"reconstructed-multiangle.csv", Which::kAll},
              {"measured-multiangle.csv", Which::kAll},
              {"reconstructed-multiangle.csv", Which::kEven},
              {"reconstructed-multiangle.csv", Which::kOdd}};
  for (const auto& [name, which] : sets) {
    const std::vector<paint::Paint> paints = paints_of(name);
    const auto place = errors_of(paints, by_curve, which), angle = errors_of(paints, cubic_in(by_angle), which);
    std::printf("%-30s %3zu readings: by angle %.2f mean %.2f p95, by place %.2f %.2f\n", name, place.size(),
                math::mean(angle), math::percentile_95(angle), math::mean(place), math::percentile_95(place));
    EXPECT_LT(math::mean(place), 0.9 * math::mean(angle)) << name;
    EXPECT_LT(math::percentile_95(place), math::percentile_95(angle)) << name;
  }
}

// An offset that is chosen on half of the paints serves the other half: no other one of these is better there by more
// than 3 % of the mean.
TEST(HeldOutAngles, TheOffsetServesPaintsThatItWasNotChosenOnRealData) {
  if (!std::getenv("GONIOCHROME_DATA")) GTEST_SKIP() << "GONIOCHROME_DATA is not set";
  const std::vector<paint::Paint> paints = paints_of("reconstructed-multiangle.csv");
  const auto with_offset = [](double offset_deg) {
    return cubic_in([=](double angle_deg) { return std::log(angle_deg + offset_deg); });
  };
  for (const Which which : {Which::kEven, Which::kOdd}) {
    const double chosen = math::mean(errors_of(paints, by_curve, which));
    for (const double offset_deg : {5.0, 8.0, 12.0, 20.0, 40.0})
      EXPECT_LT(chosen, 1.03 * math::mean(errors_of(paints, with_offset(offset_deg), which))) << offset_deg;
    // The control: far away the logarithm is a straight line.
    EXPECT_LT(chosen, 0.95 * math::mean(errors_of(paints, with_offset(150), which)));
  }
}

// Lobes between readings follow the curve. `before` is what they erred by while the curve was a cubic of the angle, a
// row of it had 3 % of the weight of a reading, and a row toward specular 2 %: mean and 95th percentile by each method.
TEST(HeldOutAngles, LobesFollowTheCurveRealData) {
  if (!std::getenv("GONIOCHROME_DATA")) GTEST_SKIP() << "GONIOCHROME_DATA is not set";
  const struct {
    const char* name;
    FitMethod method;
    double mean_before, p95_before;
  } cases[] = {{"reconstructed-multiangle.csv", FitMethod::kL1, 3.06, 10.93},
               {"reconstructed-multiangle.csv", FitMethod::kL2, 2.98, 11.13},
               {"reconstructed-multiangle.csv", FitMethod::kDeltaE, 3.22, 12.18},
               {"measured-multiangle.csv", FitMethod::kL1, 3.16, 8.60},
               {"measured-multiangle.csv", FitMethod::kL2, 3.03, 8.62},
               {"measured-multiangle.csv", FitMethod::kDeltaE, 3.77, 13.17}};
  for (const auto& [name, method, mean_before, p95_before] : cases) {
    const auto errors = errors_of(paints_of(name), by_lobes(method));
    std::printf("%-30s %-6s %.2f mean %.2f p95\n", name, fit_method_name(method), math::mean(errors),
                math::percentile_95(errors));
    EXPECT_LT(math::mean(errors), 0.8 * mean_before) << name << fit_method_name(method);
    EXPECT_LT(math::percentile_95(errors), 0.8 * p95_before) << name << fit_method_name(method);
  }
}

}  // namespace
}  // namespace goniochrome::fit::held_out_angles_test
