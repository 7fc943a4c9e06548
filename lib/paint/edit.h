// The designer's moves on a paint: average hue, chroma and lightness, face, flop, travel, gloss, tweaks at an angle,
// variations and gradients. [Shimizu2009] 3.4, 3.6, 5.4.4. goniochrome-theory(7), DESIGN MOVES.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "paint/paint.h"

namespace goniochrome::paint {

// What a designer calls the color of a paint as a whole: means over the curve at 15, 45 and 110 deg of L*, of chroma,
// and of a* and b*, whose direction is the average hue in [0,360). Below kLeastChroma a paint has no hue to set and no
// chroma to scale to a wish.
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

// R: how much of a change at an aspecular angle (deg) is the face's: 1 at 15 deg and nearer, 0 from the travel on,
// linear between. The flop's part is 1 - R. [Shimizu2009] 3.6.4, corrected
double face_share(const Appearance& appearance, double aspecular_deg);

// Moves to make on one paint, in this order. A member that is empty, 0 or the identity changes nothing.
struct Edit {
  std::optional<double> average_hue_deg, average_chroma, average_lightness;  // to be reached by the whole paint
  Tweak tweak;                   // of the whole paint, or where at_deg is set
  std::optional<double> at_deg;  // of face and flop by face_share at this aspecular angle
  std::optional<color::Lab> face, flop;
  color::Lab face_shift, flop_shift;
  std::optional<double> travel_deg;
  double travel_shift_deg = 0;
  double gloss_angle_deg = 60;
  std::optional<double> gloss;  // gloss units
  double gloss_shift = 0;
};

// Whether an edit moves the color or the gloss at all.
bool moves_color(const Edit& edit);
bool moves_gloss(const Edit& edit);

// A paint after its moves, and what was done to it beside them.
struct Edited {
  Paint paint;
  std::optional<Appearance> before, after;  // where the color moved
  std::optional<double> fitted_de00;        // worst row, where the appearance had to be fitted first
  std::vector<std::string> dropped;         // what went stale: "lobes", "color map", "gloss at 20 deg"
  std::vector<std::string> clipped;         // "face: L* -3.2 to 0"
  std::vector<std::string> skipped;         // moves that this paint cannot take, and why
};

// Rows and appearance move together. A change of the whole paint maps every row; any other change adds to each row what
// it adds to the curve at the row's aspecular angle, so rows on the curve stay on it and a residual stays as it is.
// The appearance is fitted where the paint has only rows. Name, code and class stay; the instrument's name goes, since
// the rows are designed now. Error: the rows cannot be fitted.
Result<Edited> edited(const Paint& paint, const Edit& edit);

// One of the eight neighbors of a paint: its name ("face-lighter", "travel+10") and the edit that makes it.
struct Neighbor {
  std::string name;
  Edit edit;
};
enum class Variation { kFace, kFlop, kTravel, kGloss };

// Face and flop: lighter, darker and six hue directions 60 deg apart, all at dE76 = step. Travel (deg) and gloss
// (units): one to four steps either way. step > 0.
std::vector<Neighbor> neighbors(Variation variation, double step);

// The paint at `fraction` (0..1) of the straight way in Lab from one paint to another: face and flop, the rows of the
// geometries both have (under another condition than the default, and with none in common, those of the curve), and
// travel and gloss in proportion. Error: different illuminants or observers, or a paint with
// no color.
Result<Paint> between(const Paint& from, const Paint& to, double fraction);

}  // namespace goniochrome::paint
