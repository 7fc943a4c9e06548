// For tests: what the tests of foreign formats share, which read texts and files and compare paints.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <string_view>
#include <vector>

#include "base/file.h"
#include "base/scratch_for_test.h"
#include "formats/imported.h"

namespace goniochrome::formats {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

inline paint::Geometry geometry(const char* name) {
  return paint::parse_geometry(name).value();
}

inline void expect_same(const std::vector<paint::Paint>& was, const std::vector<paint::Paint>& is) {
  ASSERT_EQ(is.size(), was.size());
  for (std::size_t p = 0; p < was.size(); ++p) {
    EXPECT_EQ(is[p].name, was[p].name);
    EXPECT_EQ(is[p].code, was[p].code);
    EXPECT_EQ(is[p].paint_class, was[p].paint_class);
    EXPECT_EQ(is[p].measurement->condition, was[p].measurement->condition);
    EXPECT_EQ(is[p].measurement->instrument, was[p].measurement->instrument);
    EXPECT_EQ(is[p].measurement->serial, was[p].measurement->serial);
    EXPECT_EQ(is[p].measurement->date, was[p].measurement->date);
    ASSERT_EQ(is[p].measurement->rows.size(), was[p].measurement->rows.size());
    for (std::size_t i = 0; i < was[p].measurement->rows.size(); ++i) {
      EXPECT_EQ(is[p].measurement->rows[i].geometry, was[p].measurement->rows[i].geometry);
      EXPECT_EQ(is[p].measurement->rows[i].lab, was[p].measurement->rows[i].lab);
    }
    ASSERT_EQ(is[p].gloss.size(), was[p].gloss.size());
    for (const paint::GlossReading& gloss : was[p].gloss)
      EXPECT_THAT(is[p].gloss,
                  Contains(testing::AllOf(testing::Field(&paint::GlossReading::angle_deg, gloss.angle_deg),
                                          testing::Field(&paint::GlossReading::gloss_units, gloss.gloss_units))));
  }
}

// Two paints with everything that a table of readings can hold: quotation marks in a name, numbers to the last bit, and
// every kind of geometry. The second has an illuminant of its own.
inline std::vector<paint::Paint> two_paints(const std::string& illuminant) {
  paint::Paint a;
  a.name = "blue \"night\" & <7>", a.code = "B-7", a.paint_class = paint::PaintClass::kMetallic;
  a.measurement = paint::Measurement{{"D65", 10},
                                     "MA-T12",
                                     {{geometry("45as15"), {41.87, -45.99, -21.73 / 3}},
                                      {geometry("45as-15"), {1.0 / 3, 1e-17, -9999.999999999998}},
                                      {geometry("45as25az-76"), {130.5, 0, -0.1}},
                                      {geometry("45as15az0"), {30, 1, 2}},
                                      {geometry("r45as45"), {0, 0, 0}}}};
  a.measurement->serial = "S/N 7", a.measurement->date = "2021-11-26T07:54:25Z";
  a.gloss = {{60, 92.1}, {20, 1.0 / 7}};
  paint::Paint b;
  b.name = "plain";
  b.measurement = paint::Measurement{{illuminant, 2}, "", {{geometry("45as15"), {2, 3, 4}}}};
  b.measurement->date = "2021-11-26..2021-11-28";
  return {a, b};
}

template <Result<ImportedPaints> (*Read)(InputFile, const ImportOptions&)>
class ImportTest : public testing::Test {
 protected:
  std::string path() const { return scratch_.path("paints"); }
  static Result<ImportedPaints> read_file(const std::string& path, const ImportOptions& options = {}) {
    auto input = InputFile::open(path);
    EXPECT_TRUE(input.ok());
    return Read(std::move(input).value(), options);
  }
  Result<ImportedPaints> read(std::string_view text, const ImportOptions& options = {}) const {
    return read_file(scratch_.file("paints", text), options);
  }
  ImportedPaints good(std::string_view text, const ImportOptions& options = {}) const {
    auto result = read(text, options);
    EXPECT_TRUE(result.ok()) << (result.ok() ? "" : result.error().message);
    return result.ok() ? std::move(result).value() : ImportedPaints{};
  }
  std::string refusal(std::string_view text) const {
    const auto result = read(text);
    EXPECT_FALSE(result.ok());
    return result.ok() ? "" : result.error().message;
  }

 private:
  ScratchFolder scratch_;
};

}  // namespace goniochrome::formats
