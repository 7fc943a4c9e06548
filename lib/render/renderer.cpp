#include "render/renderer.h"

#include <algorithm>
#include <optional>

#include "base/clock.h"
#include "render/cpu/cpu_engine.h"
#include "render/gl/gl.h"
#include "render/gl/gl_engine.h"
#include "render/gl/shader.h"
#include "render/integral/integral_engine.h"
#include "render/textures/surface_layer.h"

namespace goniochrome::render {

namespace {

// G-buffers are kept up to this size together: 16 samples of 1280 x 720.
constexpr std::size_t kMostKept = std::size_t{256} << 20;

// Visible points that a plan is made from.
constexpr std::size_t kProbe = 512;

bool same_view(const View& a, const View& b) {
  const Camera &x = a.camera, &y = b.camera;
  return a.width == b.width && a.height == b.height && x.eye == y.eye && x.target == y.target && x.up == y.up &&
         x.fov_deg == y.fov_deg;
}

// 0 is the center of the pixel; then come the samples.
std::array<double, 2> shift_of(int sample, int samples) {
  if (sample == 0) return {0, 0};
  return sample_shifts(samples)[static_cast<std::size_t>(sample - 1)];
}

}  // namespace

struct OpenGl {
  explicit OpenGl(GlContext made) : context(std::move(made)), engine(context) {}

  GlContext context;
  std::optional<Rasterizer> rasterizer;
  GlEngine engine;
};

struct Renderer::State {
  std::unique_ptr<OpenGl> gl;            // none: `given` is all there is to see
  std::shared_ptr<const Gbuffer> given;  // of the pixel centers, whatever the view
  CpuEngine cpu_engine;
  Engine engine = Engine::kGl;
  Scene scene;
  Effects effects;
  const mesh::Mesh* uploaded = nullptr;
  std::size_t uploaded_triangles = 0;

  // The view drawn last: its G-buffers by sample (the first is that of the centers), and which one is in the texture.
  std::optional<View> view;
  Rays rays;
  std::vector<std::shared_ptr<Gbuffer>> kept;
  std::vector<std::vector<TexturePlace>> placed;  // on textures, of the same; empty: not yet
  std::uint64_t placed_for = 0;                   // the layer
  int in_texture = -1;
  double rasterization_ms = 0;

