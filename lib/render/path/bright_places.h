// Places whose light surfaces get most of what they pass on from, and directions toward them.
// goniochrome-paths(7), "Bright places".
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "render/path/emitters.h"
#include "render/path/sequence.h"
#include "render/path/surface_pieces.h"

namespace goniochrome::render {

// The surface in groups of near pieces that face alike. From each group, the receiver, the share of directions that are
// drawn toward each group, the place. Emitters are no places, since they are drawn for themselves. Immutable: for any
// number of threads at once.
class BrightPlaces {
 public:
  // An estimate, by the numbers of the sequence from its third set on, of the radiance that the surface at a hit sends
  // against `direction`, its own emission apart; mean of the channels.
  using Sent = std::function<double(const rays::Hit& hit, const rays::Float3& direction, const Sequence& sequence,
                                    std::uint32_t index)>;
  // Null where directions toward places are not worth while. The scene must outlive the places.
  static std::shared_ptr<const BrightPlaces> find(const rays::RayScene& scene, const Emitters& emitters,
                                                  const Sent& sent, std::uint64_t seed);

  // How many times smaller the second moment of what a matt surface gets from the others along a direction is with
  // these places: the geometric mean over the surface, as predicted.
  double gain() const { return gain_; }

  // The directions that a point of the surface draws by.
  class Receiver {
   public:
    Receiver() = default;
    // The part of the directions that is drawn toward places.
    double chance() const { return chance_; }

   private:
    friend class BrightPlaces;
    std::uint32_t group_ = 0;
    double chance_ = 0;
  };
  // Lobes narrower than this are not helped by places.
  static constexpr double kNarrow_sr = 0.5;
  // `wide_share`: the part of what the point sends back that is not of such lobes.
  Receiver receiver(std::uint32_t triangle, float u, float v, double wide_share) const;

  // The light that the surface at a hit sends, root mean square, over the mean over all of the surface, but no less
  // than 1; 1 on emitters and floors.
  double brightness(const rays::Hit& hit) const;

  // A direction from `from` toward a point of a triangle, drawn by numbers in [0,1). It counts where that triangle is
  // what a ray in this direction meets first, and comes to nothing elsewhere.
  struct Draw {
    rays::Float3 direction;
    std::uint32_t triangle = rays::kNothing;  // which nothing meets: the point is that very place
  };
  Draw drawn(const Receiver& receiver, const rays::Float3& from, double choice, double u, double v) const;
  // The density by which drawn() gives the direction of a ray that meets this first, 1/sr.
  double pdf(const Receiver& receiver, const rays::Hit& hit, const rays::Float3& direction) const;

 private:
  BrightPlaces(const rays::RayScene& scene, const Emitters& emitters);
  struct Link;
  struct Links;
  std::vector<double> sent_squares(const Sent& sent, std::uint64_t seed) const;
  bool is_uneven(const std::vector<double>& squares) const;
  void group(const std::vector<double>& squares);
  std::vector<double> group_squares(const Sent& sent, std::uint64_t seed) const;
  double sent_square(const Sent& sent, std::uint32_t piece, const Sequence& sequence, std::uint32_t index) const;
  std::uint32_t drawn_piece(std::size_t group, double choice) const;
  Link link(std::size_t receiver, std::size_t place, const Sequence& sequence, std::uint32_t index, bool by_ray) const;
  Links links(std::size_t receiver, const std::vector<double>& squares, const Sequence& sequence) const;
  double weigh(std::size_t receiver, const std::vector<double>& squares, std::uint64_t seed);

  const rays::RayScene& scene_;
  SurfacePieces pieces_;
  std::vector<double> piece_area_;       // of each piece, local; 0 of emitters
  std::vector<std::uint16_t> group_of_;  // of each piece; emitters are of the group after the last
  std::vector<std::uint32_t> first_;     // of the pieces of each group in listed_
  std::vector<std::uint32_t> listed_;    // pieces, group by group
  std::vector<float> listed_area_;       // cumulative within each group, relative
  std::vector<double> area_;             // of each group, local
  std::vector<double> brightness_;       // of each group, and 1 for the one after the last
  std::vector<float> chance_;            // of each receiver
  std::vector<float> density_;           // of each receiver, by area of each place
  std::vector<float> cumulative_;        // of each receiver, over places
  double gain_ = 1;
};

}  // namespace goniochrome::render
