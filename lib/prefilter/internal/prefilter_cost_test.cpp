#include "prefilter/internal/prefilter_cost.h"

#include <gtest/gtest.h>

#include "base/parallel.h"

namespace goniochrome::prefilter::prefilter_cost_test {
namespace {

envmap::Environment gray(int height) {
  image::Image image = {
      2 * height, height, 3, std::vector<float>(static_cast<std::size_t>(height) * height * 6, 1.0F), {}};
  return envmap::Environment::from_lat_long(std::move(image), envmap::Environment::BadPixels::kError, "gray").value();
}

double total(const std::vector<LobePlan>& plan) {
  double sum = 0;
  for (const LobePlan& lobe : plan) sum += lobe.predicted_time_s;
  return sum;
}

TEST(PrefilterCost, FirstLobeThatNeedsATablePaysForIt) {
  const envmap::Environment env = gray(128);
  const std::vector<LobePlan> both = prefilter_plan(env, {{250, 900}, false, 32, 1e-3});
  const std::vector<LobePlan> sharp = prefilter_plan(env, {{900}, false, 32, 1e-3});
  // Alone, the sharp lobe makes the transform that the wider one makes for it.
  EXPECT_GT(sharp[1].predicted_time_s, both[2].predicted_time_s);
  EXPECT_GT(both[1].predicted_time_s, sharp[1].predicted_time_s - both[2].predicted_time_s);
  EXPECT_LT(total(both), total(sharp) + total(prefilter_plan(env, {{250}, false, 32, 1e-3})));
}

TEST(PrefilterCost, GrowsWithWhatEachStepCounts) {
  const PrefilterRequest request = {{6, 70, 900}, true, 64, 1e-3};
  PrefilterRequest larger = request, tighter = request;
  larger.size = 128;
  tighter.tolerance = 1e-6;
  const envmap::Environment env = gray(64), fine = gray(256);
  const std::vector<LobePlan> plan = prefilter_plan(env, request), more_texels = prefilter_plan(env, larger),
                              more_degrees = prefilter_plan(env, tighter), more_rows = prefilter_plan(fine, request);
  ASSERT_EQ(plan.size(), 5U);
  for (std::size_t i = 0; i < plan.size(); ++i) {
    EXPECT_GT(plan[i].predicted_time_s, 0) << i;
    EXPECT_GT(more_texels[i].predicted_time_s, plan[i].predicted_time_s) << i;
    EXPECT_LT(more_texels[i].predicted_time_s, 4.1 * plan[i].predicted_time_s) << i;  // four times the texels
  }
  for (const std::size_t i : {0, 1, 2, 3}) EXPECT_GT(more_degrees[i].predicted_time_s, plan[i].predicted_time_s) << i;
  EXPECT_EQ(more_degrees[4].predicted_time_s, plan[4].predicted_time_s);
  for (const std::size_t i : {0, 1, 4}) EXPECT_GT(more_rows[i].predicted_time_s, plan[i].predicted_time_s) << i;
}

// An eighth of a cube serves all of it, but not when the scene is turned.
TEST(PrefilterCost, TurnedMirrorCostsTwelveTimesAsMuch) {
  const envmap::Environment env = gray(64);
  PrefilterRequest request = {{}, true, 32, 1e-3};
  const double straight = prefilter_plan(env, request).back().predicted_time_s;
  request.turn = envmap::Rotation::about_axes(0.3, 0, 0);
  EXPECT_NEAR(prefilter_plan(env, request).back().predicted_time_s, 12 * straight, 1e-9);
}

TEST(PrefilterCost, ThreadsShareTheTime) {
  const envmap::Environment env = gray(64);
  const int before = threads();
  set_threads(1);
  const double one = total(prefilter_plan(env, {{6, 70}, true, 32, 1e-3}));
  set_threads(4);
  const double four = total(prefilter_plan(env, {{6, 70}, true, 32, 1e-3}));
  set_threads(before);
  EXPECT_NEAR(one, 4 * four, 1e-9);
}

// The methods that are dear say so: narrower and wider than harmonics reach.
TEST(PrefilterCost, EveryMethodHasItsPrice) {
  const envmap::Environment env = gray(256);
  const auto plan = prefilter_plan(env, {{0, 0.3, 250, 1e5}, true, 32, 1e-4});
  using Method = LobePlan::Method;
  const std::vector<Method> want = {Method::kBrightHarmonics, Method::kHorizon, Method::kHorizon,
                                    Method::kHarmonics,       Method::kLocal,   Method::kMirror};
  ASSERT_EQ(plan.size(), want.size());
  for (std::size_t i = 0; i < want.size(); ++i) EXPECT_EQ(plan[i].method, want[i]) << i;
  EXPECT_GT(plan[2].predicted_time_s, plan[3].predicted_time_s);
  EXPECT_GT(plan[4].predicted_time_s, plan[3].predicted_time_s);
  // Local sums are weighted by floats, and blocks take their place below.
  const auto fine = prefilter_plan(env, {{1e5}, false, 32, 1e-6});
  EXPECT_EQ(fine[1].method, Method::kBlocks);
  EXPECT_GT(fine[1].predicted_time_s, 5 * plan[4].predicted_time_s);
  EXPECT_EQ(prefilter_plan(env, {{}, false, 32, 1e-6})[0].method, Method::kHorizon);
  EXPECT_EQ(prefilter_plan(env, {{0}, false, 32, 1e-2})[1].method, Method::kHorizon);
}

}  // namespace
}  // namespace goniochrome::prefilter::prefilter_cost_test
