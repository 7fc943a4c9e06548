// The lobe model of a paint is a constant plus cosine lobes about the mirror direction. [ShimizuMeyer] 3.1
// goniochrome-theory(7), LOBE MODEL.
#pragma once

#include "base/vec3.h"
#include "color/color.h"
#include "paint/paint.h"

namespace goniochrome::brdf {

// Unpolarized Fresnel reflectance of a smooth dielectric of relative index n for cos_i in [0,1].
double fresnel_dielectric(double cos_i, double index);

constexpr double kCoatIndex = 1.5;

// The weights that hold for a viewer at that angle from the normal: `fit` itself without its views, or the linear
// interpolation between two of them, constant beyond the ends. Exponents ascending, as in the views.
paint::LobeFit at_view(const paint::LobeFit& fit, double view_deg);

// f(wi,wo) in 1/sr without its mirror lobe (which is a delta: see render/exact.h). 0 where either direction is below
// the horizon.
color::Rgb brdf(const paint::LobeFit& fit, const Vec3& to_light, const Vec3& to_viewer, const Vec3& normal);

// The incidence at which K_G holds where no gloss meter's angle says so.
constexpr double kGlossIncidence_deg = 45;

// What gloss is multiplied by under a clear coat: its Fresnel reflectance where light and viewer are each at an angle
// of that cosine from the normal between them, over that at the incidence `gloss_deg`.
double coat_fresnel(double cos_half, double gloss_deg = kGlossIncidence_deg);

// As brdf(), with gloss lobes times coat_fresnel().
color::Rgb coated_brdf(const paint::LobeFit& fit, const Vec3& to_light, const Vec3& to_viewer, const Vec3& normal,
                       double gloss_deg = kGlossIncidence_deg);

// f in 1/sr of a viewer `view_deg` from the normal; `gloss_scale` is what a K_G of 1 counts: 1/cos_i, and under a coat
// times coat_fresnel().
color::Rgb brdf_by_angles(const paint::LobeFit& fit, double aspecular_rad, double view_deg, double gloss_scale);

// The reflectance factor pi f without conventional gloss at an aspecular angle: what a multi-angle instrument reads,
// by the weights for all views.
color::Rgb flake_reflectance_factor(const paint::LobeFit& fit, double aspecular_deg);

}  // namespace goniochrome::brdf
