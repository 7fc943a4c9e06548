// The renderer's equations as the search for the paint of a picture needs them. goniochrome-theory(7), SKETCH FITTING.
#pragma once

#include "base/result.h"
#include "envmap/prefiltered.h"
#include "image/aov_file.h"
#include "sketch/sketch.h"

namespace goniochrome::sketch {

// The light of the environment and of the lamps of the buffers in every lobe, as render-osmesa drew it: with the
// effects `fresnel`, `horizon` and `operator` where the buffers' header says that they were drawn. Both arguments must
// outlive the result. Error: the buffers lack normals or rays.
Result<SketchLight> sketch_light(const image::AovFile& buffers, const envmap::PrefilteredEnvironment& env);

// The effects that the buffers' picture was drawn with and that sketch_light() does not have, by render-osmesa's names
// and in its order.
std::vector<std::string> effects_without_light(const image::AovFile& buffers);

}  // namespace goniochrome::sketch
