#include "render/path/bright_places.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>

#include "base/angles.h"
#include "base/parallel.h"

namespace goniochrome::render {

namespace {

using rays::Float3;
using rays::Hit;

constexpr std::size_t kGroups = 512;  // a power of 2
// How far apart pieces count that face away from each other, in units of half the mesh.
constexpr float kTurned = 0.25F;
// The part of a piece's weight that goes by its area, in the choice of groups.
constexpr double kByArea = 0.75;
// One path is followed from each piece, and so many from each group.
constexpr std::uint32_t kMostPieces = 1U << 14, kPathsOfGroup = 64;
// About so many rays of a receiver are shared out among the places, of which each gets no less and no more than this.
constexpr double kTestRays = 8192;
constexpr std::uint32_t kLeastPairs = 8, kMostPairs = 256;
// Where light is spread this evenly, places are not worth while: the mean square of what the surface sends over the
// square of its mean; and what they have to gain.
constexpr double kEven = 10, kLeastGain = 2;
// More directions toward places would leave so few others that their light grows from surface to surface.
constexpr std::array<double, 3> kChances{0, 0.25, 0.5};

// The number of a pair of points of a receiver and a place, of which there are kMostPairs.
constexpr std::uint32_t pair(std::size_t place, std::uint32_t k) {
  return static_cast<std::uint32_t>(place * kMostPairs) + k;
}

// Groups of pieces that are near each other and face alike, each of about the same weight: halves of halves, by planes
// across the direction in which the weight is spread most.
class Grouping {
 public:
  Grouping(const SurfacePieces& pieces, const std::vector<double>& weight, std::size_t groups)
      : weight_(weight), group_(pieces.count()) {
    at_.reserve(pieces.count());
    for (std::uint32_t piece = 0; piece < pieces.count(); ++piece) {
      const auto [middle, normal] = pieces.placed(piece);
      at_.push_back({middle.x, middle.y, middle.z, kTurned * normal.x, kTurned * normal.y, kTurned * normal.z});
    }
    order_.resize(pieces.count());
    std::iota(order_.begin(), order_.end(), 0U);
    split(0, order_.size(), 0, groups);
  }
  std::vector<std::uint16_t> take() { return std::move(group_); }

 private:
  static constexpr std::size_t kAxes = 6, kBins = 256;

  // The direction in which the weight is spread most, and from where to where it goes there.
  struct Spread {
    std::size_t axis = 0;
    float low = 0, high = 0;
  };
  Spread widest(std::size_t begin, std::size_t end) const {
    double all = 0, sum[kAxes] = {}, squares[kAxes] = {};
    std::array<float, kAxes> low, high;
    low.fill(std::numeric_limits<float>::infinity()), high.fill(-std::numeric_limits<float>::infinity());
    for (std::size_t i = begin; i < end; ++i) {
      const double weight = weight_[order_[i]];
      all += weight;
      for (std::size_t k = 0; k < kAxes; ++k) {
        const float x = at_[order_[i]][k];
        sum[k] += weight * x, squares[k] += weight * x * x;
        low[k] = std::min(low[k], x), high[k] = std::max(high[k], x);
      }
    }
    Spread widest;
    double most = -1;
    for (std::size_t k = 0; k < kAxes && all > 0; ++k) {
      const double variance = squares[k] / all - (sum[k] / all) * (sum[k] / all);
      if (variance > most && high[k] > low[k]) most = variance, widest = {k, low[k], high[k]};
    }
    return widest;
  }

