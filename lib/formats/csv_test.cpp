#include "formats/csv.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "base/testdata_for_test.h"
#include "formats/internal/csv_for_test.h"
#include "formats/paint_source.h"

namespace goniochrome::formats::csv_test {
namespace {

using csv_for_test::Reading;
using csv_for_test::reading_of;
using csv_for_test::reading_of_text;
using testing::ElementsAre;
using testing::HasSubstr;

const std::string kHeader = "sample,geometry,illuminant,observer,L,a,b\n";

void expect_two_paints(const Reading& reading) {
  EXPECT_THAT(reading.errors, ElementsAre());
  ASSERT_EQ(reading.paints.size(), 2u);
  const paint::Paint& first = reading.paints[0];
  EXPECT_EQ(first.name, "RM331");
  EXPECT_EQ(first.measurement->condition, (color::ViewingCondition{"A", 2}));
  ASSERT_EQ(first.measurement->rows.size(), 2u);
  EXPECT_EQ(paint::geometry_name(first.measurement->rows[0].geometry), "45as-15");
  EXPECT_EQ(first.measurement->rows[0].lab, (color::Lab{41.87, -45.99, -21.5}));
  EXPECT_EQ(first.measurement->rows[1].lab, (color::Lab{1, 2, 3}));
  EXPECT_EQ(reading.paints[1].name, "b");
  EXPECT_EQ(reading.paints[1].measurement->rows[0].lab, (color::Lab{4, 5, 6}));
}

// A gloss of "1,234" beside decimal points was 1.234.
TEST(PaintCsv, SeparatorsOfThousandsAreNoDecimalCommas) {
  const std::string header = "sample,geometry,illuminant,observer,L,a,b,gloss20\n";
  const Reading mixed = reading_of_text(header + "x,45as15,D65,10,41.87,1,2,\"1,234\"\n");
  EXPECT_THAT(mixed.errors, ElementsAre(HasSubstr("the table has the numbers 1,234 and 41.87: write all with a decimal "
                                                  "point, and none with a separator of thousands")));
  const Reading commas = reading_of_text(header + "x,45as15,D65,10,\"41,87\",1,2,\"1,234\"\n");
  ASSERT_EQ(commas.paints.size(), 1u);
  EXPECT_EQ(commas.paints[0].gloss.at(0).gloss_units, 1.234);
}

TEST(PaintCsv, ReadsLongTablesInEveryForm) {
  const std::string body = "RM331,45as-15,A,2,41.87,-45.99,-21.5\nRM331,45,A,2,1,2,3\nb,45as15,A,2,4,5,6\n";
  const Reading plain = reading_of_text(kHeader + body);
  expect_two_paints(plain);
  EXPECT_THAT(plain.lines, ElementsAre(2, 4));
  EXPECT_THAT(plain.warnings, ElementsAre());
  expect_two_paints(reading_of_text("\xef\xbb\xbf" + kHeader + body));
  expect_two_paints(reading_of_text("Sample,Geometry,Illuminant,Observer,L*,a*,b*\n" + body));
  std::string semicolons = kHeader + body;
  for (char& c : semicolons) c = c == ',' ? ';' : c == '.' ? ',' : c;
  expect_two_paints(reading_of_text(semicolons));
  std::string tabs = kHeader + body;
  for (char& c : tabs) c = c == ',' ? '\t' : c == '.' ? ',' : c;
  expect_two_paints(reading_of_text(tabs));
  for (const char* end : {"\r\n", "\r"}) {
    std::string lines;
    for (const char c : kHeader + body) lines += c == '\n' ? end : std::string(1, c);
    expect_two_paints(reading_of_text(lines));
  }
  expect_two_paints(reading_of_text("\n\n" + kHeader + "\n  \n" + body.substr(0, body.size() - 1)));
  expect_two_paints(
      reading_of_text("L , a, b ,observer,\"sample\",illuminant,geometry\n41.87,-45.99,-21.5,2,\"RM331\",A,45as-15\n"
                      " 1 , +2 ,3e0,2, \"RM331\" ,A,45\n4,5,6,2,b,A,15\n"));
}

TEST(PaintCsv, WideTablesLeaveOutEmptyGeometries) {
  const std::string header = "sample,illuminant,observer,L-15,a-15,b-15,L*45as45,a*45as45,b*45as45\n";
  expect_two_paints(reading_of_text(header + "RM331,A,2,41.87,-45.99,-21.5,1,2,3\nb,A,2,,,,4,5,6\n"));
  expect_two_paints(
      reading_of_text("sample;illuminant;observer;L_Minus15;a_Minus15;b_Minus15;L (45);a (45);b (45)\n"
                      "RM331;A;2;41,87;-45,99;-21,5;1;2;3\nb;A;2;;;;4;5;6\n"));
  EXPECT_THAT(reading_of_text(header + "x,A,2,,,,,,\n").errors, ElementsAre("p.csv:2: sample \"x\" has no Lab values"));
  EXPECT_THAT(reading_of_text(header + "x,A,2,1,,3,,,\n").errors,
              ElementsAre("p.csv:2: a-15 is empty: write a number"));
}

TEST(PaintCsv, TheSampleTablesAgreeWithTheSampleLibrary) {
  const auto library = read_paints(testdata("paints.paints.xml"));
  ASSERT_TRUE(library.ok());
  for (const char* name : {"paints.csv", "paints-wide.csv"}) {
    const Reading reading = reading_of(testdata(name));
    EXPECT_THAT(reading.errors, ElementsAre());
    std::size_t i = 0;
    for (const paint::Paint& paint : *library) {
      if (!paint.measurement) continue;
      ASSERT_LT(i, reading.paints.size());
      const paint::Paint& row = reading.paints[i++];
      EXPECT_EQ(row.name, paint.name);
      EXPECT_EQ(row.measurement->condition, paint.measurement->condition);
      ASSERT_EQ(row.measurement->rows.size(), paint.measurement->rows.size()) << name << paint.name;
      for (const paint::LabReading& wanted : paint.measurement->rows) {
        const auto found = std::ranges::find(row.measurement->rows, wanted.geometry, &paint::LabReading::geometry);
        ASSERT_NE(found, row.measurement->rows.end());
        EXPECT_EQ(found->lab, wanted.lab);
      }
    }
    EXPECT_EQ(i, reading.paints.size());
  }
}

TEST(PaintCsv, ReadsQuotedCells) {
  const Reading reading =
      reading_of_text(kHeader + "\"a, \"\"b\"\"\nc\",45as15,D65,10,1,2,3\n\"  d \",45as15,D65,10,1,2,3\n");
  EXPECT_THAT(reading.errors, ElementsAre());
  ASSERT_EQ(reading.paints.size(), 2u);
  EXPECT_EQ(reading.paints[0].name, "a, \"b\"\nc");
  EXPECT_EQ(reading.paints[1].name, "  d ");
  EXPECT_THAT(reading.lines, ElementsAre(2, 4));
}

TEST(PaintCsv, ReadsOptionalColumns) {
  const Reading reading = reading_of_text(
      "name,geometry,illuminant,observer,L,a,b,class,code,instrument,gloss20,gloss60,gloss85\n"
      "m,15,D65,10,1,2,3,Metallic,RM,goni,80.5,92,\nm,45,D65,10,1,2,3,,,,,,\n");
  EXPECT_THAT(reading.errors, ElementsAre());
  const paint::Paint& paint = reading.paints.at(0);
  EXPECT_EQ(paint.paint_class, paint::PaintClass::kMetallic);
  EXPECT_EQ(paint.code, "RM");
  EXPECT_EQ(paint.measurement->instrument, "goni");
  ASSERT_EQ(paint.gloss.size(), 2u);
  EXPECT_EQ(paint.gloss[0].gloss_units, 80.5);
  EXPECT_EQ(paint.gloss[1].angle_deg, 60);
}

TEST(PaintCsv, TellsWhatTheHeaderLeavesOpen) {
  const Reading reading = reading_of_text("sample,geometry,L,a,b,operator\nx,15,1,2,3,Ann\n");
  EXPECT_EQ(reading.paints.at(0).measurement->condition, (color::ViewingCondition{"D65", 10}));
  EXPECT_THAT(reading.warnings,
              ElementsAre(HasSubstr("the columns \"operator\" are not read"), HasSubstr("taken as D65 and 10 deg")));
}

TEST(PaintCsv, RefusesWhatIsNoHeader) {
  const auto error = [](const std::string& text) { return reading_of_text(text).errors.at(0); };
  EXPECT_EQ(error(""), "p.csv: is empty: begin with sample,geometry,illuminant,observer,L,a,b");
  EXPECT_THAT(error("hello world\n"), HasSubstr("p.csv:1: the header has no column \"sample\": begin with"));
  EXPECT_THAT(error("sample,geometry,L,a\n"), HasSubstr("the header has no column \"b\""));
  EXPECT_THAT(error("sample,x,y\n"), HasSubstr("neither a column \"geometry\" nor columns like L15, a15, b15"));
  EXPECT_THAT(error("sample,L15,a15\n"), HasSubstr("the header has no column b45as15"));
  EXPECT_THAT(error("sample,L15,a15,b15,L45as15\n"), HasSubstr("two columns are named L45as15: keep one"));
  EXPECT_THAT(error("sample,sample,L15,a15,b15\n"), HasSubstr("two columns are named sample: keep one"));
  EXPECT_THAT(error(kHeader + "\"open\n"), HasSubstr("p.csv:2: a quotation mark is left open"));
}

TEST(PaintCsv, WrongCellsLoseARowAndNameLineColumnValueAndRemedy) {
  const Reading reading = reading_of_text(kHeader +
                                          "a,15,D65,10,1,2,3\n"
                                          "a,25,D65,10,1,\"12,5\",3\n"
                                          "a,45,D65,10,1,two,3\n"
                                          "a,75,D65,10,,2,3\n"
                                          "a,45xx,D65,10,1,2,3\n"
                                          "a,15,D65,10,1,2,3\n"
                                          "a,110,A,10,1,2,3\n"
                                          "a,110,D65,4,1,2,3\n"
                                          "a,110,D65,10,1,5,2,3\n"
                                          "a,110,D65,10,1,2\n"
                                          "\n"
                                          "b,15,D65,10,nan,2,3\n"
                                          "b,25,,10,1,2,3\n"
                                          "c\xe9,15,D65,10,1,2,3\n"
                                          "d,15,D65,10,1,2,3\n");
  EXPECT_THAT(
      reading.errors,
      ElementsAre("p.csv:4: a is \"two\": write a number such as 12.5", "p.csv:5: L is empty: write a number",
                  "p.csv:6: geometry \"45xx\" is not understood: write it like 45as15, 45as-15, r45as15, "
                  "45as25az90 or 15",
                  "p.csv:7: geometry 45as15 of sample \"a\" is already at line 2: keep one, or give the mean",
                  "p.csv:8: sample \"a\" has another illuminant or observer than on line 2: a paint has one; "
                  "give the others names of their own",
                  "p.csv:9: observer is \"4\": write 2 or 10 (degrees)",
                  "p.csv:10: the row has 8 cells and the header 7: write decimal points, or separate the cells by ;",
                  "p.csv:11: the row has 6 cells and the header 7: fill or remove cells",
                  "p.csv:13: L is \"nan\": write a finite number",
                  "p.csv:14: illuminant is empty: write D65, A or another one",
                  "p.csv:15: a character is not valid UTF-8: save the table as CSV UTF-8"));
  // The good rows are there; a sample without any is not.
  ASSERT_EQ(reading.paints.size(), 2u);
  EXPECT_EQ(reading.paints[0].name, "a");
  EXPECT_EQ(reading.paints[0].measurement->rows.size(), 2u);
  EXPECT_EQ(reading.paints[1].name, "d");
  EXPECT_THAT(reading_of_text(kHeader + ",15,D65,10,1,2,3\n").errors,
              ElementsAre("p.csv:2: sample is empty: name every row"));
}

TEST(PaintCsv, DuplicateNamesAreToldWithBothLines) {
  const Reading reading = reading_of_text(kHeader +
                                          "a,15,D65,10,1,2,3\nb,15,D65,10,1,2,3\nb,45,D65,10,1,2,3\n"
                                          "a,25,D65,10,1,2,3\na,45,D65,10,1,2,3\nc,15,D65,10,1,2,3\n");
  EXPECT_THAT(reading.errors,
              ElementsAre("p.csv:5: sample \"a\" is already at line 2: put its rows together, or rename it"));
  EXPECT_EQ(reading.paints.size(), 3u);
  EXPECT_THAT(reading_of_text("sample,L15,a15,b15\na,1,2,3\na,1,2,3\n").errors,
              ElementsAre("p.csv:3: sample \"a\" is already at line 2: rename one of them"));
}

// A spectrum of two hundredths at all wavelengths is 116 (.02)^(1/3) - 16 under any light.
std::string spectral_table(const std::string& head, const std::string& row, double factor) {
  std::string heads = head, cells = row;
  for (int nm = 400; nm <= 700; nm += 20) {
    heads += fmt::format(",{} nm", nm);
    cells += fmt::format(",{}", factor);
  }
  return heads + "\n" + cells + "\n";
}

TEST(PaintCsv, ReadsSpectraAndTheirColors) {
  const double L = 116 * std::cbrt(0.02) - 16;
  const Reading alone = reading_of_text(spectral_table("sample,geometry", "gray,45as25", 0.02));
  EXPECT_THAT(alone.errors, ElementsAre());
  const paint::Measurement& measurement = *alone.paints.at(0).measurement;
  EXPECT_NEAR(measurement.rows.at(0).lab.L, L, 1e-9);
  EXPECT_NEAR(measurement.rows.at(0).lab.a, 0, 1e-9);
  EXPECT_EQ(measurement.spectra.at(0).geometry, *paint::parse_geometry("25"));
  EXPECT_EQ(measurement.spectra.at(0).to_nm(), 700);
  const Reading percent = reading_of_text(spectral_table("sample,geometry,L,a,b", "gray,45as25,15.487,0,0", 2));
  EXPECT_EQ(percent.paints.at(0).measurement->rows.at(0).lab.L, 15.487);
  EXPECT_NEAR(percent.paints.at(0).measurement->spectra.at(0).factors.at(3), 0.02, 1e-12);
  const auto too_low = [](const char* value) {
    return HasSubstr(fmt::format("a reflectance factor is {}: 0 is black, and noise goes no lower than -0.1", value));
  };
  EXPECT_THAT(reading_of_text(spectral_table("sample,geometry", "gray,45as25", -0.2)).errors,
              ElementsAre(too_low("-0.2")));
  EXPECT_THAT(reading_of_text(spectral_table("sample,geometry", "gray,45as25", -20), Scale::kPercent).errors,
              ElementsAre(too_low("-0.2")));
  EXPECT_THAT(reading_of_text(spectral_table("sample,geometry", "gray,45as25", -0.09)).errors, ElementsAre());
  EXPECT_THAT(reading_of_text("sample,geometry,400,410,420,430,450\nx,45as15,1,1,1,1,1\n").errors,
              ElementsAre(HasSubstr("the wavelengths go from 400 to 430 nm by 10 nm, and then to 450 nm")));
  EXPECT_THAT(reading_of_text("sample,geometry,400,410,410 nm,420,430\nx,45as15,1,1,1,1,1\n").errors,
              ElementsAre(HasSubstr("two columns are of the wavelength 410 nm")));
  EXPECT_THAT(reading_of_text("sample,geometry,400,410,420,430,440\nx,45as15,,,,,\n").errors,
              ElementsAre(HasSubstr("the row has no spectrum, and the table no L, a and b")));
  EXPECT_THAT(reading_of_text(spectral_table("sample,geometry,L,a,b", "gray,45as25,50,0,0", 1e5)).errors,
              ElementsAre(HasSubstr("write a reflectance, where 1, or 100 percent, is the perfect diffuser")));
}

// A table of spectra, 400 to 700 nm, that are the same at all wavelengths.
std::string flat_table(const std::vector<std::pair<std::string, double>>& rows, const std::string& unit = "") {
  std::string text = "sample,geometry,illuminant,observer";
  for (int nm = 400; nm <= 700; nm += 20) text += fmt::format(",{} nm{}", nm, unit);
  for (const auto& [row, value] : rows) {
    text += "\n" + row + ",D65,10";
    for (int nm = 400; nm <= 700; nm += 20) text += fmt::format(",{}", value);
  }
  return text + "\n";
}

double lightness(double factor) {
  return 116 * std::cbrt(factor) - 16;
}

// 6, 2 and 1.5 % were read as factors, L* 195, 130 and 117, because none of them is above 20.
TEST(PaintCsv, TheScaleOfAFileIsFoundFromAllOfIt) {
  const std::string dark = flat_table({{"dark,45as15", 6}, {"dark,45as45", 2}, {"dark,45as110", 1.5}});
  for (const Scale scale : {Scale::kUnstated, Scale::kPercent}) {
    const Reading read = reading_of_text(dark, scale);
    ASSERT_THAT(read.errors, ElementsAre());
    const auto& rows = read.paints.at(0).measurement->rows;
    EXPECT_NEAR(rows.at(0).lab.L, lightness(0.06), 1e-9);
    EXPECT_NEAR(rows.at(1).lab.L, lightness(0.02), 1e-9);
    EXPECT_NEAR(rows.at(2).lab.L, lightness(0.015), 1e-9);
    if (scale == Scale::kUnstated) {
      EXPECT_THAT(read.closing, ElementsAre("p.csv: reflectances were read as percent: as factors, 1 of 1 paints would "
                                            "reflect more than paint can; give paint-convert --scale factor if not"));
    }
  }
  EXPECT_THAT(reading_of_text(dark, Scale::kFactor).errors,
              ElementsAre(HasSubstr("\"dark\" has 2 at 45as45, which is more than a paint reflects")));
  const Reading factors = reading_of_text(flat_table({{"gray,45as15", 0.6}, {"gray,45as45", 0.2}}));
  EXPECT_NEAR(factors.paints.at(0).measurement->rows.at(1).lab.L, lightness(0.2), 1e-9);
  EXPECT_THAT(factors.closing, ElementsAre(HasSubstr("read as factors, where 1 is the perfect diffuser")));
}

// One value says nothing of the others, and a paint that is bright near to specular may be metal, or dark in percent.
TEST(PaintCsv, RefusesAScaleThatMayBeEither) {
  const std::string silver = flat_table({{"silver,45as15", 2.2}, {"silver,45as45", 0.45}, {"silver,45as110", 0.1}});
  EXPECT_THAT(
      reading_of_text(silver).errors,
      ElementsAre(
          "p.csv: nothing says whether reflectances are percent or factors, and \"silver\" has 2.2 at "
          "45as15, which may be either: give paint-convert --scale percent, or --scale factor where 1 is the perfect "
          "diffuser"));
  EXPECT_THAT(reading_of_text(silver).paints, testing::IsEmpty());
  const auto L = [&](Scale scale) {
    const Reading read = reading_of_text(silver, scale);
    return read.paints.empty() ? 0 : read.paints[0].measurement->rows.at(0).lab.L;
  };
  EXPECT_NEAR(L(Scale::kFactor), lightness(2.2), 1e-9);
  EXPECT_NEAR(L(Scale::kPercent), lightness(0.022), 1e-9);
  const std::string one_of_four =
      flat_table({{"a,45as45", 0.3}, {"b,45as45", 0.5}, {"c,45as45", 25}, {"d,45as45", 0.4}});
  EXPECT_THAT(reading_of_text(one_of_four).errors,
              ElementsAre(HasSubstr("\"c\" has 25 at 45as45, which as a factor is more than paint reflects, unlike 3 "
                                    "other paints")));
  EXPECT_EQ(reading_of_text(one_of_four, Scale::kFactor).paints.size(), 4u);
}

// Half of these paints were read as percent and nearly black.
TEST(PaintCsv, RefusesPercentBesideFactors) {
  const std::string mixed = flat_table({{"a,45as45", 30}, {"b,45as45", 25}, {"c,45as45", 0.6}, {"d,45as45", 0.4}});
  EXPECT_THAT(reading_of_text(mixed).errors,
              ElementsAre(testing::AllOf(HasSubstr("percent and as factors: \"a\" has 30 at 45as45"),
                                         HasSubstr("\"c\" has 0.6 at 45as45"), HasSubstr("as 2 of 4 paints are"))));
  const Reading told = reading_of_text(mixed, Scale::kPercent);
  EXPECT_EQ(told.paints.size(), 4u);
  EXPECT_THAT(told.closing, ElementsAre(HasSubstr("2 of 4 paints would reflect 1 percent or less at every angle")));
  std::string headings = flat_table({{"a,45as45", 30}}, " [%]");
  headings.replace(headings.find("[%]"), 3, "factor");
  EXPECT_THAT(reading_of_text(headings).errors,
              ElementsAre(HasSubstr("says another scale of reflectances than stands before")));
}

TEST(PaintCsv, HearsTheScaleThatATableStates) {
  const double wanted = lightness(0.009);
  const std::string heading = flat_table({{"jet,45as15", 0.9}}, " [%]");
  std::string row = flat_table({{"jet,45as15", 0.9}}), units = ",deg,,";
  for (int nm = 400; nm <= 700; nm += 20) units += ",%";
  row.insert(row.find('\n'), "\n" + units);
  for (const std::string& text : {heading, row}) {
    const Reading read = reading_of_text(text);
    EXPECT_THAT(read.errors, ElementsAre());
    EXPECT_THAT(read.closing, ElementsAre());
    EXPECT_NEAR(read.paints.at(0).measurement->rows.at(0).lab.L, wanted, 1e-9);
    EXPECT_THAT(reading_of_text(text, Scale::kFactor).closing, ElementsAre(HasSubstr("--scale has no effect")));
  }
  EXPECT_NEAR(reading_of_text(flat_table({{"white,45as45", 0.9}})).paints.at(0).measurement->rows.at(0).lab.L,
              lightness(0.9), 1e-9);
}

// A heading of the L* column is no matter of the unit row: a first row that cannot be read is still told.
TEST(PaintCsv, ARowOfUnitsHasNoNumbers) {
  EXPECT_EQ(reading_of_text(kHeader + ",deg,,deg,-,CIELAB,-\nx,15,D65,10,1,2,3\n").paints.size(), 1u);
  EXPECT_THAT(reading_of_text(kHeader + "x,15,D65,10,-,-,-\n").errors, ElementsAre(HasSubstr("p.csv:2: L is \"-\"")));
  EXPECT_THAT(reading_of_text(kHeader + "x,15,D65,10,one,-,-\n").errors, ElementsAre(HasSubstr("L is \"one\"")));
}

TEST(PaintCsv, WavelengthsMayStandInAnyOrder) {
  std::string head = "sample,geometry,illuminant,observer", cells = "A,45as15,D65,10", turned = head,
              turned_cells = cells;
  for (int k = 0; k <= 15; ++k) {
    head += fmt::format(",{}nm", 400 + 20 * k), cells += fmt::format(",{}", 0.70 - 0.04 * k);
    turned += fmt::format(",{}nm", 700 - 20 * k), turned_cells += fmt::format(",{}", 0.10 + 0.04 * k);
  }
  const Reading up = reading_of_text(head + "\n" + cells + "\n"),
                down = reading_of_text(turned + "\n" + turned_cells + "\n");
  EXPECT_THAT(down.errors, ElementsAre());
  const paint::SpectrumReading &was = up.paints.at(0).measurement->spectra.at(0),
                               &is = down.paints.at(0).measurement->spectra.at(0);
  EXPECT_EQ(is.from_nm, 400);
  ASSERT_EQ(is.factors.size(), was.factors.size());
  for (std::size_t i = 0; i < was.factors.size(); ++i) EXPECT_NEAR(is.factors[i], was.factors[i], 1e-12);
}

TEST(PaintCsv, RefusesSpectraThatTheObserverDoesNotSee) {
  EXPECT_THAT(reading_of_text("sample,geometry,400,410,420,430,440\nx,45as45,.1,.1,.1,.1,.9\n").errors,
              ElementsAre(HasSubstr("p.csv:2: the spectrum goes from 400 to 440 nm and leaves out")));
  EXPECT_THAT(reading_of_text("sample,geometry,900,920,940,960,980\nx,45as45,.5,.5,.5,.5,.5\n").errors,
              ElementsAre(HasSubstr("from 900 to 980 nm and leaves out 100 % of what the observer sees")));
  const Reading narrow = reading_of_text("sample,geometry,420,485,550,615,680\nx,45as45,.5,.5,.5,.5,.5\n");
  EXPECT_THAT(narrow.closing, testing::Contains(HasSubstr("spectra leave out 6 % of what the observer sees")));
}

TEST(PaintCsv, ReadsTheTextsOfSpreadsheets) {
  const std::string body = "RM331,45as-15,A,2,41.87,-45.99,-21.5\nRM331,45,A,2,1,2,3\nb,45as15,A,2,4,5,6\n";
  for (const bool little : {true, false}) {
    std::string wide = little ? "\xff\xfe" : "\xfe\xff";
    for (const char c : kHeader + body) wide += little ? std::string{c, '\0'} : std::string{'\0', c};
    expect_two_paints(reading_of_text(wide));
  }
  std::string semicolons = kHeader + body;
  for (char& c : semicolons) c = c == ',' ? ';' : c == '.' ? ',' : c;
  expect_two_paints(reading_of_text("sep=;\r\n" + semicolons));
  expect_two_paints(reading_of_text("\xef\xbb\xbfsep=,\n" + kHeader + body));
  expect_two_paints(reading_of_text(
      kHeader + "RM331,45as-15,A,2,\"41,87\",\"-45,99\",\"-21,5\"\nRM331,45,A,2,1,2,3\nb,45as15,A,2,4,5,6\n"));
  expect_two_paints(reading_of_text(kHeader + "\n,,,,,,\n" + body + "\n,,,,,,\n , ,,,,,\n"));
  expect_two_paints(reading_of_text(kHeader + "RM331,45as-15\xc2\xa0 ,A,2,\xc2\xa0 41.87,\xe2\x88\x92" +
                                    "45.99,-21.5\nRM331\xc2\xa0,45 ,A,2,1,2,3\n"
                                    "b,45as15,A,2,4,5,6\n"));
  EXPECT_THAT(reading_of_text(kHeader + "x,45as\xc2\xa0"
                                        "15x,A,2,1,2,3\n")
                  .errors,
              ElementsAre(HasSubstr("geometry \"45as<U+00A0>15x\"")));
}

TEST(PaintCsv, ANameStandsForTheRowsBelowIt) {
  const Reading read =
      reading_of_text(kHeader + "RM331,45as-15,A,2,41.87,-45.99,-21.5\n,45,,,1,2,3\nb,45as15,A,2,4,5,6\n");
  expect_two_paints(read);
  EXPECT_THAT(read.closing,
              ElementsAre(HasSubstr("rows without a name were taken for rows of the sample above (line 3)")));
}

TEST(PaintCsv, DatesTellMeasurementsOfOneNameApart) {
  const std::string head = "sample,DateTime,geometry,illuminant,observer,L,a,b\n";
  const Reading read = reading_of_text(head +
                                       "x,2024-01-01T10:00,15,D65,10,1,2,3\nx,2024-01-01T10:01,45,D65,10,1,2,3\n"
                                       "y,2024-01-01,15,D65,10,1,2,3\nx,2024-01-02,15,D65,10,4,5,6\n"
                                       "x,2024-01-03,15,D65,10,7,8,9\n");
  EXPECT_THAT(read.errors, ElementsAre());
  std::vector<std::string> names;
  for (const paint::Paint& paint : read.paints) names.push_back(paint.name);
  EXPECT_THAT(names, ElementsAre("x", "y", "x (2)", "x (3)"));
  EXPECT_EQ(read.paints[0].measurement->rows.size(), 2u);
  EXPECT_THAT(read.closing,
              ElementsAre(HasSubstr("samples with another date or code than before got a number (x (2) and 1 more)")));
  EXPECT_THAT(reading_of_text(head + "x,1,15,D65,10,1,2,3\ny,1,15,D65,10,1,2,3\nx,1,45,D65,10,1,2,3\n").errors,
              ElementsAre(HasSubstr("sample \"x\" is already at line 2")));
}

// A paint of another code is another paint, though it has the name of the one before.
TEST(PaintCsv, CodesTellPaintsOfOneNameApart) {
  const Reading reading = reading_of_text(
      "sample,code,geometry,illuminant,observer,L,a,b\nr,A,15,D65,10,1,2,3\nr,,25,D65,10,2,2,3\n"
      "r,B,45,D65,10,3,2,3\n");
  EXPECT_THAT(reading.errors, ElementsAre());
  ASSERT_EQ(reading.paints.size(), 2u);
  EXPECT_EQ(reading.paints[0].measurement->rows.size(), 2u);
  EXPECT_EQ(reading.paints[1].name, "r (2)");
  EXPECT_EQ(reading.paints[1].code, "B");
  EXPECT_THAT(reading.closing,
              ElementsAre("p.csv: samples with another date or code than before got a number (r (2))"));
}

TEST(PaintCsv, ReadsTheHeadingsOfInstruments) {
  const Reading read = reading_of_text(
      "\xef\xbb\xbf"
      "Blech;Lichtart;Beobachter;-15\xc2\xb0 L*;-15\xc2\xb0 a*;-15\xc2\xb0 b*;L* 45\xc2\xb0;a* 45\xc2\xb0;b* "
      "45\xc2\xb0\nrot;D65;10;41,5;-1,25;3;20;1;2\n");
  EXPECT_THAT(read.errors, ElementsAre());
  const paint::Paint& paint = read.paints.at(0);
  EXPECT_EQ(paint.name, "rot");
  EXPECT_EQ(paint.measurement->rows.at(0).geometry, *paint::parse_geometry("-15"));
  EXPECT_EQ(paint.measurement->rows.at(0).lab, (color::Lab{41.5, -1.25, 3}));
  EXPECT_EQ(paint.measurement->rows.at(1).lab, (color::Lab{20, 1, 2}));
  EXPECT_THAT(read.warnings, testing::Contains(HasSubstr("the column \"Blech\" is taken for the names")));
}

TEST(PaintCsv, ReadsDegreeSignsInCellsAndHeadings) {
  const Reading rows = reading_of_text(
      "Probe;Lichtart;Beobachter;Geometrie;L*;a*;b*\nrot;D65;10\xc2\xb0;-15\xc2\xb0;41,5;-1,25;3\n"
      "rot;D65;10\xc2\xb0;45 \xc2\xb0;20;1;2\n");
  EXPECT_THAT(rows.errors, ElementsAre());
  const Reading columns = reading_of_text(
      "Probe;Lichtart;Beobachter;-15\xc2\xb0:L*;-15\xc2\xb0:a*;-15\xc2\xb0:b*;45\xc2\xb0:L*;45\xc2\xb0:a*;45\xc2\xb0:b*"
      "\nrot;D65;10\xc2\xb0;41,5;-1,25;3;20;1;2\n");
  EXPECT_THAT(columns.errors, ElementsAre());
  for (const Reading* read : {&rows, &columns}) {
    const paint::Paint& paint = read->paints.at(0);
    EXPECT_EQ(paint.measurement->condition.observer_deg, 10);
    EXPECT_EQ(paint.measurement->rows.at(0).geometry, *paint::parse_geometry("-15"));
    EXPECT_EQ(paint.measurement->rows.at(0).lab, (color::Lab{41.5, -1.25, 3}));
    EXPECT_EQ(paint.measurement->rows.at(1).lab, (color::Lab{20, 1, 2}));
  }
  EXPECT_THAT(reading_of_text("sample,geometry,illuminant,observer,L,a,b\nrot,45as15,D65,12\xc2\xb0,1,2,3\n").errors,
              ElementsAre(HasSubstr("write 2 or 10 (degrees)")));
}

// An export of an instrument's program: percent, blanks behind geometries, dates. One of 240 panels was measured again.
TEST(PaintCsv, ReadsTheExportOfAnInstrumentRealData) {
  const char* data = std::getenv("GONIOCHROME_DATA");
  if (!data) GTEST_SKIP() << "GONIOCHROME_DATA is not set";
  const Reading read = reading_of(std::string(data) + "/instrument/refinish-panels.csv");
  EXPECT_THAT(read.errors, ElementsAre());
  EXPECT_EQ(read.paints.size(), 241u);
  EXPECT_THAT(read.closing, testing::Contains(HasSubstr("read as percent")));
  double highest = 0, lowest = 100;
  for (const paint::Paint& paint : read.paints)
    for (const paint::LabReading& row : paint.measurement->rows)
      highest = std::max(highest, row.lab.L), lowest = std::min(lowest, row.lab.L);
  EXPECT_LT(highest, 100);
  EXPECT_GT(highest, 90);
  EXPECT_GT(lowest, 0);
  EXPECT_LT(lowest, 5);
}

TEST(PaintCsv, ReadsMeasuredPaintsRealData) {
  const char* data = std::getenv("GONIOCHROME_DATA");
  if (!data) GTEST_SKIP() << "GONIOCHROME_DATA is not set";
  const Reading measured = reading_of(std::string(data) + "/lab/measured-multiangle.csv");
  EXPECT_THAT(measured.errors, ElementsAre());
  EXPECT_EQ(measured.paints.size(), 10u);
  const Reading reconstructed = reading_of(std::string(data) + "/lab/reconstructed-multiangle.csv");
  EXPECT_THAT(reconstructed.errors, ElementsAre());
  EXPECT_EQ(reconstructed.paints.size(), 80u);
}

}  // namespace
}  // namespace goniochrome::formats::csv_test
