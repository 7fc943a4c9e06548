#include "formats/cxf.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdlib>

#include "formats/internal/import_for_test.h"

namespace goniochrome::formats::cxf_test {
namespace {

class Cxf : public ImportTest<read_cxf> {
 protected:
  void write(const std::vector<paint::Paint>& paints, bool one_object_per_angle) const {
    auto writer = CxfWriter::begin(OutputFile::create(path()).value(),
                                   {"test <1>", "made & tried", "2026-01-02T03:04:05Z", one_object_per_angle});
    ASSERT_TRUE(writer.ok());
    for (const paint::Paint& paint : paints) ASSERT_TRUE(writer->write(paint).ok());
    ASSERT_TRUE(writer->finish().ok());
  }
};

TEST_F(Cxf, RoundTripKeepsEveryBit) {
  for (const bool one_object_per_angle : {false, true}) {
    write(two_paints("LED-B3"), one_object_per_angle);
    const auto read = read_file(path());
    ASSERT_TRUE(read.ok()) << read.error().message;
    EXPECT_THAT(read->warnings, IsEmpty());
    expect_same(two_paints("LED-B3"), read->paints);
  }
}

TEST_F(Cxf, SpectraComeBackAsTheyWere) {
  std::vector<paint::Paint> paints = two_paints("D50");
  paints[0].measurement->spectra = {{geometry("45as15"), 400, 10, {0.1, 1.0 / 3, 2.9}},
                                    {geometry("45as25az-76"), 360, 20, {0.2, -0.01, 0.4, 1}}};
  for (const bool one_object_per_angle : {false, true}) {
    write(paints, one_object_per_angle);
    const auto read = read_file(path());
    ASSERT_TRUE(read.ok()) << read.error().message;
    EXPECT_THAT(read->warnings, IsEmpty());
    expect_same(paints, read->paints);
    const auto &was = paints[0].measurement->spectra, &is = read->paints[0].measurement->spectra;
    ASSERT_EQ(is.size(), was.size());
    for (std::size_t i = 0; i < was.size(); ++i) {
      EXPECT_EQ(is[i].geometry, was[i].geometry);
      EXPECT_EQ(is[i].from_nm, was[i].from_nm);
      EXPECT_EQ(is[i].step_nm, was[i].step_nm);
      EXPECT_EQ(is[i].factors, was[i].factors);
    }
    EXPECT_THAT(read->paints[1].measurement->spectra, IsEmpty());
  }
}

// The schema of CxF3 has bounds for wavelengths and factors, and a spectrum has its place beside a Lab.
TEST_F(Cxf, SpectraThatTheSchemaDoesNotAllowAreLeftOutAndNamed) {
  paint::Paint paint;
  paint.name = "p";
  paint.measurement = paint::Measurement{{},
                                         "",
                                         {{geometry("45as15"), {90, 0, 0}},
                                          {geometry("45as25"), {80, 0, 0}},
                                          {geometry("45as45"), {70, 0, 0}},
                                          {geometry("45as75"), {60, 0, 0}}}};
  paint.measurement->spectra = {{geometry("45as15"), 400, 10, {0.1, 3}},
                                {geometry("45as25"), 410, 10, {0.1, 0.2}},
                                {geometry("45as45"), 400, 7, {0.1, 0.2}},
                                {geometry("45as75"), 400, 10, {0.1, 0.2}},
                                {geometry("45as110"), 400, 10, {0.1, 0.2}}};
  auto writer = CxfWriter::begin(OutputFile::create(path()).value(), {"t", "t", "2026-01-02T03:04:05Z", false});
  ASSERT_TRUE(writer->write(paint).ok());
  ASSERT_TRUE(writer->finish().ok());
  EXPECT_THAT(writer->warnings(),
              ElementsAre(HasSubstr("that CxF3 does not allow"), HasSubstr("without L*, a* and b* beside them")));
  EXPECT_THAT(writer->warnings()[0], HasSubstr("(p at 45as15 and 2 more)"));
  const auto read = read_file(path());
  ASSERT_TRUE(read.ok());
  EXPECT_EQ(read->paints[0].measurement->rows.size(), 4u);
  ASSERT_EQ(read->paints[0].measurement->spectra.size(), 1u);
  EXPECT_EQ(read->paints[0].measurement->spectra[0].geometry, geometry("45as75"));
}

TEST_F(Cxf, OneObjectPerAnglePutsOneLabIntoEach) {
  write(two_paints("LED-B3"), true);
  const std::string text = file_content(path()).value();
  std::size_t objects = 0, colors = 0;
  for (std::size_t at = 0; (at = text.find("<cc:Object ", at)) != std::string::npos; ++at) ++objects;
  for (std::size_t at = 0; (at = text.find("<cc:ColorCIELab", at)) != std::string::npos; ++at) ++colors;
  EXPECT_EQ(objects, 6u);
  EXPECT_EQ(colors, 6u);
  EXPECT_THAT(text, HasSubstr("Name=\"plain 45as15\""));
}

TEST_F(Cxf, WriterRefusesWhatTheFormatCannotHold) {
  auto writer = CxfWriter::begin(OutputFile::create(path()).value(), {});
  paint::Paint paint;
  paint.name = "empty";
  EXPECT_THAT(writer->write(paint).error().message, HasSubstr("\"empty\" has no readings"));
  paint.measurement = paint::Measurement{{}, "", {{geometry("45as110"), {-0.5, 0, 0}}}};
  EXPECT_THAT(writer->write(paint).error().message, HasSubstr("at 45as110: L* is -0.5"));
}

// --- files of others
// -----------------------------------------------------------------------------------------------------

std::string cxf(const std::string& objects, const std::string& specifications) {
  return "<CxF xmlns=\"http://colorexchangeformat.com/CxF3-core\"><Resources><ObjectCollection>" + objects +
         "</ObjectCollection>\n<ColorSpecificationCollection>" + specifications +
         "</ColorSpecificationCollection></Resources></CxF>";
}
std::string object(const std::string& name, const std::string& colors, const std::string& more = "") {
  return "<Object ObjectType=\"Standard\" Name=\"" + name +
         "\" Id=\"x1\"><CreationDate>2026-01-01T00:00:00Z</CreationDate><ColorValues>" + colors + "</ColorValues>" +
         more + "</Object>";
}
std::string lab(const std::string& specification, const char* values = "<L>50</L><A>1</A><B>2</B>") {
  return "<ColorCIELab ColorSpecification=\"" + specification + "\">" + values + "</ColorCIELab>";
}
std::string specification(const std::string& id, const std::string& geometries, const std::string& more = "",
                          const std::string& condition = "<Illuminant>A</Illuminant><Observer>10_Degree</Observer>") {
  return "<ColorSpecification Id=\"" + id + "\"><TristimulusSpec>" + condition +
         "<Method>unknown</Method></TristimulusSpec><MeasurementSpec><MeasurementType>Spectrum_Reflectance</"
         "MeasurementType>"
         "<GeometryChoice>" +
         geometries + "</GeometryChoice>" + more + "</MeasurementSpec></ColorSpecification>";
}
std::string angles(std::initializer_list<std::pair<int, const char*>> list) {
  std::string text = "<MultiAngle>";
  for (const auto& [aspecular, rest] : list)
    text += "<BRDFAngle Notation=\"" + std::to_string(aspecular) +
            "as\"><IlluminationAngle>45</IlluminationAngle><Aspecular>" + std::to_string(aspecular) + "</Aspecular>" +
            rest + "</BRDFAngle>";
  return text + "</MultiAngle>";
}

TEST_F(Cxf, ValuesFindTheirAngles) {
  const auto paints = good(cxf(
      object("one for all", lab("m")) + object("one each", lab("m") + lab("m", "<L>60</L><A>3</A><B>4</B>")) +
          object("too many", lab("m") + lab("m") + lab("m")) + object("nowhere", lab("gone")) +
          object("flat", lab("f") + "<ColorCIELCh ColorSpecification=\"z\"><L>5</L><C>10</C><H>90</H></ColorCIELCh>"),
      specification("m", angles({{15, ""}, {25, "<Azimuth>60</Azimuth>"}})) +
          specification(
              "f",
              "<SingleAngle><SingleAngleConfiguration>Annular</SingleAngleConfiguration>"
              "<IlluminationAngle>45.0</IlluminationAngle><MeasurementAngle>0.0</MeasurementAngle></SingleAngle>") +
          specification("z", angles({{75, "<Azimuth>0</Azimuth>"}}), "<Device><Model>meter</Model></Device>")));
  ASSERT_EQ(paints.paints.size(), 3u);
  const auto& all = paints.paints[0].measurement->rows;
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0].lab, all[1].lab);
  EXPECT_EQ(all[1].geometry, geometry("45as25az60"));
  EXPECT_EQ(paints.paints[0].measurement->condition, (color::ViewingCondition{"A", 10}));
  const auto& each = paints.paints[1].measurement->rows;
  ASSERT_EQ(each.size(), 2u);
  EXPECT_EQ(each[0].lab.L, 50);
  EXPECT_EQ(each[1].lab.L, 60);
  const auto& flat = paints.paints[2].measurement->rows;
  EXPECT_EQ(flat[0].geometry, geometry("45as45"));
  EXPECT_EQ(flat[1].geometry, geometry("45as75"));
  EXPECT_NEAR(flat[1].lab.b, 10, 1e-12);
  EXPECT_EQ(paints.paints[2].measurement->instrument, "meter");
  EXPECT_THAT(paints.warnings, Contains(HasSubstr("one value stands for several angles (one for all)")));
  EXPECT_THAT(paints.warnings,
              Contains(HasSubstr("3 values under a specification of 2 angles were left out (too many and 2 more)")));
  EXPECT_THAT(paints.warnings, Contains(HasSubstr("\"gone\" is not in the file")));
}

