// One visible point and the light that each lobe of a basis gathers there, by rays.
// goniochrome-transport(7), "TRANSPORT".
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "render/path/lobe_columns.h"
#include "render/path/point_sampler.h"

namespace goniochrome::render {

// Parts whose paints are told apart. A floor that shows the environment is a group with the one weight 1 of the diffuse
// column, and its light is kept as it shows it. Bounced light is told by the group that sent it and by how the light
// left it last.
struct PaintGroups {
  std::vector<int> of_part;  // of the mesh, then of the floor
  int count = 0;
  // The classes of bounced light: off the flakes of a group, off its gloss and mirror, and through further surfaces.
  static constexpr int kKinds = 3;
  enum Kind { kBase = 0, kGloss = 1, kDeeper = 2 };
  std::size_t classes() const { return static_cast<std::size_t>(count) * kKinds; }
  std::size_t at(int group, Kind kind) const { return static_cast<std::size_t>(group * kKinds + kind); }
};

// The light of a point in each column of weight 1, in the order of the columns. Direct light is that of lights,
// environment and emitters; bounced light has met a surface before.
struct LobeEstimate {
  std::vector<color::Rgb> direct, bounced;
  std::vector<color::Rgb> classes;  // of bounced light, as the paint that the point wears shows them

  void add(const LobeEstimate& other, double scale);
};

class PointTransport;

class LobePoint : PointSampler {
 public:
  // `bounces` as in PathOptions. The arguments must outlive the point.
  LobePoint(const Transport& transport, const LobeColumns& columns, const PaintGroups& groups, int bounces,
            const rays::Spot& spot, const rays::Float3& to_viewer);

  // True if nothing rises above its horizon.
  bool open() const { return open_; }

  // Bounced light by every pair of columns: what column k of weight 1 gathers of the light that column l of weight 1
  // sends there from a surface of a group. The direct light of that surface, from lights, environment and emitters, is
  // kept apart from the light that came to it through further surfaces in the paints that they wear. Sums in any
  // product of colors are products with l's weight first and k's after it.
  struct Pairs {
    std::size_t columns = 0;
    std::vector<color::Rgb> once, deeper;  // (group, k, l)
    std::size_t at(int group, std::size_t k, std::size_t l) const {
      return (static_cast<std::size_t>(group) * columns + k) * columns + l;
    }
  };
  Pairs pairs(int sequences, int directions, std::uint64_t seed) const;

  // Adds the light of the open floor, less that of the environment below the horizon, to the open light of the columns
  // whose light of it is known. Nothing where no floor is shaded.
  void add_open_floor(color::Rgb* open_light) const;

  // The mean light of at most kMostPoints points of one part, and at least one, is that which needs no samples and that
  // which samples tell.
  //
  // Without samples: lamps, what the mirror sees, and lamps on a floor that no grid shades. `open_mirrors` has what the
  // mirror of each point sees of the environment without any surface in the way; null: rays tell it. `paint` has a
  // weight for each column, or is null.
  static LobeEstimate known(std::span<const LobePoint> points, const color::Rgb* open_mirrors, const color::Rgb* paint);
  // True if samples tell nothing more than this and the open light.
  static bool is_known(std::span<const LobePoint> points, bool with_open_light);
  // By an even number of sequences, each of so many directions, a power of two, from one of the points. The results of
  // the even and of the odd sequences are independent. `open_light` has the mean light of each column, of the
  // environment without any surface in the way, with add_open_floor(): what is sampled is what to add to it. Null: rays
  // alone.
  static std::array<LobeEstimate, 2> sampled(std::span<const LobePoint> points, const color::Rgb* open_light,
                                             int sequences, int directions, std::uint64_t seed,
                                             const color::Rgb* paint = nullptr);
  // All light of this point.
  LobeEstimate estimate(const color::Rgb* open_light, int sequences, int directions, std::uint64_t seed) const;
  static constexpr std::size_t kMostPoints = 16;

 private:
  struct Column;
  class SentClasses;
  class Columns;
  class SentColumns;
  class PairColumns;
  PaintedPoint::Shares mirror() const;
  PaintedPoint::Shares lamp_columns(std::size_t which, const Transport::SeenLamp& lamp) const;
  void add_deterministic(const color::Rgb* open_mirror, double share, const color::Rgb* paint,
                         LobeEstimate& estimate) const;
  // The diffuse part and so many lobes are told by the blocks of an open floor; 0: not even that part.
  std::size_t floor_lobes() const;
  static LobeEstimate known_floor(std::span<const LobePoint> points);
  static std::array<LobeEstimate, 2> sampled_floor(std::span<const LobePoint> points, int sequences, int directions,
                                                   std::uint64_t seed);
  PointTransport as_floor() const;
  static void add_floor_light(const LightShares& light, LobeEstimate& estimate);
  LobeEstimate no_light() const;
  int group_of(const rays::Hit& hit) const {
    return groups_.of_part[static_cast<std::size_t>(transport_.rays().part(hit.triangle))];
  }
  std::size_t class_of(const rays::Hit& hit, PaintGroups::Kind kind) const { return groups_.at(group_of(hit), kind); }

  const LobeColumns& columns_;
  const PaintGroups& groups_;
};

}  // namespace goniochrome::render
