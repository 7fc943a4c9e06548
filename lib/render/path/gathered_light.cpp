#include "render/path/gathered_light.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "render/path/covariance.h"

namespace goniochrome::render {

namespace {

using rays::Float3;

constexpr int kFirstSequences = 2;
constexpr std::size_t kHeldOut = 200;                   // of the mesh, and of the floor
constexpr double kHeldOutSequences = 16;                // at a tolerance of 1
constexpr double kReach = 2;                            // steps to each side
constexpr float kWidth = 0.7F;                          // of the kernel, in steps
constexpr float kTurn = 0.25F;                          // of the kernel, in the difference of unit normals
constexpr float kLeastCosine = 0.8F, kMostRise = 0.4F;  // between two points of one smooth surface
constexpr double kRidge = 0.05;
constexpr double kOpenShare = 0.25;  // of the tolerance, for sums over the open environment
constexpr std::uint32_t kShelterRays = 8;
constexpr float kNearby = 0.05F;  // of rays that ask what is near, in local units

std::uint64_t seed_of(std::uint64_t seed, std::uint64_t point, int sequence) {
  return mixed(mixed(seed, point), static_cast<std::uint64_t>(sequence));
}

color::Rgb over(const color::Rgb& a, const color::Rgb& b) {
  const auto by = [](double x, double y) { return y > 0 ? x / y : 0; };
  return {by(a.x, b.x), by(a.y, b.y), by(a.z, b.z)};
}

// The first row of the inverse of a symmetric 3 x 3 matrix: xx xy xz yy yz zz.
std::array<double, 3> first_row(const std::array<double, 6>& m) {
  const double a = m[3] * m[5] - m[4] * m[4], b = m[2] * m[4] - m[1] * m[5], c = m[1] * m[4] - m[2] * m[3];
  const double det = m[0] * a + m[1] * b + m[2] * c;
  return {a / det, b / det, c / det};
}

}  // namespace

GatheredLight::GatheredLight(const Transport& transport, const VisibleSurface& centers, const GatherRequest& request)
    : transport_(transport),
      surface_(centers),
      request_(request),
      sampled_(request.options),
      width_(centers.gbuffer.width),
      height_(centers.gbuffer.height) {
  sampled_.correction = request.options.correction || request.open != nullptr;
  level_.assign(surface_.hits.size(), kFirstLevel);
  number_.assign(surface_.hits.size(), -1);
  beside_.assign(surface_.hits.size(), {kNotSeen, 0, 0});
}

bool GatheredLight::gatherable(int x, int y) const {
  const int part = surface_.gbuffer.part(x, y);
  return part >= 0 && transport_.wear(part) >= 0;
}

double GatheredLight::seen2(const color::Rgb& radiance, const Covariance& covariance) const {
  const double noise = noise_de00(radiance, covariance, request_.white_luminance);
  return noise * noise;
}

std::vector<GatheredLight::Point> GatheredLight::made(const std::vector<std::size_t>& pixels, bool all_exact) const {
  std::vector<Point> points(pixels.size());
  parallel_for(pixels.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      Point& point = points[i];
      point.x = static_cast<int>(pixels[i] % static_cast<std::size_t>(width_));
      point.y = static_cast<int>(pixels[i] / static_cast<std::size_t>(width_));
      const rays::Spot spot = spot_at(transport_.rays(), surface_, point.x, point.y);
      point.to_viewer = surface_.gbuffer.to_viewer(point.x, point.y);
      const PointTransport at(transport_, request_.options, spot, rays::float3(point.to_viewer));
      point.position = spot.position, point.normal = spot.shading, point.part = spot.part;
      point.shelter = shelter(spot, pixels[i]);
      point.scale = transport_.laid_paint(spot);
      point.seen = at.sure();
      if (request_.base != nullptr) {
        const float* rgb = request_.base->pixel(point.x, point.y);
        point.seen += color::Rgb{rgb[0], rgb[1], rgb[2]};
      }
      point.wanted = kFirstSequences;
    }
  });
  add_open(points, all_exact);
  return points;
}

