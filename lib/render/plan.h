// A plan decides, before a picture is drawn, with which effects and by which engine it is shaded. An effect is drawn
// where the scene calls for it. Lobes and look-ups of prefiltered maps are tried out on some of the visible points, and
// those that nobody sees there are left out. What rays and sums change is told by the first pass of the picture.
// goniochrome-plan(7), "PLAN".
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "math/statistics.h"
#include "render/effect_words.h"
#include "render/effects.h"

namespace goniochrome::render {

// The changes that rays can add to a picture.
struct RayContext {
  std::string absent = "no rays are traced";  // why none are traced; "" where they are
  bool refused = false;                       // whether that is because --effects says so
  bool floor = false;                         // whether there is a floor to draw
  bool floor_forced = false;                  // whether it is asked for by name
  std::string no_floor;                       // why there is none; "" where there is, or where nothing is said of it
  bool has_environment = false;               // whether the light is at hand of which sums are made
};

struct PlanRequest {
  double tolerance_de00 = 0.5;        // what leaving effects out may change, p95 over visible pixels, all together
  EffectWords effects = {};           // that are asked for
  std::optional<std::string> engine;  // by name; none: the first that draws by prefiltered maps
  double white_luminance = 1;         // what color differences are relative to
  int samples = 1;
};

// The decision on an effect.
enum class Decision { kNotInScene, kDrawn, kDropped, kForcedOn, kForcedOff, kFirstPass };

// The word for a decision in plans, reports and the headers of pictures. image::read_aov_file() reads it back.
const char* spelled(Decision decision);

struct PlanItem {
  std::string effect;
  bool needed = false;  // the scene calls for it
  std::string reason;
  // The change by leaving it out alone, at 95 of 100 points; NaN where it was not measured. Of rays and sums it is what
  // the first pass found.
  double de00_p95 = 0;
  bool on = false;
  Decision decision = Decision::kNotInScene;
  std::optional<double> truth_de00_p95;  // the same as de00_p95, by the reference integrator
};

struct Plan {
  std::vector<PlanItem> items;
  Effects effects;
  std::string engine;  // that was chosen
  std::string engine_reason;
  double de00_p95 = 0;  // of all that is left out of the maps together
  double time_ms = 0;   // that planning took, the maps loaded that the picture needs as well
};

// Findings of the first pass at some points, where no surface is in the way of light.
struct FoundMaps {
  std::optional<double> sums_de00_p95;  // the change by sums at 95 of 100 points; nothing without sums
  bool sums_stopped = false;            // whether nobody sees it, so that they are left out
  // The errors of the maps that are drawn, with their sums, at each point: CIEDE2000. Empty where none was measured.
  std::vector<double> errors_de00;
  double de00_p95() const { return errors_de00.empty() ? 0 : math::percentile_95(errors_de00); }
};

}  // namespace goniochrome::render
