// The lobe model of a paint is a constant plus cosine lobes about the mirror direction. [ShimizuMeyer] 3.1
// goniochrome-lobes(7), "LOBE MODEL".
#pragma once

#include "base/vec3.h"
#include "color/color.h"
#include "paint/paint.h"

namespace goniochrome::brdf {

// Unpolarized Fresnel reflectance of a smooth dielectric of relative index n for cos_i in [0,1].
double fresnel_dielectric(double cos_i, double index);

constexpr double kCoatIndex = 1.5;

// The transmission of a coat of that index at an angle of that cosine: 1 less its Fresnel reflectance. Light passes it
// twice on its way to the viewer. Exactly 1 without a coat. goniochrome-coats(7), "COAT".
double coat_transmission(double cosine, double coat_index);

// Its mean over the hemisphere, weighted by the cosine: what even light is left of. Relative error 1e-6.
double mean_coat_transmission(double coat_index);

// c T(c): what a base under a coat gets from a direction of that cosine in (0,1], and the first and second derivatives.
struct CoatedCosine {
  double value, slope, bend;
};
CoatedCosine coated_cosine(double cosine, double coat_index);

// The light of a base after both passages, relative to the light without a coat.
double coat_passages(double coat_index, double cos_i, double cos_o);

// The light of a base under one coat relative to that under another: light falls in at 45 deg and is seen at the angle
// of this cosine.
double base_change(double cos_o, double from_index, double to_index);

// How bright the mirror image in one coat is, relative to that in another, at the angle of this cosine.
double mirror_change(double cos_o, double from_index, double to_index);

// The index of the surface that the mirror lobe is the image on: that of the coat, or kCoatIndex where there is none.
constexpr double mirror_index(double coat_index) {
  return coat_index > paint::kNoCoat ? coat_index : kCoatIndex;
}

// The paint under a coat of another index that looks the same: its base where it is lit at 45 deg and seen along the
// normal, its mirror image at 60 deg. Under kNoCoat that is the textbook form, whose coat adds light and takes none
// away.
paint::LobeFit under_coat(const paint::LobeFit& fit, double coat_index);

// The weights that hold for a viewer at that angle from the normal: `fit` itself without its views, or the linear
// interpolation between two of them, constant beyond the ends. Exponents ascending, as in the views.
paint::LobeFit at_view(const paint::LobeFit& fit, double view_deg);

// f(wi,wo) in 1/sr without its mirror lobe (which is a delta: see render/exact.h). 0 where either direction is below
// the horizon.
color::Rgb brdf(const paint::LobeFit& fit, const Vec3& to_light, const Vec3& to_viewer, const Vec3& normal);

// The incidence at which K_G holds where no gloss meter's angle says so.
constexpr double kGlossIncidence_deg = 45;

// The incidence at which the mirror lobe shows the same under every coat: that of a gloss meter.
constexpr double kMirrorReading_deg = 60;

// The factor of gloss under a clear coat: its Fresnel reflectance where light and viewer are each at an angle of that
// cosine from the normal between them, over that at the incidence `gloss_deg`.
double coat_fresnel(double cos_half, double gloss_deg = kGlossIncidence_deg);

// Evaluates brdf() with gloss lobes times coat_fresnel().
color::Rgb coated_brdf(const paint::LobeFit& fit, const Vec3& to_light, const Vec3& to_viewer, const Vec3& normal,
                       double gloss_deg = kGlossIncidence_deg);

// f in 1/sr of a viewer `view_deg` from the normal; `base_scale` is what the coat leaves of the base's light, as
// coat_passages() has it; `gloss_scale` is what a K_G of 1 counts: 1/cos_i, and under a coat times coat_fresnel().
color::Rgb brdf_by_angles(const paint::LobeFit& fit, double aspecular_rad, double view_deg, double base_scale,
                          double gloss_scale);

// The reflectance factor pi f without conventional gloss at an aspecular angle, by the weights for all views, where
// light and viewer are at those angles from the normal.
color::Rgb flake_reflectance_factor(const paint::LobeFit& fit, double aspecular_deg, double light_deg, double view_deg);
// The angle from the normal at which a multi-angle instrument views a surface that is lit at 45 deg, in the plane of
// incidence. Beyond 110 deg, where no instrument reads, the viewer is taken to stay at 65 deg.
double instrument_view_deg(double aspecular_deg);
// The reading of such an instrument.
color::Rgb flake_reflectance_factor(const paint::LobeFit& fit, double aspecular_deg);

}  // namespace goniochrome::brdf
