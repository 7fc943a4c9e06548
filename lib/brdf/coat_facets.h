// A rough coat as paths draw it: what its facets send from one direction to another, and directions that are drawn by
// them. Lobes stand for the same coat where maps are looked up. goniochrome-coats(7), "SATIN".
#pragma once

#include <optional>

#include "base/vec3.h"
#include "brdf/rough_coat.h"
#include "paint/paint.h"

namespace goniochrome::brdf {

// All directions are unit vectors in the frame whose z is the normal; that to the viewer lies above the horizon.
class CoatFacets {
 public:
  // Facets of a coat of that refractive index.
  CoatFacets(const RoughCoat& coat, double index) : coat_(coat), index_(index) {}

  // f cos_i, and the density that drawn() gives the direction, both in 1/sr. Both are 0 below the horizon.
  struct Sent {
    double f_cos = 0, pdf = 0;
  };
  Sent sent(const Vec3& to_light, const Vec3& to_viewer) const;

  // A direction of the light that a visible facet mirrors to the viewer, by numbers in [0,1); `choice` says of which
  // scale the facet is. It may lie below the horizon.
  Vec3 drawn(const Vec3& to_viewer, double choice, double u, double v) const;

  // The integral of f cos_i over a disc that is `radius_rad` (0..90 deg) around its middle, relative to pi sin^2 of the
  // radius. The relative error is some 3 %.
  double over_disc(const Vec3& to_viewer, const Vec3& middle, double radius_rad) const;

  // The exponent of a cosine lobe that is about as narrow as the light of the finer scale, across the plane of
  // incidence, and bends as fast.
  double sharpest_exponent(double cos_o) const;

  // About how much of a light of that extent in sr is narrower than the coat spreads it: from 0, for a wide coat, to 1.
  double narrow_share(double light_sr, double cos_o) const;

 private:
  // The chance by which a facet of the coarse scale is drawn.
  double sharp_chance(double cos_o) const;

  RoughCoat coat_;
  double index_;
};

// True if the gloss of a paint stands for a rough coat, as set_gloss_views() gives it to the paint: gray weights that
// change with the view, at all of kCoatViews_deg.
bool stands_for_coat(const paint::LobeFit& fit);
// The coat with the readings of these lobes; none where they stand for none. The weights hold at the incidence
// `gloss_deg`.
std::optional<RoughCoat> coat_of_lobes(const paint::LobeFit& fit, double gloss_deg);

}  // namespace goniochrome::brdf
