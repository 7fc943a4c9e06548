// The light of --env: a prefiltered environment, or an image that is filtered on the way.
#pragma once

#include "base/result.h"
#include "envmap/prefiltered.h"
#include "request.h"
#include "stage.h"

namespace goniochrome::tool {

// The environment of --env. An image is filtered by the lobes of the basis, or of the paints where these have others,
// unless an earlier run kept it; the session says so. The stage is dressed. Error: what cannot be read.
Result<envmap::PrefilteredEnvironment> environment_of(const Options& options, const Request& request,
                                                      const Stage& stage, cli::Session& session);

// The image that the environment of the scene was made from: beside the environment, if it holds the same light; else
// its mirror part.
Result<Source> source_of(const Options& options, const render::Scene& scene, cli::Session& session);

}  // namespace goniochrome::tool
