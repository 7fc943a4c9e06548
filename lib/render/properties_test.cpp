// Laws that hold for any paint, light and direction, on random ones. Every test prints its seed; GONIOCHROME_SEED tries
// another.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "base/angles.h"
#include "base/scratch_for_test.h"
#include "brdf/isoline.h"
#include "brdf/lafortune.h"
#include "brdf/lobe_model.h"
#include "brdf/ward.h"
#include "fit/paint_fit.h"
#include "formats/paint_source.h"
#include "formats/xml.h"
#include "prefilter/prefilter.h"
#include "render/exact.h"
#include "render/scenes_for_test.h"

namespace goniochrome::render::properties_test {
namespace {

std::uint64_t seed() {
  const char* text = std::getenv("GONIOCHROME_SEED");
  return text ? std::strtoull(text, nullptr, 10) : 1;
}

class Property : public ::testing::Test {
 protected:
  void SetUp() override {
    fmt::print("seed {}\n", seed());
    RecordProperty("seed", std::to_string(seed()));
  }

  double between(double low, double high) { return low + (high - low) * next_(); }
  double log_between(double low, double high) { return low * std::pow(high / low, next_()); }
  int count(int low, int high) { return low + static_cast<int>(next_() * (high - low + 1)); }
  color::Rgb color(double most) { return {between(0, most), between(0, most), between(0, most)}; }

  Vec3 direction() {
    const double z = between(-1, 1), azimuth = between(0, 2 * kPi), s = std::sqrt(1 - z * z);
    return {s * std::cos(azimuth), s * std::sin(azimuth), z};
  }
  // Half of them within 6 degrees of the horizon.
  Vec3 above_horizon() {
    Vec3 d = direction();
    d.z = std::abs(d.z) * (next_() < 0.5 ? 1 : 0.1);
    return normalized(d);
  }

  // Lobes from nearly matt to sharper than a texel. Their energies with the diffuse part's sum to `energy` per channel.
  paint::LobeFit paint(double energy, bool with_gloss) {
    paint::LobeFit fit;
    const int lobes = count(1, 6);
    color::Rgb share = color(1);
    color::Rgb sum = share;
    fit.diffuse = (1 / kPi) * share;
    for (int i = 0; i < lobes; ++i) {
      paint::Lobe lobe;
      lobe.exponent = log_between(0.5, 5000);
      const double full = 2 * kPi / (lobe.exponent + 1);
      share = color(1);
      (with_gloss && i % 2 ? lobe.gloss : lobe.directional_diffuse) = (1 / full) * share;
      sum = sum + share;
      fit.lobes.push_back(lobe);
    }
    const double scale = energy / std::max({sum.x, sum.y, sum.z});
    fit.diffuse = scale * fit.diffuse;
    for (paint::Lobe& lobe : fit.lobes) {
      lobe.directional_diffuse = scale * lobe.directional_diffuse;
      lobe.gloss = scale * lobe.gloss;
    }
    std::ranges::sort(fit.lobes, {}, &paint::Lobe::exponent);
    return fit;
  }

  // Radiances that are multiples of 1/16, so that sums and doubles of them are exact; one texel in fifty is a lamp.
  std::vector<float> radiances(int width, int height) {
    std::vector<float> rgb(3 * static_cast<std::size_t>(width) * height);
    for (float& value : rgb) value = static_cast<float>(count(1, 32)) / 16 * (next_() < 0.02 ? 256.0F : 1.0F);
    return rgb;
  }

  static envmap::Environment environment(int width, int height, const std::vector<float>& rgb) {
    return envmap::Environment::from_lat_long({width, height, 3, rgb, {}}, envmap::Environment::BadPixels::kError,
                                              "random.exr")
        .value();
  }

  // Points that see their surface at any angle; `paints` must outlive them.
  std::vector<SurfacePoint> points(const std::vector<paint::LobeFit>& paints) {
    std::vector<SurfacePoint> points;
    for (const paint::LobeFit& fit : paints) {
      SurfacePoint point;
      point.normal = direction();
      point.to_viewer = direction();
      if (dot(point.normal, point.to_viewer) < 0) point.to_viewer = -point.to_viewer;
      point.paint = &fit;
      points.push_back(point);
    }
    return points;
  }