TEST_F(Cxf, ObjectsWithoutANameGetOne) {
  const std::string bare = "<Object ObjectType=\"Standard\"><ColorValues>" + lab("m") + "</ColorValues></Object>";
  const auto paints = good(cxf(bare + bare, specification("m", angles({{15, ""}}))));
  ASSERT_EQ(paints.paints.size(), 2u);
  EXPECT_THAT(paints.paints[0].name, HasSubstr("line "));
  EXPECT_NE(paints.paints[0].name, paints.paints[1].name);
  EXPECT_THAT(paints.warnings, Contains(HasSubstr("called by their line")));
}

TEST_F(Cxf, SpectraBecomeLabUnderTheirSpecification) {
  std::string ones;
  for (int i = 0; i < 41; ++i) ones += " 0.5";
  const std::string spectrum = "<ReflectanceSpectrum ColorSpecification=\"s\">" + ones + "</ReflectanceSpectrum>";
  const std::string text =
      cxf(object("gray", spectrum),
          specification("s", angles({{15, ""}}), "<WavelengthRange StartWL=\"380\" Increment=\"10\"/>"));
  const auto paints = good(text);
  ASSERT_EQ(paints.paints.size(), 1u);
  const color::Lab gray = paints.paints[0].measurement->rows[0].lab;
  EXPECT_NEAR(gray.L, 116 * std::cbrt(0.5) - 16, 1e-9);
  EXPECT_NEAR(gray.a, 0, 1e-9);
  EXPECT_NEAR(gray.b, 0, 1e-9);
  EXPECT_THAT(paints.warnings, IsEmpty());
  // The file's own Lab goes before.
  const auto own =
      good(cxf(object("gray", spectrum + lab("s")),
               specification("s", angles({{15, ""}}), "<WavelengthRange StartWL=\"380\" Increment=\"10\"/>")));
  EXPECT_EQ(own.paints[0].measurement->rows[0].lab.L, 50);
}

