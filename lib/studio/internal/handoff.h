// How a design leaves a page, for formulation systems and for the other tools.
#pragma once

#include <string>

#include "base/result.h"
#include "formats/xml.h"
#include "paint/paint.h"

namespace goniochrome::studio {

// One paint as paint XML, with a step in its history.
Result<void> write_xml(const std::string& file, const paint::Paint& paint, const formats::Processing& step);

// Its readings as a long table, or those of its curve at the export angles where it has none.
Result<void> write_csv(const std::string& file, paint::Paint paint);

// Its readings as CxF3, or those of its curve at the export angles where it has none. `created` is a date and time as
// in 2026-11-21T10:00:00Z. Error: what CxF does not hold, such as an L* below 0.
Result<void> write_cxf(const std::string& file, paint::Paint paint, const formats::Processing& step,
                       const std::string& created);

}  // namespace goniochrome::studio
