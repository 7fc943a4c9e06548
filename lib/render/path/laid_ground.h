// The lower half of an environment, laid on a floor. goniochrome-theory(7), PATHS, Ground.
#pragma once

#include <vector>

#include "color/color.h"
#include "envmap/environment.h"
#include "rays/ray_scene.h"
#include "render/scene.h"

namespace goniochrome::render {

// The radiance of an environment in a direction, bilinear between the centers of its texels (of texels of a cube's
// edges and of an angular map: that of the nearest). Working space.
color::Rgb smooth_radiance(const envmap::Environment& environment, const Vec3& direction);

// A floor that shows what a probe saw of the ground it stood on. Where nothing takes light from it, a point of the
// floor has the radiance of the environment in the direction in which the probe saw that point. It is matt: shaded
// points have that radiance times the share of their irradiance that is left, channel by channel.
class LaidGround {
 public:
  // The environment must outlive it. Error: an eye that is not above the floor.
  static Result<LaidGround> create(const Ground& ground, const envmap::Environment& environment,
                                   const std::vector<Light>& lights);

  // What the point of the floor shows in the open; `position` in units of the mesh.
  color::Rgb open_radiance(const Vec3& position) const;
  // The same as a matt paint, in 1/sr: the radiance by the irradiance of the open floor; 0 where there is no light.
  color::Rgb paint(const color::Rgb& open_radiance) const;
  // Of the floor in the open, from above.
  const color::Rgb& irradiance() const { return irradiance_; }

 private:
  const envmap::Environment* environment_ = nullptr;
  Vec3 eye_;
  color::Rgb irradiance_;
};

}  // namespace goniochrome::render
