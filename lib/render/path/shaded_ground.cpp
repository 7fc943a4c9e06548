#include "render/path/shaded_ground.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <mutex>

#include "base/angles.h"
#include "base/parallel.h"
#include "brdf/disc_light.h"

namespace goniochrome::render {

namespace {

using rays::Float3;

constexpr unsigned kFanRays = 8;
// Few directions of a source tell whether its light is all there or all hidden; else there are so many.
constexpr std::uint32_t kFew = 8, kMany = 64;
// The grid is even about the mesh, to this part of its length beyond it. From there on cells grow by this factor, as
// far as so many lengths.
constexpr double kGridMargin = 0.1, kGridGrowth = 1.15, kGridReach = 16;
constexpr std::size_t kBounceStep = 4;
// Light above so many times that of a white floor under the open sky, such as a sun in paint, is found by few of a
// node's directions: what is above it counts as far as a node beside it finds any.
constexpr double kRare = 4;
// A cell in which light bends is divided into so many, each way.
constexpr std::size_t kDivisions = 4, kFineNodes = kDivisions + 1;
constexpr std::uint32_t kWhole = std::numeric_limits<std::uint32_t>::max();

float mean_of(const Float3& a) {
  return (a.x + a.y + a.z) / 3;
}

std::vector<float> lines(double low, double high, double cell, double length) {
  const double first = low - kGridMargin * length, last = high + kGridMargin * length;
  const auto count = static_cast<int>(std::ceil((last - first) / cell));
  std::vector<float> inner, outer;
  for (int i = 0; i <= count; ++i) inner.push_back(static_cast<float>(first + i * (last - first) / count));
  double step = cell, beyond = 0;
  while (beyond < kGridReach * length) {
    step *= kGridGrowth, beyond += step;
    outer.push_back(static_cast<float>(beyond));
  }
  std::vector<float> all;
  for (std::size_t i = outer.size(); i-- > 0;) all.push_back(inner.front() - outer[i]);
  all.insert(all.end(), inner.begin(), inner.end());
  for (const float further : outer) all.push_back(inner.back() + further);
  return all;
}

// Every so many-th, and the last.
std::vector<float> every(const std::vector<float>& all, std::size_t step) {
  std::vector<float> some;
  for (std::size_t i = 0; i + 1 < all.size(); i += step) some.push_back(all[i]);
  some.push_back(all.back());
  return some;
}

// Between four values, of which the second pair is the lower one.
Float3 between_four(const Float3* upper, const Float3* lower, float right, float down) {
  return (1 - down) * ((1 - right) * upper[0] + right * upper[1]) + down * ((1 - right) * lower[0] + right * lower[1]);
}

}  // namespace

// 256 for the default tolerance. Twice the directions have some .6 of the error.
int ground_directions(double tolerance_de00) {
  constexpr double kDefault_de00 = 0.5;
  int directions = kFewestGroundDirections;
  for (double kept = 1.6 * kDefault_de00; kept > tolerance_de00 && directions < 4096; kept *= 0.6) directions *= 2;
  return directions;
}

GroundRequest ground_request(double tolerance_de00, std::uint64_t seed, double left_s) {
  GroundRequest request{.directions = ground_directions(tolerance_de00), .seed = seed};
  request.bounced_directions = 2 * request.directions;
  request.longest_s = left_s / 4;
  return request;
}

// The directions from a place of the floor in which the mesh can be: all where the place is beside the cone's sphere.
struct ShadedGround::Cone {
  Float3 axis;
  float cosine = -2;

