// One visible point, by rays. goniochrome-paths(7), "PATHS".
#pragma once

#include <cstdint>
#include <vector>

#include "render/path/point_sampler.h"

namespace goniochrome::render {

class PointTransport : PointSampler {
 public:
  // `to_viewer` is unit. The transport must outlive the point.
  PointTransport(const Transport& transport, const PathOptions& options, const rays::Spot& spot,
                 const rays::Float3& to_viewer);

  // The deterministic part: directional lights, the point's own emission, and the light of the mirror lobe without
  // bounces.
  const color::Rgb& deterministic() const { return deterministic_; }
  // True if that is all: then the shares below are 0.
  bool certain() const { return certain_; }
  // The mean by shares of the samples first, first + 1, ... of the rest, drawn from a sequence of this seed; `first`
  // and `count` are multiples of kHalfFan. Its expectation is the rest, exactly.
  LightShares batch_shares(std::uint64_t seed, std::uint32_t first = 0, std::uint32_t count = kBatch) const {
    LightShares shares = shares_of(Sequence(seed, kBatch), first, count);
    shares.from_floor += floor_light();
    return shares;
  }
  // This draws from any sequence, and leaves floor_light() out.
  LightShares shares_of(const Sequence& sequence, std::uint32_t first, std::uint32_t count) const;
  // The part of LightShares::from_floor that is known without samples, from the blocks of the floor: that of the
  // diffuse part and wide lobes.
  color::Rgb floor_light() const;

 private:
  class Surface;
  void add_lights();
  void add_mirror();
  // Rays to a lamp, none of which is aimed yet.
  rays::Fan lamp_fan(const Transport::SeenLamp& lamp) const;
  // Sends a ray of a fan there if that is above the horizon.
  void aim(rays::Fan& fan, std::uint32_t ray, const rays::Float3& direction) const;
  color::Rgb lamp_shadows(const Sequence& sequence, std::uint32_t begin, std::uint32_t count) const;
  color::Rgb sharp_floor_light(const Sequence& sequence, std::uint32_t begin, std::uint32_t count) const;

  PathOptions options_;
  bool correction_;                   // whether samples tell what the mesh changes: as asked, or of a floor
  bool over_ground_;                  // over a floor whose ground is shaded
  std::uint32_t mirror_samples_ = 0;  // in a batch
  // Lamps that are discs, parts of which the mesh may hide: samples estimate the hidden part, or the free part where
  // that is less.
  struct Lamp {
    Transport::SeenLamp seen;
    bool hidden = true;
  };
  std::vector<Lamp> lamps_;
  color::Rgb deterministic_;
  bool certain_ = false;
};

}  // namespace goniochrome::render
