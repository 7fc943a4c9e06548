#include "render/path/lobe_point.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "base/angles.h"
#include "render/path/ground_kernel.h"
#include "render/path/path_loop.h"

namespace goniochrome::render {

namespace {

using rays::Float3;
using rays::Hit;

constexpr float kShort = 1 - 1e-4F;   // a ray to a point of an emitter ends this part of the way short of it
constexpr float kLightChance = 0.5F;  // that a direction is drawn from the environment, where there is one
constexpr int kMirrorShare = 8;       // one mirror sample to so many directions, where the mirror sees a surface

color::Rgb rgb(const Float3& c) {
  return rays::vec3(c);
}

double brightness(const color::Rgb& c) {
  return (std::abs(c.x) + std::abs(c.y) + std::abs(c.z)) / 3;
}

}  // namespace

// The light that a surface on a ray sends back along it, by class; apart from them, the light off a floor that no paint
// changes.
struct LobePoint::Sent {
  color::Rgb base, gloss, deeper, fixed;
  color::Rgb total() const { return base + gloss + deeper; }
};

// Light that one surface reflects, by the class of its reflection: base, or gloss and mirror.
class LobePoint::Classes {
 public:
  static constexpr bool kWeighsLamps = false;
  struct Reflected {
    Float3 base, gloss;
    float pdf = 0;
  };
  Classes(const LobePoint& point, Sent& sent) : point_(point), sent_(sent) {}

  Reflected reflected(const Transport::Vertex& vertex, const Float3& to_light) const {
    const PaintedPoint::Parts parts = vertex.painted.parts(to_light);
    return {parts.diffuse + parts.lobes - parts.gloss, parts.gloss, parts.pdf};
  }
  void add_reflected(const Transport::Vertex&, const Reflected& f, double scale, const PathLight& light) {
    const auto s = static_cast<float>(scale);
    sent_.base += point_.reflect(s * f.base, light.rgb), sent_.gloss += point_.reflect(s * f.gloss, light.rgb);
  }
  void add(double scale, const PathLight& light) {
    const auto s = static_cast<float>(scale);
    sent_.base += point_.reflect(s * base_, light.rgb), sent_.gloss += point_.reflect(s * gloss_, light.rgb);
  }
  void reflect(const Transport::Vertex&, const Reflected& f, double scale) {
    base_ = static_cast<float>(scale) * f.base, gloss_ = static_cast<float>(scale) * f.gloss;
  }
  void mirror(const Transport::Vertex& vertex, double scale) {
    base_ = {}, gloss_ = static_cast<float>(scale) * vertex.painted.mirror();
  }
  // Returns light of further surfaces as this one reflects it.
  color::Rgb shown(const color::Rgb& light) const { return point_.reflect(base_ + gloss_, light); }

 private:
  const LobePoint& point_;
  Sent& sent_;
  Float3 base_, gloss_;
};

// Means over the directions of each sequence, column by column: light of the environment from unoccluded and from
// occluded directions, light of emitters, and bounced light. The squares of single directions tell which estimate is
// the quieter one.
struct LobePoint::Sums {
  std::size_t columns;
  int directions;
  std::vector<color::Rgb> free, hidden, emitted, bounced;
  std::vector<double> free_squares, hidden_squares;
  std::vector<color::Rgb> classes;
  // Columns before this one have the open floor in the light that is known of them, in place of the environment below
  // the horizon.
  std::size_t over_floor = 0;