  unsigned wanted(const rays::Fan& fan) const {
    unsigned bits = 0;
    for (unsigned i = 0; i < kFanRays; ++i)
      if (fan.x[i] * axis.x + fan.y[i] * axis.y + fan.z[i] * axis.z >= cosine) bits |= 1U << i;
    return bits & fan.wanted;
  }
};

ShadedGround::Cone ShadedGround::cone(const Float3& start) const {
  Cone cone;
  const float distance = rays::length(start), sine = distance > 0 ? mesh_radius_ / distance : 1;
  if (!(sine < 1)) return cone;
  cone.axis = (-1 / distance) * start;
  cone.cosine = std::sqrt(1 - sine * sine) - 1e-6F;
  return cone;
}

std::optional<ShadedGround::Place> ShadedGround::Grid::find(const Float3& place) const {
  if (values.empty() || !(place.x >= x.front() && place.x <= x.back() && place.z >= z.front() && place.z <= z.back()))
    return {};
  Place at;
  const auto interval = [](const std::vector<float>& lines, float value, std::size_t& i, float& part) {
    const auto above = std::upper_bound(lines.begin() + 1, lines.end() - 1, value);
    i = static_cast<std::size_t>(above - lines.begin()) - 1;
    part = (value - lines[i]) / (lines[i + 1] - lines[i]);
  };
  interval(x, place.x, at.column, at.right);
  interval(z, place.z, at.row, at.down);
  return at;
}

// Directions that lie together are traced together: sectors of azimuth, and within each from the horizon up.
ShadedGround::Directions ShadedGround::directions(const std::vector<ProjectedGround::SharedRay>& rays) {
  std::vector<ProjectedGround::SharedRay> sorted = rays;
  const auto azimuth = [](const ProjectedGround::SharedRay& ray) {
    return std::atan2(ray.direction.x, ray.direction.z);
  };
  std::ranges::sort(sorted, {}, azimuth);
  const auto across = static_cast<std::size_t>(std::lround(std::sqrt(static_cast<double>(rays.size()) * kFanRays)));
  for (std::size_t first = 0; first < sorted.size(); first += std::max<std::size_t>(kFanRays, across)) {
    const auto begin = sorted.begin() + static_cast<std::ptrdiff_t>(first);
    const auto end = sorted.begin() + static_cast<std::ptrdiff_t>(
                                          std::min(sorted.size(), first + std::max<std::size_t>(kFanRays, across)));
    std::sort(begin, end, [](const auto& a, const auto& b) { return a.direction.y < b.direction.y; });
  }
  Directions all;
  for (std::size_t first = 0; first < sorted.size(); first += kFanRays) {
    rays::Fan fan;
    for (std::size_t i = 0; i < kFanRays; ++i) {
      const bool real = first + i < sorted.size();
      const ProjectedGround::SharedRay& ray = sorted[real ? first + i : first];
      const Float3 direction = rays::float3(ray.direction);
      fan.x[i] = direction.x, fan.y[i] = direction.y, fan.z[i] = direction.z;
      if (real) fan.wanted |= 1U << i;
      all.shares.push_back(real ? rays::float3(ray.share) : Float3{});
    }
    all.fans.push_back(fan);
  }
  return all;
}

ShadedGround::Source ShadedGround::source(
    const std::function<std::vector<ProjectedGround::SharedRay>(std::uint32_t count)>& drawn) {
  Source source{directions(drawn(kFew)), directions(drawn(kMany)), {}, {}, {}};
  for (const Float3& share : source.many.shares) source.share = source.share + share;
  return source;
}

void ShadedGround::add_lamp(const Light& light, const color::Rgb& irradiance) {
  const color::Rgb lit = (kPi * brdf::disc_irradiance(light.direction.y, light.radius_rad)) * light.white;
  color::Rgb share;
  for (int c = 0; c < 3; ++c) share[c] = irradiance[c] > 0 ? lit[c] / irradiance[c] : 0;
  if (share == color::Rgb{}) return;
  sources_.push_back(source([&](std::uint32_t count) {
    std::vector<ProjectedGround::SharedRay> rays;
    if (!(light.radius_rad > 0)) return std::vector<ProjectedGround::SharedRay>{{light.direction, share}};
    const Sequence sequence(0x1A3B, count);
    double above = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
      const std::array<double, 4> numbers = sequence.point(i, 0);
      const Vec3 direction = disc_direction(light, numbers[0], numbers[1]);
      if (direction.y > 0) rays.push_back({direction, share}), above += direction.y;
    }
    for (ProjectedGround::SharedRay& ray : rays) ray.share = (ray.direction.y / above) * ray.share;
    return rays;
  }));
}

