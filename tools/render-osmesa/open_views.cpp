#include <algorithm>
#include <cmath>
#include <list>

#include "base/clock.h"
#include "brdf/coat_facets.h"
#include "paint_views.h"
#include "rays/ray_scene.h"
#include "render/light_transport.h"
#include "render/panes.h"
#include "stream.h"

namespace goniochrome::tool {

namespace {

constexpr std::size_t kMostSamples = std::size_t{1} << 20;  // of all pixels
constexpr std::size_t kMostKept = 8;                        // coats whose light is kept
constexpr double kCoatSteps = 50;                           // of the index, in 1

double rounded_coat(double index) {
  return index == paint::kNoCoat ? index : std::round(kCoatSteps * index) / kCoatSteps;
}

// The light of the view for paints under one coat.
struct OpenView {
  double coat = paint::kNoCoat;
  render::LobeTransport light;
  std::optional<ViewShader> shader;
};

class OpenViews : public PaintViews {
 public:
  OpenViews(const Options& options, const Request& request, Stage& stage, std::unique_ptr<PaintViews> others)
      : options_(options),
        request_(request),
        stage_(stage),
        others_(std::move(others)),
        wardrobe_(stage.dresses.front()) {
    exposure = others_->exposure;
    render::Plan looked_up;
    looked_up.engine = "cpu", looked_up.engine_reason = "the light of each lobe is looked up once for all paints";
    plan = std::make_shared<render::Plan>(std::move(looked_up));
  }

  Result<void> draw(const SourcePaint& paint, PaintView& view) override {
    if (paint.map != nullptr || !paint.paint.lobes->tilts.empty() || brdf::stands_for_coat(*paint.paint.lobes))
      return others_->draw(paint, view);
    const auto kept = view_of(paint);
    if (!kept.ok()) return others_->draw(paint, view);
    const auto shaded = (*kept)->shader->shade(wardrobe_.in(paint), stacked_);
    if (!shaded.ok()) return others_->draw(paint, view);
    const Stopwatch clock;
    render::put_mean(stacked_, static_cast<int>(samples_.size()), view.picture);
    view.shading_ms = shaded->frame_ms + 1000 * clock.elapsed_s(), view.bounced_de00_p95 = 0;
    return {};
  }

 private:
  // The samples of all pixels are looked up.
  Result<void> look() {
    if (!samples_.empty()) return {};
    if (stage_.gbuffer) {
      samples_ = {stage_.gbuffer};
      return {};
    }
    const Stopwatch clock;
    GONIO_ASSIGN(const render::Camera camera, camera_of(options_, stage_.mesh, request_.size));
    GONIO_ASSIGN(const render::Rays centers, render::rays(camera, request_.size.width, request_.size.height));
    GONIO_ASSIGN(const rays::RayScene mesh, rays::RayScene::create(stage_.mesh));
    for (const auto& [x, y] : render::sample_shifts(request_.samples)) {
      render::Rays shifted = centers;
      shifted.corner += x * centers.right + y * centers.down;
      auto seen = render::visible_surface(mesh, shifted, request_.size.width, request_.size.height);
      samples_.push_back(std::make_shared<const render::Gbuffer>(std::move(seen)));
    }
    gbuffer_ms = 1000 * clock.elapsed_s() / static_cast<double>(samples_.size());
    return {};
  }

  // The light for the coat of this paint, and for views where its weights change with them.
  Result<OpenView*> view_of(const SourcePaint& paint) {
    const double coat = rounded_coat(paint.paint.lobes->coat_index);
    const auto kept = std::ranges::find(kept_, coat, &OpenView::coat);
    if (kept != kept_.end()) {
      kept_.splice(kept_.begin(), kept_, kept);
      return &kept_.front();
    }
    GONIO_TRY(look());
    GONIO_ASSIGN(render::LobeTransport light, light_under(coat));
    if (kept_.size() == kMostKept) kept_.pop_back();
    OpenView& made = kept_.emplace_front(coat, std::move(light));
    std::vector<const render::Gbuffer*> seen;
    for (const auto& sample : samples_) seen.push_back(sample.get());
    made.shader.emplace(made.light, std::move(seen), stage_.scene);
    return &made;
  }

  Result<render::LobeTransport> light_under(double coat) const {
    const DressedMesh& base = stage_.dresses.front();
    render::Scene scene = stage_.scene;
    scene.paints = base.paints, scene.anisotropy.clear(), scene.gloss_deg = base.gloss_deg;
    GONIO_ASSIGN(const render::LobeColumns columns, render::lobe_columns(scene));
    render::PathScene path;
    path.scene = &scene;
    GONIO_ASSIGN(render::WornPaints worn, render::worn_paints(columns, path));
    for (const std::size_t part : free_parts(base)) worn.coats[part] = coat;
    GONIO_ASSIGN(const render::OpenLight light, render::OpenLight::create(scene, columns, worn.coats));
    return render::open_transport(light, columns, worn, samples_);
  }

  const Options& options_;
  const Request& request_;
  Stage& stage_;
  std::unique_ptr<PaintViews> others_;
  Wardrobe wardrobe_;
  std::vector<std::shared_ptr<const render::Gbuffer>> samples_;
  std::list<OpenView> kept_;  // the one used last is the first
  image::Image stacked_;      // the samples below each other
};

bool has_open_views(const Options& options, const Request& request, const Stage& stage) {
  const std::size_t samples = static_cast<std::size_t>(request.size.width) *
                              static_cast<std::size_t>(request.size.height) * static_cast<std::size_t>(request.samples);
  const DressedMesh& base = stage.dresses.front();
  const bool brushed = std::ranges::any_of(base.anisotropy, [](const auto& alpha) { return alpha.alpha_x > 0; });
  const bool tilted = std::ranges::any_of(base.paints, [](const paint::LobeFit& fit) { return !fit.tilts.empty(); });
  return stage.scene.env != nullptr && stage.env.mirror.map.size > 0 && stage.env.diffuse.map.size > 0 &&
         stage.scene.lights.empty() && stage.scene.layer == nullptr && !render::has_panes(stage.scene) && !brushed &&
         !tilted && samples <= kMostSamples && stage.scene.background != render::Background::kEnvironment &&
         options.effects == stream_effects() && (options.engine == "auto" || options.engine == "cpu");
}

}  // namespace

std::unique_ptr<PaintViews> open_views(const Options& options, const Request& request, Stage& stage,
                                       cli::Session& session, std::unique_ptr<PaintViews> others) {
  if (!has_open_views(options, request, stage)) return others;
  session.explain(
      "the light of each lobe is looked up once, for every sample of the pixels, and serves all paints: no effect is "
      "left out, and no rays are traced\n");
  return std::make_unique<OpenViews>(options, request, stage, std::move(others));
}

}  // namespace goniochrome::tool
