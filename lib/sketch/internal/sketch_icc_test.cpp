// Profiles are made here by Little CMS or byte by byte; what they mean is computed by the formulas they were made from.
#include "image/icc.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <lcms2.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>

#include "color/color.h"
#include "image/color_space.h"
#include "sketch/sketch_picture.h"

namespace goniochrome::sketch::sketch_icc_test {
namespace {

using testing::HasSubstr;

constexpr color::Xyz kD50{0.9642, 1, 0.8249};

std::string bytes_of(cmsHPROFILE profile) {
  cmsUInt32Number size = 0;
  cmsSaveProfileToMem(profile, nullptr, &size);
  std::string bytes(size, '\0');
  cmsSaveProfileToMem(profile, bytes.data(), &size);
  cmsCloseProfile(profile);
  return bytes;
}

// With the colorants of sRGB.
std::string rgb_profile(cmsToneCurve* curve) {
  const cmsCIExyY d65{.3127, .3290, 1};
  const cmsCIExyYTRIPLE primaries{{.64, .33, 1}, {.30, .60, 1}, {.15, .06, 1}};
  cmsToneCurve* curves[] = {curve, curve, curve};
  const std::string bytes = bytes_of(cmsCreateRGBProfile(&d65, &primaries, curves));
  cmsFreeToneCurve(curve);
  return bytes;
}

// IEC 61966-2-1.
cmsToneCurve* srgb_curve() {
  const double g_abcd[] = {2.4, 1 / 1.055, 0.055 / 1.055, 1 / 12.92, 0.04045};
  return cmsBuildParametricToneCurve(nullptr, 4, g_abcd);
}
double srgb_light(double signal) {
  return signal <= 0.04045 ? signal / 12.92 : std::pow((signal + 0.055) / 1.055, 2.4);
}

std::string gray_profile(double gamma) {
  cmsToneCurve* curve = cmsBuildGamma(nullptr, gamma);
  const std::string bytes = bytes_of(cmsCreateGrayProfile(cmsD50_xyY(), curve));
  cmsFreeToneCurve(curve);
  return bytes;
}

// The table profiles here are affine from signals to Lab, which their interpolation follows exactly.
color::Lab lab_of_inks(const float* inks) {
  const double c = inks[0], m = inks[1], y = inks[2], k = inks[3];
  return {100 - 30 * c - 25 * m - 8 * y - 32 * k, -35 * c + 60 * m - 5 * y, -40 * c - 5 * m + 70 * y};
}
color::Lab lab_of_signals(const float* rgb) {
  const double r = rgb[0], g = rgb[1], b = rgb[2];
  return {25 * r + 55 * g + 20 * b, 50 * (r - g), 45 * (g - b)};
}

template <color::Lab (*lab_of)(const float*), int channels>
cmsInt32Number sample(const cmsUInt16Number* in, cmsUInt16Number* out, void*) {
  float signals[channels];
  for (int c = 0; c < channels; ++c) signals[c] = static_cast<float>(in[c]) / 65535;
  const color::Lab lab = lab_of(signals);
  const cmsCIELab there{lab.L, lab.a, lab.b};
  cmsFloat2LabEncodedV2(out, &there);
  return 1;
}

std::string table_profile(cmsColorSpaceSignature space, int channels, cmsSAMPLER16 sampler) {
  cmsHPROFILE profile = cmsCreateProfilePlaceholder(nullptr);
  cmsSetProfileVersion(profile, 2.1);
  cmsSetDeviceClass(profile, cmsSigOutputClass);
  cmsSetColorSpace(profile, space);
  cmsSetPCS(profile, cmsSigLabData);
  cmsPipeline* pipeline = cmsPipelineAlloc(nullptr, static_cast<cmsUInt32Number>(channels), 3);
  cmsStage* table = cmsStageAllocCLut16bit(nullptr, 5, static_cast<cmsUInt32Number>(channels), 3, nullptr);
  cmsStageSampleCLut16bit(table, sampler, nullptr, 0);
  cmsPipelineInsertStage(pipeline, cmsAT_BEGIN, table);
  cmsWriteTag(profile, cmsSigAToB0Tag, pipeline);
  cmsPipelineFree(pipeline);
  return bytes_of(profile);
}
std::string cmyk_profile() {
  return table_profile(cmsSigCmykData, 4, sample<lab_of_inks, 4>);
}
std::string rgb_table_profile() {
  return table_profile(cmsSigRgbData, 3, sample<lab_of_signals, 3>);
}

// A row of pixels, with the names that an image file gives its channels.
image::Image row_of(int channels, const std::vector<float>& data) {
  image::Image image{static_cast<int>(data.size()) / channels, 1, channels, data, {}};
  if (channels == 4) image.channel_names = {"C", "M", "Y", "K"};
  return image;
}

// Every combination of five levels.
image::Image all_levels(int channels) {
  std::vector<float> data;
  const int count = static_cast<int>(std::pow(5, channels));
  for (int i = 0; i < count; ++i)
    for (int c = 0, rest = i; c < channels; ++c, rest /= 5) data.push_back(static_cast<float>(rest % 5) / 4);
  return row_of(channels, data);
}

color::Rgb pixel(const image::Image& image, int x) {
  const float* p = image.pixel(x, 0);
  return {p[0], p[1], p[2]};
}

// Relative to the white of the profile connection space.
color::Lab lab_d50(const color::Rgb& rgb) {
  return color::lab_from_xyz(adapted(color::xyz_d65_from_rgb(rgb), color::xyz_d65_from_rgb({1, 1, 1}), kD50), kD50);
}

// The profile's numbers are rounded to 1/65536, half of which the way to the working space, whose rows sum to less than
// 2.5, and three columns make 6e-5; the rounded exponent and slopes of the curve add less than 2e-5.
constexpr double kMatrixRounding = 1e-4;

TEST(SketchIcc, SrgbByItsProfileIsSrgbByItsFormula) {
  std::vector<float> signals;
  for (int i = 0; i < 256; ++i)
    for (const int level : {i, (7 * i) % 256, 255 - i}) signals.push_back(static_cast<float>(level) / 255);
  const image::Image image = row_of(3, signals);
  const auto light = image_through_icc(image, rgb_profile(srgb_curve()), "a.png");
  ASSERT_TRUE(light.ok()) << light.error().message;
  for (int i = 0; i < 256; ++i) {
    const color::Rgb s = pixel(image, i), found = pixel(*light, i);
    const color::Rgb expected = color::rec2020_from_rec709({srgb_light(s.x), srgb_light(s.y), srgb_light(s.z)});
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], expected[c], kMatrixRounding) << i;
  }
}

