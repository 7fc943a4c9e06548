// The way of a paint's color through the a*b* plane, and its colors in a row.
#pragma once

#include <string>

#include "color/color.h"
#include "paint/curve.h"
#include "paint/paint.h"
#include "report/plot.h"

namespace goniochrome::tool {

// A color as a style sheet spells it; what the display cannot show is clipped.
std::string css(const color::Lab& lab, const color::Xyz& white);

// The a*b* plane in a ring of hues: the curve from 15 to 110 deg from specular in its own colors, with an arrow in the
// direction of the travel, and the readings in the plane of incidence as dots with their angles. `white` is that of the
// readings.
report::Drawing plane_drawing(const paint::Paint& paint, const paint::TargetCurve& curve, const color::Xyz& white,
                              int width, int height);

// The colors of the curve from 15 to 110 deg from specular, side by side, one for each half degree, with their angles.
// L* is stated for a perfect diffuser of 100, which is the white of the display; lighter colors are clipped.
report::Drawing travel_bar(const paint::TargetCurve& curve, const color::Xyz& white, int width, int height);

}  // namespace goniochrome::tool