  void split(std::size_t begin, std::size_t end, std::size_t first, std::size_t groups) {
    const Spread spread = groups > 1 ? widest(begin, end) : Spread{};
    if (!(spread.high > spread.low)) {
      for (std::size_t i = begin; i < end; ++i) group_[order_[i]] = static_cast<std::uint16_t>(first);
      return;
    }
    const auto bin = [&](std::uint32_t piece) {
      const float share = (at_[piece][spread.axis] - spread.low) / (spread.high - spread.low);
      return std::min(kBins - 1, static_cast<std::size_t>(share * kBins));
    };
    std::array<double, kBins> weights{};
    for (std::size_t i = begin; i < end; ++i) weights[bin(order_[i])] += weight_[order_[i]];
    const double all = std::accumulate(weights.begin(), weights.end(), 0.0);
    // The first bin above the plane: both sides have pieces, since both the first and the last bin have.
    std::size_t cut = 1;
    for (double below = weights[0]; cut + 1 < kBins && below + 0.5 * weights[cut] < 0.5 * all; ++cut)
      below += weights[cut];
    const auto middle = std::partition(order_.begin() + static_cast<std::ptrdiff_t>(begin),
                                       order_.begin() + static_cast<std::ptrdiff_t>(end),
                                       [&](std::uint32_t piece) { return bin(piece) < cut; });
    const auto at = static_cast<std::size_t>(middle - order_.begin());
    split(begin, at, first, groups / 2);
    split(at, end, first + groups / 2, groups / 2);
  }