// A curve of 1024 numbers of 16 bits, as scanners and cameras write: half a number is 8e-6 of light.
TEST(SketchIcc, ACurveOfNumbersIsFollowed) {
  std::vector<cmsUInt16Number> numbers(1024);
  for (int i = 0; i < 1024; ++i)
    numbers[i] = static_cast<cmsUInt16Number>(std::lround(65535 * std::pow(i / 1023.0, 1.8)));
  const auto light = image_through_icc(row_of(3, {0.25F, 0.25F, 0.25F, 1, 0.5F, 0}),
                                       rgb_profile(cmsBuildTabulatedToneCurve16(nullptr, 1024, numbers.data())), "a");
  ASSERT_TRUE(light.ok()) << light.error().message;
  const color::Rgb orange = color::rec2020_from_rec709({1, std::pow(0.5, 1.8), 0});
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(pixel(*light, 0)[c], std::pow(0.25, 1.8), kMatrixRounding);
    EXPECT_NEAR(pixel(*light, 1)[c], orange[c], kMatrixRounding);
  }
}

TEST(SketchIcc, GrayIsNeutralAndFollowsItsCurve) {
  const auto light = image_through_icc(row_of(1, {0, 0.1F, 0.5F, 1}), gray_profile(2.2), "gray.png");
  ASSERT_TRUE(light.ok()) << light.error().message;
  int x = 0;
  for (const double signal : {0.0, 0.1, 0.5, 1.0}) {
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(pixel(*light, x)[c], std::pow(signal, 2.2), kMatrixRounding) << signal;
    ++x;
  }
  // A gray picture may have the profile of a display.
  const auto shown = image_through_icc(row_of(1, {0.5F}), rgb_profile(srgb_curve()), "gray.jpg");
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(pixel(*shown, 0)[c], srgb_light(0.5), kMatrixRounding);
}