// Nothing is lost without a word, and no color is made of nothing.
TEST_F(Cxf, SpectraThatAreNoneAreNamedAndTheirLabIsKept) {
  const auto spectrum = [](const std::string& factors) {
    return "<ReflectanceSpectrum ColorSpecification=\"s\">" + factors + "</ReflectanceSpectrum>";
  };
  const auto text = [&](const std::string& factors, const std::string& range, bool with_lab) {
    return cxf(object("p", spectrum(factors) + (with_lab ? lab("s") : "")),
               specification("s", angles({{15, ""}}), range));
  };
  const std::string range = "<WavelengthRange StartWL=\"400\" Increment=\"10\"/>";
  struct Case {
    const char *factors, *range, *told;
  };
  for (const Case& wrong :
       {Case{"0.1 0.2", "", "without a WavelengthRange"},
        {"0.1 0.2", "<WavelengthRange StartWL=\"400\" Increment=\"0\"/>", "without a WavelengthRange"},
        {"0.1 0.2", "<WavelengthRange StartWL=\"400\" Increment=\"-10\"/>", "of a negative Increment"},
        {"0.1", range.c_str(), "of a single wavelength"},
        {"0.1 1e308", range.c_str(), "with factors beyond 2000 were left out"},
        {"0.1 -21", range.c_str(), "with factors of -0.1 or less were left out"},
        {"0.1 -0.1", range.c_str(), "with factors of -0.1 or less were left out"},
        {"0.1 0.2", "<WavelengthRange StartWL=\"400\" Increment=\"1000\"/>", "in steps of 1000 nm were left out"},
        {"0.1 0.2", "<WavelengthRange StartWL=\"400\" Increment=\"20.5\"/>", "in steps of 20.5 nm were left out"},
        {"0.1 0.2", "<WavelengthRange StartWL=\"400\" Increment=\"0.1\"/>", "in steps of 0.1 nm were left out"}}) {
    const auto beside = good(text(wrong.factors, wrong.range, true));
    ASSERT_EQ(beside.paints.size(), 1u) << wrong.told;
    EXPECT_EQ(beside.paints[0].measurement->rows[0].lab.L, 50);
    EXPECT_THAT(beside.paints[0].measurement->spectra, IsEmpty()) << wrong.told;
    EXPECT_THAT(beside.warnings, ElementsAre(testing::AllOf(HasSubstr(wrong.told), HasSubstr("(p)"))));
    const auto alone = good(text(wrong.factors, wrong.range, false));
    EXPECT_THAT(alone.paints, IsEmpty()) << wrong.told;
    EXPECT_THAT(alone.warnings, Contains(HasSubstr(wrong.told)));
  }
  // A reading of black may be a little below it, and a step that CxF3 does not have is still a step.
  for (const char* step : {"1", "7", "20"})
    EXPECT_EQ(good(text("-0.09 20", fmt::format("<WavelengthRange StartWL=\"400\" Increment=\"{}\"/>", step), true))
                  .paints[0]
                  .measurement->spectra.size(),
              1u)
        << step;
  for (const bool with_lab : {false, true})
    EXPECT_THAT(refusal(text(" ", range, with_lab)), HasSubstr("ReflectanceSpectrum is empty: write its factors"));
}

