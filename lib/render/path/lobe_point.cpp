#include "render/path/lobe_point.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "base/angles.h"
#include "render/path/ground_kernel.h"
#include "render/path/path_loop.h"
#include "render/path/point_transport.h"

namespace goniochrome::render {

namespace {

using rays::Float3;
using rays::Hit;

constexpr float kLightChance = 0.3F;  // that a direction is drawn from the environment, where there is one
constexpr int kMirrorShare = 8;       // one mirror sample to so many directions, where the mirror sees a surface

double brightness(const color::Rgb& c) {
  return (std::abs(c.x) + std::abs(c.y) + std::abs(c.z)) / 3;
}

}  // namespace

// The light that one surface on a ray sends back, by the class of its reflection: base, or gloss and mirror. What comes
// from further surfaces is told apart.
class LobePoint::SentClasses {
 public:
  static constexpr bool kWeighsLamps = false;
  struct Reflected {
    Float3 base, gloss;
    float pdf = 0;
  };
  explicit SentClasses(const LobePoint& point) : point_(point) {}
  color::Rgb base, gloss, deeper;

  Reflected reflected(const Transport::Vertex& vertex, const Float3& to_light) const {
    const PaintedPoint::Parts parts = vertex.painted.parts(to_light);
    return {parts.diffuse + parts.lobes - parts.gloss, parts.gloss, parts.pdf};
  }
  void add_reflected(const Transport::Vertex&, const Reflected& f, double scale, const PathLight& light) {
    base += scale * point_.reflect(f.base, light.rgb), gloss += scale * point_.reflect(f.gloss, light.rgb);
  }
  void add(double scale, const PathLight& light) {
    base += scale * point_.reflect(path_.base, light.rgb), gloss += scale * point_.reflect(path_.gloss, light.rgb);
  }
  void reflect(const Transport::Vertex&, const Reflected& f, double scale) {
    path_ = {static_cast<float>(scale) * f.base, static_cast<float>(scale) * f.gloss};
  }
  void mirror(const Transport::Vertex& vertex, double scale) {
    path_ = {{}, static_cast<float>(scale) * vertex.painted.mirror()};
  }
  void add_deeper(const color::Rgb& light) { deeper += point_.reflect(path_.base + path_.gloss, light); }

 private:
  const LobePoint& point_;
  Reflected path_;
};

// The light of a column by the directions of a sequence: that of the environment from unoccluded and from occluded
// ones, light of emitters, and bounced light. The squares of single directions tell which estimate is the quieter one.
struct LobePoint::Column {
  color::Rgb free, hidden, emitted, bounced;
  double free_square = 0, hidden_square = 0;
};

// Receives the light of all columns, as means over the directions of a sequence.
class LobePoint::Columns {
 public:
  // Columns before `over_floor` have the open floor in the light that is known of them, in place of the environment
  // below the horizon.
  Columns(const LobePoint& point, int directions, std::size_t over_floor, const color::Rgb* paint)
      : columns(point.columns_.count()),
        classes(point.groups_.classes()),
        point_(point),
        share_(1.0 / directions),
        over_floor_(over_floor),
        paint_(paint) {}
  std::vector<Column> columns;
  std::vector<color::Rgb> classes;

  PaintedPoint::Shares at(const Float3& direction) const { return point_.painted_.shares(direction); }
  PaintedPoint::Shares mirror() const { return point_.mirror(); }
  bool wants(const Ray& ray) const { return ray.occluded || point_.transport_.environment_; }
  void add_sky(const PaintedPoint::Shares& f, double scale, const Ray& ray, const color::Rgb& light) {
    if (over_floor_ > 0 && !point_.transport_.is_projected(ray.hit))
      add_open(f, scale, 0, over_floor_, point_.open_light(ray.direction, light), ray.occluded);
    add_open(f, scale, over_floor_, columns.size(), light, ray.occluded);
  }
  void add_light(const PaintedPoint::Shares& f, double scale, const color::Rgb& light, std::size_t begin = 0) {
    for (std::size_t k = begin; k < columns.size(); ++k) columns[k].emitted += (scale * share_ * f.of[k]) * light;
  }
  void add_floor(const PaintedPoint::Shares& f, double scale, const Hit& hit, const Transport::FloorLight& light) {
    add_open(f, scale, 0, over_floor_, light.fixed + light.bounced, false);
    add_light(f, scale, light.fixed, over_floor_);
    add_bounced(f, scale, light.bounced, over_floor_);
    classes[point_.class_of(hit, PaintGroups::kDeeper)] += shown(f, scale, light.bounced, over_floor_);
  }
  void add_sent(const PaintedPoint::Shares& f, double scale, const Hit& hit, const Float3& direction,
                const Sequence& sequence, std::uint32_t index) {
    const Transport& t = point_.transport_;
    SentClasses sent(point_);
    t.send({t, t.rays_->spot(hit, point_.spot_.start, direction), -direction}, point_.bounces_ - 1, sequence, index, 4,
           sent);
    add_bounced(f, scale, sent.base + sent.gloss + sent.deeper, 0);
    classes[point_.class_of(hit, PaintGroups::kBase)] += shown(f, scale, sent.base, 0);
    classes[point_.class_of(hit, PaintGroups::kGloss)] += shown(f, scale, sent.gloss, 0);
    classes[point_.class_of(hit, PaintGroups::kDeeper)] += shown(f, scale, sent.deeper, 0);
  }

