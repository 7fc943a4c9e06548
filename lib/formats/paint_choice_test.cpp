#include "formats/paint_choice.h"

#include <gtest/gtest.h>

#include "formats/scratch_for_test.h"

namespace goniochrome::formats {
namespace {

TEST(PaintReference, AFileAndTheNameBehindTheLastHash) {
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

}  // namespace
}  // namespace goniochrome::formats