ShadedGround::ShadedGround(std::shared_ptr<const rays::RayScene> scene, const ProjectedGround& ground,
                           const std::vector<Light>& lights, const mesh::Box& box, float mesh_radius,
                           const GroundRequest& request)
    : scene_(std::move(scene)), mesh_radius_(mesh_radius), bent_(1.0F / static_cast<float>(request.directions)) {
  height_ = scene_->spot({rays::kFloor, 0, 0, 0}, {}, {0, -1, 0}).position.y;
  soft_ = directions(ground.soft_rays(static_cast<std::uint32_t>(request.directions)));
  if (ground.has_bright()) sources_.push_back(source([&](std::uint32_t count) { return ground.bright_rays(count); }));
  for (const Light& light : lights) add_lamp(light, ground.irradiance());
  const Float3 low = scene_->local(box.low), high = scene_->local(box.high);
  const double length = std::max({high.x - low.x, high.y - low.y, high.z - low.z});
  if (!(length > 0)) return;
  const std::vector<float> x = lines(low.x, high.x, request.cell * length, length),
                           z = lines(low.z, high.z, request.cell * length, length);
  shade(x, z);
  if (request.sent) gather(every(x, kBounceStep), every(z, kBounceStep), request, ground.irradiance());
}

template <class Value>
void ShadedGround::fill(Grid& grid, const Value& value) const {
  const std::size_t columns = grid.x.size();
  grid.values.resize(columns * grid.z.size());
  parallel_each(grid.z.size(), 4, [&](std::size_t row) {
    for (std::size_t column = 0; column < columns; ++column)
      grid.values[row * columns + column] = value(start_at(grid.x[column], grid.z[row]), row * columns + column);
  });
}

void ShadedGround::shade(const std::vector<float>& x, const std::vector<float>& z) {
  occluded_.x = x, occluded_.z = z;
  fill(occluded_, [&](const Float3& start, std::size_t) { return occluded(soft_, start); });
  divide();
  for (Source& source : sources_) mark(source), smooth(source);
}

// Marks the cells that the shadows of boxes about neighboring triangles meet, so that no place in shadow is missed.
void ShadedGround::mark(Source& source) const {
  constexpr std::size_t kBoxes = 4096;
  const std::size_t columns = occluded_.x.size() - 1, triangles = scene_->triangles(),
                    each = std::max<std::size_t>(1, triangles / kBoxes);
  std::vector<mesh::Box> boxes;
  for (std::size_t first = 0; first < triangles; first += each) {
    mesh::Box box = mesh::kEmptyBox;
    for (std::size_t t = first; t < std::min(triangles, first + each); ++t)
      for (const Float3& corner : scene_->corners(static_cast<std::uint32_t>(t))) box.add(rays::vec3(corner));
    if (box.high.y > height_) boxes.push_back(box);
  }
  source.states.assign(columns * (occluded_.z.size() - 1), Source::kFree);
  std::mutex mutex;
  parallel_for(source.many.fans.size(), 1, [&](std::size_t begin, std::size_t end) {
    std::vector<bool> marked(source.states.size(), false);
    for (std::size_t fan = begin; fan < end; ++fan) mark(source.many.fans[fan], boxes, marked);
    const std::lock_guard lock(mutex);
    for (std::size_t i = 0; i < marked.size(); ++i)
      if (marked[i]) source.states[i] = Source::kAsked;
  });
}

void ShadedGround::mark(const rays::Fan& fan, const std::vector<mesh::Box>& boxes, std::vector<bool>& marked) const {
  const auto cells = [](const std::vector<float>& lines, double low, double high) {
    const auto begin = std::upper_bound(lines.begin() + 1, lines.end() - 1, static_cast<float>(low));
    const auto end = std::lower_bound(begin, lines.end() - 1, static_cast<float>(high));
    return std::pair(begin - lines.begin() - 1, end - lines.begin());
  };
  const auto columns = static_cast<std::ptrdiff_t>(occluded_.x.size()) - 1;
  for (const mesh::Box& box : boxes) {
    const double bottom = std::max(0.0, box.low.y - height_), top = box.high.y - height_;
    for (unsigned i = 0; i < kFanRays; ++i) {
      if ((fan.wanted >> i & 1U) == 0) continue;
      const double x = fan.x[i] / fan.y[i], z = fan.z[i] / fan.y[i];
      const auto [left, right] =
          cells(occluded_.x, box.low.x - std::max(bottom * x, top * x), box.high.x - std::min(bottom * x, top * x));
      const auto [back, front] =
          cells(occluded_.z, box.low.z - std::max(bottom * z, top * z), box.high.z - std::min(bottom * z, top * z));
      for (std::ptrdiff_t row = back; row < front; ++row)
        std::fill(marked.begin() + row * columns + left, marked.begin() + row * columns + right, true);
    }
  }
}