  Sums(std::size_t count, int of_directions, std::size_t of_columns, std::size_t of_classes)
      : columns(of_columns),
        directions(of_directions),
        free(count * of_columns),
        hidden(free.size()),
        emitted(free.size()),
        bounced(free.size()),
        free_squares(free.size()),
        hidden_squares(free.size()),
        classes(of_classes) {}
  std::size_t at(int sequence, std::size_t column) const {
    return static_cast<std::size_t>(sequence) * columns + column;
  }
};

LobePoint::LobePoint(const Transport& transport, const LobeColumns& columns, const PaintGroups& groups, int bounces,
                     const rays::Spot& spot, const Float3& to_viewer)
    : transport_(transport),
      columns_(columns),
      groups_(groups),
      spot_(spot),
      painted_(transport.painted(spot, to_viewer)),
      kernels_(columns, painted_) {
  options_.bounces = bounces;
  if (transport.environment_) light_chance_ = kLightChance;
  on_projected_ = transport.is_projected(spot);
  open_ = !transport.rays_->has_floor() && !transport.rays_->any_above(spot.start, spot.shading, 0);
  if (!open_ && !on_projected_) mirror_hit_ = transport.rays_->closest(spot_.start, painted_.mirrored());
}

color::Rgb LobePoint::reflect(const Float3& f, const color::Rgb& light) const {
  return transport_.reflection_ != nullptr ? color::reflected(*transport_.reflection_, rgb(f), light) : rgb(f) * light;
}

LobePoint::Ray LobePoint::drawn_ray(const std::array<double, 4>& numbers) const {
  Ray ray;
  if (numbers[0] < light_chance_) {
    const EnvironmentTable::Place place = transport_.environment_->place(numbers[1], numbers[2]);
    if (!(place.density > 0)) return ray;
    ray.direction = place.direction;
  } else {
    ray.direction = kernels_.direction((numbers[0] - light_chance_) / (1 - light_chance_), numbers[1], numbers[2]);
  }
  ray.above = rays::dot(ray.direction, spot_.shading) > 0;
  return ray;
}

// Those of one sequence.
std::vector<LobePoint::Ray> LobePoint::traced_rays(int directions, std::uint64_t seed, bool& any_occluded) const {
  std::vector<Ray> rays(static_cast<std::size_t>(directions));
  const Sequence sequence(seed, static_cast<std::uint32_t>(directions));
  for (int first = 0; first < directions; first += 8) {
    Ray* eight = &rays[static_cast<std::size_t>(first)];
    rays::Fan fan;
    fan.origin = spot_.start;
    for (int i = 0; i < 8; ++i) {
      eight[i] = drawn_ray(sequence.point(static_cast<std::uint32_t>(first + i), 0));
      fan.x[i] = eight[i].direction.x, fan.y[i] = eight[i].direction.y, fan.z[i] = eight[i].direction.z;
      if (eight[i].above) fan.wanted |= 1U << i;
    }
    const unsigned occluded = transport_.rays_->occluded(fan);
    for (int i = 0; i < 8; ++i) eight[i].occluded = (occluded >> i & 1U) != 0;
    any_occluded = any_occluded || occluded != 0;
  }
  return rays;
}

// A path whose first surface is told in two parts. What comes from further surfaces is told apart.
LobePoint::Sent LobePoint::sent(const Hit& hit, const Float3& direction, const Sequence& sequence,
                                std::uint32_t index) const {
  Sent sent;
  const Transport& t = transport_;
  if (t.is_projected(hit)) {
    const Transport::FloorLight floor = t.off_floor(hit, spot_.start, direction, options_.bounces, sequence, index, 4);
    sent.fixed = floor.fixed, sent.deeper = floor.bounced;
    return sent;
  }
  const Transport::Vertex vertex(t, t.rays_->spot(hit, spot_.start, direction), -direction);
  if (vertex.painted.black()) return sent;
  Classes light(*this, sent);
  const Transport::Next next = t.step(vertex, sequence.point(index, 4), sequence.point(index, 5), light);
  if (!next.goes_on() || !next.hit.any()) return sent;
  const int further = options_.bounces - 1;
  if (t.is_projected(next.hit)) {
    const Transport::FloorLight floor = t.off_floor(next.hit, next.start, next.direction, further, sequence, index, 6);
    light.add(1, {floor.fixed});
    sent.deeper = light.shown(floor.bounced);
  } else if (further > 0) {
    sent.deeper = light.shown(t.bounced(next.hit, next.start, next.direction, further, sequence, index, 6));
  }
  return sent;
}

void LobePoint::add_classes(const Float3& f, const Hit& hit, const Sent& sent, double share, Sums& sums) const {
  const int group = group_of(hit);
  sums.classes[groups_.at(group, PaintGroups::kBase)] += share * reflect(f, sent.base);
  sums.classes[groups_.at(group, PaintGroups::kGloss)] += share * reflect(f, sent.gloss);
  sums.classes[groups_.at(group, PaintGroups::kDeeper)] += share * reflect(f, sent.deeper);
}

void LobePoint::add_ray(const Ray& ray, const Sequence& sequence, std::uint32_t index, Sums& sums, int which) const {
  float values[2 * kMostTracedLobes + 2];
  const float kernels_pdf = kernels_.at(ray.direction, values);
  LightSample light;
  if (transport_.environment_) light = transport_.environment_->at(ray.direction);
  const double pdf = light_chance_ * light.pdf + (1 - light_chance_) * kernels_pdf;
  if (!(pdf > 0) || !(kernels_pdf > 0)) return;
  const double scale = 1 / pdf;
  const bool passes_on = options_.bounces > 0 || !transport_.emitters_.empty() || transport_.ground_;
  const Hit hit = ray.occluded && passes_on ? transport_.rays_->closest(spot_.start, ray.direction) : Hit{};
  const bool meets_floor = transport_.is_projected(hit);
  const Sent sent =
      hit.any() && (options_.bounces > 0 || meets_floor) ? this->sent(hit, ray.direction, sequence, index) : Sent{};
  const std::size_t first = sums.at(which, 0), count = columns_.count();
  const auto add_open = [&](std::size_t begin, std::size_t end, const color::Rgb& radiance, bool is_hidden) {
    std::vector<color::Rgb>& into = is_hidden ? sums.hidden : sums.free;
    std::vector<double>& squares = is_hidden ? sums.hidden_squares : sums.free_squares;
    const double size = scale * brightness(radiance);
    for (std::size_t k = begin; k < end; ++k) {
      into[first + k] += (scale / sums.directions * values[k]) * radiance;
      squares[first + k] += size * size * values[k] * values[k];
    }
  };
  if (meets_floor) {
    add_open(0, sums.over_floor, sent.fixed + sent.total(), false);
  } else if (sums.over_floor > 0) {
    const bool below = ray.direction.y < 0;
    add_open(0, sums.over_floor,
             below ? rgb(transport_.open_floor_->lit(spot_.start, ray.direction, 0, 0)) : light.radiance, ray.occluded);
  }
  add_open(sums.over_floor, count, light.radiance, ray.occluded);
  if (!hit.any()) return;
  const color::Rgb& emission = transport_.emitters_.radiance(transport_.rays_->part(hit.triangle));
  if (emission != color::Rgb{}) {
    const double share =
        1 / (pdf + transport_.emitters_.pdf(lit_point(spot_), hit.triangle, ray.direction, hit.distance));
    for (std::size_t k = 0; k < count; ++k) sums.emitted[first + k] += (share / sums.directions * values[k]) * emission;
  }
  const color::Rgb total = sent.total();
  const std::size_t begin = meets_floor ? sums.over_floor : 0;
  for (std::size_t k = begin; sent.fixed != color::Rgb{} && k < count; ++k)
    sums.emitted[first + k] += (scale / sums.directions * values[k]) * sent.fixed;
  if (total == color::Rgb{}) return;
  for (std::size_t k = begin; k < count; ++k) sums.bounced[first + k] += (scale / sums.directions * values[k]) * total;
  const Float3 f_cos = begin > 0 ? beside_floor(ray.direction) : painted_.at(ray.direction).f_cos;
  add_classes(static_cast<float>(scale) * f_cos, hit, sent, 1.0 / sums.directions, sums);
}

// f cos of the paint without the lobes whose light of a floor is known, which is none of bounced light.
Float3 LobePoint::beside_floor(const Float3& direction) const {
  const auto wide = painted_.wide_lobes(kWidestShared, GroundReceiver::kMostLobes);
  return wide ? painted_.without_wide(wide->size()).at(direction).f_cos : painted_.at(direction).f_cos;
}

void LobePoint::add_emitter(const std::array<double, 4>& numbers, Sums& sums, int which) const {
  const EmitterSample light = transport_.emitters_.drawn(lit_point(spot_), numbers[0], numbers[1], numbers[2]);
  float values[2 * kMostTracedLobes + 2];
  const float kernels_pdf = light.pdf > 0 ? kernels_.at(light.direction, values) : 0;
  if (!(kernels_pdf > 0) || transport_.rays_->occluded(spot_.start, light.direction, kShort * light.distance)) return;
  const double open_pdf = transport_.environment_ ? transport_.environment_->at(light.direction).pdf : 0;
  const double scale = 1 / (light.pdf + light_chance_ * open_pdf + (1 - light_chance_) * kernels_pdf);
  for (std::size_t k = 0; k < columns_.count(); ++k)
    sums.emitted[sums.at(which, k)] += (scale / sums.directions * values[k]) * light.radiance;
}

void LobePoint::add_mirror(std::uint64_t seed, Sums& sums, int which) const {
  if (!mirror_hit_.any() || (options_.bounces == 0 && !transport_.is_projected(mirror_hit_))) return;
  const std::size_t mirror = sums.at(which, columns_.mirror());
  const auto add = [&](const Sent& sent, double share) {
    sums.bounced[mirror] += (share * kernels_.mirror()) * sent.total();
    sums.emitted[mirror] += (share * kernels_.mirror()) * sent.fixed;
    add_classes(painted_.mirror(), mirror_hit_, sent, share, sums);
  };
  if (const auto floor = transport_.seen_floor(mirror_hit_, spot_.start, painted_.mirrored()))
    return add({{}, {}, floor->into_diffuse, floor->direct}, 1);
  const int samples = std::max(1, sums.directions / kMirrorShare);
  const Sequence sequence(mixed(seed, 0x4D), static_cast<std::uint32_t>(sums.directions));
  for (int i = 0; i < samples; ++i)
    add(sent(mirror_hit_, painted_.mirrored(), sequence, static_cast<std::uint32_t>(i)), 1.0 / samples);
}

std::size_t LobePoint::floor_lobes() const {
  if (transport_.open_floor_ == nullptr || !painted_.axes().empty()) return 0;
  const auto wide = std::ranges::count_if(columns_.exponents, [](double e) { return e <= kWidestShared; });
  return std::min(static_cast<std::size_t>(wide), GroundReceiver::kMostLobes);
}

void LobePoint::add_open_floor(color::Rgb* open_light) const {
  const std::size_t lobes = floor_lobes();
  if (lobes == 0) return;
  GroundReceiver receiver = ground_receiver(spot_, painted_);
  receiver.lobes = lobes;
  std::copy_n(columns_.exponents.begin(), lobes, receiver.exponents);
  const GroundColumns floor = transport_.open_floor_->columns(receiver);
  open_light[LobeColumns::diffuse()] += rgb(floor.diffuse);
  for (std::size_t j = 0; j < lobes; ++j)
    open_light[LobeColumns::flake(j)] += rgb(floor.flakes[j]), open_light[LobeColumns::gloss(j)] += rgb(floor.gloss[j]);
}

// The columns gather light of a disc that the mesh may hide in part: even directions of it, of which some are free.
bool LobePoint::lamp_values(std::size_t which, const Transport::SeenLamp& lamp, float* values) const {
  constexpr std::uint32_t kDirections = 64;
  const bool any = kernels_.toward_disc(lamp.light, !lamp.is_placed, values);
  if (!any || open_) return any;
  const std::size_t count = columns_.count();
  float sums[2 * kMostTracedLobes + 2] = {}, here[2 * kMostTracedLobes + 2];
  bool all_free = true;
  const Sequence sequence(mixed(0x1A3B, which), kDirections);
  for (std::uint32_t i = 0; i < kDirections; ++i) {
    const std::array<double, 4> numbers = sequence.point(i, 0);
    const Transport::LampSample sample = Transport::drawn_from(lamp, numbers[0], numbers[1]);
    if (!(kernels_.at(sample.direction, here) > 0)) continue;
    if (transport_.rays_->occluded(spot_.start, sample.direction, sample.reach)) {
      all_free = false;
      continue;
    }
    const double half = std::cos(0.5 * lamp.light.radius_rad), share = 1 / (half * half * kDirections);
    for (std::size_t k = 0; k < count; ++k) sums[k] += static_cast<float>(share) * here[k];
  }
  if (!all_free) std::copy_n(sums, count, values);
  return true;
}

// Lamps, whose shadow rays decide all, and what the mirror sees without a bounce.
void LobePoint::add_deterministic(const color::Rgb* open_mirror, double share, std::vector<color::Rgb>& direct) const {
  float values[2 * kMostTracedLobes + 2];
  for (std::size_t i = 0; i < transport_.lights_.size(); ++i) {
    const Transport::SeenLamp lamp = transport_.seen_lamp(i, spot_.start);
    const Light& light = lamp.light;
    if (light.radius_rad > 0) {
      if (!lamp_values(i, lamp, values)) continue;
    } else {
      const Float3 direction = rays::float3(light.direction);
      if (!(kernels_.at(direction, values) > 0)) continue;
      if (!open_ && transport_.rays_->occluded(spot_.start, direction, lamp.reach)) continue;
    }
    for (std::size_t k = 0; k < columns_.count(); ++k) direct[k] += (share * kPi * values[k]) * light.white;
  }
  color::Rgb& mirror = direct[columns_.mirror()];
  const double weight = share * kernels_.mirror();
  if (!transport_.lights_.empty())
    mirror += weight * transport_.mirrored_lamps(spot_.start, painted_.mirrored(), mirror_hit_);
  if (mirror_hit_.any()) {
    mirror += weight * transport_.emitters_.radiance(transport_.rays_->part(mirror_hit_.triangle));
  } else if (open_mirror != nullptr) {
    mirror += share * *open_mirror;
  } else if (transport_.environment_) {
    mirror += weight * transport_.mirrored_environment(painted_.mirrored());
  }
}

namespace {

// Among so many points, the one that a sequence starts from: the even sequences go through all of them in one order and
// the odd ones in another, so that the start of one half says nothing of the other.
std::size_t start_of(int sequence, std::size_t points, std::uint64_t seed) {
  const auto half = static_cast<std::uint64_t>(sequence % 2), turn = static_cast<std::uint64_t>(sequence / 2) / points;
  const auto step = static_cast<std::size_t>(sequence / 2) % points;
  std::array<std::uint8_t, LobePoint::kMostPoints> order;
  std::iota(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(points), std::uint8_t{0});
  for (std::size_t i = 0; i <= step && i + 1 < points; ++i) {
    const std::uint64_t number = mixed(mixed(seed, 2 * turn + half), 0x57A7U + i);
    std::swap(order[i], order[i + static_cast<std::size_t>(number % (points - i))]);
  }
  return order[step];
}

// The estimates of sequences that start from several points. Where each point has at least two they scatter about the
// means of their points, since what points differ by is no random error of a mean that all of them are part of.
class Scatter {
 public:
  explicit Scatter(std::size_t points) : of_point_(points) {}

