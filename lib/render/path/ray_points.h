// Points of a picture as rays leave them.
#pragma once

#include <cstddef>
#include <vector>

#include "rays/ray_scene.h"
#include "render/gbuffer.h"

namespace goniochrome::render {

// A visible point.
struct RayPoint {
  rays::Spot spot;
  rays::Float3 to_viewer;
};

// The point that a pixel of a rasterized G-buffer shows, on the very triangle that was drawn there. The pixel must show
// the mesh, and the G-buffer must have triangles.
RayPoint ray_point(const rays::RayScene& scene, const mesh::Mesh& mesh, const Gbuffer& gbuffer, int x, int y);

// The place of the floor that a pixel beside the mesh sees, or nothing above the horizon.
rays::Hit floor_hit(const rays::RayScene& scene, const rays::Float3& eye, const rays::Float3& direction);

// Up to so many of the points of the floor that are seen beside the mesh, evenly spread.
std::vector<RayPoint> floor_points(const rays::RayScene& scene, const Gbuffer& gbuffer, std::size_t most);

}  // namespace goniochrome::render
