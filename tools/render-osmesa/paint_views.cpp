#include "paint_views.h"

#include <utility>

#include "image/shrink.h"
#include "plan_text.h"
#include "render/aov.h"
#include "render/effect_union.h"
#include "render/scene_effects.h"
#include "stream.h"

namespace goniochrome::tool {

Wardrobe::Wardrobe(const DressedMesh& base) : dress_(base), parts_(free_parts(base)) {}

const DressedMesh& Wardrobe::in(const SourcePaint& paint) {
  for (const std::size_t part : parts_) put_on(part, paint.paint, paint.map.get(), dress_);
  map_ = paint.map;
  return dress_;
}

std::vector<std::size_t> free_parts(const DressedMesh& dress) {
  std::vector<std::size_t> parts;
  for (std::size_t part = 0; part < dress.names.size(); ++part)
    if (dress.names[part].empty()) parts.push_back(part);
  return parts;
}

TransportViews::TransportViews(const Options& options, const Request& request, Stage& stage, cli::Session& session)
    : session_(session),
      points_across_(request.points_across()),
      wardrobe_(stage.dresses.front()),
      shader_(stage.transport->light, {stage.gbuffer.get()}, stage.scene) {
  const double automatic = stage.transport->file.automatic_stops;
  exposure = {{stage.transport->file.white_luminance, {0, 1, 0}}, request.stops_by(automatic), automatic};
  render::Plan kept;
  kept.engine = "transport", kept.engine_reason = options.gbuffer + " holds the light by lobes";
  plan = std::make_shared<render::Plan>(std::move(kept));
}

Result<void> TransportViews::draw(const SourcePaint& paint, PaintView& view) {
  GONIO_ASSIGN(const ShadedPaint shaded, show(wardrobe_.in(paint), view.picture));
  view.shading_ms = shaded.frame_ms + shaded.scale_ms;
  view.bounced_de00_p95 = shaded.bounced_de00_p95;
  return {};
}

Result<ShadedPaint> TransportViews::show(const DressedMesh& dress, image::Image& picture) {
  GONIO_ASSIGN(const ShadedPaint shaded, shader_.shade(dress, points_across_ > 1 ? points_ : picture));
  if (points_across_ > 1) image::shrink(points_, points_across_, picture);
  session_.results()["transport"] = shader_.figures(shaded, session_.common().tolerance);
  if (shaded.coat_changed && !std::exchange(is_coat_told_, true))
    session_.warn(
        "a paint has a coat and took the place of one without it, or the other way round: toward grazing the picture "
        "is that of the paint whose light was traced");
  return shaded;
}

namespace {

// An engine draws the effects that any of the paints so far has called for. The plan of a paint would leave out what is
// not seen in that paint, which says nothing about the others.
class EngineViews : public PaintViews {
 public:
  EngineViews(const Options& options, const Request& request, Stage& stage, cli::Session& session,
              render::Renderer renderer)
      : options_(options),
        request_(request),
        stage_(stage),
        session_(session),
        wardrobe_(stage.dresses.front()),
        renderer_(std::move(renderer)) {}

  Result<void> begin() {
    if (options_.gbuffer.empty()) {
      GONIO_ASSIGN(camera_, camera_of(options_, stage_.mesh, request_.size));
    }
    GONIO_ASSIGN(auto seen, renderer_.look(stage_.mesh, view()));
    looks_ = {seen};
    exposure = begin_sight(renderer_, *seen, stage_, request_, session_);
    return {};
  }

  Result<void> draw(const SourcePaint& paint, PaintView& view_of_paint) override {
    wear(wardrobe_.in(paint), options_, stage_);
    GONIO_TRY(load());
    std::swap(frame_.picture, view_of_paint.picture);
    const Result<void> drawn = renderer_.draw(view(), frame_);
    std::swap(frame_.picture, view_of_paint.picture);
    GONIO_TRY(drawn);
    view_of_paint.shading_ms = frame_.frame_ms;
    gbuffer_ms = frame_.gbuffer_ms;
    return {};
  }

 private:
  render::View view() const { return {camera_, request_.size.width, request_.size.height, request_.samples, false}; }

  // Loads what the paint that is worn calls for, unless that is loaded.
  Result<void> load() {
    const render::Effects wanted = render::effects_of(stage_.scene);
    if (is_loaded_ && render::covers(covered_, wanted)) {
      renderer_.load_paints(stage_.scene);
      return {};
    }
    GONIO_ASSIGN(render::Plan made, renderer_.load(stage_.scene, looks_, request_.plan));
    const bool is_first = !std::exchange(is_loaded_, true);
    if (is_first) tell(made);
    // Every paint of the environment's basis is drawn without loading again.
    const bool all_lobes = is_first && stage_.scene.env != nullptr && options_.effects == stream_effects();
    covered_ = is_first ? wanted : render::united(covered_, wanted);
    if (!is_first) made.effects = render::united(plan->effects, made.effects);
    if (all_lobes) {
      covered_ = render::with_all_lobes(covered_, *stage_.scene.env);
      made.effects = render::with_all_lobes(made.effects, *stage_.scene.env);
    }
    if (!is_first || all_lobes) GONIO_TRY(renderer_.load(stage_.scene, made.effects, made.engine));
    request_.plan.engine = made.engine;
    plan = std::make_shared<render::Plan>(std::move(made));
    return {};
  }

  void tell(const render::Plan& first) {
    for (Json& row : plan_rows(first)) session_.results()["plan"].push_back(std::move(row));
    session_.explain(plan_table(first));
    for (const std::string& remark : renderer_.remarks()) session_.warn(remark);
  }

  const Options& options_;
  Request request_;
  Stage& stage_;
  cli::Session& session_;
  Wardrobe wardrobe_;
  render::Renderer renderer_;
  render::Camera camera_;
  std::vector<std::shared_ptr<const render::Gbuffer>> looks_;
  render::Effects covered_;  // what the paints so far call for
  bool is_loaded_ = false;
  render::Frame frame_;  // without its picture
};

}  // namespace

Result<std::unique_ptr<PaintViews>> paint_views(const Options& options, const Request& request, Stage& stage,
                                                cli::Session& session) {
  if (free_parts(stage.dresses.front()).empty())
    return usage_error("every part wears what --part, --trim or --texture says: leave one for the paints of --paint");
  session.explain(explanation(options, stage.mesh, stage.dresses.front()));
  if (stage.transport)
    return std::unique_ptr<PaintViews>(std::make_unique<TransportViews>(options, request, stage, session));
  GONIO_ASSIGN(render::Renderer renderer, make_renderer(options, request, stage, session));
  auto views = std::make_unique<EngineViews>(options, request, stage, session, std::move(renderer));
  GONIO_TRY(views->begin());
  return open_views(options, request, stage, session, std::move(views));
}

}  // namespace goniochrome::tool
