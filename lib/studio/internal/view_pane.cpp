#include "studio/internal/view_pane.h"

#include <algorithm>
#include <cmath>

#include "brdf/lobe_model.h"
#include "render/trim.h"

namespace goniochrome::studio {

namespace {

// The pictures of tiles are about this wide.
constexpr int kTileWidth = 208;

// The default of render-osmesa: beyond it, bounced light should be traced again.
constexpr double kTolerance_de00 = 0.5;

image::Image thinned_picture(const image::Image& picture, int n) {
  image::Image thin = image::even_image(picture.width / n, picture.height / n, 4);
  for (int y = 0; y < thin.height; ++y)
    for (int x = 0; x < thin.width; ++x) std::copy_n(picture.pixel(n * x + n / 2, n * y + n / 2), 4, thin.pixel(x, y));
  return thin;
}

}  // namespace

Result<ViewPane> ViewPane::make(std::string_view bytes, JsonReader& request) {
  GONIO_ASSIGN(render::UnpackedView view, render::unpacked_view(bytes));
  ViewPane pane;
  const bool with_mirror = request.flag("mirrors");
  const std::vector<double> numbers = request.numbers("operator", 27);
  auto number = numbers.begin();
  for (auto& matrix : pane.reflection_.k)
    for (auto& row : matrix)
      for (double& value : row) value = *number++;
  for (const Json& part : request.list("parts")) {
    JsonReader of(part);
    const mesh::MeshPart named{of.text("name"), of.text("material", ""), 0, 0};
    GONIO_TRY(of.status());
    pane.parts_.push_back(named.name);
    pane.finishes_.push_back(render::trim_of(named, with_mirror));
  }
  GONIO_TRY(request.status());
  const render::LobeTransport& light = pane.full_->light = std::move(view.light);
  if (pane.parts_.size() != light.worn.brushed.size())
    return input_error("the view has {} parts, and the mesh {}", light.worn.brushed.size(), pane.parts_.size());
  pane.scaler_.emplace(light, render::operator_or_null(pane.reflection_));
  pane.full_->picture =
      view.beside.data.empty() ? image::even_image(light.width, light.height, 4) : std::move(view.beside);
  const int step = std::max(1, static_cast<int>(std::lround(static_cast<double>(light.width) / kTileWidth)));
  render::Thinned few = render::thinned(light, step);
  std::vector<float> few_angles;
  for (const std::uint32_t point : few.points) few_angles.push_back(view.view_deg[point]);
  pane.small_->light = std::move(few.light), pane.small_->picture = thinned_picture(pane.full_->picture, step);
  pane.small_->shader.emplace(pane.small_->light, std::move(few_angles));
  pane.full_->shader.emplace(light, std::move(view.view_deg));
  return Result(std::move(pane));
}

Result<Json> ViewPane::show(const paint::Paint& paint, const paint::LobeFit& fit, double gloss_deg, bool small) {
  std::vector<render::PartPaint> parts;
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    if (finishes_[i])
      parts.push_back({&*finishes_[i], {}, brdf::kGlossIncidence_deg, "", parts_[i]});
    else
      parts.push_back({&fit, paint.anisotropy.value_or(paint::Anisotropy{}), gloss_deg, paint.name, parts_[i]});
  }
  GONIO_ASSIGN(const render::ShownPaints shown, render::shown_paints(full_->light.columns, full_->light.worn, parts));
  const color::ReflectionOperator* reflection = render::operator_or_null(reflection_);
  const render::BounceScale scale = scaler_->scale(shown.weights);
  Shaded& shaded = small ? *small_ : *full_;
  shaded.shader->shade(shown.paints, reflection, scale, 1, shaded.picture);
  is_small_ = small;
  return Json{{"width", shaded.picture.width},
              {"height", shaded.picture.height},
              {"scaled", scale.changed},
              {"bounced_de00_p95", json_number(scale.error_p95_de00)},
              {"trace_again", scale.error_p95_de00 > kTolerance_de00},
              {"coat_changed", shown.coat_changed}};
}

}  // namespace goniochrome::studio