std::string flat(const std::string& specification, const std::string& value) {
  std::string text = "<ReflectanceSpectrum ColorSpecification=\"" + specification + "\">";
  for (int nm = 400; nm <= 700; nm += 10) text += " " + value;
  return text + "</ReflectanceSpectrum>";
}
std::string measured_at(const std::string& id, int aspecular) {
  return specification(id, angles({{aspecular, ""}}), "<WavelengthRange StartWL=\"400\" Increment=\"10\"/>");
}

// CxF3 defines factors: 2 at 15 deg and 1 at 45 deg was L* 130 and 100, and no paint is that bright at both.
TEST_F(Cxf, RefusesFactorsThatNoPaintHas) {
  const auto text = [](const char* near, const char* far) {
    return cxf(object("dark", flat("a", near) + flat("b", far)), measured_at("a", 15) + measured_at("b", 45));
  };
  EXPECT_THAT(
      refusal(text("2.0", "1.0")),
      HasSubstr("CxF3 says that reflectances are factors, where 1 is the perfect diffuser, and \"dark\" has 1 at "
                "45as45, which is more than a paint reflects: give paint-convert --scale percent"));
  const auto percent = good(text("2.0", "1.0"), {"", 0, false, Scale::kPercent});
  EXPECT_NEAR(percent.paints.at(0).measurement->rows.at(0).lab.L, 116 * std::cbrt(0.02) - 16, 1e-9);
  const auto silver = good(text("2.2", "0.45"));
  EXPECT_NEAR(silver.paints.at(0).measurement->rows.at(0).lab.L, 116 * std::cbrt(2.2) - 16, 1e-9);
  EXPECT_THAT(silver.warnings, IsEmpty());
  // The L* beside it says more than the schema.
  const auto beside =
      good(cxf(object("dark", flat("a", "2.0") + lab("a", "<L>15.487</L><A>0</A><B>0</B>")), measured_at("a", 15)));
  EXPECT_NEAR(beside.paints.at(0).measurement->spectra.at(0).factors.at(0), 0.02, 1e-12);
  EXPECT_THAT(beside.warnings, Contains(HasSubstr("read as percent, as the L* beside them says")));
}

TEST_F(Cxf, ReadsXyzAndSpectraOfPoints) {
  const std::string xyz = "<ColorCIEXYZ ColorSpecification=\"a\"><X>20</X><Y>21</Y><Z>22</Z></ColorCIEXYZ>";
  const auto condition = "<Illuminant>D65</Illuminant><Observer>10_Degree</Observer>";
  const std::string d65 = specification("a", angles({{15, ""}}), "", condition);
  const auto gray = good(cxf(object("gray", xyz), d65));
  const color::Lab wanted = color::lab_from_xyz({.20, .21, .22}, *color::white_point({"D65", 10}));
  EXPECT_EQ(gray.paints.at(0).measurement->rows.at(0).lab, wanted);
  EXPECT_THAT(gray.warnings, IsEmpty());
  const auto both = good(cxf(object("gray", xyz + lab("a")), d65));
  EXPECT_EQ(both.paints.at(0).measurement->rows.at(0).lab.L, 50);
  const auto points = [](std::initializer_list<int> nm) {
    std::string text = "<CustomSpectrum ColorSpecification=\"a\">";
    for (const int at : nm) text += fmt::format("<SpectralPoint WL=\"{}\">0.3</SpectralPoint>", at);
    return text + "</CustomSpectrum>";
  };
  const auto even = good(cxf(object("e", points({700, 600, 500, 400})), d65));
  EXPECT_NEAR(even.paints.at(0).measurement->rows.at(0).lab.L, 116 * std::cbrt(0.3) - 16, 1e-9);
  EXPECT_EQ(even.paints.at(0).measurement->spectra.at(0).from_nm, 400);
  const auto uneven = good(cxf(object("u", points({400, 450, 600, 700})), d65));
  EXPECT_NEAR(uneven.paints.at(0).measurement->rows.at(0).lab.L, 116 * std::cbrt(0.3) - 16, 1e-9);
  EXPECT_THAT(uneven.paints.at(0).measurement->spectra, IsEmpty());
  EXPECT_THAT(uneven.warnings, ElementsAre(HasSubstr("the points of spectra in unequal steps are not kept")));
}

