#include "formats/importers.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zip.h>

#include <cstdlib>
#include <map>

#include "formats/internal/import_for_test.h"
#include "formats/internal/spreadsheet.h"
#include "paint/spectra.h"

namespace goniochrome::formats::workbook_test {
namespace {

using Parts = std::map<std::string, std::string>;

// A cell as a program writes it that uses no shared strings.
std::string text_cell(const std::string& reference, const std::string& text) {
  return "<c r=\"" + reference + "\" t=\"inlineStr\"><is><t>" + text + "</t></is></c>";
}
std::string number_cell(const std::string& reference, const std::string& number) {
  return "<c r=\"" + reference + "\"><v>" + number + "</v></c>";
}

class Workbook : public ImportTest<read_workbook> {
 protected:
  void write(const Parts& parts, bool encrypt = false) const {
    zip_t* archive = zip_open(path().c_str(), ZIP_CREATE | ZIP_TRUNCATE, nullptr);
    ASSERT_NE(archive, nullptr);
    for (const auto& [name, content] : parts) {
      const auto at = zip_file_add(archive, name.c_str(), zip_source_buffer(archive, content.data(), content.size(), 0),
                                   ZIP_FL_OVERWRITE);
      ASSERT_GE(at, 0);
      if (encrypt) zip_file_set_encryption(archive, static_cast<zip_uint64_t>(at), ZIP_EM_AES_256, "secret");
    }
    ASSERT_EQ(zip_close(archive), 0) << zip_strerror(archive);
  }

  // A workbook of these sheets, each of which is the text inside <worksheet>.
  static Parts parts_of(const std::vector<std::pair<std::string, std::string>>& sheets) {
    const std::string space = " xmlns=\"http://schemas.openxmlformats.org/spreadsheetml/2006/main\"";
    Parts parts;
    std::string list, relations;
    for (std::size_t i = 0; i < sheets.size(); ++i) {
      const std::string n = std::to_string(i + 1);
      list += "<sheet name=\"" + sheets[i].first + "\" sheetId=\"" + n + "\" r:id=\"rId" + n + "\"/>";
      relations += "<Relationship Id=\"rId" + n + "\" Type=\"sheet\" Target=\"worksheets/sheet" + n + ".xml\"/>";
      parts["xl/worksheets/sheet" + n + ".xml"] = "<worksheet" + space + ">" + sheets[i].second + "</worksheet>";
    }
    parts["xl/workbook.xml"] =
        "<workbook" + space +
        " xmlns:r=\"http://schemas.openxmlformats.org/officeDocument/2006/relationships\"><sheets>" + list +
        "</sheets></workbook>";
    parts["xl/_rels/workbook.xml.rels"] =
        "<Relationships xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\">" + relations +
        "</Relationships>";
    return parts;
  }

  // Rows of cells; a cell that is a number is stored as one. Empty cells are left out.
  static std::string data(const std::vector<std::vector<std::string>>& rows) {
    std::string text = "<sheetData>";
    for (std::size_t r = 0; r < rows.size(); ++r) {
      text += "<row r=\"" + std::to_string(r + 1) + "\">";
      for (std::size_t c = 0; c < rows[r].size(); ++c) {
        if (rows[r][c].empty()) continue;
        const std::string place = (c < 26 ? std::string() : std::string(1, static_cast<char>('A' + c / 26 - 1))) +
                                  static_cast<char>('A' + c % 26) + std::to_string(r + 1);
        const bool is_number = !rows[r][c].empty() && rows[r][c].find_first_not_of("0123456789.-") == std::string::npos;
        text += is_number ? number_cell(place, rows[r][c]) : text_cell(place, rows[r][c]);
      }
      text += "</row>";
    }
    return text + "</sheetData>";
  }

