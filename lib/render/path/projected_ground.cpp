#include "render/path/projected_ground.h"

#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "brdf/disc_light.h"
#include "render/path/sequence.h"

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

constexpr int kColumns = 512, kRows = 128;
constexpr double kColumnRad = 2 * kPi / kColumns, kRowRad = kPi / 2 / kRows;

std::size_t place_of(int column, int row) {
  return static_cast<std::size_t>(column) * kRows + static_cast<std::size_t>(row);
}

double azimuth_of(const Vec3& direction) {
  return std::atan2(direction.x, direction.z);
}

double gray_of(const color::Rgb& light) {
  return (light.x + light.y + light.z) / 3;
}

double elevation_of(const Vec3& direction) {
  return std::atan2(direction.y, std::hypot(direction.x, direction.z));
}

int column_of(double azimuth_rad) {
  return std::clamp(static_cast<int>((azimuth_rad + kPi) / kColumnRad), 0, kColumns - 1);
}

int row_of(double elevation_rad) {
  return std::clamp(static_cast<int>(elevation_rad / kRowRad), 0, kRows - 1);
}

// The integral of the cosine from the vertical over a cell.
double cell_cosine(int row) {
  const double low = std::sin(row * kRowRad), high = std::sin((row + 1) * kRowRad);
  return kColumnRad * 0.5 * (high * high - low * low);
}

// True if cells hold whole texels.
bool is_fine(const envmap::Environment& environment) {
  const int around =
      environment.layout() == envmap::Environment::Layout::kCube ? 4 * environment.width() : environment.width();
  return around >= 2 * kColumns;
}

}  // namespace

Result<ProjectedGround> ProjectedGround::create(const Ground& ground, const envmap::Environment& environment,
                                                const std::vector<Light>& lights) {
  if (!(ground.probe_eye.y > ground.height))
    return input_error(
        "the environment was seen from a height of {}, and the floor lies at {}: the eye must be above it",
        ground.probe_eye.y, ground.height);
  ProjectedGround result;
  result.environment_ = &environment;
  result.eye_ = ground.probe_eye;
  result.sums_.assign(place_of(kColumns + 1, 0), 0.0F);
  const bool fine = is_fine(environment);
  if (!fine) result.gather_light(environment);
  // Each texel is a constant patch.
  std::vector<BrightTexel> texels;
  result.soft_rows_.assign(static_cast<std::size_t>(environment.height()) + 1, 0.0);
  const bool rows_agree = environment.layout() == envmap::Environment::Layout::kLatLong;
  for (int row = 0; row < environment.height(); ++row) {
    double weight = 0;
    for (int column = 0; column < environment.width(); ++column) {
      if (column == 0 || !rows_agree) weight = upward_weight(environment, column, row);
      if (!(weight > 0)) continue;
      const color::Rgb light = weight * texel(environment, column, row);
      result.irradiance_ += light;
      result.soft_rows_[static_cast<std::size_t>(row) + 1] += gray_of(light);
      if (gray_of(texel(environment, column, row)) > 0) texels.push_back({column, row, gray_of(light)});
      if (fine) result.add_light(environment.direction_at(column + 0.5, row + 0.5), gray_of(light));
    }
  }
  result.soft_irradiance_ = result.irradiance_;
  for (const Light& light : lights) {
    const color::Rgb lit = (kPi * brdf::disc_irradiance(light.direction.y, light.radius_rad)) * light.white;
    result.irradiance_ += lit;
    if (gray_of(lit) > 0) result.add_light(light.direction, gray_of(lit));
  }
  result.sum_up();
  result.find_bright(std::move(texels));
  for (std::size_t row = 1; row < result.soft_rows_.size(); ++row)
    result.soft_rows_[row] = result.soft_rows_[row - 1] + std::max(0.0, result.soft_rows_[row]);
  return result;
}

void ProjectedGround::add_light(const Vec3& direction, double light) {
  const std::size_t at = place_of(column_of(azimuth_of(direction)) + 1, row_of(elevation_of(direction)));
  sums_[at] += static_cast<float>(light);
}

