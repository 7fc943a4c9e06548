// The drawing of one paint.
#pragma once

#include <vector>

#include "brdf/measured.h"
#include "paint/paint.h"
#include "report/plot.h"

namespace goniochrome::tool {

struct PageInput {
  const paint::Paint& paint;
  const brdf::MeasuredBrdf* brdf = nullptr;  // what the squares compare with, where there is one
  std::vector<double> incidence_deg;
};

// A page of 1080 px. Error: the paint has neither readings nor an appearance nor lobes, or its illuminant is unknown.
Result<report::Drawing> page_of(const PageInput& input);

// The drawing in one row: L*, a* and b*, and the squares.
Result<report::Drawing> row_of_sheet(const PageInput& input);

}  // namespace goniochrome::tool
