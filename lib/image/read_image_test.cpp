// The inks of CMYK JPEGs, which libjpeg writes here; other formats are tested in image_test.cpp and hdr_test.cpp.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <vector>
// libjpeg's headers want <cstdio> before them.
#include <jpeglib.h>

#include "base/file.h"
#include "base/scratch_for_test.h"
#include "image/color_space.h"
#include "image/image.h"

namespace goniochrome::image::read_image_test {
namespace {

using testing::HasSubstr;

constexpr int kWidth = 24, kHeight = 16;

// A smooth slope of each ink, 0..255.
int ink(int x, int y, int c) {
  const int values[] = {10 * x, 15 * y, 255 - 10 * x, 5 * x + 5 * y};
  return values[c];
}

// A JPEG of quality 100 and of that many samples a pixel. `set_up` chooses what follows from the defaults, `start` may
// write markers, and `row` gives the samples of a row.
std::string jpeg(int width, int height, int samples, J_COLOR_SPACE space,
                 const std::function<void(jpeg_compress_struct&)>& set_up,
                 const std::function<void(jpeg_compress_struct&)>& start,
                 const std::function<std::vector<JSAMPLE>(int)>& row) {
  jpeg_compress_struct info{};
  jpeg_error_mgr errors{};
  info.err = jpeg_std_error(&errors);
  jpeg_create_compress(&info);
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&info, &bytes, &size);
  info.image_width = static_cast<JDIMENSION>(width), info.image_height = static_cast<JDIMENSION>(height);
  info.input_components = samples, info.in_color_space = space;
  jpeg_set_defaults(&info);
  set_up(info);
  jpeg_set_quality(&info, 100, TRUE);
  jpeg_start_compress(&info, TRUE);
  start(info);
  for (int y = 0; y < height; ++y) {
    std::vector<JSAMPLE> values = row(y);
    JSAMPLE* pointer = values.data();
    jpeg_write_scanlines(&info, &pointer, 1);
  }
  jpeg_finish_compress(&info);
  std::string content(reinterpret_cast<char*>(bytes), size);
  jpeg_destroy_compress(&info);
  std::free(bytes);
  return content;
}

// A JPEG of inks. With `adobe` the inks are stored inverted, so that paper is 255, as Adobe's programs do. `space` is
// JCS_CMYK or JCS_YCCK.
std::string cmyk_jpeg(bool adobe, J_COLOR_SPACE space) {
  const auto set_up = [&](jpeg_compress_struct& info) {
    jpeg_set_colorspace(&info, space);
    for (int c = 0; c < 4; ++c) info.comp_info[c].h_samp_factor = info.comp_info[c].v_samp_factor = 1;
    info.write_Adobe_marker = adobe ? TRUE : FALSE;
  };
  return jpeg(
      kWidth, kHeight, 4, JCS_CMYK, set_up, [](jpeg_compress_struct&) {},
      [&](int y) {
        std::vector<JSAMPLE> row;
        for (int x = 0; x < kWidth; ++x)
          for (int c = 0; c < 4; ++c) row.push_back(static_cast<JSAMPLE>(adobe ? 255 - ink(x, y, c) : ink(x, y, c)));
        return row;
      });
}

class CmykJpeg : public testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove(path_); }
  Result<ImagePart> read(const std::string& content, Inks inks) {
    EXPECT_TRUE(write_file(path_, content).ok());
    return read_image(path_, inks);
  }
  const std::string path_ =
      (std::filesystem::temp_directory_path() / fmt::format("goniochrome-cmyk-{}.jpg", getpid())).string();
};

