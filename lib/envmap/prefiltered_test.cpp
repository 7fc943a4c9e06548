#include "envmap/prefiltered.h"

#include <Imath/half.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <random>

#include "envmap/mip.h"
#include "envmap/open_maps.h"
#include "image/exr.h"

namespace goniochrome::envmap::prefiltered_test {
namespace {

using testing::HasSubstr;

class EnvFile : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() / fmt::format("goniochrome-env-{}", getpid());
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  std::filesystem::path folder_;
};

PrefilteredLobe random_lobe(double exponent, int size, double tolerance, double low, double high) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> log_value(std::log(low), std::log(high));
  PrefilteredLobe lobe;
  lobe.exponent = exponent;
  lobe.tolerance = tolerance;
  lobe.method = "by hand";
  lobe.max_error = 3e-4, lobe.mean_error = 1e-5, lobe.verified_texels = 12, lobe.predicted_error = 2e-4;
  lobe.map = CubeMap(size);
  for (float& v : lobe.map.texels) v = static_cast<float>(std::exp(log_value(random)));
  return lobe;
}

PrefilteredEnvironment small_env() {
  PrefilteredEnvironment env;
  env.source = "hall.hdr";
  env.diffuse = random_lobe(1, 4, 1e-3, .1, 10);
  env.lobes = {random_lobe(1.3, 3, 1e-3, .1, 10), random_lobe(70, 8, 1e-4, .1, 10)};
  env.mirror = random_lobe(paint::kMirrorExponent, 16, 1e-3, .1, 1e5);
  return env;
}

TEST_F(EnvFile, EnvironmentReturnsAsRounded) {
  PrefilteredEnvironment env = small_env();
  for (PrefilteredLobe* lobe : {&env.diffuse, &env.lobes[0], &env.lobes[1], &env.mirror}) round_to_storage(*lobe);
  ASSERT_TRUE(write_env(path("x.env.exr"), env, "prefilter-envmap hall.hdr").ok());
  const auto read = read_env(path("x.env.exr"));
  ASSERT_TRUE(read.ok()) << read.error().message;
  EXPECT_EQ(read->source, "hall.hdr");
  ASSERT_EQ(read->lobes.size(), 2U);
  EXPECT_EQ(read->diffuse.map.texels, env.diffuse.map.texels);
  EXPECT_EQ(read->lobes[0].map.texels, env.lobes[0].map.texels);
  EXPECT_EQ(read->lobes[1].map.texels, env.lobes[1].map.texels);
  EXPECT_EQ(read->mirror.map.texels, env.mirror.map.texels);
  EXPECT_EQ(read->mirror.exponent, paint::kMirrorExponent);
  EXPECT_FLOAT_EQ(static_cast<float>(read->lobes[0].max_error), 3e-4F);
  EXPECT_EQ(read->lobes[0].verified_texels, 12);
  EXPECT_EQ(read->lobes[0].method, "by hand");
  EXPECT_EQ(read->lobe(1.3), &read->lobes[0]);  // the file holds the float 1.3
  EXPECT_EQ(read->lobe(1), &read->diffuse);
  EXPECT_EQ(read->lobe(paint::kMirrorExponent), &read->mirror);
  EXPECT_EQ(read->lobe(71), nullptr);
}

// Halves are kept where they meet the tolerance; the textbook writer always stores them.
TEST_F(EnvFile, StorageKeepsTheTolerance) {
  for (const double tolerance : {1e-2, 1e-3, 3e-4, 1e-5}) {
    PrefilteredLobe lobe = random_lobe(6, 16, tolerance, .1, 10);
    const CubeMap before = lobe.map;
    round_to_storage(lobe);
    EXPECT_EQ(storage_type(lobe), tolerance >= 1e-3 ? image::PixelType::kHalf : image::PixelType::kFloat);
    double worst = 0, worst_half = 0;
    for (std::size_t i = 0; i < before.texels.size(); ++i) {
      worst = std::max(worst, std::fabs(lobe.map.texels[i] / double(before.texels[i]) - 1));
      worst_half = std::max(
          worst_half, std::fabs(static_cast<float>(Imath::half(before.texels[i])) / double(before.texels[i]) - 1));
    }
    EXPECT_LE(worst, tolerance >= 1e-3 ? 0x1p-11 : tolerance / 64);
    EXPECT_EQ(worst_half > tolerance, tolerance < 4e-4);  // the control: what halves would cost
  }
}

