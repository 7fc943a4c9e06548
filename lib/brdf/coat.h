// What a coat leaves of the readings of its base where light and viewer stand elsewhere. goniochrome-theory(7), COAT.
#pragma once

namespace goniochrome::brdf {

// What the two passages through the coat leave of the light of a base, see coat_passages(), relative to the geometry in
// which an instrument reads that aspecular angle: light at 45 deg, the viewer in the plane of incidence, but not
// steeper than 65 deg from the normal. A reading times this is the reading where light and viewer stand otherwise.
// Cosines are cut to 0..1. Exactly 1 without a coat.
double coat_passages_to_reading(double coat_index, double aspecular_deg, double cos_i, double cos_o);

}  // namespace goniochrome::brdf
