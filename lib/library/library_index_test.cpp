#include "library/library_index.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>

#include "base/file.h"
#include "formats/xml.h"
#include "library/internal/search_random_for_test.h"
#include "library/search_library.h"

namespace goniochrome::library {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;

class LibraryIndexFile : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("goniochrome-index-" + std::to_string(::getpid()));
    fs::create_directories(folder_);
    path_ = (folder_ / "library.paints.xml").string();
    write_library(100);
  }
  void TearDown() override { fs::remove_all(folder_); }

  void write_library(int paints) {
    std::mt19937_64 random(3);
    auto writer = formats::PaintWriter::begin(OutputFile::create(path_).value()).value();
    for (int i = 0; i < paints; ++i)
      ASSERT_TRUE(writer.write(random_paints::paint(random, "p" + std::to_string(i), {15, 45, 110})).ok());
    ASSERT_TRUE(writer.finish().ok());
  }
  LibraryIndex opened() {
    auto index = LibraryIndex::open(path_);
    EXPECT_TRUE(index.ok()) << index.error().message;
    return std::move(index).value();
  }

  fs::path folder_;
  std::string path_;
};

TEST_F(LibraryIndexFile, is_built_once_and_then_mapped) {
  const LibraryIndex built = opened();
  EXPECT_EQ(built.origin(), LibraryIndex::Origin::kBuilt);
  EXPECT_EQ(built.note(), "there was none");
  const LibraryIndex mapped = opened();
  EXPECT_EQ(mapped.origin(), LibraryIndex::Origin::kMapped);
  ASSERT_EQ(mapped.size(), 100u);
  const auto paints = formats::read_paints(path_).value();
  for (std::size_t i = 0; i < paints.size(); ++i) {
    EXPECT_EQ(mapped.name(i), paints[i].name);
    EXPECT_EQ(mapped.code(i), paints[i].code);
    EXPECT_EQ(mapped.paint_class(i), paints[i].paint_class);
    for (const paint::MetricColumn& column : paint::metric_columns_without_fit()) {
      const double kept = mapped.metric(i, column), fresh = (*paint::metrics(paints[i])).*column.value;
      EXPECT_TRUE(kept == fresh || (std::isnan(kept) && std::isnan(fresh))) << column.name;
    }
  }
  ASSERT_EQ(mapped.sections().size(), 1u);
  EXPECT_EQ(mapped.sections()[0].geometries.size(), 3u);
  EXPECT_EQ(mapped.bytes(), fs::file_size(index_path(path_)));
}

TEST_F(LibraryIndexFile, changed_library_makes_it_stale) {
  opened();
  write_library(101);
  const LibraryIndex again = opened();
  EXPECT_EQ(again.origin(), LibraryIndex::Origin::kBuilt);
  EXPECT_EQ(again.note(), "the library has changed");
  EXPECT_EQ(again.size(), 101u);

  // Same size, other content, other time: the checksum tells.
  std::string text = file_content(path_).value();
  text.replace(text.find("p100"), 4, "q100");
  std::ofstream(path_) << text;
  fs::last_write_time(path_, fs::last_write_time(path_) + std::chrono::seconds(5));
  EXPECT_EQ(opened().name(100), "q100");
}

TEST_F(LibraryIndexFile, touched_library_is_still_the_same) {
  opened();
  fs::last_write_time(path_, fs::last_write_time(path_) + std::chrono::seconds(5));
  EXPECT_EQ(opened().origin(), LibraryIndex::Origin::kMapped);
}