// The exact sums less what the maps have. That changes with the normal and the viewer alone: where it is nearly the
// same at all points of the first lattice nearby, its mean over them is taken.
void GatheredLight::add_open(std::vector<Point>& points, bool all_exact) const {
  if (request_.open == nullptr) return;
  constexpr std::size_t kTogether = 64;
  std::vector<std::uint8_t> known(points.size(), 0);
  parallel_for(points.size(), kTogether, [&](std::size_t begin, std::size_t end) {
    std::vector<VisiblePoint> open;
    std::vector<std::size_t> numbers;
    for (std::size_t i = begin; i < end; ++i) {
      Point& p = points[i];
      known[i] = transport_.shows_ground(p.part);
      if (known[i] != 0) continue;
      open.push_back({rays::vec3(p.normal), p.to_viewer, p.part});
      numbers.push_back(i);
    }
    if (open.empty()) return;
    const std::vector<color::Rgb> quick = request_.open->quick(open);
    for (std::size_t k = 0; k < numbers.size(); ++k) {
      Point& p = points[numbers[k]];
      p.seen += quick[k], p.certain = -1.0 * quick[k];
      if (!all_exact) known[numbers[k]] = take_open_of_neighbors(p);
    }
  });
  std::vector<VisiblePoint> open;
  std::vector<std::size_t> numbers;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (known[i] != 0) continue;
    open.push_back({rays::vec3(points[i].normal), points[i].to_viewer, points[i].part});
    numbers.push_back(i);
  }
  const std::vector<color::Rgb> exact = request_.open->exact(open, kOpenShare * request_.tolerance_de00);
  for (std::size_t i = 0; i < numbers.size(); ++i) points[numbers[i]].certain += exact[i];
}

bool GatheredLight::take_open_of_neighbors(Point& point) const {
  Near found[kMostNear];
  const int count = near(point.x, point.y, point.position, point.normal, point.part, 1 << kFirstLevel, -1, found);
  color::Rgb mean;
  double total = 0;
  int exact = 0;
  for (int k = 0; k < count; ++k) {
    const Point& other = points_[static_cast<std::size_t>(found[k].point)];
    mean += static_cast<double>(found[k].weight) * other.certain, total += found[k].weight;
    exact += found[k].weight > 0.1F ? 1 : 0;
  }
  if (exact < 3) return false;
  mean = (1 / total) * mean;
  Covariance spread{};
  for (int k = 0; k < count; ++k)
    add(spread, found[k].weight / total, outer(points_[static_cast<std::size_t>(found[k].point)].certain - mean));
  const double most = kOpenShare * request_.tolerance_de00;
  if (seen2(point.seen, spread) > most * most) return false;
  point.certain = mean;
  return true;
}

// The sequences that each point wants.
void GatheredLight::draw(std::vector<Point>& points, const Deadline* deadline) const {
  std::vector<std::size_t> wanted;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (points[i].wanted > 0) wanted.push_back(i);
  parallel_for(wanted.size(), 8, [&](std::size_t begin, std::size_t end) {
    if (deadline != nullptr && deadline->passed()) return;
    for (std::size_t i = begin; i < end; ++i) {
      Point& point = points[wanted[i]];
      const rays::Spot spot = spot_at(transport_.rays(), surface_, point.x, point.y);
      const PointTransport at(transport_, sampled_, spot, rays::float3(point.to_viewer));
      point.sampled = !at.lobes_certain();
      for (int k = 0; k < point.wanted && point.sampled; ++k) {
        const std::uint64_t seed = seed_of(request_.seed, pixel(point.x, point.y), point.sums.count());
        point.sums.add(over(at.lobes_mean(seed, kDirections), point.scale));
      }
    }
  });
  for (Point& point : points) point.wanted = 0;
}

void GatheredLight::add_points(const std::vector<std::size_t>& pixels, const Deadline* deadline) {
  std::vector<Point> more = made(pixels, points_.empty());
  draw(more, deadline);
  for (Point& point : more) {
    if (point.sampled && point.sums.count() == 0) continue;  // time was up
    number_[pixel(point.x, point.y)] = static_cast<std::int32_t>(points_.size());
    points_.push_back(point);
  }
}