// A step of the 16-bit encoding is 1/652.8 of L* and 1/256 of a* and b*. The table's entries and its answer are rounded
// to half a step each, and the signals to half of 1/65535, which is 0.001 for the steepest of the numbers: at most
// 0.003 in L* and 0.005 in a* and b*, which is 0.008 dE. The control is the rule of thumb for inks, or sRGB.
constexpr double kTableRounding_de = 0.01;

TEST(SketchIcc, TableProfilesAreFollowed) {
  for (const int channels : {3, 4}) {
    const image::Image image = all_levels(channels);
    const auto light = image_through_icc(image, channels == 4 ? cmyk_profile() : rgb_table_profile(), "a.tif");
    ASSERT_TRUE(light.ok()) << light.error().message;
    double most = 0, control = 0;
    for (int i = 0; i < image.width; ++i) {
      const float* s = image.pixel(i, 0);
      const color::Lab expected = channels == 4 ? lab_of_inks(s) : lab_of_signals(s);
      most = std::max(most, color::delta_e_76(lab_d50(pixel(*light, i)), expected));
      const float paper = channels == 4 ? 1 - s[3] : 1;
      const color::Rgb filters = channels == 4 ? color::Rgb{(1 - s[0]) * paper, (1 - s[1]) * paper, (1 - s[2]) * paper}
                                               : color::Rgb{srgb_light(s[0]), srgb_light(s[1]), srgb_light(s[2])};
      control = std::max(control, color::delta_e_76(lab_d50(filters), expected));
    }
    EXPECT_LE(most, kTableRounding_de) << channels;
    EXPECT_GE(control, 30) << channels;
  }
  const auto paper = image_through_icc(row_of(4, {0, 0, 0, 0}), cmyk_profile(), "a.tif");
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(pixel(*paper, 0)[c], 1, kMatrixRounding);
}

void put32(std::string& bytes, std::size_t at, std::uint32_t value) {
  for (int i = 0; i < 4; ++i) bytes[at + i] = static_cast<char>(value >> (24 - 8 * i));
}

// A profile with Display P3's colorants and a gamma of 2, written as ICC.1:2010 says.
std::string p3_profile() {
  const double xyz[3][3] = {{0.51512, 0.2412, -0.00105}, {0.29198, 0.69225, 0.04189}, {0.1571, 0.06657, 0.78407}};
  std::string bytes(132 + 6 * 12 + 3 * 20 + 14, '\0');
  put32(bytes, 0, static_cast<std::uint32_t>(bytes.size()));
  put32(bytes, 8, 0x02100000);
  bytes.replace(12, 12, "mntrRGB XYZ "), bytes.replace(36, 4, "acsp");
  put32(bytes, 128, 6);
  const std::size_t data = 132 + 6 * 12;
  const char* names[] = {"rXYZ", "gXYZ", "bXYZ", "rTRC", "gTRC", "bTRC"};
  for (int i = 0; i < 6; ++i) {
    bytes.replace(132 + 12 * i, 4, names[i]);
    put32(bytes, 136 + 12 * i, static_cast<std::uint32_t>(data + (i < 3 ? 20 * i : 60)));
    put32(bytes, 140 + 12 * i, i < 3 ? 20 : 14);
  }
  for (int i = 0; i < 3; ++i) {
    bytes.replace(data + 20 * i, 4, "XYZ ");
    for (int c = 0; c < 3; ++c)
      put32(bytes, data + 20 * i + 8 + 4 * c, static_cast<std::uint32_t>(std::lround(xyz[i][c] * 65536)));
  }
  bytes.replace(data + 60, 4, "curv");
  put32(bytes, data + 68, 1);
  bytes[data + 72] = 2, bytes[data + 73] = 0;
  return bytes;
}

