// The renderer's equations as the search for the paint of a picture needs them.
// goniochrome-sketches(7), "SKETCH FITTING".
#pragma once

#include <memory>
#include <optional>

#include "base/result.h"
#include "envmap/prefiltered.h"
#include "image/aov_file.h"
#include "render/light_transport.h"
#include "sketch/sketch.h"

namespace goniochrome::sketch {

// True if lamps of the buffers are discs in the picture. The plan leaves extents out where no lobe of the paint that it
// draws is narrow enough to show them; another paint under the same lamps would. They are points where the plan was
// told to leave out what is seen of them.
bool lamps_are_discs(const image::AovFile& buffers);

// The light of the environment and of the lamps of the buffers in every lobe, as render-osmesa drew it: with the
// effects `fresnel`, `coat`, `horizon` and `operator` where the buffers' header says that they were drawn. Both
// arguments must outlive the result. Error: the buffers lack normals or rays.
Result<SketchLight> sketch_light(const image::AovFile& buffers, const envmap::PrefilteredEnvironment& env);

// The light of the lamps of the buffers alone, in the lobes of a basis.
Result<SketchLight> lamp_light(const image::AovFile& buffers, const formats::Basis& basis);

// The light that was traced for the buffers' view, with shadows and bounced light, and what a paint makes of it.
class SketchTransport {
 public:
  // Nothing where the buffers have no transport. Error: as render::transport_of().
  static Result<std::optional<SketchTransport>> of(const image::AovFile& buffers);

  // The samples of a pixel, whose mean the light is.
  int samples() const;

  // The index of the coat that light was traced through, the largest of all parts.
  double coat_index() const;

  // The light as of sketch_light(), for paints under a coat of that index. Bounced light is that of the paints that
  // were worn, or of the paint told last. A picture of several samples a pixel shows their mean, as the light in the
  // centers of the pixels around tells it.
  SketchLight light(int samples, double coat_index) const;

  // The parts of the mesh, by number from 1. The floor has no number among them: it keeps what it wears.
  std::vector<int> mesh_parts() const;

  // The picture of the paints that were worn (radiance, as R G B A), and A = 0 where no surface was traced.
  image::Image worn_picture() const;

  // Scales bounced light to these weights, under a coat of that index, on these parts (numbers from 1), and returns
  // what that errs by (CIEDE2000, 95th percentile): 0 where the tracing was done without bounces.
  double wear(const std::vector<color::Rgb>& weights, double coat_index, const std::vector<int>& parts);

 private:
  SketchTransport() = default;
  std::shared_ptr<const render::LobeTransport> transport_;
  std::shared_ptr<const std::vector<float>> cosines_;       // of each point, of the viewer; null: not known
  std::shared_ptr<const std::vector<color::Rgb>> factors_;  // of each point's bounced light; null: 1
  std::optional<color::ReflectionOperator> reflection_;
};

// The effects that the buffers' picture was drawn with and that sketch_light() does not have, by render-osmesa's names
// and in its order.
std::vector<std::string> effects_without_light(const image::AovFile& buffers);

}  // namespace goniochrome::sketch
