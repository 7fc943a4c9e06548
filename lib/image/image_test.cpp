#include "image/image.h"

#include <Imath/half.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cmath>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <random>

#include "base/file.h"
#include "base/hard_case_for_test.h"
#include "base/scratch_for_test.h"

namespace goniochrome::image::image_test {
namespace {

using testing::HasSubstr;

class ImageFile : public testing::Test {
 protected:
  std::string path(const std::string& name) const { return folder_.path(name); }
  ScratchFolder folder_;
};

ImagePart random_part(const std::string& name, int width, int height, int channels, PixelType type) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> exponent(-6, 4);
  ImagePart part;
  part.name = name;
  part.type = type;
  part.image = {width, height, channels, {}, {}};
  for (int i = 0; i < width * height * channels; ++i) part.image.data.push_back(std::pow(10.0F, exponent(random)));
  return part;
}

bool maps_contain(const std::string& text) {
  std::ifstream maps("/proc/self/maps");
  const std::string all((std::istreambuf_iterator<char>(maps)), std::istreambuf_iterator<char>());
  return all.find(text) != std::string::npos;
}

TEST_F(ImageFile, ExrPartsOfTheirOwnSizeAndAttributesReturn) {
  std::vector<ImagePart> parts = {random_part("a", 5, 7, 3, PixelType::kFloat),
                                  random_part("b", 2, 12, 4, PixelType::kHalf),
                                  random_part("c", 9, 1, 1, PixelType::kFloat)};
  parts[0].attributes = {{"text", std::string("x y")},
                         {"number", 2.5F},
                         {"whole", 3},
                         {"unbounded", std::numeric_limits<float>::infinity()},
                         {"chromaticities", std::vector<float>{.64F, .33F, .3F, .6F, .15F, .06F, .3127F, .329F}},
                         {"envmap", std::string("cube")}};
  parts[2].attributes = {{"chromaticities", std::vector<float>{.64F, .33F, .3F, .6F, .15F, .06F, .3127F, .329F}}};
  parts[1].attributes = parts[2].attributes;
  ASSERT_TRUE(write_exr(path("x.exr"), parts).ok());
  const auto read = read_exr(path("x.exr"));
  ASSERT_TRUE(read.ok()) << read.error().message;
  ASSERT_EQ(read->size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    const ImagePart &want = parts[i], &got = read.value()[i];
    EXPECT_EQ(got.name, want.name);
    EXPECT_EQ(got.type, want.type);
    EXPECT_EQ(got.image.width, want.image.width);
    EXPECT_EQ(got.image.height, want.image.height);
    ASSERT_EQ(got.image.data.size(), want.image.data.size());
    for (std::size_t k = 0; k < want.image.data.size(); ++k) {
      if (want.type == PixelType::kFloat)
        ASSERT_EQ(got.image.data[k], want.image.data[k]);
      else  // half an ulp of 11 bits, or of the subnormals
        ASSERT_NEAR(got.image.data[k], want.image.data[k], std::max(want.image.data[k] * 0x1p-11F, 0x1p-25F));
    }
    for (const auto& [name, value] : want.attributes) EXPECT_EQ(got.attributes.at(name), value) << name;
  }
  EXPECT_EQ(read.value()[0].image.channel_names, (std::vector<std::string>{"R", "G", "B"}));
}

TEST_F(ImageFile, HalvesAreRoundedAndNotTruncated) {
  ImagePart part = random_part("a", 100, 100, 3, PixelType::kHalf);
  std::mt19937 random(5);
  std::uniform_real_distribution<float> one_to_two(1, 2);
  for (float& value : part.image.data) value = one_to_two(random);
  ASSERT_TRUE(write_exr(path("x.exr"), {part}).ok());
  const auto read = read_exr(path("x.exr"));
  ASSERT_TRUE(read.ok());
  double bias = 0;
  for (std::size_t i = 0; i < part.image.data.size(); ++i)
    bias += (read.value()[0].image.data[i] - part.image.data[i]) / part.image.data[i];
  // Truncation would give a mean of -2^-12 .. -2^-11; rounding gives 0 with a spread of 2^-12/sqrt(30000).
  EXPECT_LT(std::fabs(bias / part.image.data.size()), 0x1p-12 / std::sqrt(30000.0) * 4);
}

// Light in units of its own may be tiny everywhere; alpha says nothing of it.
TEST_F(ImageFile, APictureTooDarkForHalvesIsOneOfFloats) {
  ImagePart part{"dark", {2, 2, 4, std::vector<float>(16, 3e-9F), {}}, {}, PixelType::kHalf};
  for (std::size_t i = 3; i < 16; i += 4) part.image.data[i] = 1;
  ASSERT_TRUE(write_exr(path("x.exr"), {part}).ok());
  EXPECT_EQ(read_exr(path("x.exr")).value()[0].image.data, part.image.data);
  part.image.data[4] = 0.5F;  // dark pixels beside others
  ASSERT_TRUE(write_exr(path("x.exr"), {part}).ok());
  EXPECT_EQ(read_exr(path("x.exr")).value()[0].type, PixelType::kHalf);
}

// The textbook writer stores halves whatever comes: 70000 becomes Inf.
TEST_F(ImageFile, HardCase_PrefilterSunAValueBeyondHalfMakesThePartFloat) {
  ImagePart part = random_part("sun", 2, 2, 3, PixelType::kHalf);
  part.image.data[5] = 1e9F;
  ASSERT_TRUE(write_exr(path("x.exr"), {part}).ok());
  const auto read = read_exr(path("x.exr"));
  ASSERT_TRUE(read.ok());
  EXPECT_EQ(read.value()[0].type, PixelType::kFloat);
  EXPECT_EQ(read.value()[0].image.data, part.image.data);
  hard_case("prefilter-sun", {.what = "a texel of 1e9 after storing",
                              .textbook = static_cast<float>(half(1e9F)) / 1e9 - 1,
                              .ours = std::abs(read.value()[0].image.data[5] / 1e9 - 1),
                              .bound = 0,
                              .unit = "relative"});
}

TEST_F(ImageFile, AValueThatIsNotFiniteIsRefusedByPixel) {
  ImagePart part = random_part("depth", 3, 2, 3, PixelType::kFloat);
  part.image.data[3 * (3 + 2) + 1] = std::numeric_limits<float>::quiet_NaN();
  const auto written = write_exr(path("x.exr"), {part});
  ASSERT_FALSE(written.ok());
  EXPECT_THAT(written.error().message, HasSubstr("x.exr: part depth: pixel 2,1 channel G is nan"));
  EXPECT_FALSE(std::filesystem::exists(path("x.exr")));
}

TEST_F(ImageFile, EveryCutExrIsRefused) {
  ASSERT_TRUE(write_exr(path("x.exr"),
                        {random_part("a", 40, 40, 3, PixelType::kFloat), random_part("b", 40, 60, 3, PixelType::kHalf)})
                  .ok());
  const std::string whole = file_content(path("x.exr")).value();
  for (std::size_t size = 0; size < whole.size(); size += 1 + whole.size() / 97) {
    ASSERT_TRUE(write_file(path("cut.exr"), whole.substr(0, size)).ok());
    const auto read = read_exr(path("cut.exr"));
    ASSERT_FALSE(read.ok()) << size;
    EXPECT_THAT(read.error().message, HasSubstr("cut.exr: "));
  }
  const auto read = read_exr(path("absent.exr"));
  ASSERT_FALSE(read.ok());
  EXPECT_THAT(read.error().message, HasSubstr("absent.exr: cannot be read: No such file"));
}

TEST_F(ImageFile, DamagedExrNeverCrashes) {
  ASSERT_TRUE(write_exr(path("x.exr"), {random_part("a", 30, 30, 3, PixelType::kHalf)}).ok());
  const std::string whole = file_content(path("x.exr")).value();
  std::mt19937 random(3);
  int refused = 0;
  for (int i = 0; i < 300; ++i) {
    std::string hurt = whole;
    for (int k = 0; k < 3; ++k) hurt[random() % std::min<std::size_t>(hurt.size(), 400)] = static_cast<char>(random());
    ASSERT_TRUE(write_file(path("hurt.exr"), hurt).ok());
    if (!read_exr(path("hurt.exr")).ok()) ++refused;
  }
  EXPECT_GT(refused, 50);
}

TEST_F(ImageFile, AMissingModuleSaysWhereItWasLookedForAndWhatToDo) {
  ASSERT_TRUE(write_png(path("x.png"), {1, 1, 3, {0, 0, 0}, {}}).ok());
  setenv("GONIOCHROME_MODULE_PATH", "/nonexistent", 1);
  const auto read = read_image(path("x.png"));
  unsetenv("GONIOCHROME_MODULE_PATH");
  ASSERT_FALSE(read.ok());
  EXPECT_THAT(read.error().message, HasSubstr("/nonexistent/goniochrome-codecs.so: cannot be loaded"));
  EXPECT_THAT(read.error().message, HasSubstr("convert the image to EXR"));
}

// The libraries of other formats stay in the child process, and this one stays small.
TEST_F(ImageFile, NoPictureLoadsALibraryIntoThisProcess) {
  ASSERT_TRUE(write_exr(path("x.exr"), {random_part("a", 4, 2, 3, PixelType::kHalf)}).ok());
  ASSERT_TRUE(write_png(path("x.png"), {1, 1, 3, {0, 0, 0}, {}}).ok());
  for (const char* name : {"x.exr", "x.png", "x.png"}) ASSERT_TRUE(read_image(path(name)).ok());
  for (const char* library : {"goniochrome-codecs", "libpng", "OpenImageIO"}) EXPECT_FALSE(maps_contain(library));
}

TEST_F(ImageFile, PngReturnsWithinHalfAStepWithItsText) {
  Image image = {16, 16, 3, {}, {}};
  for (int i = 0; i < 16 * 16 * 3; ++i) image.data.push_back(static_cast<float>(i % 257) / 256.0F);
  image.data[0] = -1;
  image.data[1] = 2;
  image.data[2] = 0;
  ASSERT_TRUE(write_png(path("x.png"), image, {{"Software", std::string("goniochrome")}}).ok());
  const auto read = read_image(path("x.png"));
  ASSERT_TRUE(read.ok()) << read.error().message;
  EXPECT_EQ(std::get<std::string>(read->attributes.at("oiio:ColorSpace")), "sRGB");
  EXPECT_EQ(read->image.data[0], 0);
  EXPECT_EQ(read->image.data[1], 1);
  EXPECT_EQ(read->image.data[2], 0);
  for (std::size_t i = 3; i < image.data.size(); ++i)
    EXPECT_NEAR(read->image.data[i], image.data[i], 0.5 / 255 + 1e-6) << i;
  EXPECT_THAT(file_content(path("x.png")).value(), HasSubstr("Software"));
}

TEST_F(ImageFile, AnUnknownFormatIsRefusedByName) {
  ASSERT_TRUE(write_file(path("notes.hdr"), "these are notes").ok());
  const auto read = read_image(path("notes.hdr"));
  ASSERT_FALSE(read.ok());
  EXPECT_THAT(read.error().message, HasSubstr("notes.hdr: is none of the image formats that are read here"));
  EXPECT_FALSE(read_image(path("absent.hdr")).ok());
  EXPECT_THAT(read_image(path("")).error().message, HasSubstr("is a folder"));
}

TEST_F(ImageFile, TheContentTellsTheFormatAndTheNameDoesNot) {
  ASSERT_TRUE(write_png(path("x.iff"), {2, 1, 3, {1, 0, 0, 0, 0, 1}, {}}).ok());
  const auto read = read_image(path("x.iff"));
  ASSERT_TRUE(read.ok()) << read.error().message;
  EXPECT_EQ(read->image.data, (std::vector<float>{1, 0, 0, 0, 0, 1}));
}

TEST_F(ImageFile, WhatIsNotWantedIsRefusedByItsNameWhateverItIsCalled) {
  using std::string_literals::operator""s;
  const std::string tiff = "II*\0\x08\0\0\0\x01\0"s, rest(200, '\0');
  for (const auto& [content, what] : std::vector<std::pair<std::string, std::string>>{
           {"FOR4\0\0\0\x40"
            "CIMG"s +
                rest,
            "IFF"},
           {"GIF89a" + rest, "GIF"},
           {"8BPS" + rest, "Photoshop"},
           {"\0\0\0\x0cjP  "s + rest, "JPEG 2000"},
           {"\0\0\0\x18"
            "ftypheic"s +
                rest,
            "HEIF"},
           {"\x01\xda"s + rest, "SGI"},
           {std::string(128, '\0') + "DICM" + rest, "DICOM"},
           {"II*\0\x10\0\0\0CR\x02\0"s + rest, "camera's raw"},
           {tiff + "\xfe\0\x04\0\x01\0\0\0\x01\0\0\0"s + rest, "camera's raw"},
           {tiff + "\x12\xc6\x01\0\x04\0\0\0\x01\x04\0\0"s + rest, "camera's raw"},
           {"<?xml version" + rest, "XML"},
           {"RIFF\0\0\0\0WAVE"s + rest, "none of the image formats"}}) {
    ASSERT_TRUE(write_file(path("x.png"), content).ok());
    const auto read = read_image(path("x.png"));
    ASSERT_FALSE(read.ok()) << what;
    EXPECT_THAT(read.error().message, HasSubstr("x.png: "));
    EXPECT_THAT(read.error().message, HasSubstr(what));
    EXPECT_THAT(read.error().message, HasSubstr("convert it to EXR"));
  }
}

// A header alone, of a picture of 10000 x 10000: what it says must not be taken for granted.
TEST_F(ImageFile, AForgedSizeIsRefusedBeforeItTakesMemory) {
  ASSERT_TRUE(write_file(path("x.ppm"), "P6\n10000 10000\n255\n" + std::string(100, 'x')).ok());
  const auto read = read_image(path("x.ppm"));
  ASSERT_FALSE(read.ok());
  EXPECT_THAT(read.error().message, HasSubstr("more pixels than a file of its size can hold"));
}

// The textbook writer opens the target itself: a full disk leaves a stump that looks like a file.
TEST_F(ImageFile, HardCase_InterruptedAFullDiskLeavesTheOldFile) {
  ASSERT_TRUE(write_file(path("x.exr"), "old").ok());
  rlimit before = {};
  getrlimit(RLIMIT_FSIZE, &before);
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit limit = {4096, before.rlim_max};
  setrlimit(RLIMIT_FSIZE, &limit);
  const auto written = write_exr(path("x.exr"), {random_part("a", 100, 100, 3, PixelType::kFloat)});
  std::ofstream(path("stump.exr")) << std::string(100000, 'x');  // the control
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, old_handler);
  ASSERT_FALSE(written.ok());
  EXPECT_THAT(written.error().message, HasSubstr("x.exr: cannot be written: File too large"));
  hard_case("interrupted", {.what = "bytes of half a picture where the disk is full",
                            .textbook = static_cast<double>(std::filesystem::file_size(path("stump.exr"))),
                            .ours = file_content(path("x.exr")).value() == "old" ? 0.0 : 1.0,
                            .bound = 0,
                            .unit = "bytes"});
  std::filesystem::remove(path("stump.exr"));
  EXPECT_EQ(folder_.files(), 1u);
}

}  // namespace
}  // namespace goniochrome::image::image_test