void ProjectedGround::gather_light(const envmap::Environment& environment) {
  for (int column = 0; column < kColumns; ++column) {
    const double azimuth = (column + 0.5) * kColumnRad - kPi;
    for (int row = 0; row < kRows; ++row) {
      const double elevation = (row + 0.5) * kRowRad, level = std::cos(elevation);
      const float* rgb =
          environment.lookup({level * std::sin(azimuth), std::sin(elevation), level * std::cos(azimuth)});
      sums_[place_of(column + 1, row)] += static_cast<float>(cell_cosine(row) * gray_of({rgb[0], rgb[1], rgb[2]}));
    }
  }
}

// A cell holds the light of texels whose middle it holds, or of its own middle. Texels reach into the cells around: a
// part of their light keeps any direction from being drawn much more seldom than its light asks for.
void ProjectedGround::sum_up() {
  constexpr float kAround = 0.1F;
  const std::vector<float> own = sums_;
  for (int column = 1; column <= kColumns; ++column) {
    for (int row = 0; row < kRows; ++row) {
      float most = 0;
      for (int c = column - 1; c <= column + 1; ++c)
        for (int r = std::max(0, row - 1); r <= std::min(kRows - 1, row + 1); ++r)
          most = std::max(most, own[place_of((c + kColumns - 1) % kColumns + 1, r)]);
      sums_[place_of(column, row)] += kAround * most;
    }
  }
  for (std::size_t i = kRows; i < sums_.size(); ++i) sums_[i] += sums_[i - kRows];
}

// The irradiance of a row from before a column, which may lie one turn further on.
double ProjectedGround::before(int column, int row) const {
  return column <= kColumns
             ? static_cast<double>(sums_[place_of(column, row)])
             : static_cast<double>(sums_[place_of(kColumns, row)]) + sums_[place_of(column - kColumns, row)];
}

ProjectedGround::Window ProjectedGround::window(const Vec3& position, const mesh::Box& box) const {
  Window window;
  const Vec3 nearest = {std::clamp(position.x, box.low.x, box.high.x), 0,
                        std::clamp(position.z, box.low.z, box.high.z)};
  const double distance = std::hypot(nearest.x - position.x, nearest.z - position.z);
  const double height = box.high.y - position.y;
  if (!(height > 0)) return window;
  window.half_width_rad = kPi, window.top_rad = kPi / 2;
  if (distance > 0) {
    window.azimuth_rad = azimuth_of(0.5 * (box.low + box.high) - position);
    window.half_width_rad = 0;
    for (const double x : {box.low.x, box.high.x}) {
      for (const double z : {box.low.z, box.high.z}) {
        const double off = azimuth_of({x - position.x, 0, z - position.z}) - window.azimuth_rad;
        window.half_width_rad = std::max(window.half_width_rad, std::abs(std::remainder(off, 2 * kPi)));
      }
    }
    window.top_rad = std::atan2(height, distance);
  }
  const double top = std::sin(window.top_rad);
  window.cosine = window.half_width_rad * top * top;
  window.rows = std::min(kRows, static_cast<int>(std::ceil(window.top_rad / kRowRad)));
  const double left = window.azimuth_rad - window.half_width_rad;
  const int first = static_cast<int>(std::floor((left + kPi) / kColumnRad));
  window.columns = std::min(
      kColumns, static_cast<int>(std::floor((left + 2 * window.half_width_rad + kPi) / kColumnRad)) - first + 1);
  window.first = (first % kColumns + kColumns) % kColumns;
  for (int row = 0; row < window.rows; ++row) {
    const double light = before(window.first + window.columns, row) - before(window.first, row);
    window.light[static_cast<std::size_t>(row) + 1] =
        window.light[static_cast<std::size_t>(row)] + static_cast<float>(std::max(0.0, light));
  }
  return window;
}

double ProjectedGround::light_share(const Window& window) const {
  const double light = gray_of(irradiance_);
  return light > 0 ? std::min(1.0, window.light[static_cast<std::size_t>(window.rows)] / light) : 0;
}

