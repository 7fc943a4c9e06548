#include "drawing.h"

#include <cmath>
#include <filesystem>
#include <numbers>
#include <utility>

#include "envmap/prefiltered.h"
#include "fit/paint_fit.h"
#include "fit/sketch.h"
#include "render/display.h"
#include "render/renderer.h"

namespace goniochrome {

namespace {

constexpr int kWidth = 640, kHeight = 320, kSamples = 4;
constexpr double kDistance = 0.87;  // of the camera; at 1 a mesh just fits from every side
constexpr float kBackdrop = 0.3F;

// A unit ball: the simplest body that shows face and flop at once.
Mesh ball() {
  constexpr std::uint32_t kRings = 96, kSegments = 192;
  Mesh mesh;
  for (std::uint32_t ring = 0; ring <= kRings; ++ring)
    for (std::uint32_t segment = 0; segment <= kSegments; ++segment) {
      const double t = std::numbers::pi * ring / kRings, p = 2 * std::numbers::pi * segment / kSegments;
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

Basis basis_of(const PrefilteredEnvironment& env) {
  Basis basis;
  basis.name = "environment", basis.mirror = env.mirror.map.size > 0;
  for (const PrefilteredLobe& lobe : env.lobes) basis.exponents.push_back(lobe.exponent);
  return basis;
}

}  // namespace

struct PaintDrawing::State {
  std::string description;
  Mesh mesh;
  PrefilteredEnvironment env;
  std::optional<PaintFitter> fitter;
  std::optional<Renderer> renderer;
  std::optional<Display> display;
  Scene scene;
  double stops = 0;
};

PaintDrawing::PaintDrawing(std::unique_ptr<State> state) : state_(std::move(state)) {}
PaintDrawing::PaintDrawing(PaintDrawing&&) noexcept = default;
PaintDrawing::~PaintDrawing() = default;

std::string PaintDrawing::described() const {
  return state_->description;
}

Result<PaintDrawing> PaintDrawing::make(const Options& options) {
  auto state = std::make_unique<State>();
  Basis basis = sketch_basis();
  state->mesh = ball();
  if (!options.mesh.empty()) {
    GONIO_ASSIGN(state->mesh, read_mesh(options.mesh));
  }
  if (!options.env.empty()) {
    GONIO_ASSIGN(state->env, read_env(options.env));
    basis = basis_of(state->env);
    state->scene.env = &state->env;
  } else {
    if (!options.basis.empty()) {
      GONIO_ASSIGN(basis, read_basis(options.basis));
    }
    state->scene.lights = {{orbit_direction(25, 45), {1, 1, 1}}, {orbit_direction(-60, 20), {0.35, 0.35, 0.35}}};
  }
  const auto file = [](const std::string& path) { return std::filesystem::path(path).filename().string(); };
  state->description = fmt::format("on {} under {}", options.mesh.empty() ? "a ball" : file(options.mesh),
                                   options.env.empty() ? "two lamps" : file(options.env));
  state->fitter.emplace(basis, FitOptions{});
  GONIO_ASSIGN(Renderer renderer, Renderer::create());
  state->renderer.emplace(std::move(renderer));
  GONIO_ASSIGN(Display display, Display::make(""));
  state->display.emplace(std::move(display));
  state->scene.mesh = &state->mesh;
  state->scene.background = Background::kColor;
  const double white = diffuse_white(state->scene.env, state->scene.lights).luminance;
  state->stops = white > 0 ? -std::log2(white) : 0;
  const double gray = kBackdrop * (white > 0 ? white : 1);
  state->scene.background_color = {gray, gray, gray};
  return PaintDrawing(std::move(state));
}

Result<std::string> PaintDrawing::png(const Paint& paint) {
  GONIO_ASSIGN(const PaintFit fit, state_->fitter->fit(paint));
  state_->scene.paints.assign(state_->mesh.parts.size(), fit.lobes);
  GONIO_TRY(state_->renderer->load(state_->scene));
  const Camera camera = Camera::orbit(state_->mesh, 35, 12, kDistance, 30, static_cast<double>(kWidth) / kHeight);
  GONIO_ASSIGN(const Frame frame, state_->renderer->draw(camera, kWidth, kHeight, kSamples));
  GONIO_ASSIGN(const Image shown, state_->display->image(frame.picture, state_->stops));
  return png_content(paint.name, shown);
}

}  // namespace goniochrome
