#include "fit/color_map_fit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>

#include "base/angles.h"
#include "base/random_for_test.h"
#include "base/scratch_for_test.h"
#include "color/spectrum.h"

namespace goniochrome::fit::color_map_fit_test {
namespace {

constexpr std::array kTreatments = {brdf::CriticalAngle::kClip, brdf::CriticalAngle::kSlide,
                                    brdf::CriticalAngle::kSlideMap, brdf::CriticalAngle::kIndexOne};

Vec3 direction(double polar_rad, double azimuth_rad) {
  return {std::sin(polar_rad) * std::cos(azimuth_rad), std::sin(polar_rad) * std::sin(azimuth_rad),
          std::cos(polar_rad)};
}

color::Xyz white() {
  return *color::white_point({"D65", 10});
}

// A flake paint whose color is a function of its two flake angles alone, smooth in both.
color::Lab flake_paint(const Vec3& wi, const Vec3& wo) {
  const brdf::FlakeAngles f = brdf::flake_angles(wi, wo, 1.5);
  const double flop = std::exp(-std::pow(f.flake_rad / 0.25, 2));
  const double hue = 1 + 2 * f.incidence_rad;
  return {20 + 60 * flop, 40 * std::cos(hue), 40 * std::sin(hue)};
}

std::vector<ColorMapRow> in_plane_rows(double step_deg) {
  std::vector<ColorMapRow> rows;
  for (double light = step_deg; light <= 75; light += step_deg)
    for (double view = -75; view <= 75; view += step_deg) {
      const Vec3 wi = direction(light * kDegree, 0), wo = direction(view * kDegree, 0);
      rows.push_back({wi, wo, flake_paint(wi, wo)});
    }
  return rows;
}

TEST(ColorMapFit, OutOfPlaneFollowsFromInPlane) {
  double last = 1e9;
  for (const double step_deg : {15.0, 7.5, 5.0}) {
    const auto fit = fit_color_map(in_plane_rows(step_deg), white(), {256, 1.5});
    ASSERT_TRUE(fit.ok());
    double mean = 0;
    int count = 0;
    for (double light = 8; light < 70; light += 7)
      for (double view = 8; view < 70; view += 7)
        for (double azimuth = 20; azimuth < 180; azimuth += 23) {
          const Vec3 wi = direction(light * kDegree, 0), wo = direction(view * kDegree, azimuth * kDegree);
          const brdf::FlakeAngles f = brdf::flake_angles(wi, wo, 1.5);
          const double steepest = std::asin(1 / 1.5) - f.flake_rad - f.incidence_rad;
          if (steepest < 0.02 || paint::aspecular_angle_rad(wi, wo, {0, 0, 1}) < 12 * kDegree) continue;
          const color::Rgb got = brdf::reflectance_factor(fit->map, wi, wo, brdf::CriticalAngle::kClip);
          mean += color::delta_e_76(color::lab_from_rgb(got, white()), flake_paint(wi, wo));
          ++count;
        }
    mean /= count;
    EXPECT_GT(count, 100);
    EXPECT_LT(mean, last) << step_deg;  // finer rows, better map
    last = mean;
  }
  EXPECT_LT(last, 0.5);
}

TEST(ColorMapFit, PassesThroughItsRowsAndIsReciprocal) {
  const auto rows = in_plane_rows(15);
  const auto fit = fit_color_map(rows, white(), {512, 1.5});
  ASSERT_TRUE(fit.ok());
  EXPECT_GT(fit->glare_rows, 0);
  EXPECT_EQ(fit->grazing_rows, 0);
  double worst = 0;
  for (const ColorMapRow& row : rows) {
    if (paint::aspecular_angle_rad(row.light, row.view, {0, 0, 1}) < 10 * kDegree) continue;
    if (std::max(row.light.z, row.view.z) > 0.99) continue;  // the map is coarse in angle next to the normal
    const color::Rgb got = brdf::reflectance_factor(fit->map, row.light, row.view, brdf::CriticalAngle::kClip);
    const color::Rgb back = brdf::reflectance_factor(fit->map, row.view, row.light, brdf::CriticalAngle::kClip);
    worst = std::max(worst, color::delta_e_76(color::lab_from_rgb(got, white()), row.lab));
    EXPECT_NEAR(got.y, back.y, 1e-12);
  }
  EXPECT_LT(worst, 0.5);  // halves of texels of 1/512 in the cosine
}

TEST(ColorMapFit, TellsWhatItCannotUse) {
  std::vector<ColorMapRow> one_light;
  for (const double view : {-30.0, -20.0, 0.0, 20.0, 65.0})
    one_light.push_back({direction(45 * kDegree, 0), direction(view * kDegree, 0), {50, 0, 0}});
  // One light and several viewers still have different angles on the flakes.
  EXPECT_TRUE(fit_color_map(one_light, white(), {}).ok());
  one_light.resize(3);
  const auto refused = fit_color_map(one_light, white(), {});
  ASSERT_FALSE(refused.ok());
  EXPECT_NE(refused.error().message.find("here are 3"), std::string::npos) << refused.error().message;
  EXPECT_FALSE(fit_color_map(std::vector<ColorMapRow>{}, white(), {}).ok());
}

TEST(ColorMapFit, ColorsOutsideTheWorkingSpaceAreKeptAndCounted) {
  std::vector<ColorMapRow> rows = in_plane_rows(15);
  for (ColorMapRow& row : rows) row.lab = {30, -150, 40};  // no color of any display
  const auto fit = fit_color_map(rows, white(), {16, 1.5});
  ASSERT_TRUE(fit.ok());
  EXPECT_EQ(fit->negative_share, 1);
  const color::Lab back = color::lab_from_rgb(brdf::fetched(fit->map, {8, 8}), white());
  EXPECT_LT(color::delta_e_76(back, {30, -150, 40}), 1e-3);  // rounding to float
}

// The color of an opaque pigmented coat: a function of the aspecular angle in air.
color::Lab near_matt_paint(const Vec3& wi, const Vec3& wo) {
  const double angle_deg = paint::aspecular_angle_rad(wi, wo, {0, 0, 1}) / kDegree, t = std::exp(-angle_deg / 25);
  return {30 + 50 * t, 40 - 30 * t, 10 + 20 * t};
}

double mean_out_of_plane_de76(const brdf::ColorMap& map, color::Lab (*paint)(const Vec3&, const Vec3&)) {
  double sum = 0;
  int count = 0;
  for (double light = 8; light < 70; light += 7)
    for (double view = 8; view < 70; view += 7)
      for (double azimuth = 20; azimuth < 180; azimuth += 23) {
        const Vec3 wi = direction(light * kDegree, 0), wo = direction(view * kDegree, azimuth * kDegree);
        if (paint::aspecular_angle_rad(wi, wo, {0, 0, 1}) < 12 * kDegree) continue;
        const color::Rgb got = brdf::reflectance_factor(map, wi, wo, brdf::CriticalAngle::kSlide);
        sum += color::delta_e_76(color::lab_from_rgb(got, white()), paint(wi, wo));
        ++count;
      }
  return sum / count;
}

// A map of the aspecular angle where that tells the color, and a map of isolines where they do. The control forces the
// other model on each.
TEST(ColorMapFit, TheModelThatPredictsHeldOutRowsBetterIsTaken) {
  std::vector<ColorMapRow> rows = in_plane_rows(10);
  const auto flakes = fit_color_map(rows, white(), {});
  ASSERT_TRUE(flakes.ok());
  EXPECT_FALSE(flakes->map.aspecular);
  EXPECT_LT(flakes->isolines_de76, 0.5 * flakes->aspecular_de76);
  for (ColorMapRow& row : rows) row.lab = near_matt_paint(row.light, row.view);
  const auto matt = fit_color_map(rows, white(), {}),
             forced = fit_color_map(rows, white(), {128, 1.5, ColorMapModel::kIsolines});
  ASSERT_TRUE(matt.ok() && forced.ok());
  EXPECT_TRUE(matt->map.aspecular);
  EXPECT_FALSE(forced->map.aspecular);
  EXPECT_EQ(matt->held_out_de76, matt->aspecular_de76);
  const double ours = mean_out_of_plane_de76(matt->map, near_matt_paint),
               control = mean_out_of_plane_de76(forced->map, near_matt_paint);
  EXPECT_LT(ours, 0.3);
  EXPECT_GT(control, 3 * ours);
  // Reciprocal, and the same whatever the treatment of the critical angle is.
  const Vec3 wi = direction(1.1, 0), wo = direction(1.2, 1.9);
  const color::Rgb there = brdf::reflectance_factor(matt->map, wi, wo, brdf::CriticalAngle::kClip),
                   back = brdf::reflectance_factor(matt->map, wo, wi, brdf::CriticalAngle::kIndexOne);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(there[c], back[c], 1e-9);
}

// Rows with errors of their own are told by their neighbors less, and then a smaller power is closer to the paint
// beside the plane, where nothing was read. Rows without errors keep the smoothest map. The controls force the other
// power.
TEST(ColorMapFit, RowsWithErrorsGetASmallerPower) {
  const auto fitted = [](const std::vector<ColorMapRow>& rows, std::optional<double> power) {
    return *fit_color_map(rows, white(), {128, 1.5, ColorMapModel::kIsolines, power});
  };
  TestNumbers next(5);
  std::vector<ColorMapRow> rows = in_plane_rows(7.5);
  const ColorMapFit smooth = fitted(rows, {}), forced = fitted(rows, 0.5);
  EXPECT_EQ(smooth.isolines_power, 1);
  EXPECT_LT(smooth.isolines_de76, forced.isolines_de76);
  EXPECT_LT(mean_out_of_plane_de76(smooth.map, flake_paint), mean_out_of_plane_de76(forced.map, flake_paint));
  for (ColorMapRow& row : rows)
    row.lab = {row.lab.L + 8 * (next() - 0.5), row.lab.a + 8 * (next() - 0.5), row.lab.b + 8 * (next() - 0.5)};
  const ColorMapFit noisy = fitted(rows, {}), stiff = fitted(rows, 1);
  EXPECT_LT(noisy.isolines_power, 1);
  EXPECT_LT(noisy.isolines_de76, stiff.isolines_de76);
  EXPECT_LT(mean_out_of_plane_de76(noisy.map, flake_paint), mean_out_of_plane_de76(stiff.map, flake_paint));
}

// Its mean over many draws of rows whose errors are the lights' own, beside the spread of the difference over the
// draws.
TEST(ColorMapFit, TheErrorOfTheDifferenceIsItsSpread) {
  TestNumbers next(11);
  double sum = 0, squares = 0, told = 0;
  constexpr int kDraws = 60;
  for (int draw = 0; draw < kDraws; ++draw) {
    std::vector<ColorMapRow> rows = in_plane_rows(12.5);
    double shift = 0, last_light = 0;
    for (ColorMapRow& row : rows) {
      if (row.light.z != last_light) shift = 12 * (next() - 0.5), last_light = row.light.z;
      row.lab.b += shift;
    }
    const auto fit = fit_color_map(rows, white(), {16, 1.5});
    ASSERT_TRUE(fit.ok() && fit->difference_error_de76);
    const double difference = fit->isolines_de76 - fit->aspecular_de76;
    sum += difference, squares += difference * difference, told += *fit->difference_error_de76 / kDraws;
  }
  const double spread = std::sqrt((squares - sum * sum / kDraws) / (kDraws - 1));
  // Six lights tell a spread to a third; between lights the paint itself differs, so that the error told is the larger.
  EXPECT_GT(told, 0.7 * spread);
  EXPECT_LT(told, 5 * spread);
}

// The held-out error is what it says: each row is left out in turn, the map is made from the others, and is asked for
// the row.
TEST(ColorMapFit, HeldOutErrorIsThatOfMapsWithoutTheRow) {
  std::vector<ColorMapRow> rows;
  for (const double light : {15.0, 30.0, 50.0, 65.0})
    for (const double view : {-70.0, -40.0, -5.0, 25.0, 55.0}) {
      const Vec3 wi = direction(light * kDegree, 0), wo = direction(view * kDegree, 0);
      if (paint::aspecular_angle_rad(wi, wo, {0, 0, 1}) > 10 * kDegree) rows.push_back({wi, wo, flake_paint(wi, wo)});
    }
  const ColorMapOptions options = {512, 1.5, ColorMapModel::kIsolines};
  const auto fit = fit_color_map(rows, white(), options);
  ASSERT_TRUE(fit.ok());
  double sum = 0;
  for (std::size_t left_out = 0; left_out < rows.size(); ++left_out) {
    std::vector<ColorMapRow> others = rows;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(left_out));
    const auto without = fit_color_map(others, white(), options);
    ASSERT_TRUE(without.ok());
    const ColorMapRow& row = rows[left_out];
    const color::Rgb got = brdf::reflectance_factor(without->map, row.light, row.view, brdf::CriticalAngle::kClip);
    sum += color::delta_e_76(color::lab_from_rgb(got, white()), row.lab);
  }
  // Texels of 1/512 in the cosine, and L* that are held at 0 in maps.
  EXPECT_NEAR(fit->held_out_de76, sum / static_cast<double>(rows.size()), 0.05 * fit->held_out_de76);
}

// A file of scattered directions whose ring at 80 deg is wrong by a factor of 20, as measurements at grazing angles
// are. Rows for light at 75 deg do not exist, and a blend of the rings at 70 and 80 deg must not take their place.
TEST(ColorMapFit, AGrazingRingHasNoPartInTheMap) {
  const ScratchFolder folder;
  std::string text = "2\n400 700\n";
  for (double light = 10; light <= 80; light += 10)
    for (double view = -75; view <= 75; view += 7.5) {
      const double f = 0.1 * (light > 75 ? 20 : 1);
      text += fmt::format("{} 0 {} {} {} {}\n", light * kDegree, std::abs(view) * kDegree, view < 0 ? kPi : 0, f, f);
    }
  const auto brdf = brdf::read_measured(folder.file("ring.brdf", text));
  ASSERT_TRUE(brdf.ok()) << brdf.error().message;
  const auto fit = fit_color_map(**brdf, {"D65", 2}, {});
  ASSERT_TRUE(fit.ok()) << fit.error().message;
  EXPECT_GT(fit->grazing_rows, 15);
  const Vec3 wi = direction(75 * kDegree, 0), wo = direction(10 * kDegree, 0);
  const color::Rgb got = brdf::reflectance_factor(fit->map, wi, wo, brdf::CriticalAngle::kSlide);
  EXPECT_NEAR(got.y, 0.1 * kPi, 0.003);
  EXPECT_GT((*brdf)->value(wi, wo).f[0], 0.3) << "the control: what the file gives between its rings";
}

// Rows measured in plane, and rows to predict from them: aspecular > 12 deg, viewer < 70 deg.
struct MeasuredRows {
  std::vector<ColorMapRow> in_plane, beside;
  color::Xyz white;
};

// Every measured row of a Cornell file.
MeasuredRows cornell_rows(const std::string& path) {
  MeasuredRows rows{{}, {}, white()};
  const auto brdf = brdf::read_measured(path);
  EXPECT_TRUE(brdf.ok()) << brdf.error().message;
  const auto& wavelengths = (*brdf)->traits().wavelengths_nm;
  const auto meter = color::SpectralColorimeter::make(wavelengths, {"D65", 10});
  std::ifstream file(path);
  std::string line;
  std::vector<double> numbers;
  while (std::getline(file, line)) {
    std::istringstream words(line.substr(0, line.find('#')));
    for (double value; words >> value;) numbers.push_back(value);
  }
  for (std::size_t i = 1 + wavelengths.size(); i + 4 + wavelengths.size() <= numbers.size();
       i += 4 + wavelengths.size()) {
    const double* row = &numbers[i];
    std::vector<double> factors;
    for (std::size_t k = 0; k < wavelengths.size(); ++k) factors.push_back(kPi * std::max(row[4 + k], 0.0));
    const ColorMapRow color = {direction(row[0], row[1]), direction(row[2], row[3]), meter->lab(factors)};
    const bool in_plane = std::abs(std::sin(row[3] - row[1])) < 1e-3 || row[2] < 1e-3;
    const double aspecular_deg = paint::aspecular_angle_rad(color.light, color.view, {0, 0, 1}) / kDegree;
    if (in_plane) rows.in_plane.push_back(color);
    if (!in_plane && aspecular_deg > 12 && row[2] < 70 * kDegree) rows.beside.push_back(color);
  }
  return rows;
}

// The rival: a function of the aspecular angle alone, the local line through the in-plane rows, at its best bandwidth.
// Over all rows beside the plane, and over those of them that are not beyond the critical angle.
struct AspecularOnly {
  double all = 1e9, inside = 1e9;
};
bool is_inside(const ColorMapRow& row) {
  const brdf::FlakeAngles f = brdf::flake_angles(row.light, row.view, 1.5);
  return f.flake_rad + f.incidence_rad < std::asin(1 / 1.5);
}
AspecularOnly aspecular_only_de76(const MeasuredRows& rows) {
  AspecularOnly best;
  for (const double bandwidth_deg : {1.0, 2.0, 3.0, 4.0, 6.0, 8.0}) {
    double sum = 0, sum_inside = 0;
    int inside = 0;
    for (const ColorMapRow& target : rows.beside) {
      const double at = paint::aspecular_angle_rad(target.light, target.view, {0, 0, 1}) / kDegree;
      double w0 = 0, w1 = 0, w2 = 0, y0[3] = {}, y1[3] = {};
      for (const ColorMapRow& row : rows.in_plane) {
        const double x = paint::aspecular_angle_rad(row.light, row.view, {0, 0, 1}) / kDegree - at;
        if (x + at < 10) continue;
        const double w = std::exp(-0.5 * std::pow(x / bandwidth_deg, 2)) + 1e-12;
        const double lab[3] = {row.lab.L, row.lab.a, row.lab.b};
        w0 += w, w1 += w * x, w2 += w * x * x;
        for (int c = 0; c < 3; ++c) y0[c] += w * lab[c], y1[c] += w * x * lab[c];
      }
      double got[3];
      for (int c = 0; c < 3; ++c) got[c] = (w2 * y0[c] - w1 * y1[c]) / (w0 * w2 - w1 * w1);
      const double de = color::delta_e_76({got[0], got[1], got[2]}, target.lab);
      sum += de;
      if (is_inside(target)) sum_inside += de, ++inside;
    }
    best.all = std::min(best.all, sum / static_cast<double>(rows.beside.size()));
    best.inside = std::min(best.inside, sum_inside / inside);
  }
  return best;
}

// The dense files of other makers, as an instrument with seven lights and seventeen viewers in plane would read them.
MeasuredRows sampled_rows(const brdf::MeasuredBrdf& brdf) {
  const auto meter = brdf::ChannelColorimeter::make(brdf.traits(), {"D65", 2});
  EXPECT_TRUE(meter.ok());
  MeasuredRows rows{{}, {}, meter->white()};
  const auto row = [&](double light_deg, double view_deg, double azimuth_deg) {
    const Vec3 wi = direction(light_deg * kDegree, 0), wo = direction(view_deg * kDegree, azimuth_deg * kDegree);
    std::vector<double> factors = brdf.value(wi, wo).f;
    for (double& f : factors) f = kPi * std::max(f, 0.0);
    return ColorMapRow{wi, wo, color::lab_from_xyz(meter->xyz(factors), meter->white())};
  };
  for (double light = 10; light <= 70; light += 10) {
    for (double view = -70; view <= 70; view += 8.75) rows.in_plane.push_back(row(light, view, 0));
    for (double view = 10; view < 70; view += 8)
      for (double azimuth = 15; azimuth < 180; azimuth += 15) {
        const ColorMapRow beside = row(light, view, azimuth);
        if (paint::aspecular_angle_rad(beside.light, beside.view, {0, 0, 1}) > 12 * kDegree)
          rows.beside.push_back(beside);
      }
  }
  return rows;
}

// Mean differences, printed as one line of the table.
struct Comparison {
  double aspecular_only, clip, slide, slide_map, index;
  // Errors of pairs that need no treatment: by isolines, by the aspecular angle alone, and their number.
  double inside, aspecular_inside;
  int inside_rows;
};
Comparison compared(const std::string& name, const MeasuredRows& rows) {
  Comparison result{};
  const AspecularOnly rival = aspecular_only_de76(rows);
  result.aspecular_only = rival.all, result.aspecular_inside = rival.inside;
  double* const means[] = {&result.clip, &result.slide, &result.slide_map, &result.index};
  for (std::size_t k = 0; k < kTreatments.size(); ++k) {
    // Index 1 all through: the map itself has no coat either.
    const double index = kTreatments[k] == brdf::CriticalAngle::kIndexOne ? 1 : 1.5;
    const auto fit = fit_color_map(rows.in_plane, rows.white, {256, index, ColorMapModel::kIsolines});
    EXPECT_TRUE(fit.ok()) << fit.error().message;
    double sum = 0, sum_inside = 0;
    int within = 0;
    for (const ColorMapRow& row : rows.beside) {
      const color::Rgb got = brdf::reflectance_factor(fit->map, row.light, row.view, kTreatments[k]);
      const double de = color::delta_e_76(color::lab_from_rgb(got, rows.white), row.lab);
      sum += de;
      if (is_inside(row)) sum_inside += de, ++within;
    }
    *means[k] = sum / static_cast<double>(rows.beside.size());
    if (k == 0) result.inside = sum_inside / within, result.inside_rows = within;
  }
  std::printf("%-22s %5zu %10.2f %8.2f %8.2f %10.2f %8.2f %6d %10.2f %8.2f\n", name.c_str(), rows.beside.size(),
              result.aspecular_only, result.clip, result.slide, result.slide_map, result.index, result.inside_rows,
              result.aspecular_inside, result.inside);
  return result;
}

void print_heading() {
  std::printf("%-22s %5s %10s %8s %8s %10s %8s %6s %10s %8s\n", "mean dE76", "rows", "aspecular", "clip", "slide",
              "slide-map", "index", "inside", "aspecular", "isolines");
}

TEST(ColorMapFit, CornellInPlaneRowsPredictAllOthersRealData) {
  const char* data = std::getenv("GONIOCHROME_DATA");
  if (data == nullptr) GTEST_SKIP() << "GONIOCHROME_DATA is not set";
  print_heading();
  for (const std::string name : {"cayman", "garnet_red", "krylon_blue"}) {
    const MeasuredRows rows = cornell_rows(std::string(data) + "/brdf/cornell/" + name + ".brdf");
    ASSERT_GT(rows.beside.size(), 900u);
    const Comparison c = compared(name, rows);
    // The slide within the map is offered because it was published; it is not better than the rival on every paint.
    for (const double mean : {c.clip, c.slide, c.index}) EXPECT_LT(mean, c.aspecular_only) << name;
    EXPECT_LT(c.inside, 0.7 * c.aspecular_inside) << name;
  }
}

// On the two NVIDIA files, whose values are not reciprocal and partly negative, the isolines win once and lose once.
TEST(ColorMapFit, OtherMeasurementsAgreeRealData) {
  const char* data = std::getenv("GONIOCHROME_DATA");
  if (data == nullptr) GTEST_SKIP() << "GONIOCHROME_DATA is not set";
  print_heading();
  for (const std::string name :
       {"rgl/cc_ibiza_sunset_rgb.bsdf", "rgl/satin_rosaline_rgb.bsdf", "rgl/vch_golden_yellow_rgb.bsdf",
        "nvidia/carpaint_blue.mbsdf", "nvidia/carpaint_red.mbsdf"}) {
    const auto brdf = brdf::read_measured(std::string(data) + "/brdf/" + name);
    ASSERT_TRUE(brdf.ok()) << brdf.error().message;
    const Comparison c = compared(name.substr(name.find('/') + 1, 22), sampled_rows(**brdf));
    for (const double mean : {c.clip, c.slide, c.index})
      EXPECT_LT(mean, (name == "nvidia/carpaint_red.mbsdf" ? 1.1 : 1.0) * c.aspecular_only) << name;
  }
}

TEST(ColorMapFit, MeasuredBrdfsRealData) {
  const char* data = std::getenv("GONIOCHROME_DATA");
  if (data == nullptr) GTEST_SKIP() << "GONIOCHROME_DATA is not set";
  for (const std::string name : {"cornell/cayman.brdf", "rgl/cc_ibiza_sunset_rgb.bsdf"}) {
    const auto brdf = brdf::read_measured(std::string(data) + "/brdf/" + name);
    if (!brdf.ok()) continue;
    const color::ViewingCondition condition = {"D65", (*brdf)->traits().wavelengths_nm.empty() ? 2 : 10};
    const auto fit = fit_color_map(**brdf, condition, {64, 1.5});
    ASSERT_TRUE(fit.ok()) << fit.error().message;
    EXPECT_GT(fit->rows, 200);
    EXPECT_FALSE(fit->map.aspecular);
    EXPECT_EQ(fit->held_out_de76, fit->isolines_de76);
    EXPECT_LT(fit->held_out_de76, 0.65 * fit->aspecular_de76);
    EXPECT_GT(fit->compared_rows, 900);
    std::printf("%-28s isolines %.2f aspecular %.2f\n", name.c_str(), fit->isolines_de76, fit->aspecular_de76);
  }
}

}  // namespace
}  // namespace goniochrome::fit::color_map_fit_test
