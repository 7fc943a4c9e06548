// A clear coat with a rough surface, from satin to matt: what gloss meters read of it, which coat has given readings,
// and where it sends the light of each view. goniochrome-coats(7), "SATIN".
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "base/result.h"
#include "base/vec3.h"
#include "paint/paint.h"

namespace goniochrome::brdf {

// How the slopes of facets are distributed: as GGX has them, with long tails, or as heights of a Gaussian process do.
enum class Slopes { kGgx, kGaussian };

// A rough dielectric on two scales. The fine scale has a height that compares with the wavelength: it leaves the share
// exp(-k cos^2) of the reflected light together (Kirchhoff) and scatters the rest. The coarse scale is an orange peel
// of slopes. Both are distributed alike, so that f = F (share D_slope G + (1 - share) D_haze G) / (4 cos_i cos_o),
// where F and the share hold at the angle between light and half vector.
struct RoughCoat {
  double k = 0;         // (4 pi sigma / lambda)^2, sigma the height of the fine scale
  double slope = 0;     // of the coarse scale
  double haze = kHaze;  // slope of what the fine scale scatters
  Slopes slopes = Slopes::kGgx;
  bool operator==(const RoughCoat&) const = default;

  static constexpr double kHaze = 0.3;  // where no reading tells
};

// The slopes of which tables are made.
inline constexpr double kLeastSlope = 5e-4, kMostSlope = 0.8;

// The share of the reflected light that the fine scale leaves together, at an angle of that cosine.
double sharp_share(const RoughCoat& coat, double cosine);

// The reading of a meter at 20, 60 or 85 deg for such a coat of that index alone, in GU. Error: no meter has that
// angle.
Result<double> coat_reading(const RoughCoat& coat, double angle_deg, double index);

// The standard deviation of a reading that somebody states: meters print tenths.
inline constexpr double kStatedDeviation_gu = 0.1;

// The most probable coat of one to three readings, which are free of what the base reflects; no coat where they are
// those of a smooth surface to 1 GU, which is what meters repeat. One reading takes the coat of the usual series, in
// which both scales grow together, of GGX; further readings leave that series as far as they ask for it. All three also
// tell how the slopes are distributed. Error: no meter has that angle.
Result<std::optional<RoughCoat>> rough_coat_of(const std::vector<paint::GlossReading>& readings, double index,
                                               double deviation_gu = kStatedDeviation_gu);

// The range of coats of two scales that readings leave open: all coats from one to the other have the readings within
// two standard deviations, with numbers as usual. The haze is what readings tell least, so that they are sorted by it.
// Coats whose three readings agree to a tenth may differ in pictures by several units of CIEDE2000.
struct CoatRange {
  RoughCoat least_haze, probable, most_haze;
};
// The range about the coat of rough_coat_of(), which is the probable one. None where that has one scale, or there is
// none. Error: no meter has that angle.
Result<std::optional<CoatRange>> rough_coat_range(const std::vector<paint::GlossReading>& readings, double index,
                                                  double deviation_gu = kStatedDeviation_gu);

// The angles of the viewer at which weights stand for a rough coat, between which they are linear.
inline constexpr double kCoatViews_deg[] = {0, 20, 35, 45, 53, 60, 66, 71, 75, 78.5, 82, 85, 87, 89};
// Which of them has a meter of that angle.
std::optional<std::size_t> view_of_meter(double meter_deg);

// The angles from the mirror direction within which light is counted: 180 deg is the last.
std::span<const double> ring_angles_rad();

// The shares of the light reflected at a view that come from within each of ring_angles_rad(), relative to what a
// smooth surface reflects. Views are those of kCoatViews_deg. Absolute error 0.01, 0.012 of Gaussian slopes, as each
// ring has one share.
std::vector<double> coat_within(const RoughCoat& coat, std::size_t view);

// The reading of the nearest meter for the coat, for a gloss lobe cos^E of weight F(theta_h), and for the mirror, all
// of index 1.5, in GU.
double coat_reading_at(const RoughCoat& coat, std::size_t view);
double lobe_reading_at(double exponent, std::size_t view);
double mirror_reading_at(std::size_t view);

// The shares of light within the rings of a gloss lobe cos^E of weight F(theta_h), which the horizon cuts.
// Relative error 1e-3.
std::vector<double> lobe_within(double exponent, std::size_t view);

}  // namespace goniochrome::brdf
