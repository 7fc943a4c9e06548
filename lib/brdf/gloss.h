// The simulated gloss meter (ASTM D523) and the way back from its readings to the weights of the gloss lobes.
// goniochrome-theory(7), GLOSS.
#pragma once

#include <vector>

#include "base/result.h"
#include "brdf/lobe_model.h"
#include "paint/paint.h"

namespace goniochrome::brdf {

constexpr double kBlackGlassIndex = 1.567;  // the standard that reads 100 GU

constexpr double kGlossAngles_deg[] = {20, 60, 85};  // of the meters there are

// What the meter at 20, 60 or 85 deg reads, in gloss units (GU), for each part of the lobe model with weight 1.
struct GlossColumns {
  double angle_deg = 60;
  double diffuse = 0;                       // K_D = 1/sr
  std::vector<double> directional_diffuse;  // K_DD = 1/sr, for each exponent
  std::vector<double> gloss;                // K_G = 1/sr, for each exponent
  double mirror = 0;                        // a smooth coat of index 1.5: the smooth limit
};

// The readings of a basis at the three standard angles, by quadrature over both apertures (relative error <= 1e-4);
// some milliseconds once per basis. Immutable.
class GlossTable {
 public:
  explicit GlossTable(const std::vector<double>& exponents);
  const std::vector<double>& exponents() const { return exponents_; }
  // Error: no meter has that angle.
  Result<const GlossColumns*> at(double angle_deg) const;

 private:
  std::vector<double> exponents_;
  std::vector<GlossColumns> columns_;
};

// The reading in GU of a whole paint: diffuse, flake, gloss lobes and mirror, by luminance. Exponents of `fit` that the
// table does not hold count as 0.
double gloss_units(const GlossTable& table, const GlossColumns& meter, const paint::LobeFit& fit);

// Sets K_G and the mirror weight of `fit` (lobes: those of the table in its order, the mirror last if there is one) so
// that the whole paint reads `readings`. Gloss lobes are gray. Returns simulated minus stated GU for each reading.
//
// One reading: a lobe of total energy F (Fresnel at the meter's angle, n = 1.5) as wide as the reading asks, spread
// over its two neighbors in the basis; at and beyond the smooth limit the mirror alone, scaled up to 100 GU. Several:
// non-negative least squares over the readings. What diffuse and flake light already reads is taken off first; where
// that is more than the reading, nothing is set. Error: an angle that no meter has, or a reading below 0.
Result<std::vector<double>> set_gloss(const GlossTable& table, const std::vector<paint::GlossReading>& readings,
                                      paint::LobeFit& fit);

}  // namespace goniochrome::brdf
