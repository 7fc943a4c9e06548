// The tables that CsvPaintWriter makes, and how they come back.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/scratch_for_test.h"
#include "formats/csv.h"
#include "formats/internal/csv_for_test.h"

namespace goniochrome::formats::csv_write_test {
namespace {

using csv_for_test::Reading;
using csv_for_test::reading_of_text;
using testing::ElementsAre;
using testing::HasSubstr;

const std::string kHeader = "sample,geometry,illuminant,observer,L,a,b\n";

std::string written(const std::vector<paint::Paint>& paints, const CsvLayout& layout) {
  const ScratchFolder folder;
  auto writer = CsvPaintWriter::begin(*OutputFile::create(folder.path("p.csv")), layout);
  for (const paint::Paint& paint : paints) {
    const auto done = writer->write(paint);
    if (!done.ok()) return done.error().message;
  }
  EXPECT_TRUE(writer->finish().ok());
  return folder.content("p.csv");
}

paint::Paint paint_with(const std::string& name, const std::vector<std::pair<const char*, color::Lab>>& rows) {
  paint::Paint paint;
  paint.name = name;
  paint.measurement.emplace();
  for (const auto& [geometry, lab] : rows) paint.measurement->rows.push_back({*paint::parse_geometry(geometry), lab});
  return paint;
}

TEST(PaintCsvWriter, IsWrittenAsTheManualSays) {
  paint::Paint paint = paint_with("a, b", {{"15", {41.87, -45.99, 1.0 / 3}}, {"45as25az90", {1, 2, 3}}});
  EXPECT_EQ(written({paint}, {}), kHeader +
                                      "\"a, b\",45as15,D65,10,41.87,-45.99,0.3333333333333333\n"
                                      "\"a, b\",45as25az90,D65,10,1,2,3\n");
  paint.paint_class = paint::PaintClass::kPearl;
  paint.gloss = {{60, 92.1}};
  EXPECT_EQ(written({paint}, {{}, true}),
            "sample,geometry,illuminant,observer,L,a,b,class,code,instrument,gloss20,gloss60,gloss85,serial,date\n"
            "\"a, b\",45as15,D65,10,41.87,-45.99,0.3333333333333333,pearl,,,,92.1,,,\n"
            "\"a, b\",45as25az90,D65,10,1,2,3,pearl,,,,92.1,,,\n");
  const CsvLayout wide{
      {*paint::parse_geometry("-15"), *paint::parse_geometry("15"), *paint::parse_geometry("45as25az90")}, false};
  EXPECT_EQ(written({paint}, wide),
            "sample,illuminant,observer,L-15,a-15,b-15,L15,a15,b15,L45as25az90,a45as25az90,b45as25az90\n"
            "\"a, b\",D65,10,,,,41.87,-45.99,0.3333333333333333,1,2,3\n");
  EXPECT_THAT(written({paint}, {{*paint::parse_geometry("15")}, false}), HasSubstr("the table has no columns for"));
  paint.measurement.reset();
  EXPECT_THAT(written({paint}, {}), HasSubstr("has no Lab values"));
}

TEST(PaintCsvWriter, BothFormsComeBackToTheLastBit) {
  const ScratchFolder folder;
  paint::Paint paint = paint_with("x", {{"-15", {160.0 / 3, -1e-17, 1e4 / 7}}, {"15", {0.1 + 0.2, -0.0, 5e-324}}});
  paint.gloss = {{20, 1.0 / 3}};
  paint.code = "c";
  paint.measurement->instrument = "i \"1\"";
  for (const CsvLayout& layout :
       {CsvLayout{{}, true}, CsvLayout{{*paint::parse_geometry("-15"), *paint::parse_geometry("15")}, true}}) {
    const Reading back = reading_of_text(written({paint}, layout));
    EXPECT_THAT(back.errors, ElementsAre());
    const paint::Paint& read = back.paints.at(0);
    for (int i = 0; i < 2; ++i) EXPECT_EQ(read.measurement->rows.at(i).lab, paint.measurement->rows[i].lab);
    EXPECT_EQ(read.gloss.at(0).gloss_units, 1.0 / 3);
    EXPECT_EQ(read.code, "c");
    EXPECT_EQ(read.measurement->instrument, "i \"1\"");
  }
}

// Spectra have columns named by wavelengths, which the first paint chooses; rows without a spectrum have empty cells.
TEST(PaintCsvWriter, SpectraComeBackAsTheyWere) {
  std::vector<paint::Paint> paints = {paint_with("x", {{"15", {10, 2, 3}}, {"25", {20, 5, 6}}}),
                                      paint_with("y", {{"15", {1, 2, 3}}})};
  const paint::Geometry at_15 = *paint::parse_geometry("15"), at_25 = *paint::parse_geometry("25");
  paints[0].measurement->spectra = {{at_25, 400.1, 0.1, {0.01, 0.1 / 3, 0.02, 0.03, 0.04}}};
  CsvLayout layout;
  layout.all_columns = layout.spectra = true;
  const std::string text = written(paints, layout);
  EXPECT_NE(text.find(",gloss85,serial,date,400.1,400.2,400.3,400.4,400.5\n"), std::string::npos) << text;
  const Reading reading = reading_of_text(text);
  EXPECT_THAT(reading.errors, ElementsAre());
  ASSERT_EQ(reading.paints.size(), 2u);
  EXPECT_EQ(reading.paints[0].measurement->rows[1].lab, (color::Lab{20, 5, 6}));
  ASSERT_EQ(reading.paints[0].measurement->spectra.size(), 1u);
  const paint::SpectrumReading& read = reading.paints[0].measurement->spectra[0];
  EXPECT_EQ(read.geometry, at_25);
  EXPECT_EQ(read.from_nm, 400.1);
  EXPECT_NEAR(read.step_nm, 0.1, 1e-9);
  EXPECT_EQ(read.factors, paints[0].measurement->spectra[0].factors);
  EXPECT_TRUE(reading.paints[1].measurement->spectra.empty());
  // A table that is not asked for them, and one of paints that have none, are what they were before.
  EXPECT_EQ(written(paints, {}),
            "sample,geometry,illuminant,observer,L,a,b\nx,45as15,D65,10,10,2,3\n"
            "x,45as25,D65,10,20,5,6\ny,45as15,D65,10,1,2,3\n");
  paints[0].measurement->spectra.clear();
  EXPECT_EQ(written(paints, layout), written(paints, {{}, true}));
  EXPECT_EQ(written({}, layout), written({}, {{}, true}));
  // The error names spectra that have no columns.
  const ScratchFolder folder;
  auto writer = CsvPaintWriter::begin(*OutputFile::create(folder.path("p.csv")), layout);
  paints[0].measurement->spectra = {{at_15, 400, 10, {1, 1, 1, 1}}, {at_25, 400, 10, {1, 1, 1, 1, 1}}};
  paints[1].measurement->spectra = {{at_15, 410, 10, {1, 1, 1, 1, 1}}, {at_25, 400, 10, {1, 1, 1, 1, 1}}};
  for (const paint::Paint& paint : paints) ASSERT_TRUE(writer->write(paint).ok());
  EXPECT_THAT(writer->warnings(),
              ElementsAre("spectra are left out that have other wavelengths than the first paint of the table (x at "
                          "45as15 and 1 more)",
                          "spectra without L*, a* and b* beside them are left out (y at 45as25)"));
  // If the first paint has no spectra, the error tells the remedy.
  auto reversed = CsvPaintWriter::begin(*OutputFile::create(folder.path("r.csv")), layout);
  paints[0].measurement->spectra.clear();
  for (const paint::Paint& paint : paints) ASSERT_TRUE(reversed->write(paint).ok());
  EXPECT_THAT(reversed->warnings(), ElementsAre(testing::AllOf(testing::HasSubstr("put a paint with one first"),
                                                               testing::HasSubstr("(y at 45as15 and 1 more)"))));
}

// Rows of the curve are marked; they are read only where a paint has no others.
TEST(PaintCsvWriter, TheOriginOfRowsIsToldAndRead) {
  const paint::Paint paint = paint_with("x", {{"15", {1, 2, 3}}, {"25", {4, 5, 6}}});
  const paint::Geometry at_25 = *paint::parse_geometry("25");
  const auto text = [&](const CsvLayout& layout, const std::vector<paint::Geometry>& from_curve) {
    const ScratchFolder folder;
    auto writer = CsvPaintWriter::begin(*OutputFile::create(folder.path("p.csv")), layout);
    EXPECT_TRUE(writer->write(paint, from_curve).ok());
    EXPECT_TRUE(writer->finish().ok());
    return folder.content("p.csv");
  };
  const CsvLayout wide{{*paint::parse_geometry("15"), at_25}, false, true};
  EXPECT_EQ(
      text({{}, false, true}, {at_25}),
      "sample,geometry,illuminant,observer,L,a,b,origin\nx,45as15,D65,10,1,2,3,row\nx,45as25,D65,10,4,5,6,curve\n");
  EXPECT_EQ(text(wide, {at_25}),
            "sample,illuminant,observer,L15,a15,b15,L25,a25,b25,origin\nx,D65,10,1,2,3,4,5,6,45as25\n");
  for (const CsvLayout& layout : {CsvLayout{{}, false, true}, wide}) {
    EXPECT_EQ(reading_of_text(text(layout, {at_25})).paints.at(0).measurement->rows.size(), 1u);
    EXPECT_EQ(
        reading_of_text(text(layout, {*paint::parse_geometry("15"), at_25})).paints.at(0).measurement->rows.size(), 2u);
    EXPECT_EQ(reading_of_text(text(layout, {})).paints.at(0).measurement->rows.size(), 2u);
  }
}

TEST(PaintCsvWriter, EveryTextComesBackFromItsCell) {
  paint::Paint paint = paint_with("x", {{"15", {1, 2, 3}}});
  for (const char* text : {"plain", "a, \"b\"\nc", "  d ", "\"", "\"\"", "", ";"}) {
    paint.code = text;
    EXPECT_EQ(reading_of_text(written({paint}, {{}, true})).paints.at(0).code, text);
  }
}

}  // namespace
}  // namespace goniochrome::formats::csv_write_test