// At quality 100 each coefficient is rounded to 1, which leaves a pixel off by 1 or 2 of 255; YCCK rounds once more.
TEST_F(CmykJpeg, InksComeBackAsTheyWere) {
  for (const auto& [adobe, space] : {std::pair{true, JCS_CMYK}, {true, JCS_YCCK}, {false, JCS_CMYK}}) {
    const auto part = read(cmyk_jpeg(adobe, space), Inks::kKept);
    ASSERT_TRUE(part.ok()) << part.error().message;
    const Image& image = part->image;
    EXPECT_EQ(image.channel_names, (std::vector<std::string>{"C", "M", "Y", "K"}));
    ASSERT_EQ(image.data.size(), 4U * kWidth * kHeight);
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x)
        for (int c = 0; c < 4; ++c) EXPECT_NEAR(255 * image.pixel(x, y)[c], ink(x, y, c), 3) << x << " " << y << c;
  }
}

TEST_F(CmykJpeg, WhoDoesNotAskForInksGetsRgb) {
  const auto part = read(cmyk_jpeg(true, JCS_CMYK), Inks::kAsRgb);
  ASSERT_TRUE(part.ok()) << part.error().message;
  EXPECT_EQ(part->image.channel_names, (std::vector<std::string>{"R", "G", "B"}));
  EXPECT_EQ(inks_problem(*part, "car.jpg"),
            "car.jpg is CMYK, and its inks were taken for RGB without regard to its profile: convert it to RGB");
}

TEST_F(CmykJpeg, ACutFileIsAnError) {
  const std::string whole = cmyk_jpeg(true, JCS_CMYK);
  for (const std::size_t size : {whole.size() / 2, whole.size() - 60}) {
    const auto part = read(whole.substr(0, size), Inks::kKept);
    ASSERT_FALSE(part.ok()) << size;
    EXPECT_THAT(part.error().message, HasSubstr("cannot be read as an image: "));
  }
}

// A gray JPEG of 32 x 16 pixels, white in its upper left quarter, that says how it is turned.
std::string turned_jpeg(int orientation) {
  // Exif: a TIFF header and a directory of one entry, the tag 0x112, of one short number.
  std::string exif("Exif\0\0MM\0\x2a\0\0\0\x08\0\1\x01\x12\0\3\0\0\0\1\0\0\0\0\0\0\0\0", 32);
  exif[25] = static_cast<char>(orientation);
  const auto write_exif = [&](jpeg_compress_struct& info) {
    jpeg_write_marker(&info, JPEG_APP0 + 1, reinterpret_cast<const JOCTET*>(exif.data()),
                      static_cast<unsigned>(exif.size()));
  };
  return jpeg(
      32, 16, 1, JCS_GRAYSCALE, [](jpeg_compress_struct&) {}, write_exif,
      [](int y) {
        std::vector<JSAMPLE> row(32, 0);
        if (y < 8) std::fill_n(row.begin(), 16, JSAMPLE{255});
        return row;
      });
}

// The white quarter is where viewers show it. Without regard to the tag it was in the upper left of all eight.
TEST(Orientation, PicturesAreUpright) {
  const ScratchFolder folder;
  struct Case {
    int orientation;
    bool upright, left, top;
  };
  for (const Case& c : {Case{1, true, true, true},
                        {2, true, false, true},
                        {3, true, false, false},
                        {4, true, true, false},
                        {5, false, true, true},
                        {6, false, false, true},
                        {7, false, false, false},
                        {8, false, true, false}}) {
    const auto part = read_image(folder.file("x.jpg", turned_jpeg(c.orientation)));
    ASSERT_TRUE(part.ok()) << part.error().message;
    const Image& image = part->image;
    EXPECT_EQ(image.width, c.upright ? 32 : 16) << c.orientation;
    for (const bool left : {true, false})
      for (const bool top : {true, false}) {
        const float value = image.pixel(left ? 2 : image.width - 3, top ? 2 : image.height - 3)[0];
        EXPECT_NEAR(value, left == c.left && top == c.top ? 1 : 0, .02) << c.orientation << left << top;
      }
  }
}

}  // namespace
}  // namespace goniochrome::image::read_image_test
