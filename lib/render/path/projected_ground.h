// The lower half of an environment, projected onto a floor. goniochrome-paths(7), "Ground".
#pragma once

#include <vector>

#include "color/color.h"
#include "envmap/environment.h"
#include "mesh/mesh.h"
#include "rays/ray_scene.h"
#include "render/scene.h"

namespace goniochrome::render {

// A floor that shows what a probe saw of the ground it stood on. Where nothing takes light from it, a point of the
// floor has the radiance of the environment in the direction in which the probe saw that point. It is matt: shaded
// points have that radiance times the share of their irradiance that is left, channel by channel.
class ProjectedGround {
 public:
  // The environment must outlive it. Error: an eye that is not above the floor.
  static Result<ProjectedGround> create(const Ground& ground, const envmap::Environment& environment,
                                        const std::vector<Light>& lights);

  // The radiance of the floor at a point where nothing occludes it; `position` in units of the mesh.
  color::Rgb open_radiance(const Vec3& position) const;
  // The radiance that the probe saw in a unit direction.
  color::Rgb seen(const Vec3& direction) const { return environment_->blended(direction); }
  // The radiance as a matt paint, in 1/sr: over the irradiance of the unoccluded floor; 0 where there is no light.
  color::Rgb paint(const color::Rgb& open_radiance) const;
  // The irradiance of the unoccluded floor, from above.
  const color::Rgb& irradiance() const { return irradiance_; }
  // The brightest texels above the horizon, such as those of a sun, where they hold much of the irradiance: their
  // shadow has edges, and is told apart from that of all other light.
  bool has_bright() const { return !bright_.empty(); }

  // Directions above the horizon, spread as the light of the environment comes from there, and what comes along each to
  // the open floor, as shares of irradiance() channel by channel. Together the shares are what all such light gives.
  // `count` is a power of two.
  struct SharedRay {
    Vec3 direction;
    color::Rgb share;
  };
  std::vector<SharedRay> soft_rays(std::uint32_t count) const {
    return shared_rays(count, false);
  }  // none where it is dark
  std::vector<SharedRay> bright_rays(std::uint32_t count) const { return shared_rays(count, true); }

 private:
  template <class Visit>
  void for_upper_texels(const Visit& visit) const;
  void find_bright();
  std::vector<SharedRay> shared_rays(std::uint32_t count, bool bright) const;

  const envmap::Environment* environment_ = nullptr;
  Vec3 eye_;
  color::Rgb irradiance_;
  color::Rgb bright_irradiance_, soft_irradiance_;  // of the environment
  std::vector<double> upward_;                      // of texels, as upward_weight() has them
  std::vector<bool> bright_;                        // texel by texel; empty where there are none
};

}  // namespace goniochrome::render
