#include "studio/studio.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <optional>

#include "base/file.h"
#include "base/scratch_for_test.h"
#include "base/testdata_for_test.h"
#include "color/print_gamut.h"
#include "fit/paint_fit.h"
#include "formats/cxf.h"
#include "formats/paint_source.h"
#include "library/index.h"
#include "paint/curve.h"
#include "paint/edit.h"
#include "render/scene_effects.h"
#include "studio/paint_json.h"

namespace goniochrome::studio::studio_test {
namespace {

using ::testing::HasSubstr;

const std::vector<double> kExponents = {1.3, 6, 20, 70};

paint::Paint metallic() {
  paint::Paint paint;
  paint.name = "blue <b>";
  paint.code = "B1";
  paint.paint_class = paint::PaintClass::kMetallic;
  paint.gloss = {{60, 88.5}};
  paint::Measurement& measurement = paint.measurement.emplace();
  for (const double angle : {15.0, 25.0, 45.0, 75.0, 110.0}) {
    const double from_travel = std::max(0.0, (80 - angle) / 65), share = from_travel * from_travel;
    measurement.rows.push_back({{.aspecular_deg = angle}, {30 + 40 * share, -3.1 + 2 * share, -20.7 - 10 * share}});
  }
  return paint;
}

Studio loaded() {
  Studio studio;
  paint::Paint other = metallic();
  other.name = "other";
  for (paint::LabReading& row : other.measurement->rows) row.lab.L += 20;
  const Json answer = studio.answer({{"do", "load"},
                                     {"basis", {{"name", "b4"}, {"exponents", kExponents}, {"mirror", true}}},
                                     {"paints", {paint_json(other), paint_json(metallic())}}});
  EXPECT_EQ(answer.value("paints", 0), 2);
  EXPECT_EQ(answer.at("geometries").size(), 5U);
  return studio;
}

TEST(PaintJson, KeepsEveryBit) {
  paint::Paint paint = metallic();
  paint.appearance = paint::Appearance{{0.1, -1.0 / 3, 2e-17}, {1e5, 0, -0.0}, 61.7, 0.123456789012345678};
  paint.anisotropy = paint::Anisotropy{0.05, 0.3};
  paint.color_map = paint::ColorMapReference{"x.exr", 1.6};
  paint.coat_index = 1.55;
  paint.flakes = paint::Flakes{40, 0.2, 0.3};
  paint.measurement->condition = {"A", 2};
  paint.measurement->spectra.push_back({{.aspecular_deg = 15}, 400, 10, {0.1, 0.2, 1.0 / 7}});
  paint.measurement->textures = {{"Sparkle Grade", "15d", "2", 3.25}};
  paint.foreign = {"<x xmlns=\"urn:y\"/>"};
  const auto back = paint_of_json(Json::parse(json_text(paint_json(paint))));
  ASSERT_TRUE(back.ok()) << back.error().message;
  EXPECT_EQ(paint_json(*back), paint_json(paint));
  EXPECT_EQ(back->appearance->face, paint.appearance->face);
  EXPECT_EQ(back->measurement->spectra[0].factors, paint.measurement->spectra[0].factors);
  ASSERT_EQ(back->measurement->textures.size(), 1U);
  EXPECT_EQ(back->measurement->textures[0].value, 3.25);
  EXPECT_EQ(back->measurement->condition, paint.measurement->condition);
}

TEST(PaintJson, RefusesWhatIsNoPaint) {
  for (const char* text : {R"({})", R"([])", R"({"name": 5})", R"({"name": "x", "gloss": [[60]]})",
                           R"({"name": "x", "appearance": {"face": [1, 2], "flop": [1, 2, 3], "travel": 60}})",
                           R"({"name": "x", "measurement": {"rows": [{"geometry": "45as", "lab": [1, 2, 3]}]}})"})
    EXPECT_FALSE(paint_of_json(Json::parse(text)).ok()) << text;
}

TEST(Studio, EditsAsTheLibraryDoes) {
  Studio studio = loaded();
  const Json answer = studio.answer({{"do", "edit"},
                                     {"paint", paint_json(metallic())},
                                     {"edit",
                                      {{"hue-shift", 12.5},
                                       {"face-shift", {1, 2, 3}},
                                       {"travel-shift", 5},
                                       {"gloss", 60},
                                       {"set", {{{"geometry", "45as45"}, {"lab", {50, 1, 2}}}}}}}});
  paint::Edit edit;
  edit.tweak.hue_deg = 12.5;
  edit.face_shift = {1, 2, 3};
  edit.travel_shift_deg = 5;
  edit.gloss = 60;
  edit.readings = {{{.aspecular_deg = 45}, {50, 1, 2}}};
  const auto edited = paint::edited(metallic(), edit);
  ASSERT_TRUE(edited.ok());
  EXPECT_EQ(answer.at("paint"), paint_json(edited->paint));
}

TEST(Studio, BrushesAPaintAndTellsItsTilts) {
  Studio studio = loaded();
  const Json edit = {{"anisotropy", {0.05, 0.3}}};
  const Json brushed = studio.answer({{"do", "edit"}, {"paint", paint_json(metallic())}, {"edit", edit}}).at("paint");
  EXPECT_EQ(brushed.at("anisotropy"), Json::array({0.05, 0.3}));
  EXPECT_EQ(studio.answer({{"do", "describe"}, {"paint", brushed}}).at("anisotropy"), Json::array({0.05, 0.3}));
  ASSERT_FALSE(studio.answer({{"do", "fit"}, {"paint", brushed}}).contains("error"));
  const std::span<const std::byte> bytes = studio.list(Studio::List::kTilts);
  std::vector<float> tilts(bytes.size() / sizeof(float));
  std::memcpy(tilts.data(), bytes.data(), bytes.size());
  ASSERT_GT(tilts.size(), 4U);
  // The shares add up to 1, and the normals spread along Y more than along X, as the widths do.
  double sum = 0, along_x = 0, along_y = 0;
  for (std::size_t i = 0; i < tilts.size(); i += 4) {
    sum += tilts[i + 3];
    along_x += tilts[i + 3] * tilts[i] * tilts[i];
    along_y += tilts[i + 3] * tilts[i + 1] * tilts[i + 1];
  }
  EXPECT_NEAR(sum, 1, 1e-5);
  EXPECT_GT(along_y, 4 * along_x);
  ASSERT_FALSE(studio.answer({{"do", "fit"}, {"paint", paint_json(metallic())}}).contains("error"));
  EXPECT_TRUE(studio.list(Studio::List::kTilts).empty());
}

TEST(Studio, StatesFlakesOrAssumesThoseOfTheClass) {
  Studio studio = loaded();
  const auto described = [&](const Json& paint) { return studio.answer({{"do", "describe"}, {"paint", paint}}); };
  const Json assumed = {{"values", {30, 0.5, 0.5}}, {"assumed", true}};
  EXPECT_EQ(described(paint_json(metallic())).at("flakes"), assumed);
  const auto edited = [&](const Json& paint, const Json& flakes) {
    return studio.answer({{"do", "edit"}, {"paint", paint}, {"edit", {{"flakes", flakes}}}}).at("paint");
  };
  const Json stated = edited(paint_json(metallic()), {40, 0.2, 0.7});
  EXPECT_EQ(described(stated).at("flakes"), (Json{{"values", {40, 0.2, 0.7}}, {"assumed", false}}));
  EXPECT_EQ(edited(stated, {0, 0, 0.5}), paint_json(metallic()));
  paint::Paint solid = metallic();
  solid.paint_class = paint::PaintClass::kSolid;
  EXPECT_FALSE(described(paint_json(solid)).contains("flakes"));
}

TEST(Studio, RefusesEditsThatPaintEditRefuses) {
  Studio studio = loaded();
  for (const char* text :
       {R"({"hew": 5})", R"({"travel": 15})", R"({"gloss": 101})", R"({"face": [1, 2]})", R"({"face": [-1, 2, 3]})",
        R"({"hue": "5"})", R"({"set": [{"geometry": "x", "lab": [1, 2, 3]}]})", R"({"anisotropy": [0.1]})",
        R"({"anisotropy": [0.1, 0]})", R"({"anisotropy": [0.1, 11]})", R"({"flakes": [30, 0.5]})",
        R"({"flakes": [30, 0, 0.5]})", R"({"flakes": [30, 1.1, 0.5]})", R"({"flakes": [30, 0.5, 31]})"})
    EXPECT_TRUE(studio.answer({{"do", "edit"}, {"paint", paint_json(metallic())}, {"edit", Json::parse(text)}})
                    .contains("error"))
        << text;
}

TEST(Studio, FitsAsTheLibraryDoesAndFillsTheWeights) {
  Studio studio = loaded();
  const Json answer = studio.answer({{"do", "fit"}, {"paint", paint_json(metallic())}});
  ASSERT_FALSE(answer.contains("error")) << answer;
  const fit::PaintFitter fitter({"b4", kExponents, true}, {});
  const auto fit = fitter.fit(metallic());
  ASSERT_TRUE(fit.ok());
  EXPECT_EQ(answer.at("diffuse")[0], fit->lobes.diffuse.x);
  ASSERT_EQ(answer.at("lobes").size(), fit->lobes.lobes.size());
  for (std::size_t i = 0; i < fit->lobes.lobes.size(); ++i) {
    EXPECT_EQ(answer.at("lobes")[i].at("flake")[2], fit->lobes.lobes[i].directional_diffuse.z);
    EXPECT_EQ(answer.at("lobes")[i].at("gloss")[0], fit->lobes.lobes[i].gloss.x);
  }
  render::Scene scene;
  scene.paints = {fit->lobes};
  scene.gloss_deg = {60};
  scene.reflection = page_operator();
  EXPECT_EQ(studio.weights(), render::weight_table(scene, page_effects(kExponents, true, 3)).rgba);
  // White light shows the color of the weights: the operator's forms of white, brought back, are what the table has.
  EXPECT_EQ(studio.weights().size(), render::weight_table(scene, page_effects(kExponents, true, 3)).rgba.size());
}

TEST(Studio, FindsTheNearestPaintsInOrder) {
  Studio studio = loaded();
  const Json list = studio.answer({{"do", "nearest"}, {"paint", paint_json(metallic())}, {"count", 5}}).at("list");
  ASSERT_EQ(list.size(), 2U);
  EXPECT_EQ(list[0].at("name"), "blue <b>");
  EXPECT_EQ(list[0].at("distance"), 0.0);
  EXPECT_EQ(list[1].at("place"), 0);
  // Five readings that are 20 lighter each; a sum of five differences of doubles near 50, each to an ulp.
  EXPECT_NEAR(list[1].at("distance").get<double>(), 100, 1e-12);
}

TEST(Studio, VariationsAreEditsThatMakeTheirPaints) {
  Studio studio = loaded();
  for (const char* of : {"face", "flop", "travel", "gloss"}) {
    const Json list =
        studio.answer({{"do", "variations"}, {"paint", paint_json(metallic())}, {"of", of}, {"step", 2}}).at("list");
    EXPECT_EQ(list.size(), 8U) << of;
    for (const Json& one : list)
      EXPECT_EQ(
          studio.answer({{"do", "edit"}, {"paint", paint_json(metallic())}, {"edit", one.at("edit")}}).at("paint"),
          one.at("paint"))
          << one.at("name");
  }
}

TEST(Studio, WritesWhatTheReadersRead) {
  Studio studio = loaded();
  const ScratchFolder scratch;
  const std::string path = scratch.path("x.paints.xml");
  EXPECT_EQ(studio.answer({{"do", "write"},
                           {"paint", paint_json(metallic())},
                           {"as", "xml"},
                           {"file", path},
                           {"lobes", true},
                           {"command", "a \"step\""}}),
            Json::object());
  const auto paints = formats::read_paints(path);
  ASSERT_TRUE(paints.ok()) << paints.error().message;
  ASSERT_EQ(paints->size(), 1U);
  EXPECT_TRUE((*paints)[0].lobes.has_value());
  EXPECT_EQ((*paints)[0].name, "blue <b>");
  EXPECT_EQ((*paints)[0].measurement->rows[2].lab, metallic().measurement->rows[2].lab);
  const std::string table = scratch.path("x.csv");
  EXPECT_EQ(studio.answer({{"do", "write"}, {"paint", paint_json(metallic())}, {"as", "csv"}, {"file", table}}),
            Json::object());
  EXPECT_THAT(*file_content(table), HasSubstr("blue <b>,45as15,D65,10,70,"));
}

TEST(Studio, WritesCxfThatTheReaderReads) {
  Studio studio = loaded();
  const ScratchFolder scratch;
  const std::string path = scratch.path("x.cxf");
  paint::Paint designed;
  designed.name = "designed";
  designed.code = "N1";
  designed.appearance = paint::Appearance{{60, 10, -20}, {20, 3, -30}, 70, std::nullopt};
  EXPECT_EQ(studio.answer({{"do", "write"},
                           {"paint", paint_json(designed)},
                           {"as", "cxf"},
                           {"file", path},
                           {"created", "2026-11-21T10:00:00Z"}}),
            Json::object());
  auto input = InputFile::open(path);
  ASSERT_TRUE(input.ok());
  const auto read = formats::read_cxf(std::move(*input), {});
  ASSERT_TRUE(read.ok()) << read.error().message;
  ASSERT_EQ(read->paints.size(), 1U);
  EXPECT_EQ(read->paints[0].code, "N1");
  const std::vector<paint::LabReading> rows = paint::rows_of(*designed.appearance);
  ASSERT_EQ(read->paints[0].measurement->rows.size(), rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ(read->paints[0].measurement->rows[i].geometry, rows[i].geometry);
    EXPECT_EQ(read->paints[0].measurement->rows[i].lab, rows[i].lab);
  }
}

// The library of loaded() has L* 20 higher than the paint that is asked for.
TEST(Studio, FiltersAndListsTheLibrary) {
  Studio studio = loaded();
  const auto places = [&](const Json& request) {
    Json whole = request;
    whole["do"] = "filter";
    const Json answer = studio.answer(whole);
    EXPECT_FALSE(answer.contains("error")) << answer;
    const auto bytes = studio.list(Studio::List::kFiltered);
    std::vector<std::uint32_t> list(bytes.size() / sizeof(std::uint32_t));
    std::memcpy(list.data(), bytes.data(), bytes.size());
    EXPECT_EQ(answer.value("count", std::size_t{99}), list.size());
    return list;
  };
  using Places = std::vector<std::uint32_t>;
  EXPECT_EQ(places(Json::object()), (Places{0, 1}));
  EXPECT_EQ(places({{"text", "OTH"}}), Places{0});
  EXPECT_EQ(places({{"text", "b1"}}), (Places{0, 1})) << "both have the code B1";
  EXPECT_EQ(places({{"classes", {"pearl"}}}), Places{});
  EXPECT_EQ(places({{"ranges", {{{"metric", "L15"}, {"low", 80}}}}}), Places{0});
  EXPECT_EQ(places({{"order", "L15"}}), (Places{1, 0}));
  EXPECT_TRUE(studio.answer({{"do", "filter"}, {"order", "L16"}}).contains("error"));
  const Json rows = studio.answer({{"do", "rows"}, {"places", {1}}}).at("list");
  EXPECT_EQ(rows[0].at("name"), "blue <b>");
  EXPECT_EQ(rows[0].at("colors").size(), 5U);
  EXPECT_TRUE(studio.answer({{"do", "rows"}, {"places", {2}}}).contains("error"));
}

TEST(Studio, TheCloudHoldsEveryPaintAtAnAngle) {
  Studio studio = loaded();
  EXPECT_EQ(studio.answer({{"do", "cloud"}, {"geometry", "45as25"}}).at("count"), 2);
  std::vector<float> points(6);
  const auto bytes = studio.list(Studio::List::kCloud);
  ASSERT_EQ(bytes.size(), points.size() * sizeof(float));
  std::memcpy(points.data(), bytes.data(), bytes.size());
  const auto L = static_cast<float>(metallic().measurement->rows[1].lab.L);
  EXPECT_EQ(std::minmax(points[0], points[3]), std::minmax(L, L + 20.0F));
  EXPECT_EQ(studio.answer({{"do", "cloud"}, {"geometry", "25as25"}}).at("count"), 0);
}

// An index that was packed elsewhere answers as one that is made of the paints.
TEST(Studio, TakesAnIndexInThePlaceOfPaints) {
  std::vector<paint::Paint> paints = {metallic(), metallic()};
  paints[1].name = "second";
  auto next = paints.begin();
  const auto index = library::LibraryIndex::from_paints([&]() -> Result<std::optional<paint::Paint>> {
    return next == paints.end() ? std::optional<paint::Paint>() : std::optional(*next++);
  });
  ASSERT_TRUE(index.ok());
  Studio studio;
  studio.attached() = std::string(index->content());
  const Json answer = studio.answer(
      {{"do", "load"}, {"basis", {{"name", "b4"}, {"exponents", kExponents}, {"mirror", true}}}, {"attached", true}});
  EXPECT_EQ(answer.value("paints", 0), 2) << answer;
  EXPECT_EQ(studio.answer({{"do", "nearest"}, {"paint", paint_json(metallic())}}).at("list").size(), 2U);
  Studio damaged;
  damaged.attached() = "no index";
  EXPECT_TRUE(damaged
                  .answer({{"do", "load"},
                           {"basis", {{"name", "b4"}, {"exponents", kExponents}, {"mirror", true}}},
                           {"attached", true}})
                  .contains("error"));
}

TEST(Studio, TellsTheColorAtAnAngleAndMovesIt) {
  Studio studio = loaded();
  paint::Paint designed;
  designed.name = "designed";
  designed.appearance = paint::Appearance{{60, 10, -20}, {20, 3, -30}, 70, std::nullopt};
  const auto at = [&](const Json& paint) {
    return studio.answer({{"do", "at"}, {"paint", paint}, {"angle", 40}}).at("lab");
  };
  const double share = (70.0 - 40) / (70 - 15);
  // The clamped quadratic of [Shimizu2009] 3.3.2 at 40 deg, to some ulp of its terms.
  EXPECT_NEAR(at(paint_json(designed))[0].get<double>(), 20 + 40 * share * share, 1e-12);
  const Json edited =
      studio.answer({{"do", "edit"}, {"paint", paint_json(designed)}, {"edit", {{"at", 40}, {"lightness-shift", 3}}}});
  EXPECT_NEAR(at(edited.at("paint"))[0].get<double>(), 23 + 40 * share * share, 1e-9);
  EXPECT_TRUE(studio.answer({{"do", "at"}, {"paint", paint_json(designed)}, {"angle", 181}}).contains("error"));
}

TEST(Studio, GradientsAreEvenStepsInLab) {
  Studio studio = loaded();
  paint::Paint other = metallic();
  other.name = "other";
  for (paint::LabReading& row : other.measurement->rows) row.lab.L += 20;
  const Json list =
      studio.answer({{"do", "gradient"}, {"from", paint_json(metallic())}, {"to", paint_json(other)}, {"count", 3}})
          .at("list");
  ASSERT_EQ(list.size(), 3U);
  EXPECT_EQ(list[1].at("name"), "blue <b>-other.2");
  EXPECT_NEAR(list[1].at("measurement").at("rows")[0].at("lab")[0].get<double>(),
              metallic().measurement->rows[0].lab.L + 10, 1e-12);
  EXPECT_TRUE(
      studio.answer({{"do", "gradient"}, {"from", paint_json(metallic())}, {"to", paint_json(other)}, {"count", 2.5}})
          .contains("error"));
}

TEST(Studio, DroppersReadSignals) {
  Studio studio = loaded();
  const Json found = studio.answer({{"do", "dropper"}, {"signals", {119, 119, 119, 119, 119, 119}}});
  EXPECT_NEAR(found.at("lab")[0].get<double>(), 50.03, 0.01);  // as in sketch/dropper_test.cpp
  EXPECT_EQ(found.at("gloss"), 0);
  EXPECT_EQ(found.at("css"), "#777777");
  for (const char* text : {R"({"do": "dropper", "signals": []})", R"({"do": "dropper", "signals": [1, 2]})",
                           R"({"do": "gloss", "edge": 5})", R"({"do": "gloss", "edge": 5, "extent": 4, "meter": 61})"})
    EXPECT_TRUE(studio.answer(Json::parse(text)).contains("error")) << text;
}

TEST(Studio, DescribesTheColorsOfAScreen) {
  Studio studio = loaded();
  // Pictures show a matt white so: the shoulder leaves .9 of the display's white, and more for what is brighter.
  EXPECT_EQ(studio.answer({{"do", "color"}, {"lab", {100, 0, 0}}}).at("css"), "#f3f3f3");
  EXPECT_EQ(studio.answer({{"do", "color"}, {"lab", {133, 0, 0}}}).at("css"), "#fcfcfc");
  EXPECT_EQ(studio.answer({{"do", "color"}, {"lab", {0, 0, 0}}}).at("css"), "#000000");
  // L* 53.585 is a reflectance factor of .2140, whose sRGB signal is .5 (IEC 61966-2-1).
  EXPECT_EQ(studio.answer({{"do", "color"}, {"lab", {53.585, 0, 0}}}).at("css"), "#808080");
  EXPECT_EQ(studio.answer({{"do", "color"}, {"lab", {53.585, 0, 0}}, {"screen", "display-p3"}}).at("css"),
            "color(display-p3 0.5020 0.5020 0.5020)");
  EXPECT_TRUE(studio.answer({{"do", "color"}, {"lab", {50, 0, 0}}, {"screen", "wide"}}).contains("error"));
  const Json described = studio.answer({{"do", "describe"}, {"paint", paint_json(metallic())}});
  EXPECT_EQ(described.at("rows").size(), 5U);
  EXPECT_EQ(described.at("rows")[1].at("angle"), 25.0);
  // The curve of a measured paint passes through its readings.
  const Json& curve = described.at("curve");
  const auto at_25 = std::ranges::find_if(curve, [](const Json& point) { return point.at("angle") == 25.0; });
  ASSERT_NE(at_25, curve.end());
  EXPECT_EQ(at_25->at("lab"), described.at("rows")[1].at("lab"));
}

TEST(Studio, DescribesTheLossesOfAPrint) {
  Studio studio;
  const std::vector<double> chroma(std::size_t{1} * color::PrintGamut::kLightnesses * color::PrintGamut::kHues, 12);
  const Json print = {{"name", "matt"}, {"darkest", 20}, {"lightest", 60}, {"chroma", chroma}};
  const auto load = [&](const Json& gamut) {
    return studio.answer({{"do", "load"},
                          {"basis", {{"name", "b4"}, {"exponents", kExponents}, {"mirror", true}}},
                          {"paints", {paint_json(metallic())}},
                          {"print", gamut}});
  };
  load(print);
  paint::Paint paint = metallic();
  paint.appearance = paint::Appearance{{70, 0, 30}, {40, 3, 4}, 60, {}};
  const Json told = studio.answer({{"do", "describe"}, {"paint", paint_json(paint)}}).at("print");
  EXPECT_EQ(told.at("face").at("nearest"), Json::array({60.0, 0.0, 12.0}));
  EXPECT_GT(told.at("face").at("de00"), 5);
  EXPECT_FALSE(told.at("face").contains("low"));
  EXPECT_EQ(told.at("flop").at("de00"), 0);
  EXPECT_EQ(told.at("flop").at("low"), 20);
  EXPECT_EQ(told.at("flop").at("high"), 60);
  EXPECT_NEAR(told.at("border").at(0).at("a").get<double>(), 12, 1e-9);
  load(Json());
  EXPECT_FALSE(studio.answer({{"do", "describe"}, {"paint", paint_json(paint)}}).contains("print"));
  EXPECT_TRUE(load({{"name", "matt"}, {"darkest", 20}, {"lightest", 60}, {"chroma", {1, 2}}}).contains("error"));
}

TEST(Studio, OpensFilesByTheReadersOfTheTools) {
  Studio studio;
  const auto open = [&](const std::string& name) { return studio.answer({{"do", "open"}, {"name", testdata(name)}}); };
  const Json paints = open("paints.csv");
  EXPECT_EQ(paints.at("kind"), "paints");
  const auto read = formats::read_paints(testdata("paints.csv"));
  ASSERT_TRUE(read.ok());
  ASSERT_EQ(paints.at("list").size(), read->size());
  for (std::size_t i = 0; i < read->size(); ++i) EXPECT_EQ(paints.at("list")[i], paint_json((*read)[i]));
  const Json box = open("box.obj");
  EXPECT_EQ(box.at("kind"), "mesh");
  EXPECT_EQ(box.at("mesh").at("parts").size(), 4U);
  // Corners are numbers of vertices.
  const auto numbers = studio.list(Studio::List::kNumbers);
  const Json& corners = box.at("mesh").at("corners");
  ASSERT_EQ(corners.at(1), 3 * box.at("triangles").get<std::size_t>());
  std::vector<std::uint32_t> vertices(corners.at(1).get<std::size_t>());
  std::memcpy(vertices.data(), numbers.data() + corners.at(0).get<std::size_t>(), vertices.size() * 4);
  EXPECT_EQ(3 * (*std::ranges::max_element(vertices) + 1), box.at("mesh").at("positions").at(1).get<std::size_t>());
  EXPECT_EQ(open("b5.basis.xml").at("basis").at("exponents").size(), 5U);
  EXPECT_EQ(open("studio.exr").at("kind"), "light");
  EXPECT_THAT(open("absent.csv").at("error").get<std::string>(), HasSubstr("absent.csv"));
}

TEST(Studio, FiltersLightForTheLobesOfABasis) {
  Studio studio;
  double part = 0;
  bool rises = true;
  studio.progress() = [&](double done) { rises = rises && done >= part, part = done; };
  const Json basis = {{"name", "b2"}, {"exponents", {1.3, 20}}, {"mirror", false}};
  const Json answer = studio.answer({{"do", "light"}, {"name", testdata("studio.exr")}, {"basis", basis}});
  EXPECT_EQ(answer.at("environment").at("name"), "studio");
  EXPECT_GE(answer.at("environment").at("cubes").size(), 3U);  // the diffuse one, and each lobe's
  EXPECT_TRUE(rises);
  EXPECT_NEAR(part, 1, 1e-9);
  EXPECT_TRUE(studio.answer({{"do", "light"}, {"name", testdata("studio.exr")}}).contains("error"));
}

TEST(Studio, AnswersNonsenseWithAnError) {
  Studio studio;
  for (const char* text : {R"({})", R"([])", R"({"do": "dance"})", R"({"do": "fit", "paint": {"name": "x"}})",
                           R"({"do": "nearest", "paint": {"name": "x"}})", R"({"do": "load"})"})
    EXPECT_TRUE(studio.answer(Json::parse(text)).contains("error")) << text;
  Studio ready = loaded();
  for (const char* text : {R"({"do": "fit", "paint": {"name": "x"}})", R"({"do": "describe", "paint": {"name": "x"}})",
                           R"({"do": "variations", "paint": {"name": "x"}, "of": "hue"})",
                           R"({"do": "write", "paint": {"name": "x"}, "as": "pdf"})"})
    EXPECT_TRUE(ready.answer(Json::parse(text)).contains("error")) << text;
}

}  // namespace
}  // namespace goniochrome::studio::studio_test
