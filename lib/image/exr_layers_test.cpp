#include "image/internal/exr_layers.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfOutputFile.h>

#include "base/scratch_for_test.h"
#include "image/color_space.h"
#include "image/exr.h"

namespace goniochrome::image::exr_layers_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

ExrLayer chosen(const std::vector<ExrPartNames>& parts, const std::string& wanted = "") {
  const auto layer = color_layer(parts, wanted, "x.exr");
  EXPECT_TRUE(layer.ok()) << layer.error().message;
  return layer.ok() ? *layer : ExrLayer{};
}

std::string problem(const std::vector<ExrPartNames>& parts, const std::string& wanted = "") {
  const auto layer = color_layer(parts, wanted, "x.exr");
  return layer.ok() ? "" : layer.error().message;
}

TEST(ExrLayers, ColorsAreKnownByNameWhateverTheirCaseAndOrder) {
  EXPECT_THAT(chosen({{"", {"b", "g", "r"}}}).channels, ElementsAre("r", "g", "b"));
  EXPECT_THAT(chosen({{"", {"Blue", "Green", "Red", "alpha"}}}).channels, ElementsAre("Red", "Green", "Blue", "alpha"));
  EXPECT_THAT(chosen({{"", {"layer.B", "layer.G", "layer.R"}}}).channels, ElementsAre("layer.R", "layer.G", "layer.B"));
  const ExrLayer blender = chosen({{"",
                                    {"ViewLayer.Combined.A", "ViewLayer.Combined.B", "ViewLayer.Combined.G",
                                     "ViewLayer.Combined.R", "ViewLayer.Depth.Z"}}});
  EXPECT_THAT(blender.channels, ElementsAre("ViewLayer.Combined.R", "ViewLayer.Combined.G", "ViewLayer.Combined.B",
                                            "ViewLayer.Combined.A"));
  EXPECT_THAT(blender.as, ElementsAre("R", "G", "B", "A"));
  EXPECT_THAT(chosen({{"", {"Y", "A"}}}).as, ElementsAre("Y", "A"));
  // Colors without a layer are the picture, whatever stands beside them.
  EXPECT_THAT(chosen({{"", {"R", "G", "B", "diffuse.B", "diffuse.G", "diffuse.R"}}}).channels,
              ElementsAre("R", "G", "B"));
  // The only part with colors.
  EXPECT_EQ(chosen({{"depth", {"Z"}}, {"rgba", {"R", "G", "B"}}}).part, 1U);
}

TEST(ExrLayers, NoneOrSeveralAreNamedAndOneCanBeChosen) {
  EXPECT_EQ(problem({{"", {"U", "V"}}}),
            "x.exr: none of its layers has R, G and B, or Y alone: its channels are U, V: name one to be gray, as in "
            "x.exr[U]");
  // A normal is no brightness, and brightness with half of its colors no picture.
  EXPECT_THAT(problem({{"", {"N.X", "N.Y", "N.Z"}}}), HasSubstr("none of its layers"));
  EXPECT_THAT(problem({{"", {"BY", "RY", "Y"}}}), HasSubstr("none of its layers"));
  const std::vector<ExrPartNames> two = {{"", {"a.B", "a.G", "a.R", "b.B", "b.G", "b.R", "z.Z"}}};
  EXPECT_EQ(problem(two), "x.exr: several layers have colors: a, b: name one, as in x.exr[a]");
  EXPECT_THAT(chosen(two, "B").channels, ElementsAre("b.R", "b.G", "b.B"));
  EXPECT_THAT(problem(two, "c"), HasSubstr("no layer with colors is called \"c\""));
  EXPECT_THAT(chosen(two, "z.Z").as, ElementsAre("Y"));
  const std::vector<ExrPartNames> parts = {{"left", {"R", "G", "B"}}, {"right", {"R", "G", "B"}}};
  EXPECT_EQ(chosen(parts).part, 0U);
  EXPECT_EQ(chosen(parts, "right").part, 1U);
}

TEST(ExrLayers, PixelsAreShownInTheDisplayWindow) {
  const Image data{2, 1, 1, {1, 2}, {"Y"}};
  EXPECT_THAT(shown_in({0, 0, 3, 2}, {1, 1, 2, 1}, data).data, ElementsAre(0, 0, 0, 0, 1, 2));
  EXPECT_THAT(shown_in({0, 0, 1, 1}, {-1, 0, 2, 1}, data).data, ElementsAre(2)) << "overscan is cut";
}

class ExrPicture : public testing::Test {
 protected:
  // A file of floats whose channels hold 1, 2, 3 ... in the order of `names`.
  std::string written(const std::vector<std::string>& names, const Imath::Box2i& display, const Imath::Box2i& data,
                      Imf::PixelType type = Imf::FLOAT) {
    Imf::Header header(display, data);
    const std::string path = folder_.path("x.exr");
    const int width = data.max.x - data.min.x + 1, height = data.max.y - data.min.y + 1;
    std::vector<std::vector<float>> values;
    Imf::FrameBuffer buffer;
    for (std::size_t c = 0; c < names.size(); ++c)
      values.emplace_back(static_cast<std::size_t>(width * height), static_cast<float>(c + 1));
    for (std::size_t c = 0; c < names.size(); ++c) {
      header.channels().insert(names[c], Imf::Channel(type));
      buffer.insert(names[c], Imf::Slice::Make(type, values[c].data(), data));
    }
    Imf::OutputFile file(path.c_str(), header);
    file.setFrameBuffer(buffer);
    file.writePixels(height);
    return path;
  }
  const Imath::Box2i whole_{{0, 0}, {3, 1}};
  ScratchFolder folder_;
};

