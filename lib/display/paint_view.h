// The arithmetic of the built-in view "Paint" and of displays of sRGB and Display P3: the way from light to a screen,
// and the way back from a picture of a screen to light. Nothing here loads OpenColorIO. goniochrome-rendering(7),
// "RENDERING".
//
// Light is linear, and 1 is the white of the display.
#pragma once

#include <array>
#include <string>

#include "color/color.h"

namespace goniochrome::display {

// Up to this value of the largest channel, the view "Paint" shows light as it is.
constexpr double kKnee = 0.8;

// A display by its primaries. Its white is D65, and its signal curve that of sRGB.
enum class Screen { kSrgb, kDisplayP3 };

// A working-space color as linear light of the primaries of a screen.
color::Rgb screen_light(const color::Rgb& rgb, Screen screen);

// The view "Paint", from linear Rec.709 to linear Rec.709. Colors are exact as long as the largest channel is at most
// kKnee. Beyond it that channel follows a shoulder, so that a highlight grows brighter without changing its hue. A
// color outside the gamut is mixed with the gray of its luminance until no channel is negative.
color::Rgb paint_view(const color::Rgb& rec709);

// The light that paint_view() shows as this color, whose channels must lie in 0..1. Where the largest channel is 0.9998
// or more, the light is taken for 200 times the white, beyond which the shoulder no longer tells one light from
// another.
color::Rgb paint_view_undone(const color::Rgb& rec709);

// The rest of a working-space color on a display: the color itself, or where a channel of the display is negative, its
// mixture with the gray of its luminance at which that channel is 0.
color::Rgb in_display_gamut(const color::Rgb& rgb, Screen screen = Screen::kSrgb);

// The sRGB signal (IEC 61966-2-1), 0..1, of one channel or of a luminance; light below 0 counts as 0 and above 1 as 1.
double srgb_signal(double light);

// The largest chroma that a display shows at a lightness and a hue without gray mixed in.
double screen_chroma(double lightness, double hue_deg, const color::Xyz& white, Screen screen = Screen::kSrgb);

// A color under its white as the view "Paint" shows it on a display, like a matt surface of it in a picture: its codes,
// 0..255, and as CSS has it, "#rrggbb" or "color(display-p3 r g b)".
std::array<int, 3> screen_color(const color::Lab& lab, const color::Xyz& white, Screen screen = Screen::kSrgb);
std::string css_color(const color::Lab& lab, const color::Xyz& white, Screen screen = Screen::kSrgb);

// How much light five codes of an 8-bit sRGB display stand for around `light`, where the picture went through the view
// "Paint" and the largest channel is `brightest`. It is an upper bound.
double code_width(double light, double brightest);

}  // namespace goniochrome::display
