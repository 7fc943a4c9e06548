// The windows of the three gloss meters [ASTM D523], which are seen from the sample.
#pragma once

#include "brdf/lobe_model.h"

namespace goniochrome::brdf {

struct Meter {
  double angle_deg, receptor_par_deg, receptor_perp_deg;  // in the plane of incidence, and across it
};
constexpr Meter kMeters[] = {{20, 1.8, 3.6}, {60, 4.4, 11.7}, {85, 4.0, 6.0}};
constexpr double kSourcePar_deg = 0.75, kSourcePerp_deg = 2.5;

}  // namespace goniochrome::brdf
