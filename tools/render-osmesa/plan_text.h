// A plan as a table, as a report and as a line of a file's header.
#pragma once

#include <string>

#include "base/json.h"
#include "render/plan.h"

namespace goniochrome::tool {

// A row for each effect: effect, needed, dE00, decision, why; then the engine.
std::string plan_table(const render::Plan& plan);

// The findings of the first pass on effects that were not measured before; "" where it found nothing.
std::string findings_text(const render::Plan& before, const render::Plan& after);

// Comments for the head of the OpenGL program of the scene: what the picture shows and the program does not, and where
// that comes from. "" where the program shows all.
std::string shader_gaps(const render::Plan& plan);

// Rows of the report and of the header of a file: effect, needed, reason, de00_p95, decision, and truth_de00_p95 where
// it was measured. Nothing in them changes from run to run.
Json plan_rows(const render::Plan& plan);

}  // namespace goniochrome::tool
