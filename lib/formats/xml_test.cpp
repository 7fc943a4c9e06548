#include "formats/xml.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <libxml/parser.h>
#include <libxml/xmlschemas.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>

#include "base/scratch_for_test.h"
#include "base/testdata_for_test.h"
#include "formats/basis.h"

namespace goniochrome::formats::xml_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const std::string kHead = "<?xml version=\"1.0\"?>\n<paints xmlns=\"urn:goniochrome:paint:1\" version=\"1\">\n";

std::string document(const std::string& body) {
  return kHead + body + "</paints>\n";
}

std::string measured(const std::string& name, const std::string& lab) {
  return "<paint name=\"" + name + "\">\n<measurement illuminant=\"D65\" observer=\"10\">\n" + lab +
         "</measurement>\n</paint>\n";
}

// The paints of a document, one by one.
struct Reading {
  std::vector<paint::Paint> paints;
  std::vector<std::string> errors;
  std::vector<int> lines;
  std::vector<Processing> processing;
  std::vector<std::string> foreign;
};

Reading reading_of(const std::string& path) {
  Reading reading;
  auto reader = PaintReader::open(path);
  if (!reader.ok()) {
    reading.errors.push_back(reader.error().message);
    return reading;
  }
  for (;;) {
    auto paint = reader->next();
    if (!paint.ok()) {
      reading.errors.push_back(paint.error().message.substr(paint.error().message.rfind('/') + 1));
      continue;
    }
    if (!*paint) break;
    reading.paints.push_back(std::move(**paint));
    reading.lines.push_back(reader->line());
  }
  reading.processing = reader->processing();
  reading.foreign = reader->foreign();
  return reading;
}

Reading reading_of_text(const std::string& text) {
  const ScratchFolder folder;
  return reading_of(folder.file("p.xml", text));
}

std::string only_error(const std::string& text) {
  const Reading reading = reading_of_text(text);
  EXPECT_EQ(reading.errors.size(), 1u) << text;
  // A message may hold a '/' itself; only what follows the folder matters.
  return reading.errors.empty() ? "" : reading.errors.front();
}

Result<void> write_all(const std::string& path, const std::vector<paint::Paint>& paints,
                       const std::vector<Processing>& history = {}, const std::vector<std::string>& foreign = {}) {
  GONIO_ASSIGN(OutputFile file, OutputFile::create(path));
  GONIO_ASSIGN(PaintWriter writer, PaintWriter::begin(std::move(file), history, foreign));
  for (const paint::Paint& paint : paints) GONIO_TRY(writer.write(paint));
  return writer.finish();
}

paint::Paint full_paint() {
  paint::Paint paint;
  paint.name = "a \"quoted\" <name> & 'more', \xc3\xa9\n";
  paint.code = "R&D";
  paint.paint_class = paint::PaintClass::kInterference;
  paint.measurement = paint::Measurement{{"A", 2}, "goniometer \"7\"", {}};
  for (const char* name : {"45as15", "45as-15", "r45as-15", "15as-45", "45as25az90", "45as110"})
    paint.measurement->rows.push_back({*paint::parse_geometry(name), {160.1 / 3, -1e-17, 1e4 / 7}});
  paint.gloss = {{20, 81.7}, {60, 0}, {85, 1999.5}};
  paint.appearance = paint::Appearance{{95, 1, 2}, {0.1 + 0.2, -5e-324, 2}, std::nextafter(15.0, 16.0), 0.41};
  paint.anisotropy = paint::Anisotropy{0.05, 0.3};
  paint.flakes = paint::Flakes{22.5, 0.4, 0.7};
  paint.color_map = paint::ColorMapReference{"maps/x y.exr", 1.5};
  paint.lobes = paint::LobeFit{"b7", "l1", 1.25, 0.5, 1.5375, {0.1, 0.2, 0.3}, {}};
  paint.coat_index = 1.5375;
  paint.lobes->lobes = {{12.5, {1, 2, 3}, {4, 5, 6}}, {INFINITY, {0, 0, 0}, {1e-300, 987654321098.7654, 0.1}}};
  paint.lobes->views = {{0, {0.1, 0.2, 0.3}, {{12.5, {1, 2, 3}, {}}}}, {90, {0.3, 0.2, 0.1}, {}}};
  paint.foreign = {"<x:note xmlns:x=\"urn:x\" k=\"1\">a<x:b/>c &amp; d</x:note>", "<y xmlns=\"urn:y\"/>"};
  return paint;
}