// XYZ from 0 to 1 were read as percent without a word.
TEST_F(Cxf, XyzTooDarkForPercentAreTold) {
  const std::string small =
      cxf(object("s", "<ColorCIEXYZ ColorSpecification=\"a\"><X>0.2</X><Y>0.21</Y><Z>0.22</Z></ColorCIEXYZ>"),
          specification("a", angles({{15, ""}}), "", "<Illuminant>D65</Illuminant><Observer>10_Degree</Observer>"));
  EXPECT_THAT(good(small).warnings, ElementsAre(HasSubstr("no Y is above 0.21: give paint-convert --scale factor")));
  ImportOptions options;
  options.scale = Scale::kFactor;
  const auto read = good(small, options);
  EXPECT_NEAR(read.paints.at(0).measurement->rows.at(0).lab.L, 116 * std::cbrt(.21) - 16, 1e-12);
  EXPECT_THAT(read.warnings, IsEmpty());
}

// Messages name the kind of a value that is not read.
TEST_F(Cxf, NamesWhatItDoesNotRead) {
  const auto rgb =
      good(cxf(object("x", "<ColorSRGB ColorSpecification=\"a\"><R>1</R></ColorSRGB>"), measured_at("a", 15)));
  EXPECT_THAT(rgb.warnings, Contains(HasSubstr("values in ColorSRGB are not read (x)")));
  std::string film = measured_at("a", 15);
  film.replace(film.find("Spectrum_Reflectance"), 20, "Spectrum_Transmittance");
  const auto through = good(cxf(object("film", flat("a", "0.5") + lab("a")), film));
  EXPECT_THAT(through.paints, IsEmpty());
  EXPECT_THAT(through.warnings, Contains(HasSubstr("values of Spectrum_Transmittance are of no reflected light")));
  EXPECT_THAT(refusal("<CXF xmlns=\"urn:old\"/>"), HasSubstr("is CxF of another version (\"urn:old\"): export CxF3"));
  EXPECT_THAT(refusal("<CxF/>"), HasSubstr("is CxF without a namespace"));
  EXPECT_TRUE(looks_cxf("<?xml version=\"1.0\"?><a:CXF xmlns:a=\"urn:old\">"));
}

// Filters were passed over in silence, and a light of its own was said to be unstated.
TEST_F(Cxf, TellsWhatChangesReadings) {
  const auto text = [](const std::string& light, const std::string& device, const char* notation) {
    std::string all = specification(
        "a",
        "<MultiAngle><BRDFAngle Notation=\"" + std::string(notation) +
            "\"><IlluminationAngle>45</IlluminationAngle><Aspecular>15</Aspecular></BRDFAngle></MultiAngle>",
        "", light + "<Observer>10_Degree</Observer>");
    const std::size_t end = all.find("</MeasurementSpec>");
    return cxf(object("p", lab("a")), all.insert(end, "<Device>" + device + "</Device>"));
  };
  const std::string d65 = "<Illuminant>D65</Illuminant>";
  EXPECT_THAT(good(text(d65, "<DeviceFilter>Filter_None</DeviceFilter>", "45as15")).warnings, IsEmpty());
  const auto filtered = good(text(d65, "<DeviceFilter>Filter_UVExcluded</DeviceFilter>", "45as15"));
  EXPECT_THAT(filtered.warnings, ElementsAre(HasSubstr("DeviceFilter \"Filter_UVExcluded\" may change")));
  const auto polarized = good(text(d65, "<DevicePolarization>true</DevicePolarization>", "45as15"));
  EXPECT_THAT(polarized.warnings, ElementsAre(HasSubstr("DevicePolarization \"true\" may change")));
  const auto noted = good(text(d65, "", "45as-15"));
  EXPECT_THAT(noted.warnings, ElementsAre(HasSubstr("the Notation \"45as-15\" stands beside the angles of 45as15")));
  const auto custom = good(text("<CustomIlluminant Name=\"shop\"/>", "", "45as15"));
  EXPECT_THAT(custom.warnings, IsEmpty());
  EXPECT_EQ(custom.paints.at(0).measurement->condition.illuminant, "shop");
}

TEST_F(Cxf, ReadsUtf16) {
  const std::string text =
      "<?xml version=\"1.0\" encoding=\"UTF-16\"?>" + cxf(object("p", lab("a")), measured_at("a", 15));
  std::string wide = "\xff\xfe";
  for (const char c : text) wide += std::string{c, '\0'};
  EXPECT_EQ(good(wide).paints.at(0).measurement->rows.at(0).lab.L, 50);
}

