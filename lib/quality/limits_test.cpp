#include "quality/limits.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/random_for_test.h"
#include "quality/limit_maker.h"

namespace goniochrome::quality::limits_test {
namespace {

using Kind = color::DifferenceFormula::Kind;

paint::Paint paint_of(const std::string& name, const color::Lab& at_15, const color::Lab& at_45,
                      const color::Lab& at_110) {
  paint::Paint paint;
  paint.name = name;
  paint.measurement = paint::Measurement{
      {}, "", {{{.aspecular_deg = 15}, at_15}, {{.aspecular_deg = 45}, at_45}, {{.aspecular_deg = 110}, at_110}}};
  return paint;
}

const paint::Paint kRed = paint_of("red", {60, 50, 30}, {40, 40, 20}, {20, 30, 10});

Comparison moved(const color::Lab& by, const CompareOptions& options) {
  paint::Paint sample = kRed;
  for (paint::LabReading& row : sample.measurement->rows)
    row.lab = {row.lab.L + by.L, row.lab.a + by.a, row.lab.b + by.b};
  return *compare(*subject_of(kRed), *subject_of(sample), options);
}

std::vector<Limit> limits(const std::string& rows) {
  const auto parsed = parse_limits("geometry,quantity,low,high\n" + rows, "limits.csv");
  EXPECT_TRUE(parsed.ok()) << parsed.error().message;
  return *parsed;
}

std::vector<std::string> words(const Comparison& comparison, const CompareOptions& options, const std::string& rows) {
  std::vector<std::string> result;
  for (const Excess& excess : judged(comparison, options, limits(rows)).excesses) result.push_back(excess.words);
  return result;
}

const CompareOptions kOptions{{{Kind::kCiede2000}, {Kind::kCmc}}, {}};

TEST(Limits, FailInWordsThatTellPlaceAmountAndDirection) {
  const Comparison dark = moved({-2.1, 0, 0}, kOptions);
  EXPECT_EQ(words(dark, kOptions, "45as15,dL,-1.5,\n"),
            std::vector<std::string>{"45as15: dL -2.1, limit -1.5: too dark near gloss"});
  EXPECT_EQ(words(dark, kOptions, "*,dL,-1.5,1.5\n").size(), 3u);
  EXPECT_EQ(words(moved({0, 0, 3}, kOptions), kOptions, "45as110,db,,1\n"),
            std::vector<std::string>{"45as110: db 3, limit 1: too yellow in the flop"});
  // At a hue of 27 deg a turn counterclockwise is one to yellow.
  EXPECT_EQ(words(moved({0, -1, 2}, kOptions), kOptions, "45as45,dH,-1,1\n").front().substr(0, 11), "45as45: dH ");
  EXPECT_NE(words(moved({0, -1, 2}, kOptions), kOptions, "45as45,dH,-1,1\n").front().find("too yellow"),
            std::string::npos);
  EXPECT_EQ(words(dark, kOptions, "max,dE,,1\nmean,dE_cmc:2:1,,0.1\n").size(), 2u);
  EXPECT_EQ(words(dark, kOptions, "max,dE,,1\n").front(), "max: dE_ciede2000 1.87, limit 1: too far off at 45as15");
  paint::Paint gray = kRed;
  gray.measurement->rows[0].lab = {60, 25, 15};
  const Comparison flat = *compare(*subject_of(kRed), *subject_of(gray), kOptions);
  EXPECT_TRUE(words(flat, kOptions, "*,chroma_index,-9,9\n").front().ends_with(": too little chroma travel"));
}

TEST(Limits, AreKeptByNumbersOnThem) {
  // 124.3 - 2.4 is not a number of this base; the difference misses -2.4 by a rounding.
  paint::Paint standard = kRed, sample = kRed;
  standard.measurement->rows[0].lab.L = 124.3, sample.measurement->rows[0].lab.L = 121.9;
  const Comparison c = *compare(*subject_of(standard), *subject_of(sample), kOptions);
  EXPECT_TRUE(judged(c, kOptions, limits("45as15,dL,-2.4,2.4\n")).excesses.empty());
  EXPECT_EQ(judged(c, kOptions, limits("45as15,dL,-2.39999,2.4\n")).excesses.size(), 1u);
}

// The judgement of a sample that was not measured at the last geometry of its standard.
Judged without_110(const color::Lab& by, const std::string& rows) {
  paint::Paint sample = kRed;
  sample.measurement->rows.pop_back();
  for (paint::LabReading& row : sample.measurement->rows)
    row.lab = {row.lab.L + by.L, row.lab.a + by.a, row.lab.b + by.b};
  return judged(*compare(*subject_of(kRed), *subject_of(sample), kOptions), kOptions, limits(rows));
}

TEST(Limits, AreNotKeptByReadingsThatTheSampleLacks) {
  const Judged all = without_110({}, "*,dL,-1,1\n");
  EXPECT_STREQ(all.verdict(), "incomplete");
  EXPECT_STREQ(all.verdict("45as15"), "pass");
  EXPECT_STREQ(all.verdict("45as110"), "incomplete");
  ASSERT_EQ(all.excesses.size(), 1u);
  EXPECT_EQ(all.excesses.front().words, "45as110: dL has a limit and was not measured");
  EXPECT_EQ(without_110({}, "max,dE,,1\n").excesses.front().words,
            "max: dE_ciede2000 has a limit, and 45as110 was not measured");
  EXPECT_STREQ(without_110({}, "mean,dE_cmc:2:1,,1\n").verdict(), "incomplete");
  EXPECT_STREQ(without_110({}, "45as15,dL,-1,1\n").verdict(), "pass") << "the control: no limit there";
  // A curve through the other angles says nothing of the flop.
  EXPECT_EQ(without_110({}, "*,flop_index,-1,1\n").excesses.front().words,
            "paint: flop_index has a limit and was not measured");
  // A limit that is passed comes first.
  const Judged dark = without_110({-2, 0, 0}, "*,dL,-1,1\n");
  EXPECT_STREQ(dark.verdict(), "fail");
  EXPECT_EQ(dark.excesses.back().words, "45as110: dL has a limit and was not measured");
}

TEST(Limits, AreNotKeptByWhatHasNoValue) {
  paint::Paint mirror = kRed;
  mirror.measurement->rows[1].geometry.aspecular_deg = 0;
  const CompareOptions din{{{Kind::kDin6175}}, {}};
  const Comparison c = *compare(*subject_of(mirror), *subject_of(mirror), din);
  for (const char* row : {"*,dE,,1\n", "45as0,dE,,1\n", "max,dE,,1\n", "mean,dE,,1\n"}) {
    const Judged all = judged(c, din, limits(row));
    EXPECT_STREQ(all.verdict(), "incomplete") << row;
    EXPECT_EQ(all.excesses.size(), 1u) << row;
  }
  EXPECT_STREQ(judged(c, din, limits("*,dE,,1\n")).verdict("45as15"), "pass");
  EXPECT_STREQ(judged(c, din, limits("*,dL,-1,1\n")).verdict(), "pass") << "the control";
}

TEST(Limits, NameFormulasAndGeometriesInAnySpelling) {
  for (const auto& [spelling, name] :
       {std::pair{"dE_cmc", "dE_cmc:2:1"}, {"dE_cmc:2.0:1", "dE_cmc:2:1"}, {"dE_CIEDE2000", "dE_ciede2000"}})
    EXPECT_EQ(limits(fmt::format("*,{},,1\n", spelling)).front().quantity, name);
  EXPECT_STREQ(judged(moved({-2.1, 0, 0}, kOptions), kOptions, limits("*,dE_CMC,,.1\n")).verdict(), "fail");
  EXPECT_EQ(limits("15,texture:Grade,,1\n").front().at, "45as15");
  EXPECT_EQ(limits("15d,texture:Grade,,1\n").front().at, "15d");
}

TEST(Limits, GiveNoVerdictWhereThereIsNone) {
  const Judged some = judged(moved({}, kOptions), kOptions, limits("45as15,dL,-1,1\n"));
  EXPECT_STREQ(some.verdict("45as15"), "pass");
  EXPECT_STREQ(some.verdict("45as45"), "-");
  EXPECT_STREQ(some.verdict("max"), "-");
  EXPECT_STREQ(some.verdict(), "pass");
  EXPECT_STREQ(judged(moved({}, kOptions), kOptions, {}).verdict(), "-");
}

TEST(Limits, OfTexturesTakeThePlacesOfTheStandard) {
  paint::Paint standard = kRed, sample = kRed;
  standard.measurement->textures = {{"Grade", "15d", "", 3}, {"Grade", "45d", "", 2}};
  sample.measurement->textures = {standard.measurement->textures.front()};
  const auto verdict = [&](const char* at) -> std::string {
    return judged(*compare(*subject_of(standard), *subject_of(sample), kOptions), kOptions,
                  limits("*,texture:Grade,-1,1\n"))
        .verdict(at);
  };
  EXPECT_EQ(verdict("15d"), "pass");
  EXPECT_EQ(verdict("45d"), "incomplete");
  sample.measurement->textures = standard.measurement->textures;
  EXPECT_EQ(verdict("45d"), "pass") << "the control";
}

TEST(Limits, OfWhatWasNotMeasuredAreIncomplete) {
  EXPECT_STREQ(judged(moved({}, kOptions), kOptions, limits("45as25,dL,-1,1\n")).verdict(), "incomplete");
  EXPECT_EQ(words(moved({}, kOptions), kOptions, "45as25,dL,-1,1\n"),
            std::vector<std::string>{"45as25: dL has a limit and was not measured"});
  EXPECT_EQ(words(moved({}, kOptions), kOptions, "*,gloss60,-1,1\n15d,texture:Sparkle Grade,,1\n").size(), 2u);
}

TEST(Limits, ComeBackFromTheirTableAndFromAPaint) {
  const std::vector<Limit> all =
      limits("*,dL,-1.5,1.5\nmax,dE_cmc:2:1,,1.7\n15d,texture:Sparkle <&> Grade,-1,\n*,metamerism_A,,0.5\n");
  const auto same = [](const Limit& x, const Limit& y) {
    return x.at == y.at && x.quantity == y.quantity && x.low == y.low && x.high == y.high;
  };
  EXPECT_TRUE(std::ranges::equal(*parse_limits(limits_table(all), "again"), all, same));
  const paint::Paint carrying = with_limits(with_limits(kRed, limits("*,dL,0,1\n")), all);
  EXPECT_EQ(carrying.foreign.size(), 1u);
  EXPECT_TRUE(std::ranges::equal(*limits_of(carrying), all, same));
  EXPECT_TRUE(limits_of(kRed)->empty());
  CompareOptions options{{{Kind::kCie76}}, {}};
  ASSERT_TRUE(add_needed(all, options).ok());
  EXPECT_EQ(options.formulas.size(), 2u);
  EXPECT_EQ(options.illuminants, std::vector<std::string>{"A"});
}

TEST(Limits, HaveADecimalCommaWhereCellsAreSeparatedOtherwise) {
  for (const char separator : {';', '\t'}) {
    std::string table = "sep=;\ngeometry;quantity;low;high\n*;dL;-1,5;0,25\n";
    std::ranges::replace(table, ';', separator);
    const auto parsed = parse_limits(table, "limits.csv");
    ASSERT_TRUE(parsed.ok()) << parsed.error().message;
    EXPECT_EQ(parsed->front().low, -1.5);
    EXPECT_EQ(parsed->front().high, 0.25);
  }
}

TEST(Limits, AreReadAsSpreadsheetsSaveThem) {
  const auto parsed = parse_limits("sep=;\r\nGeometry;Quantity;Low;High\r\n\"*\";dL;-1,5;1,5\r\n;;;\r\n", "l.csv");
  ASSERT_TRUE(parsed.ok()) << parsed.error().message;
  ASSERT_EQ(parsed->size(), 1u);
  EXPECT_EQ(parsed->front().low, -1.5);
}

TEST(Limits, AreRefusedWithTheirLine) {
  for (const char* wrong : {"*,dL,1,-1", "*,dQ,1,2", "*,dL,,", "*,dL,x,2", "*,dL,1", "x,dL,1,2", "mean,dL,1,2",
                            "45as15,gloss60,1,2", "*,dE_cie99,,2", "paint,dL,1,2", "paint,dE,,2",
                            "paint,metamerism_A,,2", "*,dL,nan,2", "*,texture:,,2", "*,metamerism_,,2"}) {
    const auto result = parse_limits(
        "geometry;quantity;low;high\n\n*;dL;-1;1\n" +
            [&] {
              std::string row = wrong;
              std::ranges::replace(row, ',', ';');
              return row;
            }() +
            "\n",
        "l.csv");
    ASSERT_FALSE(result.ok()) << wrong;
    EXPECT_EQ(result.error().message.substr(0, 8), "l.csv:4:") << wrong;
  }
  EXPECT_FALSE(parse_limits("dL,1,2\n", "l.csv").ok());
  EXPECT_FALSE(parse_limits("geometry,quantity,low,high\n", "l.csv").ok());
}

TEST(Limits, MadeByAShareAreKeptByItAndNotByMore) {
  TestNumbers random(5);
  LimitMaker maker;
  std::vector<Comparison> panels;
  for (int i = 0; i < 200; ++i) {
    panels.push_back(moved({2 * random() - 1, 4 * random() - 2, 3 * random()}, kOptions));
    maker.add(panels.back(), kOptions);
  }
  const auto kept = [&](const std::vector<Limit>& limits) {
    return std::ranges::count_if(panels,
                                 [&](const Comparison& c) { return judged(c, kOptions, limits).excesses.empty(); });
  };
  EXPECT_EQ(kept(*maker.by_share(0.9)), 180);
  EXPECT_EQ(kept(*maker.by_share(1)), 200);
  EXPECT_EQ(kept(*maker.by_spread(100)), 200);
  EXPECT_TRUE(maker.dropped().empty());
  paint::Paint short_panel = kRed;
  short_panel.measurement->rows.pop_back();
  maker.add(*compare(*subject_of(kRed), *subject_of(short_panel), kOptions), kOptions);
  EXPECT_EQ(maker.dropped(),
            (std::vector<std::string>{"45as110", "chroma_index", "flop_index", "hue_shift_index", "hue_travel_deg"}));
  LimitMaker few;
  few.add(panels[0], kOptions), few.add(panels[1], kOptions);
  EXPECT_FALSE(few.by_spread(3).ok());
}

TEST(Limits, AreReachedByTheEightPaintsThatJustPass) {
  const std::vector<Limit> all = limits("*,dL,-1,2\n45as15,dE,,1.5\nmax,dE_cmc:2:1,,1\n");
  const auto family = just_passing(kRed, kOptions, all);
  ASSERT_TRUE(family.ok()) << family.error().message;
  ASSERT_EQ(family->size(), 9u);
  EXPECT_EQ((*family)[1].name, "red.face-lighter");
  for (std::size_t i = 1; i < 9; ++i) {
    const Comparison c = *compare(*subject_of(kRed), *subject_of((*family)[i]), kOptions);
    EXPECT_TRUE(judged(c, kOptions, all).excesses.empty()) << (*family)[i].name;
    paint::Paint beyond = (*family)[i];
    for (std::size_t g = 0; g < 3; ++g) {
      color::Lab& lab = beyond.measurement->rows[g].lab;
      const color::Lab& s = kRed.measurement->rows[g].lab;
      lab = {s.L + 1.001 * (lab.L - s.L), s.a + 1.001 * (lab.a - s.a), s.b + 1.001 * (lab.b - s.b)};
      EXPECT_NE(lab, s);
    }
    EXPECT_GE(judged(*compare(*subject_of(kRed), *subject_of(beyond), kOptions), kOptions, all).excesses.size(), 1u);
  }
  // A geometry without a limit takes what the others allow, up to black.
  const auto flop = just_passing(kRed, kOptions, limits("45as45,dE,,1\n45as45,dL,-3,3\n"));
  ASSERT_TRUE(flop.ok()) << flop.error().message;
  const auto step = [&](std::size_t paint, std::size_t row) {
    return (*flop)[paint].measurement->rows[row].lab.L - kRed.measurement->rows[row].lab.L;
  };
  EXPECT_EQ((*flop)[2].name, "red.face-darker");
  EXPECT_LT(step(2, 1), -0.9);
  EXPECT_NEAR(step(2, 2), step(2, 1), 1e-9);
  EXPECT_NEAR(step(2, 0), step(2, 1), 1e-9);
  const auto wide = just_passing(kRed, kOptions, limits("45as45,da,-30,30\n45as45,db,-30,30\n45as45,dL,-30,30\n"));
  ASSERT_TRUE(wide.ok()) << wide.error().message;
  EXPECT_NEAR((*wide)[2].measurement->rows[2].lab.L, 0, 1e-9);
  EXPECT_FALSE(just_passing(kRed, kOptions, limits("*,dL,-1,1\n")).ok());
  EXPECT_FALSE(just_passing(kRed, kOptions, limits("*,dL,1,2\n")).ok());
}

}  // namespace
}  // namespace goniochrome::quality::limits_test