void expect_same(const paint::Paint& x, const paint::Paint& y) {
  EXPECT_EQ(x.name, y.name);
  EXPECT_EQ(x.code, y.code);
  EXPECT_EQ(x.paint_class, y.paint_class);
  ASSERT_EQ(x.measurement.has_value(), y.measurement.has_value());
  if (x.measurement) {
    EXPECT_EQ(x.measurement->condition, y.measurement->condition);
    EXPECT_EQ(x.measurement->instrument, y.measurement->instrument);
    ASSERT_EQ(x.measurement->rows.size(), y.measurement->rows.size());
    for (std::size_t i = 0; i < x.measurement->rows.size(); ++i) {
      EXPECT_EQ(x.measurement->rows[i].geometry, y.measurement->rows[i].geometry);
      EXPECT_EQ(x.measurement->rows[i].lab, y.measurement->rows[i].lab);
    }
  }
  ASSERT_EQ(x.gloss.size(), y.gloss.size());
  for (std::size_t i = 0; i < x.gloss.size(); ++i) {
    EXPECT_EQ(x.gloss[i].angle_deg, y.gloss[i].angle_deg);
    EXPECT_EQ(x.gloss[i].gloss_units, y.gloss[i].gloss_units);
  }
  ASSERT_EQ(x.appearance.has_value(), y.appearance.has_value());
  if (x.appearance) {
    EXPECT_EQ(x.appearance->face, y.appearance->face);
    EXPECT_EQ(x.appearance->flop, y.appearance->flop);
    EXPECT_EQ(x.appearance->travel_deg, y.appearance->travel_deg);
    EXPECT_EQ(x.appearance->residual_de00, y.appearance->residual_de00);
  }
  EXPECT_EQ(x.coat_index, y.coat_index);
  EXPECT_EQ(x.foreign, y.foreign);
}

TEST(PaintXml, EveryPartSurvivesToTheLastBit) {
  const ScratchFolder folder;
  const paint::Paint paint = full_paint();
  const std::string path = folder.path("p.xml");
  const std::vector<std::string> foreign = {"<z:top xmlns:z=\"urn:z\"/>"};
  ASSERT_TRUE(write_all(path, {paint}, {{"fit-paint", "0.1.0", "fit-paint 'a b' < x & y"}}, foreign).ok());
  const Reading reading = reading_of(path);
  ASSERT_THAT(reading.errors, ElementsAre());
  ASSERT_EQ(reading.paints.size(), 1u);
  const paint::Paint& back = reading.paints.front();
  expect_same(back, paint);
  EXPECT_EQ(back.anisotropy->alpha_x, 0.05);
  EXPECT_EQ(back.anisotropy->alpha_y, 0.3);
  EXPECT_EQ(back.flakes, (paint::Flakes{22.5, 0.4, 0.7}));
  EXPECT_EQ(back.color_map->href, "maps/x y.exr");
  EXPECT_EQ(back.lobes->diffuse, paint.lobes->diffuse);
  ASSERT_EQ(back.lobes->lobes.size(), 2u);
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(back.lobes->lobes[i].exponent, paint.lobes->lobes[i].exponent);
    EXPECT_EQ(back.lobes->lobes[i].directional_diffuse, paint.lobes->lobes[i].directional_diffuse);
    EXPECT_EQ(back.lobes->lobes[i].gloss, paint.lobes->lobes[i].gloss);
  }
  ASSERT_EQ(back.lobes->views.size(), 2u);
  EXPECT_EQ(back.lobes->views[0].view_deg, 0);
  ASSERT_EQ(back.lobes->views[0].lobes.size(), 1u);
  EXPECT_EQ(back.lobes->views[0].lobes[0].directional_diffuse, (color::Rgb{1, 2, 3}));
  EXPECT_EQ(back.lobes->views[1].view_deg, 90);
  EXPECT_EQ(back.lobes->views[1].diffuse, (color::Rgb{0.3, 0.2, 0.1}));
  EXPECT_EQ(reading.foreign, foreign);
  ASSERT_EQ(reading.processing.size(), 1u);
  EXPECT_EQ(reading.processing[0].command, "fit-paint 'a b' < x & y");
  // Written again it is the same file.
  ASSERT_TRUE(write_all(folder.path("q.xml"), reading.paints, reading.processing, reading.foreign).ok());
  EXPECT_EQ(folder.content("q.xml"), folder.content("p.xml"));
}

// The coat of the lobes is that of the paint. Lobes of a file that does not know coats have none.
TEST(PaintXml, LobesHoldUnderTheCoatThatThePaintStates) {
  const auto read = [](const std::string& coat) {
    const ScratchFolder folder;
    const std::string lobes =
        "<lobes space=\"lin_rec2020_scene\" basis=\"b\" method=\"l1\" max_de00=\"1\" mean_de00=\"1\">"
        "<diffuse r=\"1\" g=\"1\" b=\"1\"/></lobes>";
    const std::string path = folder.path("p.xml");
    std::ofstream(path) << document("<paint name=\"p\">" + lobes + coat + "</paint>\n");
    const Reading reading = reading_of(path);
    EXPECT_THAT(reading.errors, ElementsAre());
    return reading.paints.front();
  };
  EXPECT_EQ(read("").coat_index, std::nullopt);
  EXPECT_EQ(read("").lobes->coat_index, paint::kNoCoat);
  EXPECT_EQ(read("<coat index=\"1.52\"/>").lobes->coat_index, 1.52);
  EXPECT_EQ(read("<coat index=\"1\"/>").coat_index, paint::kNoCoat);
  // Lobes that were fitted again have the last word.
  const ScratchFolder folder;
  paint::Paint paint = read("<coat index=\"1.52\"/>");
  paint.lobes->coat_index = paint::kNoCoat;
  ASSERT_TRUE(write_all(folder.path("q.xml"), {paint}, {}, {}).ok());
  EXPECT_EQ(reading_of(folder.path("q.xml")).paints.front().lobes->coat_index, paint::kNoCoat);
}