void GatheredLight::begin() {
  std::vector<std::size_t> lattice, others[2];
  constexpr int kStep = 1 << kFirstLevel;
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x) {
      if (!gatherable(x, y)) continue;
      const bool floor = is_floor(surface_.gbuffer.part(x, y));
      (x % kStep == kOffset && y % kStep == kOffset ? lattice : others[floor ? 1 : 0]).push_back(pixel(x, y));
    }
  }
  add_points(lattice, nullptr);
  // Held out are pixels drawn by chance, one from each of equal stretches.
  std::vector<std::size_t> chosen;
  for (std::size_t f = 0; f < 2; ++f) {
    const std::vector<std::size_t>& all = others[f];
    const std::size_t count = std::min(all.size() / 4, kHeldOut);
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t first = k * all.size() / count, end = (k + 1) * all.size() / count;
      chosen.push_back(all[first + mixed(request_.seed ^ 0x68656C64U, k) % (end - first)]);
    }
  }
  held_out_ = made(chosen, true);
  const double tolerance = request_.tolerance_de00;
  for (Point& point : held_out_)
    point.wanted = static_cast<int>(
        std::clamp(kHeldOutSequences / (tolerance * tolerance), kHeldOutSequences, 8 * kHeldOutSequences));
  draw(held_out_, nullptr);
}

// Points of the same smooth surface on the lattice of this step; how many.
int GatheredLight::near(double x, double y, const Float3& position, const Float3& normal, int part, int step,
                        std::int32_t without, Near* found) const {
  const int wear = transport_.wear(part);
  const auto low = [&](double at) { return static_cast<int>(std::ceil((at - kOffset) / step - kReach)); };
  const auto high = [&](double at) { return static_cast<int>(std::floor((at - kOffset) / step + kReach)); };
  int count = 0;
  for (int j = low(y); j <= high(y); ++j) {
    const int row = kOffset + j * step;
    if (row < 0 || row >= height_) continue;
    for (int i = low(x); i <= high(x); ++i) {
      const int column = kOffset + i * step;
      if (column < 0 || column >= width_) continue;
      const std::int32_t number = number_[pixel(column, row)];
      if (number < 0 || number == without || count == kMostNear) continue;
      const Point& point = points_[static_cast<std::size_t>(number)];
      if (transport_.wear(point.part) != wear) continue;
      const float cosine = rays::dot(point.normal, normal);
      if (cosine < kLeastCosine) continue;
      const Float3 chord = point.position - position;
      const float most = kMostRise * rays::length(chord) + rays::kLift;
      if (std::abs(rays::dot(chord, normal)) > most || std::abs(rays::dot(chord, point.normal)) > most) continue;
      const auto u = static_cast<float>((column - x) / step), v = static_cast<float>((row - y) / step);
      const float distance2 = (u * u + v * v) / (kWidth * kWidth) + 2 * (1 - cosine) / (kTurn * kTurn);
      found[count++] = {number, std::exp(-0.5F * distance2), u, v, 0};
    }
  }
  return count;
}

// A plane through the values, fitted with the weights of the kernel, at the place itself.
GatheredLight::Mix GatheredLight::mixed_at(double x, double y, const Float3& position, const Float3& normal, int part,
                                           int step, std::int32_t without) const {
  Near found[kMostNear];
  Mix mix;
  const int count = near(x, y, position, normal, part, step, without, found);
  const bool own = count > 0 && step == 1;
  if (count < 3 && !own) return mix;
  std::array<double, 6> moments{};
  for (int k = 0; k < count; ++k) {
    const double w = found[k].weight, u = found[k].u, v = found[k].v;
    const double terms[6] = {w, w * u, w * v, w * u * u, w * u * v, w * v * v};
    for (std::size_t m = 0; m < 6; ++m) moments[m] += terms[m];
  }
  if (!(moments[0] > 0.05)) return mix;
  moments[3] += kRidge * moments[0], moments[5] += kRidge * moments[0];
  const std::array<double, 3> row = first_row(moments);
  double size = 0;
  for (int k = 0; k < count; ++k) {
    Near& n = found[k];
    n.share = static_cast<float>(n.weight * (row[0] + row[1] * n.u + row[2] * n.v));
    size += std::abs(n.share);
  }
  mix.count = count;
  const bool flat = size > 2;  // the plane would be carried far beyond its points
  for (int k = 0; k < count; ++k) {
    const Point& point = points_[static_cast<std::size_t>(found[k].point)];
    const double even = found[k].weight / moments[0], share = flat ? even : found[k].share;
    mix.light += share * point.value();
    mix.shown += even * point.shown();
    add(mix.noise, share * share, point.variance);
    add(mix.error, even, point.error);
    mix.samples += even * kDirections * point.sums.count();
    mix.shelter += even * point.shelter;
    mix.points[k] = found[k].point;
  }
  return mix;
}

