#include <algorithm>
#include <cmath>
#include <list>

#include "base/clock.h"
#include "base/parallel.h"
#include "brdf/coat_facets.h"
#include "brdf/lobe_model.h"
#include "paint_views.h"
#include "rays/ray_scene.h"
#include "render/light_transport.h"
#include "render/panes.h"
#include "stream.h"

namespace goniochrome::tool {

namespace {

constexpr std::size_t kMostSamples = std::size_t{1} << 20;  // of all pixels
constexpr std::size_t kMostKept = 8;                        // coats whose light is kept
constexpr double kCoatStep = 0.02;

double rounded_coat(double index) {
  return index == paint::kNoCoat ? index : kCoatStep * std::round(index / kCoatStep);
}

// The light of the view for paints under one coat.
struct OpenView {
  double coat = paint::kNoCoat;
  render::LobeColumns columns;
  std::vector<double> coats;  // of each part
  std::size_t classes = 0;
  std::unique_ptr<render::TransportShader> shader;
};

class OpenViews : public PaintViews {
 public:
  OpenViews(const Options& options, const Request& request, Stage& stage, std::unique_ptr<PaintViews> others)
      : options_(options),
        request_(request),
        stage_(stage),
        others_(std::move(others)),
        wardrobe_(stage.dresses.front()) {
    stops = others_->stops, automatic_stops = others_->automatic_stops, white_luminance = others_->white_luminance;
    render::Plan looked_up;
    looked_up.engine = "cpu", looked_up.engine_reason = "the light of each lobe is looked up once for all paints";
    plan = std::make_shared<render::Plan>(std::move(looked_up));
  }

  Result<void> draw(const SourcePaint& paint, PaintView& view) override {
    if (paint.paint.anisotropy || paint.map != nullptr || !paint.paint.lobes->tilts.empty() ||
        brdf::stands_for_coat(*paint.paint.lobes))
      return others_->draw(paint, view);
    const auto kept = view_of(paint);
    if (!kept.ok()) return others_->draw(paint, view);
    const OpenView* open = *kept;
    const DressedMesh& dress = wardrobe_.in(paint);
    std::vector<render::TransportPaint> worn;
    for (std::size_t part = 0; part < dress.paints.size(); ++part) {
      const paint::LobeFit fit = brdf::under_coat(dress.paints[part], open->coats[part]);
      auto one = render::transport_paint(open->columns, fit, dress.gloss_deg[part]);
      if (!one.ok()) return others_->draw(paint, view);
      worn.push_back(*std::move(one));
    }
    const Stopwatch shading;
    prepare(stacked_);
    const color::ReflectionOperator* reflection = render::operator_or_null(stage_.scene.reflection);
    const render::BounceScale none{false, std::vector<color::Rgb>(open->classes, color::Rgb{1, 1, 1})};
    open->shader->shade(worn, reflection, none, 1, stacked_);
    render::put_mean(stacked_, static_cast<int>(samples_.size()), view.picture);
    view.shading_ms = 1000 * shading.elapsed_s(), view.bounced_de00_p95 = 0;
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
  Result<const OpenView*> view_of(const SourcePaint& paint) {
    const double coat = rounded_coat(paint.paint.lobes->coat_index);
    const auto kept = std::ranges::find(kept_, coat, &OpenView::coat);
    if (kept != kept_.end()) {
      kept_.splice(kept_.begin(), kept_, kept);
      return &kept_.front();
    }
    GONIO_TRY(look());
    if (kept_.size() == kMostKept) kept_.pop_back();
    GONIO_ASSIGN(OpenView made, made_for(coat));
    kept_.push_front(std::move(made));
    return &kept_.front();
  }

  Result<OpenView> made_for(double coat) const {
    OpenView view;
    view.coat = coat;
    const DressedMesh& base = stage_.dresses.front();
    render::Scene scene = stage_.scene;
    scene.paints = base.paints, scene.anisotropy.clear(), scene.gloss_deg = base.gloss_deg;
    for (std::size_t part = 0; part < base.paints.size(); ++part)
      view.coats.push_back(base.names[part].empty() ? coat : base.paints[part].coat_index);
    GONIO_ASSIGN(view.columns, render::lobe_columns(scene));
    render::PathScene path;
    path.scene = &scene;
    GONIO_ASSIGN(const render::WornPaints worn, render::worn_paints(view.columns, path));
    view.classes = worn.groups.classes();
    GONIO_ASSIGN(const render::OpenLight light, render::OpenLight::create(scene, view.columns, view.coats));
    const render::LobeTransport open = render::open_transport(light, view.columns, worn, samples_);
    std::vector<const render::Gbuffer*> seen;
    for (const auto& sample : samples_) seen.push_back(sample.get());
    view.shader = std::make_unique<render::TransportShader>(open, render::view_angles_deg(open, seen));
    return view;
  }

  // The samples below each other, with what is seen beside the mesh. Shading changes the others alone.
  void prepare(image::Image& stacked) const {
    const int width = samples_.front()->width, height = samples_.front()->height * static_cast<int>(samples_.size());
    const std::size_t floats = 4 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    if (stacked.data.size() == floats) return;
    stacked = {width, height, 4, std::vector<float>(floats, 0.0F), {}};
    if (stage_.scene.background != render::Background::kColor) return;
    for (std::size_t i = 0; i < floats; i += 4) {
      for (int c = 0; c < 3; ++c)
        stacked.data[i + static_cast<std::size_t>(c)] = static_cast<float>(stage_.scene.background_color[c]);
      stacked.data[i + 3] = 1;
    }
  }

  const Options& options_;
  const Request& request_;
  Stage& stage_;
  std::unique_ptr<PaintViews> others_;
  Wardrobe wardrobe_;
  std::vector<std::shared_ptr<const render::Gbuffer>> samples_;
  std::list<OpenView> kept_;  // the one used last is the first
  image::Image stacked_;
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