  const std::vector<double>& weight_;
  std::vector<std::array<float, kAxes>> at_;
  std::vector<std::uint32_t> order_;
  std::vector<std::uint16_t> group_;
};

}  // namespace

// A point of a receiver and one of a place: of the integral over the place of what a matt point of the receiver gets,
// cos_i dw for light of 1, by area; and the density by solid angle that 1 by area is. Both are 0 where the points do
// not face each other, and where a ray is asked for, also where something stands between them.
struct BrightPlaces::Link {
  double cos = 0, toward = 0;
  // The moment is the integral of light^2 cos_i^2 over the density within the place, for light of 1 and an area of 1.
  double moment() const { return toward > 0 ? cos * cos / (toward * toward) : 0; }
};

// Links of a receiver, in the order of the places.
struct BrightPlaces::Links {
  std::vector<Link> all;
  std::vector<std::uint32_t> first;  // of each place, and where the last one ends
  std::span<const Link> of(std::size_t place) const {
    return std::span(all).subspan(first[place], first[place + 1] - first[place]);
  }
};

BrightPlaces::BrightPlaces(const rays::RayScene& scene, const Emitters& emitters) : scene_(scene), pieces_(scene) {
  piece_area_.resize(pieces_.count());
  for (std::uint32_t piece = 0; piece < pieces_.count(); ++piece)
    if (emitters.radiance(scene.part(pieces_.triangle(piece))) == color::Rgb{})
      piece_area_[piece] = pieces_.area(piece);
}

std::shared_ptr<const BrightPlaces> BrightPlaces::find(const rays::RayScene& scene, const Emitters& emitters,
                                                       const Sent& sent, std::uint64_t seed) {
  const std::shared_ptr<BrightPlaces> places(new BrightPlaces(scene, emitters));
  const std::vector<double> of_pieces = places->sent_squares(sent, seed);
  if (!places->is_uneven(of_pieces)) return nullptr;
  places->group(of_pieces);
  const std::vector<double> of_groups = places->group_squares(sent, seed);
  places->chance_.assign(kGroups, 0);
  places->density_.assign(kGroups * kGroups, 0), places->cumulative_.assign(kGroups * kGroups, 0);
  std::vector<double> logs(kGroups);
  parallel_each(kGroups, 4,
                [&](std::size_t receiver) { logs[receiver] = std::log(places->weigh(receiver, of_groups, seed)); });
  double sum = 0, light = 0, area = 0;
  for (std::size_t group = 0; group < kGroups; ++group) {
    sum += places->area_[group] * logs[group], area += places->area_[group];
    light += places->area_[group] * std::sqrt(of_groups[group]);
  }
  for (const double square : of_groups) places->brightness_.push_back(std::max(1.0, std::sqrt(square) * area / light));
  places->brightness_.push_back(1);
  places->gain_ = std::exp(sum / area);
  return places->gain_ >= kLeastGain ? places : nullptr;
}

// Either side of the piece may send: which one is left to chance. What is seen from where follows the cosine.
double BrightPlaces::sent_square(const Sent& sent, std::uint32_t piece, const Sequence& sequence,
                                 std::uint32_t index) const {
  const std::array<double, 4> place = sequence.point(index, 0), view = sequence.point(index, 1);
  const auto across = static_cast<float>(std::sqrt(view[0])), phi = 2 * rays::kFloatPi * static_cast<float>(view[1]);
  const Float3 normal = (place[3] < 0.5 ? 1.0F : -1.0F) * pieces_.placed(piece).normal;
  const rays::Frame frame = rays::frame_about(normal);
  const Float3 viewer = (across * std::cos(phi)) * frame.x + (across * std::sin(phi)) * frame.y +
                        std::sqrt(std::max(1e-6F, 1 - across * across)) * normal;
  const double light = sent(pieces_.drawn(piece, place[0], place[1]), -rays::normalized(viewer), sequence, index);
  return light * light;
}

// Squares of the light of each piece, by one path each; where there are more pieces, of some of them, each of which
// stands for as many.
std::vector<double> BrightPlaces::sent_squares(const Sent& sent, std::uint64_t seed) const {
  const std::uint32_t count = pieces_.count(), step = (count + kMostPieces - 1) / kMostPieces;
  const Sequence sequence(mixed(seed, 0xB1), kMostPieces);
  std::vector<double> squares(count);
  parallel_each((count + step - 1) / step, 64, [&](std::size_t i) {
    const auto first = static_cast<std::uint32_t>(i) * step;
    if (!(piece_area_[first] > 0)) return;
    const double square = sent_square(sent, first, sequence, static_cast<std::uint32_t>(i));
    for (std::uint32_t piece = first; piece < std::min(count, first + step); ++piece) squares[piece] = square;
  });
  return squares;
}

bool BrightPlaces::is_uneven(const std::vector<double>& squares) const {
  double area = 0, sum = 0, square = 0;
  for (std::uint32_t piece = 0; piece < pieces_.count(); ++piece) {
    area += piece_area_[piece];
    sum += piece_area_[piece] * std::sqrt(squares[piece]), square += piece_area_[piece] * squares[piece];
  }
  return square * area > kEven * sum * sum;
}

// Groups send equal parts of light, or have equal areas.
void BrightPlaces::group(const std::vector<double>& squares) {
  const std::uint32_t count = pieces_.count();
  std::vector<double> weight(count);
  double light = 0, surface = 0;
  for (std::uint32_t piece = 0; piece < count; ++piece) {
    light += piece_area_[piece] * std::sqrt(squares[piece]);
    surface += piece_area_[piece];
  }
  for (std::uint32_t piece = 0; piece < count; ++piece)
    weight[piece] = piece_area_[piece] * ((1 - kByArea) * std::sqrt(squares[piece]) / light + kByArea / surface);
  group_of_ = Grouping(pieces_, weight, kGroups).take();
  for (std::uint32_t piece = 0; piece < count; ++piece)
    if (!(piece_area_[piece] > 0)) group_of_[piece] = kGroups;
  first_.assign(kGroups + 2, 0);
  for (const std::uint16_t group : group_of_) ++first_[group + 1U];
  for (std::size_t group = 0; group <= kGroups; ++group) first_[group + 1] += first_[group];
  listed_.resize(count), listed_area_.resize(count), area_.assign(kGroups + 1, 0);
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (std::uint32_t piece = 0; piece < count; ++piece) {
    const std::uint16_t group = group_of_[piece];
    area_[group] += piece_area_[piece];
    listed_area_[next[group]] = static_cast<float>(area_[group]);
    listed_[next[group]++] = piece;
  }
  for (std::size_t group = 0; group < kGroups; ++group)
    for (std::uint32_t i = first_[group]; i < first_[group + 1]; ++i)
      listed_area_[i] /= static_cast<float>(area_[group]);
}

std::uint32_t BrightPlaces::drawn_piece(std::size_t group, double choice) const {
  const auto first = listed_area_.begin() + first_[group], last = listed_area_.begin() + first_[group + 1] - 1;
  return listed_[static_cast<std::size_t>(std::upper_bound(first, last, static_cast<float>(choice)) -
                                          listed_area_.begin())];
}

std::vector<double> BrightPlaces::group_squares(const Sent& sent, std::uint64_t seed) const {
  std::vector<double> squares(kGroups);
  parallel_each(kGroups, 4, [&](std::size_t group) {
    if (!(area_[group] > 0)) return;
    const Sequence sequence(mixed(mixed(seed, 0xB2), group), kPathsOfGroup);
    for (std::uint32_t i = 0; i < kPathsOfGroup; ++i) {
      const std::uint32_t piece = drawn_piece(group, sequence.point(i, 0)[2]);
      squares[group] += sent_square(sent, piece, sequence, i) / kPathsOfGroup;
    }
  });
  return squares;
}

// Points that are nearer to each other than the place is wide count as if they were as far apart.
BrightPlaces::Link BrightPlaces::link(std::size_t receiver, std::size_t place, const Sequence& sequence,
                                      std::uint32_t index, bool by_ray) const {
  const std::array<double, 4> here = sequence.point(index, 0), there = sequence.point(index, 1);
  const Hit from = pieces_.drawn(drawn_piece(receiver, here[2]), here[0], here[1]),
            to = pieces_.drawn(drawn_piece(place, there[2]), there[0], there[1]);
  const Float3 target = pieces_.position(to), way = target - pieces_.position(from);
  if (!(rays::length(way) > 0)) return {};
  const rays::Spot spot = scene_.spot(from, target, -rays::normalized(way));
  const Float3 apart = target - spot.start, direction = rays::normalized(apart);
  const double cos = rays::dot(spot.shading, direction);
  if (!(cos > 0) || (by_ray && scene_.closest(spot.start, direction).triangle != to.triangle)) return {};
  const double toward = scene_.by_solid_angle(to.triangle, direction, rays::length(apart));
  return {cos, std::max(toward, cos * area_[place] / kPi)};
}

// Some pairs of points tell how much light each place would send with nothing in the way; rays go where that is much.
// With as many to all places, small bright ones that are seen from a part of the receiver alone would often be missed.
BrightPlaces::Links BrightPlaces::links(std::size_t receiver, const std::vector<double>& squares,
                                        const Sequence& sequence) const {
  std::vector<double> open(kGroups);
  for (std::size_t place = 0; place < kGroups; ++place) {
    if (!(area_[place] * squares[place] > 0)) continue;
    for (std::uint32_t k = 0; k < kLeastPairs; ++k)
      open[place] += link(receiver, place, sequence, pair(place, k), false).moment();
    open[place] = area_[place] * std::sqrt(squares[place] * open[place]);
  }
  const double sum = std::accumulate(open.begin(), open.end(), 0.0);
  Links links;
  for (std::size_t place = 0; place < kGroups; ++place) {
    links.first.push_back(static_cast<std::uint32_t>(links.all.size()));
    if (!(open[place] > 0)) continue;
    const std::uint32_t pairs =
        std::clamp(static_cast<std::uint32_t>(kTestRays * open[place] / sum), kLeastPairs, kMostPairs);
    for (std::uint32_t k = 0; k < pairs; ++k)
      links.all.push_back(link(receiver, place, sequence, pair(place, k), true));
  }
  links.first.push_back(static_cast<std::uint32_t>(links.all.size()));
  return links;
}

// With shares s over places, in each of which points are drawn evenly by area, what a direction brings has the second
// moment sum of M/s, where M is the integral over the place of light^2 cos^2 over the density within it. It is least
// for s as the root of M. The chance is that for which the second moment of the mixture with the cosine's density is
// least; returns that of the cosine over it.
double BrightPlaces::weigh(std::size_t receiver, const std::vector<double>& squares, std::uint64_t seed) {
  if (!(area_[receiver] > 0)) return 1;
  const Sequence sequence(mixed(mixed(seed, 0xB3), receiver), kGroups * kMostPairs);
  const Links links = this->links(receiver, squares, sequence);
  std::vector<double> shares(kGroups);
  double sum = 0;
  for (std::size_t place = 0; place < kGroups; ++place) {
    double moment = 0;
    for (const Link& link : links.of(place)) moment += link.moment();
    if (moment > 0)
      sum += shares[place] =
          area_[place] * std::sqrt(squares[place] * moment / static_cast<double>(links.of(place).size()));
  }
  if (!(sum > 0)) return 1;
  double up_to = 0;
  std::array<double, kChances.size()> moments{};
  for (std::size_t place = 0; place < kGroups; ++place) {
    const double share = shares[place] / sum, density = area_[place] > 0 ? share / area_[place] : 0;
    up_to += share;
    cumulative_[receiver * kGroups + place] = static_cast<float>(up_to);
    density_[receiver * kGroups + place] = static_cast<float>(density);
    const double pairs = static_cast<double>(links.of(place).size());
    for (const auto& [cos, toward] : links.of(place)) {
      if (!(toward > 0)) continue;
      for (std::size_t c = 0; c < kChances.size(); ++c)
        moments[c] += squares[place] * area_[place] * cos * cos / toward /
                      (pairs * ((1 - kChances[c]) * cos / kPi + kChances[c] * density * toward));
    }
  }
  const auto least = static_cast<std::size_t>(std::ranges::min_element(moments) - moments.begin());
  chance_[receiver] = static_cast<float>(kChances[least]);
  return moments[least] > 0 ? moments[0] / moments[least] : 1;
}

double BrightPlaces::brightness(const Hit& hit) const {
  const std::uint32_t piece = pieces_.at(hit.triangle, hit.u, hit.v);
  return brightness_[piece == SurfacePieces::kNone ? kGroups : group_of_[piece]];
}

BrightPlaces::Receiver BrightPlaces::receiver(std::uint32_t triangle, float u, float v, double wide_share) const {
  Receiver receiver;
  const std::uint32_t piece = pieces_.at(triangle, u, v);
  if (piece == SurfacePieces::kNone || group_of_[piece] == kGroups) return receiver;
  receiver.group_ = group_of_[piece];
  receiver.chance_ = wide_share * chance_[receiver.group_];
  return receiver;
}

BrightPlaces::Draw BrightPlaces::drawn(const Receiver& receiver, const Float3& from, double choice, double u,
                                       double v) const {
  const auto begin = cumulative_.begin() + static_cast<std::ptrdiff_t>(receiver.group_ * kGroups);
  const auto found = std::upper_bound(begin, begin + kGroups - 1, static_cast<float>(choice));
  const auto place = static_cast<std::size_t>(found - begin);
  const double below = place > 0 ? *(found - 1) : 0, share = *found - below;
  if (!(share > 0) || !(area_[place] > 0)) return {};
  const Hit to = pieces_.drawn(drawn_piece(place, (choice - below) / share), u, v);
  const Float3 apart = pieces_.position(to) - from;
  const float distance = rays::length(apart);
  if (!(distance > 0)) return {};
  return {(1 / distance) * apart, to.triangle};
}

double BrightPlaces::pdf(const Receiver& receiver, const Hit& hit, const Float3& direction) const {
  const std::uint32_t piece = pieces_.at(hit.triangle, hit.u, hit.v);
  if (piece == SurfacePieces::kNone || group_of_[piece] == kGroups) return 0;
  return density_[receiver.group_ * kGroups + group_of_[piece]] *
         scene_.by_solid_angle(hit.triangle, direction, hit.distance);
}

}  // namespace goniochrome::render
