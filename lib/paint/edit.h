// How a designer changes a paint: its average hue, chroma and lightness, its face, flop, travel and gloss, or its color
// at one angle; and the variations and gradients that are made in this way. [Shimizu2009] 3.4, 3.6, 5.4.4;
// goniochrome-paint(7), "DESIGN MOVES".
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "paint/paint.h"

namespace goniochrome::paint {

// The color of a paint as a whole, as designers call it: the means of L*, of chroma, and of a* and b* over the curve at
// 15, 45 and 110 deg. The direction of the mean a* and b* is the average hue in [0,360). Below kLeastChroma a paint has
// no hue that could be set and no chroma that could be scaled.
struct AverageColor {
  double L = 0, chroma = 0, hue_deg = 0;
};
AverageColor average_color(const Appearance& appearance);

// One color's change: L* plus `lightness`, chroma times `chroma_factor` (>= 0), hue turned by `hue_deg`.
// [Shimizu2009] 3.6.1-3.6.3
struct Tweak {
  double lightness = 0, chroma_factor = 1, hue_deg = 0;
  friend bool operator==(const Tweak&, const Tweak&) = default;
};
color::Lab tweaked(const color::Lab& lab, const Tweak& tweak);

// R: the part of a change at an aspecular angle (deg) that the face takes in the source's blend: 1 up to 15 deg, 0 from
// the travel on, and linear between. The flop takes 1 - R. [Shimizu2009] 3.6.4, corrected
double face_share(const Appearance& appearance, double aspecular_deg);

// How a change of the color at one angle is divided between face and flop.
enum class Share {
  kExact,   // the least change of face and flop (sum of squares in Lab) that makes exactly this change at the angle
  kSource,  // the source's blend by R, after which the color at the angle has changed by less
};

// The moves that are made on one paint, in this order. A member that is empty, 0 or the identity changes nothing.
struct Edit {
  std::optional<double> average_hue_deg, average_chroma, average_lightness;  // what the whole paint shall have
  Tweak tweak;                   // of the whole paint, or, if at_deg is set,
  std::optional<double> at_deg;  // of the color at this aspecular angle
  Share share = Share::kExact;   // for at_deg
  std::optional<color::Lab> face, flop;
  color::Lab face_shift, flop_shift;
  std::optional<double> travel_deg;
  double travel_shift_deg = 0;
  bool keep_residual = false;            // where face, flop or travel is set
  std::vector<LabReading> readings;      // what these geometries shall read
  std::optional<Anisotropy> anisotropy;  // both alphas 0: none
  std::optional<Flakes> flakes;          // diameter and coverage 0: none
  double gloss_angle_deg = 60;
  std::optional<double> gloss;  // gloss units
  double gloss_shift = 0;
};

// These are true if an edit moves the color, if it moves the gloss, and if it states a face, flop or travel outright.
bool moves_color(const Edit& edit);
bool moves_gloss(const Edit& edit);
bool states_appearance(const Edit& edit);

// A paint after its moves, and what else happened to it.
struct Edited {
  Paint paint;
  std::optional<Appearance> before, after;  // if the color moved
  std::optional<double> fitted_de00;        // of the worst row, if the appearance had to be fitted
  std::optional<double> restated_de00;      // of the worst row, if the rows were stated anew, before they were
  std::vector<std::string> dropped;         // what is no longer true: "lobes", "color map", "gloss at 20 deg"
  std::vector<std::string> clipped;         // "face: L* -3.2 to 0"
  std::vector<std::string> skipped;         // moves that cannot be made on this paint, and why
};

// The paint after its moves. Rows and appearance move together. A change of the whole paint maps every row; any other
// change adds to each row what it adds to the curve at the row's aspecular angle, so that rows on the curve stay on it
// and a residual stays as it is. If a face, flop or travel is stated outright, the rows are those of the new curve
// unless edit.keep_residual is set: a residual belongs to the paint that was measured, and not to the one that is
// stated. The appearance is fitted if the paint has only rows. Readings are set last; if no face, flop or travel is
// stated with them, the appearance is then fitted to all rows. Name, code and class stay; the instrument's name goes,
// since the rows are designed now. No color is left at L* 0. Error: the rows cannot be fitted.
Result<Edited> edited(const Paint& paint, const Edit& edit);

// One of the eight neighbors of a paint: its name ("face-lighter", "travel+10") and the edit that makes it.
struct Neighbor {
  std::string name;
  Edit edit;
};
enum class Variation { kFace, kFlop, kTravel, kGloss };

// The neighbors of a paint. Face and flop have lighter and darker ones and six in hue directions 60 deg apart, all at
// dE76 = step. Travel (deg) and gloss (units) have those one to four steps away in either direction. step > 0.
std::vector<Neighbor> neighbors(Variation variation, double step);

// True if a neighbor is a paint of its own. It is not if a value was clipped to the end of the gloss scale, since
// several neighbors would meet there under different names, or if nothing changed.
bool is_distinct(const Edited& neighbor, const Paint& of);

// The paint at `fraction` (0..1) of the straight line in Lab from one paint to another. It has a face and a flop, the
// rows of the geometries that both paints have, and travel and gloss in proportion. If there is no such row and the
// condition is not the default one, it has the rows of its curve. Error: different illuminants or observers, or a paint
// without color.
Result<Paint> between(const Paint& from, const Paint& to, double fraction);

}  // namespace goniochrome::paint
