#include "image/surface_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "base/angles.h"
#include "base/scratch_for_test.h"
#include "base/testdata_for_test.h"

namespace goniochrome::image::surface_file_test {
namespace {

TEST(ColorMapFile, ReadsBackWhatWasWritten) {
  const ScratchFolder folder;
  const std::string path = folder.path("map.exr");
  brdf::ColorMap map = brdf::color_map_of_size(4, 1.45);
  for (std::size_t i = 0; i < map.factors.size(); ++i) map.factors[i] = 0.25f * static_cast<float>(i) - 1;
  ASSERT_TRUE(write_color_map(path, map, {{"made", std::string("here")}}).ok());
  const auto back = read_color_map(path);
  ASSERT_TRUE(back.ok()) << back.error().message;
  EXPECT_EQ(back->size, 4);
  EXPECT_DOUBLE_EQ(back->index, 1.45);
  EXPECT_EQ(back->factors, map.factors);  // quarters are exact in half precision
}

TEST(ColorMapFile, ModelAndDistancesAreKept) {
  const ScratchFolder folder;
  const std::string path = folder.path("map.exr");
  brdf::ColorMap map = brdf::color_map_of_size(2, 1.5);
  ASSERT_TRUE(write_color_map(path, map, {}).ok());
  EXPECT_FALSE(read_color_map(path)->aspecular);
  EXPECT_TRUE(read_color_map(path)->distance_deg.empty());
  map.aspecular = true;
  for (std::size_t i = 0; i < 8; ++i) map.distance_deg.push_back(static_cast<float>(i)), map.factors[3 * i] = 0.25F;
  ASSERT_TRUE(write_color_map(path, map, {}).ok());
  const auto back = read_color_map(path);
  ASSERT_TRUE(back.ok()) << back.error().message;
  EXPECT_TRUE(back->aspecular);
  EXPECT_EQ(back->distance_deg, map.distance_deg);
  EXPECT_EQ(back->factors, map.factors);
}

TEST(ColorMapFile, RefusesWhatIsNoMap) {
  const ScratchFolder folder;
  const std::string path = folder.path("no-map.exr");
  ASSERT_TRUE(write_exr(path, {{"", {4, 4, 3, std::vector<float>(48, 0.5f), {}}, {}, PixelType::kHalf}}).ok());
  const auto square = read_color_map(path);
  ASSERT_FALSE(square.ok());
  EXPECT_NE(square.error().message.find("twice as high as wide"), std::string::npos);
  const std::vector<float> values(24, 0.5f);
  ASSERT_TRUE(write_exr(path, {{"", {2, 4, 3, values, {}}, {{"goniochrome:index", 0.5f}}, PixelType::kHalf}}).ok());
  EXPECT_NE(read_color_map(path).error().message.find("from 1 to 4"), std::string::npos);
  ASSERT_TRUE(write_exr(path, {{"", {2, 4, 3, values, {}}, {}, PixelType::kHalf}}).ok());
  EXPECT_DOUBLE_EQ(read_color_map(path)->index, 1.5);
  EXPECT_FALSE(read_color_map(folder.path("absent.exr")).ok());
}

const std::vector<std::string> kChannels = {"diffuse.R", "diffuse.G", "diffuse.B", "lobe0.R", "lobe0.G",
                                            "lobe0.B",   "lobe0.x",   "lobe0.y",   "lobe0.z", "lobe0.n"};

class SbrdfFile : public testing::Test {
 protected:
  // Reads a 1x1 texture with these channels.
  Result<brdf::SbrdfTexture> read(const std::vector<std::string>& channels, const std::vector<float>& values) {
    const Image image{1, 1, static_cast<int>(channels.size()), values, channels};
    EXPECT_TRUE(write_exr(path_, {{"", image, {}, PixelType::kFloat}}).ok());
    return read_sbrdf(path_);
  }
  ScratchFolder folder_;
  const std::string path_ = folder_.path("one.sbrdf.exr");
};

TEST_F(SbrdfFile, ReadsWhateverTheOrderOfChannels) {
  const std::vector<float> values = {0.1F, 0.2F, 0.3F, 1, 2, 3, -1, -0.5F, 1, 40};
  const auto texture = read(kChannels, values);
  ASSERT_TRUE(texture.ok()) << texture.error().message;
  EXPECT_EQ(texture->lobes, 1);
  EXPECT_EQ(texture->values, (std::vector<float>{0.1F, 0.2F, 0.3F, 1, 0, 1, 2, 3, -1, -0.5F, 1, 40}));
  EXPECT_EQ(read({"diffuse.R", "diffuse.G", "diffuse.B"}, {1, 1, 1})->lobes, 0);
}

TEST_F(SbrdfFile, PartsOfOneSizeAreOneTexture) {
  const auto part = [](const char* name, int width, int first, int last) {
    const std::vector<std::string> channels(kChannels.begin() + first, kChannels.begin() + last);
    const auto n = static_cast<std::size_t>(width * (last - first));
    return ImagePart{name, {width, 1, last - first, std::vector<float>(n, 0.5F), channels}, {}, PixelType::kFloat};
  };
  ASSERT_TRUE(write_exr(path_, {part("diffuse", 2, 0, 3), part("lobe", 2, 3, 10)}).ok());
  const auto texture = read_sbrdf(path_);
  ASSERT_TRUE(texture.ok()) << texture.error().message;
  EXPECT_EQ(texture->lobes, 1);
  EXPECT_EQ(texture->texel(1, 0)[11], 0.5F);
  ASSERT_TRUE(write_exr(path_, {part("diffuse", 2, 0, 3), part("lobe", 4, 3, 10)}).ok());
  const std::string told = read_sbrdf(path_).error().message;
  EXPECT_NE(told.find("part lobe is 4 x 1, but part diffuse is 2 x 1"), std::string::npos) << told;
}

TEST_F(SbrdfFile, ReadsBackWhatWasWrittenWhateverStandsBeside) {
  const brdf::SbrdfTexture texture{1, 2, 1, {0.1F, 0.2F, 0.3F, 0.6F,  0.8F, 1, 2, 3, -1, -0.5F, 1, 40.7F,
                                             0.5F, 0.4F, 0.3F, -0.6F, 0.8F, 3, 2, 1, -1, -1,    1, 7}};
  const ImagePart beside{"capture", {1, 2, 3, {1, 0.5F, 0.01F, 0, 0, 0}, {"alpha", "certainty", "error"}}, {}};
  ASSERT_TRUE(write_sbrdf(path_, texture, {{"made", std::string("here")}}, {beside}).ok());
  const auto back = read_sbrdf(path_);
  ASSERT_TRUE(back.ok()) << back.error().message;
  EXPECT_EQ(back->height, 2);
  EXPECT_EQ(back->values, texture.values);
  EXPECT_EQ(read_exr(path_)->at(1).image.channel_names[1], "certainty");
}

TEST_F(SbrdfFile, FramesOfLobesAreReadBackBesideAlpha) {
  brdf::SbrdfTexture texture{
      1, 1, 2, {0.125F, 0.25F, 0.5F, 1, 0, 1, 2, 3, -1, -0.5F, 1, 40, 3, 2, 1, -1, -0.25F, 1, 7}};
  texture.turns = {0.6F, 0.8F, -1, 0};
  ASSERT_TRUE(write_sbrdf(path_, texture, {}).ok());
  const auto turned = read_sbrdf(path_);
  ASSERT_TRUE(turned.ok()) << turned.error().message;
  EXPECT_EQ(turned->values, texture.values);
  ASSERT_EQ(turned->turns.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(turned->turns[i], texture.turns[i], 5e-4) << "half precision";
  texture.alpha = {0.5F};
  ASSERT_TRUE(write_sbrdf(path_, texture, {}).ok());
  const auto covering = read_sbrdf(path_);
  EXPECT_EQ(covering->turns, turned->turns);
  EXPECT_EQ(covering->alpha, texture.alpha);
  texture.turns.clear(), texture.alpha.clear();
  ASSERT_TRUE(write_sbrdf(path_, texture, {}).ok());
  EXPECT_EQ(read_exr(path_)->front().image.channels, 19) << "no channels of frames where the texel's serves";
}

TEST_F(SbrdfFile, NormalsAreReadBackAndChecked) {
  brdf::SbrdfTexture texture{1, 2, 0, {0.1F, 0.2F, 0.3F, 1, 0, 0.1F, 0.2F, 0.3F, 1, 0}};
  texture.normals = {0.6F, 0, 0.8F, 0, 0, 1};
  ASSERT_TRUE(write_sbrdf(path_, texture, {}).ok());
  const auto back = read_sbrdf(path_);
  ASSERT_TRUE(back.ok()) << back.error().message;
  ASSERT_EQ(back->normals.size(), 6u);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(back->normals[i], texture.normals[i], 5e-4) << "half precision";
  EXPECT_NEAR(std::hypot(back->normals[0], back->normals[1], back->normals[2]), 1, 1e-6) << "unit again";
  texture.normals[5] = -1;
  ASSERT_TRUE(write_sbrdf(path_, texture, {}).ok());
  const std::string told = read_sbrdf(path_).error().message;
  EXPECT_NE(told.find("the normal of texel (0,1) is 0 0 -1: give a unit vector"), std::string::npos) << told;
  const std::string some = read({"diffuse.R", "diffuse.G", "diffuse.B", "normal.x"}, {1, 1, 1, 0}).error().message;
  EXPECT_NE(some.find("give normal.x, normal.y and normal.z, or none"), std::string::npos) << some;
}

// A file that another program had converted was read as if it had not been.
TEST_F(SbrdfFile, ColorsOfAnotherSpaceAreRefused) {
  const Image image{1, 1, 10, {0.1F, 0.2F, 0.3F, 1, 2, 3, -1, -0.5F, 1, 40}, kChannels};
  for (const auto& [id, wanted] : {std::pair{"lin_rec2020_scene", true}, {"lin_ap1_scene", false}}) {
    ASSERT_TRUE(write_exr(path_, {{"", image, {{"colorInteropID", std::string(id)}}, PixelType::kFloat}}).ok());
    EXPECT_EQ(read_sbrdf(path_).ok(), wanted) << id;
  }
}

TEST_F(SbrdfFile, TellsWhatIsWrong) {
  const std::vector<float> good = {0.1F, 0.2F, 0.3F, 1, 2, 3, -1, -0.5F, 1, 40};
  const auto told = [&](std::vector<std::string> channels, std::vector<float> values) {
    const auto refused = read(channels, values);
    return refused.ok() ? std::string("nothing") : refused.error().message;
  };
  auto channels = kChannels;
  channels[7] = "lobe0.q";
  EXPECT_NE(told(channels, good).find("channel lobe0.y is missing"), std::string::npos) << told(channels, good);
  channels = kChannels;
  channels.push_back("glow.R");
  auto values = good;
  values.push_back(1);
  EXPECT_NE(told(channels, values).find("glow.R is not known"), std::string::npos);
  channels.back() = "frame.c";
  EXPECT_NE(told(channels, values).find("frame.c and frame.s"), std::string::npos);
  values = good;
  values[9] = -1;
  EXPECT_NE(told(kChannels, values).find("lobe0.n of texel (0,0) is -1"), std::string::npos);
  values = good;
  values[6] = values[7] = values[8] = 0;
  EXPECT_NE(told(kChannels, values).find("the axes of lobe0 of texel (0,0) are 0"), std::string::npos);
  values[3] = values[4] = values[5] = 0;  // a lobe that reflects nothing needs no axes
  EXPECT_EQ(told(kChannels, values), "nothing");
  EXPECT_NE(told({"R", "G", "B"}, {1, 1, 1}).find("diffuse.R is missing"), std::string::npos);
}

TEST_F(SbrdfFile, ReadsBackWhatWasWritten) {
  const brdf::SbrdfTexture plain{2, 1, 1, {0.5F, 0.25F, 0, 1, 0, 1, 2, 3, -1, -0.5F, 1, 40,  //
                                           0,    0.5F,  1, 0, 1, 4, 5, 6, -1, -1,    1, 8}};
  ASSERT_TRUE(write_sbrdf(path_, plain, {{"made", std::string("here")}}).ok());
  const auto parts = read_exr(path_);
  EXPECT_EQ(parts->front().type, PixelType::kHalf);
  EXPECT_EQ(attribute_or<std::string>(parts->front().attributes, "made", ""), "here");
  EXPECT_EQ(read_sbrdf(path_)->values, plain.values);
  // The axis 1.0005 of a lobe of 3000 makes it 4.5 times as strong; a half would make it 1. So would 1.3 another
  // number.
  for (const auto& [at, value] : {std::pair{8U, -1.0005F}, {11U, 1.3F}}) {
    brdf::SbrdfTexture sharp = plain;
    sharp.values[11] = 3000, sharp.values[at] = value;
    ASSERT_TRUE(write_sbrdf(path_, sharp, {}).ok());
    EXPECT_EQ(read_sbrdf(path_)->values, sharp.values);
  }
}

TEST_F(SbrdfFile, ReadsTheTexturesOfTheTestData) {
  for (const auto& [name, lobes] : {std::pair{"brushed", 3}, {"nameplate", 3}, {"wood", 1}}) {
    const auto texture = read_sbrdf(testdata(std::string(name) + ".sbrdf.exr"));
    ASSERT_TRUE(texture.ok()) << texture.error().message;
    EXPECT_EQ(texture->lobes, lobes);
    EXPECT_EQ(texture->width, 128);
    // No texel sends back more than it gets, as far as its lobes about the mirror direction tell at normal incidence.
    double most = 0;
    for (int row = 0; row < texture->height; ++row)
      for (int column = 0; column < texture->width; ++column) {
        const brdf::SbrdfTexel texel = brdf::sbrdf_texel(*texture, column, row);
        double albedo = kPi * texel.surface.diffuse.x;
        for (const brdf::LafortuneLobe& lobe : texel.surface.lobes)
          albedo += brdf::environment_fetch(lobe, {0, 0, 1}).weight.x;
        most = std::max(most, albedo);
      }
    EXPECT_LE(most, 1) << name;
    EXPECT_GT(most, 0.1) << name;
  }
}

}  // namespace
}  // namespace goniochrome::image::surface_file_test
