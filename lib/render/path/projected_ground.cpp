#include "render/path/projected_ground.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/angles.h"
#include "brdf/disc_light.h"
#include "render/path/environment_table.h"
#include "render/path/sequence.h"

namespace goniochrome::render {

namespace {

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

std::size_t place_of(const envmap::Environment& environment, int column, int row) {
  return static_cast<std::size_t>(row) * static_cast<std::size_t>(environment.width()) +
         static_cast<std::size_t>(column);
}

}  // namespace

// Calls visit(column, row, upward_weight()) for the texels that reach above the horizon.
template <class Visit>
void ProjectedGround::for_upper_texels(const Visit& visit) const {
  for (int row = 0; row < environment_->height(); ++row)
    for (int column = 0; column < environment_->width(); ++column)
      if (const double weight = upward_[place_of(*environment_, column, row)]; weight > 0) visit(column, row, weight);
}

Result<ProjectedGround> ProjectedGround::create(const Ground& ground, const envmap::Environment& environment,
                                                const std::vector<Light>& lights) {
  if (!(ground.probe_eye.y > ground.height))
    return input_error(
        "the environment was seen from a height of {}, and the floor lies at {}: the eye must be above it",
        ground.probe_eye.y, ground.height);
  ProjectedGround result;
  result.environment_ = &environment;
  result.eye_ = ground.probe_eye;
  const bool rows_agree = environment.layout() == envmap::Environment::Layout::kLatLong;
  result.upward_.reserve(environment.values().size() / 3);
  for (int row = 0; row < environment.height(); ++row)
    for (int column = 0; column < environment.width(); ++column)
      result.upward_.push_back(column > 0 && rows_agree ? result.upward_.back()
                                                        : upward_weight(environment, column, row));
  // Each texel is a constant patch.
  result.for_upper_texels(
      [&](int column, int row, double weight) { result.soft_irradiance_ += weight * environment.texel(column, row); });
  result.irradiance_ = result.soft_irradiance_;
  for (const Light& light : lights)
    result.irradiance_ += (kPi * brdf::disc_irradiance(light.direction.y, light.radius_rad)) * light.white;
  result.find_bright();
  return result;
}

// Texels that are so many times as bright as the mean, if they hold enough of the irradiance.
void ProjectedGround::find_bright() {
  constexpr double kTimes = 30, kPart = 0.1;
  const envmap::Environment& environment = *environment_;
  const double mean = color::mean(irradiance_) / kPi;
  std::vector<bool> bright(static_cast<std::size_t>(environment.width()) *
                           static_cast<std::size_t>(environment.height()));
  color::Rgb sum;
  for_upper_texels([&](int column, int row, double weight) {
    const color::Rgb light = environment.texel(column, row);
    if (color::mean(light) <= kTimes * mean) return;
    bright[place_of(environment, column, row)] = true;
    sum += weight * light;
  });
  if (!(color::mean(sum) > kPart * color::mean(irradiance_))) return;
  bright_ = std::move(bright), bright_irradiance_ = sum, soft_irradiance_ += -1.0 * sum;
}

// Directions are drawn from the environment with the cosine in its texels. The sum of the shares is scaled to what is
// known; where a channel has no light in the draws, it is shared evenly.
std::vector<ProjectedGround::SharedRay> ProjectedGround::shared_rays(std::uint32_t count, bool bright) const {
  const color::Rgb& irradiance = bright ? bright_irradiance_ : soft_irradiance_;
  if (!(color::mean(irradiance) > 1e-9 * color::mean(irradiance_))) return {};
  std::vector<envmap::Environment::Dimmed> factors(environment_->values().size() / 3);
  for (int row = 0; row < environment_->height(); ++row)
    for (int column = 0; column < environment_->width(); ++column)
      factors[place_of(*environment_, column, row)] = {column, row, 0};
  for_upper_texels([&](int column, int row, double weight) {
    const std::size_t at = place_of(*environment_, column, row);
    if (bright == (has_bright() && bright_[at])) factors[at].factor = weight / environment_->solid_angle(column, row);
  });
  const envmap::Environment upward = environment_->dimmed(factors);
  const EnvironmentTable table(upward);
  const Sequence sequence(bright ? 0xB816 : 0x50F7, count);
  std::vector<SharedRay> rays;
  color::Rgb drawn;
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::array<double, 4> numbers = sequence.point(i, 0);
    const LightSample light = table.drawn(numbers[0], numbers[1]);
    if (!(light.pdf > 0 && light.direction.y > 0)) continue;
    rays.push_back({rays::vec3(light.direction), (1.0 / light.pdf) * light.radiance});
    drawn += rays.back().share;
  }
  for (int c = 0; c < 3; ++c) {
    const double whole = irradiance_[c] > 0 ? std::max(0.0, irradiance[c] / irradiance_[c]) : 0;
    for (SharedRay& ray : rays)
      ray.share[c] = drawn[c] > 0 ? ray.share[c] * (whole / drawn[c]) : whole / static_cast<double>(rays.size());
  }
  return rays;
}

color::Rgb ProjectedGround::open_radiance(const Vec3& position) const {
  const Vec3 seen = position - eye_;
  const double distance = length(seen);
  return distance > 0 ? this->seen((1 / distance) * seen) : color::Rgb{};
}

color::Rgb ProjectedGround::paint(const color::Rgb& open_radiance) const {
  const auto by = [](double radiance, double irradiance) { return irradiance > 0 ? radiance / irradiance : 0; };
  return {by(open_radiance.x, irradiance_.x), by(open_radiance.y, irradiance_.y), by(open_radiance.z, irradiance_.z)};
}

}  // namespace goniochrome::render
