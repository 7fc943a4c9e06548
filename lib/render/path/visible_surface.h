// What a camera sees, by rays: the G-buffer that every engine shades, and the surface points behind it.
#pragma once

#include <vector>

#include "rays/ray_scene.h"
#include "render/gbuffer.h"

namespace goniochrome::render {

struct VisibleSurface {
  Gbuffer gbuffer;              // as Rasterizer draws it; the floor is the part after the mesh's
  std::vector<rays::Hit> hits;  // pixel by pixel
};

// The points of all pixels that `rays` names. Bit-identical for any number of threads.
VisibleSurface visible_surface(const rays::RayScene& scene, const Rays& rays, int width, int height);

// The surface point of a pixel, which shows something.
rays::Spot spot_at(const rays::RayScene& scene, const VisibleSurface& surface, int x, int y);

}  // namespace goniochrome::render
