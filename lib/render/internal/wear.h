// The wear of the parts of a scene: paint, brushing and surface.
#pragma once

#include <cstddef>

#include "render/scene.h"

namespace goniochrome::render {

// Whether a part of the scene wears a color map.
bool is_mapped(const Scene& scene, std::size_t part);

// Whether the gloss of a part of the scene stands for a rough coat, whose facets can be drawn in its place: a plain
// paint that is not brushed.
bool wears_rough_coat(const Scene& scene, std::size_t part);

// Whether two parts of the scene wear the same.
bool same_wear(const Scene& scene, std::size_t a, std::size_t b);

double gloss_deg_of(const Scene& scene, std::size_t part);
paint::Anisotropy anisotropy_of(const Scene& scene, std::size_t part);
bool is_anisotropic(const paint::Anisotropy& alpha);

}  // namespace goniochrome::render
