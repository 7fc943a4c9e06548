// Tilted lobes in paint XML: read, written and refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "base/scratch_for_test.h"
#include "formats/paint_source.h"
#include "formats/xml.h"

namespace goniochrome::formats::tilts_xml_test {
namespace {

using testing::HasSubstr;

std::string document(const std::string& tilts, bool lobes = true) {
  return "<paints xmlns=\"urn:goniochrome:paint:1\" version=\"1\">\n<paint name=\"p\">\n" +
         std::string(lobes ? "<lobes space=\"lin_rec2020_scene\" basis=\"b\" method=\"l1\" max_de00=\"0\" "
                             "mean_de00=\"0\"><diffuse r=\"0\" g=\"0\" b=\"0\"/></lobes>"
                           : "") +
         tilts + "</paint>\n<paint name=\"q\"/></paints>\n";
}

const std::string kSet =
    "<set mean_de00=\"0.7\"><lobe exponent=\"20\" tilt=\"-30\" out=\"0\"/><lobe exponent=\"6\" tilt=\"0\" out=\"40\"/>"
    "<view angle=\"0\">.1 .2 .3 1 2 3 4 5 6</view><view angle=\"90\">0 0 0\n0 0 0 0 0 1e-3</view></set>";

std::string tilts(const std::string& inside, const std::string& space = "urn:goniochrome:tilts:1") {
  return "<tilts xmlns=\"" + space + "\">" + inside + "</tilts>";
}

struct Read {
  std::vector<paint::Paint> paints;
  std::string error;
};
Read read(const std::string& text) {
  const ScratchFolder folder;
  std::ofstream(folder.path("p.xml")) << text;
  auto reader = PaintReader::open(folder.path("p.xml"));
  Read result;
  for (;;) {
    auto paint = reader->next();
    if (!paint.ok()) {
      result.error += paint.error().message;
      continue;
    }
    if (!*paint) return result;
    result.paints.push_back(std::move(**paint));
  }
}

TEST(TiltsXml, AreReadAndWrittenAgain) {
  const Read once = read(document(tilts(kSet + kSet)));
  ASSERT_EQ(once.error, "");
  ASSERT_EQ(once.paints.size(), 2u);
  ASSERT_TRUE(once.paints[0].lobes);
  const auto& sets = once.paints[0].lobes->tilts;
  ASSERT_EQ(sets.size(), 2u);
  EXPECT_EQ(sets[0].mean_de00, 0.7);
  EXPECT_EQ(sets[0].lookups(), 3);
  ASSERT_EQ(sets[0].views.size(), 2u);
  EXPECT_EQ(sets[0].views[0].diffuse, (color::Rgb{0.1, 0.2, 0.3}));
  EXPECT_EQ(sets[0].views[0].weights[1], (color::Rgb{4, 5, 6}));
  EXPECT_EQ(sets[0].views[1].weights[1].z, 1e-3);
  EXPECT_TRUE(once.paints[0].foreign.empty());
  const ScratchFolder folder;
  auto file = OutputFile::create(folder.path("q.xml"));
  auto writer = PaintWriter::begin(std::move(*file));
  ASSERT_TRUE(writer->write(once.paints[0]).ok());
  ASSERT_TRUE(writer->finish().ok());
  EXPECT_EQ(read_paints(folder.path("q.xml"))->front().lobes->tilts, sets);
}

// Readers that know nothing of <tilts> treat it as this one treats any other vocabulary: they keep it.
TEST(TiltsXml, AreKeptByReadersThatDoNotKnowThem) {
  const Read other = read(document(tilts(kSet, "urn:goniochrome:tilts:2")));
  ASSERT_EQ(other.error, "");
  EXPECT_TRUE(other.paints[0].lobes->tilts.empty());
  ASSERT_EQ(other.paints[0].foreign.size(), 1u);
  EXPECT_THAT(other.paints[0].foreign[0], HasSubstr(".1 .2 .3 1 2 3 4 5 6"));
}

TEST(TiltsXml, WrongOnesLoseTheirPaintAlone) {
  const std::string lobe = "<lobe exponent=\"20\" tilt=\"0\" out=\"0\"/>";
  const auto set = [&](const std::string& inside) { return tilts("<set mean_de00=\"1\">" + inside + "</set>"); };
  const std::pair<std::string, const char*> kWrong[] = {
      {tilts("<sets/>"), "<sets> is not known here"},
      {tilts("<set/>"), "mean_de00"},
      {tilts("12"), "stands between elements"},
      {tilts(kSet) + tilts(kSet), "a second <tilts>"},
      {set(lobe), "needs two or more"},
      {set(lobe + "<view angle=\"0\">0 0 0 1 1 1</view>"), "1 views: it needs two or more"},
      {set(lobe + "<view angle=\"0\">0 0 0 1 1</view>"), "holds 6 numbers"},
      {set(lobe + "<view angle=\"0\">0 0 0 1 1 -1</view>"), "weight"},
      {set(lobe + "<view angle=\"0\">0 0 0 1 1 nan</view>"), "weight"},
      {set(lobe + "<view angle=\"91\">0 0 0 1 1 1</view>"), "0 to 90"},
      {set(lobe + "<view angle=\"5\">0 0 0 1 1 1</view><view angle=\"5\">0 0 0 1 1 1</view>"), "each once"},
      {set("<view angle=\"0\">0 0 0</view>" + lobe), "write the lobes first"},
      {set("<lobe exponent=\"-1\" tilt=\"0\" out=\"0\"/>"), "exponent"},
      {set("<lobe exponent=\"1\" tilt=\"200\" out=\"0\"/>"), "-180 to 180"},
      {set("<lobe exponent=\"1\" tilt=\"0\" out=\"91\"/>"), "0 to 90"},
      {set("<lobe exponent=\"1\" tilt=\"0\"/>"), "out"},
  };
  for (const auto& [text, why] : kWrong) {
    const Read wrong = read(document(text));
    EXPECT_THAT(wrong.error, HasSubstr(why)) << text;
    ASSERT_EQ(wrong.paints.size(), 1u) << text;
    EXPECT_EQ(wrong.paints[0].name, "q");
  }
  EXPECT_THAT(read(document(tilts(kSet), false)).error, HasSubstr("has no <lobes>"));
  std::string many;
  for (int i = 0; i < 9; ++i) many += kSet;
  EXPECT_THAT(read(document(tilts(many))).error, HasSubstr("more than 8 sets"));
}

}  // namespace
}  // namespace goniochrome::formats::tilts_xml_test