// Those that are so many times as bright as the mean, if they hold enough of the irradiance.
void ProjectedGround::find_bright(std::vector<BrightTexel> texels) {
  constexpr double kTimes = 30, kPart = 0.1;
  const double mean = gray_of(irradiance_) / kPi;
  double sum = 0;
  std::erase_if(
      texels, [&](const BrightTexel& at) { return gray_of(texel(*environment_, at.column, at.row)) <= kTimes * mean; });
  for (const BrightTexel& at : texels) bright_sums_.push_back(sum += at.light);
  if (!(sum > kPart * gray_of(irradiance_))) {
    bright_sums_.clear();
    return;
  }
  bright_ = std::move(texels);
  is_bright_.assign(static_cast<std::size_t>(environment_->width()) * static_cast<std::size_t>(environment_->height()),
                    false);
  for (const BrightTexel& at : bright_) {
    const color::Rgb light = upward_weight(*environment_, at.column, at.row) * texel(*environment_, at.column, at.row);
    bright_irradiance_ += light;
    soft_rows_[static_cast<std::size_t>(at.row) + 1] -= at.light;
    is_bright_[static_cast<std::size_t>(at.row) * static_cast<std::size_t>(environment_->width()) +
               static_cast<std::size_t>(at.column)] = true;
  }
  soft_irradiance_ += -1.0 * bright_irradiance_;
}

bool ProjectedGround::is_bright(const Vec3& direction) const {
  if (is_bright_.empty()) return false;
  const envmap::GridPosition at = environment_->grid().position(direction);
  const int column = std::clamp(static_cast<int>(at.column), 0, environment_->width() - 1),
            row = std::clamp(static_cast<int>(at.row), 0, environment_->height() - 1);
  return is_bright_[static_cast<std::size_t>(row) * static_cast<std::size_t>(environment_->width()) +
                    static_cast<std::size_t>(column)];
}

ProjectedGround::BrightSample ProjectedGround::drawn_bright(double which, double u, double v) const {
  const double total = bright_sums_.back();
  const auto above = std::upper_bound(bright_sums_.begin(), bright_sums_.end(), which * total);
  const auto i = std::min(static_cast<std::size_t>(above - bright_sums_.begin()), bright_.size() - 1);
  const BrightTexel& at = bright_[i];
  const double column = at.column + u, row = at.row + v;
  const double density = environment_->solid_angle_density(column, row);
  return {environment_->direction_at(column, row), density > 0 ? at.light / total / density : 0,
          texel(*environment_, at.column, at.row)};
}

color::Rgb ProjectedGround::share_of(const color::Rgb& irradiance) const {
  const auto by = [](double part, double whole) { return whole > 0 ? std::max(0.0, part / whole) : 0; };
  return {by(irradiance.x, irradiance_.x), by(irradiance.y, irradiance_.y), by(irradiance.z, irradiance_.z)};
}

// Where a channel has no light in the draws, it is shared evenly.
void ProjectedGround::scale_to(const color::Rgb& irradiance, std::vector<SharedRay>& rays) const {
  const color::Rgb wanted = share_of(irradiance);
  color::Rgb drawn;
  for (const SharedRay& ray : rays) drawn += ray.share;
  for (int c = 0; c < 3; ++c) {
    for (SharedRay& ray : rays)
      ray.share[c] =
          drawn[c] > 0 ? ray.share[c] * (wanted[c] / drawn[c]) : wanted[c] / static_cast<double>(rays.size());
  }
}

// Rows are drawn by what light they hold, columns by that within the row, and places within a texel evenly.
std::vector<ProjectedGround::SharedRay> ProjectedGround::soft_rays(std::uint32_t count) const {
  const double total = soft_rows_.back();
  if (!(total > 1e-9 * gray_of(irradiance_))) return {};
  const auto width = static_cast<std::size_t>(environment_->width());
  const Sequence sequence(0x50F7, count);
  std::vector<std::array<double, 4>> draws;
  for (std::uint32_t i = 0; i < count; ++i) draws.push_back(sequence.point(i, 0));
  std::ranges::sort(draws);
  std::vector<SharedRay> rays;
  std::vector<double> sums(width + 1);  // of the row that was asked last
  int in_sums = -1;
  for (const std::array<double, 4>& draw : draws) {
    const auto above = std::upper_bound(soft_rows_.begin(), soft_rows_.end(), draw[0] * total);
    const int row = std::clamp(static_cast<int>(above - soft_rows_.begin()) - 1, 0, environment_->height() - 1);
    if (row != in_sums) {
      for (std::size_t column = 0; column < width; ++column) {
        const int at = static_cast<int>(column);
        const bool bright = !is_bright_.empty() && is_bright_[static_cast<std::size_t>(row) * width + column];
        const double light =
            bright ? 0 : upward_weight(*environment_, at, row) * gray_of(texel(*environment_, at, row));
        sums[column + 1] = sums[column] + light;
      }
      in_sums = row;
    }
    if (!(sums.back() > 0)) continue;
    const auto right = std::upper_bound(sums.begin(), sums.end(), draw[1] * sums.back());
    const int column = std::clamp(static_cast<int>(right - sums.begin()) - 1, 0, environment_->width() - 1);
    const color::Rgb light = texel(*environment_, column, row);
    Vec3 direction = environment_->direction_at(column + draw[2], row + draw[3]);
    if (!(direction.y > 0)) direction = environment_->direction_at(column + 0.5, row + 0.5);
    if (!(direction.y > 0)) continue;
    rays.push_back({direction, (1 / gray_of(light)) * share_of(light)});
  }
  scale_to(soft_irradiance_, rays);
  return rays;
}