// By position the first three channels of the file were red, green and blue: alpha, blue and green.
TEST_F(ExrPicture, OfALayerHasItsRedAsRed) {
  const std::string path = written({"Combined.R", "Combined.G", "Combined.B", "Combined.A"}, whole_, whole_);
  for (const std::string& name : {path, path + "[combined]"}) {
    const auto part = read_image(name);
    ASSERT_TRUE(part.ok()) << part.error().message;
    EXPECT_THAT(part->image.channel_names, ElementsAre("R", "G", "B", "A"));
    EXPECT_THAT(std::vector<float>(part->image.data.begin(), part->image.data.begin() + 4), ElementsAre(1, 2, 3, 4));
  }
  EXPECT_THAT(read_image(path + "[other]").error().message, HasSubstr("no layer with colors is called \"other\""));
  EXPECT_THAT(read_image(folder_.file("x.png", "\x89PNG\r\n\x1a\n") + "[a]").error().message,
              HasSubstr("has no layers"));
}

TEST_F(ExrPicture, OfACropIsBlackAroundIt) {
  const auto part = read_image(written({"R", "G", "B"}, whole_, {{1, 1}, {2, 1}}));
  ASSERT_TRUE(part.ok()) << part.error().message;
  EXPECT_EQ(part->image.width, 4);
  EXPECT_EQ(part->image.height, 2);
  for (int x = 0; x < 4; ++x) {
    EXPECT_EQ(part->image.pixel(x, 0)[0], 0);
    EXPECT_EQ(part->image.pixel(x, 1)[2], x == 1 || x == 2 ? 3 : 0);
  }
  const auto overscan = read_image(written({"R", "G", "B"}, whole_, {{-1, -1}, {4, 2}}));
  ASSERT_TRUE(overscan.ok()) << overscan.error().message;
  EXPECT_EQ(overscan->image.width, 4);
  EXPECT_THAT(read_image(written({"R", "G", "B"}, whole_, {{9, 9}, {9, 9}})).error().message,
              HasSubstr("none of its pixels lies in its display window"));
  EXPECT_THAT(read_image(written({"R", "G", "B"}, {{0, 0}, {99999, 99999}}, whole_)).error().message,
              HasSubstr("is too large for its 4 x 2 pixels"));
}

// One of 65535 was light of 65535.
TEST_F(ExrPicture, OfWholeNumbersIsRefused) {
  EXPECT_THAT(read_image(written({"R", "G", "B"}, whole_, whole_, Imf::UINT)).error().message,
              HasSubstr("its channel R holds whole numbers"));
  EXPECT_TRUE(read_image(written({"R", "G", "B"}, whole_, whole_)).ok()) << "control";
}

ImagePart bright(const char* name, int width, int height) {
  return {name,
          {width, height, 1, std::vector<float>(static_cast<std::size_t>(width * height), 1.0F), {"Y"}},
          {},
          PixelType::kFloat};
}

TEST_F(ExrPicture, HasPartsThatStandElsewhereInIt) {
  ImagePart crop = bright("crop", 2, 1);
  crop.left = 2, crop.top = 1, crop.attributes["goniochrome:column"] = "mirror";
  const std::string path = folder_.path("crop.exr");
  ASSERT_TRUE(write_exr(path, {bright("picture", 4, 2), crop}).ok());
  auto read = open_exr(path, {});
  ASSERT_TRUE(read.ok()) << read.error().message;
  ImagePart part;
  EXPECT_FALSE(*read->other("none", part));
  ASSERT_TRUE(*read->other("crop", part));
  EXPECT_EQ(part.left, 2);
  EXPECT_EQ(part.top, 1);
  EXPECT_THAT(part.image.data, ElementsAre(1, 1));
  EXPECT_THAT(read_image(path + "[crop]")->image.data, ElementsAre(0, 0, 0, 0, 0, 0, 1, 1)) << "as it is shown";
}

// Numbers of a transport, in a part wider than its picture, made the picture wide in every other program.
TEST_F(ExrPicture, IsShownAsLargeAsItIsWhateverFollows) {
  const std::string path = folder_.path("wide.exr");
  ASSERT_TRUE(write_exr(path, {bright("picture", 4, 2), bright("numbers", 9, 5)}).ok());
  EXPECT_EQ(Imf::MultiPartInputFile(path.c_str()).header(0).displayWindow(), whole_);
  const auto read = read_exr(path);
  ASSERT_TRUE(read.ok()) << read.error().message;
  EXPECT_EQ(read->at(1).image.width, 9);
  EXPECT_EQ(read->at(1).image.height, 5);
}

}  // namespace
}  // namespace goniochrome::image::exr_layers_test
