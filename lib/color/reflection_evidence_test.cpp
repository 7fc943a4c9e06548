// The products of colors beside spectral integration, on reflectances and lights that no operator was fitted to. The
// tables of testdata/ are published figures, every 5 nm from 380 to 730 nm; PROVENANCE.md names their sources. The
// default operator errs less than the plain product in every class here but one.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "base/file.h"
#include "base/testdata_for_test.h"
#include "base/text.h"
#include "color/internal/cie_tables.h"
#include "color/reflection.h"
#include "color/reflection_file.h"

namespace goniochrome::color::reflection_evidence_test {
namespace {

using Spectrum = std::vector<double>;

struct Column {
  std::string name, set;
  Spectrum values;
};

// The columns of a table: a row of names, a row of sets, and rows of a wavelength and values.
std::vector<Column> columns(const std::string& file) {
  const auto text = file_content(testdata(file));
  EXPECT_TRUE(text.ok());
  std::vector<Column> result;
  int row = 0;
  for (const std::string_view line : split(*text, '\n')) {
    if (line.empty()) continue;
    const auto words = split(line, ',');
    result.resize(words.size() - 1);
    for (std::size_t i = 1; i < words.size(); ++i) {
      Column& column = result[i - 1];
      if (row == 0) column.name = std::string(words[i]);
      if (row == 1) column.set = std::string(words[i]);
      if (row > 1) column.values.push_back(*parse_number(words[i]));
    }
    ++row;
  }
  return result;
}

// Colors of spectra that are relative to daylight D65, which has the color 1,1,1 and the luminance 1.
class Observer {
 public:
  explicit Observer(const Spectrum& d65) {
    constexpr std::size_t kFirst = 4;  // 380 nm
    double luminance = 0;
    for (std::size_t i = 0; i < d65.size(); ++i) {
      const auto& bar = kCieTable[kFirst + i].observer_2;
      weights_.push_back({d65[i] * bar[0], d65[i] * bar[1], d65[i] * bar[2]});
      luminance += weights_.back().Y;
    }
    for (Xyz& w : weights_) w = {w.X / luminance, w.Y / luminance, w.Z / luminance};
    white_ = xyz(Spectrum(d65.size(), 1.0));
  }
  Xyz xyz(const Spectrum& relative) const {
    Xyz sum;
    for (std::size_t i = 0; i < weights_.size(); ++i)
      sum = {sum.X + weights_[i].X * relative[i], sum.Y + weights_[i].Y * relative[i],
             sum.Z + weights_[i].Z * relative[i]};
    return sum;
  }
  Rgb rgb(const Spectrum& relative) const { return rgb_from_xyz_d65(adapted(xyz(relative), white_, kScreenWhite)); }
  // The spectrum with luminance 1.
  Spectrum normalized(Spectrum relative) const {
    const double luminance = xyz(relative).Y;
    for (double& v : relative) v /= luminance;
    return relative;
  }

