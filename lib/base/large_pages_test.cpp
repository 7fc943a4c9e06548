#include "base/large_pages.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <numeric>

#include "base/unset_array.h"

namespace goniochrome::large_pages_test {
namespace {

constexpr std::size_t kMany = 3'000'001;  // 12 MB, and no whole number of pages

TEST(LargePages, AVectorKeepsItsValuesAndGetsZeros) {
  std::vector<std::uint32_t> values(kMany / 2);
  std::iota(values.begin(), values.end(), 1U);
  resize_on_large_pages(values, kMany);
  ASSERT_EQ(values.size(), kMany);
  for (std::size_t i = 0; i < kMany; ++i)
    ASSERT_EQ(values[i], i < kMany / 2 ? static_cast<std::uint32_t>(i + 1) : 0U) << i;
  resize_on_large_pages(values, 3);
  EXPECT_EQ(values, (std::vector<std::uint32_t>{1, 2, 3}));
}

// Data in the pages at the ends of an array belong to others as well.
TEST(LargePages, WhatIsThereAlreadyStays) {
  std::vector<std::uint32_t> values(kMany);
  std::iota(values.begin(), values.end(), 0U);
  prefer_large_pages(values.data() + 5, (kMany - 9) * sizeof(values[0]));
  prefer_large_pages(nullptr, 0);
  for (std::size_t i = 0; i < kMany; ++i) ASSERT_EQ(values[i], i);
}

TEST(LargePages, AnUnsetArrayIsWritten) {
  UnsetArray<std::uint32_t> values(kMany);
  for (std::size_t i = 0; i < kMany; ++i) values[i] = static_cast<std::uint32_t>(i);
  EXPECT_EQ(values[0], 0U);
  EXPECT_EQ(values[kMany - 1], kMany - 1);
}

}  // namespace
}  // namespace goniochrome::large_pages_test