TEST(PaintXml, ReadsTheSampleLibraryInOrderWithItsLines) {
  const Reading reading = reading_of(testdata("paints.paints.xml"));
  EXPECT_THAT(reading.errors, ElementsAre());
  ASSERT_GT(reading.paints.size(), 35u);
  EXPECT_EQ(reading.paints[0].name, "arctic_white");
  EXPECT_EQ(reading.paints[0].measurement->rows[1].lab, (color::Lab{95.03, -0.82, 2.07}));
  EXPECT_EQ(reading.lines[0], 4);
  EXPECT_EQ(reading.lines[1], 12);
}

TEST(PaintXml, PartsComeInAnyOrderAndAnEmptyLibraryIsOne) {
  const Reading reading = reading_of_text(document(
      "<paint name=\"p\"><gloss angle=\"60\"> 92.1 </gloss><appearance travel=\"63\"><flop L=\"1\" a=\"2\" "
      "b=\"3\"/><face "
      "L=\"4\" a=\"5\" b=\"+6e0\"/></appearance><measurement observer=\"2\" illuminant=\"D50\"><lab b=\"3\" a=\"2\" "
      "L=\" 1 \" geometry=\"15\"/></measurement></paint>"));
  EXPECT_THAT(reading.errors, ElementsAre());
  ASSERT_EQ(reading.paints.size(), 1u);
  EXPECT_EQ(reading.paints[0].appearance->face, (color::Lab{4, 5, 6}));
  EXPECT_EQ(reading.paints[0].measurement->condition, (color::ViewingCondition{"D50", 2}));
  EXPECT_EQ(reading.paints[0].gloss[0].gloss_units, 92.1);
  const Reading none = reading_of_text(document(""));
  EXPECT_TRUE(none.errors.empty() && none.paints.empty());
}

TEST(PaintXml, ForeignElementsMeanTheSameWhereverTheyAreWritten) {
  const ScratchFolder folder;
  const std::string text =
      "<p:paints xmlns:p=\"urn:goniochrome:paint:1\" xmlns:x=\"urn:x\" xmlns=\"urn:default\" version=\"1\">"
      "<x:head/><p:paint name=\"a\" xmlns:y=\"urn:y\"><x:one y:k=\"&lt;&amp;&quot;\">t<![CDATA[<&]]><!-- gone "
      "--></x:one>"
      "<two>&#10;<p:lab/></two></p:paint></p:paints>";
  const Reading first = reading_of(folder.file("p.xml", text));
  ASSERT_THAT(first.errors, ElementsAre());
  EXPECT_THAT(first.foreign,
              ElementsAre("<x:head xmlns=\"urn:default\" xmlns:p=\"urn:goniochrome:paint:1\" xmlns:x=\"urn:x\"/>"));
  const std::string scope =
      " xmlns=\"urn:default\" xmlns:p=\"urn:goniochrome:paint:1\" xmlns:x=\"urn:x\" xmlns:y=\"urn:y\"";
  EXPECT_THAT(first.paints[0].foreign, ElementsAre("<x:one" + scope + " y:k=\"&lt;&amp;&quot;\">t&lt;&amp;</x:one>",
                                                   "<two" + scope + ">\n<p:lab/></two>"));
  ASSERT_TRUE(write_all(folder.path("q.xml"), first.paints, {}, first.foreign).ok());
  const Reading second = reading_of(folder.path("q.xml"));
  EXPECT_THAT(second.errors, ElementsAre());
  EXPECT_EQ(second.paints[0].foreign, first.paints[0].foreign);
  EXPECT_EQ(second.foreign, first.foreign);
}

TEST(PaintXml, OneWrongValueLosesOnePaint) {
  const Reading reading =
      reading_of_text(document(measured("a", "<lab geometry=\"45as15\" L=\"1\" a=\"2\" b=\"3\"/>\n") +
                               measured("b", "<lab geometry=\"45as15\" L=\"1\" a=\"two\" b=\"3\"/>\n") +
                               measured("c", "<lab geometry=\"45as15\" L=\"1\" a=\"2\" b=\"3\"/>\n")));
  ASSERT_EQ(reading.paints.size(), 2u);
  EXPECT_EQ(reading.paints[0].name, "a");
  EXPECT_EQ(reading.paints[1].name, "c");
  EXPECT_THAT(reading.errors, ElementsAre("p.xml:10: a is \"two\": write a number such as 12.5"));
}