std::vector<ProjectedGround::SharedRay> ProjectedGround::bright_rays(std::uint32_t count) const {
  std::vector<SharedRay> rays;
  if (!has_bright()) return rays;
  const Sequence sequence(0xB816, count);
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::array<double, 4> draw = sequence.point(i, 0);
    const BrightSample sample = drawn_bright(draw[0], draw[1], draw[2]);
    if (sample.pdf > 0 && sample.direction.y > 0)
      rays.push_back({sample.direction, (1 / gray_of(sample.radiance)) * share_of(sample.radiance)});
  }
  scale_to(bright_irradiance_, rays);
  return rays;
}

// The part of the draws that follow the light.
constexpr double kByLight = 0.5;

Vec3 ProjectedGround::drawn(const Window& window, double choice, double u, double v) const {
  const float total = window.light[static_cast<std::size_t>(window.rows)];
  double azimuth = 0, sine = 0;
  if (choice < kByLight && total > 0) {
    const auto begin = window.light.begin(), end = begin + window.rows + 1;
    const double wanted = u * total;
    const auto above = std::upper_bound(begin, end, static_cast<float>(wanted));
    const int row = std::clamp(static_cast<int>(above - begin) - 1, 0, window.rows - 1);
    const double low = window.light[static_cast<std::size_t>(row)],
                 high = window.light[static_cast<std::size_t>(row) + 1];
    const double up = high > low ? std::clamp((wanted - low) / (high - low), 0.0, 1.0) : 0.5;
    const double start = before(window.first, row), across = before(window.first + window.columns, row) - start;
    int lower = 0, upper = window.columns;  // of the columns whose light is not above v of the row
    while (upper - lower > 1) {
      const int middle = (lower + upper) / 2;
      (before(window.first + middle, row) - start <= v * across ? lower : upper) = middle;
    }
    const double left = before(window.first + lower, row) - start,
                 right = before(window.first + lower + 1, row) - start;
    const double along = right > left ? std::clamp((v * across - left) / (right - left), 0.0, 1.0) : 0.5;
    azimuth = (window.first + lower + along) * kColumnRad - kPi;
    const double from = std::sin(row * kRowRad), to = std::sin((row + 1) * kRowRad);
    sine = std::sqrt(from * from + up * (to * to - from * from));
  } else {
    const double top = std::sin(window.top_rad);
    azimuth = window.azimuth_rad + (2 * u - 1) * window.half_width_rad;
    sine = top * std::sqrt(v);
  }
  const double level = std::sqrt(std::max(0.0, 1 - sine * sine));
  return {level * std::sin(azimuth), sine, level * std::cos(azimuth)};
}

// Both parts are even by the cosine within a cell and within the window.
double ProjectedGround::density(const Window& window, const Vec3& direction) const {
  if (!(direction.y > 0) || !(window.cosine > 0)) return 0;
  const double total = window.light[static_cast<std::size_t>(window.rows)];
  const double azimuth = azimuth_of(direction), top = std::sin(window.top_rad);
  double density = 0;
  if (direction.y <= top &&
      std::abs(std::remainder(azimuth - window.azimuth_rad, 2 * kPi)) <= window.half_width_rad * (1 + 1e-12))
    density += (total > 0 ? 1 - kByLight : 1) / window.cosine;
  const int row = row_of(elevation_of(direction)), column = column_of(azimuth);
  if (total > 0 && row < window.rows && (column - window.first + kColumns) % kColumns < window.columns) {
    const double light = before(column + 1, row) - before(column, row);
    density += kByLight * std::max(0.0, light) / total / cell_cosine(row);
  }
  return density * direction.y;
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
