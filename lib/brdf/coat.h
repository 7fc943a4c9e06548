// The share of the readings of a base that its coat leaves where light and viewer stand elsewhere.
// goniochrome-coats(7), "COAT".
#pragma once

namespace goniochrome::brdf {

// The share of the light of a base after both passages through the coat, see coat_passages(), relative to the geometry
// in which an instrument reads that aspecular angle: light at 45 deg, the viewer in the plane of incidence, but not
// steeper than 65 deg from the normal. A reading times this is the reading where light and viewer stand otherwise.
// Cosines are cut to 0..1. Exactly 1 without a coat.
double coat_passages_to_reading(double coat_index, double aspecular_deg, double cos_i, double cos_o);

}  // namespace goniochrome::brdf