// The check that all writers share.
TEST(PaintXml, WhatIsNoColorOrNotFiniteIsNotWritten) {
  const ScratchFolder folder;
  const auto refused = [&](const std::function<void(paint::Paint&)>& spoil) {
    paint::Paint paint = full_paint();
    spoil(paint);
    const auto written = write_all(folder.path("p.xml"), {paint});
    return written.ok() ? std::string() : written.error().message;
  };
  const auto tilted = [](double tilt_deg, double weight) {
    const paint::TiltedView view = {0, {0.1, 0.1, 0.1}, {{weight, 0, 0}}};
    return std::vector{paint::TiltedLobes{1, {{12, tilt_deg, 0}}, {view, view}}};
  };
  EXPECT_EQ(refused([](paint::Paint&) {}), "");
  EXPECT_EQ(refused([&](paint::Paint& p) { p.lobes->tilts = tilted(1, 1); }), "");
  std::filesystem::remove(folder.path("p.xml"));
  for (const double wrong : {std::nan(""), HUGE_VAL, 1e50}) {
    EXPECT_NE(refused([&](paint::Paint& p) { p.measurement->rows[0].lab.a = wrong; }), "") << wrong;
    EXPECT_NE(refused([&](paint::Paint& p) { p.appearance->face.L = wrong; }), "") << wrong;
  }
  for (const double wrong : {std::nan(""), HUGE_VAL}) {
    EXPECT_NE(refused([&](paint::Paint& p) { p.appearance->travel_deg = wrong; }), "") << wrong;
    EXPECT_NE(refused([&](paint::Paint& p) { p.gloss[0].gloss_units = wrong; }), "") << wrong;
    EXPECT_NE(refused([&](paint::Paint& p) { p.lobes->lobes[0].gloss.x = wrong; }), "") << wrong;
    EXPECT_NE(refused([&](paint::Paint& p) { p.appearance->residual_de00 = wrong; }), "") << wrong;
    EXPECT_NE(refused([&](paint::Paint& p) { p.anisotropy->alpha_y = wrong; }), "") << wrong;
    EXPECT_NE(refused([&](paint::Paint& p) { p.flakes->coverage = wrong; }), "") << wrong;
    EXPECT_NE(refused([&](paint::Paint& p) { p.color_map->index = wrong; }), "") << wrong;
    EXPECT_NE(refused([&](paint::Paint& p) { p.coat_index = wrong; }), "") << wrong;
    EXPECT_NE(refused([&](paint::Paint& p) { p.lobes->coat_index = wrong; }), "") << wrong;
    EXPECT_NE(refused([&](paint::Paint& p) { p.lobes->mean_de00 = wrong; }), "") << wrong;
    EXPECT_NE(refused([&](paint::Paint& p) { p.lobes->views[1].view_deg = wrong; }), "") << wrong;
    EXPECT_NE(refused([&](paint::Paint& p) { p.lobes->lobes[0].exponent = -wrong; }), "") << wrong;
    EXPECT_NE(refused([&](paint::Paint& p) { p.lobes->tilts = tilted(wrong, 0); }), "") << wrong;
    EXPECT_NE(refused([&](paint::Paint& p) { p.lobes->tilts = tilted(0, wrong); }), "") << wrong;
  }
  EXPECT_EQ(folder.files(), 0u);
}

