// Pictures are equal whatever draws them: OSMesa, EGL's software, a GPU, and the processor.
#include <gtest/gtest.h>

#include <cmath>

#include "base/testdata_for_test.h"
#include "render/renderer.h"
#include "render/scenes_for_test.h"

namespace goniochrome::render::gl_drivers_test {
namespace {

// Half of a unit in the last place of a half float of this value. Halves have 11 bits, and none is smaller than 2^-24.
double half_unit(double value) {
  int exponent = 0;
  std::frexp(value, &exponent);
  return std::ldexp(0.5, std::max(exponent - 11, -24));
}

// A bare shape of many facets in paints of every kind of lobe, under an environment that changes fast and two lamps.
struct World {
  mesh::Mesh mesh = *mesh::read_mesh(testdata("speed-shape.obj"));
  envmap::PrefilteredEnvironment env = uneven_env({1.3, 6, 40, 300, 3000}, {32, 20, 44, 100, 64});
  Scene scene;
  View view{Camera::orbit(mesh, 35, 12, 1, 30, 1.5), 240, 160, 1, false};

  World() {
    scene.mesh = &mesh, scene.env = &env;
    scene.paints.assign(mesh.parts.size(), rich_paint());
    scene.lights = {{normalized({1, 2, 3}), {1, 0.9, 0.7}}, {normalized({-3, 1, 2.5}), {0.4, 0.1, 0.6}}};
    scene.background = Background::kEnvironment;
  }
};

Frame drawn(Renderer& renderer, const World& world, const std::string& engine) {
  Frame frame;
  const auto loaded = renderer.load(world.scene, engine);
  EXPECT_TRUE(loaded.ok()) << loaded.error().message;
  const auto done = renderer.draw(world.view, frame);
  EXPECT_TRUE(done.ok()) << done.error().message;
  return frame;
}

struct Difference {
  double units = 0;            // of half a unit of a half float, the largest
  std::size_t beyond = 0;      // channels of pixels that differ by more than that
  std::size_t other_face = 0;  // pixels that show another triangle, or nothing
  std::size_t pixels = 0;      // that show the same
};

Difference difference(const Frame& a, const Frame& b) {
  Difference of;
  const Gbuffer &seen = *a.gbuffer, &other = *b.gbuffer;
  for (int y = 0; y < seen.height; ++y) {
    for (int x = 0; x < seen.width; ++x) {
      if (seen.triangles[seen.index(x, y)] != other.triangles[other.index(x, y)]) {
        ++of.other_face;
        continue;
      }
      ++of.pixels;
      for (int c = 0; c < 4; ++c) {
        const double one = a.picture.pixel(x, y)[c], two = b.picture.pixel(x, y)[c];
        const double units = std::abs(one - two) / half_unit(std::max(std::abs(one), std::abs(two)));
        of.units = std::max(of.units, units);
        of.beyond += units > 1 ? 1 : 0;
      }
    }
  }
  return of;
}

constexpr std::pair<OpenGlBy, const char*> kAll[] = {
    {OpenGlBy::kOsmesa, "OSMesa"}, {OpenGlBy::kEgl, "EGL"}, {OpenGlBy::kGpu, "GPU"}};

class Drivers : public testing::TestWithParam<std::pair<OpenGlBy, const char*>> {
 protected:
  void SetUp() override {
    auto made = Renderer::create(GetParam().first);
    if (!made.ok()) GTEST_SKIP() << GetParam().second << ": " << made.error().message;
    renderer_.emplace(*std::move(made));
    RecordProperty("renderer", renderer_->opengl());
  }
  std::optional<Renderer> renderer_;
};

TEST_P(Drivers, TellTheirNames) {
  EXPECT_NE(renderer_->opengl(), "");
  EXPECT_EQ(renderer_->opengl_library(), GetParam().first == OpenGlBy::kOsmesa ? "OSMesa" : "EGL");
}

// One G-buffer, shaded by OpenGL and on the processor.
TEST_P(Drivers, ShadeAsTheProcessor) {
  const World world;
  const Frame gl = drawn(*renderer_, world, "gl"), cpu = drawn(*renderer_, world, "cpu");
  const Difference of = difference(gl, cpu);
  EXPECT_EQ(of.other_face, 0U);
  EXPECT_LE(of.units, 1) << of.beyond << " values";
  // The control: the shape turned by 1/100 of a degree.
  World turned;
  turned.view.camera = Camera::orbit(turned.mesh, 35.01, 12, 1, 30, 1.5);
  EXPECT_GT(difference(gl, drawn(*renderer_, turned, "gl")).units, 10);
}

INSTANTIATE_TEST_SUITE_P(Each, Drivers, testing::ValuesIn(kAll), [](const auto& of) { return of.param.second; });

// Software is the same software: every bit.
TEST(SoftwareDrivers, AgreeInEveryBit) {
  auto osmesa = Renderer::create(OpenGlBy::kOsmesa), egl = Renderer::create(OpenGlBy::kEgl);
  if (!osmesa.ok()) GTEST_SKIP() << "OSMesa: " << osmesa.error().message;
  if (!egl.ok()) GTEST_SKIP() << "EGL: " << egl.error().message;
  if (osmesa->opengl() != egl->opengl()) GTEST_SKIP() << osmesa->opengl() << " and " << egl->opengl();
  const World world;
  const Frame one = drawn(*osmesa, world, "gl"), two = drawn(*egl, world, "gl");
  EXPECT_EQ(one.gbuffer->data, two.gbuffer->data);
  EXPECT_EQ(one.picture.data, two.picture.data);
}

}  // namespace
}  // namespace goniochrome::render::gl_drivers_test
