// The description of a paint on a page in numbers, curves and colors.
#pragma once

#include <array>
#include <string>

#include "base/json.h"
#include "base/result.h"
#include "color/print_gamut.h"
#include "display/paint_view.h"
#include "paint/paint.h"
#include "studio/internal/json_reader.h"

namespace goniochrome::studio {

// The white that readings of this condition are relative to; that of D65 where the illuminant is unknown.
color::Xyz screen_white(const color::ViewingCondition& condition);

// The screen of the page that asks: "srgb", where nothing is said, or "display-p3".
display::Screen screen_of(JsonReader& request);

// The color as CSS has it on a screen, under the light that the reading is relative to.
std::string css_color(const color::Lab& lab, const color::ViewingCondition& condition, display::Screen screen);

// Members: name, code, class, appearance{face, flop, travel, fitted}, average{L, chroma, hue}, gloss[], flakes{}
// (values[] of diameter, coverage and spread, and `assumed`, by class) where there are some, rows[] of geometry, angle,
// lab and css, curve[] of angle, lab and css, metrics{}, and screen{}: for face and flop the
// difference `de00` from what the screen shows and the `nearest` that it shows, and the `border` of that in the plane
// of a* and b* at the lightness of the face. `print`{} is the same of a print, where there is one, with its name, and
// for each end the lightnesses `low` and `high` between which it prints. Error: a paint without color, or of an unknown
// illuminant.
Result<Json> description(const paint::Paint& paint, display::Screen screen, const color::PrintGamut* print);

// The colors of the lobes of a paint at the angles of a curve: a list of angle and lab.
Json curve_json(const paint::LobeFit& fit, const color::ViewingCondition& condition);

}  // namespace goniochrome::studio
