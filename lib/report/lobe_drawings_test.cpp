#include "report/lobe_drawings.h"

#include <gtest/gtest.h>

#include <cmath>

namespace goniochrome::report::lobe_drawings_test {
namespace {

std::size_t count(const std::string& text, const std::string& word) {
  std::size_t n = 0;
  for (auto at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++n;
  return n;
}

// The map keeps areas: every cell of the square covers 2 pi / n^2 of the hemisphere, so the mean of z is 1/2.
TEST(LobeDrawings, TheSquareCoversTheHemisphereEvenly) {
  constexpr int kCells = 64;
  double mean_z = 0, mean_x = 0;
  for (int i = 0; i < kCells; ++i)
    for (int j = 0; j < kCells; ++j) {
      const Vec3 w = hemisphere_direction((2 * i + 1.0) / kCells - 1, (2 * j + 1.0) / kCells - 1);
      EXPECT_NEAR(length(w), 1, 1e-12);
      EXPECT_GE(w.z, -1e-12);
      mean_z += w.z / (kCells * kCells), mean_x += w.x / (kCells * kCells);
    }
  // The midpoint rule on 64 cells of a function that bends along the diagonals.
  EXPECT_NEAR(mean_z, 0.5, 1e-3);
  EXPECT_NEAR(mean_x, 0, 1e-12);
  EXPECT_EQ(hemisphere_direction(0, 0), (Vec3{0, 0, 1}));
  EXPECT_NEAR(hemisphere_direction(1, 0.3).z, 0, 1e-12);
  EXPECT_NEAR(hemisphere_direction(-1, 0).x, -1, 1e-12);
  EXPECT_NEAR(hemisphere_direction(0, -0.5).y, -0.5 * std::sqrt(2 - 0.25), 1e-12);
}

TEST(LobeDrawings, NothingToDrawIsDrawnWithoutNan) {
  for (const double r : {0.0, 1.0}) {
    const std::string surface = surface_drawing(
                                    "s", "#0072b2", [&](const Vec3&) { return r; }, {0.7, 0, 0.7}, 300, 240)
                                    .body;
    EXPECT_EQ(surface.find("nan"), std::string::npos);
    EXPECT_EQ(count(surface, "<path fill"), r > 0 ? 24u * 48 : 0u);
  }
  const std::string polar =
      polar_drawing("p", {{"a", "#000000", {-90, 0, 90}, {0, 1, NAN}}, {"b", "#111111", {10}, {2}, true}}, 300, 240)
          .body;
  EXPECT_EQ(polar.find("nan"), std::string::npos);
  EXPECT_EQ(count(polar, "<circle"), 1u);
}

TEST(LobeDrawings, CellsOfOneColorAreJoined) {
  const auto gray = [](double, double) { return Vec3{0.5, 0.5, 0.5}; };
  EXPECT_EQ(count(square_drawing("q", 8, gray, 100, 100).body, "<rect"), 8u + 1);
  const auto ramp = [](double x, double) { return Vec3{x, 2, -1}; };
  const std::string cells = square_drawing("q", 8, ramp, 100, 100).body;
  EXPECT_NE(cells.find("#00ff00"), std::string::npos) << "values are held in 0..1";
  EXPECT_EQ(cells.find("#-"), std::string::npos);
}

TEST(Plot, RowsAndColumnsAddUp) {
  const Drawing a{100, 50, "<a/>"}, b{30, 80, "<b/>"};
  const Drawing row = row_of({a, b}), column = column_of({a, b});
  EXPECT_EQ(row.width, 130);
  EXPECT_EQ(row.height, 80);
  EXPECT_EQ(column.width, 100);
  EXPECT_EQ(column.height, 130);
  EXPECT_NE(svg(std::vector<Drawing>{row, column}, 1).find("width=\"130\" height=\"210\""), std::string::npos);
}

}  // namespace
}  // namespace goniochrome::report::lobe_drawings_test
