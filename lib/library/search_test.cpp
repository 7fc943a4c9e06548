#include "library/search.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "library/internal/random_paints_for_test.h"

namespace goniochrome::library::search_test {
namespace {

using testing::HasSubstr;

// Searches of whole libraries.
class Searching : public testing::Test {
 protected:
  static LibraryIndex index_of(std::vector<paint::Paint> paints) {
    auto shared = std::make_shared<std::vector<paint::Paint>>(std::move(paints));
    auto at = std::make_shared<std::size_t>(0);
    auto index = LibraryIndex::from_paints([=]() -> Result<std::optional<paint::Paint>> {
      if (*at == shared->size()) return std::optional<paint::Paint>();
      return std::optional<paint::Paint>((*shared)[(*at)++]);
    });
    EXPECT_TRUE(index.ok()) << index.error().message;
    return std::move(index).value();
  }
  std::vector<paint::Paint> paints(int count, const std::vector<double>& angles_deg, const std::string& prefix = "p") {
    std::vector<paint::Paint> result;
    for (int i = 0; i < count; ++i)
      result.push_back(random_paints::paint(random_, prefix + std::to_string(i), angles_deg));
    return result;
  }
  static std::vector<paint::Geometry> at_45(const std::vector<double>& angles_deg) {
    std::vector<paint::Geometry> result;
    for (const double angle : angles_deg) result.push_back({.incidence_deg = 45, .aspecular_deg = angle});
    return result;
  }
  static std::vector<std::uint32_t> numbers(const std::vector<LibraryMatch>& matches) {
    std::vector<std::uint32_t> result;
    for (const LibraryMatch& match : matches) result.push_back(match.paint);
    return result;
  }
  std::mt19937_64 random_{12};
};

TEST_F(Searching, ComparesAtTheGeometriesSharedWithTheMostPaints) {
  auto all = paints(50, {15, 45, 110});
  for (paint::Paint& paint : paints(3, {25, 45, 75})) all.push_back(paint);
  const LibraryIndex index = index_of(all);
  const LibrarySearch search(index, {});
  const paint::Paint query = random_paints::paint(random_, "q", {15, 25, 45, 75, 110});
  const auto plan = search.plan(query);
  ASSERT_TRUE(plan.ok());
  EXPECT_EQ(plan->geometries, at_45({15, 45, 110}));
  EXPECT_EQ(plan->left_out, 3u);

  // All paints at three angles rather than some at five; sets that overlap count by what they have in common.
  auto mixed = paints(20, {15, 45, 110});
  for (paint::Paint& paint : paints(30, {15, 25, 45, 75, 110})) mixed.push_back(paint);
  for (paint::Paint& paint : paints(10, {15, 45, 60, 110})) mixed.push_back(paint);
  const LibraryIndex mixed_index = index_of(mixed);
  const auto common =
      LibrarySearch(mixed_index, {}).plan(random_paints::paint(random_, "q", {15, 25, 45, 60, 75, 110}));
  EXPECT_EQ(common->geometries, at_45({15, 45, 110}));
  EXPECT_EQ(common->left_out, 0u);

  // Asked for 45 deg alone, all paints count.
  const LibrarySearch at_one(index, {.geometries = at_45({45})});
  EXPECT_EQ(at_one.plan(query)->left_out, 0u);
  EXPECT_EQ(at_one.nearest(*at_one.plan(all[52]))[0].paint, 52u);

  const LibrarySearch nowhere(index, {.geometries = at_45({15, 25})});
  EXPECT_THAT(nowhere.plan(query).error().message, HasSubstr("measured at all of 45as15,45as25"));
  EXPECT_THAT(at_one.plan(random_paints::paint(random_, "r", {15})).error().message,
              HasSubstr("no color at 45as45: it was measured at 45as15"));
}

TEST_F(Searching, FindsAcrossSectionsWhatOneListWouldGive) {
  auto all = paints(200, {15, 45, 110});
  for (paint::Paint& paint : paints(200, {15, 25, 45, 75, 110}, "w")) all.push_back(paint);
  all[250].measurement->rows = all[10].measurement->rows;  // a tie, and the same geometries as the first
  std::shuffle(all.begin(), all.end(), random_);
  const LibraryIndex index = index_of(all);
  ASSERT_EQ(index.sections().size(), 2u);
  for (const color::DifferenceFormula& metric : {kDe76, kDe00}) {
    const LibrarySearch search(index, {.count = 7, .metric = metric, .weights = {{at_45({110})[0], 2}}});
    for (int q = 0; q < 100; ++q) {
      const paint::Paint query = q % 2 ? all[static_cast<std::size_t>(q)] : paints(1, {15, 45, 110})[0];
      const auto plan = search.plan(query);
      ASSERT_TRUE(plan.ok());
      ASSERT_EQ(plan->geometries.size(), 3u);
      std::vector<std::pair<double, std::uint32_t>> brute;
      for (std::size_t i = 0; i < all.size(); ++i) {
        std::vector<color::Lab> lab;
        for (const paint::LabReading& row : comparable_rows(all[i]))
          if (std::ranges::find(plan->geometries, row.geometry) != plan->geometries.end()) lab.push_back(row.lab);
        brute.emplace_back(search_distance(plan->terms, lab, metric), static_cast<std::uint32_t>(i));
      }
      std::ranges::sort(brute);
      const auto matches = search.nearest(*plan);
      ASSERT_EQ(matches.size(), 7u);
      for (std::size_t i = 0; i < 7; ++i) {
        EXPECT_EQ(matches[i].paint, brute[i].second);
        EXPECT_EQ(matches[i].distance, brute[i].first);
        EXPECT_EQ(search_distance(plan->terms, matches[i].lab, metric), matches[i].distance);
      }
    }
  }
}

TEST_F(Searching, KeepsToMetricsAndClasses) {
  auto all = paints(300, {15, 45, 110});
  for (std::size_t i = 0; i < all.size(); i += 3) all[i].paint_class = paint::PaintClass::kMetallic;
  const LibraryIndex index = index_of(all);
  const paint::MetricRange range = paint::parse_metric_range("flop_index=5:12").value();
  const LibrarySearch search(index, {.count = 300, .ranges = {range}, .classes = {paint::PaintClass::kMetallic}});
  std::vector<std::uint32_t> wanted;
  for (std::uint32_t i = 0; i < all.size(); i += 3)
    if (range.contains(paint::metrics(all[i])->flop_index)) wanted.push_back(i);
  ASSERT_GT(wanted.size(), 3u);
  EXPECT_EQ(search.candidates(), wanted.size());
  auto found = numbers(search.nearest(*search.plan(all[0])));
  std::ranges::sort(found);
  EXPECT_EQ(found, wanted);
}

TEST_F(Searching, ConditionsDoNotMix) {
  auto all = paints(5, {15, 45, 110});
  all[2].measurement->condition.observer_deg = 2;
  const LibraryIndex index = index_of(all);
  const auto refused = LibrarySearch(index, {}).plan(all[0]);
  ASSERT_FALSE(refused.ok());
  EXPECT_THAT(refused.error().message, HasSubstr("D65/10, the library has some for D65/2"));
  EXPECT_THAT(refused.error().message, HasSubstr("colorsnap --mix-observers"));
  const LibrarySearch mixing(index, {.count = 5, .mix_conditions = true});
  const auto plan = mixing.plan(all[0]);
  ASSERT_TRUE(plan.ok());
  EXPECT_EQ(plan->mixed->observer_deg, 2);
  EXPECT_EQ(mixing.nearest(*plan).size(), 5u);
}

TEST_F(Searching, DesignedPaintsAreComparedByTheirCurve) {
  paint::Paint designed;
  designed.name = "designed";
  designed.appearance = paint::Appearance{{70, 30, 10}, {30, 12, 4}, 60, {}};
  auto all = paints(20, {15, 45, 110});
  all.push_back(designed);
  paint::Paint empty;
  empty.name = "empty";
  all.push_back(empty);
  const LibraryIndex index = index_of(all);
  EXPECT_EQ(index.size(), 22u);
  const LibrarySearch search(index, {});
  EXPECT_EQ(search.candidates(), 21u);
  const auto matches = search.nearest(*search.plan(designed));
  EXPECT_EQ(matches[0].paint, 20u);
  EXPECT_EQ(matches[0].distance, 0);
  EXPECT_THAT(search.plan(empty).error().message, HasSubstr("no color"));
}

TEST_F(Searching, RefusesWhatHasNothingInCommon) {
  const LibraryIndex index = index_of(paints(5, {25, 75}));
  EXPECT_THAT(LibrarySearch(index, {}).plan(paints(1, {15, 110})[0]).error().message,
              HasSubstr("measured at 45as15,45as110, the library at 45as25,45as75"));
  const LibraryIndex none = index_of({});
  EXPECT_EQ(none.size(), 0u);
  EXPECT_THAT(LibrarySearch(none, {}).plan(paints(1, {15})[0]).error().message, HasSubstr("the library at none"));
}

}  // namespace
}  // namespace goniochrome::library::search_test