TEST_F(Cxf, ConditionsAreChosenOrAssumed) {
  const std::string text =
      cxf(object("p", lab("a") + lab("b", "<L>10</L><A>0</A><B>0</B>"),
                 "<PhysicalAttributes><Gloss>80</Gloss></PhysicalAttributes>"),
          specification("a", angles({{15, ""}})) +
              specification("b", angles({{15, ""}}), "", "<Illuminant>D50</Illuminant><Observer>2_Degree</Observer>"));
  const auto first = good(text);
  EXPECT_EQ(first.paints[0].measurement->rows[0].lab.L, 50);
  EXPECT_EQ(first.paints[0].gloss[0].angle_deg, 60);
  EXPECT_THAT(first.warnings,
              ElementsAre(HasSubstr("gloss without its angle"), HasSubstr("--illuminant and --observer")));
  EXPECT_EQ(good(text, {"D50", 2, false}).paints[0].measurement->rows[0].lab.L, 10);
  const auto silent = good(cxf(object("p", lab("a")), specification("a", angles({{15, ""}}), "", "")));
  EXPECT_EQ(silent.paints[0].measurement->condition, (color::ViewingCondition{"D65", 10}));
  EXPECT_THAT(silent.warnings, ElementsAre(HasSubstr("taken as D65/10")));
}

TEST_F(Cxf, TheAngleOfAGlossIsNoNumberOfAStandard) {
  const auto glosses = [&](const std::string& method) {
    return good(cxf(
        object("p", lab("a"), "<PhysicalAttributes><Gloss Method=\"" + method + "\">80</Gloss></PhysicalAttributes>"),
        specification("a", angles({{15, ""}}))));
  };
  for (const auto& [method, angle] :
       std::initializer_list<std::pair<const char*, double>>{{"60 deg", 60},
                                                             {"ISO 2813, 20 degree", 20},
                                                             {"DIN 67530 85\xc2\xb0", 85},
                                                             {"20\xc2\xb0 (ISO 2813:2014)", 20},
                                                             {"85.", 85},
                                                             {"ISO 2813", 60}}) {
    const auto read = glosses(method);
    ASSERT_EQ(read.paints[0].gloss.size(), 1u) << method;
    EXPECT_EQ(read.paints[0].gloss[0].angle_deg, angle) << method;
  }
  const auto other = glosses("75 deg");
  EXPECT_THAT(other.paints[0].gloss, IsEmpty());
  EXPECT_THAT(other.warnings, ElementsAre(HasSubstr("another angle than 20, 60 and 85 deg")));
}

TEST_F(Cxf, AnAngleWithoutNumbersIsItsNotationOrRefused) {
  const auto angle = [](const std::string& notation) {
    return "<MultiAngle><BRDFAngle Notation=\"" + notation + "\"></BRDFAngle></MultiAngle>";
  };
  const auto noted = good(cxf(object("p", lab("a")), specification("a", angle("15as-30"))));
  EXPECT_EQ(noted.paints[0].measurement->rows[0].geometry, geometry("15as-30"));
  EXPECT_THAT(refusal(cxf(object("p", lab("a")), specification("a", angle("front")))),
              HasSubstr("BRDFAngle has no Aspecular, and its Notation \"front\" names no geometry"));
}

// Colors of a palette have no geometry: the user says which they stand for.
TEST_F(Cxf, ReadsTheColorsOfCxf2) {
  std::string spectrum;
  for (int i = 0; i < 31; ++i) spectrum += " .2";
  const std::string text =
      "<?xml version='1.0'?><CxF xmlns='http://colorexchangeformat.com/v2'><Palette PaletteName='p'><ColorSet>"
      "<Color ColorName='r'><ColorSpaceCIELab><L>50</L><A>1</A><B>-2</B></ColorSpaceCIELab></Color>"
      "<Color ColorName='s'><ReflectanceSpectrum StartWL='400' Increment='10'>" +
      spectrum + "</ReflectanceSpectrum></Color></ColorSet></Palette></CxF>";
  const auto none = good(text);
  EXPECT_THAT(none.paints, IsEmpty());
  EXPECT_THAT(none.warnings, Contains(HasSubstr("give paint-convert --viewing GEOMETRY")));
  ImportOptions options;
  options.viewings = {{"", geometry("45as45")}};
  const auto paints = good(text, options);
  ASSERT_EQ(paints.paints.size(), 2u);
  EXPECT_EQ(paints.paints[0].name, "r");
  EXPECT_EQ(paints.paints[0].measurement->rows.at(0).lab, (color::Lab{50, 1, -2}));
  EXPECT_EQ(paints.paints[1].measurement->spectra.at(0).factors.size(), 31u);
  EXPECT_NEAR(paints.paints[1].measurement->rows.at(0).lab.L, 51.8372, 1e-4);  // 116 (.2)^(1/3) - 16
}

