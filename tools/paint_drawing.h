// Small pictures of paints for pages: on a mesh under an environment, or on a ball under two lamps where neither is
// given.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "base/angles.h"
#include "display/display.h"
#include "envmap/prefiltered.h"
#include "fit/paint_fit.h"
#include "formats/default_basis.h"
#include "render/effect_union.h"
#include "render/renderer.h"
#include "render/scene_effects.h"
#include "render/trim.h"

namespace goniochrome::tool {

struct DrawingSetup {
  std::string mesh, env, basis;  // files; "" where there is none
  int width = 640, height = 320;
};

// Draws one paint after another.
class PaintDrawing {
 public:
  static Result<PaintDrawing> make(const DrawingSetup& setup);

  Result<image::Image> image(const paint::Paint& paint);
  Result<std::string> png(const paint::Paint& paint);
  // A picture whose left half is that of `left`, which image() gave, and whose right half shows the paint.
  Result<std::string> split_png(image::Image left, const paint::Paint& right);

  // Statements of the mesh file that the reader does not understand.
  const std::vector<std::string>& remarks() const { return state_->mesh.remarks; }
  // "on car.obj under studio.env.exr"
  const std::string& described() const { return state_->description; }

 private:
  // The scene points to the members beside it, which stay in place.
  struct State {
    DrawingSetup setup;
    std::string description;
    mesh::Mesh mesh;
    envmap::PrefilteredEnvironment env;
    std::optional<fit::PaintFitter> fitter;
    std::optional<render::Renderer> renderer;
    std::optional<display::Display> display;
    render::Scene scene;
    std::optional<render::Effects> loaded;  // what all paints so far call for
    double stops = 0;
  };
  explicit PaintDrawing(std::unique_ptr<State> state) : state_(std::move(state)) {}

  static mesh::Mesh ball();
  static formats::Basis basis_of(const envmap::PrefilteredEnvironment& env);
  static Result<formats::Basis> light(State& state);

