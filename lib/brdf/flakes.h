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

// A disc lamp as flakes of one lobe show it, with its tables.
struct FlakeLamp {
  FlakeLamp(double exponent, double radius_rad, double spread_deg);

  double exponent, radius_rad, shown_rad;
  std::shared_ptr<const DiscLobeTable> lit, shown;  // of both radii

  // The part of the lobe's flakes that show the lamp, horizon apart; at most 1. `chord` is the distance between the
  // unit vectors to its middle and along the mirror direction.
  double part_that_shows(double chord) const;
};

// The flakes that show the lamp, as a box of tilts. `mirrored` is the mirror direction of the view, and `across` any
// direction that is fixed to the surface. Tilts are cos^(E+1) of the angle to the mirror direction, and the turn about
// it.
FlakeBox tilts_that_show(const FlakeLamp& lamp, const Vec3& mirrored, const Vec3& across, const Vec3& toward);

// The grain of a lamp in one lobe: the mean light for a weight K_DD of 1 and a white of 1, and the variance of it over
// patches that hold one flake of the lobe each, relative to the mean squared.
struct DiscGrain {
  double mean = 0, relative_variance = 0;
};
DiscGrain disc_grain(const FlakeLamp& lamp, const Vec3& normal, const Vec3& mirrored, const Vec3& toward,
                     double coat_index);

}  // namespace goniochrome::brdf
