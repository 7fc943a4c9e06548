// This is a simulated gloss meter (ASTM D523): it tells what a meter reads of a paint, and finds the weights of the
// gloss lobes that make it read given values. goniochrome-coats(7), "GLOSS".
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "base/result.h"
#include "brdf/lobe_model.h"
#include "brdf/rough_coat.h"
#include "paint/paint.h"

namespace goniochrome::brdf {

constexpr double kBlackGlassIndex = 1.567;  // the standard that reads 100 GU

constexpr double kGlossAngles_deg[] = {20, 60, 85};  // at which meters read

// Readings of the meter at 20, 60 or 85 deg, in gloss units (GU), for each part of the lobe model with weight 1.
struct GlossColumns {
  double angle_deg = 60;
  double diffuse = 0;                       // K_D = 1/sr
  std::vector<double> directional_diffuse;  // K_DD = 1/sr, for each exponent
  std::vector<double> gloss;                // K_G = 1/sr, for each exponent
  double mirror = 0;                        // a smooth coat of index 1.5: the smooth limit
};

// The readings of a basis at the three standard angles, by quadrature over both apertures (relative error <= 1e-4);
// which take some milliseconds for a basis. It does not change afterwards.
class GlossTable {
 public:
  explicit GlossTable(const std::vector<double>& exponents);
  const std::vector<double>& exponents() const { return exponents_; }
  // Error: no meter has that angle.
  Result<const GlossColumns*> at(double angle_deg) const;
  // lobe_within() of every exponent at one of kCoatViews_deg, and lobe_reading_at() as the last element; made when it
  // is first asked for, by any thread.
  const std::vector<std::vector<double>>& within(std::size_t view) const;

 private:
  struct CoatColumns;
  std::vector<double> exponents_;
  std::shared_ptr<CoatColumns> coat_;
  std::vector<GlossColumns> columns_;
};

// The reading in GU of a smooth coat of that index alone. Error: no meter has that angle.
Result<double> smooth_gloss(double angle_deg, double coat_index);

// The index of the coat of a paint that states these readings: kCoatIndex or, where a reading is above what a smooth
// coat of that index reads, the least index that reads so much, at most that of 100 GU. kNoCoat where no reading is
// above 0. Error: an angle that no meter has.
Result<double> coat_index_of(const std::vector<paint::GlossReading>& readings);

// The index of the coat of a paint: the stated one or, where its gloss asks for more, that of the gloss. A paint that
// states kNoCoat has none. `assumed` are the readings of a paint that states no gloss. Error: as above.
Result<double> coat_index_of_paint(const paint::Paint& paint, const std::vector<paint::GlossReading>& assumed = {});

// The index, from kCoatIndex to kBlackGlassIndex, of the smooth coat whose mirror image is `brighter` times that of
// kCoatIndex, at an incidence of that cosine.
double coat_index_of_mirror(double brighter, double cosine);

// The reading in GU of a whole paint: diffuse, flake, gloss lobes and mirror, by luminance. What the coat leaves of the
// base's light is taken at the meter's angle. Exponents of `fit` that the table does not hold count as 0. The gloss
// weights hold at the incidence `gloss_deg` and follow coat_fresnel() from there; without it, they hold at the meter's
// own angle.
double gloss_units(const GlossTable& table, const GlossColumns& meter, const paint::LobeFit& fit, double gloss_deg);
double gloss_units(const GlossTable& table, const GlossColumns& meter, const paint::LobeFit& fit);

// Sets K_G and the mirror weight of `fit` for all views (lobes: those of the table in its order, the mirror last if
// there is one), so that the whole paint reads the first of `readings`; K_G holds at the incidence of that reading.
// Gloss lobes are gray. Returns simulated minus stated GU for each reading.
//
// For one reading it takes a lobe of the total energy F (Fresnel at the meter's angle, n = 1.5) that is as wide as the
// reading asks, and spreads it over its two neighbors in the basis; at and beyond the smooth limit of the coat of `fit`
// it takes the mirror alone, scaled up to 100 GU. Without a mirror lobe the sharpest lobe is taken there, which reads
// less, since no more than F is reflected. For several readings it takes the rough coat of them all at the angle of the
// first, see set_gloss_views(). The reading of diffuse and flake light is subtracted first; where that alone exceeds
// the reading, no gloss is set. Error: an angle that no meter has, or a reading below 0.
Result<std::vector<double>> set_gloss(const GlossTable& table, const std::vector<paint::GlossReading>& readings,
                                      paint::LobeFit& fit);

// Gives the gloss of a rough coat that has these readings (see rough_coat_of()) to the views of `fit`, which it makes
// at kCoatViews_deg and at the views that are there: at each view the gray weights >= 0 of the lobes and the mirror
// whose light comes as near to that of the coat as it can, counted within rings around the mirror direction, and whose
// readings are those of the coat. Weights for all views, see set_gloss(), must be set. Where there is no rough coat,
// the views that are there get those. Errors as in set_gloss().
Result<void> set_gloss_views(const GlossTable& table, const std::vector<paint::GlossReading>& readings,
                             paint::LobeFit& fit);

// The range of rough coats that these readings leave open, with the base of `fit` as a part of them; see
// rough_coat_range().
Result<std::optional<CoatRange>> coat_range(const GlossTable& table, const std::vector<paint::GlossReading>& readings,
                                            const paint::LobeFit& fit);

}  // namespace goniochrome::brdf
