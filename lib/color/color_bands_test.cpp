// Spectra from three channels beside the spectra that had these colors: published reflectances and lamps of testdata/.
#include "color/color_bands.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "base/file.h"
#include "base/testdata_for_test.h"
#include "base/text.h"
#include "color/reflection.h"
#include "math/least_squares.h"

namespace goniochrome::color::color_bands_test {
namespace {

using Conversion = std::function<Bands(const Rgb&)>;

const BandObserver& eye() {
  static const BandObserver kEye = *BandObserver::make();
  return kEye;
}

// The columns of a table of testdata/ that are fitted to or held out, in bands.
std::vector<Bands> spectra(const std::string& file, bool lights) {
  const auto text = file_content(testdata(file));
  EXPECT_TRUE(text.ok());
  std::vector<double> nm;
  std::vector<std::string> sets;
  std::vector<std::vector<double>> columns;
  int row = 0;
  for (const std::string_view line : split(*text, '\n')) {
    const auto words = split(line, ',');
    if (words.size() < 2) continue;
    columns.resize(words.size() - 1);
    if (row++ == 1) sets.assign(words.begin() + 1, words.end());
    if (row <= 2) continue;
    nm.push_back(*parse_number(words[0]));
    for (std::size_t i = 1; i < words.size(); ++i) columns[i - 1].push_back(*parse_number(words[i]));
  }
  std::vector<Bands> all;
  for (std::size_t i = 0; i < columns.size(); ++i)
    if (sets[i] == "fit" || sets[i] == "held")
      all.push_back(lights ? *light_bands(nm, columns[i]) : *reflectance_bands(nm, columns[i]));
  return all;
}

// The constant, sine and cosine over the range that have the color: [Glassner1989].
Bands of_glassner(const Rgb& rgb) {
  std::array<Bands, 3> basis;
  Matrix3 colors{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (int b = 0; b < kBands; ++b) {
      const double x = 2 * M_PI * b / (kBands - 1);
      basis[i][static_cast<std::size_t>(b)] = i == 0 ? 1 : i == 1 ? std::sin(x) : std::cos(x);
    }
    for (int c = 0; c < 3; ++c) colors[static_cast<std::size_t>(c)][i] = eye().rgb(basis[i])[c];
  }
  const Rgb share = product(inverse(colors).matrix, rgb);
  Bands sum{};
  for (std::size_t b = 0; b < sum.size(); ++b)
    sum[b] = share.x * basis[0][b] + share.y * basis[1][b] + share.z * basis[2][b];
  return sum;
}

// The smoothest bands from 0 to 1 that come nearest to a color: slack variables hold the upper bound.
Bands bounded(const Rgb& rgb) {
  math::Matrix rows(kBands - 1 + 3 + kBands, 2 * kBands);
  std::vector<double> right(static_cast<std::size_t>(rows.rows));
  for (int b = 0; b < kBands; ++b) {
    if (b + 1 < kBands) rows(b, b) = -1, rows(b, b + 1) = 1;
    for (int c = 0; c < 3; ++c) rows(kBands - 1 + c, b) = 30 * eye().weights()[static_cast<std::size_t>(b)][c];
    rows(kBands + 2 + b, b) = rows(kBands + 2 + b, kBands + b) = 1e3;
    right[static_cast<std::size_t>(kBands + 2 + b)] = 1e3;
  }
  for (int c = 0; c < 3; ++c) right[static_cast<std::size_t>(kBands - 1 + c)] = 30 * rgb[c];
  const auto fit = math::nnls(rows, right);
  Bands bands{};
  std::copy_n(fit.x.begin(), kBands, bands.begin());
  return bands;
}

// White, a secondary and a primary of Rec.709 by the order of the channels, with spectra between 0 and 1: [Smits1999].
Bands of_smits(const Rgb& rgb) {
  static const auto kBasis = [] {
    std::array<Bands, 8> basis{};
    for (unsigned i = 1; i < 8; ++i)
      basis[i] = bounded(rec2020_from_rec709({(i & 1U) ? 1.0 : 0, (i & 2U) ? 1.0 : 0, (i & 4U) ? 1.0 : 0}));
    return basis;
  }();
  const Rgb here = rec709_from_rec2020(rgb);
  std::array<int, 3> order = {0, 1, 2};
  std::ranges::sort(order, [&](int a, int b) { return here[a] < here[b]; });
  const unsigned highest = 1U << order[2], two = highest | 1U << order[1];
  Bands sum{};
  for (std::size_t b = 0; b < sum.size(); ++b)
    sum[b] = here[order[0]] * kBasis[7][b] + (here[order[1]] - here[order[0]]) * kBasis[two][b] +
             (here[order[2]] - here[order[1]]) * kBasis[highest][b];
  return sum;
}

Bands sigmoid(const Rgb& k, double size) {
  Bands bands{};
  for (int b = 0; b < kBands; ++b) {
    const double t = 2.0 * b / (kBands - 1) - 1, u = (k.x * t + k.y) * t + k.z;
    bands[static_cast<std::size_t>(b)] = size * (0.5 + u / (2 * std::sqrt(1 + u * u)));
  }
  return bands;
}

// A sigmoid of a parabola, of twice the largest channel: [JakobHanika2019], by damped Gauss-Newton steps on L*a*b*.
Bands of_jakob_hanika(const Rgb& rgb) {
  const double size = 2 * std::max({rgb.x, rgb.y, rgb.z});
  const Xyz white = xyz_d65_from_rgb({1, 1, 1});
  const auto error = [&](const Rgb& k) {
    const Lab have = lab_from_rgb(eye().rgb(sigmoid(k, 1)), white), want = lab_from_rgb((1 / size) * rgb, white);
    return Rgb{have.L - want.L, have.a - want.a, have.b - want.b};
  };
  Rgb k, now = error(k);
  double damping = 1e-3;
  for (int step = 0; step < 200 && dot(now, now) > 1e-12; ++step) {
    std::array<Rgb, 3> slope;
    for (int i = 0; i < 3; ++i) {
      Rgb moved = k;
      moved[i] += 1e-6;
      slope[static_cast<std::size_t>(i)] = 1e6 * (error(moved) - now);
    }
    Matrix3 normal{};
    Rgb right;
    for (std::size_t i = 0; i < 3; ++i) {
      right[static_cast<int>(i)] = -dot(slope[i], now);
      for (std::size_t j = 0; j < 3; ++j) normal[i][j] = dot(slope[i], slope[j]) * (i == j ? 1 + damping : 1);
    }
    const Rgb next = k + product(inverse(normal).matrix, right), then = error(next);
    if (dot(then, then) < dot(now, now)) {
      k = next, now = then, damping /= 3;
    } else {
      damping *= 4;
    }
  }
  return sigmoid(k, size);
}

double difference(const Bands& a, const Bands& b) {
  const Xyz white = xyz_d65_from_rgb({1, 1, 1});
  return delta_e_2000(lab_from_rgb(eye().rgb(a), white), lab_from_rgb(eye().rgb(b), white));
}

// The mean difference over all products of two spectra, the first ones and perhaps the second ones by a conversion.
double mean_error(const Conversion& made, const std::vector<Bands>& paints, const std::vector<Bands>& lights,
                  bool both) {
  std::vector<Bands> shown;
  for (const Bands& light : lights) shown.push_back(both ? made(eye().rgb(light)) : light);
  double sum = 0;
  for (const Bands& paint : paints) {
    const Bands guess = made(eye().rgb(paint));
    for (std::size_t i = 0; i < lights.size(); ++i)
      sum += difference(product(guess, shown[i]), product(paint, lights[i]));
  }
  return sum / static_cast<double>(paints.size() * lights.size());
}

TEST(ColorBands, HaveTheirColorAndAreNotNegative) {
  for (const Rgb& wanted : {Rgb{0.62, 0.07, 0.05}, {0, 9, 10}, {1, 1, 1}, {1e-6, 2e-6, 1e-6}, {0.1, 0.42, 0.09}}) {
    const Bands bands = bands_of_color(wanted, eye());
    EXPECT_GE(std::ranges::min(bands), 0);
    EXPECT_LE(length(eye().rgb(bands) - wanted), 1e-4 * length(wanted));
  }
  for (const double value : bands_of_color({0.5, 0.5, 0.5}, eye())) EXPECT_NEAR(value, 0.5, 1e-4);
  EXPECT_EQ(bands_of_color({}, eye()), Bands{});
  // The sine and cosine of [Glassner1989] go below 0 for the same red.
  EXPECT_LT(std::ranges::min(of_glassner({0.62, 0.07, 0.05})), -0.05);
}

// Where a lamp states its spectrum and the paint does not, the sigmoid errs least; where neither does, the smoothest
// bands do. They err less than the other two in both.
TEST(ColorBands, ErrLessThanTheSpectraOfOthersWhereNothingIsStated) {
  const std::vector<Bands> paints = spectra("published-reflectances.csv", false),
                           lamps = spectra("published-lights.csv", true);
  ASSERT_EQ(paints.size(), 53U);
  ASSERT_EQ(lamps.size(), 31U);
  std::vector<Bands> filtered;
  for (std::size_t i = 0; i < paints.size(); i += 3)
    filtered.push_back(scaled(1 / xyz_d65_from_rgb(eye().rgb(paints[i])).Y, paints[i]));
  const std::map<std::string, Conversion> ways = {
      {"smoothest", [](const Rgb& rgb) { return bands_of_color(rgb, eye()); }},
      {"glassner", of_glassner},
      {"smits", of_smits},
      {"jakob-hanika", of_jakob_hanika}};
  std::map<std::string, std::array<double, 3>> errors;
  for (const auto& [name, made] : ways) {
    auto& e = errors[name] = {mean_error(made, paints, lamps, false), mean_error(made, paints, lamps, true),
                              mean_error(made, paints, filtered, true)};
    printf("%-14s paints %.2f, paints and lamps %.2f, paints and filtered daylight %.2f\n", name.c_str(), e[0], e[1],
           e[2]);
  }
  const std::array<double, 3> ours = errors["smoothest"];
  for (const char* other : {"glassner", "smits"}) EXPECT_LT(ours[0], errors[other][0]) << other;
  for (const char* other : {"smits", "jakob-hanika"}) EXPECT_LT(ours[1], errors[other][1]) << other;
  for (const char* other : {"glassner", "smits", "jakob-hanika"}) EXPECT_LT(ours[2], errors[other][2]) << other;
  EXPECT_LT(errors["jakob-hanika"][0], ours[0]);
}

}  // namespace
}  // namespace goniochrome::color::color_bands_test