TEST_F(LibraryIndexFile, damaged_index_is_rebuilt) {
  opened();
  const std::string whole = file_content(index_path(path_)).value();
  // Cut anywhere, or with bytes turned in the head, the directory or the tables that are followed: never a crash, and
  // either the damage is found or what is read is inside the file.
  for (std::size_t size : {std::size_t{0}, std::size_t{5}, std::size_t{31}, whole.size() / 2, whole.size() - 1}) {
    std::ofstream(index_path(path_), std::ios::binary) << whole.substr(0, size);
    EXPECT_EQ(opened().origin(), LibraryIndex::Origin::kBuilt) << size;
  }
  std::mt19937_64 random(5);
  int found = 0;
  for (int i = 0; i < 600; ++i) {
    std::string damaged = whole;
    const std::size_t at = i % 3 == 0   ? random() % 64
                           : i % 3 == 1 ? whole.size() - 1 - random() % 2000
                                        : random() % whole.size();
    damaged[at] = static_cast<char>(random());
    std::ofstream(index_path(path_), std::ios::binary) << damaged;
    const LibraryIndex index = opened();
    found += index.origin() == LibraryIndex::Origin::kBuilt;
    std::size_t letters = 0;
    for (std::size_t p = 0; p < index.size(); ++p) letters += index.name(p).size() + index.code(p).size();
    EXPECT_LE(letters, whole.size());
    const LibrarySearch search(index, {.count = 3});
    std::mt19937_64 same(4);
    const auto plan = search.plan(random_paints::paint(same, "q", {15, 45, 110}));
    if (!plan.ok()) continue;
    for (const LibraryMatch& match : search.nearest(*plan)) EXPECT_LT(match.paint, index.size());
  }
  EXPECT_GT(found, 150);
}

TEST_F(LibraryIndexFile, stays_in_memory_where_it_cannot_be_kept) {
  fs::create_directory(index_path(path_));
  const LibraryIndex index = opened();
  EXPECT_EQ(index.origin(), LibraryIndex::Origin::kInMemory);
  EXPECT_THAT(index.note(), HasSubstr("is a folder"));
  EXPECT_EQ(index.size(), 100u);
}

TEST_F(LibraryIndexFile, errors) {
  EXPECT_THAT(LibraryIndex::open((folder_ / "none.xml").string()).error().message, HasSubstr("cannot be read"));
  EXPECT_THAT(LibraryIndex::open(folder_.string()).error().message, HasSubstr("no plain file"));
  EXPECT_THAT(LibraryIndex::open("-").error().message, HasSubstr("-: cannot be read"));
  std::ofstream(path_) << "<paints";
  EXPECT_FALSE(LibraryIndex::open(path_).ok());
  EXPECT_FALSE(fs::exists(index_path(path_)));
}

// Searches of whole libraries.
class Snap : public testing::Test {
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

TEST_F(Snap, geometries_shared_with_the_most_paints) {
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

TEST_F(Snap, across_sections_like_one_list) {
  auto all = paints(200, {15, 45, 110});
  for (paint::Paint& paint : paints(200, {15, 25, 45, 75, 110}, "w")) all.push_back(paint);
  all[250].measurement->rows = all[10].measurement->rows;  // a tie, and the same geometries as the first
  std::shuffle(all.begin(), all.end(), random_);
  const LibraryIndex index = index_of(all);
  ASSERT_EQ(index.sections().size(), 2u);
  for (const ColorMetric metric : {ColorMetric::kDe76, ColorMetric::kDe00}) {
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

TEST_F(Snap, filters) {
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

TEST_F(Snap, conditions_do_not_mix) {
  auto all = paints(5, {15, 45, 110});
  all[2].measurement->condition.observer_deg = 2;
  const LibraryIndex index = index_of(all);
  const auto refused = LibrarySearch(index, {}).plan(all[0]);
  ASSERT_FALSE(refused.ok());
  EXPECT_THAT(refused.error().message, HasSubstr("D65/10, the library has some for D65/2"));
  EXPECT_THAT(refused.error().message, HasSubstr("--mix-observers"));
  const LibrarySearch mixing(index, {.count = 5, .mix_conditions = true});
  const auto plan = mixing.plan(all[0]);
  ASSERT_TRUE(plan.ok());
  EXPECT_EQ(plan->mixed->observer_deg, 2);
  EXPECT_EQ(mixing.nearest(*plan).size(), 5u);
}

TEST_F(Snap, designed_paints_are_compared_by_their_curve) {
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

TEST_F(Snap, nothing_in_common_and_empty) {
  const LibraryIndex index = index_of(paints(5, {25, 75}));
  EXPECT_THAT(LibrarySearch(index, {}).plan(paints(1, {15, 110})[0]).error().message,
              HasSubstr("measured at 45as15,45as110, the library at 45as25,45as75"));
  const LibraryIndex none = index_of({});
  EXPECT_EQ(none.size(), 0u);
  EXPECT_THAT(LibrarySearch(none, {}).plan(paints(1, {15})[0]).error().message, HasSubstr("the library at none"));
}

}  // namespace
}  // namespace goniochrome::library