TEST(PaintXml, WrongValuesAreNamedWithLineAndRemedy) {
  const auto lab = [](const std::string& row) { return only_error(document(measured("p", row + "\n"))); };
  const auto paint = [](const std::string& body) {
    return only_error(document("<paint name=\"p\">\n" + body + "</paint>\n"));
  };
  EXPECT_EQ(lab("<lab geometry=\"45as15\" L=\"12,5\" a=\"2\" b=\"3\"/>"),
            "p.xml:5: L is \"12,5\": write a decimal point");
  EXPECT_EQ(lab("<lab\ngeometry=\"45as15\"\nL=\"12\"\na=\"\" b=\"3\"/>"), "p.xml:8: a is empty: write a number");
  EXPECT_EQ(lab("<lab geometry=\"45as15\" L=\"NaN\" a=\"2\" b=\"3\"/>"),
            "p.xml:5: L is \"NaN\": write a finite number");
  EXPECT_EQ(lab("<lab geometry=\"45as15\" L=\"1e999\" a=\"2\" b=\"3\"/>"),
            "p.xml:5: L is \"1e999\": write a number such as 12.5");
  EXPECT_EQ(lab("<lab geometry=\"45as15\" L=\"64abc\" a=\"2\" b=\"3\"/>"),
            "p.xml:5: L is \"64abc\": write a number such as 12.5");
  EXPECT_EQ(lab("<lab geometry=\"45as15\" L=\"64\" b=\"3\"/>"), "p.xml:5: <lab> has no a: write a=\"...\"");
  EXPECT_EQ(lab("<lab geometry=\"45as15\" L=\"64\" a=\"1\" b=\"3\" c=\"4\"/>"),
            "p.xml:5: <lab> takes no attribute \"c\": it takes geometry, L, a, b");
  EXPECT_EQ(lab("<lab geometry=\"45xx15\" L=\"64\" a=\"1\" b=\"3\"/>"),
            "p.xml:5: geometry \"45xx15\" is not understood: write it like 45as15, 45as-15, r45as15, 45as25az90 or 15");
  EXPECT_EQ(lab("<lab geometry=\"45as15\" L=\"1\" a=\"1\" b=\"3\"/>\n<lab geometry=\"15\" L=\"1\" a=\"1\" b=\"3\"/>"),
            "p.xml:6: geometry 45as15 is given twice: keep one, or give the mean");
  EXPECT_EQ(lab(""), "p.xml:6: <measurement> of paint \"p\" has no <lab>: add it");
  EXPECT_EQ(paint("<gloss angle=\"60\">shiny</gloss>"), "p.xml:4: gloss is \"shiny\": write a number such as 12.5");
  EXPECT_EQ(paint("<gloss angle=\"60\">-1</gloss>"), "p.xml:4: gloss is -1: write 0 or more");
  EXPECT_EQ(paint("<gloss angle=\"45\">1</gloss>"),
            "p.xml:4: angle is \"45\": a gloss meter reads at 20, 60 or 85 (degrees)");
  EXPECT_EQ(paint("<appearance travel=\"12\"><face L=\"1\" a=\"1\" b=\"1\"/></appearance>"),
            "p.xml:4: travel is 12: give an angle above 15 and up to 180 deg");
  EXPECT_EQ(paint("<appearance travel=\"50\">\n<face L=\"1\" a=\"1\" b=\"1\"/></appearance>"),
            "p.xml:5: <appearance> of paint \"p\" has no <flop>: add it");
  EXPECT_EQ(paint("<measurement illuminant=\"D65\" observer=\"4\"></measurement>"),
            "p.xml:4: observer is \"4\": write 2 or 10 (degrees)");
  EXPECT_EQ(paint("<colour/>"),
            "p.xml:4: <colour> is not known inside <paint>: it holds <measurement>, <gloss>, <appearance>, "
            "<anisotropy>, <colorMap>, <coat>, <flakes>, <lobes>");
  EXPECT_EQ(paint("<anisotropy alphaX=\"0\" alphaY=\"1\"/>"), "p.xml:4: alphaX is 0: write a number above 0");
  EXPECT_EQ(paint("<colorMap href=\"x.exr\" index=\"0.9\"/>"), "p.xml:4: index is 0.9: write 1 or more");
  for (const char* index : {"1.2", "1.8", "1.4999"})
    EXPECT_EQ(paint(std::string("<coat index=\"") + index + "\"/>"),
              std::string("p.xml:4: index is \"") + index + "\": a coat has 1.5 to 1.7, and 1 says that there is none");
  EXPECT_EQ(paint("<coat index=\"1.5\"/><coat index=\"1.5\"/>"), "p.xml:4: a second <coat> in paint \"p\": keep one");
  EXPECT_EQ(paint("<flakes diameter_um=\"30\" coverage=\"1.5\" spread_deg=\"0.5\"/>"),
            "p.xml:4: coverage is \"1.5\": it is a part of the surface: write up to 1");
  EXPECT_EQ(paint("<flakes diameter_um=\"3000\" coverage=\"1\" spread_deg=\"0.5\"/>"),
            "p.xml:4: diameter_um is \"3000\": flakes have up to 1000 micrometers");
  EXPECT_EQ(paint("<flakes diameter_um=\"30\" coverage=\"1\" spread_deg=\"31\"/>"),
            "p.xml:4: spread_deg is \"31\": one flake spreads light by up to 30 deg");
  EXPECT_EQ(paint("<flakes diameter_um=\"0\" coverage=\"1\" spread_deg=\"0\"/>"),
            "p.xml:4: diameter_um is 0: write a number above 0");
  EXPECT_EQ(paint("some words"), "p.xml:4: text \"some words\" stands between elements: remove it");
  EXPECT_EQ(paint("<anisotropy alphaX=\"1\" alphaY=\"1\"/><anisotropy alphaX=\"1\" alphaY=\"1\"/>"),
            "p.xml:4: a second <anisotropy> in paint \"p\": keep one");
  EXPECT_EQ(paint("<note xmlns=\"\"/>"), "p.xml:4: <note> has no namespace: declare one with xmlns=\"...\"");
  EXPECT_EQ(paint("<lobes space=\"lin_rec709\" basis=\"b\" method=\"l1\" max_de00=\"1\" mean_de00=\"1\"/>"),
            "p.xml:4: space is \"lin_rec709\": weights must be in lin_rec2020_scene: fit the paint again");
  const auto lobes = [&](const std::string& views) {
    return paint(
        "<lobes space=\"lin_rec2020_scene\" basis=\"b\" method=\"l1\" max_de00=\"1\" mean_de00=\"1\">"
        "<diffuse r=\"1\" g=\"1\" b=\"1\"/>" +
        views + "</lobes>");
  };
  const std::string diffuse = "<diffuse r=\"1\" g=\"1\" b=\"1\"/></view>";
  EXPECT_EQ(lobes("<view angle=\"91\">" + diffuse), "p.xml:4: angle is \"91\": give degrees from the normal, 0 to 90");
  EXPECT_EQ(lobes("<view angle=\"15\">" + diffuse + "<view angle=\"15\">" + diffuse),
            "p.xml:4: angle is \"15\": views stand in the order of their angles, each once");
  EXPECT_EQ(lobes("<view angle=\"15\"/>"), "p.xml:4: <view> of paint \"p\" has no <diffuse>: add it");
  EXPECT_EQ(only_error(document("<paint name=\"\"/>\n")), "p.xml:3: name is empty: write something");
  EXPECT_EQ(only_error(document("<paint/>\n")), "p.xml:3: <paint> has no name: write name=\"...\"");
  EXPECT_EQ(only_error(document("<paint name=\"p\" class=\"shiny\"/>\n")),
            "p.xml:3: class is \"shiny\": write solid, metallic, pearl, interference or unknown");
}

