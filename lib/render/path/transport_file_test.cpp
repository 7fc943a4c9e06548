// A transport written and read back, shaded, and damaged.
#include "render/path/transport_file.h"

#include <gtest/gtest.h>

#include <functional>

#include "render/internal/seen.h"
#include "render/path/transport_shading.h"
#include "render/path/transport_stage_for_test.h"

namespace goniochrome::render::transport_file_test {
namespace {

using namespace transport_stage;

constexpr double kWhite = 2.5;  // luminance, so that units show

struct Kept {
  paint::LobeFit cup, ball;
  TracedLobes traced;
  image::AovFile file;
};

// The file as it comes back from a disk: parts in halves are rounded.
const Kept& kept() {
  static const Kept made = [] {
    std::mt19937_64 random(3);
    Kept k;
    k.cup = random_paint(random), k.ball = random_paint(random);
    const Stage stage(k.cup, k.ball, 20, 15);
    LobeTransportRequest request;
    request.tolerance_de00 = 8;
    request.white_luminance = kWhite;
    request.probes = 16;
    request.pixel_samples = 4;
    k.traced = stage.traced(request);
    TransportParts parts = transport_parts(k.traced.transport);
    const std::string path = ::testing::TempDir() + "transport_file_test.exr";
    image::ImagePart picture{
        "picture", {20, 15, 1, std::vector<float>(300, 0.0F), {"part"}}, {}, image::PixelType::kFloat};
    for (std::size_t i = 0; i < k.traced.transport.places.size(); ++i)
      picture.image.data[k.traced.transport.places[i]] = static_cast<float>(k.traced.transport.part[i] + 1);
    picture.attributes[kTransportAttribute] = parts.header;
    std::vector<image::ImagePart> all = {picture};
    all.insert(all.end(), parts.parts.begin(), parts.parts.end());
    EXPECT_TRUE(image::write_exr(path, all).ok());
    k.file = *image::read_aov_file(path);
    return k;
  }();
  return made;
}

TEST(TransportFile, ComesBackToHalvesAndIsShadedAsItWasTraced) {
  const Kept& k = kept();
  const LobeTransport& before = k.traced.transport;
  auto read = transport_of(k.file);
  ASSERT_TRUE(read.ok()) << read.error().message;
  const LobeTransport& t = **read;
  EXPECT_EQ(t.places, before.places);
  EXPECT_EQ(t.part, before.part);
  EXPECT_EQ(t.columns, before.columns);
  EXPECT_EQ(t.probes.size(), before.probes.size());
  EXPECT_GT(t.probes.size(), 4U);
  EXPECT_EQ(t.unit, kWhite);
  EXPECT_EQ(t.samples, 4);
  // A half has 11 bits, and 2^-25 at the least; direct and bounced light are halves of their own.
  for (std::size_t i = 0; i < t.places.size(); ++i)
    for (std::size_t c = 0; c < t.columns.count(); ++c)
      for (int e = 0; e < 3; ++e)
        for (const bool bounced : {false, true}) {
          const double kept = before.light(i, c, bounced)[e] - (bounced ? before.light(i, c, false)[e] : 0),
                       found = t.unit * (t.light(i, c, bounced)[e] - (bounced ? t.light(i, c, false)[e] : 0));
          ASSERT_NEAR(found, kept, 0x1p-11 * std::abs(kept) + kWhite * 0x1p-24);
        }
  // Shaded by the kernel, in the paints that were worn, by the product of colored light, and in paints that change
  // with the view; against sums in doubles.
  std::mt19937_64 random(8);
  paint::LobeFit travels = random_paint(random);
  for (const double view : {0.0, 30.0, 70.0}) {
    const paint::LobeFit at = random_paint(random);
    travels.views.push_back({view, at.diffuse, at.lobes});
  }
  const color::ReflectionOperator op = color::iso_rgb_operator();
  std::vector<float> view_deg(t.places.size());
  for (std::size_t i = 0; i < view_deg.size(); ++i) view_deg[i] = static_cast<float>(i % 90);
  const TransportShader shader(t, view_deg);
  for (const bool colored : {false, true}) {
    std::vector<TransportPaint> paints(5, *transport_paint(t.columns, k.cup, 45));
    paints.push_back(*transport_paint(t.columns, travels, 45));
    std::vector<std::vector<color::Rgb>> flat(5, weights_of(t.columns, k.cup));
    flat.push_back(weights_of(t.columns, travels));
    const BounceScale scale = bounce_scale(t, flat, colored ? &op : nullptr);
    EXPECT_TRUE(scale.changed);
    EXPECT_GT(scale.error_p95_de00, 0);
    image::Image picture{20, 15, 4, std::vector<float>(1200, 0.0F), {}};
    shader.shade(paints, colored ? &op : nullptr, scale, 2, picture);
    double worst = 0;
    for (std::size_t i = 0; i < t.places.size(); ++i) {
      const color::Rgb factor = bounce_factor(t, i, scale);
      const paint::LobeFit here = t.part[i] == 5 ? brdf::at_view(travels, view_deg[i]) : k.cup;
      const auto weights = weights_of(t.columns, here);
      color::Rgb sum;
      for (std::size_t c = 0; c < weights.size(); ++c) {
        const color::Rgb direct = t.light(i, c, false);
        const color::Rgb light = direct + factor * (t.light(i, c) - direct);
        sum += colored ? color::reflected(op, weights[c], light) : weights[c] * light;
      }
      const float* pixel = &picture.data[4 * t.places[i]];
      EXPECT_EQ(pixel[3], 1);
      worst = std::max(worst, seen_difference({pixel[0], pixel[1], pixel[2]}, 2 * t.unit * sum, 2 * t.unit));
    }
    EXPECT_LT(worst, 0.01);  // floats, and halves of the classes
  }
}

TEST(TransportFile, OfPaintsThatWereWornNeedsNoScaling) {
  const auto t = **transport_of(kept().file);
  std::vector<std::vector<color::Rgb>> worn(5, weights_of(t.columns, kept().cup));
  worn.push_back(weights_of(t.columns, kept().ball));
  const BounceScale scale = bounce_scale(t, worn, nullptr);
  EXPECT_FALSE(scale.changed);
  EXPECT_EQ(scale.error_p95_de00, 0);
}

// Each damage is told in one sentence that names the part or the number.
TEST(TransportFile, DamagedIsRefusedByName) {
  const auto refused = [](const std::function<void(image::AovFile&)>& damage) {
    image::AovFile file = kept().file;
    damage(file);
    const auto read = transport_of(file);
    return read.ok() ? std::string("read") : read.error().message;
  };
  const auto layer = [](image::AovFile& file, const char* name) {
    return std::ranges::find(file.layers, name, &image::ImagePart::name);
  };
  EXPECT_NE(refused([&](auto& file) {
              file.layers.erase(layer(file, "direct-flake-001"));
            }).find("it lacks the part direct-flake-001: render it again with --aov transport"),
            std::string::npos);
  EXPECT_NE(refused([&](auto& file) { file.layers.erase(layer(file, "bounced-mirror")); }).find("bounced-mirror"),
            std::string::npos);
  EXPECT_NE(refused([&](auto& file) { layer(file, "direct-mirror")->image.width = 10; }).find("10 x 15 pixels"),
            std::string::npos);
  EXPECT_NE(refused([&](auto& file) { layer(file, "bounced-probes")->image.data.pop_back(); }).find("bounced-probes"),
            std::string::npos);
  EXPECT_NE(refused([&](auto& file) {
              layer(file, "bounced-class-000")->image.channel_names[0] = "X";
            }).find("bounced-class-000 lacks the channel"),
            std::string::npos);
  // Other channels, and colors that a program has converted, were taken for red, green and blue of Rec.2020.
  EXPECT_NE(refused([&](auto& file) {
              layer(file, "direct-mirror")->image.channel_names[2] = "Z";
            }).find("direct-mirror lacks the channel B"),
            std::string::npos);
  EXPECT_NE(refused([&](auto& file) {
              layer(file, "bounced-mirror")->attributes["colorInteropID"] = "lin_rec709_scene";
            }).find("colorInteropID of its part bounced-mirror is \"lin_rec709_scene\", not \"lin_rec2020_scene\""),
            std::string::npos);
  EXPECT_NE(refused([](auto& file) { file.transport.resize(file.transport.size() / 2); }).find("no JSON object"),
            std::string::npos);
  EXPECT_NE(refused([](auto& file) {
              file.transport = R"({"version":3})";
            }).find("its transport is of version 3, and this program reads 1 and 2"),
            std::string::npos);
  EXPECT_NE(refused([](auto& file) {
              file.image.data[std::ranges::find(file.image.data, 6.0F) - file.image.data.begin()] = 9;
            }).find("shows part 9, and the transport knows 6"),
            std::string::npos);
  EXPECT_NE(refused([](auto& file) {
              file.transport.replace(file.transport.find("\"samples\":4"), 11, "\"samples\":5");
            }).find("its exponents, bounces, samples or white"),
            std::string::npos);
  // Another basis.
  EXPECT_NE(refused([](auto& file) {
              const auto at = file.transport.find("200.0");
              file.transport.replace(at, 5, "200.0,300.0");
            }).find("a paint has 8 weights for 10 columns"),
            std::string::npos);
  EXPECT_EQ(refused([](auto&) {}), "read");
}

// Files that were written before a transport told its samples hold the light of the pixel centers.
TEST(TransportFile, WithoutASampleCountIsThatOfTheCenters) {
  image::AovFile file = kept().file;
  const std::string told = "\"samples\":4,";
  file.transport.erase(file.transport.find(told), told.size());
  const auto read = transport_of(file);
  ASSERT_TRUE(read.ok()) << read.error().message;
  EXPECT_EQ((*read)->samples, 1);
}

}  // namespace
}  // namespace goniochrome::render::transport_file_test
