// A view packed for a page and unpacked there, and the parts of a transport that a page keeps.
#include "render/path/packed_view.h"

#include <gtest/gtest.h>

#include "render/internal/seen.h"
#include "render/path/shown_paints.h"
#include "render/path/transport_file.h"
#include "render/path/transport_stage_for_test.h"

namespace goniochrome::render::packed_view_test {
namespace {

using namespace transport_stage;

struct Traced {
  paint::LobeFit cup, ball;
  LobeTransport light;
};
const Traced& traced() {
  static const Traced made = [] {
    std::mt19937_64 random(5);
    Traced t;
    t.cup = random_paint(random), t.ball = random_paint(random);
    LobeTransportRequest request;
    request.tolerance_de00 = 8;
    request.probes = 16;
    t.light = Stage(t.cup, t.ball, 30, 20).traced(request).transport;
    return t;
  }();
  return made;
}

image::Image beside_of(const LobeTransport& t) {
  image::Image beside{t.width, t.height, 4, {}, {}};
  for (int i = 0; i < t.width * t.height; ++i)
    for (const float value : {0.25F * static_cast<float>(i % 7), 100.0F, 1e6F, 1.0F}) beside.data.push_back(value);
  for (const std::uint32_t place : t.places) std::fill_n(&beside.data[4 * place], 4, 0.0F);
  return beside;
}

std::vector<float> angles_of(const LobeTransport& t) {
  std::vector<float> angles(t.places.size());
  for (std::size_t i = 0; i < angles.size(); ++i) angles[i] = 0.37F * static_cast<float>(i % 240);
  return angles;
}

std::vector<PartPaint> worn_by_all(const paint::LobeFit& cup, const paint::LobeFit& ball) {
  std::vector<PartPaint> parts(6, {&cup, {}, 45, "cup", "wall"});
  parts.back().paint = &ball;
  return parts;
}

struct Pictured {
  image::Image picture;
  BounceScale scale;
};
Pictured picture_of(const LobeTransport& light, const std::vector<PartPaint>& parts) {
  const auto shown = shown_paints(light.columns, light.worn, parts);
  EXPECT_TRUE(shown.ok());
  const color::ReflectionOperator op = color::fitted_operator();
  Pictured result{{light.width, light.height, 4, {}, {}}, bounce_scale(light, shown->weights, &op)};
  result.picture.data.assign(4 * static_cast<std::size_t>(light.width) * static_cast<std::size_t>(light.height), 0.0F);
  TransportShader(light, {}).shade(shown->paints, &op, result.scale, 1, result.picture);
  return result;
}

std::vector<double> differences(const LobeTransport& light, const image::Image& a, const image::Image& b) {
  std::vector<double> all;
  const auto rgb = [](const image::Image& of, std::uint32_t place) {
    const float* pixel = &of.data[4 * place];
    return color::Rgb{pixel[0], pixel[1], pixel[2]};
  };
  for (const std::uint32_t place : light.places) all.push_back(seen_difference(rgb(a, place), rgb(b, place), 1));
  return all;
}

TEST(PackedView, ShowsOtherPaintsAsTheTransportDoes) {
  const LobeTransport& before = traced().light;
  const auto packed = packed_view(before, angles_of(before), beside_of(before));
  ASSERT_TRUE(packed.ok());
  const auto view = unpacked_view(*packed);
  ASSERT_TRUE(view.ok()) << view.error().message;
  const LobeTransport& after = view->light;
  EXPECT_EQ(after.places, before.places);
  EXPECT_EQ(after.part, before.part);
  EXPECT_EQ(after.columns, before.columns);
  EXPECT_EQ(after.worn.weights, before.worn.weights);
  EXPECT_EQ(after.worn.groups.of_part, before.worn.groups.of_part);
  EXPECT_EQ(after.probes.size(), before.probes.size());
  EXPECT_GT(after.probes.size(), 4U);
  EXPECT_EQ(after.probed, before.probed);
  for (std::size_t i = 0; i < before.places.size(); ++i) EXPECT_NEAR(view->view_deg[i], angles_of(before)[i], 0.0101);
  std::mt19937_64 random(17);
  double least_control = 1e9;
  for (int trial = 0; trial < 8; ++trial) {
    const paint::LobeFit cup = random_paint(random), ball = random_paint(random);
    const auto parts = worn_by_all(cup, ball);
    const Pictured exact = picture_of(before, parts), ours = picture_of(after, parts);
    // Columns err by kPackedError_de00 in a paint that shows nothing else, and most of the light in the cup is bounced.
    EXPECT_LT(percentile_95(differences(before, exact.picture, ours.picture)), 3 * kPackedError_de00);
    EXPECT_NEAR(ours.scale.error_p95_de00, exact.scale.error_p95_de00, 0.02 * exact.scale.error_p95_de00);
    // The control: the same without bounced light.
    LobeTransport direct = after;
    for (std::vector<float>& column : direct.bounced) std::ranges::fill(column, 0.0F);
    least_control =
        std::min(least_control, percentile_95(differences(before, exact.picture, picture_of(direct, parts).picture)));
  }
  EXPECT_GT(least_control, 8 * kPackedError_de00);
}

TEST(PackedView, KeepsWhatIsBesideThePoints) {
  const LobeTransport& light = traced().light;
  const image::Image beside = beside_of(light);
  ASSERT_LT(light.places.size() + 20, beside.data.size() / 4);  // some pixels show nothing
  const auto view = unpacked_view(*packed_view(light, angles_of(light), beside));
  ASSERT_TRUE(view.ok());
  ASSERT_EQ(view->beside.data.size(), beside.data.size());
  for (std::size_t i = 0; i < beside.data.size(); ++i)
    ASSERT_NEAR(view->beside.data[i], beside.data[i], 0x1p-10 * beside.data[i] + 1e-6) << i;
  EXPECT_TRUE(unpacked_view(*packed_view(light, angles_of(light), {}))->beside.data.empty());
}

TEST(PackedView, CutOrTooLargeIsRefused) {
  const LobeTransport& light = traced().light;
  const std::string bytes = *packed_view(light, angles_of(light), beside_of(light));
  for (std::size_t size = 0; size < bytes.size(); size += 1 + bytes.size() / 300)
    EXPECT_FALSE(unpacked_view(std::string_view(bytes).substr(0, size)).ok()) << size;
  EXPECT_FALSE(unpacked_view(bytes + "x").ok());
  // Changed bytes may be other light, but they break nothing.
  std::mt19937_64 random(2);
  int refused = 0;
  for (int trial = 0; trial < 300; ++trial) {
    std::string changed = bytes;
    changed[random() % (trial % 2 == 0 ? 400 : bytes.size())] = static_cast<char>(random());
    if (!unpacked_view(changed).ok()) ++refused;
  }
  EXPECT_GT(refused, 20);
  EXPECT_LT(refused, 280);
  LobeTransport large = light;
  large.places.resize(kMostPagePoints + 1);
  const auto refusal = packed_view(large, {}, {});
  ASSERT_FALSE(refusal.ok());
  EXPECT_NE(refusal.error().message.find("trace it again in a smaller size"), std::string::npos);
}

TEST(PackedView, ThinnedHasThePixelsInTheMiddleOfSquares) {
  const LobeTransport& light = traced().light;
  const auto parts = worn_by_all(traced().ball, traced().cup);
  const image::Image all = picture_of(light, parts).picture;
  LobeTransport small = thinned(light, 4).light;
  EXPECT_EQ(small.width, 7);
  EXPECT_EQ(small.height, 5);
  const auto shown = shown_paints(light.columns, light.worn, parts);
  const color::ReflectionOperator op = color::fitted_operator();
  image::Image few{7, 5, 4, std::vector<float>(140, 0.0F), {}};
  TransportShader(small, {}).shade(shown->paints, &op, bounce_scale(light, shown->weights, &op), 1, few);
  int seen = 0;
  for (int y = 0; y < 5; ++y)
    for (int x = 0; x < 7; ++x)
      for (int c = 0; c < 4; ++c) {
        EXPECT_EQ(few.pixel(x, y)[c], all.pixel(4 * x + 2, 4 * y + 2)[c]);
        seen += few.pixel(x, y)[3] == 1 ? 1 : 0;
      }
  EXPECT_GT(seen, 20);
}

// Light of a sun is beyond the range of halves, and is shown as it would be in a smaller unit.
TEST(TransportShader, ShowsLightBeyondTheRangeOfHalves) {
  const LobeTransport& light = traced().light;
  const std::vector<PartPaint> parts(6, {&traced().ball, {}, 45, "", ""});
  constexpr float kBrighter = 0x1p30F;
  LobeTransport bright = light;
  for (std::size_t k = 0; k < light.columns.count(); ++k)
    for (std::vector<float>* of : {&bright.direct[k], &bright.bounced[k]})
      for (float& value : *of) value *= kBrighter;
  for (std::vector<float>& of : bright.classes)
    for (float& value : of) value *= kBrighter;
  const Pictured all = picture_of(light, parts), sun = picture_of(bright, parts);
  double sum = 0;
  for (const std::uint32_t place : light.places)
    for (std::size_t c = 0; c < 3; ++c) {
      const float dim = all.picture.data[4 * place + c];
      EXPECT_NEAR(sun.picture.data[4 * place + c] / kBrighter, dim, 2e-3 * std::abs(dim) + 1e-3);
      sum += dim;
    }
  EXPECT_GT(sum, 0.1 * static_cast<double>(light.places.size()));
}

TEST(ShownPaints, TellsOfCoatsAndRefusesOtherBrushing) {
  LobeTransport light = traced().light;
  std::mt19937_64 random(6);
  paint::LobeFit coated = random_paint(random);
  const paint::LobeFit bare = coated;
  coated.coat_index = 1.5;
  EXPECT_FALSE(shown_paints(light.columns, light.worn, worn_by_all(bare, bare))->coat_changed);
  EXPECT_TRUE(shown_paints(light.columns, light.worn, worn_by_all(bare, coated))->coat_changed);
  auto brushed = worn_by_all(bare, bare);
  brushed[2].anisotropy = {0.1, 0.3};
  const auto refused = shown_paints(light.columns, light.worn, brushed);
  ASSERT_FALSE(refused.ok());
  EXPECT_NE(refused.error().message.find("part wall"), std::string::npos);
  // A floor comes last, in what it wore.
  light.worn.has_floor = true;
  light.worn.groups.of_part.push_back(0);
  light.worn.coats.push_back(paint::kNoCoat);
  const auto shown = shown_paints(light.columns, light.worn, worn_by_all(bare, bare));
  ASSERT_EQ(shown->weights.size(), 7U);
  EXPECT_EQ(shown->weights.back(), light.worn.weights[0]);
  EXPECT_EQ(operator_or_null(color::component_wise()), nullptr);
}

}  // namespace
}  // namespace goniochrome::render::packed_view_test