TEST(PaintXml, MessagesStayOnOneLine) {
  const std::string error =
      only_error(document("<paint name=\"p\">\none\ntwo " + std::string(100, 'x') + "</paint>\n"));
  EXPECT_EQ(error, "p.xml:5: text \"one two " + std::string(52, 'x') + "...\" stands between elements: remove it");
}

TEST(PaintXml, OtherDocumentsAreRefusedByName) {
  EXPECT_THAT(only_error("<CxF xmlns=\"urn:x\"/>"), HasSubstr("p.xml:1: this begins with <CxF>, not with paints"));
  EXPECT_THAT(only_error("<paints xmlns=\"urn:goniochrome:paint:2\" version=\"1\"/>"),
              HasSubstr("p.xml:1: this <paints> is of the namespace \"urn:goniochrome:paint:2\": the first element"));
  EXPECT_THAT(only_error("<paints version=\"1\"/>"), HasSubstr("xmlns=\"urn:goniochrome:paint:1\""));
  EXPECT_EQ(only_error("<paints xmlns=\"urn:goniochrome:paint:1\" version=\"2\"/>"),
            "p.xml:1: version is \"2\": this program reads version 1: convert the file with the program that wrote it");
  EXPECT_EQ(only_error(""), "p.xml: is empty: give it a document");
  EXPECT_EQ(only_error("sample,geometry\n"),
            "p.xml:1: this is not XML: it must begin with < and an element (paint-convert makes XML of paint tables)");
  EXPECT_EQ(only_error(document("") + kHead),
            "p.xml:4: there is more after the end of the document: give several documents as several files");
  EXPECT_THAT(only_error(document("<paint name=\"p\"></pain></paint>")), HasSubstr("p.xml:3: the closing tag"));
  EXPECT_THAT(only_error(document("<paint name=\"a & b\"/>")), HasSubstr("write &amp; or &lt;"));
  EXPECT_THAT(only_error(document("<x:note/>")), HasSubstr("p.xml:3: a prefix has no namespace"));
  EXPECT_EQ(only_error(document("<paint name=\"p\"/><x:n xmlns:x=\"urn:x\"/>")),
            "p.xml:3: <n> stands behind a paint: move it in front of the first paint, or into one");
  EXPECT_FALSE(PaintReader::open("/no/such/file.xml").ok());
}

using XmlDocument = std::unique_ptr<xmlDoc, decltype(&xmlFreeDoc)>;

// The published schema, as an independent judge of documents.
class PublishedSchema {
 public:
  bool accepts(xmlDocPtr document) {
    const std::unique_ptr<xmlSchemaValidCtxt, decltype(&xmlSchemaFreeValidCtxt)> judge(
        xmlSchemaNewValidCtxt(schema_.get()), xmlSchemaFreeValidCtxt);
    xmlSchemaSetValidErrors(judge.get(), silent, silent, nullptr);
    return xmlSchemaValidateDoc(judge.get(), document) == 0;
  }

 private:
  static void silent(void*, const char*, ...) {}
  static xmlSchemaPtr parsed() {
    const std::string path = testdata("../lib/formats/paint.xsd");
    const std::unique_ptr<xmlSchemaParserCtxt, decltype(&xmlSchemaFreeParserCtxt)> parser(
        xmlSchemaNewParserCtxt(path.c_str()), xmlSchemaFreeParserCtxt);
    return xmlSchemaParse(parser.get());
  }
  std::unique_ptr<xmlSchema, decltype(&xmlSchemaFree)> schema_{parsed(), xmlSchemaFree};
};

std::string text_of(xmlDocPtr document) {
  xmlChar* bytes = nullptr;
  int size = 0;
  xmlDocDumpMemory(document, &bytes, &size);
  std::string text(reinterpret_cast<const char*>(bytes), static_cast<std::size_t>(size));
  xmlFree(bytes);
  return text;
}

void list_elements(xmlNodePtr node, std::vector<xmlNodePtr>& elements) {
  for (; node; node = node->next)
    if (node->type == XML_ELEMENT_NODE) elements.push_back(node), list_elements(node->children, elements);
}

const xmlChar* xml(const char* text) {
  return reinterpret_cast<const xmlChar*>(text);
}

TEST(PaintXml, TheSchemaAcceptsWhatTheWriterWrites) {
  const ScratchFolder folder;
  ASSERT_TRUE(write_all(folder.path("p.xml"), {full_paint()}, {{"fit-paint", "1", "x"}}).ok());
  EXPECT_THAT(reading_of(folder.path("p.xml")).errors, ElementsAre());
  const XmlDocument written(xmlReadFile(folder.path("p.xml").c_str(), nullptr, 0), xmlFreeDoc);
  EXPECT_TRUE(PublishedSchema().accepts(written.get()));
}