  void add(std::size_t point, const color::Rgb& value) { of_point_[point].add(value), all_.add(value); }
  int freedom() const { return all_.count() - (stratified() ? static_cast<int>(of_point_.size()) : 1); }
  Covariance covariance() const {
    if (!stratified()) return all_.covariance();
    Covariance sum{};
    for (const Estimates& point : of_point_) {
      const Covariance own = point.covariance();
      for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += (point.count() - 1.0) / freedom() * own[i];
    }
    return sum;
  }

 private:
  bool stratified() const {
    return std::ranges::all_of(of_point_, [](const Estimates& point) { return point.count() >= 2; });
  }
  std::vector<Estimates> of_point_;
  Estimates all_;
};

}  // namespace

// All that a floor shows is light of its one column; what the mesh sends to it came through other surfaces.
LobeEstimate LobePoint::floor_estimate(std::span<const LobePoint* const> points, int sequences, int directions,
                                       std::uint64_t seed) {
  const LobePoint& any = *points.front();
  LobeEstimate result;
  result.direct.resize(any.columns_.count()), result.bounced.resize(any.columns_.count());
  result.covariance.resize(any.columns_.count()), result.classes.resize(any.groups_.classes());
  const int floor = any.groups_.of_part[static_cast<std::size_t>(any.spot_.part)];
  color::Rgb &direct = result.direct[LobeColumns::diffuse()], &bounced = result.bounced[LobeColumns::diffuse()];
  color::Rgb& deeper = result.classes[any.groups_.at(floor, PaintGroups::kDeeper)];
  std::vector<PointTransport> floors;
  bool certain = true;
  for (const LobePoint* point : points) {
    const double share = 1.0 / static_cast<double>(points.size());
    if (any.transport_.shaded_ != nullptr) {
      const LightShares shown = any.transport_.shaded_ground(point->spot_);
      direct += share * shown.direct, bounced += share * shown.into_diffuse, deeper = bounced;
      continue;
    }
    floors.emplace_back(point->transport_, point->options_, point->spot_, point->painted_.to_viewer());
    direct += share * floors.back().deterministic();
    certain = certain && floors.back().certain();
  }
  if (certain) return result;
  result.sequences = sequences;
  const int batches = std::max(1, directions / kBatch);
  LightShares mean;
  Scatter shown(points.size());
  for (int which = 0; which < sequences; ++which) {
    const std::size_t start = start_of(which, floors.size(), seed);
    const PointTransport& point = floors[start];
    LightShares of_sequence;
    for (int i = 0; i < batches; ++i)
      of_sequence += (1.0 / batches) * point.batch_shares(mixed(mixed(seed, static_cast<std::uint64_t>(which)),
                                                                static_cast<std::uint64_t>(i)));
    mean += (1.0 / sequences) * of_sequence;
    shown.add(start, of_sequence.sum());
  }
  result.freedom = shown.freedom();
  direct += mean.direct;
  bounced = deeper = mean.into_lobes + mean.into_diffuse;
  result.covariance[LobeColumns::diffuse()] = result.shown = shown.covariance();
  return result;
}

void LobePoint::add_sequence(const std::vector<Ray>& rays, std::uint64_t seed, Sums& sums, int which) const {
  const Sequence sequence(seed, static_cast<std::uint32_t>(sums.directions));
  for (std::size_t i = 0; i < rays.size(); ++i)
    if (rays[i].above && (rays[i].occluded || transport_.environment_))
      add_ray(rays[i], sequence, static_cast<std::uint32_t>(i), sums, which);
  if (!transport_.emitters_.empty())
    for (std::uint32_t i = 0; i < rays.size(); ++i) add_emitter(sequence.point(i, 1), sums, which);
  add_mirror(seed, sums, which);
}

// Light L from free directions is what is wanted; M is known of all directions. For any beta that does not depend on
// the samples,
//   (1 - beta) free + beta (M - hidden)
// has the right expectation: beta = 1 takes away what is hidden, beta = 0 sums what is free. The quieter of both is the
// one with the smaller second moment; beta = free2/(free2 + hidden2) is taken for the even sequences from the odd
// ones and for the odd ones from the even ones, so that it depends on no sample that it weighs.
LobeEstimate LobePoint::estimate(std::span<const LobePoint* const> points, const color::Rgb* open_light,
                                 const color::Rgb* open_mirrors, int sequences, int directions, std::uint64_t seed,
                                 const color::Rgb* paint) {
  const LobePoint& any = *points.front();
  if (any.on_projected_) return floor_estimate(points, sequences, directions, seed);
  const Transport& transport = any.transport_;
  const LobeColumns& columns = any.columns_;
  const std::size_t count = columns.count();
  LobeEstimate result;
  result.direct.resize(count), result.bounced.resize(count), result.covariance.resize(count);
  result.classes.resize(any.groups_.classes());
  for (std::size_t i = 0; i < points.size(); ++i)
    points[i]->add_deterministic(open_light != nullptr ? &open_mirrors[i] : nullptr,
                                 1.0 / static_cast<double>(points.size()), result.direct);
  const auto add_open = [&] {
    for (std::size_t k = 0; open_light != nullptr && k + 1 < count; ++k) result.direct[k] += open_light[k];
  };
  const bool summed = open_light == nullptr && transport.environment_ != nullptr;
  if (!summed && std::ranges::all_of(points, [](const LobePoint* point) { return point->open_; })) {
    add_open();
    return result;
  }
  result.sequences = sequences;
  bool any_occluded = summed;
  std::vector<std::vector<Ray>> rays;
  const auto seed_of = [seed](int which) { return mixed(seed, static_cast<std::uint64_t>(which)); };
  std::vector<std::size_t> starts;
  for (int which = 0; which < sequences; ++which) {
    const LobePoint& start = *points[starts.emplace_back(start_of(which, points.size(), seed))];
    rays.push_back(start.traced_rays(directions, seed_of(which), any_occluded));
    any_occluded = any_occluded || start.mirror_hit_.any();
  }
  if (!any_occluded) {
    add_open();
    result.freedom = sequences - 1;
    return result;
  }
  Sums sums(static_cast<std::size_t>(sequences), directions, count, any.groups_.classes());
  if (const std::size_t lobes = any.floor_lobes(); open_light != nullptr && lobes > 0) sums.over_floor = 1 + 2 * lobes;
  for (int which = 0; which < sequences; ++which) {
    const auto w = static_cast<std::size_t>(which);
    points[starts[w]]->add_sequence(rays[w], seed_of(which), sums, which);
  }
  for (std::size_t c = 0; c < sums.classes.size(); ++c) result.classes[c] = (1.0 / sequences) * sums.classes[c];
  std::vector<color::Rgb> of_paint(paint != nullptr ? static_cast<std::size_t>(sequences) : 0);
  for (std::size_t k = 0; k < count; ++k) {
    double beta[2] = {0, 0};
    if (open_light != nullptr && k != columns.mirror()) {
      double free[2] = {0, 0}, hidden[2] = {0, 0};
      for (int which = 0; which < sequences; ++which)
        free[which % 2] += sums.free_squares[sums.at(which, k)],
            hidden[which % 2] += sums.hidden_squares[sums.at(which, k)];
      for (const std::size_t parity : {0, 1}) {
        const double all = free[1 - parity] + hidden[1 - parity];
        beta[parity] = all > 0 ? free[1 - parity] / all : 1;
      }
    }
    color::Rgb direct, bounced;
    Scatter shown(points.size());
    for (int which = 0; which < sequences; ++which) {
      const std::size_t at = sums.at(which, k);
      const double b = beta[which % 2];
      color::Rgb light = (1 - b) * sums.free[at] - b * sums.hidden[at] + sums.emitted[at];
      if (open_light != nullptr && k != columns.mirror()) light += b * open_light[k];
      direct += (1.0 / sequences) * light, bounced += (1.0 / sequences) * sums.bounced[at];
      shown.add(starts[static_cast<std::size_t>(which)], light + sums.bounced[at]);
      if (paint != nullptr)
        of_paint[static_cast<std::size_t>(which)] += any.reflect(rays::float3(paint[k]), light + sums.bounced[at]);
    }
    result.direct[k] += direct, result.bounced[k] += bounced;
    result.covariance[k] = shown.covariance(), result.freedom = shown.freedom();
  }
  Scatter shown(points.size());
  for (std::size_t which = 0; which < of_paint.size(); ++which) shown.add(starts[which], of_paint[which]);
  if (paint != nullptr) result.shown = shown.covariance();
  return result;
}

}  // namespace goniochrome::render