// The white of the working space to the rounding of the profile's own numbers, 1/65536 and five digits.
TEST(SketchIcc, AMatrixProfileIsFollowed) {
  const auto light = image_through_icc(row_of(3, {1, 1, 1, 0.5F, 0.5F, 0.5F, 1, 0, 0}), p3_profile(), "p3.png");
  ASSERT_TRUE(light.ok()) << light.error().message;
  const color::Rgb white = pixel(*light, 0), gray = pixel(*light, 1), red = pixel(*light, 2);
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(white[c], 1, 1e-3);
    EXPECT_NEAR(gray[c], 0.25, 1e-3);
  }
  const color::Rgb srgb_red = color::rec2020_from_rec709({1, 0, 0});
  EXPECT_GT(red.x, srgb_red.x);  // P3's red is purer
  EXPECT_LT(red.y, srgb_red.y);
}

TEST(SketchIcc, ProfilesThatCannotBeFollowedAreRefusedWithTheRemedy) {
  std::string lab = p3_profile(), no_curve = p3_profile();
  lab.replace(16, 4, "Lab "), no_curve.replace(132 + 3 * 12, 4, "none");
  const image::Image rgb = row_of(3, {0.5F, 0.5F, 0.5F});
  for (const auto& [bytes, words] : {std::pair<std::string, std::string>{lab, "is for Lab"},
                                     {no_curve, "damaged"},
                                     {cmyk_profile(), "is for CMYK and its pixels are read as RGB"},
                                     {gray_profile(2), "is for gray and its pixels are read as RGB"},
                                     {p3_profile().substr(0, 100), "damaged"},
                                     {std::string(200, 'x'), "damaged"},
                                     {"x", "damaged"}}) {
    const auto light = image_through_icc(rgb, bytes, "a.png");
    ASSERT_FALSE(light.ok()) << words;
    EXPECT_THAT(light.error().message, HasSubstr("a.png: its ICC profile is"));
    EXPECT_THAT(light.error().message, HasSubstr(words));
    EXPECT_THAT(light.error().message, HasSubstr("convert the image to sRGB"));
  }
}

// Cut anywhere, or with any byte turned: an error or light, never a read past the end (the sanitizers look on).
TEST(SketchIcc, ADamagedProfileIsAnErrorOrFinite) {
  int refused = 0, followed = 0;
  const auto check = [&](const std::string& bytes, const image::Image& image) {
    const auto light = image_through_icc(image, bytes, "cut.png");
    ++(light.ok() ? followed : refused);
    if (!light.ok()) return;
    for (const float value : light->data) EXPECT_TRUE(std::isfinite(value));
  };
  const image::Image rgb = row_of(3, {0, 0.3F, 1, 1, 1, 1}), inks = row_of(4, {0, 0.3F, 1, 0.5F});
  for (const auto& [whole, image] : {std::pair<std::string, image::Image>{p3_profile(), rgb}, {cmyk_profile(), inks}}) {
    const std::size_t head = std::min<std::size_t>(whole.size(), 400);
    for (std::size_t at = 0; at < head; ++at) {
      check(whole.substr(0, at), image);
      std::string turned = whole;
      turned[at] = static_cast<char>(~turned[at]);
      check(turned, image);
    }
  }
  EXPECT_GT(refused, 400);
  EXPECT_GT(followed, 100);
}

class CmykFile : public testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directories(folder_); }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::string file(const std::string& name, const std::string& bytes) {
    const std::string path = (folder_ / name).string();
    std::ofstream(path, std::ios::binary) << bytes;
    return path;
  }
  std::filesystem::path folder_ = std::filesystem::temp_directory_path() / fmt::format("goniochrome-cmyk-{}", getpid());
};

constexpr unsigned char kInks[] = {51, 128, 26, 77};

