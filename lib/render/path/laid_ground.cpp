#include "render/path/laid_ground.h"

#include <algorithm>
#include <cmath>

#include "base/angles.h"

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
  // Away from the horizon the middle of a fine texel is exact to the square of its size.
  constexpr int kParts = 4, kFine = 64;
  const double up = environment.direction_at(column + 0.5, row + 0.5).y;
  if (environment.width() >= kFine && std::abs(up) > 4.0 / environment.width())
    return up > 0 ? up * environment.solid_angle_density(column + 0.5, row + 0.5) : 0;
  double weight = 0;
  for (int i = 0; i < kParts; ++i) {
    for (int j = 0; j < kParts; ++j) {
      const double c = column + (i + 0.5) / kParts, r = row + (j + 0.5) / kParts;
      weight += std::max(0.0, environment.direction_at(c, r).y) * environment.solid_angle_density(c, r);
    }
  }
  return weight / (kParts * kParts);
}

constexpr int kAzimuths = 128, kElevations = 32;

std::size_t place_of(int azimuth, int elevation) {
  return static_cast<std::size_t>(elevation) * (kAzimuths + 1) + static_cast<std::size_t>(azimuth);
}

double azimuth_of(const Vec3& direction) {
  return std::atan2(direction.x, direction.z);
}

double mean_of(const color::Rgb& light) {
  return (light.x + light.y + light.z) / 3;
}

// How far the edge of a texel may be from its middle.
double texel_radius(const envmap::Environment& environment) {
  return environment.layout() == envmap::Environment::Layout::kCube
             ? kPi / 2 / environment.width()
             : 1.5 * kPi / std::min(environment.width(), environment.height());
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
  laid.sums_.assign(place_of(0, kElevations + 1), 0.0);
  laid.margin_rad_ = std::max(kPi / kAzimuths, texel_radius(environment));
  // Each texel is a constant patch.
  const bool rows_agree = environment.layout() == envmap::Environment::Layout::kLatLong;
  for (int row = 0; row < environment.height(); ++row) {
    double weight = 0;
    for (int column = 0; column < environment.width(); ++column) {
      if (column == 0 || !rows_agree) weight = upward_weight(environment, column, row);
      if (!(weight > 0)) continue;
      const color::Rgb light = weight * texel(environment, column, row);
      laid.irradiance_ += light;
      laid.add_light(environment.direction_at(column + 0.5, row + 0.5), mean_of(light));
    }
  }
  for (const Light& light : lights) {
    const color::Rgb lit = (kPi * std::max(0.0, light.direction.y)) * light.white;
    laid.irradiance_ += lit;
    if (light.direction.y > 0) laid.add_light(light.direction, mean_of(lit));
  }
  laid.sum_up();
  return laid;
}

void LaidGround::add_light(const Vec3& direction, double light) {
  const double around = azimuth_of(direction) / (2 * kPi) + 0.5;
  const double up = std::atan2(direction.y, std::hypot(direction.x, direction.z)) / (kPi / 2);
  const int azimuth = std::clamp(static_cast<int>(around * kAzimuths), 0, kAzimuths - 1);
  const int elevation = std::clamp(static_cast<int>(up * kElevations), 0, kElevations - 1);
  sums_[place_of(azimuth + 1, elevation + 1)] += light;
}

void LaidGround::sum_up() {
  for (int e = 1; e <= kElevations; ++e)
    for (int a = 1; a <= kAzimuths; ++a)
      sums_[place_of(a, e)] += sums_[place_of(a - 1, e)] + sums_[place_of(a, e - 1)] - sums_[place_of(a - 1, e - 1)];
}

// The light from below an elevation and so far to either side of an azimuth, or more.
double LaidGround::light_within(double azimuth_rad, double half_width_rad, double elevation_rad) const {
  const int top =
      std::min(kElevations, static_cast<int>(std::ceil((elevation_rad + margin_rad_) / (kPi / 2) * kElevations)));
  const double half = half_width_rad + margin_rad_, cell = 2 * kPi / kAzimuths;
  if (half >= kPi) return sums_[place_of(kAzimuths, top)];
  const int first = static_cast<int>(std::floor((azimuth_rad - half + kPi) / cell));
  const int count = std::min(kAzimuths, static_cast<int>(std::ceil((azimuth_rad + half + kPi) / cell)) - first);
  const int begin = (first % kAzimuths + kAzimuths) % kAzimuths, end = begin + count;
  const auto before = [&](int azimuth) { return sums_[place_of(azimuth, top)]; };
  double sum = before(std::min(end, kAzimuths)) - before(begin);
  if (end > kAzimuths) sum += before(end - kAzimuths);
  return sum;
}

double LaidGround::hidden_share(const Vec3& position, const mesh::Box& box) const {
  const Vec3 nearest = {std::clamp(position.x, box.low.x, box.high.x), 0,
                        std::clamp(position.z, box.low.z, box.high.z)};
  const double distance = std::hypot(nearest.x - position.x, nearest.z - position.z);
  const double height = box.high.y - position.y;
  if (!(distance > 0)) return 1;
  if (!(height > 0)) return 0;
  const double toward = azimuth_of(0.5 * (box.low + box.high) - position);
  double half_width = 0;
  for (const double x : {box.low.x, box.high.x})
    for (const double z : {box.low.z, box.high.z})
      half_width = std::max(
          half_width, std::abs(std::remainder(azimuth_of({x - position.x, 0, z - position.z}) - toward, 2 * kPi)));
  const double elevation = std::atan2(height, distance);
  const double covered = half_width / kPi * height * height / (height * height + distance * distance);
  const double light = mean_of(irradiance_);
  return std::max(covered, light > 0 ? light_within(toward, half_width, elevation) / light : 0);
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
