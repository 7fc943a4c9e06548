// A transport written and read back, shaded, and damaged.
#include "render/path/transport_file.h"

#include <gtest/gtest.h>

#include <array>
#include <functional>

#include "image/exr.h"
#include "render/internal/seen.h"
#include "render/path/shown_paints.h"
#include "render/path/transport_shading.h"
#include "render/path/transport_stage_for_test.h"

namespace goniochrome::render::transport_file_test {
namespace {

using namespace transport_stage;

constexpr double kWhite = 2.5;  // luminance, so that units show

// A file whose parts can be damaged, and the names of those that were read.
struct Parts {
  image::AovFile file;
  std::vector<image::ImagePart> layers;
  std::vector<std::string> read = {};

  void serve() {
    file.layer = [this](const std::string& name, image::ImagePart& part) -> Result<bool> {
      const auto found = std::ranges::find(layers, name, &image::ImagePart::name);
      if (found == layers.end()) return false;
      read.push_back(name), part = *found;
      return true;
    };
  }
  image::ImagePart& layer(const std::string& name) { return *std::ranges::find(layers, name, &image::ImagePart::name); }
};

struct Kept {
  paint::LobeFit cup, ball;
  TracedLobes traced;
  image::AovFile file;
  Parts parts;
};

std::string written(const LobeTransport& t, const std::string& name) {
  TransportParts parts = transport_parts(t);
  std::string path = ::testing::TempDir() + name;
  std::vector<float> pixels(static_cast<std::size_t>(t.width) * static_cast<std::size_t>(t.height), 0.0F);
  for (std::size_t i = 0; i < t.places.size(); ++i) pixels[t.places[i]] = static_cast<float>(t.part[i] + 1);
  std::vector<image::ImagePart> all = {
      {"picture", {t.width, t.height, 1, pixels, {"part"}}, {}, image::PixelType::kFloat}};
  all.front().attributes[kTransportAttribute] = parts.header;
  all.insert(all.end(), parts.parts.begin(), parts.parts.end());
  EXPECT_TRUE(image::write_exr(path, all).ok());
  return path;
}

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
    const std::string path = written(k.traced.transport, "transport_file_test.exr");
    k.file = *image::read_aov_file(path);
    k.parts = {k.file, *image::read_exr(path)};
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
  const auto refused_parts = [](const std::function<void(Parts&)>& damage) {
    Parts parts = kept().parts;
    damage(parts);
    parts.serve();
    const auto read = transport_of(parts.file);
    return read.ok() ? std::string("read") : read.error().message;
  };
  const auto refused = [&](const std::function<void(image::AovFile&)>& damage) {
    return refused_parts([&](Parts& parts) { damage(parts.file); });
  };
  EXPECT_NE(refused_parts([](auto& parts) {
              parts.layer("direct-flake-001").name = "other";
            }).find("it lacks the part direct-flake-001: render it again with --aov transport"),
            std::string::npos);
  EXPECT_NE(refused_parts([](auto& parts) { parts.layer("bounced-mirror").name = "other"; }).find("bounced-mirror"),
            std::string::npos);
  EXPECT_NE(refused_parts([](auto& parts) { parts.layer("direct-mirror").left = 19; }).find("pixels from 19,"),
            std::string::npos);
  EXPECT_NE(refused_parts([](auto& parts) { parts.layer("direct-mirror").top = -1; }).find(",-1 on, of 3 channels"),
            std::string::npos);
  EXPECT_NE(refused_parts([](auto& parts) {
              parts.layer("direct-mirror").image.height = 3;
            }).find("its part direct-mirror has no finite value at pixel "),
            std::string::npos);
  EXPECT_NE(refused_parts([](auto& parts) {
              std::ranges::fill(parts.layer("bounced-class-000").image.data, HUGE_VALF);
            }).find("its part bounced-class-000 has no finite value at pixel "),
            std::string::npos);
  EXPECT_NE(
      refused_parts([](auto& parts) { parts.layer("bounced-probes").image.data.pop_back(); }).find("bounced-probes"),
      std::string::npos);
  EXPECT_NE(refused_parts([](auto& parts) {
              parts.layer("bounced-class-000").image.channel_names[0] = "X";
            }).find("bounced-class-000 lacks the channel"),
            std::string::npos);
  // Other channels, and colors that a program has converted, were taken for red, green and blue of Rec.2020.
  EXPECT_NE(refused_parts([](auto& parts) {
              parts.layer("direct-mirror").image.channel_names[2] = "Z";
            }).find("direct-mirror lacks the channel B"),
            std::string::npos);
  EXPECT_NE(refused_parts([](auto& parts) {
              parts.layer("bounced-mirror").attributes["colorInteropID"] = "lin_rec709_scene";
            }).find("colorInteropID of its part bounced-mirror is \"lin_rec709_scene\", not \"lin_rec2020_scene\""),
            std::string::npos);
  EXPECT_NE(refused([](auto& file) { file.transport.resize(file.transport.size() / 2); }).find("no JSON object"),
            std::string::npos);
  EXPECT_NE(refused([](auto& file) {
              file.transport = R"({"version":2})";
            }).find("its transport is of version 2, and this program reads 3: render it again with --aov transport"),
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

// A paint without some lobes shows the same without their light, and it is not read.
TEST(TransportFile, ReadsNoMoreThanPaintsWeigh) {
  Parts parts = kept().parts;
  parts.serve();
  paint::LobeFit few = kept().cup;
  few.lobes = {few.lobes[1], few.lobes.back()};
  few.lobes[0].gloss = {};
  const std::vector<PartPaint> worn(6, {&few, {}, 45, "", ""});
  const LobeTransport all = **transport_of(parts.file);
  const ShownPaints shown = *shown_paints(all.columns, all.worn, worn);
  parts.read.clear();
  LobeTransport some = **transport_points(parts.file);
  ASSERT_TRUE(read_light(parts.file, weighed_columns(shown), some).ok());
  std::vector<std::string> expected;
  for (const char* kind : {"direct-", "bounced-"})
    for (const char* column : {"diffuse", "flake-001", "mirror"}) expected.push_back(std::string(kind) + column);
  for (int group = 0; group < all.worn.groups.count; ++group)
    expected.push_back(fmt::format("bounced-class-{:03}", group));
  expected.emplace_back("bounced-probes");
  EXPECT_EQ(parts.read, expected);
  image::Image pictures[2];
  double errors[2];
  for (const bool is_some : {false, true}) {
    const LobeTransport& t = is_some ? some : all;
    const BounceScale scale = bounce_scale(t, shown.weights, nullptr);
    pictures[is_some] = {20, 15, 4, std::vector<float>(1200, 0.0F), {}};
    TransportShader(t, {}).shade(shown.paints, nullptr, scale, 2, pictures[is_some]);
    errors[is_some] = scale.error_p95_de00;
  }
  EXPECT_EQ(pictures[0].data, pictures[1].data);
  EXPECT_EQ(errors[0], errors[1]);
}

// A part of the picture shows a surface, and all around it is a floor that shows the environment.
TEST(TransportFile, KeepsOneColumnOfAFloorThatShowsTheEnvironment) {
  LobeTransport t;
  t.width = 20, t.height = 15, t.bounces = 1, t.columns.exponents = {20}, t.white_luminance = kWhite;
  const std::size_t columns = t.columns.count();
  t.worn.groups = {{0, 1}, 2};
  t.worn.weights.assign(2, std::vector<color::Rgb>(columns));
  t.worn.weights[0].assign(columns, {0.1, 0.1, 0.1}), t.worn.weights[1][LobeColumns::diffuse()] = {1, 1, 1};
  t.worn.brushed.resize(1), t.worn.emission.resize(1), t.worn.coats.assign(2, paint::kNoCoat);
  t.worn.has_floor = t.worn.floor_is_projected = true;
  for (std::uint32_t place = 0; place < 300; ++place) {
    const bool is_floor = place % 20 < 4 || place % 20 > 8 || place / 20 < 5 || place / 20 > 11;
    t.places.push_back(place), t.part.push_back(is_floor ? 1 : 0);
  }
  t.make_room();
  std::mt19937_64 random(5);
  for (std::vector<float>* of : {&t.direct[0], &t.direct[1], &t.direct[2], &t.direct[3], &t.bounced[0], &t.classes[0]})
    for (float& value : *of) value = static_cast<float>(random() % 64) / 16;
  EXPECT_EQ(t.direct[LobeColumns::diffuse()].size(), 3 * 300U);
  EXPECT_EQ(t.direct[t.columns.mirror()].size(), 3 * 35U);
  const std::string path = written(t, "transport_file_test_floor.exr");
  const std::vector<image::ImagePart> parts = *image::read_exr(path);
  for (const image::ImagePart& part : parts) {
    const bool whole = part.name == "picture" || part.name.ends_with("-diffuse");
    EXPECT_EQ((std::array{part.left, part.top, part.image.width, part.image.height}),
              whole ? (std::array{0, 0, 20, 15}) : (std::array{4, 5, 5, 7}))
        << part.name;
  }
  const LobeTransport read = **transport_of(*image::read_aov_file(path));
  ASSERT_TRUE(read.worn.floor_is_projected);
  image::Image picture{20, 15, 4, std::vector<float>(1200, 0.0F), {}};
  BounceScale scale;
  for (std::size_t k = 0; k < t.worn.groups.classes(); ++k)
    scale.of_class.emplace_back(1.0, 1.0, 0.5 * static_cast<double>(k));
  TransportShader(read, {}).shade({{{0}, {t.worn.weights[0]}}, {{0}, {t.worn.weights[1]}}}, nullptr, scale, 1, picture);
  for (std::size_t i = 0; i < t.places.size(); ++i) {
    for (std::size_t k = 0; k < columns; ++k)
      for (int c = 0; c < 3; ++c) ASSERT_NEAR(read.unit * read.light(i, k)[c], t.light(i, k)[c], 4 * 0x1p-10);
    const color::Rgb direct = t.light(i, 0, false), bounced = t.light(i, 0) - direct,
                     factor = bounce_factor(t, i, scale);
    if (t.part[i] == 1) {
      EXPECT_EQ(factor.z, 2.5) << "what came through further surfaces";
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(picture.data[4 * i + static_cast<std::size_t>(c)], direct[c] + factor[c] * bounced[c], 0.02);
    }
  }
}

}  // namespace
}  // namespace goniochrome::render::transport_file_test