 private:
  void add_open(const PaintedPoint::Shares& f, double scale, std::size_t begin, std::size_t end,
                const color::Rgb& light, bool is_hidden) {
    const double size = scale * brightness(light);
    for (std::size_t k = begin; k < end; ++k) {
      (is_hidden ? columns[k].hidden : columns[k].free) += (scale * share_ * f.of[k]) * light;
      (is_hidden ? columns[k].hidden_square : columns[k].free_square) += size * size * f.of[k] * f.of[k];
    }
  }
  void add_bounced(const PaintedPoint::Shares& f, double scale, const color::Rgb& light, std::size_t begin) {
    for (std::size_t k = begin; k < columns.size(); ++k) columns[k].bounced += (scale * share_ * f.of[k]) * light;
  }
  // Columns from `begin` on as the paint shows them.
  color::Rgb shown(const PaintedPoint::Shares& f, double scale, const color::Rgb& light, std::size_t begin) const {
    color::Rgb paint;
    for (std::size_t k = begin; paint_ != nullptr && k < columns.size(); ++k)
      paint += static_cast<double>(f.of[k]) * paint_[k];
    return scale * share_ * point_.reflect(rays::float3(paint), light);
  }

  const LobePoint& point_;
  double share_;
  std::size_t over_floor_;
  const color::Rgb* paint_;
};

LobePoint::LobePoint(const Transport& transport, const LobeColumns& columns, const PaintGroups& groups, int bounces,
                     const rays::Spot& spot, const Float3& to_viewer)
    : PointSampler(transport, bounces, spot,
                   transport.painted(spot, to_viewer)
                       .of_basis(transport.is_projected(spot) ? std::span<const double>() : columns.exponents)),
      columns_(columns),
      groups_(groups) {
  if (transport.environment_) light_chance_ = kLightChance;
}

PaintedPoint::Shares LobePoint::mirror() const {
  PaintedPoint::Shares mirror;
  mirror.of[columns_.mirror()] = painted_.coat_mirror();
  return mirror;
}

std::size_t LobePoint::floor_lobes() const {
  if (transport_.open_floor_ == nullptr || painted_.is_brushed() || !transport_.open_floor_->tells(spot_.start))
    return 0;
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
  open_light[LobeColumns::diffuse()] += rays::vec3(floor.diffuse);
  for (std::size_t j = 0; j < lobes; ++j)
    open_light[LobeColumns::flake(j)] += rays::vec3(floor.flakes[j]),
        open_light[LobeColumns::gloss(j)] += rays::vec3(floor.gloss[j]);
}

// A disc that the mesh may hide in part is seen by even directions of it, of which some are free.
PaintedPoint::Shares LobePoint::lamp_columns(std::size_t which, const Transport::SeenLamp& lamp) const {
  const Light& light = lamp.light;
  const std::uint32_t directions = light.radius_rad > 0 ? 64 : 1;
  const PaintedPoint::Shares whole = light.radius_rad > 0 ? painted_.disc_shares(light, !lamp.is_placed)
                                                          : painted_.shares(rays::float3(light.direction));
  if (open_ || !(whole.diffuse() > 0)) return whole;
  PaintedPoint::Shares sum;
  bool all_free = true;
  const Sequence::Set numbers = Sequence(mixed(0x1A3B, which), directions).set(0);
  const double half = std::cos(0.5 * light.radius_rad), share = 1 / (half * half * directions);
  for (std::uint32_t i = 0; i < directions; ++i) {
    const std::array<double, 4> point = numbers.point(i);
    const Transport::LampSample sample = Transport::drawn_from(lamp, point[0], point[1]);
    const PaintedPoint::Shares here = painted_.shares(sample.direction);
    if (!(here.pdf > 0)) continue;
    if (transport_.rays_->occluded(spot_.start, sample.direction, sample.reach)) {
      all_free = false;
      continue;
    }
    for (std::size_t k = 0; k < columns_.count(); ++k) sum.of[k] += static_cast<float>(share) * here.of[k];
  }
  return all_free ? whole : sum;
}

// Lamps, whose shadow rays decide all, and what the mirror sees without a bounce.
void LobePoint::add_deterministic(const color::Rgb* open_mirror, double share, const color::Rgb* paint,
                                  LobeEstimate& estimate) const {
  for (std::size_t i = 0; i < transport_.lights_.size(); ++i) {
    const Transport::SeenLamp lamp = transport_.seen_lamp(i, spot_.start);
    const PaintedPoint::Shares f = lamp_columns(i, lamp);
    for (std::size_t k = 0; k < columns_.count(); ++k) estimate.direct[k] += (share * kPi * f.of[k]) * lamp.light.white;
  }
  const std::size_t k = columns_.mirror();
  const double weight = share * painted_.coat_mirror();
  const Mirrored seen = mirrored();
  estimate.direct[k] += weight * seen.fixed, estimate.bounced[k] += weight * seen.bounced;
  if (paint != nullptr && seen.bounced != color::Rgb{})
    estimate.classes[class_of(mirror_hit_, PaintGroups::kDeeper)] +=
        weight * reflect(rays::float3(paint[k]), seen.bounced);
  if (mirror_hit_.any()) return;
  if (open_mirror != nullptr) {
    estimate.direct[k] += share * *open_mirror;
  } else if (transport_.environment_) {
    estimate.direct[k] += weight * transport_.mirrored_environment(painted_.mirrored());
  }
}

namespace {

// Among so many points, the one that a sequence starts from: the even sequences go through all of them in one order and
// the odd ones in another, so that the start of one half says nothing of the other.
std::size_t start_of(std::size_t sequence, std::size_t points, std::uint64_t seed) {
  const std::size_t half = sequence % 2, turn = sequence / 2 / points, step = sequence / 2 % points;
  std::array<std::uint8_t, LobePoint::kMostPoints> order;
  std::iota(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(points), std::uint8_t{0});
  for (std::size_t i = 0; i <= step && i + 1 < points; ++i) {
    const std::uint64_t number = mixed(mixed(seed, 2 * turn + half), 0x57A7U + i);
    std::swap(order[i], order[i + static_cast<std::size_t>(number % (points - i))]);
  }
  return order[step];
}

}  // namespace

LobeEstimate LobePoint::no_light() const {
  const std::vector<color::Rgb> dark(columns_.count());
  return {dark, dark, std::vector<color::Rgb>(groups_.classes())};
}

PointTransport LobePoint::as_floor() const {
  PathOptions options;
  options.bounces = bounces_;
  return {transport_, options, spot_, painted_.to_viewer()};
}

// All that a floor shows is light of its one column.
LobeEstimate LobePoint::known_floor(std::span<const LobePoint> points) {
  LobeEstimate result = points.front().no_light();
  for (const LobePoint& point : points)
    result.direct[LobeColumns::diffuse()] +=
        (1.0 / static_cast<double>(points.size())) * point.as_floor().deterministic();
  return result;
}

void LobePoint::add_floor_light(const LightShares& light, LobeEstimate& estimate) {
  estimate.direct[LobeColumns::diffuse()] += light.direct;
  estimate.bounced[LobeColumns::diffuse()] += light.into_lobes + light.into_diffuse;
}

std::array<LobeEstimate, 2> LobePoint::sampled_floor(std::span<const LobePoint> points, int sequences, int directions,
                                                     std::uint64_t seed) {
  const LobePoint& any = points.front();
  std::array<LobeEstimate, 2> halves = {any.no_light(), any.no_light()};
  const int batches = std::max(1, directions / kBatch);
  for (std::size_t which = 0; which < static_cast<std::size_t>(sequences); ++which) {
    const PointTransport floor = points[start_of(which, points.size(), seed)].as_floor();
    for (int i = 0; i < batches; ++i)
      add_floor_light(
          (2.0 / (sequences * batches)) * floor.batch_shares(mixed(mixed(seed, which), static_cast<std::uint64_t>(i))),
          halves[which % 2]);
  }
  return halves;
}

LobeEstimate LobePoint::known(std::span<const LobePoint> points, const color::Rgb* open_mirrors,
                              const color::Rgb* paint) {
  if (points.front().on_projected_) return known_floor(points);
  LobeEstimate result = points.front().no_light();
  for (std::size_t i = 0; i < points.size(); ++i)
    points[i].add_deterministic(open_mirrors != nullptr ? &open_mirrors[i] : nullptr,
                                1.0 / static_cast<double>(points.size()), paint, result);
  return result;
}

bool LobePoint::is_known(std::span<const LobePoint> points, bool with_open_light) {
  const Transport& transport = points.front().transport_;
  if (points.front().on_projected_)
    return std::ranges::all_of(points, [](const LobePoint& point) { return point.as_floor().certain(); });
  return (with_open_light || transport.environment_ == nullptr) && std::ranges::all_of(points, &LobePoint::open);
}

// Light L from free directions is what is wanted; M is known of all directions. For any beta that does not depend on
// the samples,
//   (1 - beta) free + beta (M - hidden)
// has the right expectation: beta = 1 takes away what is hidden, beta = 0 sums what is free. The quieter of both is the
// one with the smaller second moment; beta = free2/(free2 + hidden2) is taken for the even sequences from the odd
// ones and for the odd ones from the even ones, so that it depends on no sample that it weighs.
std::array<LobeEstimate, 2> LobePoint::sampled(std::span<const LobePoint> points, const color::Rgb* open_light,
                                               int sequences, int directions, std::uint64_t seed,
                                               const color::Rgb* paint) {
  const LobePoint& any = points.front();
  if (any.on_projected_) return sampled_floor(points, sequences, directions, seed);
  const Transport& transport = any.transport_;
  const LobeColumns& columns = any.columns_;
  const std::size_t count = columns.count();
  std::array<LobeEstimate, 2> halves = {any.no_light(), any.no_light()};
  bool any_occluded = (open_light == nullptr && transport.environment_ != nullptr) || !transport.emitters_.empty();
  const auto sequence_of = [&](std::size_t which) {
    return Sequence(mixed(seed, which), static_cast<std::uint32_t>(directions));
  };
  std::vector<std::vector<Ray>> rays(static_cast<std::size_t>(sequences));
  std::vector<std::size_t> starts;
  for (std::size_t which = 0; which < rays.size(); ++which) {
    const LobePoint& start = points[starts.emplace_back(start_of(which, points.size(), seed))];
    rays[which].resize(static_cast<std::size_t>(directions));
    start.trace(sequence_of(which).set(0), 0, rays[which]);
    any_occluded = any_occluded || start.mirror_hit_.any() || std::ranges::any_of(rays[which], &Ray::occluded);
  }
  if (!any_occluded) return halves;
  std::size_t over_floor = 0;
  if (const std::size_t lobes = any.floor_lobes(); open_light != nullptr && lobes > 0) over_floor = 1 + 2 * lobes;
  std::vector<Columns> sums;
  const double share = 2.0 / sequences;
  for (std::size_t which = 0; which < rays.size(); ++which) {
    const LobePoint& start = points[starts[which]];
    Columns& sum = sums.emplace_back(start, directions, over_floor, paint);
    start.add(rays[which], sequence_of(which), 0, sum);
    const int mirrors = std::max(1, directions / kMirrorShare);
    start.sample_mirror(sequence_of(which).other(0x4D), 0, static_cast<std::uint32_t>(mirrors),
                        static_cast<double>(directions) / mirrors, sum);
    for (std::size_t c = 0; c < sum.classes.size(); ++c) halves[which % 2].classes[c] += share * sum.classes[c];
  }
  for (std::size_t k = 0; k < count; ++k) {
    const bool is_open = open_light != nullptr && k != columns.mirror();
    double free[2] = {0, 0}, hidden[2] = {0, 0};
    for (std::size_t which = 0; which < sums.size(); ++which) {
      free[which % 2] += sums[which].columns[k].free_square;
      hidden[which % 2] += sums[which].columns[k].hidden_square;
    }
    for (std::size_t which = 0; which < sums.size(); ++which) {
      const Column& of = sums[which].columns[k];
      const std::size_t other = 1 - which % 2;
      const double all = free[other] + hidden[other], beta = !is_open ? 0 : all > 0 ? free[other] / all : 1;
      color::Rgb light = (1 - beta) * of.free - beta * of.hidden + of.emitted;
      if (is_open) light += (beta - 1) * open_light[k];
      halves[which % 2].direct[k] += share * light, halves[which % 2].bounced[k] += share * of.bounced;
    }
  }
  return halves;
}

void LobeEstimate::add(const LobeEstimate& other, double scale) {
  for (std::size_t k = 0; k < direct.size(); ++k)
    direct[k] += scale * other.direct[k], bounced[k] += scale * other.bounced[k];
  for (std::size_t k = 0; k < classes.size(); ++k) classes[k] += scale * other.classes[k];
}

LobeEstimate LobePoint::estimate(const color::Rgb* open_light, int sequences, int directions,
                                 std::uint64_t seed) const {
  const std::size_t mirror = columns_.mirror();
  const std::span one(this, 1);
  LobeEstimate result = known(one, open_light != nullptr ? open_light + mirror : nullptr, nullptr);
  for (std::size_t k = 0; open_light != nullptr && k < mirror; ++k) result.direct[k] += open_light[k];
  if (is_known(one, open_light != nullptr)) return result;
  for (const LobeEstimate& half : sampled(one, open_light, sequences, directions, seed)) result.add(half, 0.5);
  return result;
}

}  // namespace goniochrome::render
