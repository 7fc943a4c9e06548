#include "render/path/environment_table.h"

#include <algorithm>

#include "base/angles.h"

namespace goniochrome::render {

namespace {

using rays::Float3;

constexpr int kRowGuide = 1024, kColumnGuide = 256;

// The number of the interval of ascending `edges` that holds u, never an empty one, from where the guide says.
template <class Number>
int interval(const Number* edges, int count, double u, const std::uint16_t* guide, int steps) {
  int i = guide[static_cast<int>(u * steps)];
  while (i + 1 < count && static_cast<double>(edges[i + 1]) <= u) ++i;
  while (i > 0 && !(edges[i + 1] > edges[i])) --i;
  return i;
}

template <class Number>
void add_guide(const Number* edges, int count, int steps, std::vector<std::uint16_t>& guide) {
  int i = 0;
  for (int step = 0; step < steps; ++step) {
    while (i + 1 < count && static_cast<double>(edges[i + 1]) <= static_cast<double>(step) / steps) ++i;
    guide.push_back(static_cast<std::uint16_t>(i));
  }
}

}  // namespace

EnvironmentTable::EnvironmentTable(const envmap::Environment& environment)
    : environment_(&environment), width_(environment.width()), height_(environment.height()) {
  rows_.assign(static_cast<std::size_t>(height_) + 1, 0.0);
  columns_.assign(static_cast<std::size_t>(height_) * (static_cast<std::size_t>(width_) + 1), 0.0F);
  std::vector<double> sums(static_cast<std::size_t>(width_) + 1, 0.0);
  std::vector<double> row_sums;
  double squares = 0, sphere = 0;
  const envmap::SolidAngles solid_angles(environment.grid());
  for (int row = 0; row < height_; ++row) {
    for (int column = 0; column < width_; ++column) {
      const color::Rgb light = environment.texel(column, row);
      const double mean = color::mean(light), solid_angle = solid_angles.at(column, row);
      const auto at = static_cast<std::size_t>(column);
      sums[at + 1] = sums[at] + mean * solid_angle;
      squares += mean * mean * solid_angle;
      sphere += solid_angle;
    }
    row_solid_angle_.push_back(solid_angles.at(0, row));
    row_cosine_.push_back(std::cos(kPi * row / height_));
    const double sum = sums.back();
    float* cumulative = &columns_[static_cast<std::size_t>(row) * (static_cast<std::size_t>(width_) + 1)];
    for (std::size_t i = 0; i < sums.size(); ++i) cumulative[i] = sum > 0 ? static_cast<float>(sums[i] / sum) : 0.0F;
    row_sums.push_back(sum);
  }
  for (std::size_t row = 0; row < row_sums.size(); ++row) rows_[row + 1] = rows_[row] + row_sums[row];
  total_ = rows_.back();
  extent_sr_ = squares > 0 ? total_ * total_ / squares : sphere;
  if (total_ > 0)
    for (double& row : rows_) row /= total_;
  row_cosine_.push_back(-1);
  add_guide(rows_.data(), height_, kRowGuide, row_guide_);
  for (int row = 0; row < height_; ++row)
    add_guide(&columns_[static_cast<std::size_t>(row) * (static_cast<std::size_t>(width_) + 1)], width_, kColumnGuide,
              column_guide_);
  for (int i = 0; environment.grid().is_cube() && i <= width_; ++i)
    edges_.push_back(environment.grid().face_coordinate(i));
}

// SphereGrid::solid_angle_density() of a direction within this texel: 1 + s^2 + t^2 of a unit direction is one over the
// square of its component along the face's axis, which is the largest.
double EnvironmentTable::cube_density(const Float3& direction, int column, int row) const {
  const double along = std::max({std::abs(direction.x), std::abs(direction.y), std::abs(direction.z)});
  const auto c = static_cast<std::size_t>(column), r = static_cast<std::size_t>(row % width_);
  return (edges_[c + 1] - edges_[c]) * (edges_[r + 1] - edges_[r]) * (along * along * along);
}

int EnvironmentTable::row_at(double u) const {
  return interval(rows_.data(), height_, u, row_guide_.data(), kRowGuide);
}

void EnvironmentTable::fetch(double u, double v) const {
  if (dark()) return;
  const auto row = static_cast<std::size_t>(row_at(u));
  __builtin_prefetch(&column_guide_[row * kColumnGuide + static_cast<std::size_t>(v * kColumnGuide)]);
}

// Directions in a lat-long map are even in solid angle within a texel: in longitude and in the cosine from the pole.
// Elsewhere they are even in column and row, for the density hardly changes over a texel.
EnvironmentTable::Place EnvironmentTable::place(double u, double v) const {
  if (dark()) return {};
  const int row = row_at(u);
  const auto r = static_cast<std::size_t>(row);
  const float* cumulative = this->cumulative(r);
  const int column = interval(cumulative, width_, v, &column_guide_[r * kColumnGuide], kColumnGuide);
  __builtin_prefetch(environment_->radiance(column, row));
  const double down = std::clamp((u - rows_[r]) / (rows_[r + 1] - rows_[r]), 0.0, 1.0);
  const double right = std::clamp(
      (v - cumulative[column]) / (static_cast<double>(cumulative[column + 1]) - cumulative[column]), 0.0, 1.0);
  if (environment_->layout() == envmap::Environment::Layout::kLatLong) {
    const double cosine = row_cosine_[r] + down * (row_cosine_[r + 1] - row_cosine_[r]);
    const auto ring = static_cast<float>(std::sqrt(std::max(0.0, 1 - cosine * cosine)));
    const auto longitude = static_cast<float>(2 * kPi * (0.5 - (column + right) / width_));
    return {{ring * std::sin(longitude), static_cast<float>(cosine), ring * std::cos(longitude)},
            column,
            row,
            row_solid_angle_[r]};
  }
  if (!edges_.empty()) {
    const auto c = static_cast<std::size_t>(column), t = static_cast<std::size_t>(row % width_);
    const double across = edges_[c] + right * (edges_[c + 1] - edges_[c]),
                 along = edges_[t] + down * (edges_[t + 1] - edges_[t]);
    const Float3 direction = rays::float3(envmap::cube_direction(row / width_, across + 1, along + 1, 2));
    return {direction, column, row, cube_density(direction, column, row)};
  }
  return {rays::float3(environment_->direction_at(column + right, row + down)), column, row,
          environment_->solid_angle_density(column + right, row + down)};
}

// The share as the tables have it, whose floats round: drawn directions and at() agree.
LightSample EnvironmentTable::light(const Float3& direction, int column, int row, double density) const {
  const auto r = static_cast<std::size_t>(row);
  const float* edge = cumulative(r) + column;
  const double share = (rows_[r + 1] - rows_[r]) * (static_cast<double>(edge[1]) - edge[0]);
  return {direction, density > 0 ? static_cast<float>(share / density) : 0.0F, environment_->texel(column, row)};
}

LightSample EnvironmentTable::light(const Place& place) const {
  return place.density > 0 ? light(place.direction, place.column, place.row, place.density) : LightSample{};
}

LightSample EnvironmentTable::at(const Float3& direction) const {
  const envmap::GridPosition at = environment_->grid().position(rays::vec3(direction));
  const int column = std::clamp(static_cast<int>(at.column), 0, width_ - 1);
  const int row = std::clamp(static_cast<int>(at.row), 0, height_ - 1);
  const double density = !edges_.empty() ? cube_density(direction, column, row)
                         : environment_->layout() == envmap::Environment::Layout::kLatLong
                             ? row_solid_angle_[static_cast<std::size_t>(row)]
                             : environment_->solid_angle_density(at.column, at.row);
  return light(direction, column, row, density);
}

}  // namespace goniochrome::render
