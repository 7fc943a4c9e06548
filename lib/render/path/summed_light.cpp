#include "render/path/summed_light.h"

#include <algorithm>
#include <cmath>

#include "brdf/lobe_model.h"
#include "render/effects.h"
#include "render/integral/block_sums.h"
#include "render/integral/integral_engine.h"

namespace goniochrome::render {

namespace {

// The columns of one point, patch by patch.
class ColumnGatherer {
 public:
  ColumnGatherer(const Vec3& normal, const Vec3& to_viewer, const std::vector<LobeAxis>& axes,
                 const std::vector<double>& exponents, double coat_index, Grain grain, color::Rgb* columns)
      : normal_(normal),
        to_viewer_(to_viewer),
        axes_(axes),
        exponents_(exponents),
        coat_index_(coat_index),
        let_out_(brdf::coat_transmission(std::clamp(dot(normal, to_viewer), 0.0, 1.0), coat_index)),
        grain_(std::move(grain)),
        columns_(columns) {}

  const Grain& grain() const { return grain_; }
  bool ends_at_horizon() const { return true; }
  const Vec3& normal() const { return normal_; }

  void add(const Patch& patch, const color::Rgb& radiance) {
    const BaseLight base(patch, normal_, coat_index_);
    if (!(base.cosine() > 0)) return;
    const color::Rgb light = patch.solid_angle_sr * radiance;
    columns_[LobeColumns::diffuse()] += let_out_ * base.mean() * light;
    const double cos_half = std::min(1.0, 0.5 * length(patch.direction + to_viewer_));
    const double fresnel = brdf::fresnel_dielectric(cos_half, brdf::kCoatIndex);
    for (const LobeAxis& axis : axes_) {
      const LobeLight lobe_light(patch, axis.direction, normal_);
      for (std::size_t j = 0; j < exponents_.size(); ++j) {
        const BlurredLobe blurred = grain_.blurred(exponents_[j], patch.variance);
        const color::Rgb power = axis.share * lobe_light.mean(blurred) * light;
        if (power == color::Rgb{}) continue;
        columns_[LobeColumns::flake(j)] += let_out_ * base.mean(lobe_light.more_cosine(blurred, base)) * power;
        columns_[LobeColumns::gloss(j)] += fresnel * power;
      }
    }
  }

 private:
  Vec3 normal_, to_viewer_;
  const std::vector<LobeAxis>& axes_;
  const std::vector<double>& exponents_;
  double coat_index_, let_out_;
  Grain grain_;
  color::Rgb* columns_;
};

}  // namespace

SummedLight::SummedLight(const envmap::BlockTree& tree, double tolerance_de00, const LobeColumns& columns)
    : tree_(&tree), spread_(spread_for(tolerance_de00)) {
  std::ranges::copy_if(columns.exponents, std::back_inserter(exponents_),
                       [](double exponent) { return exponent <= kWidestShared; });
}

void SummedLight::at(const Vec3& normal, const Vec3& to_viewer, const std::vector<LobeAxis>& axes, double coat_index,
                     color::Rgb* light) const {
  std::vector<Vec3> middles;
  for (const LobeAxis& axis : axes) middles.push_back(axis.direction);
  Grain grain(tree_->environment().largest_texel_rad(), spread_);
  grain.add(std::move(middles), {exponents_.rbegin(), exponents_.rend()});
  std::fill_n(light, count(), color::Rgb{});
  ColumnGatherer gatherer(normal, to_viewer, axes, exponents_, coat_index, std::move(grain), light);
  gather_blocks(*tree_, gatherer);
}

}  // namespace goniochrome::render