// Each set of colors states its light and observer, and what it does not state is told.
TEST_F(Cxf, HearsTheConditionOfCxf2) {
  const auto set = [](const std::string& name, const std::string& stated) {
    return "<ColorSet>" + stated + "<Color ColorName='" + name +
           "'><ColorSpaceCIELab><L>50</L><A>1</A><B>-2</B></ColorSpaceCIELab></Color></ColorSet>";
  };
  const std::string d50 =
      "<CollectionColorSpaceSpecification><ColorSpaceSpecificationSpectrumTristimulus>"
      "<FieldOfView>FieldOfView_2_Degree</FieldOfView><IlluminationOptions><Illuminant>Illuminant_D50</Illuminant>"
      "</IlluminationOptions></ColorSpaceSpecificationSpectrumTristimulus></CollectionColorSpaceSpecification>";
  ImportOptions options;
  options.viewings = {{"", geometry("45as45")}};
  const auto palette = [](const std::string& sets) {
    return "<CxF xmlns='http://colorexchangeformat.com/v2'><Palette>" + sets + "</Palette></CxF>";
  };
  const auto stated = good(palette(set("p", d50)), options);
  ASSERT_EQ(stated.paints.size(), 1u);
  EXPECT_EQ(paint::condition_of(stated.paints[0]), (color::ViewingCondition{"D50", 2}));
  EXPECT_THAT(stated.warnings, Not(Contains(HasSubstr("is not stated: taken as D65/10"))));
  const auto both = good(palette(set("p", d50) + set("q", "")), options);
  ASSERT_EQ(both.paints.size(), 2u);
  EXPECT_EQ(paint::condition_of(both.paints[0]), (color::ViewingCondition{"D50", 2}));
  EXPECT_EQ(paint::condition_of(both.paints[1]), (color::ViewingCondition{"D65", 10}));
  EXPECT_THAT(both.warnings, Contains(HasSubstr("is not stated: taken as D65/10")));
}

// A part of a color that is not there was 0.
TEST_F(Cxf, ColorsAreWhole) {
  const std::string at_15 = specification("a", angles({{15, ""}}));
  EXPECT_THAT(refusal(cxf(object("p", lab("a", "<L>50</L><A>1</A>")), at_15)),
              HasSubstr("a Lab lacks one of L, A and B: write all three"));
  for (const auto& [kind, value, told] : {std::array<const char*, 3>{"CIEXYZ", "<X>20</X><Y>20</Y>", "X, Y and Z"},
                                          {"CIELCh", "<L>50</L><C>10</C>", "L, C and H"}})
    EXPECT_THAT(
        refusal(cxf(object("p", fmt::format("<Color{0} ColorSpecification=\"a\">{1}</Color{0}>", kind, value)), at_15)),
        HasSubstr(told));
}

TEST_F(Cxf, RefusalsNameTheLine) {
  EXPECT_THAT(refusal(cxf("\n" + object("p", lab("a", "\n<L>12,5</L><A>1</A><B>2</B>")), "")),
              HasSubstr(":3: L is \"12,5\": write a number with a decimal point"));
  EXPECT_THAT(refusal("<CxF xmlns=\"http://colorexchangeformat.com/v1\"/>"), HasSubstr("export CxF3"));
  EXPECT_THAT(refusal("<html/>"), HasSubstr("no CxF file"));
  EXPECT_THAT(refusal(""), HasSubstr("is empty"));
  const auto kept = good(cxf(object("p", lab("a", "<L>x</L><A>1</A><B>2</B>")) + object("q", lab("a")),
                             specification("a", angles({{15, ""}}))),
                         {"", 0, true});
  ASSERT_EQ(kept.paints.size(), 1u);
  EXPECT_EQ(kept.paints[0].name, "q");
  EXPECT_THAT(kept.skipped, ElementsAre(HasSubstr("L is \"x\"")));
}

// Paints come one by one, and an object that cannot be read is told in its place.
TEST_F(Cxf, ReaderGivesPaintsInOrder) {
  const std::string bad = lab("a", "<L>x</L><A>1</A><B>2</B>");
  const std::string text =
      cxf(object("p", lab("a")) + object("bad", bad) + object("q", lab("a")), specification("a", angles({{15, ""}})));
  ASSERT_TRUE(write_file(path(), text).ok());
  auto reader = CxfReader::open(InputFile::open(path()).value(), {"", 0, true});
  ASSERT_TRUE(reader.ok());
  std::vector<std::string> names;
  int errors = 0;
  for (;;) {
    const auto paint = reader->next();
    if (!paint.ok())
      ++errors;
    else if (*paint)
      names.push_back((*paint)->name);
    else
      break;
  }
  EXPECT_THAT(names, ElementsAre("p", "q"));
  EXPECT_EQ(errors, 1);
  EXPECT_FALSE(reader->next()->has_value()) << "the end stays the end";
}

