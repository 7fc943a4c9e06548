#include "color/illuminant.h"

#include <gtest/gtest.h>

#include "color/spectrum.h"

namespace goniochrome::color::illuminant_test {
namespace {

TEST(Illuminant, IsKnownByAnyOfItsNames) {
  const std::pair<const char*, const char*> cases[] = {
      {"D65", "D65"},  {"d65", "D65"}, {" a ", "A"},         {"FL11", "F11"},      {"tl84", "F11"}, {"TL-84", "F11"},
      {"TL83", "F12"}, {"CWF", "F2"},  {"LED-B1", "LED-B1"}, {"led b5", "LED-B5"}, {"ID65", "ID65"}};
  for (const auto& [text, name] : cases) EXPECT_EQ(illuminant_named(text), name) << text;
  for (const char* text : {"", "D", "D60", "moonlight", "F", "LED", "D65/10"})
    EXPECT_FALSE(illuminant_named(text)) << text;
}

TEST(Illuminant, StandsBeforeItsObserver) {
  EXPECT_EQ(condition_in("d65/10"), (ViewingCondition{"D65", 10}));
  EXPECT_EQ(condition_in("F11 / 2 deg"), (ViewingCondition{"F11", 2}));
  EXPECT_EQ(condition_in("cwf"), (ViewingCondition{"F2", 0}));
  for (const char* text : {"D65/", "D65/5", "/10", "NONE"}) EXPECT_FALSE(condition_in(text)) << text;
  EXPECT_EQ(condition_among("ILLUMINANT, D65"), (ViewingCondition{"D65", 0}));
  EXPECT_EQ(condition_among("CIE A/2, L*"), (ViewingCondition{"A", 2}));
  EXPECT_EQ(condition_among("of D60"), (ViewingCondition{"D60", 0}));
  EXPECT_EQ(condition_among("nothing of the kind"), (ViewingCondition{"", 0}));
  EXPECT_EQ(condition_of("tl84", 2), (ViewingCondition{"F11", 2}));
  EXPECT_EQ(condition_of("tl84/10", 2), (ViewingCondition{"F11", 10}));
  EXPECT_EQ(condition_of("Moon", 2), (ViewingCondition{"Moon", 2}));
}

// Each name of the table has a column and a white, by any spelling.
TEST(Illuminant, OfTheTableHaveWhites) {
  for (const char* name : {"F12", "LED-B1", "LED-B2", "LED-B3", "LED-B4", "LED-B5", "LED-BH1", "LED-RGB1", "LED-V1",
                           "LED-V2", "ID50", "ID65"}) {
    const auto white = white_point({name, 10});
    ASSERT_TRUE(white.ok()) << name;
    EXPECT_GT(white->X, .8) << name;
    EXPECT_LT(white->X, 1.3) << name;
    EXPECT_EQ(SpectralColorimeter::make(std::vector{360.0, 780.0}, {name, 10})->white().X, white->X);
  }
  // Indoor daylight is the light of D65 and D50 behind a window: their whites lie near.
  EXPECT_NEAR(white_point({"ID65", 2})->Z, white_point({"D65", 2})->Z, .05);
  EXPECT_NEAR(white_point({"id50", 2})->Z, white_point({"d50", 2})->Z, .05);
}

}  // namespace
}  // namespace goniochrome::color::illuminant_test
