#include "color/reflection_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "base/scratch_for_test.h"

namespace goniochrome::color::reflection_file_test {
namespace {

double largest_difference(const ReflectionOperator& a, const ReflectionOperator& b) {
  double largest = 0;
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t d = 0; d < 3; ++d)
      for (std::size_t e = 0; e < 3; ++e) largest = std::max(largest, std::abs(a.k[c][d][e] - b.k[c][d][e]));
  return largest;
}

constexpr const char* kPlainTable = "[[[1,0,0],[0,0,0],[0,0,0]],[[0,0,0],[0,1,0],[0,0,0]],[[0,0,0],[0,0,0],[0,0,1]]]";

TEST(ReflectionFile, ReadsBackWhatItWritesAndRefusesTheRest) {
  const ScratchFolder folder;
  const auto read = [&](const std::string& text) {
    return read_reflection_operator(folder.file("operator.json", text));
  };
  const auto back = read(reflection_json(iso_rgb_operator()));
  ASSERT_TRUE(back.ok()) << back.error().message;
  EXPECT_LE(largest_difference(*back, iso_rgb_operator()), 1e-15);
  const std::string plain = std::string("{\"k\": ") + kPlainTable;
  for (const auto& [text, told] :
       {std::pair<std::string, std::string>{"no", "JSON object"},
        {"{\"k\": [[1,2],[3]]}", "3 x 3"},
        {"{\"k\": [[[1,0,0],[0,0,0],[0,0,0]],[[0,0,0],[0,1,0],[0,0,0]],[[0,0,0],[0,0,0],[0,0,2]]]}",
         "k[2][2] is not coherent"},
        {"{\"k\": [[[1,1,-1],[0,0,0],[0,0,0]],[[0,0,0],[0,1,0],[0,0,0]],[[0,0,0],[0,0,0],[0,0,1]]]}",
         "k[0][0] is not symmetric"},
        {plain + ", \"primaries\": \"adobe\"}", "\"primaries\" are \"adobe\""},
        {plain + ", \"primaries\": [[0.6,0.3],[0.3,0.6]]}", "x and y of red, green and blue"},
        {plain + ", \"primaries\": [[0.1,0.1],[0.2,0.2],[0.3,0.3]]}", "on one line"},
        {plain + ", \"primaries\": \"rec709\", \"white\": 6500}", "\"white\" is 6500"},
        // A name in other words left the table to Rec.2020.
        {plain + ", \"primaires\": \"rec709\"}", "\"primaires\" is not known"},
        {plain + ", \"white\": [0.3,0.3]}", "without \"primaries\""}}) {
    const auto refused = read(text);
    ASSERT_FALSE(refused.ok()) << text;
    EXPECT_NE(refused.error().message.find(told), std::string::npos) << refused.error().message;
  }
  EXPECT_FALSE(read_reflection_operator("/nowhere/at-all.json").ok());
}

TEST(ReflectionFile, PrimariesOfATableAreHonored) {
  const ScratchFolder folder;
  const auto named = read_reflection_operator(
      folder.file("named.json", std::string("{\"k\": ") + kPlainTable + ", \"primaries\": \"rec709\"}"));
  ASSERT_TRUE(named.ok()) << named.error().message;
  // The plain product of Rec.709: its red in its cyan is black. In Rec.2020 coordinates the same colors overlap.
  const Rgb red = rec2020_from_rec709({1, 0, 0}), cyan = rec2020_from_rec709({0, 1, 1});
  EXPECT_LE(length(reflected(*named, red, cyan)), 1e-14);
  EXPECT_GT(length(reflected(component_wise(), red, cyan)), 0.1);
  const auto stored =
      read_reflection_operator(folder.file("stored.json", reflection_json(iso_rgb_operator(), &kRec709)));
  ASSERT_TRUE(stored.ok()) << stored.error().message;
  EXPECT_LE(largest_difference(*stored, iso_rec709_operator()), 1e-14);
}

// The shares of a table are set where it was made. The control sets them on working-space values, where both tables
// keep more than 1 of red, so that what red takes changes its sign.
TEST(ReflectionFile, SharesAreSetInThePrimariesOfTheTable) {
  const ScratchFolder folder;
  const Rgb shares = {0.3, 0.1, 1};
  const auto in_709 = [](const ReflectionOperator& op, const Rgb& a, const Rgb& b) {
    return rec709_from_rec2020(reflected(op, rec2020_from_rec709(a), rec2020_from_rec709(b)));
  };
  const std::string path = folder.file("iso709.json", reflection_json(iso_rgb_operator(), &kRec709));
  for (const std::string& name : {std::string("iso709"), std::string("estimated"), path}) {
    const auto op = chosen_operator(name + ",0.3,0.1,1");
    ASSERT_TRUE(op.ok()) << name;
    EXPECT_NEAR(in_709(*op, {1, 0, 0}, {1, 0, 0}).x, 1 - shares.x, 1e-12) << name;
    EXPECT_NEAR(in_709(*op, {0, 1, 0}, {0, 1, 0}).y, 1 - shares.y, 1e-12) << name;
    EXPECT_NEAR(in_709(*op, {0, 0, 1}, {0, 0, 1}).z, 0, 1e-12) << name;
    EXPECT_NEAR(in_709(*op, {1, 0, 0}, {0, 1, 1}).x, shares.x, 1e-12) << name;
  }
  const auto wanted = in_working_space(*with_transfer(iso_rgb_operator(), shares), kRec709);
  EXPECT_LE(largest_difference(*chosen_operator("iso709", shares), *wanted), 1e-14);
  for (const ReflectionOperator& op : {iso_rec709_operator(), working_space_operator()}) {
    EXPECT_GT(op.k[0][0][0], 1);
    EXPECT_LT(with_transfer(op, shares)->k[0][1][0] * op.k[0][1][0], 0);
  }
  // Figure 6 of [GranierDamez2004]: all of blue comes from the others.
  for (const char* name : {"fitted", "iso", "iso709", "estimated"}) {
    const auto op = chosen_operator(std::string(name) + ",0,0,1");
    ASSERT_TRUE(op.ok()) << name << ": " << op.error().message;
    EXPECT_LE(length(reflected(*op, {1, 1, 1}, {0.3, 0.6, 0.2}) - Rgb{0.3, 0.6, 0.2}), 1e-12);
  }
}

TEST(ReflectionFile, NamesAndSharesAreTakenAsOptionsHaveThem) {
  const ScratchFolder folder;
  const auto is = [](const std::string& text, const ReflectionOperator& wanted) {
    const auto op = chosen_operator(text);
    return op.ok() && largest_difference(*op, wanted) <= 1e-14;
  };
  EXPECT_TRUE(is(kDefaultOperator, fitted_operator()));
  for (const char* name : {"plain", "none"}) EXPECT_TRUE(is(name, component_wise()));
  EXPECT_TRUE(is("iso", iso_rgb_operator()));
  EXPECT_TRUE(is("iso709", iso_rec709_operator()));
  for (const char* name : {"estimated", "working", "rec2020"}) EXPECT_TRUE(is(name, working_space_operator()));
  EXPECT_TRUE(is("iso,0", component_wise()));
  EXPECT_TRUE(is("iso,0.1", *with_transfer(iso_rgb_operator(), {0.1, 0.1, 0.1})));
  EXPECT_TRUE(is("iso, 0.1, 0.2, 0", *with_transfer(iso_rgb_operator(), {0.1, 0.2, 0})));
  const std::string path = folder.file("iso.json", reflection_json(iso_rgb_operator()));
  EXPECT_TRUE(is(path, iso_rgb_operator()));
  EXPECT_TRUE(is(path + ",0.3,0,0.2", *with_transfer(iso_rgb_operator(), {0.3, 0, 0.2})));
  for (const auto& [text, told] : {std::pair<std::string, std::string>{"xyz", "write fitted"},
                                   {"iso,2", "write fitted"},
                                   {"iso,0,1", "write fitted"},
                                   {"", "write fitted"},
                                   {"plain,0.1", "takes nothing from the other channels"},
                                   {"nowhere.json", "nowhere.json"}}) {
    const auto refused = chosen_operator(text);
    ASSERT_FALSE(refused.ok()) << text;
    EXPECT_NE(refused.error().message.find(told), std::string::npos) << refused.error().message;
  }
}

}  // namespace
}  // namespace goniochrome::color::reflection_file_test
