// One answer of trompe-fit: the paint for the second panel, how well it matches, and the texts that tell so.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/json.h"
#include "paint/paint.h"
#include "tool.h"

namespace goniochrome::tool {

struct Answer {
  std::string name;
  paint::Appearance a;              // of the first panel
  std::optional<double> light_deg;  // of --mode rows
  panels::TrompeFit fit;
  std::vector<const TrompeGeometry*> judged;  // empty on a mesh
  panels::TrompeErrors before, after;         // over all that is judged
  double coat_index = paint::kNoCoat;         // of both panels
};

// The paint of an answer, with the rows that an instrument would read. Gloss, coat, class and foreign elements are
// those of `paint`.
paint::Paint painted(const paint::Paint& paint, const Answer& answer);

// Its part of the report.
Json answer_json(const Answer& answer);

// Makes the report's results of the parts of all answers: a single part is taken as it is, several become the list
// `fits`.
Json results_of(const std::vector<Json>& fits);

// "silver_b: dE rms 4.30 to 0.07, max 9.06 to 0.10; face_l +11.0, travel +4.3"
std::string answer_line(const Answer& answer);

// True if the paint found has a smaller difference than the first paint, by the measure that was asked for.
bool is_improved(const Answer& answer, const panels::TrompeOptions& options);

}  // namespace goniochrome::tool
