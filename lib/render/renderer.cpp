#include "render/renderer.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/clock.h"
#include "rays/ray_scene.h"
#include "render/gl/gl.h"
#include "render/gl/shader.h"
#include "render/glints.h"
#include "render/internal/bands.h"
#include "render/internal/samples.h"
#include "render/internal/seen_through.h"
#include "render/internal/sparkle.h"
#include "render/path/open_residual.h"
#include "render/path/path_engine.h"
#include "render/path/visible_surface.h"
#include "render/plan/map_audit.h"
#include "render/plan/ray_plan.h"
#include "render/planning.h"
#include "render/scene_effects.h"
#include "render/surface_layer.h"

namespace goniochrome::render {

namespace {

constexpr std::size_t kMostSeen = std::size_t{128} << 20;  // bytes of what G-buffers show of textures
using Rayed = std::shared_ptr<const rays::RayScene>;

Result<Rayed> rayed(const mesh::Mesh& mesh, const std::optional<Ground>& ground, const std::vector<bool>& passed = {}) {
  const auto floor = ground ? std::optional(rays::Floor{ground->height}) : std::nullopt;
  GONIO_ASSIGN(rays::RayScene made, rays::RayScene::create(mesh, floor, passed));
  return Rayed(std::make_shared<const rays::RayScene>(std::move(made)));
}

}  // namespace

struct Renderer::State : Sight {
  std::optional<GlContext> open_gl;
  std::optional<Ground> ground;  // that hides what lies below it
  Rayed traced;                  // by which rays find what is visible; null where `given` is all there is to see
  Effort effort_asked;
  std::shared_ptr<const Gbuffer> given;       // of the pixel centers, whatever the view
  std::vector<std::unique_ptr<Engine>> made;  // beside engines(); null: not yet
  Engine* engine = nullptr;                   // that is loaded
  Scene scene;
  Effects effects;
  std::optional<RaySetup> ray_setup;
  Scene ray_scene;                           // all of it, seen or not: rays meet parts that the camera does not see
  Rayed ray_mesh;                            // of that scene, whose panes rays pass; none: not yet
  std::vector<bool> ray_panes;               // empty: the scene has none
  std::optional<envmap::SunlitSky> ray_sun;  // of the environment of ray_setup, where it has a sun
  std::shared_ptr<const EnvironmentTable> ray_table;
  std::optional<Transport> transport;
  std::optional<envmap::BlockTree> ray_texels;  // of the environment of ray_setup; none: not yet
  std::unique_ptr<OpenResidual> residual;       // of these; null: not yet
  std::unique_ptr<CpuEngine> audited;           // has the maps of an engine that shades no single points
  std::optional<FoundMaps> maps_found;          // by the first picture of a plan, or of other paints
  bool sums_may_stop = false;
  std::optional<Error> ray_failure;  // of load_paints(), which cannot tell it
  double white_luminance = 1, tolerance_de00 = 0.5;
  std::optional<Deadline> deadline;  // of the picture that is loaded or drawn
  const mesh::Mesh* met = nullptr;
  std::size_t met_triangles = 0;

  // A sample of the view drawn last, and its places on textures.
  struct Kept {
    int sample = -1;
    std::shared_ptr<Gbuffer> gbuffer;
    std::vector<TexturePlace> places;  // empty: not yet
    SeenPixels seen;
  };
  std::optional<View> view;
  Rays rays;
  Band band;                     // of that view
  std::vector<Kept> kept;        // of that band, sample by sample
  std::uint64_t placed_for = 0;  // the layer
  bool placed_footprints = false;
  PixelFlags edges;       // in that band: the pixels all samples of which were traced
  double gbuffer_ms = 0;  // to find the centers of the view, perhaps for a plan