  std::vector<paint::LobeFit> paints(int n, double energy, bool with_gloss) {
    std::vector<paint::LobeFit> all;
    for (int i = 0; i < n; ++i) all.push_back(paint(energy, with_gloss));
    return all;
  }

 private:
  TestNumbers next_{seed()};
};

double relative(double a, double b) {
  return a == b ? 0 : std::abs(a - b) / std::max(std::abs(a), std::abs(b));
}

double relative(const color::Rgb& a, const color::Rgb& b) {
  return std::max({relative(a.x, b.x), relative(a.y, b.y), relative(a.z, b.z)});
}

// Flake light, Ward's lobe, generalized cosine lobes and isolines know no difference between light and viewer; gloss
// lobes, divided by the light's cosine alone, do.
TEST_F(Property, LightAndViewerTradePlaces) {
  for (int trial = 0; trial < 20000; ++trial) {
    const Vec3 i = above_horizon(), o = above_horizon(), normal = {0, 0, 1};
    const paint::LobeFit flakes = paint(1, false);
    // cos^5000 turns a rounding of the angle into 5000 times as much of the value at most, wherever it is not tiny.
    EXPECT_LE(relative(brdf::brdf(flakes, i, o, normal), brdf::brdf(flakes, o, i, normal)), 1e-10);

    const paint::Anisotropy alpha = {log_between(0.01, 1), log_between(0.01, 1)};
    EXPECT_LE(relative(brdf::ward(i, o, alpha), brdf::ward(o, i, alpha)), 1e-9);

    brdf::Lafortune surface;
    surface.diffuse = color(0.3);
    surface.lobes = {{color(1), {between(-1, 1), between(-1, 1), between(-1, 1)}, log_between(0.5, 2000)}};
    EXPECT_LE(relative(brdf::brdf(surface, i, o), brdf::brdf(surface, o, i)), 1e-12);

    for (const brdf::CriticalAngle treatment : {brdf::CriticalAngle::kClip, brdf::CriticalAngle::kSlide,
                                                brdf::CriticalAngle::kSlideMap, brdf::CriticalAngle::kIndexOne}) {
      const double index = between(1, 2);
      const brdf::InPlane there = brdf::equivalent_in_plane(i, o, index, treatment);
      const brdf::InPlane back = brdf::equivalent_in_plane(o, i, index, treatment);
      EXPECT_NEAR(there.cos_far, back.cos_far, 1e-12);
      EXPECT_NEAR(there.cos_near, back.cos_near, 1e-12);
    }
  }
}

// A furnace: where all light is 1, nothing that reflects all it gets at most shows more than 1.
TEST_F(Property, NothingReflectsMoreThanItGets) {
  const envmap::Environment furnace = environment(16, 8, std::vector<float>(3 * 16 * 8, 1.0F));
  std::vector<paint::LobeFit> all = paints(200, 0.6, true);
  for (paint::LobeFit& fit : all) fit.lobes.push_back({paint::kMirrorExponent, {}, {0.4, 0.4, 0.4}});
  for (const color::Rgb& shown : reference_radiance(points(all), &furnace, {})) {
    // The texels are cut as finely as a lobe needs: the sum is right to the reference's own 1e-4.
    EXPECT_LE(std::max({shown.x, shown.y, shown.z}), 1 + 1e-4);
    EXPECT_GE(std::min({shown.x, shown.y, shown.z}), 0);
  }
}

// The picture of two lights is the sum of their pictures, in the reference and in the prefiltered maps.
TEST_F(Property, LightAddsUp) {
  constexpr int kWidth = 64, kHeight = 32;
  const std::vector<float> a = radiances(kWidth, kHeight), b = radiances(kWidth, kHeight);
  std::vector<float> sum(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) sum[i] = 2 * a[i] + b[i];
  const envmap::Environment in_a = environment(kWidth, kHeight, a), in_b = environment(kWidth, kHeight, b),
                            in_sum = environment(kWidth, kHeight, sum);

  const std::vector<paint::LobeFit> all = paints(50, 0.9, true);
  const std::vector<SurfacePoint> where = points(all);
  const auto by_a = reference_radiance(where, &in_a, {}), by_b = reference_radiance(where, &in_b, {}),
             by_sum = reference_radiance(where, &in_sum, {});
  for (std::size_t i = 0; i < where.size(); ++i) EXPECT_LE(relative(by_sum[i], 2 * by_a[i] + by_b[i]), 1e-11);

  prefilter::PrefilterRequest request;
  request.exponents = {log_between(30, 100), log_between(100, 1000)};
  request.diffuse = request.mirror = false;
  request.size = 16;
  request.tolerance = 1e-4;
  const auto maps = [&](const envmap::Environment& env) {
    return prefilter::prefiltered(env, request, prefilter::prefilter_plan(env, request),
                                  [](const envmap::PrefilteredLobe&, double) {});
  };
  const envmap::PrefilteredEnvironment of_a = maps(in_a), of_b = maps(in_b), of_sum = maps(in_sum);
  for (std::size_t lobe = 0; lobe < of_sum.lobes.size(); ++lobe) {
    const auto &a_texels = of_a.lobes[lobe].map.texels, &b_texels = of_b.lobes[lobe].map.texels,
               &sum_texels = of_sum.lobes[lobe].map.texels;
    for (std::size_t i = 0; i < sum_texels.size(); ++i) {
      // Each of the three keeps the tolerance, of itself.
      EXPECT_LE(relative(sum_texels[i], 2.0 * a_texels[i] + b_texels[i]), 2 * request.tolerance);
    }
  }
}

// A scene that turns with its light looks the same. A quarter turn about the vertical moves every texel onto another.
TEST_F(Property, TurningEverythingChangesNothing) {
  constexpr int kWidth = 64, kHeight = 32;
  const std::vector<float> rgb = radiances(kWidth, kHeight);
  const std::vector<paint::LobeFit> all = paints(50, 0.9, true);
  const std::vector<SurfacePoint> where = points(all);
  const auto before = [&] {
    const envmap::Environment env = environment(kWidth, kHeight, rgb);
    return std::pair{reference_radiance(where, &env, {}), env.direction(0, 15)};
  }();
  for (int quarters = 1; quarters < 4; ++quarters) {
    std::vector<float> turned_rgb(rgb.size());
    for (int row = 0; row < kHeight; ++row) {
      for (int column = 0; column < 3 * kWidth; ++column) {
        turned_rgb[static_cast<std::size_t>(3 * kWidth * row + (column + quarters * 3 * kWidth / 4) % (3 * kWidth))] =
            rgb[static_cast<std::size_t>(3 * kWidth * row + column)];
      }
    }
    const envmap::Environment env = environment(kWidth, kHeight, turned_rgb);
    const Vec3 to = env.direction(quarters * kWidth / 4, 15), from = before.second;
    const double cosine = (to.x * from.x + to.z * from.z) / (from.x * from.x + from.z * from.z);
    const double sine = (to.x * from.z - to.z * from.x) / (from.x * from.x + from.z * from.z);
    const auto turned = [&](const Vec3& d) { return Vec3{cosine * d.x + sine * d.z, d.y, cosine * d.z - sine * d.x}; };
    std::vector<SurfacePoint> there = where;
    for (SurfacePoint& point : there) {
      point.normal = turned(point.normal);
      point.to_viewer = turned(point.to_viewer);
    }
    const auto after = reference_radiance(there, &env, {});
    for (std::size_t i = 0; i < there.size(); ++i) EXPECT_LE(relative(after[i], before.first[i]), 1e-9);
  }
}

// A lobe more can stay at weight 0: the objective never rises. The sharpest lobe comes first, for the target between
// the face and specular depends on it.
TEST_F(Property, MoreLobesNeverFitWorse) {
  for (int trial = 0; trial < 40; ++trial) {
    paint::Paint designed;
    designed.name = "random";
    const double face = between(5, 130);
    designed.appearance = paint::Appearance{{face, between(-60, 60), between(-60, 60)},
                                            {between(1, face), between(-40, 40), between(-40, 40)},
                                            between(20, 180),
                                            {}};
    for (const fit::FitMethod method : {fit::FitMethod::kL1, fit::FitMethod::kL2}) {
      fit::FitOptions options;
      options.method = method;
      options.target = paint::TargetCurve::Kind::kCurve;
      formats::Basis basis;
      double least = 1e300;
      for (int lobes = 1; lobes <= 8; ++lobes) {
        basis.exponents.push_back(lobes == 1 ? log_between(50, 150) : log_between(0.5, basis.exponents.front()));
        formats::Basis sorted = basis;
        std::ranges::sort(sorted.exponents);
        const auto fit = fit::PaintFitter(sorted, options).fit(designed);
        ASSERT_TRUE(fit) << fit.error().message;
        EXPECT_LE(fit->report.objective, least * (1 + 1e-9)) << lobes << " lobes";
        least = std::min(least, fit->report.objective);
      }
    }
  }
}

// A paint read back is the paint written, to the last bit of every number.
TEST_F(Property, PaintXmlKeepsEveryBit) {
  const ScratchFolder scratch;
  std::vector<paint::Paint> written;
  for (int i = 0; i < 200; ++i) {
    paint::Paint p;
    p.name = fmt::format("paint {}", i);
    p.measurement.emplace();
    const int rows = count(1, 9);
    for (int row = 0; row < rows; ++row) {
      p.measurement->rows.push_back(
          {{45, 15.0 + row, false, 0, false}, {between(0, 150), between(-100, 100), log_between(1e-17, 100)}});
    }
    p.gloss = {{60, between(0, 100)}};
    p.appearance = paint::Appearance{{between(0, 150), between(-90, 90), between(-90, 90)},
                                     {between(0, 150), between(-90, 90), between(-90, 90)},
                                     between(15.01, 180),
                                     {}};
    p.lobes = paint(between(0, 3), true);
    p.lobes->basis = "random";
    p.lobes->method = "l2";
    written.push_back(p);
  }
  const std::string first = scratch.path("first.xml"), second = scratch.path("second.xml");
  const auto write = [](const std::string& path, const std::vector<paint::Paint>& paints) {
    auto writer = formats::PaintWriter::begin(OutputFile::create(path).value());
    ASSERT_TRUE(writer);
    for (const paint::Paint& p : paints) ASSERT_TRUE(writer->write(p));
    ASSERT_TRUE(writer->finish());
  };
  write(first, written);
  const auto read = formats::read_paints(first);
  ASSERT_TRUE(read) << read.error().message;
  ASSERT_EQ(read->size(), written.size());
  for (std::size_t i = 0; i < written.size(); ++i) {
    const paint::Paint &p = written[i], &q = (*read)[i];
    for (std::size_t row = 0; row < p.measurement->rows.size(); ++row) {
      EXPECT_EQ(p.measurement->rows[row].lab, q.measurement->rows[row].lab);
    }
    EXPECT_EQ(p.appearance->face, q.appearance->face);
    EXPECT_EQ(p.appearance->flop, q.appearance->flop);
    EXPECT_EQ(p.appearance->travel_deg, q.appearance->travel_deg);
    ASSERT_EQ(p.lobes->lobes.size(), q.lobes->lobes.size());
    for (std::size_t lobe = 0; lobe < p.lobes->lobes.size(); ++lobe) {
      EXPECT_EQ(p.lobes->lobes[lobe].exponent, q.lobes->lobes[lobe].exponent);
      EXPECT_EQ(p.lobes->lobes[lobe].gloss.y, q.lobes->lobes[lobe].gloss.y);
    }
  }
  write(second, *read);
  EXPECT_EQ(scratch.content("first.xml"), scratch.content("second.xml"));
}

}  // namespace
}  // namespace goniochrome::render::properties_test
