#include "stage.h"

#include <algorithm>
#include <cmath>

#include "base/paths.h"
#include "base/text.h"
#include "image/aov_file.h"
#include "image/image.h"
#include "mesh/unit.h"
#include "render/aov.h"
#include "render/panes.h"
#include "render/trim.h"
#include "spectra.h"
#include "stream.h"

namespace goniochrome::tool {

namespace {

void tell_repairs(const mesh::Mesh& mesh, cli::Session& session) {
  const mesh::Mesh::Repairs& repairs = mesh.repairs;
  session.results()["triangles"] = mesh.triangles.size();
  session.results()["repairs"] = {{"normals_made", repairs.normals_made},
                                  {"degenerate_dropped", repairs.degenerate_dropped},
                                  {"polygons_split", repairs.polygons_split},
                                  {"triangles_turned", repairs.triangles_turned}};
  const double longest = mesh::bounding_box(mesh).longest_side();
  const mesh::LengthUnit unit = mesh::length_unit(mesh);
  session.results()["mesh"] = {{"longest_side", json_number(longest)}, {"unit_m", unit.meters}};
  if (unit.meters != 1)
    session.say(
        fmt::format("the mesh is {:.4g} units long, which are taken as {} ({:.3g} m): places and heights are in "
                    "units of the mesh",
                    longest, unit.name, longest * unit.meters));
  if (repairs.normals_made > 0) {
    session.say(fmt::format("{} of {} vertices had no normal and got one", repairs.normals_made, mesh.normals.size()));
  }
  for (const std::string& remark : mesh.remarks) session.warn(remark);
}

// Tells the parts that --trim recognized, each kind with the names of its first parts.
void tell_trim(const mesh::Mesh& mesh, const DressedMesh& dress, cli::Session& session) {
  if (dress.trim.empty())
    return session.warn(
        fmt::format("--trim recognized none of {} parts: give them names with words such as glass, tire or rim, or "
                    "dress them by --part",
                    mesh.parts.size()));
  constexpr std::size_t kMost = 4;
  std::string told;
  for (const auto& [kind, word] : {std::pair{render::TrimKind::kGlass, "glass"},
                                   {render::TrimKind::kBlack, "black"},
                                   {render::TrimKind::kMetal, "metal"}}) {
    std::vector<std::string> names;
    for (const std::size_t part : dress.trim)
      if (render::trim_kind(mesh.parts[part]) == kind) names.push_back(mesh.parts[part].name);
    if (names.empty()) continue;
    const std::size_t more = names.size() - std::min(names.size(), kMost);
    names.resize(names.size() - more);
    told += fmt::format("{}{} on {}{}", told.empty() ? "" : "; ", word, joined(names, ", "),
                        more > 0 ? fmt::format(" and {} more", more) : "");
  }
  session.say(fmt::format("--trim: {}: {} of {} parts", told, dress.trim.size(), mesh.parts.size()));
}

void tell_parts(const mesh::Mesh& mesh, const DressedMesh& dress, bool streamed, cli::Session& session) {
  Json& results = session.results();
  for (std::size_t i = 0; i < mesh.parts.size(); ++i) {
    const Json paint = dress.names[i].empty() ? Json(nullptr) : Json(dress.names[i]);
    results["parts"].push_back({{"name", mesh.parts[i].name}, {"material", mesh.parts[i].material}, {"paint", paint}});
  }
  for (const LaidTexture& laid : dress.laid) {
    results["textures"].push_back({{"part", laid.part},
                                   {"file", laid.file},
                                   {"projection", laid.projection},
                                   {"width", laid.width ? json_number(*laid.width) : Json(nullptr)}});
    session.explain(fmt::format(
        "{} on {}: {}{}\n", laid.file, laid.part,
        laid.projection == "uv" ? "by the texture coordinates of the mesh" : "projected by " + laid.projection,
        laid.width ? fmt::format(", {:.4g} units of the mesh wide", *laid.width) : ""));
  }
  for (const std::string& part : dress.unplaced)
    session.warn(
        fmt::format("{} has no texture coordinates: its texture is projected by a box; --texture "
                    "PART=FILE,project=cylinder and the like choose",
                    part));
  if (dress.unpainted.empty() || streamed) return;
  session.warn(fmt::format("{} of {} parts have no paint and are matt gray: {}: give --paint or --part",
                           dress.unpainted.size(), mesh.parts.size(), first_names(dress.unpainted)));
}

Result<void> dress_stage(Options options, Stage& stage) {
  std::vector<std::string> paints;
  for (const std::string& text : options.split) {
    for (const std::string_view paint : split(text, ',')) paints.emplace_back(trimmed(paint));
  }
  if (!options.split.empty() && paints.size() != 2)
    return usage_error("--split names {} paints: write two, A.xml#NAME,B.xml#NAME", paints.size());
  if (options.split.empty()) paints = {options.paint};
  // A transport has the light that mirrors show of its own environment.
  const bool with_mirrors = !options.env.empty() || (stage.transport && !stage.transport->file.environment.empty());
  for (const std::string& paint : paints) {
    options.paint = paint;
    GONIO_ASSIGN(DressedMesh dress, dressed(stage.mesh, options, with_mirrors));
    stage.dresses.push_back(std::move(dress));
  }
  return {};
}

// A transport may show squares of its points as pixels.
Result<void> check_samples(const Options& options, const Request& request, const Stage& stage) {
  if (request.samples == 1) return {};
  if (!stage.transport)
    return usage_error("--samples is {}: --gbuffer holds pixel centers, 1 sample each", request.samples);
  const int side = request.points_across();
  if (stage.gbuffer->width % side != 0 || stage.gbuffer->height % side != 0)
    return usage_error("--samples is {}: {} has {} x {} points, which are no whole squares of {} x {}", request.samples,
                       options.gbuffer, stage.gbuffer->width, stage.gbuffer->height, side, side);
  if (!request.aovs.empty())
    return usage_error("--samples is {}, and --aov holds pixel centers: leave one of them out", request.samples);
  return {};
}

// The buffers of --gbuffer, and a mesh that has their parts.
Result<void> set_gbuffer(const Options& options, const Request& request, Stage& stage, cli::Session& session) {
  GONIO_ASSIGN(image::AovFile buffers,
               image::read_aov_file(options.gbuffer, {"normal.X", "normal.Y", "normal.Z", "part"}));
  GONIO_ASSIGN(auto light, render::transport_points(buffers));
  GONIO_ASSIGN(render::Gbuffer gbuffer, render::gbuffer_of(buffers));
  stage.gbuffer = std::make_shared<const render::Gbuffer>(std::move(gbuffer));
  for (std::size_t i = 0; i < buffers.parts.size(); ++i)
    stage.mesh.parts.push_back({buffers.parts[i], buffers.materials[i], 0, 0});
  GONIO_ASSIGN(stage.transport, kept_transport(std::move(light), std::move(buffers), options, request, session));
  // A floor keeps the paint that it wore.
  if (stage.transport && stage.transport->light.worn.has_floor) stage.mesh.parts.pop_back();
  if (!stage.transport && options.env.empty() && request.lights.empty())
    return usage_error("there is no light: give --env, --light or both");
  if (stage.transport && options.check > 0)
    return usage_error("--check compares with light that nothing blocks: leave it out, or give --mesh");
  if (stage.transport && !options.split.empty())
    return usage_error("--split is not drawn from a transport: draw two pictures");
  return check_samples(options, request, stage);
}

// The floor of a picture by an engine with prefiltered maps.
Result<void> set_projected_floor(const Request& request, const Stage& stage, render::RaySetup& rays) {
  rays.no_floor = "no floor is asked for: --floor shadow has one, and --background env calls for it";
  if (request.floor.kind == FloorRequest::Kind::kNone) return {};
  render::Scene over = stage.scene;
  GONIO_TRY(set_ground(request.floor, stage.floor_paint, over));
  rays.floor = over.ground, rays.floor_forced = request.floor_named;
  if (!rays.absent.empty() && request.floor_named)
    return usage_error("--floor shadow is drawn by rays, and there are none: {}", rays.absent);
  return {};
}

// Surfaces below a floor are hidden by rays alone.
Result<void> take_path_below(const mesh::Mesh& mesh, Request& request) {
  if (request.traces() || request.floor.kind == FloorRequest::Kind::kNone || !request.floor.height) return {};
  const mesh::Box box = mesh::bounding_box(mesh);
  if (*request.floor.height <= box.low.y + 1e-6 * box.longest_side()) return {};
  if (request.engine != nullptr)
    return usage_error(
        "--floor lies at {}, above the lowest point of the mesh, which is at {:.6g}: --engine path hides what is below",
        shortest(*request.floor.height), box.low.y);
  const auto tracer = std::ranges::find_if(render::engines(), [](const auto* engine) { return engine->traces_rays; });
  request.engine = *tracer, request.plan.engine = (*tracer)->name;
  return {};
}

// The light that rays meet, and that is summed. Prefiltered environments hold it in their mirror part, unless that was
// left out.
Result<void> set_rays(const Options& options, const Request& request, Stage& stage) {
  if (request.traces()) return {};
  render::RaySetup& rays = stage.rays.emplace();
  const bool mirrored = !options.env.empty() && stage.env.mirror.map.size > 0;
  if (options.effects.leave_out_rays()) {
    rays.absent = "left out by --effects: what it is worth was not measured";
    rays.refused = true;
  } else if (!options.gbuffer.empty()) {
    rays.absent = "buffers without their mesh: what it blocks is not known, nor what that is worth";
  } else if (!options.env.empty() && !mirrored) {
    rays.absent =
        "the environment has no mirror part, which rays would meet: make it without --no-mirror. What the mesh does "
        "to light is not known, nor what that is worth";
  }
  if (mirrored && (rays.absent.empty() || options.effects.forced_on("sums").value_or(false))) {
    stage.sky.emplace(envmap::Environment::from_cube(stage.env.mirror.map, options.env));
    rays.environment = &*stage.sky;
  }
  return set_projected_floor(request, stage, rays);
}

}  // namespace

void wear(const DressedMesh& dress, const Options& options, Stage& stage) {
  render::Scene& scene = stage.scene;
  scene.paints = dress.paints;
  scene.gloss_deg = dress.gloss_deg;
  scene.anisotropy = dress.anisotropy;
  scene.tilt_error = options.tilt_error, scene.most_tilts = options.most_tilts;
  scene.panes = dress.panes;
  scene.flakes.clear();
  for (const auto& worn : dress.worn)
    scene.flakes.push_back(worn != nullptr ? paint::known_flakes(*worn) : std::nullopt);
  stage.layer = std::make_unique<render::SurfaceLayer>(
      scene, dress.surfaces, brdf::critical_angle_of(options.critical_angle).value_or(brdf::CriticalAngle::kSlide),
      stage.mip ? &*stage.mip : nullptr);
  scene.layer = stage.layer->empty() ? nullptr : stage.layer.get();
}

Result<void> set_stage(const Options& options, Request& request, Stage& stage, cli::Session& session) {
  if (options.gbuffer.empty()) {
    GONIO_ASSIGN(stage.mesh, mesh::read_mesh(options.mesh));
    tell_repairs(stage.mesh, session);
    GONIO_TRY(take_path_below(stage.mesh, request));
  } else {
    GONIO_TRY(set_gbuffer(options, request, stage, session));
  }
  Options base = options;
  if (is_stream(options)) base.paint.clear();  // its paints come one by one
  GONIO_TRY(dress_stage(base, stage));
  if (stage.transport)
    GONIO_TRY(read_light(is_stream(options) ? nullptr : &stage.dresses.front(), stage.mesh, *stage.transport));
  if (options.trim) tell_trim(stage.mesh, stage.dresses.front(), session);
  for (const DressedMesh& dress : stage.dresses) {
    for (const std::string& remark : dress.remarks) session.warn(remark);
    for (const std::string& line : dress.fitted) session.say(line);
  }
  tell_parts(stage.mesh, stage.dresses.front(), is_stream(options), session);
  render::Scene& scene = stage.scene;
  scene.mesh = &stage.mesh;
  scene.lights = request.lights;
  if (options.gbuffer.empty()) {
    GONIO_TRY(stand_lamps(stage.mesh, scene.lights));
  } else if (std::ranges::any_of(scene.lights, [](const render::Light& light) { return light.place.has_value(); })) {
    return usage_error("--gbuffer holds no places, so that no lamp can stand at one: give --mesh");
  }
  scene.reflection = request.reflection;
  if (!options.env.empty()) {
    GONIO_ASSIGN(stage.env, environment_of(options, request, stage, session));
    scene.env = &stage.env;
    if (options.texture_maps == "mip" && !options.textures.empty()) {
      GONIO_ASSIGN(stage.mip, render::mip_cube(stage.env));
    }
  }
  wear(stage.dresses.front(), options, stage);
  if (render::has_panes(scene) && !options.gbuffer.empty())
    return usage_error("--part dresses a part in glass, and --gbuffer does not hold what lies behind it: give --mesh");
  if (request.floor.kind == FloorRequest::Kind::kPaint) {
    GONIO_ASSIGN(stage.floor_paint, paint_named(request.floor.paint, options, session));
  }
  GONIO_TRY(set_rays(options, request, stage));
  const bool summed = request.engine != nullptr && request.engine->needs_texels;
  if (options.check > 0 || summed || request.transport) {
    GONIO_ASSIGN(stage.source, source_of(options, scene, session));
  }
  if (summed && stage.source.environment) scene.texels = &stage.texels.emplace(*stage.source.environment);
  if (request.traces()) GONIO_TRY(set_ground(request.floor, stage.floor_paint, scene));
  GONIO_ASSIGN(scene.emission, emission_of(stage.mesh, request.emissions));
  for (std::size_t part = 0; part < scene.emission.size(); ++part)
    if (render::is_pane(scene, part) && !(scene.emission[part] == color::Rgb{}))
      return usage_error("--emit makes \"{}\" shine, and --part makes it glass, which does not: leave out one of both",
                         stage.mesh.parts[part].name);
  GONIO_TRY(set_spectra(options, request, stage, session));
  return set_background(scene, options.background);
}

}  // namespace goniochrome::tool