TEST_F(EnvFile, HardCase_PrefilterSunStorageNeverOverflowsOrLosesTheDark) {
  EXPECT_EQ(storage_type(random_lobe(6, 4, 1e-2, 1, 1e9)), image::PixelType::kFloat);
  EXPECT_EQ(storage_type(random_lobe(6, 4, 1e-2, 1e-9, 1e-8)), image::PixelType::kFloat);  // halves end at 6e-8
  EXPECT_EQ(storage_type(random_lobe(6, 4, 1e-2, 1, 60000)), image::PixelType::kHalf);
}

TEST_F(EnvFile, MipMappedCubesComeBackAsLobes) {
  std::vector<PrefilteredLobe> levels;
  const auto exponents = mip_exponents({16}, 16);
  ASSERT_TRUE(exponents.ok());
  for (std::size_t i = 0; i < exponents->size(); ++i) {
    levels.push_back(random_lobe((*exponents)[i], 16 >> i, 1e-2, .1, 10));
    round_to_storage(levels.back());
  }
  ASSERT_TRUE(write_mip(path("m.exr"), levels, "sky.exr", "test").ok());
  const auto env = read_env(path("m.exr"));
  ASSERT_TRUE(env.ok()) << env.error().message;
  EXPECT_EQ(env->source, "sky.exr");
  ASSERT_EQ(env->lobes.size(), 4u);  // 16, 4, 1, 1/4; the last level is of exponent 0
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(env->lobes[3 - i].exponent, levels[i].exponent);
    EXPECT_EQ(env->lobes[3 - i].map.texels, levels[i].map.texels) << i;
  }
  EXPECT_EQ(env->diffuse.map.texels, levels[2].map.texels);
  // No level for the diffuse light.
  for (PrefilteredLobe& level : levels) level.exponent *= 3;
  ASSERT_TRUE(write_mip(path("n.exr"), levels, "sky.exr", "test").ok());
  EXPECT_THAT(read_env(path("n.exr")).error().message, HasSubstr("no level has the exponent 1"));
}

PrefilteredEnvironment env_with_spots() {
  PrefilteredEnvironment env = small_env();
  env.spots = {{normalized({1, 2, 3}), {0.05, 0.04, 0.03}, 0.1}, {normalized({-3, 1, 0}), {0.02, 0.02, 0.03}, 0.4}};
  for (PrefilteredLobe* lobe : {&env.diffuse, &env.lobes[0], &env.lobes[1], &env.mirror}) round_to_storage(*lobe);
  return env;
}

// The largest difference of two maps, relative to the second, and absolute below the smallest normal half.
double apart(const CubeMap& a, const CubeMap& b) {
  EXPECT_EQ(a.texels.size(), b.texels.size());
  double most = 0;
  for (std::size_t i = 0; i < a.texels.size(); ++i)
    most = std::max<double>(most, std::abs(a.texels[i] - b.texels[i]) / std::max(0x1p-14F, std::abs(b.texels[i])));
  return most;
}

// The control is how far the maps with the spots are from those without.
TEST_F(EnvFile, MapsThatFollowFromOthersComeBackRoundedToTheHalvesOfTheFile) {
  PrefilteredEnvironment env = env_with_spots();
  ASSERT_TRUE(write_env(path("plain.env.exr"), env, "test").ok());
  keep_open_maps(env);
  ASSERT_TRUE(write_env(path("kept.env.exr"), env, "test").ok());
  const auto plain = read_env(path("plain.env.exr")), kept = read_env(path("kept.env.exr"));
  ASSERT_TRUE(plain.ok() && kept.ok());
  EXPECT_EQ(plain->coat_diffuse, nullptr);
  EXPECT_EQ(plain->lobes[1].open, nullptr);
  // Readers that do not know them find the same environment as in a file without them.
  EXPECT_EQ(kept->spots, plain->spots);
  EXPECT_EQ(kept->diffuse.map.texels, plain->diffuse.map.texels);
  EXPECT_EQ(kept->lobes[1].map.texels, plain->lobes[1].map.texels);
  const std::size_t all = env.spots.size();
  const auto check = [&](const MapPointer& read, const MapPointer& made, const CubeMap& with_spots) {
    ASSERT_NE(read, nullptr);
    EXPECT_LE(apart(*read, *made), 0x1p-11);
    EXPECT_GT(apart(*read, with_spots), 0.01);
  };
  check(kept->diffuse.open, open_diffuse_map(*plain, all), plain->diffuse.map);
  check(kept->open_coat_diffuse, open_coat_diffuse_map(*plain, all), *coat_diffuse_map(*plain));
  ASSERT_NE(kept->coat_diffuse, nullptr);
  EXPECT_LE(apart(*kept->coat_diffuse, *coat_diffuse_map(*plain)), 0x1p-11);
  for (std::size_t i = 0; i < 2; ++i) {
    ASSERT_NE(kept->lobes[i].open, nullptr);
    EXPECT_LE(apart(*kept->lobes[i].open, *open_map(*plain, plain->lobes[i], all)), 0x1p-11);
  }
  EXPECT_GT(apart(*kept->lobes[0].open, plain->lobes[0].map), 0.01);
  // For fewer spots, and for none, maps are made anew.
  EXPECT_EQ(open_map(*kept, kept->lobes[1], 1)->texels, open_map(*plain, plain->lobes[1], 1)->texels);
  EXPECT_EQ(open_map(*kept, kept->lobes[1], 0).get(), &kept->lobes[1].map);
}

