// A measured BRDF as a fit sees it: reflectance factors of the working space at thousands of pairs of directions, in
// and out of plane. goniochrome-theory(7), FITTING.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/file.h"
#include "base/result.h"
#include "brdf/measured.h"
#include "paint/paint.h"

namespace goniochrome::fit {

struct BrdfSample {
  double aspecular_rad = 0;            // from specular
  double light_deg = 0, view_deg = 0;  // from the normal
  color::Rgb value;                    // reflectance factor in the working space; channels may be negative
};

// Such a pair of directions about the normal z, the light's azimuth 0; all formats are isotropic.
paint::DirectionPair directions_of(const BrdfSample& sample);

// The cosine of half the angle between light and viewer.
double half_angle_cosine(const BrdfSample& sample);

struct BrdfTarget {
  paint::Paint paint;  // name, and what a five-angle instrument would have read, D65/2
  std::vector<BrdfSample> samples;
  std::shared_ptr<const brdf::MeasuredBrdf> source = {};  // where it was read from a file
};

// The samples of a measured BRDF and its readings at 15, 25, 45, 75 and 110 deg, seen under D65 by the 2 deg observer,
// to whom the working space belongs. Error: the data give a value that is not finite.
Result<BrdfTarget> brdf_target(const std::string& name, const brdf::MeasuredBrdf& brdf);

// Reads such a file; the paint is named for it, without folder and ending.
Result<BrdfTarget> read_brdf_target(InputFile& file);

}  // namespace goniochrome::fit