// Where a source is hidden in part at all nodes of a cell, and its light does not bend, the nodes tell it.
void ShadedGround::smooth(Source& source) const {
  const std::size_t columns = occluded_.x.size() - 1;
  std::vector<bool> wanted(occluded_.values.size(), false);
  for (std::size_t cell = 0; cell < source.states.size(); ++cell) {
    if (source.states[cell] == Source::kFree) continue;
    const std::size_t node = cell / columns * (columns + 1) + cell % columns;
    for (const std::size_t corner : {node, node + 1, node + columns + 1, node + columns + 2}) wanted[corner] = true;
  }
  source.nodes = {occluded_.x, occluded_.z, {}};
  fill(source.nodes,
       [&](const Float3& start, std::size_t node) { return wanted[node] ? occluded(source, start) : Float3{}; });
  const float least = 0.01F * mean_of(source.share), most = mean_of(source.share) - least;
  for (std::size_t cell = 0; cell < source.states.size(); ++cell) {
    if (source.states[cell] == Source::kFree) continue;
    const std::size_t column = cell % columns, row = cell / columns;
    const auto part = [&](std::size_t c, std::size_t r) {
      const float value = mean_of(source.nodes.at(c, r));
      return value > least && value < most;
    };
    if (part(column, row) && part(column + 1, row) && part(column, row + 1) && part(column + 1, row + 1) &&
        bent(source.nodes, column, row) <= bent_)
      source.states[cell] = Source::kSmooth;
  }
}

// A curve through two nodes and those beside them departs from the line between the two by no more than this.
float ShadedGround::bent(const Grid& grid, std::size_t column, std::size_t row, bool across) {
  const std::size_t last = (across ? grid.x : grid.z).size() - 1;
  const auto value = [&](std::size_t of_column, std::size_t of_row) { return mean_of(grid.at(of_column, of_row)); };
  const auto second = [&](std::size_t c, std::size_t r) {
    const std::size_t i = across ? c : r;
    if (i == 0 || i == last) return 0.0F;
    return std::abs(value(across ? c - 1 : c, across ? r : r - 1) - 2 * value(c, r) +
                    value(across ? c + 1 : c, across ? r : r + 1));
  };
  return std::max(
             {second(column, row), second(column + 1, row), second(column, row + 1), second(column + 1, row + 1)}) /
         8;
}

float ShadedGround::bent(const Grid& grid, std::size_t column, std::size_t row) {
  return std::max(bent(grid, column, row, true), bent(grid, column, row, false));
}

// Light bends at the edges of shadows, which lie in few cells: these have nodes of their own.
void ShadedGround::divide() {
  const std::size_t columns = occluded_.x.size() - 1, rows = occluded_.z.size() - 1;
  divided_.assign(columns * rows, kWhole);
  std::vector<std::size_t> curved;
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t column = 0; column < columns; ++column) {
      if (bent(occluded_, column, row) <= bent_) continue;
      divided_[row * columns + column] = static_cast<std::uint32_t>(curved.size());
      curved.push_back(row * columns + column);
    }
  }
  fine_.resize(curved.size() * kFineNodes * kFineNodes);
  parallel_each(curved.size(), 16, [&](std::size_t k) {
    const std::size_t column = curved[k] % columns, row = curved[k] / columns;
    for (std::size_t node = 0; node < kFineNodes * kFineNodes; ++node) {
      const float right = static_cast<float>(node % kFineNodes) / kDivisions,
                  down = static_cast<float>(node / kFineNodes) / kDivisions;
      fine_[k * kFineNodes * kFineNodes + node] =
          occluded(soft_, start_at(std::lerp(occluded_.x[column], occluded_.x[column + 1], right),
                                   std::lerp(occluded_.z[row], occluded_.z[row + 1], down)));
    }
  });
}