// An uncompressed CMYK TIFF of 2 x 2 equal pixels; `profile` may be "".
std::string tiff(const std::string& profile) {
  std::string bytes("II*\0\0\0\0\0", 8);
  const auto put = [&](std::uint32_t value, int size) {
    for (int i = 0; i < size; ++i) bytes += static_cast<char>(value >> (8 * i));
  };
  for (int i = 0; i < 16; ++i) bytes += static_cast<char>(kInks[i % 4]);
  const auto depths = static_cast<std::uint32_t>(bytes.size());
  for (int i = 0; i < 4; ++i) put(8, 2);
  const auto icc = static_cast<std::uint32_t>(bytes.size());
  bytes += profile;
  if (bytes.size() % 2 != 0) bytes += '\0';
  for (int i = 0; i < 4; ++i) bytes[4 + i] = static_cast<char>(bytes.size() >> (8 * i));
  struct Entry {
    std::uint32_t tag, type, count, value;
  };
  std::vector<Entry> entries = {{256, 4, 1, 2}, {257, 4, 1, 2}, {258, 3, 4, depths}, {259, 4, 1, 1},  {262, 4, 1, 5},
                                {273, 4, 1, 8}, {277, 4, 1, 4}, {278, 4, 1, 2},      {279, 4, 1, 16}, {284, 4, 1, 1}};
  if (!profile.empty()) entries.push_back({34675, 7, static_cast<std::uint32_t>(profile.size()), icc});
  put(static_cast<std::uint32_t>(entries.size()), 2);
  for (const Entry& e : entries) put(e.tag, 2), put(e.type, 2), put(e.count, 4), put(e.value, 4);
  put(0, 4);
  return bytes;
}

TEST_F(CmykFile, ATiffOfInksIsWhatItsProfileSays) {
  const auto picture = read_picture(file("inks.tif", tiff(cmyk_profile())), PictureView::kPlain);
  ASSERT_TRUE(picture.ok()) << picture.error().message;
  EXPECT_EQ(picture->space, "its ICC profile");
  EXPECT_TRUE(picture->warnings.empty());
  float inks[4];
  for (int c = 0; c < 4; ++c) inks[c] = static_cast<float>(kInks[c]) / 255;
  for (int i = 0; i < 4; ++i) {
    EXPECT_LE(color::delta_e_76(lab_d50(pixel(picture->rgb, i)), lab_of_inks(inks)), kTableRounding_de);
    EXPECT_EQ(picture->state[i], Picture::kGood);
  }
}

TEST_F(CmykFile, InksWithoutAProfileAreFiltersAndAWarningSaysSo) {
  const auto picture = read_picture(file("inks.tif", tiff("")), PictureView::kPlain);
  ASSERT_TRUE(picture.ok()) << picture.error().message;
  ASSERT_EQ(picture->warnings.size(), 1U);
  EXPECT_THAT(picture->warnings[0], HasSubstr("inks.tif is CMYK without a profile"));
  const double paper = 1 - kInks[3] / 255.0;
  color::Rgb signals;
  for (int c = 0; c < 3; ++c) signals[c] = srgb_light(paper * (1 - kInks[c] / 255.0));
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(pixel(picture->rgb, 0)[c], color::rec2020_from_rec709(signals)[c], 1e-5);
  EXPECT_TRUE(image::read_image(file("again.tif", tiff("")))->image.channels ==
              3);  // who does not ask for inks gets RGB
}

// Environments, photographs and textures with a profile were read as if they had none.
TEST(IccProfile, TellsTheColorsOfEveryPicture) {
  image::ImagePart part{"", {1, 1, 3, {.5F, .5F, .5F}, {"R", "G", "B"}}, {{"goniochrome:integer", 1}}};
  EXPECT_NEAR(image::working_space_rgb(part, "x")->data[1], srgb_light(.5), 1e-6) << "control: nothing tells";
  part.attributes["ICCProfile"] = rgb_profile(cmsBuildGamma(nullptr, 1.8));
  EXPECT_NEAR(image::working_space_rgb(part, "x")->data[1], std::pow(.5, 1.8), 1e-3);
  // Floats may be brighter than white.
  part.attributes["goniochrome:integer"] = 0, part.attributes["ICCProfile"] = rgb_profile(cmsBuildGamma(nullptr, 1));
  part.image.data = {4, 4, 4};
  EXPECT_NEAR(image::working_space_rgb(part, "x")->data[1], 4, 1e-2);
  // A profile of inks says nothing of the RGB that another library made of them.
  part.attributes["goniochrome:inks"] = 1;
  EXPECT_NEAR(image::working_space_rgb(part, "x")->data[1], 4, 1e-6);
}

}  // namespace
}  // namespace goniochrome::sketch::sketch_icc_test