// Every element of a whole document is left out, doubled and moved behind its neighbor, and every attribute is left
// out, renamed and given other values. The reader has rules of its own, and refuses whatever the schema refuses.
TEST(PaintXml, WhatTheSchemaRefusesIsRefused) {
  const std::string lobe = "exponent=\"2\" ddr=\"1\" ddg=\"1\" ddb=\"1\" gr=\"1\" gg=\"1\" gb=\"1\"/>";
  const std::string whole = document(
      "<processing tool=\"t\" version=\"1\" command=\"c\"/><paint name=\"p\" class=\"pearl\" code=\"c\">"
      "<measurement illuminant=\"D65\" observer=\"10\" instrument=\"i\" serial=\"s\" date=\"2020-01-01\">"
      "<lab geometry=\"45as15\" L=\"50\" a=\"0\" b=\"0\"/><lab geometry=\"45as45\" L=\"40\" a=\"0\" b=\"0\"/>"
      "<spectrum geometry=\"45as15\" from=\"400\" to=\"700\" step=\"100\">1 .5 1e-3 2</spectrum>"
      "<texture quantity=\"q\" geometry=\"g\" version=\"v\" value=\"1\"/></measurement><gloss angle=\"60\">90</gloss>"
      "<appearance travel=\"60\" residual_de00=\"1\"><face L=\"50\" a=\"0\" b=\"0\"/><flop L=\"20\" a=\"0\" b=\"0\"/>"
      "</appearance><anisotropy alphaX=\".1\" alphaY=\".2\"/><colorMap href=\"h\" index=\"1.5\"/><coat index=\"1.5\"/>"
      "<flakes diameter_um=\"30\" coverage=\"0.5\" spread_deg=\"0.5\"/>"
      "<lobes space=\"lin_rec2020_scene\" basis=\"b\" method=\"m\" max_de00=\"1\" mean_de00=\"1\">"
      "<diffuse r=\"1\" g=\"1\" b=\"1\"/><lobe " +
      lobe + "<view angle=\"45\"><diffuse r=\"1\" g=\"1\" b=\"1\"/><lobe " + lobe +
      "</view></lobes><n xmlns=\"urn:n\"/></paint>");
  PublishedSchema schema;
  ASSERT_THAT(reading_of_text(whole).errors, ElementsAre());
  std::size_t refused = 0, accepted = 0;
  // Edits element number `at` of a fresh document; false where there is none.
  const auto change = [&](std::size_t at, const std::function<bool(xmlNodePtr)>& edit) {
    const XmlDocument changed(xmlReadMemory(whole.data(), static_cast<int>(whole.size()), "p", nullptr, 0), xmlFreeDoc);
    std::vector<xmlNodePtr> elements;
    list_elements(changed->children, elements);
    if (at >= elements.size()) return false;
    if (!edit(elements[at])) return true;
    const bool is_valid = schema.accepts(changed.get());
    ++(is_valid ? accepted : refused);
    EXPECT_TRUE(is_valid || !reading_of_text(text_of(changed.get())).errors.empty()) << text_of(changed.get());
    return true;
  };
  for (std::size_t at = 1;; ++at) {
    if (!change(at, [](xmlNodePtr node) { return xmlUnlinkNode(node), xmlFreeNode(node), true; })) break;
    change(at, [](xmlNodePtr node) { return xmlAddNextSibling(node, xmlCopyNode(node, 1)) != nullptr; });
    change(at, [](xmlNodePtr node) { return node->next && xmlAddNextSibling(node->next, node); });
    change(at, [](xmlNodePtr node) { return xmlNewChild(node, nullptr, xml("stranger"), nullptr) != nullptr; });
    change(at, [](xmlNodePtr node) { return xmlNodeAddContent(node, xml(" word")), true; });
    change(at, [](xmlNodePtr node) { return xmlSetProp(node, xml("stranger"), xml("1")) != nullptr; });
    constexpr int kMostAttributes = 8;
    for (int k = 0; k < kMostAttributes; ++k) {
      const auto attribute = [k](xmlNodePtr node) {
        xmlAttrPtr found = node->properties;
        for (int i = 0; i < k && found; ++i) found = found->next;
        return found;
      };
      change(at, [&](xmlNodePtr node) { return attribute(node) && xmlRemoveProp(attribute(node)) == 0; });
      for (const char* value : {"", "x", "-1", "0", "1e400", "NaN", "INF", "1,5", "91", "15", "181", "3"})
        change(at,
               [&](xmlNodePtr node) { return attribute(node) && xmlSetProp(node, attribute(node)->name, xml(value)); });
    }
  }
  EXPECT_GT(refused, 400U);
  EXPECT_GT(accepted, 400U);
}

TEST(PaintXml, WriterRefusesWhatXmlCannotHold) {
  const ScratchFolder folder;
  paint::Paint paint = full_paint();
  paint.name = "bell\a";
  EXPECT_EQ(write_all(folder.path("p.xml"), {paint}).error().message,
            "paint \"bell?\" holds a text that is not valid UTF-8 or has a control character: \"bell?\"");
  paint.name = "latin-1 \xe9";
  EXPECT_FALSE(write_all(folder.path("p.xml"), {paint}).ok());
  EXPECT_FALSE(std::filesystem::exists(folder.path("p.xml")));
}

