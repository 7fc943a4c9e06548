// What few random samples tell of the light of many points. goniochrome-theory(7), PLAN, Effects of rays.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "render/path/noise.h"
#include "render/path/transport.h"

namespace goniochrome::render {

// A visible point as rays leave it.
struct RayPoint {
  rays::Spot spot;
  rays::Float3 to_viewer;
};

// Points near each other get nearly the same light: so many of them, the point itself among them.
constexpr std::size_t kAlike = 16;

// What the mesh adds to the light of a point.
struct SampledLight {
  LightShares sure;               // without noise
  std::vector<LightShares> fans;  // the rest: means of kFan samples each, in turn of independent sequences
  bool certain = false;           // whether there is no rest
  bool hidden = false;            // whether the fans hold all light that is left, and not a difference
  bool blocked = false;           // whether any ray met anything

  // As tell_lights() has them.
  LightShares told;
  // How each share of one fan scatters, by the fans of the points that are alike.
  std::array<Covariance, 3> scatter = {};
  std::array<std::uint32_t, kAlike> alike = {};
  std::uint32_t alike_count = 0;

  LightShares mean() const;  // of sure and fans alone
};

// Tells the light of each point from its own samples and from those of the points that are alike: as far from the
// mean of these as differences that are no noise go, so that all points together are spread as their true light is.
// `points`, of which `lights` has every step-th, follow the picture in both directions. Every light has as many fans as
// there are, two or more, unless it is certain.
void tell_lights(const std::vector<RayPoint>& points, std::size_t step, std::vector<SampledLight>& lights);

// The covariance of the mean of the fans, of what these effects show more than those, shares taken for independent.
Covariance covariance(const SampledLight& light, const RayEffects& with, const RayEffects& without);

}  // namespace goniochrome::render
