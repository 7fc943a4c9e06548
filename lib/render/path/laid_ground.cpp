#include "render/path/laid_ground.h"

#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "brdf/disc_light.h"

namespace goniochrome::render {

namespace {

color::Rgb texel(const envmap::Environment& environment, int column, int row) {
  const float* rgb = environment.radiance(column, row);
  return {rgb[0], rgb[1], rgb[2]};
}

// The integral of the upward cosine over the part of a texel that is above the horizon. Of a lat-long map in closed
// form: the width in longitude times half the difference of the squared cosines of its edges. Elsewhere by points of a
// grid within the texel.
double upward_weight(const envmap::Environment& environment, int column, int row) {
  if (environment.layout() == envmap::Environment::Layout::kLatLong) {
    const double above = std::max(0.0, std::cos(kPi * row / environment.height()));
    const double below = std::max(0.0, std::cos(kPi * (row + 1) / environment.height()));
    return 2 * kPi / environment.width() * (above * above - below * below) / 2;
  }
  constexpr int kParts = 4;
  double weight = 0;
  for (int i = 0; i < kParts; ++i) {
    for (int j = 0; j < kParts; ++j) {
      const double c = column + (i + 0.5) / kParts, r = row + (j + 0.5) / kParts;
      weight += std::max(0.0, environment.direction_at(c, r).y) * environment.solid_angle_density(c, r);
    }
  }
  return weight / (kParts * kParts);
}

// The irradiance of a level surface that looks up, each texel as a constant patch.
color::Rgb level_irradiance(const envmap::Environment& environment) {
  const bool rows_agree = environment.layout() == envmap::Environment::Layout::kLatLong;
  color::Rgb sum;
  for (int row = 0; row < environment.height(); ++row) {
    double weight = 0;
    for (int column = 0; column < environment.width(); ++column) {
      if (column == 0 || !rows_agree) weight = upward_weight(environment, column, row);
      if (weight > 0) sum += weight * texel(environment, column, row);
    }
  }
  return sum;
}

}  // namespace

color::Rgb smooth_radiance(const envmap::Environment& environment, const Vec3& direction) {
  const int width = environment.width(), height = environment.height();
  if (environment.layout() == envmap::Environment::Layout::kCube) {
    const envmap::CubePosition at = envmap::cube_position(direction, width);
    const double column = std::clamp(at.column - 0.5, 0.0, width - 1.0),
                 row = std::clamp(at.row - 0.5, 0.0, width - 1.0);
    const int x = std::min(static_cast<int>(column), std::max(0, width - 2)),
              y = std::min(static_cast<int>(row), std::max(0, width - 2));
    const double s = column - x, t = row - y;
    const int x1 = std::min(x + 1, width - 1), y1 = std::min(y + 1, width - 1), top = at.face * width;
    return (1 - t) * ((1 - s) * texel(environment, x, top + y) + s * texel(environment, x1, top + y)) +
           t * ((1 - s) * texel(environment, x, top + y1) + s * texel(environment, x1, top + y1));
  }
  const envmap::GridPosition at = environment.grid().position(direction);
  if (environment.layout() != envmap::Environment::Layout::kLatLong) {
    const float* rgb = environment.lookup(direction);
    return {rgb[0], rgb[1], rgb[2]};
  }
  const double column = at.column - 0.5, row = std::clamp(at.row - 0.5, 0.0, height - 1.0);
  const double left = std::floor(column);
  const double s = column - left;
  const int x = (static_cast<int>(left) % width + width) % width, x1 = (x + 1) % width;
  const int y = std::min(static_cast<int>(row), std::max(0, height - 2)), y1 = std::min(y + 1, height - 1);
  const double t = row - y;
  return (1 - t) * ((1 - s) * texel(environment, x, y) + s * texel(environment, x1, y)) +
         t * ((1 - s) * texel(environment, x, y1) + s * texel(environment, x1, y1));
}

Result<LaidGround> LaidGround::create(const Ground& ground, const envmap::Environment& environment,
                                      const std::vector<Light>& lights) {
  if (!(ground.probe_eye.y > ground.height))
    return input_error(
        "the environment was seen from a height of {}, and the floor lies at {}: the eye must be above it",
        ground.probe_eye.y, ground.height);
  LaidGround laid;
  laid.environment_ = &environment;
  laid.eye_ = ground.probe_eye;
  laid.irradiance_ = level_irradiance(environment);
  for (const Light& light : lights)
    laid.irradiance_ += (kPi * brdf::disc_irradiance(light.direction.y, light.radius_rad)) * light.white;
  return laid;
}

color::Rgb LaidGround::open_radiance(const Vec3& position) const {
  const Vec3 seen = position - eye_;
  const double distance = length(seen);
  return distance > 0 ? smooth_radiance(*environment_, (1 / distance) * seen) : color::Rgb{};
}

color::Rgb LaidGround::paint(const color::Rgb& open_radiance) const {
  const auto by = [](double radiance, double irradiance) { return irradiance > 0 ? radiance / irradiance : 0; };
  return {by(open_radiance.x, irradiance_.x), by(open_radiance.y, irradiance_.y), by(open_radiance.z, irradiance_.z)};
}

}  // namespace goniochrome::render