  void begin() const {
    if (open_gl) open_gl->make_current();
  }
  Engine& engine_of(const EngineInfo& info);
  Result<void> can_shade(const Scene& wanted, const Engine& by) const;
  Result<void> show(const mesh::Mesh& mesh);
  Result<void> look_at(const View& wanted);
  void turn_to(const Band& wanted);
  Result<void> draw_band(Frame& frame);
  Result<void> take(int first, int count, image::Image& picture);
  Result<void> look_closer(image::Image& picture);
  FoundMaps audit(const std::shared_ptr<const Gbuffer>& seen) const;
  Result<void> meet(const Scene& whole_scene);
  Result<void> add_seen_through(int sample, float gain, image::Image& picture);
  void correct(int first, int count, image::Image& picture, CorrectionNoise& noise);
  MeshSurroundings surroundings() const {
    return {*transport, {effects.background, scene.background_color, ray_setup->environment}, effects.rays};
  }
  Result<RaySetup> ray_context(const Scene& whole_scene, const std::vector<std::shared_ptr<const Gbuffer>>& gbuffers);
  Result<void> trace(const Scene& whole_scene, bool rough_coats);
  Scene completed(const Scene& scene) const;
  // The light of which rays are drawn; a sun is asked for by itself.
  const envmap::Environment* ray_environment() const { return ray_sun ? &ray_sun->sky : ray_setup->environment; }

