// The paints of a mesh as a transport shows them, part by part. goniochrome-transport(7), "TRANSPORT".
#pragma once

#include <string>
#include <vector>

#include "base/result.h"
#include "render/path/bounce_scale.h"
#include "render/path/transport_shading.h"

namespace goniochrome::render {

// The paint that a part of the mesh is to be shown in. `paint` must outlive it.
struct PartPaint {
  const paint::LobeFit* paint = nullptr;
  paint::Anisotropy anisotropy;
  double gloss_deg = 0;
  std::string name, part;  // for errors; the name of a finish that is no paint is empty
};

struct ShownPaints {
  std::vector<TransportPaint> paints;            // by part, the floor last, as TransportShader takes them
  std::vector<std::vector<color::Rgb>> weights;  // the same as bounce_scale() takes them
  bool with_views = false;                       // whether one changes with the view
  bool coat_changed = false;                     // whether a coat took the place of none, or none that of a coat
};

// A floor is shown in the paint that it wore. Error: a lobe that the columns lack; a part that is brushed otherwise
// than when its light was traced.
Result<ShownPaints> shown_paints(const LobeColumns& columns, const WornPaints& worn,
                                 const std::vector<PartPaint>& parts);

// The columns that some paint weighs.
std::vector<bool> weighed_columns(const ShownPaints& shown);

// The operator, or null where it multiplies channel by channel, as bounce_scale() and TransportShader take it.
const color::ReflectionOperator* operator_or_null(const color::ReflectionOperator& reflection);

}  // namespace goniochrome::render
