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
#include "render/gbuffer.h"

namespace goniochrome::render {

// The light that rays meet beside the lights of the scene. How many bounces it takes, and which random numbers, is told
// by Effort.
struct RaySetup {
  const envmap::Environment* environment = nullptr;  // none: dark
  std::string absent;                                // why plans cannot trace rays; "" where they can
  bool refused = false;                              // whether that is because nobody wants them
  std::optional<Ground> floor;                       // that shows the environment
  bool floor_forced = false;  // whether it is asked for by name, so that it is drawn whatever it is worth
  std::string no_floor;       // why there is none

  // True if there is a floor to draw.
  bool has_floor() const { return floor && environment != nullptr; }
};

struct PlanRequest {
  double tolerance_de00 = 0.5;        // what leaving effects out may change, p95 over visible pixels, all together
  EffectWords effects = {};           // that are asked for
  std::optional<std::string> engine;  // by name; none: the first that draws by prefiltered maps
  double white_luminance = 1;         // what color differences are relative to
  int samples = 1;
};

// A pixel that a plan tries effects at.
struct ProbePixel {
  const Gbuffer* gbuffer = nullptr;
  int x = 0, y = 0;
  color::Rgb shown = {};  // where that is known
};

// The decision on an effect.
enum class Decision { kNotInScene, kDrawn, kDropped, kForcedOn, kForcedOff, kFirstPass };

// The decision on an effect that is on or off, by name or not.
Decision decision_of(bool needed, bool on, bool forced);

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

// The row of an effect that is off and was not measured.
PlanItem unmeasured(const std::string& effect, const std::string& reason, bool needed = false);

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
  double ms = 0;  // to find them
  double de00_p95() const { return errors_de00.empty() ? 0 : math::percentile_95(errors_de00); }
};

}  // namespace goniochrome::render
