// How a round is cut to what there is time for.
#include "render/path/rounds.h"

#include <gtest/gtest.h>

namespace goniochrome::render::rounds_test {
namespace {

int by_fours(int n) {
  return n / 4 * 4;
}

// Points that were to get 4 to 200 samples get the same part of them, as far as fours can tell, and together no more
// than are left. The control is a round that is broken off, in which the first points get all and the last ones
// nothing.
TEST(RoundCut, LeavesEveryPointTheSamePart) {
  std::vector<int> asked;
  for (int i = 0; i < 4000; ++i) asked.push_back(4 * (1 + i * 7 % 50));
  const double sum = std::accumulate(asked.begin(), asked.end(), 0.0), left = 0.3 * sum;
  std::vector<int> cut = asked;
  ASSERT_TRUE(cut_round(left, cut, by_fours));
  const double drawn = std::accumulate(cut.begin(), cut.end(), 0.0);
  EXPECT_LE(drawn, left);
  EXPECT_GT(drawn, left - 8);
  std::vector<int> broken(asked.size(), 0);
  double rest = left;
  for (std::size_t i = 0; i < asked.size() && rest >= asked[i]; ++i) rest -= broken[i] = asked[i];
  const auto farthest = [&](const std::vector<int>& got) {
    double most = 0;
    for (std::size_t i = 0; i < got.size(); ++i) most = std::max(most, std::abs(got[i] - 0.3 * asked[i]));
    return most;
  };
  EXPECT_LE(farthest(cut), 8);
  EXPECT_GT(farthest(broken), 100) << "the control must fail";
}

TEST(RoundCut, LeavesARoundThatThereIsTimeForAsItIs) {
  std::vector<int> more = {4, 8, 0};
  EXPECT_TRUE(cut_round(12, more, by_fours));
  EXPECT_EQ(more, (std::vector<int>{4, 8, 0}));
  const Deadline none;
  EXPECT_TRUE(cut_round(Pace(none).left(), more, by_fours)) << "no time limit";
  EXPECT_EQ(more, (std::vector<int>{4, 8, 0}));
}

TEST(RoundCut, DrawsNothingWhereNothingIsLeft) {
  for (const double left : {0.0, 3.0, -5.0}) {
    std::vector<int> more = {4, 8, 0};
    EXPECT_FALSE(cut_round(left, more, by_fours)) << left;
    EXPECT_EQ(more, (std::vector<int>{0, 0, 0}));
  }
}

std::vector<int> planned(const RoundLimits& limits, const std::vector<double>& needed, const std::vector<double>& has) {
  std::vector<int> more(needed.size(), 0);
  const auto of = [](const std::vector<double>& list) { return [&list](std::size_t i) { return list[i]; }; };
  const bool any = plan_round(limits, of(needed), of(has), more);
  EXPECT_EQ(any, std::ranges::any_of(more, [](int n) { return n > 0; }));
  return more;
}

// A point gets what it needs beyond what it has, at most three times that, and no more than typical points ask for.
TEST(PlanRound, GivesPointsWhatTheyNeed) {
  RoundLimits limits;
  limits.of_point = 1000, limits.typical = 20;
  EXPECT_EQ(planned(limits, {0, 3, 10, 20, 500}, {4, 4, 4, 4, 10}), (std::vector<int>{0, 0, 6, 12, 11}));
  limits.at_once = 8;
  EXPECT_EQ(planned(limits, {10, 20}, {4, 4}), (std::vector<int>{6, 8}));
}

// Where every point is content and the picture is not, all get more in proportion, but for points that need nothing;
// none do where more would be in vain, or where all have all that they may get.
TEST(PlanRound, ScalesWhatContentPointsNeed) {
  RoundLimits limits;
  limits.of_point = 1000, limits.typical = 4, limits.lacking = 2;
  EXPECT_EQ(planned(limits, {4, 2, 0}, {4, 4, 4}), (std::vector<int>{12, 5, 0}));
  limits.in_vain = true;
  EXPECT_EQ(planned(limits, {4, 2, 0}, {4, 4, 4}), (std::vector<int>{0, 0, 0}));
  limits.in_vain = false, limits.of_point = 4;
  EXPECT_EQ(planned(limits, {4, 2, 0}, {4, 4, 4}), (std::vector<int>{0, 0, 0}));
}

TEST(PixelPoints, VisitsTheNeighborhoodOfAPixel) {
  PixelPoints points(8, 4);
  points.add(0, 0), points.add(2, 2), points.add(3, 2), points.add(7, 3);
  std::vector<std::size_t> seen;
  points.visit_around(1, 1, [&](std::size_t i) { seen.push_back(i); });
  EXPECT_EQ(seen, (std::vector<std::size_t>{0, 1, 2}));
}

// One bright sample among 24 quiet points is rare; as one of many it is not, nor is a point alone among those without
// samples.
TEST(PixelPoints, RareErrorsStandAlone) {
  PixelPoints points(5, 5);
  for (int i = 0; i < 25; ++i) points.add(i % 5, i / 5);
  std::vector<double> squares(25, 1.0);
  squares[12] = 100;
  EXPECT_TRUE(is_rare(points, 2, 2, squares, squares[12]));
  EXPECT_FALSE(is_rare(points, 1, 1, squares, squares[6]));
  std::ranges::fill(squares, 100);
  EXPECT_FALSE(is_rare(points, 2, 2, squares, 100)) << "control: all err so much";
  std::ranges::fill(squares, 0);
  squares[12] = 100;
  EXPECT_FALSE(is_rare(points, 2, 2, squares, 100)) << "control: nothing is known about it";
}

}  // namespace
}  // namespace goniochrome::render::rounds_test
