// The picture of a paint's index: color difference against viewing angle. [Shimizu2009] figure 4.3
#pragma once

#include <string>
#include <vector>

#include "fit/goniogeom.h"

namespace goniochrome {

struct DifferenceCurves {
  std::string paint;
  double seam_deg = 90, threshold = 2.3;
  DifferenceMetric metric = DifferenceMetric::kDe76;
  std::vector<double> lights_deg, misalignments_deg;
};

// Rows light_deg, view_deg, aspecular_deg, misalignment_deg, de for viewers all across the panel, in whole degrees.
// Glare, and viewers who do not see the second panel, are left out.
std::string csv(const DifferenceCurves& what, const FlakeCurve& curve);

// The same as a plot for each light, with the threshold.
std::string svg(const DifferenceCurves& what, const FlakeCurve& curve);

}  // namespace goniochrome
