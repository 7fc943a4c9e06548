// Blocks that are decoded here against what the library makes of the same numbers.
#include <Imath/half.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfOutputFile.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <string>
#include <vector>

#include "base/file.h"
#include "base/scratch_for_test.h"
#include "image/exr.h"

namespace goniochrome::image::exr_rows_test {
namespace {

using testing::HasSubstr;

constexpr int kWidth = 257, kHeight = 256;  // an odd width: floats may begin between two multiples of 4
constexpr std::size_t kPixels = std::size_t{kWidth} * kHeight;

// A channel "half" that has every half, also what is no number, beside a channel "float" that sorts before it, and rows
// that begin below 0.
void write(const std::string& path, Imf::Compression compression) {
  std::vector<half> halves(kPixels);
  std::vector<float> floats(kPixels);
  for (std::size_t i = 0; i < kPixels; ++i) {
    halves[i].setBits(static_cast<std::uint16_t>(i));
    floats[i] = 1.0F / static_cast<float>(i + 1);
  }
  const Imath::Box2i window(Imath::V2i(-3, -5), Imath::V2i(kWidth - 4, kHeight - 6));
  Imf::Header header(window, window);
  header.compression() = compression;
  header.channels().insert("half", Imf::Channel(Imf::HALF));
  header.channels().insert("float", Imf::Channel(Imf::FLOAT));
  Imf::FrameBuffer buffer;
  buffer.insert("half", Imf::Slice::Make(Imf::HALF, halves.data(), window, sizeof(half), sizeof(half) * kWidth));
  buffer.insert("float", Imf::Slice::Make(Imf::FLOAT, floats.data(), window, sizeof(float), sizeof(float) * kWidth));
  Imf::OutputFile file(path.c_str(), header);
  file.setFrameBuffer(buffer);
  file.writePixels(kHeight);
}

class ExrRows : public testing::Test {
 protected:
  std::string path(const std::string& name) const { return folder_.path(name); }
  ScratchFolder folder_;
};

TEST_F(ExrRows, AreWhatTheLibraryReads) {
  std::vector<std::uint32_t> library;
  // The first is decoded by the library alone.
  for (const Imf::Compression compression :
       {Imf::PIZ_COMPRESSION, Imf::ZIP_COMPRESSION, Imf::ZIPS_COMPRESSION, Imf::NO_COMPRESSION}) {
    write(path("x.exr"), compression);
    for (const std::vector<std::string>& channels : {std::vector<std::string>{"half", "float"}, {"float"}, {"half"}}) {
      const auto read = open_exr(path("x.exr"), channels);
      ASSERT_TRUE(read.ok()) << read.error().message;
      const ImagePart& part = read->first;
      EXPECT_EQ(part.type, channels.size() == 1 && channels[0] == "half" ? PixelType::kHalf : PixelType::kFloat);
      ASSERT_EQ(part.image.data.size(), channels.size() * kPixels);
      std::vector<std::uint32_t> bits;
      for (const float value : part.image.data) bits.push_back(std::bit_cast<std::uint32_t>(value));
      if (channels.size() == 2 && library.empty()) library = bits;
      for (std::size_t i = 0; i < bits.size(); ++i) {
        const std::size_t of = channels.size() == 2 ? i : 2 * i + (channels[0] == "float" ? 1 : 0);
        ASSERT_EQ(bits[i], library[of]) << "compression " << compression << ", sample " << i;
      }
    }
  }
  // Some of the numbers were subnormal or not finite.
  EXPECT_EQ(std::bit_cast<float>(library[2]), 0x1p-24F);
  EXPECT_EQ(library[2 * 0x7c00], 0x7f800000U);
}

// The check at the end of each packed block sees a number that is another one.
TEST_F(ExrRows, DamagedBlocksAreRefused) {
  write(path("x.exr"), Imf::ZIP_COMPRESSION);
  const std::string whole = file_content(path("x.exr")).value();
  ASSERT_TRUE(decoded_exr(whole, "x.exr").ok());
  std::string damaged = whole;
  damaged.back() = static_cast<char>(damaged.back() ^ 1);
  const auto read = decoded_exr(damaged, "x.exr");
  ASSERT_FALSE(read.ok());
  EXPECT_THAT(read.error().message, HasSubstr("x.exr: cannot be read as EXR: its packed pixels are damaged"));
}

}  // namespace
}  // namespace goniochrome::image::exr_rows_test
