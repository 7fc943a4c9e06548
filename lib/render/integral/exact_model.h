// Points whose light the reference integrator sums, and how their BRDF is evaluated.
// goniochrome-plan(7), "REFERENCE INTEGRATOR".
#pragma once

#include <optional>
#include <vector>

#include "brdf/coat_facets.h"
#include "brdf/color_map.h"
#include "brdf/ward.h"
#include "color/color.h"
#include "render/scene.h"
#include "render/surface_layer.h"

namespace goniochrome::render {

// How the BRDF of a point is evaluated beyond the weights of its paint.
struct ExactModel {
  bool fresnel = false;  // of gloss lobes, relative to gloss_deg, and of the mirror
  double gloss_deg = 45;
  bool horizon = true;  // each direction with its own cosine, and none from below; else as prefiltered maps have it
  std::vector<brdf::Tilt> tilts;                          // none: isotropic
  std::optional<brdf::CoatFacets> coat;                   // beside the gloss of the paint
  const color::ReflectionOperator* reflection = nullptr;  // null: component-wise
  // In the place of K_D and K_DD: in image light, under lights, or in both.
  const brdf::ColorMap* map = nullptr;
  brdf::CriticalAngle treatment = brdf::CriticalAngle::kSlide;
  bool map_in_image = false, map_under_lights = false;
};

struct SurfacePoint {
  Vec3 normal, to_viewer;  // unit, on the same side
  const paint::LobeFit* paint = nullptr;
  const ExactModel* model = nullptr;  // null: that of a bare lobe model, the mirror with its Fresnel reflectance
  Vec3 position = {};                 // for lamps at a place
};

// Texels at a point whose normals are the same.
struct TexturedPoint {
  Vec3 normal, to_viewer;
  std::vector<SurfaceLayer::Piece> pieces;
  Vec3 position = {};
};

}  // namespace goniochrome::render
