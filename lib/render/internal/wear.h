// The wear of the parts of a scene: paint, brushing and surface.
#pragma once

#include <cstddef>

#include "render/scene.h"

namespace goniochrome::render {

// Returns true where the part wears a color map.
bool is_mapped(const Scene& scene, std::size_t part);

// Returns true where the gloss of the part stands for a rough coat, whose facets can be drawn in its place. The part
// then wears a plain paint that is not brushed.
bool wears_rough_coat(const Scene& scene, std::size_t part);

// Returns true where both parts have equal paint, gloss and brushing. Surfaces are not compared.
bool same_wear(const Scene& scene, std::size_t a, std::size_t b);

double gloss_deg_of(const Scene& scene, std::size_t part);
paint::Anisotropy anisotropy_of(const Scene& scene, std::size_t part);
bool is_anisotropic(const paint::Anisotropy& alpha);

}  // namespace goniochrome::render
