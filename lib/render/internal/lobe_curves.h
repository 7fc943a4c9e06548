// Under uniform light of 1, a lobe about the mirror direction sends to the viewer an amount of light that depends on
// the view alone. These are its integrals. goniochrome-rendering(7), "Horizon".
#pragma once

#include <memory>
#include <vector>

#include "paint/paint.h"

namespace goniochrome::render {

// One of the directions w of a lobe above the horizon: its components along the mirror direction r and across it toward
// the normal, and what it adds to the integrals of LobeIntegrals.
struct LobeSample {
  double along, across;
  double cosine, plain, fresnel;
};
std::vector<LobeSample> lobe_samples(double exponent, double cos_o, double coat_index);

// Integrals over the directions w of a lobe cos^E of the angle to the mirror direction of the view, for the viewer at
// cos_o = n.wo. `cosine` is under a coat of that index: each direction counts with what the coat lets in from there;
// what it lets out to the viewer is not counted. With `horizon`, over the hemisphere above the surface, each direction
// with its own cosine and Fresnel reflectance; without, over the whole lobe, with those of its middle. Relative error
// 3e-3, of `fresnel` 1e-2.
struct LobeIntegrals {
  double cosine = 0;   // of cos^E n.w T(n.w)
  double plain = 0;    // of cos^E
  double fresnel = 0;  // of cos^E F, the reflectance of the coat at half the angle between light and viewer
  // The mean direction of the light that the first two gather is that of r + shift n, r the mirror direction.
  double cosine_shift = 0, plain_shift = 0;
};
LobeIntegrals lobe_integrals(double exponent, double cos_o, bool horizon, double coat_index = paint::kNoCoat);

// The integrals at cos_o = (i/segments)^2, i = 0..segments. Kept for the next time.
using LobeCurve = std::vector<LobeIntegrals>;
std::shared_ptr<const LobeCurve> lobe_curve(double exponent, int segments, bool horizon,
                                            double coat_index = paint::kNoCoat);

}  // namespace goniochrome::render
