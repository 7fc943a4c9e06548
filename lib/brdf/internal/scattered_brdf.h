// Measured BRDFs that list scattered pairs of directions with a spectrum for each. goniochrome-fitting(7), "Cornell".
#pragma once

#include <vector>

#include "brdf/internal/measured_formats.h"
#include "brdf/measured.h"

namespace goniochrome::brdf {

struct ScatteredRow {
  paint::DirectionPair pair;
  std::vector<double> f;  // for each wavelength of the traits
};

// Between the pairs it answers by the Delaunay triangle about the offset from the mirror direction. There is at least
// one row.
MeasuredPointer scattered_brdf(MeasuredTraits traits, std::vector<ScatteredRow> rows);

// A direction by its angle from the normal and its azimuth.
Vec3 direction(double polar_rad, double azimuth_rad);

}  // namespace goniochrome::brdf