  ImportedPaints good_workbook(const Parts& parts, const ImportOptions& options = {}) const {
    write(parts);
    auto result = read_file(path(), options);
    EXPECT_TRUE(result.ok()) << (result.ok() ? "" : result.error().message);
    return result.ok() ? std::move(result).value() : ImportedPaints{};
  }
  std::string refused(const Parts& parts) const {
    write(parts);
    const auto result = read_file(path());
    EXPECT_FALSE(result.ok());
    return result.ok() ? "" : result.error().message;
  }
};

const std::vector<std::string> kHeadings = {"Name",        "Date/Time",   "Geometry",
                                            "L* (D65/10)", "a* (D65/10)", "b* (D65/10)"};

TEST_F(Workbook, ReadsTheLayoutOfAnInstrument) {
  const auto paints = good_workbook(parts_of({{"Color Data", data({{"QC JOB:", "Job 1"},
                                                                   {"STANDARD:", "x"},
                                                                   kHeadings,
                                                                   {"red", "45524.65", "45as-15", "41.5", "-1.25", "3"},
                                                                   {"red", "45524.65", "15as80", "30.5", "0", "-2.5"},
                                                                   {"blue", "45524.75", "45as-15", "20", "1", "-30"}})},
                                              {"Texture Data", data({{"Name", "Date/Time", "Geometry"}})}}));
  EXPECT_THAT(paints.warnings, IsEmpty());
  ASSERT_EQ(paints.paints.size(), 2u);
  EXPECT_EQ(paints.paints[0].name, "red");
  EXPECT_EQ(paints.paints[0].measurement->condition, (color::ViewingCondition{"D65", 10}));
  ASSERT_EQ(paints.paints[0].measurement->rows.size(), 2u);
  EXPECT_EQ(paints.paints[0].measurement->rows[1].geometry, geometry("15as80"));
  EXPECT_EQ(paints.paints[0].measurement->rows[1].lab, (color::Lab{30.5, 0, -2.5}));
  EXPECT_EQ(paints.paints[1].measurement->rows[0].lab, (color::Lab{20, 1, -30}));
}

// A sheet without the codes of another adds to the paint of that name and date.
TEST_F(Workbook, DatesAndCodesTellPaintsOfOneNameApart) {
  const auto paints =
      good_workbook(parts_of({{"Color Data", data({{"Name", "Code", "Date", "Serial No.", "Geometry", "L*", "a*", "b*"},
                                                   {"red", "A", "26.11.2021", "S7", "45as15", "1", "0", "0"},
                                                   {"red", "B", "26.11.2021", "S7", "45as15", "2", "0", "0"},
                                                   {"red", "B", "27.11.2021", "S7", "45as15", "3", "0", "0"}})},
                              {"Other angles", data({{"Name", "Date", "Geometry", "L*", "a*", "b*"},
                                                     {"red", "26.11.2021", "45as45", "4", "0", "0"}})}}));
  ASSERT_EQ(paints.paints.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(paints.paints[i].code, i == 0 ? "A" : "B");
  EXPECT_EQ(paints.paints[0].measurement->rows.size(), 2u);
  EXPECT_EQ(paints.paints[0].measurement->date, "2021-11-26");
  EXPECT_EQ(paints.paints[2].measurement->date, "2021-11-27");
  EXPECT_EQ(paints.paints[2].measurement->serial, "S7");
}

TEST_F(Workbook, KeepsTexturesAsTheyStand) {
  const auto paints = good_workbook(
      parts_of({{"Color Data", data({kHeadings, {"red", "1", "45as15", "41.5", "-1.25", "3"}})},
                {"Texture Data", data({{"Name", "Date/Time", "Geometry", "Sparkle Grade (v2)", "Graininess"},
                                       {"red", "1", "15as45", "3.5", ""},
                                       {"red", "1", "15d", "", "7"}})}}));
  EXPECT_THAT(paints.warnings, IsEmpty());
  const std::vector<paint::TextureReading>& textures = paints.paints.at(0).measurement->textures;
  ASSERT_EQ(textures.size(), 2u);
  EXPECT_EQ(textures[0].quantity, "Sparkle Grade");
  EXPECT_EQ(textures[0].version, "v2");
  EXPECT_EQ(textures[0].geometry, "15as45");
  EXPECT_EQ(textures[1].geometry, "15d");
  EXPECT_EQ(textures[1].value, 7);
}

// Columns in another order, a comma for the point in cells that are texts, other words, and a condition above the
// table.
TEST_F(Workbook, FindsColumnsByWhatTheyHold) {
  const auto paints = good_workbook(parts_of({{"Tabelle1", data({{"Lichtart/Beobachter", "D50/2"},
                                                                 {"b*", "Messung", "a*", "L*", "Muster"},
                                                                 {"3,5", "45as15", "-1,25", "41,5", "rot"},
                                                                 {"1", "45as110", "2", "3", "rot"}})}}));
  ASSERT_EQ(paints.paints.size(), 1u);
  EXPECT_EQ(paints.paints[0].measurement->condition, (color::ViewingCondition{"D50", 2}));
  EXPECT_EQ(paints.paints[0].measurement->rows[0].lab, (color::Lab{41.5, -1.25, 3.5}));
  EXPECT_EQ(paints.paints[0].measurement->rows[1].geometry, geometry("45as110"));
}

// Columns of illuminant and observer were passed over, and D65/10 was said to be unstated.
TEST_F(Workbook, HearsIlluminantAndObserverInColumns) {
  const std::vector<std::string> heads = {"Name", "Geometry", "Illuminant", "Observer", "L*", "a*", "b*"};
  const auto paints = good_workbook(parts_of({{"s", data({heads, {"p", "45as15", "A", "2", "50", "1", "2"}})}}));
  EXPECT_EQ(paints.paints.at(0).measurement->condition, (color::ViewingCondition{"A", 2}));
  EXPECT_THAT(paints.warnings, IsEmpty());
  EXPECT_THAT(refused(parts_of({{"s", data({heads, {"p", "45as15", "A", "4", "50", "1", "2"}})}})),
              HasSubstr("row 2: the observer is \"4\": write 2 or 10"));
}

TEST_F(Workbook, SharedStringsMergedCellsAndDates) {
  Parts parts = parts_of(
      {{"s",
        "<sheetData><row r=\"1\"><c r=\"A1\" t=\"s\"><v>0</v></c><c r=\"B1\" t=\"s\"><v>1</v></c><c r=\"C1\" "
        "t=\"s\"><v>2</v></c><c r=\"D1\" t=\"s\"><v>3</v></c><c r=\"E1\" t=\"s\"><v>4</v></c></row>"
        "<row r=\"2\"><c r=\"A2\" s=\"1\"><v>45524.65577546</v></c><c r=\"B2\" t=\"s\"><v>5</v></c>" +
            number_cell("C2", "50") + number_cell("D2", "1") + number_cell("E2", "2") + "</row><row r=\"3\">" +
            text_cell("B3", "45as45") + "<c r=\"C3\"><f>SUM(1)</f><v>40</v></c>" + number_cell("D3", "3") +
            number_cell("E3", "4") + "</row></sheetData><mergeCells><mergeCell ref=\"A2:A3\"/></mergeCells>"}});
  parts["xl/sharedStrings.xml"] =
      "<sst "
      "xmlns=\"http://schemas.openxmlformats.org/spreadsheetml/2006/main\"><si><t>Name</t></si><si><r><t>Geo</t></r>"
      "<r><t>metry</t></r><rPh><t>no</t></rPh></si><si><t>L*</t></si><si><t>a*</t></si><si><t>b*</t></si>"
      "<si><t>45as15</t></si></sst>";
  parts["xl/styles.xml"] =
      "<styleSheet xmlns=\"http://schemas.openxmlformats.org/spreadsheetml/2006/main\"><numFmts><numFmt "
      "numFmtId=\"170\" "
      "formatCode=\"dd.mm.yyyy\"/></numFmts><cellXfs><xf numFmtId=\"0\"/><xf numFmtId=\"170\"/></cellXfs></styleSheet>";
  const auto paints = good_workbook(parts);
  ASSERT_EQ(paints.paints.size(), 1u);
  EXPECT_EQ(paints.paints[0].name, "2024-08-20 15:44:19");
  ASSERT_EQ(paints.paints[0].measurement->rows.size(), 2u);
  EXPECT_EQ(paints.paints[0].measurement->rows[1].lab, (color::Lab{40, 3, 4}));
}

// A truth value was the number 1, a date of a workbook that counts from 1904 four years early, and hidden sheets and
// rows were read without a word.
TEST_F(Workbook, HearsWhatCellsAndSheetsAre) {
  const auto sheet = [](const std::string& attributes, const std::string& L) {
    return "<sheetData><row r=\"1\">" + text_cell("A1", "Name") + text_cell("B1", "Geometry") + text_cell("C1", "L*") +
           text_cell("D1", "a*") + text_cell("E1", "b*") + text_cell("F1", "Date") + "</row><row r=\"2\" " +
           attributes + ">" + text_cell("A2", "gray") + text_cell("B2", "45as45") + L + number_cell("D2", "0") +
           number_cell("E2", "0") + "<c r=\"F2\" s=\"1\"><v>43538</v></c></row></sheetData>";
  };
  Parts parts = parts_of({{"s", sheet("hidden=\"1\"", number_cell("C2", "50"))}});
  parts["xl/styles.xml"] =
      "<styleSheet xmlns=\"http://schemas.openxmlformats.org/spreadsheetml/2006/main\"><cellXfs><xf numFmtId=\"0\"/>"
      "<xf numFmtId=\"14\"/></cellXfs></styleSheet>";
  auto paints = good_workbook(parts);
  EXPECT_EQ(paints.paints.at(0).measurement->date, "2019-03-14T00:00:00");
  EXPECT_THAT(paints.warnings, Contains(HasSubstr("sheets and rows that the workbook hides are read as well (s)")));
  std::string& book = parts["xl/workbook.xml"];
  book.insert(book.find("<sheets>"), "<workbookPr date1904=\"1\"/>");
  paints = good_workbook(parts);
  EXPECT_EQ(paints.paints.at(0).measurement->date, "2023-03-15T00:00:00");
  EXPECT_THAT(refused(parts_of({{"s", sheet("", "<c r=\"C2\" t=\"b\"><v>1</v></c>")}})),
              HasSubstr("L* is \"TRUE\": write a number"));
  EXPECT_THAT(refused(parts_of({{"s", sheet("", "<c r=\"C2\"><f>SUM(1)</f></c>")}})),
              HasSubstr("formulas of the sheet have no stored value: open and save the workbook"));
}

// The columns Hunter L, Delta L* and L (target) were taken for CIELAB, and an observer above the table was not heard.
TEST_F(Workbook, HeadingsOfOtherColorsAreNoCielab) {
  const auto sheet = [](const std::string& before, const std::string& behind) {
    std::vector<std::vector<std::string>> rows = {{"Illuminant", "A"},
                                                  {"Observer", "2"},
                                                  {"Name", "Geometry"},
                                                  {"gray", "45as45", "50", "1", "2", "60", "3", "4"}};
    for (const std::string heading : {"L*", "a*", "b*"}) rows[2].push_back(before + heading + behind);
    for (const std::string heading : {"L*", "a*", "b*"}) rows[2].push_back(heading);
    return parts_of({{"s", data(rows)}});
  };
  for (const auto& [before, behind] : {std::pair{"Hunter ", ""}, {"Delta ", ""}, {"", " (target)"}}) {
    const auto paints = good_workbook(sheet(before, behind));
    EXPECT_EQ(paints.paints.at(0).measurement->rows.at(0).lab, (color::Lab{60, 3, 4})) << before << behind;
    EXPECT_EQ(paints.paints.at(0).measurement->condition, (color::ViewingCondition{"A", 2}));
    EXPECT_THAT(paints.warnings,
                Contains(HasSubstr("columns of another color than CIELAB under a light are not read")));
  }
  for (const auto& [before, behind] : {std::pair{"CIE D65/10 ", ""}, {"", " (D65, 10 deg)"}, {"D65/10\xc2\xb0 ", ""}})
    EXPECT_EQ(good_workbook(sheet(before, behind)).paints.at(0).measurement->condition,
              (color::ViewingCondition{"D65", 10}));
}

TEST(WorkbookCells, PlacesAndDates) {
  EXPECT_EQ(cell_place("A1")->column, 0);
  EXPECT_EQ(cell_place("AB12")->column, 27);
  EXPECT_EQ(cell_place("XFD1048576")->row, 1048576);
  for (const char* wrong : {"", "A", "1", "A0", "ZZZZ1", "a1", "A1048577", "XFE1"})
    EXPECT_FALSE(cell_place(wrong).ok()) << wrong;
  EXPECT_EQ(date_text(61), "1900-03-01 00:00:00");
  EXPECT_EQ(date_text(36526.5), "2000-01-01 12:00:00");
  EXPECT_EQ(date_text(-1), "-1");
}

// Two hundredths at all wavelengths are L* 15.49 under any light: 116 (.02)^(1/3) - 16.
std::vector<std::vector<std::string>> spectra(const std::string& factor, const std::string& L) {
  std::vector<std::vector<std::string>> rows = {{"Name", "Geometry", "L*", "a*", "b*"},
                                                {"gray", "45as45", L, L.empty() ? "" : "0", L.empty() ? "" : "0"}};
  for (int nm = 400; nm <= 700; nm += 10) {
    rows[0].push_back(std::to_string(nm) + " nm");
    rows[1].push_back(factor);
  }
  return rows;
}

TEST_F(Workbook, IntegratesSpectraThatHaveNoLab) {
  const double L = 116 * std::cbrt(0.02) - 16;
  const auto paints =
      good_workbook(parts_of({{"s", data(spectra("0.02", ""))}}), {.illuminant = "A", .observer_deg = 2});
  ASSERT_EQ(paints.paints.size(), 1u);
  EXPECT_EQ(paints.paints[0].measurement->condition, (color::ViewingCondition{"A", 2}));
  EXPECT_NEAR(paints.paints[0].measurement->rows[0].lab.L, L, 1e-9);
  ASSERT_EQ(paints.paints[0].measurement->spectra.size(), 1u);
  EXPECT_EQ(paints.paints[0].measurement->spectra[0].to_nm(), 700);
}

TEST_F(Workbook, TellsPercentAndDisagreement) {
  const auto percent = good_workbook(parts_of({{"s", data(spectra("2", "15.4872"))}}));
  EXPECT_NEAR(percent.paints.at(0).measurement->spectra.at(0).factors.at(0), 0.02, 1e-12);
  EXPECT_THAT(percent.warnings, Contains(HasSubstr("percent")));
  EXPECT_THAT(percent.warnings, testing::Not(Contains(HasSubstr("dE00"))));
  const auto other = good_workbook(parts_of({{"s", data(spectra("0.02", "20"))}}));
  EXPECT_EQ(other.paints.at(0).measurement->rows.at(0).lab.L, 20);
  EXPECT_THAT(other.warnings, Contains(testing::AllOf(HasSubstr("at 1 of the readings"), HasSubstr("gray at 45as45"))));
}

// A cell that is shown as percent holds a factor, which a heading in percent divided by 100 once more.
TEST_F(Workbook, CellsShownAsPercentAreThat) {
  const auto sheet = [](const std::string& unit, const std::string& last_style) {
    std::string head = text_cell("A1", "Name") + text_cell("B1", "Geometry");
    std::string row = text_cell("A2", "gray") + text_cell("B2", "45as45");
    for (int i = 0; i < 16; ++i) {
      const std::string column(1, static_cast<char>('C' + i));
      head += text_cell(column + "1", std::to_string(400 + 20 * i) + " nm" + unit);
      row += "<c r=\"" + column + "2\" s=\"" + (i == 15 ? last_style : "1") + "\"><v>0.45</v></c>";
    }
    Parts parts =
        parts_of({{"s", "<sheetData><row r=\"1\">" + head + "</row><row r=\"2\">" + row + "</row></sheetData>"}});
    parts["xl/styles.xml"] =
        "<styleSheet xmlns=\"http://schemas.openxmlformats.org/spreadsheetml/2006/main\"><numFmts><numFmt "
        "numFmtId=\"170\" formatCode=\"0.0%\"/></numFmts><cellXfs><xf numFmtId=\"0\"/><xf numFmtId=\"10\"/><xf "
        "numFmtId=\"170\"/></cellXfs></styleSheet>";
    return parts;
  };
  for (const char* unit : {"", " (%)"}) {
    const auto paints = good_workbook(sheet(unit, "2"));
    EXPECT_NEAR(paints.paints.at(0).measurement->spectra.at(0).factors.at(15), 0.45, 1e-12) << unit;
    EXPECT_THAT(paints.warnings, testing::Not(Contains(HasSubstr("--scale"))));
  }
  EXPECT_THAT(refused(sheet(" (factor)", "1")), HasSubstr("says another scale of reflectances"));
  EXPECT_THAT(refused(sheet("", "0")), HasSubstr("some of its reflectances are shown as percent and others are not"));
}

// One factor above 20 made a whole workbook percent, and percent below 20 were factors.
TEST_F(Workbook, FindsTheScaleFromAllSpectra) {
  const auto sheet = [](const std::vector<std::string>& values, const std::string& unit = "") {
    std::vector<std::vector<std::string>> rows = {{"Name", "Geometry"}};
    for (std::size_t i = 0; i < values.size(); ++i)
      rows.push_back({"p" + std::to_string(i), i + 1 == values.size() ? "45as-15" : "45as45"});
    for (int nm = 400; nm <= 700; nm += 10) {
      rows[0].push_back(std::to_string(nm) + " nm" + unit);
      for (std::size_t i = 0; i < values.size(); ++i) rows[i + 1].push_back(values[i]);
    }
    return parts_of({{"s", data(rows)}});
  };
  EXPECT_THAT(refused(sheet({"0.3", "0.5", "0.4", "25"})), HasSubstr("nothing says whether reflectances are percent"));
  const auto factors = good_workbook(sheet({"0.3", "0.5", "0.4", "25"}), {"", 0, false, Scale::kFactor});
  EXPECT_NEAR(factors.paints.at(0).measurement->rows.at(0).lab.L, 116 * std::cbrt(0.3) - 16, 1e-9);
  EXPECT_NEAR(factors.paints.at(3).measurement->rows.at(0).lab.L, 116 * std::cbrt(25) - 16, 1e-9);
  const auto dark = good_workbook(sheet({"2", "3", "1.5", "6"}));
  EXPECT_NEAR(dark.paints.at(0).measurement->rows.at(0).lab.L, 116 * std::cbrt(0.02) - 16, 1e-9);
  EXPECT_THAT(dark.warnings, Contains(HasSubstr("read as percent: as factors, 3 of 4 paints")));
  const auto stated = good_workbook(sheet({"0.9", "0.8", "0.7"}, " [%]"));
  EXPECT_NEAR(stated.paints.at(0).measurement->rows.at(0).lab.L, 903.3 * 0.009, 0.1);
}

TEST_F(Workbook, RefusesReflectancesBelowBlack) {
  const std::string too_low = "gray at 45as45: a reflectance factor is -0.2: 0 is black";
  EXPECT_THAT(refused(parts_of({{"s", data(spectra("-0.2", ""))}})), HasSubstr(too_low));
  EXPECT_THAT(refused(parts_of({{"s", data(spectra("-20", "15.4872"))}})), HasSubstr("a reflectance factor is -20"));
  EXPECT_EQ(good_workbook(parts_of({{"s", data(spectra("-0.09", ""))}})).paints.size(), 1u);
}

TEST_F(Workbook, RefusesWhatIsNoTableOfReadings) {
  EXPECT_THAT(refused(parts_of({{"One", data({{"a", "b"}, {"1", "2"}})}})), HasSubstr("none of its sheets (\"One\")"));
  // A table without rows is one, and so is one of spectra that no observer sees, which are named.
  EXPECT_THAT(good_workbook(parts_of({{"One", data({kHeadings})}})).paints, IsEmpty());
  const auto infrared = good_workbook(parts_of({{"s", data({{"Name", "Geometry", "900", "920", "940", "960", "980"},
                                                            {"p", "45as15", "0.2", "0.2", "0.2", "0.2", "0.2"}})}}));
  EXPECT_THAT(infrared.paints, IsEmpty());
  EXPECT_THAT(infrared.warnings, testing::Contains(HasSubstr("leaves out 100 % of what the observer sees")));
  EXPECT_THAT(refused({{"a.txt", "x"}}), HasSubstr("ZIP archive without a workbook"));
  Parts parts = parts_of({{"One", data({kHeadings})}});
  parts.erase("xl/worksheets/sheet1.xml");
  EXPECT_THAT(refused(parts), HasSubstr("has no part xl/worksheets/sheet1.xml"));
  parts["xl/worksheets/sheet1.xml"] = "<!DOCTYPE x [<!ENTITY e \"e\">]><worksheet/>";
  EXPECT_THAT(refused(parts), HasSubstr("DOCTYPE"));
  parts["xl/_rels/workbook.xml.rels"] =
      "<Relationships><Relationship Id=\"rId1\" Target=\"../../../etc/passwd\"/></Relationships>";
  EXPECT_THAT(refused(parts), HasSubstr("has no part"));
}

TEST_F(Workbook, NamesSheetAndRow) {
  const auto wrong = [&](const std::vector<std::string>& row) {
    return refused(parts_of({{"Colors", data({kHeadings, row})}}));
  };
  EXPECT_THAT(wrong({"a", "1", "45as15", "1", "x", "2"}), HasSubstr("sheet \"Colors\", row 2: a* is \"x\""));
  EXPECT_THAT(wrong({"a", "1", "45as15", "1", "", "2"}), HasSubstr("row 2: one of L*, a* and b* is missing"));
  EXPECT_THAT(wrong({"a", "1", "15d", "1", "1", "2"}), HasSubstr("\"15d\""));
  EXPECT_THAT(wrong({"a", "1", "45as15", "1", "1", "99999"}), HasSubstr("row 2: b*"));
  EXPECT_THAT(wrong({"", "1", "45as15", "1", "1", "2"}), HasSubstr("has no name"));
}

TEST_F(Workbook, KeepGoingLosesOneRow) {
  const auto paints = good_workbook(
      parts_of({{"Colors", data({kHeadings, {"a", "1", "15d", "1", "1", "2"}, {"a", "1", "45as15", "1", "1", "2"}})}}),
      {.illuminant = "", .observer_deg = 0, .keep_going = true});
  EXPECT_EQ(paints.paints.at(0).measurement->rows.size(), 1u);
  EXPECT_THAT(paints.skipped, ElementsAre(HasSubstr("15d")));
}

TEST_F(Workbook, RefusesBombsPasswordsAndHalves) {
  Parts parts = parts_of({{"One", data({kHeadings})}});
  // Fifty megabytes of empty cells are packed into a quarter of one.
  std::string cells;
  while (cells.size() < 50'000'000) cells += "<c/>";
  parts["xl/worksheets/sheet1.xml"] =
      "<worksheet><sheetData><row r=\"1\"/></sheetData><other>" + cells + "</other></worksheet>";
  EXPECT_THAT(refused(parts), HasSubstr("times its size"));
  parts = parts_of({{"One", data({kHeadings, {"a", "1", "45as15", "1", "1", "2"}})}});
  write(parts, true);
  EXPECT_THAT(read_file(path()).error().message, HasSubstr("without a password"));
  EXPECT_THAT(refusal(std::string("\xd0\xcf\x11\xe0\xa1\xb1") + std::string(100, 'x')), HasSubstr("save it as XLSX"));
  write(parts);
  const std::string whole = file_content(path()).value();
  for (std::size_t size = 4; size < whole.size(); size += 97) {
    const auto half = read(whole.substr(0, size));
    EXPECT_FALSE(half.ok()) << size;
  }
}

// Rows and columns may be many: a merged range over all of them takes no more than the cells that are there.
TEST_F(Workbook, MergedRangesStayWithinTheirRows) {
  std::string merged = "<mergeCells>";
  for (int i = 0; i < 2000; ++i) merged += "<mergeCell ref=\"A1:XFD1048576\"/>";
  const auto message = refused(parts_of({{"One", data({{"a", "b"}, {"1", "2"}}) + merged + "</mergeCells>"}}));
  EXPECT_THAT(message, HasSubstr("more than 4194304 cells"));
}

TEST_F(Workbook, OfTheInstrumentRealData) {
  const char* folder = std::getenv("GONIOCHROME_DATA");
  if (!folder) GTEST_SKIP() << "GONIOCHROME_DATA is not set";
  for (const char* name : {"PAR_EW_ROz_NG_3", "PAR_PW_CB_NG_1"}) {
    const auto paints = read_file(std::string(folder) + "/instrument/" + name + ".xlsx");
    ASSERT_TRUE(paints.ok()) << paints.error().message;
    ASSERT_EQ(paints->paints.size(), 1u);
    const paint::Paint& paint = paints->paints[0];
    EXPECT_EQ(paint.name, name);
    ASSERT_EQ(paint.measurement->rows.size(), 12u);
    ASSERT_EQ(paint.measurement->spectra.size(), 12u);
    EXPECT_EQ(paint.measurement->rows.back().geometry, geometry("45as110"));
    for (std::size_t i = 0; i < 12; ++i) {
      const auto lab = paint::lab_of(paint.measurement->spectra[i], paint.measurement->condition);
      EXPECT_LT(color::delta_e_2000(*lab, paint.measurement->rows[i].lab), 0.05) << name << " " << i;
    }
  }
}

}  // namespace
}  // namespace goniochrome::formats::workbook_test