const std::string kRow = "<lab geometry=\"45as15\" L=\"50\" a=\"0\" b=\"0\"/>\n";

TEST(PaintXml, TexturesAreReadAndWrittenAgain) {
  const Reading reading = reading_of_text(document(
      measured("p", kRow + "<texture quantity=\"Sparkle Grade\" geometry=\"15as45\" version=\"v2\" value=\"3.25\"/>\n"
                           "<texture quantity=\"Graininess\" geometry=\"diffuse\" value=\"-0.5\"/>\n")));
  ASSERT_THAT(reading.errors, ElementsAre());
  const ScratchFolder folder;
  ASSERT_TRUE(write_all(folder.path("out.xml"), reading.paints).ok());
  const Reading again = reading_of(folder.path("out.xml"));
  ASSERT_THAT(again.errors, ElementsAre());
  for (const Reading& read : {std::cref(reading), std::cref(again)}) {
    const std::vector<paint::TextureReading>& textures = read.paints.at(0).measurement->textures;
    ASSERT_EQ(textures.size(), 2U);
    EXPECT_EQ(textures[0].quantity, "Sparkle Grade");
    EXPECT_EQ(textures[0].version, "v2");
    EXPECT_EQ(textures[1].geometry, "diffuse");
    EXPECT_EQ(textures[1].version, "");
    EXPECT_EQ(textures[1].value, -0.5);
  }
  const std::string twice = "<texture quantity=\"S\" geometry=\"15d\" value=\"1\"/>\n";
  EXPECT_THAT(only_error(document(measured("p", kRow + twice + twice))), HasSubstr("a second \"S\" at 15d"));
}

TEST(PaintXml, SpectraAreReadAndWrittenAgain) {
  const Reading reading = reading_of_text(document(measured(
      "p", kRow + "<spectrum geometry=\"45as15\" from=\"400\" to=\"420\" step=\"10\">\n 0.1 0.25\n1.5 </spectrum>\n"
                  "<spectrum geometry=\"45as25az90\" from=\"380\" to=\"385\" step=\"2.5\">0 -0.01 1e-3</spectrum>\n")));
  ASSERT_THAT(reading.errors, ElementsAre());
  const paint::Measurement& measurement = *reading.paints.at(0).measurement;
  ASSERT_EQ(measurement.spectra.size(), 2U);
  EXPECT_THAT(measurement.spectra[0].factors, ElementsAre(0.1, 0.25, 1.5));
  EXPECT_EQ(measurement.spectra[0].to_nm(), 420);
  EXPECT_EQ(measurement.spectra[1].step_nm, 2.5);
  const ScratchFolder folder;
  ASSERT_TRUE(write_all(folder.path("out.xml"), reading.paints).ok());
  const Reading again = reading_of(folder.path("out.xml"));
  ASSERT_THAT(again.errors, ElementsAre());
  for (std::size_t i = 0; i < 2; ++i) {
    const paint::SpectrumReading &a = measurement.spectra[i], &b = again.paints.at(0).measurement->spectra.at(i);
    EXPECT_EQ(a.factors, b.factors);
    EXPECT_EQ(a.geometry, b.geometry);
    EXPECT_EQ(a.from_nm, b.from_nm);
  }
}

TEST(PaintXml, WrongSpectraAreToldWhereTheyStand) {
  const auto told = [&](const std::string& spectrum) { return only_error(document(measured("p", kRow + spectrum))); };
  const std::string range = " from=\"400\" to=\"420\" step=\"10\">", good = "<spectrum geometry=\"45as15\"" + range;
  EXPECT_EQ(told(good + "1 2</spectrum>"), "p.xml:6: the spectrum at 45as15 has 2 values, and its wavelengths make 3");
  EXPECT_EQ(told(good + "1 0,5 2</spectrum>"),
            "p.xml:6: value 2 of the spectrum at 45as15 is \"0,5\": write a decimal point");
  EXPECT_EQ(told(good + "1 nan 2</spectrum>"),
            "p.xml:6: value 2 of the spectrum at 45as15 is \"nan\": write a finite number");
  EXPECT_EQ(told(good + "1 2 3</spectrum>" + good + "1 2 3</spectrum>"),
            "p.xml:6: a second spectrum at 45as15: keep one");
  EXPECT_EQ(told("<spectrum geometry=\"45as15\" from=\"420\" to=\"400\" step=\"10\">1</spectrum>"),
            "p.xml:6: to is \"400\": it must be above `from` (nanometers)");
  EXPECT_THAT(told("<spectrum geometry=\"45as15\" from=\"400\" to=\"425\" step=\"10\">1 2 3</spectrum>"),
              HasSubstr("must be whole steps"));
  EXPECT_THAT(told("<spectrum geometry=\"45as15\" from=\"400\" to=\"4e9\" step=\"1\">1</spectrum>"),
              HasSubstr("at most 2000 of them"));
  EXPECT_THAT(told("<spectrum geometry=\"15nonsense\"" + range + "1 2 3</spectrum>"), HasSubstr("15nonsense"));
}

}  // namespace
}  // namespace goniochrome::formats::xml_test