// Means over the neighboring nodes, by 1 2 1 each way: light from a mesh to a floor changes slowly, and has more noise
// than the light that the mesh blocks.
void ShadedGround::smooth(Grid& grid) {
  const std::size_t columns = grid.x.size(), rows = grid.z.size();
  const auto along = [&](std::size_t count, std::size_t step, std::size_t lines, std::size_t line_step) {
    for (std::size_t line = 0; line < lines; ++line) {
      Float3* values = &grid.values[line * line_step];
      Float3 before = values[0];
      for (std::size_t i = 0; i < count; ++i) {
        const Float3 own = values[i * step], after = i + 1 < count ? values[(i + 1) * step] : own;
        values[i * step] = 0.25F * before + 0.5F * own + 0.25F * after;
        before = own;
      }
    }
  };
  along(columns, 1, rows, columns), along(rows, columns, columns, 1);
}

Float3 ShadedGround::largest_beside(const Grid& grid, std::size_t column, std::size_t row) {
  Float3 largest;
  for (std::size_t r = std::max<std::size_t>(row, 1) - 1; r < std::min(row + 2, grid.z.size()); ++r)
    for (std::size_t c = std::max<std::size_t>(column, 1) - 1; c < std::min(column + 2, grid.x.size()); ++c)
      if (const Float3& v = grid.at(c, r); r != row || c != column)
        largest = {std::max(largest.x, v.x), std::max(largest.y, v.y), std::max(largest.z, v.z)};
  return largest;
}

// Directions even by the cosine.
void ShadedGround::gather(const std::vector<float>& x, const std::vector<float>& z, const GroundRequest& request,
                          const color::Rgb& irradiance) {
  bounced_.x = x, bounced_.z = z;
  const auto count = static_cast<std::uint32_t>(request.bounced_directions);
  Grid rare{x, z, std::vector<Float3>(x.size() * z.size())};
  fill(bounced_, [&](const Float3& start, std::size_t node) {
    const Sequence sequence(mixed(request.seed, node), count);
    const Cone toward = cone(start);
    color::Rgb sum, above;
    for (std::uint32_t first = 0; first < count; first += kFanRays) {
      rays::Fan fan;
      fan.origin = start;
      for (std::uint32_t i = 0; i < kFanRays; ++i) {
        const std::array<double, 4> numbers = sequence.point(first + i, 0);
        const double across = std::sqrt(numbers[0]), phi = 2 * kPi * numbers[1];
        fan.x[i] = static_cast<float>(across * std::cos(phi)), fan.z[i] = static_cast<float>(across * std::sin(phi));
        fan.y[i] = static_cast<float>(std::sqrt(1 - numbers[0]));
        if (fan.y[i] > 0) fan.wanted |= 1U << i;
      }
      fan.wanted = toward.wanted(fan);
      if (fan.wanted == 0) continue;
      rays::Hit hits[kFanRays];
      scene_->closest(fan, hits);
      for (std::uint32_t i = 0; i < kFanRays; ++i) {
        if (!hits[i].any()) continue;
        color::Rgb light = request.sent(hits[i], start, {fan.x[i], fan.y[i], fan.z[i]}, sequence, first + i);
        for (int c = 0; c < 3; ++c) light[c] = irradiance[c] > 0 ? kPi * light[c] / irradiance[c] : 0;
        const double part = kRare / std::max({light.x, light.y, light.z, kRare});
        sum += part * light, above += (1 - part) * light;
      }
    }
    rare.values[node] = rays::float3((1.0 / count) * above);
    return rays::float3((1.0 / count) * sum);
  });
  for (std::size_t row = 0; row < z.size(); ++row)
    for (std::size_t column = 0; column < x.size(); ++column) {
      const Float3 &own = rare.at(column, row), most = largest_beside(rare, column, row);
      Float3& value = bounced_.values[row * x.size() + column];
      value = value + Float3{std::min(own.x, most.x), std::min(own.y, most.y), std::min(own.z, most.z)};
    }
  smooth(bounced_);
}