  void begin() const {
    if (gl) gl->context.make_current();
  }
  Result<void> can_shade(const Scene& wanted, Engine by) const;
  Effects mapped() const;
  void show(const mesh::Mesh& mesh);
  Result<void> look_at(const View& wanted);
  void rasterize(int sample);
  std::shared_ptr<const Gbuffer> gbuffer(int sample);
  const std::vector<TexturePlace>& places(int sample);
  void shade(int sample, bool add, int samples, image::Image& rgba);
};

// What a G-buffer alone does not allow.
Result<void> Renderer::State::can_shade(const Scene& wanted, Engine by) const {
  if (by == Engine::kIntegral && wanted.env != nullptr && wanted.texels == nullptr)
    return usage_error("the engine integral sums the image that the environment was made from, which is not given");
  if (gl) return {};
  if (by == Engine::kGl) return usage_error("the engine gl draws the mesh: a G-buffer that is given is shaded by cpu");
  if (wanted.layer != nullptr && wanted.layer->textured())
    return usage_error("textures lie on the mesh: a G-buffer that is given has no places on them");
  return {};
}

// The effects that come from prefiltered maps: of the integral, only what stands behind the mesh.
Effects Renderer::State::mapped() const {
  if (engine != Engine::kIntegral) return effects;
  Effects behind;
  behind.environment = effects.background == Background::kEnvironment;
  behind.diffuse = false, behind.background = effects.background;
  return behind;
}

void Renderer::State::show(const mesh::Mesh& mesh) {
  if (!gl || (uploaded == &mesh && uploaded_triangles == mesh.triangles.size())) return;
  gl->rasterizer->upload(mesh);
  uploaded = &mesh, uploaded_triangles = mesh.triangles.size();
  view.reset();
}

Result<void> Renderer::State::look_at(const View& wanted) {
  if (given) {
    if (wanted.samples != 1)
      return usage_error("a G-buffer that is given has 1 sample a pixel, not {}", wanted.samples);
    view = wanted;
    return {};
  }
  GONIO_TRY(gl->rasterizer->resize(wanted.width, wanted.height));
  if (!view || !same_view(*view, wanted) || view->samples != wanted.samples) {
    GONIO_ASSIGN(rays, goniochrome::render::rays(wanted.camera, wanted.width, wanted.height));
    in_texture = -1;
    for (std::shared_ptr<Gbuffer>& old : kept) {
      if (old.use_count() > 1) old.reset();  // a frame still has it
      if (old) old->width = 0;
    }
  }
  view = wanted;
  return {};
}

void Renderer::State::rasterize(int sample) {
  if (in_texture == sample) return;
  const auto [x, y] = shift_of(sample, view->samples);
  gl->rasterizer->draw(view->camera, rays, x, y);
  in_texture = sample;
}

// A sample's G-buffer, kept or drawn anew. Where not all can be kept, those after the first share a place.
std::shared_ptr<const Gbuffer> Renderer::State::gbuffer(int sample) {
  if (given) return given;
  const std::size_t bytes = static_cast<std::size_t>(view->width) * static_cast<std::size_t>(view->height) * 16;
  const bool room = bytes * (static_cast<std::size_t>(view->samples) + 1) <= kMostKept;
  const std::size_t place = room || sample == 0 ? static_cast<std::size_t>(sample) : 1;
  if (kept.size() <= place) kept.resize(place + 1);
  std::shared_ptr<Gbuffer>& g = kept[place];
  if (!g) g = std::make_shared<Gbuffer>();
  if (g->width != 0 && (room || sample == 0)) return g;
  const Stopwatch clock;
  placed.resize(kept.size());
  placed[place].clear();
  rasterize(sample);
  gl->context.Finish();
  rasterization_ms = 1000 * clock.elapsed_s();
  gl->rasterizer->read(*g);
  return g;
}

const std::vector<TexturePlace>& Renderer::State::places(int sample) {
  const SurfaceLayer& layer = *scene.layer;
  if (placed_for != layer.id()) {
    for (std::vector<TexturePlace>& old : placed) old.clear();
    placed_for = layer.id();
  }
  const std::shared_ptr<const Gbuffer> of = gbuffer(sample);
  const auto place = static_cast<std::size_t>(std::find(kept.begin(), kept.end(), of) - kept.begin());
  placed.resize(kept.size());
  if (placed[place].empty()) placed[place] = layer.places(*of);
  return placed[place];
}

void Renderer::State::shade(int sample, bool add, int samples, image::Image& rgba) {
  if (engine != Engine::kGl) {
    const std::shared_ptr<const Gbuffer> of = gbuffer(sample);
    const float gain = 1.0F / static_cast<float>(samples);
    cpu_engine.shade(*of, gain, add, rgba);
    if (engine == Engine::kIntegral) {
      const bool placed_there = scene.layer != nullptr && scene.layer->textured();
      add_integral(*of, placed_there ? places(sample) : std::vector<TexturePlace>(), scene, effects, gain, rgba);
    }
    return;
  }
  rasterize(sample);
  gl->engine.shade(gl->rasterizer->texture(), gl->rasterizer->drawn_rays(), add);
}

Renderer::Renderer(std::unique_ptr<State> state) : state_(std::move(state)) {}
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer::~Renderer() = default;

Result<Renderer> Renderer::create() {
  GONIO_ASSIGN(GlContext context, GlContext::create());
  auto state = std::make_unique<State>();
  state->gl = std::make_unique<OpenGl>(std::move(context));
  GONIO_ASSIGN(state->gl->rasterizer, Rasterizer::create(state->gl->context));
  return Renderer(std::move(state));
}

Renderer Renderer::shading(std::shared_ptr<const Gbuffer> gbuffer) {
  auto state = std::make_unique<State>();
  state->given = std::move(gbuffer);
  state->engine = Engine::kCpu;
  return Renderer(std::move(state));
}

std::string Renderer::opengl() const {
  state_->begin();
  return state_->gl ? state_->gl->context.engine() : "";
}

std::string Renderer::shader() const {
  return shading_fragment_shader(state_->effects, state_->scene.reflection);
}

Result<void> Renderer::load(const Scene& scene, Engine engine) {
  return load(scene, effects_of(scene), engine);
}

Result<void> Renderer::load(const Scene& scene, const Effects& effects, Engine engine) {
  State& s = *state_;
  GONIO_TRY(s.can_shade(scene, engine));
  s.begin();
  s.scene = scene;
  s.effects = effects;
  s.engine = engine;
  s.show(*scene.mesh);
  const Effects mapped = s.mapped();
  GONIO_ASSIGN(const SceneMaps maps, scene_maps(scene, mapped));
  if (engine != Engine::kGl) return s.cpu_engine.load(scene, mapped, maps);
  return s.gl->engine.load(scene, effects, maps);
}

// The plan is made with all maps interleaved; where the processor shades and all lobes stay, they are used as they are.
Result<Plan> Renderer::load(const Scene& scene, const std::vector<std::shared_ptr<const Gbuffer>>& gbuffers,
                            const PlanRequest& request) {
  State& s = *state_;
  const Scene seen = seen_scene(scene, gbuffers);
  const Effects effects = effects_of(seen);
  GONIO_TRY(load(seen, effects, Engine::kCpu));
  CpuEngine component_wise;
  if (effects.reflection) {
    Effects plain = effects;
    plain.reflection = false;
    GONIO_ASSIGN(const SceneMaps maps, scene_maps(seen, plain));
    GONIO_TRY(component_wise.load(seen, plain, maps));
  }
  const std::vector<VisiblePoint> probe = probe_points(gbuffers, kProbe);
  double visible = 0, all = 0;
  for (const auto& g : gbuffers) {
    for (std::size_t i = 3; i < g->data.size(); i += 4) visible += g->data[i] != 0 ? 1 : 0;
    all += static_cast<double>(g->data.size() / 4);
  }
  PlanRequest sized = request;
  if (s.given && !sized.engine) sized.engine = Engine::kCpu;
  if (sized.pixels == 0) sized.pixels = all / static_cast<double>(std::max<std::size_t>(1, gbuffers.size()));
  const double in_one = all > 0 ? sized.pixels * visible / all : 0;  // the G-buffers may be smaller than the frame
  GONIO_ASSIGN(Plan plan,
               make_plan(seen, probe, in_one, sized, s.cpu_engine, effects.reflection ? component_wise : s.cpu_engine));
  GONIO_TRY(load(seen, plan.effects, plan.engine));
  return plan;
}

void Renderer::load_paints(const Scene& scene) {
  State& s = *state_;
  s.scene = scene;
  const Effects mapped = s.mapped();
  const WeightTable table = weight_table(scene, mapped);
  if (s.engine != Engine::kGl) return s.cpu_engine.load_paints(scene, mapped, table);
  s.begin();
  s.gl->engine.load_paints(scene, table);
}

Result<std::shared_ptr<const Gbuffer>> Renderer::look(const mesh::Mesh& mesh, const View& view) {
  State& s = *state_;
  s.begin();
  s.show(mesh);
  GONIO_TRY(s.look_at(view));
  return std::shared_ptr<const Gbuffer>(s.gbuffer(0));
}

Result<void> Renderer::draw(const View& view, Frame& frame) {
  State& s = *state_;
  s.begin();
  const Stopwatch whole;
  s.rasterization_ms = 0;
  frame.gbuffer.reset();
  GONIO_TRY(s.look_at(view));
  if (s.engine == Engine::kGl) GONIO_TRY(s.gl->engine.resize(view.width, view.height));
  frame.gbuffer = s.gbuffer(0);
  frame.gbuffer_ms = s.rasterization_ms;
  const auto add_layer = [&](image::Image& image, int first, int count) {
    if (s.scene.layer == nullptr || s.engine == Engine::kIntegral) return;
    for (int i = first; i < first + count; ++i) {
      s.scene.layer->add(*s.gbuffer(i), s.places(i), s.effects, 1.0F / static_cast<float>(count), image);
    }
  };
  const auto read = [&](image::Image& image, int samples) {
    if (s.engine == Engine::kGl) {
      s.gl->engine.read(image);
      for (float& value : image.data) value /= static_cast<float>(samples);
    }
    image.channel_names = {"R", "G", "B", "A"};
  };
  if (view.with_centers || view.samples == 1) {
    s.shade(0, false, 1, frame.picture);
    read(frame.picture, 1);
    add_layer(frame.picture, 0, 1);
    frame.centers = view.with_centers ? frame.picture : image::Image{};
  }
  if (view.samples > 1) {
    for (int i = 1; i <= view.samples; ++i) s.shade(i, i > 1, view.samples, frame.picture);
    read(frame.picture, view.samples);
    add_layer(frame.picture, 1, view.samples);
  }
  frame.frame_ms = 1000 * whole.elapsed_s();
  return s.gl ? s.gl->context.status("drawing") : Result<void>();
}

Result<Frame> Renderer::draw(const Camera& camera, int width, int height, int samples, bool with_centers) {
  Frame frame;
  GONIO_TRY(draw({camera, width, height, samples, with_centers}, frame));
  return frame;
}

}  // namespace goniochrome::render