// The share of directions, drawn by the cosine, along which a surface is near.
float GatheredLight::shelter(const rays::Spot& spot, std::size_t at) const {
  const rays::Frame frame = rays::frame_about(spot.shading);
  const Sequence sequence(mixed(request_.seed, at), kShelterRays);
  int blocked = 0;
  for (std::uint32_t k = 0; k < kShelterRays; ++k) {
    const auto numbers = sequence.point(k, 1);
    const auto r = static_cast<float>(std::sqrt(numbers[0])), phi = static_cast<float>(2 * kPi * numbers[1]),
               up = static_cast<float>(std::sqrt(1 - numbers[0]));
    const Float3 direction = (r * std::cos(phi)) * frame.x + (r * std::sin(phi)) * frame.y + up * spot.shading;
    blocked += transport_.rays().blocked(spot.start, direction, kNearby) ? 1 : 0;
  }
  return static_cast<float>(blocked) / kShelterRays;
}

// A pixel in a narrow gap may lie between points that see all of the sky: where much more or less is near than at the
// points, interpolation says nothing. On the finest lattice a pixel has a point of its own, whose light is taken there,
// and where it is less noisy than interpolation errs.
GatheredLight::Mix GatheredLight::best_at(double x, double y, const rays::Spot& spot, int step) const {
  Mix mix = mixed_at(x, y, spot.position, spot.shading, spot.part, step, -1);
  const int column = std::clamp(static_cast<int>(std::lround(x)), 0, width_ - 1),
            row = std::clamp(static_cast<int>(std::lround(y)), 0, height_ - 1);
  const bool alike = mix.count > 0 && std::abs(shelter(spot, pixel(column, row)) - mix.shelter) < kMostUnlike;
  const std::int32_t number = step == 1 && x == column && y == row ? number_[pixel(column, row)] : -1;
  if (number < 0) return alike ? mix : Mix();
  const Point& point = points_[static_cast<std::size_t>(number)];
  if (alike) {
    if (point.sums.count() < kTrusted) return mix;
    Covariance both = mix.noise;
    add(both, 1, mix.error);
    const double told = error_scale_[is_floor(spot.part) ? 1 : 0];
    if (seen2(mix.shown, scaled(point.variance, point.scale)) >= told * seen2(mix.shown, scaled(both, point.scale)))
      return mix;
  }
  mix.single = true;
  mix.count = 1, mix.points[0] = number;
  mix.light = point.value(), mix.shown = point.shown(), mix.noise = point.variance, mix.error = {};
  mix.samples = kDirections * point.sums.count();
  return mix;
}

GatheredLight::Light GatheredLight::at(double x, double y, const rays::Spot& spot) const {
  if (transport_.wear(spot.part) < 0) return {};
  const int column = std::clamp(static_cast<int>(std::lround(x)), 0, width_ - 1),
            row = std::clamp(static_cast<int>(std::lround(y)), 0, height_ - 1);
  for (int step = step_at(column, row); step <= 1 << kFirstLevel; step *= 2) {
    const Mix mix = best_at(x, y, spot, step);
    if (mix.count == 0) continue;
    Light light{true, mix.light, {}, static_cast<int>(std::lround(mix.samples))};
    add(light.covariance, told_scale(mix.single, spot.part), mix.noise);
    add(light.covariance, told_scale(mix.single, spot.part), mix.error);
    return light;
  }
  return {};
}

double GatheredLight::directions() const {
  double sum = 0;
  for (const std::vector<Point>* all : {&points_, &held_out_})
    for (const Point& point : *all) sum += kDirections * point.sums.count();
  return sum;
}

}  // namespace goniochrome::render
