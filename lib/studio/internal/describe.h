// The description of a paint on a page in numbers, curves and colors.
#pragma once

#include <array>
#include <string>

#include "base/json.h"
#include "base/result.h"
#include "color/print_gamut.h"
#include "paint/paint.h"

namespace goniochrome::studio {

// The white that readings of this condition are relative to; that of D65 where the illuminant is unknown.
color::Xyz screen_white(const color::ViewingCondition& condition);

// "#rrggbb": the color as an sRGB display shows it, under the light that the reading is relative to.
std::string css_color(const color::Lab& lab, const color::ViewingCondition& condition);

// Members: name, code, class, appearance{face, flop, travel, fitted}, average{L, chroma, hue}, gloss[], flakes{}
// (values[] of diameter, coverage and spread, and `assumed`, by class) where there are some, rows[] of geometry, angle,
// lab and css, curve[] of angle, lab and css, metrics{}, and screen{}: for face and flop the
// difference `de00` from what the screen shows and the `nearest` that it shows, and the `border` of that in the plane
// of a* and b* at the lightness of the face. `print`{} is the same of a print, where there is one, with its name, and
// for each end the lightnesses `low` and `high` between which it prints. Error: a paint without color, or of an unknown
// illuminant.
Result<Json> description(const paint::Paint& paint, const color::PrintGamut* print = nullptr);

// The colors of the lobes of a paint at the angles of a curve: a list of angle and lab.
Json curve_json(const paint::LobeFit& fit, const color::ViewingCondition& condition);

}  // namespace goniochrome::studio