  std::unique_ptr<State> state_;
};

// A unit ball: the simplest body that shows face and flop at once.
inline mesh::Mesh PaintDrawing::ball() {
  constexpr std::uint32_t kRings = 96, kSegments = 192;
  mesh::Mesh mesh;
  for (std::uint32_t ring = 0; ring <= kRings; ++ring)
    for (std::uint32_t segment = 0; segment <= kSegments; ++segment) {
      const double t = kPi * ring / kRings, p = 2 * kPi * segment / kSegments;
      mesh.positions.push_back({std::sin(t) * std::sin(p), std::cos(t), std::sin(t) * std::cos(p)});
    }
  mesh.normals = mesh.positions;
  for (std::uint32_t ring = 0; ring < kRings; ++ring)
    for (std::uint32_t segment = 0; segment < kSegments; ++segment) {
      const std::uint32_t a = ring * (kSegments + 1) + segment, b = a + kSegments + 1;
      mesh.triangles.push_back({a, b, a + 1});
      mesh.triangles.push_back({a + 1, b, b + 1});
    }
  mesh.parts.push_back({"Ball", "", 0, mesh.triangles.size()});
  return mesh;
}

inline formats::Basis PaintDrawing::basis_of(const envmap::PrefilteredEnvironment& env) {
  formats::Basis basis;
  basis.name = "environment", basis.mirror = env.mirror.map.size > 0;
  for (const envmap::PrefilteredLobe& lobe : env.lobes) basis.exponents.push_back(lobe.exponent);
  return basis;
}

// Puts the light into the scene and returns the lobes that paints are drawn with in it.
inline Result<formats::Basis> PaintDrawing::light(State& state) {
  if (!state.setup.env.empty()) {
    GONIO_ASSIGN(state.env, envmap::read_env(state.setup.env));
    state.scene.env = &state.env;
    return basis_of(state.env);
  }
  // The lamps are as wide as those of half a meter five meters away, so that gloss shows in a small picture.
  constexpr double kRadius_rad = 0.05;
  state.scene.lights = {{render::orbit_direction(25, 45), {1, 1, 1}, kRadius_rad},
                        {render::orbit_direction(-60, 20), {0.35, 0.35, 0.35}, kRadius_rad}};
  return formats::basis_or_default(state.setup.basis);
}

inline Result<PaintDrawing> PaintDrawing::make(const DrawingSetup& setup) {
  auto state = std::make_unique<State>();
  state->setup = setup;
  state->mesh = ball();
  if (!setup.mesh.empty()) {
    GONIO_ASSIGN(state->mesh, mesh::read_mesh(setup.mesh));
  }
  GONIO_ASSIGN(const formats::Basis basis, light(*state));
  const auto file = [](const std::string& path) { return std::filesystem::path(path).filename().string(); };
  state->description = fmt::format("on {} under {}", setup.mesh.empty() ? "a ball" : file(setup.mesh),
                                   setup.env.empty() ? "two lamps" : file(setup.env));
  state->fitter.emplace(basis, fit::FitOptions{});
  render::Renderer renderer = render::Renderer::tracing();
  state->renderer.emplace(std::move(renderer));
  GONIO_ASSIGN(display::Display display, display::Display::make(""));
  state->display.emplace(std::move(display));
  state->scene.mesh = &state->mesh;
  state->scene.background = render::Background::kColor;
  constexpr double kBackdrop = 0.3;
  const double white = render::diffuse_white(state->scene.env, state->scene.lights).luminance;
  state->stops = white > 0 ? -std::log2(white) : 0;
  const double gray = kBackdrop * (white > 0 ? white : 1);
  state->scene.background_color = {gray, gray, gray};
  return PaintDrawing(std::move(state));
}

inline Result<image::Image> PaintDrawing::image(const paint::Paint& paint) {
  constexpr int kSamples = 4;
  constexpr double kDistance = 0.87;  // of the camera; at 1 a mesh just fits from every side
  State& s = *state_;
  GONIO_ASSIGN(const fit::PaintFit fit, s.fitter->fit(paint));
  s.scene.paints.assign(s.mesh.parts.size(), fit.lobes);
  const bool with_mirror = s.scene.env != nullptr && s.env.mirror.map.size > 0;
  for (std::size_t part = 0; part < s.mesh.parts.size(); ++part) {
    if (const auto trim = render::trim_of(s.mesh.parts[part], with_mirror)) s.scene.paints[part] = *trim;
  }
  const render::Effects wanted = render::effects_of(s.scene);
  if (s.loaded && render::covers(*s.loaded, wanted)) {
    s.renderer->load_paints(s.scene);
  } else {
    s.loaded = s.loaded ? render::united(*s.loaded, wanted) : wanted;
    GONIO_TRY(s.renderer->load(s.scene, *s.loaded, "cpu"));
  }
  const render::Camera camera =
      render::Camera::orbit(s.mesh, 35, 12, kDistance, 30, static_cast<double>(s.setup.width) / s.setup.height);
  GONIO_ASSIGN(const render::Frame frame, s.renderer->draw(camera, s.setup.width, s.setup.height, kSamples));
  return s.display->image(frame.picture, s.stops);
}

inline Result<std::string> PaintDrawing::png(const paint::Paint& paint) {
  GONIO_ASSIGN(const image::Image shown, image(paint));
  return image::png_content(paint.name, shown);
}

inline Result<std::string> PaintDrawing::split_png(image::Image left, const paint::Paint& right) {
  GONIO_ASSIGN(const image::Image other, image(right));
  const auto row = static_cast<std::ptrdiff_t>(left.width) * left.channels;
  for (int y = 0; y < left.height; ++y)
    std::copy(other.pixel(left.width / 2, y), other.pixel(0, y) + row, left.pixel(left.width / 2, y));
  return image::png_content(right.name, left);
}

}  // namespace goniochrome::tool