 private:
  const Xyz kScreenWhite = xyz_d65_from_rgb({1, 1, 1});
  std::vector<Xyz> weights_;
  Xyz white_;
};

double difference(const Rgb& a, const Rgb& b) {
  static const Xyz white = xyz_d65_from_rgb({1, 1, 1});
  return delta_e_2000(lab_from_xyz(xyz_d65_from_rgb(a), white), lab_from_xyz(xyz_d65_from_rgb(b), white));
}

Spectrum times(const Spectrum& a, const Spectrum& b) {
  Spectrum result(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) result[i] = a[i] * b[i];
  return result;
}

// Lights of luminance 1, each with each reflectance: the two colors and the color of the product of the spectra.
struct Pair {
  Rgb light, paint, truth;
};
std::vector<Pair> pairs(const Observer& eye, const std::vector<Spectrum>& lights, const std::vector<Spectrum>& paints) {
  std::vector<Pair> result;
  for (const Spectrum& each : lights) {
    const Spectrum light = eye.normalized(each);
    for (const Spectrum& paint : paints)
      result.push_back({eye.rgb(light), eye.rgb(paint), eye.rgb(times(light, paint))});
  }
  return result;
}
double mean_error(const ReflectionOperator& op, const std::vector<Pair>& all) {
  double sum = 0;
  for (const Pair& pair : all) sum += difference(reflected(op, pair.light, pair.paint), pair.truth);
  return sum / static_cast<double>(all.size());
}

// A cube whose ceiling shines: six walls of one color each, all orders of interreflection. The form factor of opposite
// walls of a cube is 0.1998 (closed form), and the four others share the rest.
class Room {
 public:
  static constexpr std::size_t kWalls = 6;
  static double form_factor(std::size_t i, std::size_t j) {
    constexpr double kOpposite = 0.19982489569838746;
    return i == j ? 0 : i / 2 == j / 2 ? kOpposite : (1 - kOpposite) / 4;
  }
  // The light that each wall sends out where wall i makes reflect(i, E) of the light E that it receives.
  template <class Light>
  static std::array<Light, kWalls> radiosity(const Light& ceiling, const Light& dark,
                                             const std::function<Light(std::size_t, const Light&)>& reflect,
                                             const std::function<void(Light&, double, const Light&)>& add) {
    std::array<Light, kWalls> out;
    out.fill(dark);
    constexpr int kBounces = 60;  // walls reflect less than 0.9, and 0.6 in the mean: what is left out is below 1e-9
    for (int bounce = 0; bounce < kBounces; ++bounce) {
      std::array<Light, kWalls> next;
      for (std::size_t i = 0; i < kWalls; ++i) {
        Light received = dark;
        for (std::size_t j = 0; j < kWalls; ++j) add(received, form_factor(i, j), out[j]);
        next[i] = reflect(i, received);
        if (i == 0) add(next[i], 1, ceiling);
      }
      out = next;
    }
    return out;
  }
};

struct RoomCase {
  Rgb light;
  std::array<Rgb, Room::kWalls> paints, truth;
  double exposure = 1;  // makes the mean luminance that walls receive 1
};

// The first wall is the ceiling.
RoomCase room(const Observer& eye, const Spectrum& light, const std::array<Spectrum, Room::kWalls>& walls) {
  const auto out = Room::radiosity<Spectrum>(
      light, Spectrum(light.size(), 0.0), [&](std::size_t i, const Spectrum& e) { return times(walls[i], e); },
      [](Spectrum& sum, double share, const Spectrum& e) {
        for (std::size_t k = 0; k < e.size(); ++k) sum[k] += share * e[k];
      });
  RoomCase made;
  made.light = eye.rgb(light);
  double luminance = 0;
  for (std::size_t i = 0; i < Room::kWalls; ++i) {
    made.paints[i] = eye.rgb(walls[i]), made.truth[i] = eye.rgb(out[i]);
    for (std::size_t j = 1; j < Room::kWalls; ++j)
      luminance += Room::form_factor(j, i) * eye.xyz(out[i]).Y / (Room::kWalls - 1);
  }
  made.exposure = 1 / luminance;
  return made;
}

// With `white`, two walls that face each other have colors, as in a Cornell box, and the others are white.
std::vector<RoomCase> rooms(const Observer& eye, const std::vector<Spectrum>& lights,
                            const std::vector<Spectrum>& paints, int count, const Spectrum* white = nullptr) {
  std::mt19937 random(7);  // its sequence is fixed by the language
  std::vector<RoomCase> result;
  for (int r = 0; r < count; ++r) {
    const Spectrum light = eye.normalized(lights[random() % lights.size()]);
    std::array<Spectrum, Room::kWalls> walls;
    for (Spectrum& wall : walls) wall = paints[random() % paints.size()];
    if (white != nullptr) walls[1] = walls[4] = walls[5] = *white;
    walls[0].assign(light.size(), 0.8);
    result.push_back(room(eye, light, walls));
  }
  return result;
}

double mean_error(const ReflectionOperator& op, const std::vector<RoomCase>& all) {
  double sum = 0;
  for (const RoomCase& room : all) {
    const auto out = Room::radiosity<Rgb>(
        room.light, {}, [&](std::size_t i, const Rgb& e) { return reflected(op, room.paints[i], e); },
        [](Rgb& total, double share, const Rgb& e) { total += share * e; });
    for (std::size_t i = 1; i < Room::kWalls; ++i)
      sum += difference(room.exposure * out[i], room.exposure * room.truth[i]) / (Room::kWalls - 1);
  }
  return sum / static_cast<double>(all.size());
}

// The spectra of the tables, relative to daylight where they are lights.
struct Spectra {
  std::vector<Spectrum> fit_paints, held_paints, held_patches, fit_lights, held_lights;
  Spectrum daylight;
  Spectra() {
    for (const Column& column : columns("published-reflectances.csv")) {
      if (column.set == "fit") fit_paints.push_back(column.values);
      if (column.set == "held") (column.name.starts_with("ISO") ? held_patches : held_paints).push_back(column.values);
    }
    const auto lights = columns("published-lights.csv");
    for (const Column& column : lights)
      if (column.set == "daylight") daylight = column.values;
    for (const Column& column : lights) {
      Spectrum relative = column.values;
      for (std::size_t i = 0; i < relative.size(); ++i) relative[i] /= daylight[i];
      if (column.set == "fit") fit_lights.push_back(relative);
      if (column.set == "held") held_lights.push_back(relative);
    }
  }
};

class ReflectionEvidence : public testing::Test {
 protected:
  // The 18 chromatic patches and the paints that were held out, as filters in daylight.
  std::vector<Spectrum> filters() const {
    std::vector<Spectrum> all(spectra.held_patches.begin(), spectra.held_patches.begin() + 18);
    all.insert(all.end(), spectra.held_paints.begin(), spectra.held_paints.end());
    return all;
  }
  const Spectrum& white_patch() const { return spectra.held_patches[18]; }
  // The mean error of an operator in each class.
  std::map<std::string, double> errors(const ReflectionOperator& op) const {
    const std::vector<Spectrum> white = {Spectrum(spectra.daylight.size(), 1.0)};
    const auto walls = filters();
    return {{"patches, lamps", mean_error(op, pairs(eye, spectra.held_lights, spectra.held_patches))},
            {"patches, filtered daylight", mean_error(op, pairs(eye, filters(), spectra.held_patches))},
            {"paints, lamps", mean_error(op, pairs(eye, spectra.held_lights, spectra.held_paints))},
            {"paints, filtered daylight", mean_error(op, pairs(eye, filters(), spectra.held_paints))},
            {"rooms, daylight", mean_error(op, rooms(eye, white, walls, 100))},
            {"rooms, lamps", mean_error(op, rooms(eye, spectra.held_lights, walls, 100))},
            {"rooms, filtered daylight", mean_error(op, rooms(eye, filters(), walls, 100))},
            {"boxes, daylight", mean_error(op, rooms(eye, white, walls, 100, &white_patch()))},
            {"boxes, lamps", mean_error(op, rooms(eye, spectra.held_lights, walls, 100, &white_patch()))},
            {"boxes, filtered daylight", mean_error(op, rooms(eye, filters(), walls, 100, &white_patch()))}};
  }
  Spectra spectra;
  Observer eye{spectra.daylight};
};

TEST_F(ReflectionEvidence, TheTablesAreThoseThatAreTold) {
  EXPECT_EQ(spectra.held_patches.size(), 24U);
  EXPECT_EQ(spectra.held_paints.size(), 7U);
  EXPECT_EQ(spectra.fit_paints.size(), 22U);
  EXPECT_EQ(spectra.fit_lights.size(), 16U);
  EXPECT_EQ(spectra.held_lights.size(), 15U);
  ASSERT_EQ(spectra.daylight.size(), 71U);
  for (std::size_t i = 0; i < 71; ++i) EXPECT_NEAR(spectra.daylight[i], kCieTable[i + 4].illuminants[0], 5e-4);
  const Rgb white = eye.rgb(Spectrum(71, 1.0));
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(white[c], 1, 1e-12);
  // A gray room of reflectance 0.5 with a ceiling of 0.8 sends out what the sum of its two unknowns says.
  const double F = Room::form_factor(0, 1), side = (1 - F) / 4;
  const auto gray = Room::radiosity<double>(
      1, 0, [](std::size_t i, double e) { return (i == 0 ? 0.8 : 0.5) * e; },
      [](double& sum, double share, double e) { sum += share * e; });
  double into_floor = F * gray[0];
  for (std::size_t j = 2; j < 6; ++j) into_floor += side * gray[j];
  EXPECT_NEAR(gray[1], 0.5 * into_floor, 1e-9);
}

// The default is better than the other products in every class that was held out but one: boxes in daylight, where the
// plain product errs by 0.03 less. That is the price of red paint that stays red in cyan light.
TEST_F(ReflectionEvidence, TheDefaultIsBetterThanTheOthersInAllClassesThatWereHeldOutButOne) {
  const auto chosen = chosen_operator(kDefaultOperator);
  ASSERT_TRUE(chosen.ok());
  const auto ours = errors(*chosen);
  const std::map<std::string, ReflectionOperator> others = {{"plain", component_wise()},
                                                            {"iso", iso_rgb_operator()},
                                                            {"iso709", iso_rec709_operator()},
                                                            {"estimated", working_space_operator()}};
  for (const auto& [name, op] : others) {
    for (const auto& [kind, error] : errors(op)) {
      RecordProperty((kind + ", " + name).c_str(), std::to_string(error));
      printf("%-28s %-10s %6.3f  fitted %6.3f\n", kind.c_str(), name.c_str(), error, ours.at(kind));
      const bool price = name == "plain" && kind == "boxes, daylight";
      EXPECT_LT(ours.at(kind), price ? 1.04 * error : error) << kind << ", " << name;
    }
  }
}

// A box that is open in front, with a red and a green wall. In daylight the plain product is closer; in colored light
// it is not.
TEST_F(ReflectionEvidence, ASingleBoxCanBeTheOtherWayRound) {
  const auto patch = [&](const std::string& name) {
    for (const Column& column : columns("published-reflectances.csv"))
      if (column.name == name) return column.values;
    return Spectrum();
  };
  const Spectrum white = patch("ISO white 9.5"), black(white.size(), 0.0), even(white.size(), 1.0);
  const std::array<Spectrum, Room::kWalls> walls = {white, white, patch("ISO red"), patch("ISO green"), white, black};
  const auto error = [&](const ReflectionOperator& op, const Spectrum& light) {
    RoomCase box = room(eye, eye.normalized(light), walls);
    box.truth[5] = {};
    double luminance = 0;  // of the four walls
    for (std::size_t i = 1; i < 5; ++i) luminance += xyz_d65_from_rgb(box.truth[i]).Y / 4;
    box.exposure = 0.18 / luminance;
    return mean_error(op, {box}) * 5 / 4;
  };
  EXPECT_NEAR(error(fitted_operator(), even), 0.30, 0.01);
  EXPECT_NEAR(error(component_wise(), even), 0.26, 0.01);
  EXPECT_NEAR(error(fitted_operator(), patch("ISO cyan")), 1.03, 0.01);
  EXPECT_NEAR(error(component_wise(), patch("ISO cyan")), 1.09, 0.01);
}

// The limits of scripts/fit-operator: what red paint keeps in cyan light, green paint in cyan light, and green and blue
// in the light of the other two.
bool within_limits(const ReflectionOperator& op) {
  constexpr double kRounding = 1e-3;
  const Rgb red_in_cyan = reflected(op, {1, 0, 0}, {0, 1, 1}), green_in_cyan = reflected(op, {0, 1, 0}, {0, 1, 1});
  return red_in_cyan.x >= 0.05 - kRounding && green_in_cyan.x >= -kRounding && op.k[1][1][1] <= 0.995 + kRounding &&
         op.k[2][2][2] <= 0.995 + kRounding;
}

// The pairs of scripts/fit-operator: a step of 0.02 in any of the nine numbers makes their error larger or leaves the
// limits. The table has 0.7 of these numbers.
TEST_F(ReflectionEvidence, TheTableIsTheLeastOfItsKindOnWhatItWasFittedTo) {
  std::vector<Spectrum> twice;
  for (const Spectrum& light : spectra.fit_lights)
    for (const Spectrum& paint : spectra.fit_paints) twice.push_back(times(eye.normalized(light), paint));
  const auto lamps = pairs(eye, spectra.fit_lights, spectra.fit_paints),
             filtered = pairs(eye, spectra.fit_paints, spectra.fit_paints),
             both = pairs(eye, twice, spectra.fit_paints);
  const auto objective = [&](const ReflectionOperator& op) {
    return mean_error(op, lamps) + 2 * mean_error(op, filtered) + 2 * mean_error(op, both);
  };
  constexpr double kShare = 0.7;
  const ReflectionOperator plain = component_wise();
  const auto times_from_plain = [&](double factor, ReflectionOperator op) {
    for (std::size_t c = 0; c < 3; ++c)
      for (std::size_t d = 0; d < 3; ++d)
        for (std::size_t e = 0; e < 3; ++e)
          op.k[c][d][e] = plain.k[c][d][e] + factor * (op.k[c][d][e] - plain.k[c][d][e]);
    return op;
  };
  const ReflectionOperator whole = times_from_plain(1 / kShare, fitted_operator());
  const double least = objective(whole);
  EXPECT_LT(least, objective(fitted_operator()));
  EXPECT_LT(objective(fitted_operator()), objective(plain));
  EXPECT_TRUE(within_limits(fitted_operator()));
  constexpr int kDifferences[3][3] = {{1, -1, 0}, {1, 0, -1}, {0, 1, -1}};
  int beyond = 0;
  for (std::size_t c = 0; c < 3; ++c)
    for (const auto& v : kDifferences)
      for (const double step : {-0.02, 0.02}) {
        ReflectionOperator op = whole;
        for (std::size_t d = 0; d < 3; ++d)
          for (std::size_t e = 0; e < 3; ++e) op.k[c][d][e] += step * v[d] * v[e];
        if (!within_limits(times_from_plain(kShare, op))) {
          ++beyond;
          continue;
        }
        EXPECT_GT(objective(op), least) << c << " " << step;
      }
  EXPECT_GE(beyond, 1);
  EXPECT_LE(beyond, 7);
}

}  // namespace
}  // namespace goniochrome::color::reflection_evidence_test
