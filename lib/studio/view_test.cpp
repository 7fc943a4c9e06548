// Traced views beside a page: what the requests "view" and "show" answer and fill.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <random>

#include "base/angles.h"
#include "brdf/lobe_model.h"
#include "fit/paint_fit.h"
#include "render/light_transport.h"
#include "studio/paint_json.h"
#include "studio/studio.h"

namespace goniochrome::studio::view_test {
namespace {

using ::testing::HasSubstr;

const std::vector<double> kExponents = {1.3, 20};

paint::Paint plain(double L, double a) {
  paint::Paint paint;
  paint.name = "plain";
  paint.appearance = paint::Appearance{{L, a, 10}, {L / 2, a / 2, 2}, 60, 0};
  paint.gloss = {{60, 80}};
  return paint;
}

// A body and its glass, one above the other, in light that is different at every point.
render::LobeTransport made_light() {
  render::LobeTransport t;
  t.width = 416, t.height = 6, t.bounces = 1, t.unit = 2, t.probed = 2;
  t.columns.exponents = kExponents;
  t.worn.groups = {{0, 1}, 2};
  t.worn.weights.assign(2, std::vector<color::Rgb>(t.columns.count(), color::Rgb{0.02, 0.03, 0.01}));
  t.worn.brushed.assign(2, {});
  t.worn.emission.assign(2, {});
  t.worn.coats.assign(2, paint::kNoCoat);
  std::mt19937_64 random(1);
  const auto any = [&](double most) {
    return static_cast<float>(std::uniform_real_distribution<double>(0.1 * most, most)(random));
  };
  for (std::uint32_t place = 416; place < 5 * 416; ++place) {
    t.places.push_back(place), t.part.push_back(place < 3 * 416 ? 0 : 1);
  }
  t.make_room();
  for (std::size_t i = 0; i < t.places.size(); ++i) {
    for (std::size_t k = 0; k < 3 * t.columns.count(); ++k)
      t.direct[k / 3][3 * i + k % 3] = any(3), t.bounced[k / 3][3 * i + k % 3] = any(0.5);
    for (std::size_t k = 0; k < 3 * t.worn.groups.classes(); ++k) t.classes[k / 3][3 * i + k % 3] = any(0.1);
  }
  const std::size_t pairs = 3 * 2 * t.columns.count() * t.columns.count();
  for (const std::uint32_t point : {7U, 1000U}) {
    render::BounceProbe probe{point, {}, {}};
    for (std::size_t k = 0; k < pairs; ++k) probe.once.push_back(any(0.1)), probe.deeper.push_back(any(0.02));
    t.probes.push_back(std::move(probe));
  }
  return t;
}

Json view_request() {
  Json numbers = Json::array();
  for (const auto& matrix : color::fitted_operator().k)
    for (const auto& row : matrix)
      for (const double value : row) numbers.push_back(value);
  return {{"do", "view"},
          {"view", 3},
          {"parts", {{{"name", "body"}, {"material", ""}}, {{"name", "windshield"}, {"material", "x"}}}},
          {"operator", numbers}};
}

Studio loaded(const render::LobeTransport& light) {
  Studio studio;
  EXPECT_FALSE(studio
                   .answer({{"do", "load"},
                            {"basis", {{"name", "b2"}, {"exponents", kExponents}, {"mirror", false}}},
                            {"paints", {paint_json(plain(50, 10))}}})
                   .contains("error"));
  studio.attached() = *render::packed_view(light, std::vector<float>(light.places.size(), 20), {});
  const Json answer = studio.answer(view_request());
  EXPECT_EQ(answer.value("width", 0), 416) << answer;
  EXPECT_EQ(answer.value("height", 0), 6);
  return studio;
}

std::vector<float> picture(const Studio& studio) {
  const auto bytes = studio.list(Studio::List::kPicture);
  std::vector<float> values(bytes.size() / sizeof(float));
  std::memcpy(values.data(), bytes.data(), bytes.size());
  return values;
}

TEST(TracedViews, ShowEveryPaintAsSumsOfTheLightOfItsLobes) {
  const render::LobeTransport light = made_light();
  Studio studio = loaded(light);
  const paint::Paint red = plain(40, 50);
  const Json answer = studio.answer({{"do", "show"}, {"view", 3}, {"paint", paint_json(red)}});
  ASSERT_FALSE(answer.contains("error")) << answer;
  EXPECT_TRUE(answer["scaled"].get<bool>());
  EXPECT_GT(answer["bounced_de00_p95"].get<double>(), 0);
  EXPECT_EQ(answer["trace_again"].get<bool>(), answer["bounced_de00_p95"].get<double>() > 0.5);
  const std::vector<float> shown = picture(studio);
  ASSERT_EQ(shown.size(), 416U * 6 * 4);
  // The design on the body, the finish of glass on the other part; in doubles.
  const formats::Basis basis{"b2", kExponents, false};
  const paint::LobeFit fit = fit::PaintFitter(basis, {}).fit(red)->lobes;
  paint::LobeFit glass;
  glass.diffuse = (0.005 / kPi) * color::Rgb{1, 1, 1};
  std::vector<std::vector<color::Rgb>> weights;
  for (const paint::LobeFit& one : {fit, glass})
    weights.push_back(*render::column_weights(light.columns, brdf::under_coat(one, paint::kNoCoat).diffuse,
                                              brdf::under_coat(one, paint::kNoCoat).lobes, 60));
  const color::ReflectionOperator op = color::fitted_operator();
  const render::BounceScale scale = render::bounce_scale(light, weights, &op);
  double worst = 0, control = 0;
  for (std::size_t i = 0; i < light.places.size(); ++i) {
    color::Rgb sum, direct_alone;
    const auto& of = weights[static_cast<std::size_t>(light.part[i])];
    for (std::size_t k = 0; k < of.size(); ++k) {
      const color::Rgb direct = light.light(i, k, false), bounced = light.light(i, k) - direct;
      sum += color::reflected(op, of[k], direct + render::bounce_factor(light, i, scale) * bounced);
      direct_alone += color::reflected(op, of[k], direct);
    }
    for (int c = 0; c < 3; ++c) {
      const double pixel = shown[4 * light.places[i] + static_cast<std::size_t>(c)];
      worst = std::max(worst, std::abs(pixel - light.unit * sum[c]) / (light.unit * sum[c]));
      control = std::max(control, std::abs(pixel - light.unit * direct_alone[c]) / (light.unit * sum[c]));
    }
    EXPECT_EQ(shown[4 * light.places[i] + 3], 1);
  }
  EXPECT_LT(worst, 0.02);  // a column is rounded to 3 bits at least, and there are six of them
  EXPECT_GT(control, 0.05);
  EXPECT_EQ(shown[3], 0);

  // Small: the pixels in the middle of squares of two.
  const Json small = studio.answer({{"do", "show"}, {"view", 3}, {"paint", paint_json(red)}, {"small", true}});
  ASSERT_EQ(small.value("width", 0), 208);
  ASSERT_EQ(small.value("height", 0), 3);
  const std::vector<float> few = picture(studio);
  for (std::size_t x = 0; x < 208; ++x)
    for (std::size_t c = 0; c < 4; ++c) EXPECT_EQ(few[4 * (208 + x) + c], shown[4 * (3 * 416 + 2 * x + 1) + c]);
}

TEST(TracedViews, RefuseWhatTheyCannotShow) {
  const render::LobeTransport light = made_light();
  Studio studio = loaded(light);
  const auto error = [&](const Json& request) { return studio.answer(request).value("error", ""); };
  const Json paint = paint_json(plain(40, 50));
  EXPECT_THAT(error({{"do", "show"}, {"view", 1}, {"paint", paint}}), HasSubstr("number of a view that was loaded"));
  EXPECT_TRUE(studio.list(Studio::List::kPicture).empty());
  paint::Paint brushed = plain(40, 50);
  brushed.anisotropy = paint::Anisotropy{0.05, 0.3};
  EXPECT_THAT(error({{"do", "show"}, {"view", 3}, {"paint", paint_json(brushed)}}), HasSubstr("brushed otherwise"));
  EXPECT_THAT(error(view_request()), HasSubstr("damaged"));  // nothing is attached
  const std::string bytes = *render::packed_view(light, std::vector<float>(light.places.size(), 20), {});
  Json request = view_request();
  request["parts"].push_back({{"name", "door"}});
  studio.attached() = bytes;
  EXPECT_THAT(error(request), HasSubstr("the view has 2 parts, and the mesh 3"));
  request = view_request();
  request["operator"].push_back(1);
  studio.attached() = bytes;
  EXPECT_THAT(error(request), HasSubstr("operator"));
  // The view that was there before is still shown.
  EXPECT_FALSE(studio.answer({{"do", "show"}, {"view", 3}, {"paint", paint}}).contains("error"));
  Studio bare;
  EXPECT_THAT(bare.answer({{"do", "show"}, {"view", 3}, {"paint", paint}}).value("error", ""), HasSubstr("first"));
}

}  // namespace
}  // namespace goniochrome::studio::view_test
