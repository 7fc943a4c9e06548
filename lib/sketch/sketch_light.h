// The renderer's equations for the search of lib/fit that finds the paint of a picture. goniochrome-theory(7), SKETCH
// FITTING.
#pragma once

#include "base/result.h"
#include "envmap/prefiltered.h"
#include "image/aov_file.h"
#include "sketch/sketch.h"

namespace goniochrome::sketch {

// The light of every lobe of the environment, and of the lamps of the buffers, as render-osmesa drew it: with the
// effects `fresnel`, `horizon` and `operator` where the buffers' header says they were drawn. Both must outlive the
// result. Error: buffers without normals or rays.
Result<SketchLight> sketch_light(const image::AovFile& buffers, const envmap::PrefilteredEnvironment& env);

// Those effects of the buffers' picture that the light does not have; names of render-osmesa, in its order.
std::vector<std::string> effects_without_light(const image::AovFile& buffers);

}  // namespace goniochrome::sketch
