#include "render/path/shown_paints.h"

#include <utility>

#include "base/angles.h"
#include "brdf/lobe_model.h"
#include "math/elementary.h"

namespace goniochrome::render {

namespace {

// The error of brdf::under_coat() in the image in a coat.
std::vector<float> mirror_by_view(double traced_index, double index) {
  const double weight = brdf::mirror_change(math::cos(brdf::kMirrorReading_deg * kDegree), traced_index, index);
  std::vector<float> by_view;
  for (int degree = 0; degree <= 90; ++degree)
    by_view.push_back(
        static_cast<float>(brdf::mirror_change(math::cos(degree * kDegree), traced_index, index) / weight));
  return by_view;
}

}  // namespace

Result<ShownPaints> shown_paints(const LobeColumns& columns, const WornPaints& worn,
                                 const std::vector<PartPaint>& parts) {
  ShownPaints shown;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const PartPaint& part = parts[i];
    const double coat = i < worn.coats.size() ? worn.coats[i] : paint::kNoCoat;
    const paint::LobeFit fit = brdf::under_coat(*part.paint, coat);
    shown.coat_changed |= (coat == paint::kNoCoat) != (part.paint->coat_index == paint::kNoCoat);
    const auto named = [&](const Error& error) {
      return Error{error.kind, part.name.empty() ? error.message : part.name + ": " + error.message};
    };
    if (i < worn.brushed.size() && worn.brushed[i] != part.anisotropy)
      return input_error(
          "{}: is brushed otherwise than the paint of part {} was when its light was traced: render again with "
          "--aov transport in this paint",
          part.name, part.part);
    auto paint = transport_paint(columns, fit, part.gloss_deg);
    if (!paint.ok()) return named(paint.error());
    auto flat = column_weights(columns, fit.diffuse, fit.lobes, part.gloss_deg);
    if (!flat.ok()) return named(flat.error());
    if (coat != paint::kNoCoat && part.paint->coat_index != paint::kNoCoat && part.paint->coat_index != coat)
      paint->mirror_by_view = mirror_by_view(coat, part.paint->coat_index);
    shown.with_views |= paint->view_deg.size() > 1 || !paint->mirror_by_view.empty();
    shown.paints.push_back(*std::move(paint)), shown.weights.push_back(*std::move(flat));
  }
  if (worn.has_floor) {
    shown.weights.push_back(worn.weights[static_cast<std::size_t>(worn.groups.of_part.back())]);
    shown.paints.push_back({{0}, {shown.weights.back()}});
  }
  return Result(std::move(shown));
}

std::vector<bool> weighed_columns(const ShownPaints& shown) {
  std::vector<bool> weighed(shown.weights.front().size());
  for (const TransportPaint& paint : shown.paints)
    for (const std::vector<color::Rgb>& weights : paint.weights)
      for (std::size_t k = 0; k < weights.size(); ++k) weighed[k] = weighed[k] || weights[k] != color::Rgb{};
  return weighed;
}

const color::ReflectionOperator* operator_or_null(const color::ReflectionOperator& reflection) {
  return reflection.k != color::component_wise().k ? &reflection : nullptr;
}

}  // namespace goniochrome::render
