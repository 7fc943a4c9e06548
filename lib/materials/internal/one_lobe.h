// The search for the nearest parameters of the models that games, browsers and viewports share: a diffuse color, one
// microfacet lobe with a color and a roughness, and a clear coat.
#pragma once

#include <functional>
#include <initializer_list>

#include "materials/internal/shown.h"

namespace goniochrome::materials {

struct OneLobe {
  color::Rgb base, specular;  // colors of the diffuse part and of the lobe along the normal, Rec.709, 0..1
  double strength = 1;        // of the lobe; 1 in models without it
  double roughness = 0.5;     // of which alpha is the square
  double clearcoat = 0, clearcoat_roughness = 0;
  double metalness = 0;                              // 0 in models that are not searched for it
  double film = 0, film_index = 1.3, film_nm = 400;  // share, index and thickness of a thin film over the lobe
};

// f of a model in 1/sr, Rec.709.
using OneLobeModel = std::function<color::Rgb(const OneLobe& parameters, const Vec3& to_light, const Vec3& to_viewer)>;

// The parameters for which the squared color differences of the model from the lobes of the paint, over fit_samples(),
// have the least sum. The clear coat is that of the paint: its factor is the share of Fresnel's reflectance that its
// mirror and satin lobes have, and it is rough where the satin ones have the larger part.
// What the search moves beside colors and roughness. A metalness that it moves stays above 0.
enum class Searched { kColorsAndRoughness, kStrengthToo, kMetalnessToo };
OneLobe nearest_one_lobe(const paint::Paint& paint, const OneLobeModel& model, Searched searched);

// Measures how a model of such parameters shows the paint.
Shown shown_by(const paint::Paint& paint, const OneLobeModel& model, const OneLobe& parameters);

// The nearest parameters, in the numbers that files have, and what they show: of the searches `ways` the one that shows
// the paint best.
struct NearestLobe {
  OneLobe parameters;
  Shown shown;
};
NearestLobe nearest_of(const paint::Paint& paint, const OneLobeModel& model, std::initializer_list<Searched> ways);

// The parameters of the film as well, from those without one.
OneLobe nearest_with_film(const paint::Paint& paint, const OneLobeModel& model, const OneLobe& without);

// A number as files have it, in six digits, and the parameters in such numbers.
double rounded(double value);
OneLobe rounded(const OneLobe& parameters);

}  // namespace goniochrome::materials
