// The lower half of an environment, projected onto a floor. goniochrome-paths(7), "Ground".
#pragma once

#include <array>
#include <vector>

#include "base/angles.h"
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
  // The directions from a point of the floor in which it can see a body within a box that stands on the floor: about
  // an azimuth and below an elevation. From under the box these are all directions.
  struct Window {
    double azimuth_rad = 0, half_width_rad = 0, top_rad = 0;
    double cosine = 0;                     // the integral of the cosine over them
    int first = 0, columns = 0, rows = 0;  // cells of even angles that hold them
    std::array<float, 129> light = {};     // irradiance from the first so many rows of these cells
  };
  Window window(const Vec3& position, const mesh::Box& box) const;
  // The share of the irradiance that comes from a window.
  double light_share(const Window& window) const;
  // A direction of the window that two numbers in [0,1) draw: half of them as light comes from there, half by the
  // cosine. The density in 1/sr by which any direction is drawn; 0 outside of the window.
  Vec3 drawn(const Window& window, double choice, double u, double v) const;
  double density(const Window& window, const Vec3& direction) const;

  // The brightest texels above the horizon, such as those of a sun: light from them is drawn apart from all else, so
  // that where all of it is occluded its share has no noise. None where they hold little of the irradiance.
  bool has_bright() const { return !bright_.empty(); }
  bool is_bright(const Vec3& direction) const;
  // A direction of theirs, in proportion to the irradiance that they give.
  struct BrightSample {
    Vec3 direction;
    double pdf = 0;
    color::Rgb radiance;
  };
  BrightSample drawn_bright(double which, double u, double v) const;

  // Directions above the horizon, spread as the light of the environment comes from there, and what comes along each to
  // the open floor, as shares of irradiance() channel by channel. Together the shares are what all such light gives.
  // `count` is a power of two.
  struct SharedRay {
    Vec3 direction;
    color::Rgb share;
  };
  std::vector<SharedRay> soft_rays(std::uint32_t count) const;  // all but the brightest texels; none where that is dark
  std::vector<SharedRay> bright_rays(std::uint32_t count) const;  // of these; none where there are none

 private:
  struct BrightTexel {
    int column = 0, row = 0;
    double light = 0;  // irradiance
  };
  void find_bright(std::vector<BrightTexel> texels);
  color::Rgb share_of(const color::Rgb& irradiance) const;
  void scale_to(const color::Rgb& irradiance, std::vector<SharedRay>& rays) const;
  void add_light(const Vec3& direction, double light);
  void gather_light(const envmap::Environment& environment);
  void sum_up();
  double before(int column, int row) const;

  const envmap::Environment* environment_ = nullptr;
  Vec3 eye_;
  color::Rgb irradiance_;
  // Irradiance from the first so many columns of each row of cells, column by column; the mean of the channels.
  std::vector<float> sums_;
  std::vector<BrightTexel> bright_;
  std::vector<double> bright_sums_;                 // cumulative
  std::vector<bool> is_bright_;                     // texel by texel; empty where there are none
  color::Rgb bright_irradiance_, soft_irradiance_;  // of the environment
  std::vector<double> soft_rows_;  // irradiance from the first so many rows of texels but the bright ones
};

}  // namespace goniochrome::render