TEST_F(EnvFile, LobesThatAreNotWantedAreNotDecoded) {
  PrefilteredEnvironment env = env_with_spots();
  keep_open_maps(env);
  ASSERT_TRUE(write_env(path("kept.env.exr"), env, "test").ok());
  const auto read = read_env(path("kept.env.exr"), [](double exponent) { return std::abs(exponent - 70) < 1; });
  ASSERT_TRUE(read.ok());
  ASSERT_EQ(read->lobes.size(), 1U);
  EXPECT_EQ(read->lobes[0].map.size, 8);
  ASSERT_NE(read->lobes[0].open, nullptr);
  EXPECT_EQ(read->lobes[0].open->size, 8);
}

TEST_F(EnvFile, PartsOfAnotherVersionAreLeftAloneAndThoseOfAnotherSizeAreRefused) {
  PrefilteredEnvironment env = env_with_spots();
  keep_open_maps(env);
  ASSERT_TRUE(write_env(path("kept.env.exr"), env, "test").ok());
  const auto changed = [&](const std::string& name, auto change) {
    auto parts = image::read_exr(path("kept.env.exr"));
    EXPECT_TRUE(parts.ok());
    for (image::ImagePart& part : *parts)
      if (part.name == "open-lobe-001") change(part);
    EXPECT_TRUE(image::write_exr(path(name), *parts).ok());
    return read_env(path(name));
  };
  const auto later = changed("later.env.exr", [](auto& part) { part.attributes["goniochrome:version"] = 2; });
  ASSERT_TRUE(later.ok());
  EXPECT_EQ(later->lobes[1].open, nullptr);
  EXPECT_NE(later->lobes[0].open, nullptr);
  const auto small = changed("small.env.exr", [](auto& part) {
    part.image = {4, 24, 3, std::vector<float>(4 * 24 * 3, 1.0F), part.image.channel_names};
  });
  ASSERT_FALSE(small.ok());
  EXPECT_THAT(small.error().message, HasSubstr("part open-lobe-001: has 4 texels along a face, and the map that it "
                                               "follows from has 8"));
}

TEST_F(EnvFile, OtherFilesAreRefusedByPart) {
  ASSERT_TRUE(
      image::write_exr(path("p.exr"), {{"", {2, 2, 3, std::vector<float>(12, 1.0F), {}}, {}, image::PixelType::kHalf}})
          .ok());
  EXPECT_THAT(read_env(path("p.exr")).error().message, HasSubstr("p.exr: has no part `diffuse`"));
  image::ImagePart part = {"diffuse", {2, 12, 3, std::vector<float>(72, 1.0F), {}}, {}, image::PixelType::kHalf};
  ASSERT_TRUE(image::write_exr(path("q.exr"), {part}).ok());
  EXPECT_THAT(read_env(path("q.exr")).error().message, HasSubstr("q.exr: part diffuse: attribute goniochrome:texels"));
  part.image.height = 6;
  part.image.width = 4;
  ASSERT_TRUE(image::write_exr(path("r.exr"), {part}).ok());
  EXPECT_THAT(read_env(path("r.exr")).error().message, HasSubstr("is 4 x 6, not a strip of six faces"));
}

}  // namespace
}  // namespace goniochrome::envmap::prefiltered_test
