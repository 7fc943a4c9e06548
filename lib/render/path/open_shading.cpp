#include "render/path/open_shading.h"

#include "brdf/lobe_model.h"
#include "render/exact.h"
#include "render/integral/integral_engine.h"

namespace goniochrome::render {

OpenShading::OpenShading(const Scene& scene) : scene_(scene) {
  if (scene_.ground) {
    // The floor is a part more.
    scene_.gloss_deg.resize(scene_.paints.size() + 1, brdf::kGlossIncidence_deg);
    if (!scene_.anisotropy.empty()) scene_.anisotropy.resize(scene_.paints.size() + 1);
    scene_.paints.push_back(scene_.ground->kind == Ground::Kind::kPaint ? scene_.ground->paint : paint::LobeFit());
  }
  scene_.layer = nullptr;
  scene_.lights.clear();
  scene_.background = Background::kNone;
  effects_ = effects_of(scene_);
  effects_.mirror = false;
  effects_.environment = scene_.texels != nullptr;
  if (scene_.env == nullptr || scene_.texels == nullptr) return;
  auto maps = std::make_unique<CpuEngine>();
  if (maps->load(scene_, effects_).ok()) maps_ = std::move(maps);
}

std::vector<color::Rgb> OpenShading::exact(const std::vector<VisiblePoint>& points, double tolerance_de00) const {
  if (scene_.texels == nullptr) return std::vector<color::Rgb>(points.size());
  return exact_radiance(points, scene_, effects_, Surroundings(*scene_.texels, spread_for(tolerance_de00)));
}

std::vector<color::Rgb> OpenShading::quick(const std::vector<VisiblePoint>& points) const {
  return maps_ ? maps_->colors(points) : std::vector<color::Rgb>(points.size());
}

void OpenShading::add_quick(const Gbuffer& gbuffer, float gain, image::Image& rgba) const {
  if (maps_) maps_->shade(gbuffer, gain, true, rgba);
}

}  // namespace goniochrome::render
