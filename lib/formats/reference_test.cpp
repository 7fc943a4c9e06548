#include "formats/reference.h"

#include <gtest/gtest.h>

#include "base/scratch_for_test.h"
#include "formats/paint_source.h"
#include "formats/xml.h"

namespace goniochrome::formats::reference_test {
namespace {

TEST(PaintReference, IsAFileAndTheNameBehindTheLastHash) {
  EXPECT_EQ(paint_reference("a.xml").file, "a.xml");
  EXPECT_FALSE(paint_reference("a.xml").name);
  EXPECT_EQ(paint_reference("a#b.xml#Candy #2").file, "a#b.xml#Candy ");
  EXPECT_EQ(paint_reference("a#b.xml#Candy #2").name, "2");
  EXPECT_EQ(paint_reference("a.xml#").name, "");
}

TEST(PaintReference, AFileOfThatVeryNameIsMeantAsItStands) {
  const ScratchFolder folder;
  const std::string there = folder.file("batch#7.xml", "");
  EXPECT_EQ(paint_reference(there).file, there);
  EXPECT_FALSE(paint_reference(there).name);
  EXPECT_EQ(paint_reference(there + "#red").file, there);
  EXPECT_EQ(paint_reference(there + "#red").name, "red");
}

TEST(PaintReference, ANameMayHaveAHashIfTheFileIsThere) {
  const ScratchFolder folder;
  const std::string there = folder.file("lib.xml", "");
  EXPECT_EQ(paint_reference(there + "#Candy #2").file, there);
  EXPECT_EQ(paint_reference(there + "#Candy #2").name, "Candy #2");
}

TEST(NameChoice, TakesNamesListsAndPatterns) {
  NameChoice one("silver");
  EXPECT_TRUE(one.takes("silver"));
  EXPECT_FALSE(one.takes("Silver"));
  EXPECT_FALSE(one.takes("silver_fine"));
  NameChoice some("silver_*, ?ed,*");
  EXPECT_TRUE(some.takes("silver_fine"));
  EXPECT_TRUE(some.takes("red"));
  EXPECT_TRUE(some.takes(""));
  EXPECT_TRUE(NameChoice("*a*b*").takes("xxaxxbxx"));
  EXPECT_FALSE(NameChoice("*a*b").takes("xxaxxbxx"));
  EXPECT_FALSE(NameChoice("???").takes("ab"));
  EXPECT_TRUE(NameChoice("white, pearl").takes("white, pearl")) << "the very name of a paint";
  EXPECT_TRUE(NameChoice("a*").takes("a*"));
}

TEST(NameChoice, ANameThatNoPaintHasIsTold) {
  NameChoice choice("red,blue*");
  choice.takes("red");
  EXPECT_EQ(choice.check_all_met("lib.xml").error().message,
            "lib.xml: no paint is named \"blue*\": names are taken letter by letter");
  choice.takes("blue 7");
  EXPECT_TRUE(choice.check_all_met("lib.xml").ok());
  NameChoice whole("white, pearl");
  whole.takes("white, pearl");
  EXPECT_TRUE(whole.check_all_met("lib.xml").ok());
}

TEST(NameChoice, ASimilarNameIsNamed) {
  const auto told = [](const char* wanted) {
    NameChoice choice(wanted);
    for (const char* name : {"candy_red", "candy_blue", "RM331", "a"}) choice.takes(name);
    return choice.check_all_met("x").error().message;
  };
  const std::string miss = ": names are taken letter by letter";
  EXPECT_EQ(told("candy_rde"), "x: no paint is named \"candy_rde\"" + miss + "; did you mean \"candy_red\"?");
  EXPECT_EQ(told("Candy_Blue"), "x: no paint is named \"Candy_Blue\"" + miss + "; did you mean \"candy_blue\"?");
  EXPECT_EQ(told("RM313"), "x: no paint is named \"RM313\"" + miss);
  EXPECT_EQ(told("RM333"), "x: no paint is named \"RM333\"" + miss + "; did you mean \"RM331\"?");
  EXPECT_EQ(told("gold"), "x: no paint is named \"gold\"" + miss);
  EXPECT_EQ(told("b"), "x: no paint is named \"b\"" + miss) << "a letter is like every other";
}

// Matching by trying every * anew takes time that grows exponentially with their number.
TEST(NameChoice, ManyStarsTakeNoTime) {
  std::string stars;
  for (int i = 0; i < 2000; ++i) stars += "*a";
  EXPECT_FALSE(NameChoice(stars + "b").takes(std::string(4000, 'a')));
}

TEST(PaintReader, ReadsThePaintsThatAReferenceNames) {
  const ScratchFolder folder;
  const std::string file = folder.file("lib.xml",
                                       "<paints xmlns=\"urn:goniochrome:paint:1\" version=\"1\"><paint name=\"a1\"/>"
                                       "<paint name=\"b\"/><paint name=\"a2\"/></paints>");
  const auto two = read_paints(file + "#a*");
  ASSERT_TRUE(two.ok());
  ASSERT_EQ(two->size(), 2U);
  EXPECT_EQ(two->back().name, "a2");
  EXPECT_EQ(read_paints(file + "#b")->size(), 1U);
  const auto none = read_paints(file + "#c");
  ASSERT_FALSE(none.ok());
  EXPECT_EQ(none.error().message, file + ": no paint is named \"c\": names are taken letter by letter");
}

}  // namespace
}  // namespace goniochrome::formats::reference_test
