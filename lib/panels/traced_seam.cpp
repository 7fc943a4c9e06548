#include "panels/traced_seam.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/parallel.h"
#include "envmap/environment.h"
#include "math/statistics.h"
#include "rays/ray_scene.h"
#include "render/light_transport.h"

namespace goniochrome::panels {

namespace {

// Each view has so many independent sequences of directions, and directions of each. Lobes of 512 directions have a
// noise of some .3 dE, of which both sides of a place share the most.
constexpr int kSequences = 8, kDirections = 64, kBounces = 4;
constexpr double kBeside = 1e-3;  // of the mesh's size
constexpr std::size_t kTogether = 8;

}  // namespace

struct TracedSeam::State {
  const mesh::Mesh* mesh = nullptr;
  const envmap::PrefilteredEnvironment* env = nullptr;
  std::optional<envmap::Environment> sky;
  std::shared_ptr<const rays::RayScene> rays;
  std::shared_ptr<const render::EnvironmentTable> table;
  render::LobeColumns columns;
  bool open = false;
  double step = 0;  // kBeside in the units of the mesh

  // The surface of the part under a place of the seam, a step away from its edge.
  std::optional<rays::Spot> spot(const Vec3& edge, const Vec3& inward, const Vec3& normal, int part) const {
    for (const double steps : {1.0, 3.0, 9.0}) {
      const Vec3 above = edge + (steps * step) * inward + (2 * steps * step) * normal;
      const rays::Float3 origin = rays->local(above), direction = rays::float3(-normal);
      const rays::Hit hit = rays->closest(origin, direction);
      if (!hit.any() || hit.distance > 4 * steps * step * rays->scale()) continue;
      rays::Spot found = rays->spot(hit, origin, direction);
      if (found.part == part) return found;
    }
    return std::nullopt;
  }
};

TracedSeam::TracedSeam(std::unique_ptr<State> state) : state_(std::move(state)) {}
TracedSeam::TracedSeam(TracedSeam&&) noexcept = default;
TracedSeam& TracedSeam::operator=(TracedSeam&&) noexcept = default;
TracedSeam::~TracedSeam() = default;

bool TracedSeam::is_open() const {
  return state_->open;
}

Result<TracedSeam> TracedSeam::create(const mesh::Mesh& mesh, const envmap::PrefilteredEnvironment& env, bool open) {
  if (env.mirror.map.size == 0)
    return input_error("the environment has no mirror part, which rays would meet: make it without --no-mirror");
  auto state = std::make_unique<State>();
  state->mesh = &mesh, state->env = &env, state->open = open;
  render::Scene scene;
  scene.mesh = &mesh, scene.env = &env;
  GONIO_ASSIGN(state->columns, render::lobe_columns(scene));
  state->sky.emplace(envmap::Environment::from_cube(env.mirror.map, env.source));
  state->table = std::make_shared<const render::EnvironmentTable>(*state->sky);
  GONIO_ASSIGN(rays::RayScene rays, rays::RayScene::create(mesh));
  state->rays = std::make_shared<const rays::RayScene>(std::move(rays));
  const mesh::Box box = mesh::bounding_box(mesh);
  state->step = kBeside * length(box.size());
  return TracedSeam(std::move(state));
}

Result<TracedSeam::Seen> TracedSeam::seen(const paint::LobeFit& worn, const mesh::Seam& seam,
                                          const std::vector<SeamView>& views, SeamSide side, const std::string& part,
                                          std::uint64_t seed) const {
  const State& s = *state_;
  const auto found = std::ranges::find(s.mesh->parts, part, &mesh::MeshPart::name);
  if (found == s.mesh->parts.end()) return usage_error("the mesh has no part \"{}\"", part);
  const int number = static_cast<int>(found - s.mesh->parts.begin());
  render::Scene scene;
  scene.mesh = s.mesh, scene.env = s.env;
  scene.paints.assign(s.mesh->parts.size(), worn);
  render::PathScene path;
  path.scene = &scene, path.environment = &*s.sky, path.table = s.table, path.rays = s.rays;
  GONIO_ASSIGN(const render::Transport transport, render::Transport::create(path));
  GONIO_ASSIGN(const render::WornPaints groups, render::worn_paints(s.columns, path));
  GONIO_ASSIGN(const render::OpenLight open,
               render::OpenLight::create(scene, s.columns, std::vector<double>(s.mesh->parts.size(), worn.coat_index)));
  Seen seen;
  seen.lights.resize(views.size()), seen.open.resize(views.size());
  std::vector<char> beside(views.size());
  parallel_for(views.size(), kTogether, [&](std::size_t begin, std::size_t end) {
    std::vector<color::Rgb> columns(s.columns.count());
    for (std::size_t i = begin; i < end; ++i) {
      const SeamView& view = views[i];
      const mesh::SeamPoint& p = seam.points[view.point];
      const bool is_a = side == SeamSide::kA;
      const Vec3 normal = is_a ? p.normal_a : p.normal_b;
      open.at(normal, view.view, number, columns.data());
      seen.open[i] = columns;
      seen.lights[i] = seen.open[i];
      if (s.open) continue;
      auto spot = s.spot(is_a ? p.a : p.b, is_a ? -p.across : p.across, normal, number);
      beside[i] = spot ? 0 : 1;
      if (spot) {
        spot->shading = rays::float3(normal);  // that of the panel as it is judged
        std::uint64_t own = render::mixed(seed, view.point);
        for (const double c : {view.view.x, view.view.y, view.view.z})
          own = render::mixed(own, std::bit_cast<std::uint64_t>(c));
        const render::LobePoint point(transport, s.columns, groups.groups, kBounces, *spot, rays::float3(view.view));
        const render::LobeEstimate estimate = point.estimate(columns.data(), kSequences, kDirections, own);
        for (std::size_t k = 0; k < columns.size(); ++k) columns[k] = estimate.direct[k] + estimate.bounced[k];
      }
      seen.lights[i] = columns;
    }
  });
  seen.beside = static_cast<std::size_t>(std::ranges::count(beside, 1));
  return seen;
}

namespace {

SeamLights open_lights(const EnvironmentPanels& panels, const mesh::Seam& seam, const std::vector<SeamView>& views) {
  SeamLights lights;
  for (const SeamView& view : views) {
    lights.a.push_back(panels.light(seam.points[view.point].normal_a, view.view));
    lights.b.push_back(panels.light(seam.points[view.point].normal_b, view.view));
  }
  return lights;
}

std::vector<double> differences(const EnvironmentPanels& panels, const paint::LobeFit& paint,
                                const SeamLights& lights) {
  std::vector<double> de;
  for (std::size_t i = 0; i < lights.a.size(); ++i)
    de.push_back(color::delta_e_76(panels.color(paint, lights.a[i]), panels.color(paint, lights.b[i])));
  return de;
}

double apart_p95(const std::vector<double>& one, const std::vector<double>& other) {
  std::vector<double> apart;
  for (std::size_t i = 0; i < one.size(); ++i) apart.push_back(std::abs(one[i] - other[i]));
  return math::percentile_95(std::move(apart));
}

}  // namespace

Result<SeamLights> seam_lights(const EnvironmentPanels& panels, const TracedSeam* traced, const paint::LobeFit& worn,
                               const mesh::Seam& seam, const std::vector<SeamView>& views, const std::string& part_a,
                               const std::string& part_b) {
  if (traced == nullptr) return open_lights(panels, seam, views);
  SeamLights open;
  const auto traced_lights = [&](const std::vector<SeamView>& of, std::uint64_t seed) -> Result<SeamLights> {
    GONIO_ASSIGN(TracedSeam::Seen a, traced->seen(worn, seam, of, SeamSide::kA, part_a, seed));
    GONIO_ASSIGN(TracedSeam::Seen b, traced->seen(worn, seam, of, SeamSide::kB, part_b, seed));
    open.a = std::move(a.open), open.b = std::move(b.open);
    return SeamLights{std::move(a.lights), std::move(b.lights), a.beside + b.beside};
  };
  GONIO_ASSIGN(SeamLights lights, traced_lights(views, 1));
  if (traced->is_open()) return lights;
  const std::vector<double> de = differences(panels, worn, lights);
  lights.worth_de76 = apart_p95(de, differences(panels, worn, open));
  constexpr std::size_t kTriedAgain = 100;
  std::vector<SeamView> some;
  std::vector<double> first;
  for (const std::size_t i : spread_places(views.size(), kTriedAgain)) some.push_back(views[i]), first.push_back(de[i]);
  GONIO_ASSIGN(const SeamLights again, traced_lights(some, 2));
  // A standard deviation of two tracings is half of the bound that 95 % stay within.
  lights.noise_de76 = apart_p95(first, differences(panels, worn, again)) / (2 * std::sqrt(2.0));
  return lights;
}

}  // namespace goniochrome::panels
