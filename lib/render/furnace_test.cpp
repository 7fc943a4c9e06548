// A furnace: under an even sky of 1, nothing that reflects at most what it gets shows more than 1. Every paint of
// testdata/ by every engine.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <optional>
#include <string>

#include "base/testdata_for_test.h"
#include "brdf/lobe_model.h"
#include "envmap/block_tree.h"
#include "fit/color_map_fit.h"
#include "fit/paint_fit.h"
#include "fit/tilt_fit.h"
#include "formats/paint_source.h"
#include "render/renderer.h"
#include "render/scenes_for_test.h"

namespace goniochrome::render::furnace_test {
namespace {

const formats::Basis& basis() {
  static const formats::Basis read = *formats::read_basis(testdata("b7.basis.xml"));
  return read;
}

struct Worn {
  std::string name;
  paint::LobeFit lobes;
  std::optional<brdf::ColorMap> map = {};
};

// The fits of fit-paint: those of paints.paints.xml, those of rooms.paints.xml, which have lobes, and those of
// travel.paints.xml with their color maps and tilted lobes.
const std::vector<Worn>& all_paints() {
  static const std::vector<Worn> all = [] {
    std::vector<Worn> worn;
    const fit::PaintFitter fitter(basis(), {});
    for (const char* file : {"paints.paints.xml", "rooms.paints.xml", "travel.paints.xml"}) {
      const std::vector<paint::Paint> paints = *formats::read_paints(testdata(file));
      for (const paint::Paint& paint : paints) {
        worn.push_back({paint.name, paint.lobes ? *paint.lobes : fitter.fit(paint)->lobes});
        if (file != std::string("travel.paints.xml")) continue;
        worn.back().map = fit::fit_color_map(*paint.measurement, {.size = 64})->map;
        fit::TiltOptions options;
        options.lookups = {8};
        worn.back().lobes.tilts = fit::fit_tilts(*worn.back().map, worn.back().lobes, basis(), options).sets;
      }
    }
    return worn;
  }();
  return all;
}

// The brightest channel of a pixel of a ball in that paint.
double brightest(const EngineInfo& engine, const Worn& worn, const envmap::BlockTree& sky) {
  std::vector<double> exponents = basis().exponents;
  for (const paint::Lobe& lobe : worn.lobes.lobes)
    if (!lobe.is_mirror() && std::ranges::find(exponents, lobe.exponent) == exponents.end())
      exponents.push_back(lobe.exponent);
  std::ranges::sort(exponents);
  const envmap::PrefilteredEnvironment env = constant_env({1, 1, 1}, exponents);
  const mesh::Mesh mesh = sphere_mesh(48);
  Scene scene;
  scene.mesh = &mesh, scene.env = &env, scene.texels = &sky, scene.gloss_deg = {60}, scene.paints = {worn.lobes};
  std::optional<SurfaceLayer> layer;
  if (worn.map) layer.emplace(scene, std::vector<PartSurface>{{{}, &*worn.map}}, brdf::CriticalAngle::kSlide);
  if (layer) scene.layer = &*layer;
  auto renderer = Renderer::create();
  EXPECT_TRUE(renderer.ok() && renderer->load(scene, engine.name).ok()) << engine.name << " " << worn.name;
  const View view{Camera::orbit(mesh, 30, 20, 1, 30, 1), 24, 24, 1, false};
  Frame frame;
  EXPECT_TRUE(renderer->draw(view, frame).ok()) << engine.name << " " << worn.name;
  double most = 0;
  for (int y = 0; y < view.height; ++y)
    for (int x = 0; x < view.width; ++x)
      if (frame.gbuffer->part(x, y) >= 0)
        for (int c = 0; c < 3; ++c) most = std::max(most, static_cast<double>(frame.picture.pixel(x, y)[c]));
  return most;
}

// Prefiltered engines draw the coat by straight pieces, 2e-3; paths have noise. The control is the textbook form of the
// coat, which adds light and takes none away.
TEST(Furnace, NoPixelOfAnyPaintByAnyEngineIsBrighterThanTheSky) {
  image::Image image{64, 32, 3, std::vector<float>(64UL * 32 * 3, 1.0F), {}};
  const envmap::Environment even =
      *envmap::Environment::from_lat_long(std::move(image), envmap::Environment::BadPixels::kError, "even");
  const envmap::BlockTree sky{even};
  ASSERT_EQ(all_paints().size(), 80U);
  for (const EngineInfo* engine : engines()) {
    const bool is_exact = engine->needs_texels || engine->needs_mesh;
    double most = 0;
    for (const Worn& worn : all_paints()) {
      if (engine->needs_opengl && worn.map) continue;  // tilted lobes, which that engine refuses
      const double here = brightest(*engine, worn, sky);
      EXPECT_LE(here, 1 + (is_exact ? 5e-3 : 2e-3)) << engine->name << " " << worn.name;
      most = std::max(most, here);
    }
    const Worn textbook{"textbook", brdf::under_coat(all_paints().front().lobes, paint::kNoCoat)};
    EXPECT_GT(brightest(*engine, textbook, sky), 1.02) << engine->name;
    std::printf("%-9s largest %.4f\n", engine->name, most);
  }
}

}  // namespace
}  // namespace goniochrome::render::furnace_test
