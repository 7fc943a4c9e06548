// The lower half of an environment, laid on a floor. goniochrome-theory(7), PATHS, Ground.
#pragma once

#include <vector>

#include "color/color.h"
#include "envmap/environment.h"
#include "mesh/mesh.h"
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

  // How much a body within this box, which stands on the floor, can change of what a point of the floor shows: the
  // share of the irradiance that comes from where the box hides the sky, or the share of the hemisphere, weighed by the
  // cosine, that it covers, whichever is larger. It is 1 under the box.
  double hidden_share(const Vec3& position, const mesh::Box& box) const;

 private:
  void add_light(const Vec3& direction, double light);
  void sum_up();
  double light_within(double azimuth_rad, double half_width_rad, double elevation_rad) const;

  const envmap::Environment* environment_ = nullptr;
  Vec3 eye_;
  color::Rgb irradiance_;
  // Irradiance from below each elevation and before each azimuth, the mean of the channels, in cells of even angles.
  std::vector<double> sums_;
  double margin_rad_ = 0;  // how far the light of a cell may lie outside of it
};

}  // namespace goniochrome::render
