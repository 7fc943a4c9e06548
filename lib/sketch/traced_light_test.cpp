// The light under pixels, of a transport that is written by hand from light that is known.
#include "sketch/traced_light.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>

#include "base/angles.h"
#include "brdf/lobe_model.h"
#include "render/gbuffer.h"
#include "render/light_transport.h"
#include "sketch/pick.h"
#include "sketch/sketch_light.h"

namespace goniochrome::sketch::traced_light_test {
namespace {

using testing::HasSubstr;

const std::vector<double> kExponents = {3, 20, 200};
constexpr double kWhite = 2;  // luminance of the scene's white diffuser, so that units show

// The light of the diffuse column at a pixel, and the part of it in each flake column.
struct Lit {
  color::Rgb diffuse;
  std::vector<double> shares;
};

std::vector<double> of_lamp(double aspecular_deg) {
  std::vector<double> shares;
  for (const double e : kExponents) shares.push_back(std::pow(std::cos(aspecular_deg * kDegree), e));
  return shares;
}
// The light of an even hemisphere seen from above: the integral of cos^(E+1) is 2 pi/(E + 2), that of the cosine is pi.
std::vector<double> of_even_light() {
  std::vector<double> shares;
  for (const double e : kExponents) shares.push_back(2 / (e + 2));
  return shares;
}

// `floor`: what the last pixel shows wears these weights and is no part of the mesh.
image::AovFile buffers_of(const std::vector<Lit>& pixels, const std::optional<color::Rgb>& floor = {}, int samples = 1,
                          double coat_index = paint::kNoCoat) {
  render::LobeTransport t;
  t.width = static_cast<int>(pixels.size()), t.height = 1, t.samples = samples;
  t.columns.exponents = kExponents;
  t.worn.groups = {{0}, 1};
  t.worn.weights = {std::vector<color::Rgb>(t.columns.count(), color::Rgb{0.1, 0.1, 0.1})};
  t.worn.brushed.resize(1), t.worn.coats = {coat_index}, t.worn.emission.resize(1);
  if (floor) {
    t.worn.groups = {{0, 1}, 2}, t.worn.has_floor = true, t.worn.coats.push_back(paint::kNoCoat);
    t.worn.weights.emplace_back(t.columns.count());
    t.worn.weights.back().front() = *floor;
  }
  t.white_luminance = kWhite;
  for (std::uint32_t i = 0; i < pixels.size(); ++i)
    t.places.push_back(i), t.part.push_back(0), t.noise_de00.push_back(0);
  t.make_room();
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const auto put = [&](std::size_t column, double share) {
      for (std::size_t c = 0; c < 3; ++c)
        t.direct[column][3 * i + c] = static_cast<float>(share * pixels[i].diffuse[static_cast<int>(c)]);
    };
    put(render::LobeColumns::diffuse(), 1);
    for (std::size_t lobe = 0; lobe < kExponents.size(); ++lobe)
      put(render::LobeColumns::flake(lobe), pixels[i].shares[lobe]);
    if (coat_index != paint::kNoCoat) put(t.columns.mirror(), 0.3);
  }
  const render::TransportParts parts = render::transport_parts(t);
  image::AovFile file;
  file.path = "view.exr";
  file.image = {t.width, 1, 1, std::vector<float>(pixels.size(), 1.0F), {"part"}};
  if (floor) file.image.data.back() = 2;
  file.transport = parts.header;
  file.layer = [layers = parts.parts](const std::string& name, image::ImagePart& part) -> Result<bool> {
    const auto found = std::ranges::find(layers, name, &image::ImagePart::name);
    if (found == layers.end()) return false;
    part = *found;
    return true;
  };
  file.reflection = color::component_wise();
  return file;
}

// Light in halves errs by up to 2^-11 of itself, which near 25 deg moves the angle by less than 0.1 deg.
TEST(TracedLight, TheAngleIsThatOfALampAndBetweenFaceAndFlopInEvenLight) {
  const image::AovFile file = buffers_of(
      {{{1, 1, 1}, of_lamp(25)}, {{0.5, 0.4, 0.2}, of_lamp(60)}, {{3, 3, 3}, of_even_light()}, {{}, of_lamp(9)}});
  const auto light = TracedLight::of(file);
  ASSERT_TRUE(light.ok()) << light.error().message;
  EXPECT_NEAR(light->aspecular_deg(0, 0).value(), 25, 0.1);
  EXPECT_NEAR(light->aspecular_deg(1, 0).value(), 60, 0.1);
  // (cos^3 - 0.4)^2 + (cos^20 - 1/11)^2 + (cos^200 - 1/101)^2 has its root about cos^3 = 0.4 and cos^20 = 0.09, which
  // are 42.5 and 27.5 deg. The wide lobe falls slowly, so that the least squares lie between the two.
  EXPECT_GT(light->aspecular_deg(2, 0).value(), 27.5);
  EXPECT_LT(light->aspecular_deg(2, 0).value(), 42.5);
  EXPECT_FALSE(light->aspecular_deg(3, 0).has_value()) << "no light";
  EXPECT_FALSE(light->aspecular_deg(4, 0).has_value()) << "outside";
  image::AovFile none = file;
  none.transport.clear(), none.layer = {};
  EXPECT_THAT(TracedLight::of(none).error().message, HasSubstr("view.exr: holds no light that was traced"));
}

// A matt surface in full light, in a twentieth of it, and in light of another color: the color found is its own. The
// tolerance is that of halves, 2^-11 of the light, which is 0.02 in L* and at most 0.2 in chroma. Without the light
// (control) the pixel in the shadow is a darker paint.
TEST(TracedLight, ADropperInAShadowFindsThePaintOfTheSurface) {
  const color::Rgb reflectance{0.4, 0.2, 0.1};
  for (const color::ReflectionOperator& reflection : {color::component_wise(), color::iso_rgb_operator()}) {
    const double bright = kPi * kWhite;
    image::AovFile file = buffers_of({{{bright, bright, bright}, of_lamp(40)},
                                      {{bright / 20, bright / 20, bright / 20}, of_lamp(40)},
                                      {{bright, 0.6 * bright, 0.3 * bright}, of_lamp(40)}});
    file.reflection = reflection;
    const auto traced = TracedLight::of(file);
    ASSERT_TRUE(traced.ok()) << traced.error().message;
    constexpr double kStops = 1.5;
    image::ImagePart picture;
    picture.image = {3, 1, 3, {}, {"R", "G", "B"}};
    picture.attributes["colorInteropID"] = std::string("lin_rec2020_scene");
    for (const color::Rgb& light :
         {color::Rgb{kWhite, kWhite, kWhite}, (kWhite / 20) * color::Rgb{1, 1, 1}, kWhite * color::Rgb{1, 0.6, 0.3}}) {
      const color::Rgb shown = std::exp2(kStops) * color::reflected(reflection, reflectance, light);
      for (int c = 0; c < 3; ++c) picture.image.data.push_back(static_cast<float>(shown[c]));
    }
    const PickLight light{&*traced, std::exp2(-kStops), 1};
    const color::Lab truth = color::lab_from_rgb(reflectance, *color::white_point({}));
    for (int x = 0; x < 3; ++x) {
      const auto sample = pick(picture, "p.exr", {"p.exr", x, 0, 0}, &light);
      ASSERT_TRUE(sample.ok()) << sample.error().message;
      EXPECT_TRUE(sample->lit);
      EXPECT_LT(color::delta_e_76(sample->lab, truth), 0.2) << x;
    }
    const auto shadow = pick(picture, "p.exr", {"p.exr", 1, 0, 0});
    ASSERT_TRUE(shadow.ok());
    EXPECT_FALSE(shadow->lit);
    EXPECT_GT(color::delta_e_76(shadow->lab, truth), 5) << "the control must fail";
  }
}

// Light that bends from pixel to pixel, and its mean over the samples of a pixel, which are taken from the function
// itself: those of the picture and of the transport may be as many, or more or fewer. The control: the light as it is
// kept.
TEST(SketchTransport, APictureOfOtherSamplesThanTheTransportShowsTheirMean) {
  const auto bent = [](double x) { return 1 + 2 * (x - 3) * (x - 3); };  // relative to white
  const auto mean = [&](double x, int samples) {
    double sum = 0;
    for (const auto& shift : render::sample_shifts(samples)) sum += bent(x + shift[0]) / samples;
    return sum;
  };
  for (const int kept : {1, 4}) {
    std::vector<Lit> row;
    for (int x = 0; x < 7; ++x) row.push_back({kWhite * mean(x, kept) * color::Rgb{1, 0.5, 0.25}, of_even_light()});
    const auto transport = SketchTransport::of(buffers_of(row, {}, kept));
    ASSERT_TRUE(transport.ok() && transport->has_value());
    std::vector<Vec3> columns(2 * kExponents.size() + 2);
    for (const int samples : {1, 4, 16})
      for (const std::uint32_t place : {2U, 3U, 4U}) {
        const double wanted = mean(place, samples);
        (*transport)->light(samples, (*transport)->coat_index()).shade(place, columns.data());
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(columns[0][c], wanted * std::pow(0.5, c), 2e-3 * wanted) << place;
        if ((samples == 1) != (kept == 1)) {
          EXPECT_GT(std::abs(wanted - mean(place, kept)), 0.1) << "the control must fail";
        }
      }
  }
}

// Seen at 70 deg, under the coat that light was traced through and under another. The light of the base that falls in
// from 45 deg is exact, as the image is. The control: the light as it is kept.
TEST(SketchTransport, ShowsWhatAnotherCoatLeavesOfLight) {
  constexpr double kTraced = 1.5, kOther = 1.53;
  image::AovFile file = buffers_of({{{1, 1, 1}, of_lamp(40)}}, {}, 1, kTraced);
  const double c = std::cos(70 * kDegree), s = std::sin(70 * kDegree);
  file.image = {
      1, 1, 4, {1, 0, static_cast<float>(s), static_cast<float>(c)}, {"part", "normal.X", "normal.Y", "normal.Z"}};
  file.has_rays = true, file.corner = {-0.5, -0.5, -1}, file.right = {1, 0, 0}, file.down = {0, 1, 0};
  const auto transport = SketchTransport::of(file);
  ASSERT_TRUE(transport.ok() && transport->has_value());
  ASSERT_EQ((*transport)->coat_index(), kTraced);
  const auto light = [&](double index) {
    std::vector<Vec3> columns(2 * kExponents.size() + 2);
    const SketchLight of_coat = (*transport)->light(1, index);
    EXPECT_EQ(of_coat.coat_index, index);
    of_coat.shade(0, columns.data());
    return columns;
  };
  const std::vector<Vec3> traced = light(kTraced), other = light(kOther);
  const double let_out = brdf::coat_passages(kOther, std::cos(45 * kDegree), c) /
                         brdf::coat_passages(kTraced, std::cos(45 * kDegree), c),
               image = brdf::fresnel_dielectric(c, kOther) / brdf::fresnel_dielectric(c, kTraced);
  EXPECT_LT(let_out, 0.99) << "the control must fail";
  EXPECT_GT(image, 1.02) << "the control must fail";
  for (std::size_t k = 0; k < traced.size(); ++k) {
    const bool gloss = k > 0 && k % 2 == 0 && k + 1 < traced.size();
    const double change = k + 1 == traced.size() ? image : gloss ? 1 : let_out;
    EXPECT_NEAR(other[k].y, change * traced[k].y, 1e-6) << k;
  }
}

// A floor that shows the environment wears no paint, which the weights of a file tell. The control: a floor of paint.
TEST(TracedLight, AFloorThatShowsTheEnvironmentHasNoPaintToPick) {
  const std::vector<Lit> row = {{{1, 1, 1}, of_lamp(25)}, {{1, 1, 1}, of_lamp(40)}};
  const auto shown = TracedLight::of(buffers_of(row, color::Rgb{1, 1, 1})),
             painted = TracedLight::of(buffers_of(row, color::Rgb{0.1, 0.1, 0.1}));
  ASSERT_TRUE(shown.ok()) << shown.error().message;
  ASSERT_TRUE(painted.ok()) << painted.error().message;
  EXPECT_TRUE(shown->shows_floor(1, 0));
  EXPECT_FALSE(shown->diffusers(1, 0).has_value());
  EXPECT_FALSE(shown->aspecular_deg(1, 0).has_value());
  EXPECT_FALSE(shown->shows_floor(0, 0));
  EXPECT_TRUE(shown->diffusers(0, 0).has_value());
  EXPECT_FALSE(shown->shows_floor(2, 0)) << "outside";
  EXPECT_FALSE(painted->shows_floor(1, 0)) << "the control";
  EXPECT_TRUE(painted->diffusers(1, 0).has_value());
}

// The paint of buffers_of() has the weight .1 in every column, which get the light once and by their shares. The
// tolerance is that of halves.
TEST(SketchTransport, TheWornPictureIsTheLightTimesTheWeights) {
  const color::Rgb light{3, 2, 1};
  for (const color::ReflectionOperator& reflection : {color::component_wise(), color::iso_rgb_operator()}) {
    image::AovFile file = buffers_of({{light, of_lamp(25)}, {{}, of_lamp(40)}});
    file.reflection = reflection;
    const auto transport = SketchTransport::of(file);
    ASSERT_TRUE(transport.ok() && transport->has_value());
    const image::Image shown = (*transport)->worn_picture();
    double share = 1;
    for (const double of_lobe : of_lamp(25)) share += of_lobe;
    const color::Rgb truth = color::reflected(reflection, {0.1, 0.1, 0.1}, share * light);
    ASSERT_EQ(shown.width, 2);
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(shown.pixel(0, 0)[c], truth[c], 1e-3 * truth[c]);
      EXPECT_EQ(shown.pixel(1, 0)[c], 0);
    }
    EXPECT_EQ(shown.pixel(0, 0)[3], 1);
  }
}

TEST(TracedLight, APictureOfAnotherSizeAndAPixelWithoutLightAreRefused) {
  const image::AovFile file = buffers_of({{{1, 1, 1}, of_lamp(40)}, {{}, of_lamp(40)}});
  const auto traced = TracedLight::of(file);
  ASSERT_TRUE(traced.ok());
  const PickLight light{&*traced, 1, 1};
  image::ImagePart picture;
  picture.image = {2, 1, 3, std::vector<float>(6, 0.5F), {"R", "G", "B"}};
  picture.attributes["colorInteropID"] = std::string("lin_rec2020_scene");
  EXPECT_TRUE(pick(picture, "p.exr", {"p.exr", 0, 0, 0}, &light).ok());
  EXPECT_THAT(pick(picture, "p.exr", {"p.exr", 1, 0, 0}, &light).error().message, HasSubstr("get no light"));
  picture.image = {3, 1, 3, std::vector<float>(9, 0.5F), {"R", "G", "B"}};
  EXPECT_THAT(pick(picture, "p.exr", {"p.exr", 0, 0, 0}, &light).error().message,
              HasSubstr("has 3 x 1 pixels, and the light was traced for 2 x 1"));
}

}  // namespace
}  // namespace goniochrome::sketch::traced_light_test