TEST_F(Cxf, HostileFilesAreRefused) {
  const std::string good_file = cxf(object("p", lab("a")), specification("a", angles({{15, ""}})));
  EXPECT_THAT(refusal("<!DOCTYPE CxF [<!ENTITY a \"aaaaaaaaaa\"><!ENTITY b \"&a;&a;&a;\">]>" + good_file),
              HasSubstr("<!DOCTYPE"));
  EXPECT_THAT(refusal("<!DOCTYPE CxF SYSTEM \"file:///etc/passwd\">" + good_file), HasSubstr("<!DOCTYPE"));
  EXPECT_THAT(refusal(std::string_view(good_file).substr(0, good_file.size() / 2)), HasSubstr("cut off"));
  EXPECT_THAT(refusal(cxf(object(std::string(3 << 20, 'x'), lab("a")), "")), HasSubstr("longer than"));
  EXPECT_THAT(refusal(cxf(object("\xFF", lab("a")), "")), HasSubstr("UTF-8"));
  std::string deep = "<CxF xmlns=\"http://colorexchangeformat.com/CxF3-core\">";
  for (int i = 0; i < 2000; ++i) deep += "<a>";
  EXPECT_FALSE(read(deep).ok());
}

// --- the published schema and samples
// ------------------------------------------------------------------------------------

std::string data_path(const std::string& relative) {
  return std::string(std::getenv("GONIOCHROME_DATA")) + "/cxf/" + relative;
}

TEST_F(Cxf, OutputIsValidUnderThePublishedSchemaRealData) {
  if (!std::getenv("GONIOCHROME_DATA")) GTEST_SKIP() << "GONIOCHROME_DATA is not set";
  if (std::system("xmllint --version >/dev/null 2>&1") != 0) GTEST_SKIP() << "xmllint is not installed";
  for (const bool one_object_per_angle : {false, true}) {
    write(two_paints("LED-B3"), one_object_per_angle);
    EXPECT_EQ(
        std::system(fmt::format("xmllint --noout --schema {} {} 2>&1", data_path("CxF3_Core.xsd"), path()).c_str()), 0);
  }
  write({}, false);
  EXPECT_EQ(std::system(fmt::format("xmllint --noout --schema {} {} 2>&1", data_path("CxF3_Core.xsd"), path()).c_str()),
            0);
}

TEST_F(Cxf, PublishedSamplesAreReadRealData) {
  if (!std::getenv("GONIOCHROME_DATA")) GTEST_SKIP() << "GONIOCHROME_DATA is not set";
  for (const char* empty : {"minimal_cxf.cxf", "empty_sections.cxf", "multiple_objects.cxf"}) {
    const auto read = read_file(data_path(empty));
    ASSERT_TRUE(read.ok()) << read.error().message;
    EXPECT_THAT(read->paints, IsEmpty());
    EXPECT_EQ(read->warnings.size(), 1u);
  }
  const auto target = read_file(data_path("sample.cxf"));
  ASSERT_TRUE(target.ok());
  ASSERT_EQ(target->paints.size(), 144u);
  EXPECT_EQ(target->paints[0].measurement->condition, (color::ViewingCondition{"D50", 2}));
  EXPECT_EQ(target->paints[0].measurement->rows[0].lab, (color::Lab{17.64167, 1.076669, 0.3338588}));

  const auto edges = read_file(data_path("geometry_edge_cases.cxf"));
  ASSERT_TRUE(edges.ok());
  ASSERT_EQ(edges->paints.size(), 2u);
  std::vector<std::string> names;
  for (const paint::Paint& paint : edges->paints)
    for (const paint::LabReading& row : paint.measurement->rows) names.push_back(paint::geometry_name(row.geometry));
  EXPECT_THAT(names, ElementsAre("45as15", "45as25", "45as45", "45as15az30", "45as25az60"));
  EXPECT_EQ(edges->warnings.size(), 5u);
}

// The sample holds its Lab and its spectra: ours from the spectra against its own, both D50/2.
TEST_F(Cxf, SpectraOfTheSampleGiveItsLabRealData) {
  if (!std::getenv("GONIOCHROME_DATA")) GTEST_SKIP() << "GONIOCHROME_DATA is not set";
  const auto stated = read_file(data_path("sample.cxf"));
  std::string text = file_content(data_path("sample.cxf")).value();
  for (std::size_t at = 0; (at = text.find("<cc:ColorCIELab", at)) != std::string::npos;) {
    const auto end = text.find("</cc:ColorCIELab>", at);
    text.erase(at, end - at + 17);
  }
  const auto integrated = good(text);
  ASSERT_EQ(integrated.paints.size(), stated->paints.size());
  double sum = 0;
  for (std::size_t i = 0; i < stated->paints.size(); ++i)
    sum += color::delta_e_76(stated->paints[i].measurement->rows[0].lab, integrated.paints[i].measurement->rows[0].lab);
  // Its maker summed 10 nm weights; ours interpolate to 1 nm and hold 680 nm for the rest.
  EXPECT_LT(sum / static_cast<double>(stated->paints.size()), 0.6);
}

}  // namespace
}  // namespace goniochrome::formats::cxf_test
