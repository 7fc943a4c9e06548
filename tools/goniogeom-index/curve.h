// The picture of a paint's index, as in [Shimizu2009] figure 4.3: color difference against viewing angle.
#pragma once

#include <string>
#include <vector>

#include "panels/goniogeom.h"

namespace goniochrome::tool {

struct DifferenceCurves {
  std::string paint;
  double seam_deg = 90, threshold = 2.3;
  panels::DifferenceMetric metric = panels::DifferenceMetric::kDe76;
  std::vector<double> lights_deg, misalignments_deg;
};

// Rows light_deg, view_deg, aspecular_deg, misalignment_deg, de for viewers all across the panel, in whole degrees.
// Glare, and viewers who do not see the second panel, are left out.
std::string csv(const DifferenceCurves& what, const panels::FlakeCurve& curve);

// The curves as a plot for each light, with the threshold.
std::string svg(const DifferenceCurves& what, const panels::FlakeCurve& curve);

}  // namespace goniochrome::tool