Float3 ShadedGround::occluded(const Directions& directions, const Float3& start) const {
  const Cone toward = cone(start);
  Float3 sum;
  for (std::size_t k = 0; k < directions.fans.size(); ++k) {
    const unsigned wanted = toward.wanted(directions.fans[k]);
    if (wanted == 0) continue;
    rays::Fan fan = directions.fans[k];
    fan.origin = start, fan.wanted = wanted;
    const unsigned met = scene_->occluded(fan);
    for (unsigned bits = met; bits != 0; bits &= bits - 1)
      sum = sum + directions.shares[kFanRays * k + static_cast<std::size_t>(std::countr_zero(bits))];
  }
  return sum;
}

Float3 ShadedGround::occluded(const Source& source, const Float3& start) const {
  const Float3 few = occluded(source.few, start);
  constexpr float kAll = 1 - 1e-5F;
  if (mean_of(few) == 0) return few;
  return mean_of(few) >= kAll * mean_of(source.share) ? source.share : occluded(source.many, start);
}

Float3 ShadedGround::between(const Grid& grid, const Place& at) {
  return between_four(&grid.at(at.column, at.row), &grid.at(at.column, at.row + 1), at.right, at.down);
}

Float3 ShadedGround::soft_occluded(std::size_t column, std::size_t row, float right, float down) const {
  const std::uint32_t divided = divided_[row * (occluded_.x.size() - 1) + column];
  if (divided == kWhole) return between_four(&occluded_.at(column, row), &occluded_.at(column, row + 1), right, down);
  const auto cell = [](float& part) {
    part *= kDivisions;
    const std::size_t i = std::min(kDivisions - 1, static_cast<std::size_t>(part));
    part -= static_cast<float>(i);
    return i;
  };
  const std::size_t x = cell(right), z = cell(down);
  const Float3* upper = &fine_[(divided * kFineNodes + z) * kFineNodes + x];
  return between_four(upper, upper + kFineNodes, right, down);
}

GroundLight ShadedGround::light(const Float3& place, const Place* at) const {
  GroundLight light;
  if (at == nullptr) return light;
  light.left = color::Rgb{1, 1, 1} - rays::vec3(soft_occluded(at->column, at->row, at->right, at->down));
  if (const auto beside = bounced_.find(place); beside) light.bounced = rays::vec3(between(bounced_, *beside));
  return light;
}

namespace {

void take(const Float3& hidden, GroundLight& light) {
  light.left += -1.0 * color::Rgb(rays::vec3(hidden));
}

void keep_positive(GroundLight& light) {
  for (int c = 0; c < 3; ++c) light.left[c] = std::max(0.0, light.left[c]);
}

}  // namespace

GroundLight ShadedGround::seen(const Float3& place) const {
  const auto at = occluded_.find(place);
  GroundLight shown = light(place, at ? &*at : nullptr);
  for (const Source& source : sources_) {
    const auto state = at ? source.states[at->row * (occluded_.x.size() - 1) + at->column] : Source::kAsked;
    if (state == Source::kFree) continue;
    take(state == Source::kSmooth ? between(source.nodes, *at) : occluded(source, start_at(place.x, place.z)), shown);
  }
  keep_positive(shown);
  return shown;
}

GroundLight ShadedGround::met(const Float3& place, double number) const {
  const auto at = occluded_.find(place);
  GroundLight shown = light(place, at ? &*at : nullptr);
  const Float3 start = start_at(place.x, place.z);
  for (const Source& source : sources_) {
    const std::size_t count = source.many.fans.size() * kFanRays;
    std::size_t ray = std::min(count - 1, static_cast<std::size_t>(number * static_cast<double>(count)));
    const rays::Fan& fan = source.many.fans[ray / kFanRays];
    ray %= kFanRays;
    if ((fan.wanted >> ray & 1U) == 0) ray = 0;
    const Float3 direction{fan.x[ray], fan.y[ray], fan.z[ray]};
    const Cone toward = cone(start);
    if (rays::dot(direction, toward.axis) < toward.cosine) continue;
    if (scene_->occluded(start, direction)) take(source.share, shown);
  }
  keep_positive(shown);
  return shown;
}

}  // namespace goniochrome::render
