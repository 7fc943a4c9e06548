#include "formats/paint_source.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/scratch_for_test.h"
#include "base/testdata_for_test.h"

namespace goniochrome::formats::paint_source_test {
namespace {

using testing::HasSubstr;

std::vector<std::string> names_of(PaintSource& source) {
  std::vector<std::string> names;
  for (;;) {
    const auto paint = source.next();
    EXPECT_TRUE(paint.ok()) << (paint.ok() ? "" : paint.error().message);
    if (!paint.ok() || !*paint) return names;
    names.push_back((*paint)->name);
  }
}

TEST(PaintSource, ContentTellsTheFormat) {
  for (const auto& [file, format] : {std::pair{"paints.paints.xml", "paint XML"}, std::pair{"paints.csv", "long table"},
                                     std::pair{"paints-wide.csv", "wide table"}}) {
    const auto source = open_paints(testdata(file));
    ASSERT_TRUE(source.ok()) << source.error().message;
    EXPECT_EQ((*source)->format(), format);
    EXPECT_THAT(names_of(**source), testing::Contains("candy_red"));
  }
}

TEST(PaintSource, NamesChooseAmongThePaints) {
  const auto chosen = open_paints(testdata("paints.csv") + "#candy_*,silver_fine");
  ASSERT_TRUE(chosen.ok());
  for (const std::string& name : names_of(**chosen))
    EXPECT_TRUE(name == "silver_fine" || name.starts_with("candy_")) << name;
  const auto none = open_paints(testdata("paints.csv") + "#nobody");
  ASSERT_TRUE(none.ok());
  EXPECT_FALSE((*none)->next().ok());
}

TEST(PaintSource, WhatHoldsNoPaintsIsRefusedByName) {
  const ScratchFolder folder;
  EXPECT_THAT(open_paints(folder.file("empty.csv", "")).error().message, HasSubstr("empty.csv: is empty"));
  EXPECT_THAT(open_paints(folder.file("notes.txt", "no paint\n")).error().message, HasSubstr("is neither paint XML"));
  EXPECT_FALSE(open_paints(folder.path("missing.xlsx")).ok());
}

}  // namespace
}  // namespace goniochrome::formats::paint_source_test
