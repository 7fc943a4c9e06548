#include "drawing.h"

#include <cmath>
#include <filesystem>
#include <utility>

#include "base/angles.h"
#include "display/display.h"
#include "envmap/prefiltered.h"
#include "fit/paint_fit.h"
#include "formats/default_basis.h"
#include "render/renderer.h"
#include "render/trim.h"
#include "sketch/sketch.h"

namespace goniochrome::tool {

namespace {

constexpr int kWidth = 640, kHeight = 320, kSamples = 4;
constexpr double kDistance = 0.87;  // of the camera; at 1 a mesh just fits from every side
constexpr float kBackdrop = 0.3F;

// A unit ball: the simplest body that shows face and flop at once.
mesh::Mesh ball() {
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

formats::Basis basis_of(const envmap::PrefilteredEnvironment& env) {
  formats::Basis basis;
  basis.name = "environment", basis.mirror = env.mirror.map.size > 0;
  for (const envmap::PrefilteredLobe& lobe : env.lobes) basis.exponents.push_back(lobe.exponent);
  return basis;
}

}  // namespace

struct PaintDrawing::State {
  std::string description;
  mesh::Mesh mesh;
  envmap::PrefilteredEnvironment env;
  std::optional<fit::PaintFitter> fitter;
  std::optional<render::Renderer> renderer;
  std::optional<display::Display> display;
  render::Scene scene;
  double stops = 0;
};

PaintDrawing::PaintDrawing(std::unique_ptr<State> state) : state_(std::move(state)) {}
PaintDrawing::PaintDrawing(PaintDrawing&&) noexcept = default;
PaintDrawing::~PaintDrawing() = default;

std::string PaintDrawing::described() const {
  return state_->description;
}

Result<PaintDrawing> PaintDrawing::make(const Options& options, cli::Session& session) {
  auto state = std::make_unique<State>();
  GONIO_ASSIGN(formats::Basis basis, formats::basis_or_default(options.basis));
  state->mesh = ball();
  if (!options.mesh.empty()) {
    GONIO_ASSIGN(state->mesh, mesh::read_mesh(options.mesh));
    for (const std::string& remark : state->mesh.remarks) session.warn(remark);
  }
  if (!options.env.empty()) {
    GONIO_ASSIGN(state->env, envmap::read_env(options.env));
    basis = basis_of(state->env);
    state->scene.env = &state->env;
  } else {
    // As wide as a lamp of half a meter five meters away, so that gloss shows in a small picture.
    constexpr double kRadius_rad = 0.05;
    state->scene.lights = {{render::orbit_direction(25, 45), {1, 1, 1}, kRadius_rad},
                           {render::orbit_direction(-60, 20), {0.35, 0.35, 0.35}, kRadius_rad}};
  }
  const auto file = [](const std::string& path) { return std::filesystem::path(path).filename().string(); };
  state->description = fmt::format("on {} under {}", options.mesh.empty() ? "a ball" : file(options.mesh),
                                   options.env.empty() ? "two lamps" : file(options.env));
  state->fitter.emplace(basis, fit::FitOptions{});
  render::Renderer renderer = render::Renderer::tracing();
  state->renderer.emplace(std::move(renderer));
  GONIO_ASSIGN(display::Display display, display::Display::make(""));
  state->display.emplace(std::move(display));
  state->scene.mesh = &state->mesh;
  state->scene.background = render::Background::kColor;
  const double white = render::diffuse_white(state->scene.env, state->scene.lights).luminance;
  state->stops = white > 0 ? -std::log2(white) : 0;
  const double gray = kBackdrop * (white > 0 ? white : 1);
  state->scene.background_color = {gray, gray, gray};
  return PaintDrawing(std::move(state));
}

Result<std::string> PaintDrawing::png(const paint::Paint& paint) {
  GONIO_ASSIGN(const fit::PaintFit fit, state_->fitter->fit(paint));
  state_->scene.paints.assign(state_->mesh.parts.size(), fit.lobes);
  const bool with_mirror = state_->scene.env != nullptr && state_->env.mirror.map.size > 0;
  for (std::size_t part = 0; part < state_->mesh.parts.size(); ++part) {
    if (const auto trim = render::trim_of(state_->mesh.parts[part], with_mirror)) state_->scene.paints[part] = *trim;
  }
  GONIO_TRY(state_->renderer->load(state_->scene, "cpu"));
  const render::Camera camera =
      render::Camera::orbit(state_->mesh, 35, 12, kDistance, 30, static_cast<double>(kWidth) / kHeight);
  GONIO_ASSIGN(const render::Frame frame, state_->renderer->draw(camera, kWidth, kHeight, kSamples));
  GONIO_ASSIGN(const image::Image shown, state_->display->image(frame.picture, state_->stops));
  return image::png_content(paint.name, shown);
}

}  // namespace goniochrome::tool
