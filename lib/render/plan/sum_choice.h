// Whether the diffuse part and the wide lobes are corrected by sums over the environment. goniochrome-theory(7), PLAN,
// Sums.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "render/path/open_residual.h"
#include "render/plan.h"
#include "render/plan/effect_words.h"
#include "render/plan/kept.h"

namespace goniochrome::render {

// The name of the effect.
constexpr const char* kSumsName = "sums";

struct SumChoice {
  PlanItem item;
  double open_de00 = 0;  // what the picture then misses of the open light, at 95 of 100 points
};

// Where there is nothing to sum.
SumChoice no_sums(const std::string& reason);
// Where the light is not at hand that maps would be compared with.
SumChoice unmeasured_sums(const PlanRequest& request);

// Tries the sums at the points of the truth. `planned` has one radiance for each of all points, drawn with these
// effects; `residual` sums the same environment as the truth.
Result<SumChoice> sum_choice(const OpenTruth& truth, const std::vector<color::Rgb>& planned, const Scene& scene,
                             const Effects& effects, const std::vector<std::shared_ptr<const Gbuffer>>& gbuffers,
                             const PlanRequest& request, const Words& words, OpenResidual& residual);

}  // namespace goniochrome::render
