// Colors: CIELAB, XYZ and the working space, which is linear Rec.2020 (D65); the conversions between them by Bradford's
// adaptation; and color differences. goniochrome-color(7), "COLOR".
#pragma once

#include <string>
#include <string_view>

#include "base/result.h"
#include "base/vec3.h"

namespace goniochrome::color {

// CIELAB relative to the perfect diffuser. L above 100 is legal close to specular.
struct Lab {
  double L = 0, a = 0, b = 0;
  friend bool operator==(const Lab&, const Lab&) = default;
};

// CIE XYZ, Y = 1 for the perfect diffuser.
struct Xyz {
  double X = 0, Y = 0, Z = 0;
};

// The working space: linear Rec.2020, D65; 1 = perfect diffuser (reflectance factor) or scene radiance.
using Rgb = Vec3;

// The condition that a Lab value is relative to. The default is the condition that the paint industry uses.
struct ViewingCondition {
  std::string illuminant = "D65";  // D65 | D50 | A ...
  int observer_deg = 10;           // 2 | 10
  friend bool operator==(const ViewingCondition&, const ViewingCondition&) = default;
};

// The white point (Y = 1) of an illuminant seen by an observer, as CIE 15 prints it or as its table gives it. Error:
// names what is known.
Result<Xyz> white_point(const ViewingCondition& stated);

// CIE 1976 L*a*b*; the linear branch below (6/29)^3 goes on below zero, so slightly negative XYZ survive a round trip.
Lab lab_from_xyz(const Xyz& xyz, const Xyz& white);
Xyz xyz_from_lab(const Lab& lab, const Xyz& white);

// Bradford chromatic adaptation of `xyz` from one white to another.
Xyz adapted(const Xyz& xyz, const Xyz& from_white, const Xyz& to_white);

// Working-space RGB <-> XYZ relative to D65/2.
Rgb rgb_from_xyz_d65(const Xyz& xyz);
Xyz xyz_d65_from_rgb(const Rgb& rgb);
inline double luminance(const Rgb& rgb) {
  return xyz_d65_from_rgb(rgb).Y;
}

// The mean of the channels.
constexpr double mean(const Rgb& rgb) {
  return (rgb.x + rgb.y + rgb.z) / 3;
}

// A paint's Lab, relative to `white`, as working-space reflectance factors, and back. Channels may be negative.
Rgb rgb_from_lab(const Lab& lab, const Xyz& white);
Lab lab_from_rgb(const Rgb& rgb, const Xyz& white);

// Linear Rec.709 <-> linear Rec.2020, both D65.
Rgb rec2020_from_rec709(const Rgb& rec709);
Rgb rec709_from_rec2020(const Rgb& rec2020);

// Color differences. CIEDE2000 is symmetric to the last bit (Sharma, Wu, Dalal 2005).
double delta_e_76(const Lab& x, const Lab& y);
double delta_e_2000(const Lab& x, const Lab& y);

// A signed vector whose length is the CIEDE2000 difference. Least-squares searches need it, because it is smooth where
// the colors are equal, and the length is not.
Vec3 delta_e_2000_vector(const Lab& x, const Lab& y);

// dL*/dY at lightness L*, Y = 1 for the perfect diffuser: the weight that makes a reflectance error perceptual. On the
// linear branch (L* <= 8) it is constant, which keeps the weight of a black finite.
double lightness_slope(double lightness);

// CIE hue angle in degrees, [0,360), and chroma; the hue of an achromatic color is 0.
double hue_deg(const Lab& lab);
double chroma(const Lab& lab);

}  // namespace goniochrome::color
