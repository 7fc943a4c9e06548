// The flakes of a paint as its lobes have them: each flake is a mirror that shows one direction, drawn from the cosine
// power of its lobe, so that the mean over many flakes is the lobe. goniochrome-flakes(7), "MODEL".
#pragma once

#include <memory>
#include <vector>

#include "base/vec3.h"
#include "brdf/disc_light.h"
#include "brdf/flake_tree.h"
#include "paint/paint.h"

namespace goniochrome::brdf {

// The part of the flakes that reflects by each lobe of the fit, in order: flakes are equally bright, so that it is the
// part of the light of all flakes. The sum is 1, or 0 where the paint has no flakes.
std::vector<double> flake_shares(const paint::LobeFit& fit);

// The radius of the disc of even radiance as which a flake shows a disc: both have the same spread about the middle.
double shown_radius(double disc_radius_rad, double flake_spread_deg);

// A disc lamp as the flakes of a paint show it.
struct FlakeLamp {
  // The part `share` of the flakes shows directions by the lobe of that exponent; the shares sum to 1.
  struct Lobe {
    double exponent = 1, share = 1;
    std::shared_ptr<const DiscLobeTable> lit, shown;  // of both radii; made by the constructor
  };
  FlakeLamp(std::vector<Lobe> lobes, double radius_rad, double spread_deg);

  std::vector<Lobe> lobes;
  double radius_rad, shown_rad;

  // The part of the flakes that show the lamp, horizon apart; at most 1. `chord` is the distance between the unit
  // vectors to its middle and along the mirror direction.
  double part_that_shows(double chord) const;
};

// The flakes that show the lamp, as a box of tilts. `mirrored` is the mirror direction of the view, and `across` any
// direction that is fixed to the surface. The first tilt of a flake at an angle to the mirror direction is the part of
// all flakes at a larger angle; the second is the turn about that direction.
FlakeBox tilts_that_show(const FlakeLamp& lamp, const Vec3& mirrored, const Vec3& across, const Vec3& toward);

// The light of a disc of white 1 for the weight K_DD = 1 of one of the lamp's lobes.
double disc_light(const FlakeLamp& lamp, std::size_t lobe, const Vec3& normal, const Vec3& mirrored, const Vec3& toward,
                  double coat_index);
// The variance of the lamp's light over patches that hold one flake each, relative to the mean squared; infinite where
// no flake shows the lamp.
double disc_variance(const FlakeLamp& lamp, const Vec3& normal, const Vec3& mirrored, const Vec3& toward);

}  // namespace goniochrome::brdf