  const GlContext* gl() const override { return open_gl ? &*open_gl : nullptr; }
  Rayed traced_mesh() const override {
    if (traced == nullptr || !scene.ground || traced->has_floor()) return traced;
    return std::make_shared<const rays::RayScene>(traced->over({scene.ground->height}));
  }
  bool shows_mesh() const override { return given == nullptr; }
  Effort effort() const override { return effort_asked; }
  std::shared_ptr<const Gbuffer> gbuffer(int sample) override;
  const std::vector<TexturePlace>& places(int sample) override;
  SeenPixels* seen_pixels(int sample) override;
  void put(int sample, Gbuffer found);
  Kept& keep(int sample);
  // By which the picture is corrected; null where it is not.
  OpenResidual* summed() const {
    const bool stopped = maps_found && maps_found->sums_stopped;
    return effects.sums && !stopped && engine->info().is_planned ? residual.get() : nullptr;
  }
};

Engine& Renderer::State::engine_of(const EngineInfo& info) {
  const auto number = static_cast<std::size_t>(std::ranges::find(engines(), &info) - engines().begin());
  made.resize(engines().size());
  if (!made[number]) made[number] = info.make(*this);
  return *made[number];
}

Result<void> Renderer::State::can_shade(const Scene& wanted, const Engine& by) const {
  if (needs_rays(wanted) && !by.info().traces_rays)
    return usage_error("the engine {} draws neither floors nor parts that shine: take the engine path", by.info().name);
  if (has_placed_lamps(wanted) && !by.info().draws_placed_lamps)
    return usage_error("the engine {} draws no lamps at a place: take cpu or path", by.info().name);
  if (has_placed_lamps(wanted) && given)
    return usage_error("a lamp at a place needs positions, which a G-buffer that is given does not have");
  GONIO_TRY(by.can_shade(wanted));
  if (has_panes(wanted) && given)
    return usage_error(
        "a pane is seen through where the mesh is there: a G-buffer that is given has nothing behind it");
  if (has_panes(wanted) && by.info().needs_opengl)
    return usage_error("the engine {} does not draw what lies behind panes: take the engine cpu or path",
                       by.info().name);
  if (given && wanted.layer != nullptr && wanted.layer->textured())
    return usage_error("textures lie on the mesh: a G-buffer that is given has no places on them");
  return {};
}

Result<void> Renderer::State::show(const mesh::Mesh& mesh) {
  if (given || (met == &mesh && met_triangles == mesh.triangles.size())) return {};
  GONIO_ASSIGN(traced, rayed(mesh, ground));
  met = &mesh, met_triangles = mesh.triangles.size();
  ray_mesh.reset(), view.reset();
  return {};
}

// The mesh of a scene as rays of light meet it, which pass panes.
Result<void> Renderer::State::meet(const Scene& whole_scene) {
  GONIO_TRY(show(*whole_scene.mesh));
  std::vector<bool> panes = has_panes(whole_scene) ? whole_scene.panes : std::vector<bool>();
  if (ray_mesh != nullptr && ray_panes == panes) return {};
  GONIO_ASSIGN(ray_mesh, panes.empty() ? Result<Rayed>(traced) : rayed(*whole_scene.mesh, ground, panes));
  ray_panes = std::move(panes);
  return {};
}

Result<void> Renderer::State::look_at(const View& wanted) {
  if (given) {
    if (wanted.samples != 1)
      return usage_error("a G-buffer that is given has 1 sample a pixel, not {}", wanted.samples);
    view = wanted;
    return {};
  }
  if (!view || view->camera != wanted.camera || view->width != wanted.width || view->height != wanted.height ||
      view->samples != wanted.samples) {
    GONIO_ASSIGN(rays, goniochrome::render::rays(wanted.camera, wanted.width, wanted.height));
    kept.clear();
  }
  view = wanted;
  turn_to(whole_band(wanted.height));
  return {};
}

void Renderer::State::turn_to(const Band& wanted) {
  if (band != wanted) kept.clear();
  band = wanted;
}

void Renderer::State::put(int sample, Gbuffer found) {
  const auto place = static_cast<std::size_t>(sample);
  if (kept.size() <= place) kept.resize(place + 1);
  kept[place] = {sample, std::make_shared<Gbuffer>(std::move(found)), {}, {}};
}

// A sample, kept or found anew: the centers, or all others together.
Renderer::State::Kept& Renderer::State::keep(int sample) {
  const auto place = static_cast<std::size_t>(sample);
  if (place < kept.size() && kept[place].sample == sample) return kept[place];
  if (sample == 0) {
    const Stopwatch clock;
    put(0, mesh_gbuffer(*traced, rays.shifted(0, band.first), view->width, band.height()));
    gbuffer_ms = 1000 * clock.elapsed_s();
  } else {
    SampledSurface found = sampled_surface(*traced, *gbuffer(0), sample_shifts(view->samples));
    for (int i = 1; i <= view->samples; ++i) put(i, std::move(found.samples[static_cast<std::size_t>(i - 1)]));
    edges = std::move(found.edges);
  }
  return kept[place];
}

std::shared_ptr<const Gbuffer> Renderer::State::gbuffer(int sample) {
  return given ? given : keep(sample).gbuffer;
}

const std::vector<TexturePlace>& Renderer::State::places(int sample) {
  static const std::vector<TexturePlace> nowhere;
  if (scene.layer == nullptr || !scene.layer->textured()) return nowhere;
  const SurfaceLayer& layer = *scene.layer;
  if (placed_for != layer.id() || placed_footprints != effects.texture_filter) {
    for (Kept& old : kept) old.places.clear();
    placed_for = layer.id(), placed_footprints = effects.texture_filter;
  }
  Kept& one = keep(sample);
  if (!one.places.empty()) return one.places;
  one.places = effects.texture_filter ? layer.filtered_places(*one.gbuffer, to_middle_of_part(sample, view->samples))
                                      : layer.places(*one.gbuffer);
  return one.places;
}

SeenPixels* Renderer::State::seen_pixels(int sample) {
  if (given) return nullptr;
  SeenPixels& seen = keep(sample).seen;
  seen.set_most_bytes(kMostSeen / kept.size());
  return &seen;
}

// Takes the centers, unless the picture has them, and all samples of the pixels whose mean they do not tell.
Result<void> Renderer::State::look_closer(image::Image& picture) {
  keep(1);
  if (!view->with_centers) {
    Gbuffer& centers = *keep(0).gbuffer;
    centers.wanted = wanted_centers(edges, centers);
    const Result<void> taken = take(0, 1, picture);
    centers.wanted.clear();  // as whoever has the view reads all of it
    if (!taken.ok()) return taken;
  }
  const PixelFlags wanted = wanted_pixels(edges, picture, white_luminance, tolerance_de00);
  for (int i = 1; i <= view->samples; ++i) keep(i).gbuffer->wanted = wanted;
  if (band.count > 1) kept.front() = {};
  image::Image closer;
  GONIO_TRY(take(1, view->samples, closer));
  put_wanted(wanted, closer, picture);
  return {};
}

// Makes the picture the mean of `count` samples from `first` on, with the floor of rays and what is behind it.
Result<void> Renderer::State::take(int first, int count, image::Image& picture) {
  const float gain = 1.0F / static_cast<float>(count);
  GONIO_TRY(take_samples(*this, *engine, scene, effects, first, count, picture));
  if (engine->info().traces_rays) return {};
  std::vector<const Gbuffer*> samples;
  for (int i = first; i < first + count; ++i) {
    samples.push_back(gbuffer(i).get());
    if (summed() != nullptr) summed()->add(*samples.back(), gain, picture);
    if (effects.panes) GONIO_TRY(add_seen_through(i, gain, picture));
  }
  if (effects.rays.floor && transport) surroundings().add(samples, gain, picture);
  return {};
}

// Nothing is found of an engine without maps, nor of one that was loaded without a plan.
FoundMaps Renderer::State::audit(const std::shared_ptr<const Gbuffer>& seen) const {
  const auto* own = dynamic_cast<const CpuEngine*>(engine);
  const CpuEngine* maps = own != nullptr ? own : audited.get();
  if (!engine->info().is_planned || maps == nullptr || !effects.environment) return {};
  return MapAudit{scene,         effects,        *maps,          summed(), ray_texels ? &*ray_texels : nullptr,
                  sums_may_stop, tolerance_de00, white_luminance}
      .found(seen, view->samples);
}

// Surfaces behind the panes of a sample are shaded as those that are seen without panes.
Result<void> Renderer::State::add_seen_through(int sample, float gain, image::Image& picture) {
  for (const BehindPanes& behind : behind_panes(*traced, scene, *gbuffer(sample))) {
    BehindSight sight(behind, scene.layer);
    image::Image shown;
    GONIO_TRY(engine->shade(sight, sample, 1, false, shown));
    engine->finish(shown);
    if (summed() != nullptr) summed()->add(behind.gbuffer, 1, shown);
    if (effects.extent && effects.mirror) add_glints(scene, effects, behind.gbuffer, 1, shown);
    if (scene.layer != nullptr && !engine->shades_layer())
      scene.layer->add(behind.gbuffer, sight.places(sample), effects, 1, shown);
    uncover(behind, gain, picture);
    add_behind(behind, shown, gain, picture);
    if (!effects.rays.floor || !transport) continue;
    std::fill(shown.data.begin(), shown.data.end(), 0.0F);
    const Gbuffer* one = &behind.gbuffer;
    surroundings().add({&one, 1}, 1, shown);
    add_behind(behind, shown, gain, picture);
  }
  return {};
}

// Each sample of a pixel is corrected as the surface that it shows.
void Renderer::State::correct(int first, int count, image::Image& picture, CorrectionNoise& noise) {
  if (!effects.rays.any() || !transport) return;
  PathRequest request = correction_request(effects.rays, effort_asked.bounces, tolerance_de00);
  if (maps_found) request.beside_de00 = maps_found->errors_de00;
  if (noise.points > 0) request.before = &noise.drawn;
  request.white_luminance = white_luminance > 0 ? white_luminance : 1;
  request.most_samples = std::max(2 * kBatch, effects.most_ray_samples);
  request.progress = effort_asked.progress;
  // Bands have about as many points each, and those that are left share the time that is left.
  request.first_points /= static_cast<std::size_t>(band.count);
  if (effort_asked.time_limit_s > 0)
    request.time_limit_s = std::max(1e-3, deadline->left_s()) / (band.count - band.number);
  request.seed =
      mixed(effort_asked.seed, static_cast<std::uint64_t>(first) + (static_cast<std::uint64_t>(band.first) << 8));
  const image::Image before = picture;
  std::vector<std::shared_ptr<const Gbuffer>> seen;
  std::vector<const Gbuffer*> samples;
  for (int i = first; i < first + count; ++i) samples.push_back(seen.emplace_back(gbuffer(i)).get());
  if (effects.rays.floor)
    request.beside_mesh = [around = surroundings(), &samples](int x, int y) { return around.mean(samples, x, y); };
  noise.add(add_correction(*transport, samples, request, before, picture), band.first_kept - band.first,
            band.last_kept - band.first);
}

Result<void> Renderer::State::trace(const Scene& whole_scene, bool rough_coats) {
  transport.reset(), ray_failure.reset();
  if (!ray_setup || !ray_setup->absent.empty()) return {};
  ray_scene = whole_scene;
  if (ray_sun) ray_scene.lights.push_back(light_of(ray_sun->sun));
  if (whole_scene.mesh != nullptr) GONIO_TRY(meet(whole_scene));
  if (ray_setup->environment != nullptr && ray_table == nullptr)
    ray_table = std::make_shared<const EnvironmentTable>(*ray_environment());
  PathScene paths;
  paths.scene = &ray_scene;
  paths.environment = ray_environment(), paths.mirrored = ray_setup->environment, paths.table = ray_table;
  paths.rays = ray_mesh, paths.rough_coats = rough_coats;
  if (!ray_panes.empty()) paths.eye = traced;
  const bool over_floor = effects.rays.floor && ray_setup->floor;
  if (over_floor) {
    paths.ground = ray_setup->floor;
    paths.rays = std::make_shared<const rays::RayScene>(ray_mesh->over({ray_setup->floor->height}));
  }
  GONIO_ASSIGN(Transport created, Transport::create(paths));
  if (over_floor) {
    const double left_s = deadline && deadline->limit_s() > 0 ? std::max(4e-3, deadline->left_s()) : 0;
    const GroundRequest request = ground_request(tolerance_de00, effort_asked.seed, left_s);
    created.shade_ground(request, effects.rays.self || effects.rays.bounce ? effort_asked.bounces : 0);
  }
  transport.emplace(std::move(created));
  return {};
}

// Nothing is in the way of light on a convex mesh that is seen from outside.
Result<RaySetup> Renderer::State::ray_context(const Scene& whole_scene,
                                              const std::vector<std::shared_ptr<const Gbuffer>>& gbuffers) {
  RaySetup context = *ray_setup;
  if (context.environment != nullptr) {
    if (!ray_texels) ray_texels.emplace(*context.environment);
    if (!residual) residual = std::make_unique<OpenResidual>(*ray_texels);
  }
  if (!context.absent.empty() || context.has_floor() || whole_scene.mesh == nullptr) return context;
  GONIO_TRY(meet(whole_scene));
  const auto shows_inside = [](const auto& gbuffer) { return gbuffer->shows_inside(); };
  if (ray_mesh->is_convex() && std::ranges::none_of(gbuffers, shows_inside))
    context.absent = "the mesh is convex: nothing is in the way of its light";
  return context;
}

// With the light and the floor that rays meet, for engines that draw by them alone.
Scene Renderer::State::completed(const Scene& given_scene) const {
  Scene complete = given_scene;
  if (!ray_setup) return complete;
  if (complete.texels == nullptr && ray_texels) complete.texels = &*ray_texels;
  if (!complete.ground) complete.ground = ray_setup->floor;
  return complete;
}

Renderer::Renderer(std::unique_ptr<State> state) : state_(std::move(state)) {}
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer::~Renderer() = default;

Result<Renderer> Renderer::create(OpenGlBy by) {
  GONIO_ASSIGN(GlContext context, GlContext::create(by));
  auto state = std::make_unique<State>();
  state->open_gl.emplace(std::move(context));
  return Renderer(std::move(state));
}

Renderer Renderer::shading(std::shared_ptr<const Gbuffer> gbuffer) {
  auto state = std::make_unique<State>();
  state->given = std::move(gbuffer);
  return Renderer(std::move(state));
}

Renderer Renderer::tracing(std::optional<Ground> ground) {
  auto state = std::make_unique<State>();
  state->ground = std::move(ground);
  return Renderer(std::move(state));
}

std::vector<std::string> Renderer::remarks() const {
  return state_->engine != nullptr ? state_->engine->remarks() : std::vector<std::string>();
}

void Renderer::set_effort(Effort effort) {
  state_->effort_asked = std::move(effort);
  state_->deadline.reset();
}

std::string Renderer::opengl() const {
  state_->begin();
  return state_->open_gl ? state_->open_gl->engine() : "";
}

std::string Renderer::opengl_library() const {
  return state_->open_gl ? state_->open_gl->library() : "";
}

std::string Renderer::shader() const {
  return shading_fragment_shader(state_->effects, state_->scene.reflection);
}

Result<void> Renderer::load(const Scene& scene, const std::string& engine) {
  return load(scene, effects_of(scene), engine);
}

Result<void> Renderer::load(const Scene& scene, const Effects& effects, const std::string& name) {
  State& s = *state_;
  GONIO_ASSIGN(const EngineInfo* info, engine_named(name));
  Engine& engine = s.engine_of(*info);
  GONIO_TRY(s.can_shade(scene, engine));
  s.begin();
  s.scene = scene;
  s.effects = effects;
  s.engine = &engine;
  GONIO_TRY(s.show(*scene.mesh));
  if (effects.panes && !info->traces_rays) GONIO_TRY(s.meet(scene));
  // The floor lies before the background, and is drawn with it.
  Effects by_engine = effects;
  if (effects.rays.floor) by_engine.background = Background::kNone;
  GONIO_TRY(engine.load(scene, by_engine));
  return s.summed() != nullptr ? s.summed()->load(scene, effects, dynamic_cast<const CpuEngine*>(&engine))
                               : Result<void>();
}

Result<Plan> Renderer::load(const Scene& scene, const std::vector<std::shared_ptr<const Gbuffer>>& gbuffers,
                            const PlanRequest& request) {
  State& s = *state_;
  s.deadline.emplace(s.effort_asked.time_limit_s);
  s.tolerance_de00 = request.tolerance_de00;
  const EngineInfo* asked = nullptr;
  if (request.engine) {
    GONIO_ASSIGN(asked, engine_named(*request.engine));
  }
  const bool by_rays = asked != nullptr && asked->traces_rays;
  const Scene seen = by_rays ? scene : seen_scene(scene, gbuffers);  // rays meet parts that the camera does not see
  RaySetup rays;
  rays.absent = "no rays are traced";
  if (s.ray_setup && !by_rays) {
    GONIO_ASSIGN(rays, s.ray_context(scene, gbuffers));
  }
  if (has_panes(scene) && !s.given) GONIO_TRY(s.meet(scene));
  std::vector<const Engine*> able;
  std::optional<Error> refusal;  // of the engine that was asked for, or of the first
  for (const EngineInfo* info : engines()) {
    const Engine& engine = s.engine_of(*info);
    const Result<void> can = s.can_shade(info->traces_rays ? s.completed(scene) : seen, engine);
    if (can.ok()) able.push_back(&engine);
    if (!can.ok() && (request.engine ? *request.engine == info->name : !refusal)) refusal = can.error();
  }
  if (refusal && (request.engine || able.empty())) return *refusal;
  s.white_luminance = request.white_luminance;
  auto tried = std::make_unique<CpuEngine>();
  GONIO_ASSIGN(Plan plan, make_plan(seen, gbuffers, request, able, rays, *tried));
  s.effects.rays = plan.effects.rays;
  const Result<void> traced = plan.effects.rays.any() ? s.trace(scene, plan.effects.stretch) : Result<void>();
  if (!traced.ok()) {
    rays.absent = traced.error().message;
    GONIO_ASSIGN(plan, make_plan(seen, gbuffers, request, able, rays, *tried));
  }
  s.maps_found.reset(), s.audited.reset();
  s.sums_may_stop = is_drawn_unasked(plan, kSumsName);
  GONIO_ASSIGN(const EngineInfo* taken, engine_named(plan.engine));
  if (taken == &CpuEngine::kInfo) {  // that which tried out the plan has the maps
    tried->share_maps(*tried);
    Engine& old = s.engine_of(*taken);
    if (s.engine == &old) s.engine = tried.get();
    std::ranges::find(s.made, &old, &std::unique_ptr<Engine>::get)->reset(tried.release());
  } else if (taken->is_planned) {
    tried->load_paints(seen, plan.effects);
    s.audited = std::move(tried);
  }
  GONIO_TRY(load(taken->traces_rays ? s.completed(scene) : seen, plan.effects, plan.engine));
  return plan;
}

void Renderer::load_paints(const Scene& scene) {
  State& s = *state_;
  s.begin();
  s.scene = s.engine != nullptr && s.engine->info().traces_rays ? s.completed(scene) : scene;
  if (s.engine != nullptr) s.engine->load_paints(s.scene);
  if (s.audited) s.audited->load_paints(scene, s.effects);
  s.maps_found.reset();
  Result<void> taken = s.summed() != nullptr ? s.summed()->load_paints(scene) : Result<void>();
  if (taken.ok() && s.effects.rays.any()) taken = s.trace(scene, s.effects.stretch);
  if (!taken.ok()) s.ray_failure = taken.error();
}

void Renderer::set_rays(const RaySetup& setup) {
  state_->ray_setup = setup;
  state_->residual.reset(), state_->ray_texels.reset(), state_->ray_table.reset(), state_->ray_sun.reset();
  if (setup.environment != nullptr && setup.absent.empty()) state_->ray_sun = envmap::sunlit_sky(*setup.environment);
}

Result<std::shared_ptr<const Gbuffer>> Renderer::look(const mesh::Mesh& mesh, const View& view) {
  State& s = *state_;
  s.begin();
  GONIO_TRY(s.show(mesh));
  GONIO_TRY(s.look_at(view));
  return std::shared_ptr<const Gbuffer>(s.gbuffer(0));
}

Result<void> Renderer::State::draw_band(Frame& frame) {
  image::Image& picture = frame.picture;
  const int samples = view->samples;
  frame.open_centers = frame.centers = {};
  if (samples == 1 || view->with_centers) {
    GONIO_TRY(take(0, 1, picture));
    if (view->with_centers) frame.open_centers = picture;
  }
  if (samples == 1) {
    correct(0, 1, picture, frame.rays);
    if (view->with_centers) frame.centers = picture;
    return {};
  }
  if (view->with_centers) {
    frame.centers = picture;
    CorrectionNoise of_centers;
    correct(0, 1, frame.centers, of_centers);
  }
  if (engine->info().traces_rays) return take(1, samples, picture);
  GONIO_TRY(look_closer(picture));
  correct(1, samples, picture, frame.rays);
  return {};
}

Result<void> Renderer::draw(const View& view, Frame& frame) {
  State& s = *state_;
  if (s.engine == nullptr) return usage_error("nothing was loaded that could be drawn");
  if (s.ray_failure) return *s.ray_failure;
  s.begin();
  const Stopwatch whole;
  if (!s.deadline) s.deadline.emplace(s.effort_asked.time_limit_s);
  frame.gbuffer.reset();
  GONIO_TRY(s.look_at(view));
  frame.gbuffer = s.gbuffer(0);
  frame.gbuffer_ms = s.gbuffer_ms;
  if (!s.maps_found) s.maps_found = s.audit(frame.gbuffer);
  frame.rays = {}, frame.open_centers = {};
  std::vector<Band> bands = {whole_band(view.height)};
  if (!s.given && !s.engine->info().traces_rays)
    bands = bands_of(*frame.gbuffer, view.samples, s.effects.rays.any() && s.transport);
  if (bands.size() == 1) {
    GONIO_TRY(s.draw_band(frame));
  } else {
    Frame part;
    for (const Band& band : bands) {
      s.turn_to(band);
      s.put(0, rows_of(*frame.gbuffer, band));
      GONIO_TRY(s.draw_band(part));
      put_band(part.picture, band, view.height, frame.picture);
      put_band(part.centers, band, view.height, frame.centers);
      put_band(part.open_centers, band, view.height, frame.open_centers);
    }
    frame.rays = part.rays;
  }
  if (s.effects.rays.floor && s.transport)
    frame.rays.found.back().de00_p95 =
        std::max(frame.rays.found.back().de00_p95, s.surroundings().floor_change(*frame.gbuffer, s.white_luminance));
  if (s.effects.sparkle && s.engine->info().is_planned && !frame.gbuffer->triangles.empty())
    Sparkle(s.scene, s.effects).add(*frame.gbuffer, s.effects.rays.any() ? s.ray_mesh.get() : nullptr, frame.picture);
  if (s.maps_found) frame.maps = *s.maps_found;
  frame.noise.reset();
  if (s.engine->noise() != nullptr) frame.noise = *s.engine->noise();
  frame.frame_ms = 1000 * whole.elapsed_s();
  s.deadline.reset();
  return s.open_gl ? s.open_gl->status("drawing") : Result<void>();
}

Result<Frame> Renderer::draw(const Camera& camera, int width, int height, int samples, bool with_centers) {
  Frame frame;
  GONIO_TRY(draw({camera, width, height, samples, with_centers}, frame));
  return frame;
}

}  // namespace goniochrome::render
