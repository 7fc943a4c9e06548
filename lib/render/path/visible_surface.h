// The surfaces that a camera sees, by rays: the G-buffer that every engine shades, and the surface points behind it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "rays/ray_scene.h"
#include "render/gbuffer.h"

namespace goniochrome::render {

struct VisibleSurface {
  Gbuffer gbuffer;              // the floor is the part after the mesh's
  std::vector<rays::Hit> hits;  // pixel by pixel
};

// The points of all pixels that `rays` names. Bit-identical for any number of threads.
VisibleSurface visible_surface(const rays::RayScene& scene, const Rays& rays, int width, int height);

// The G-buffer of the mesh alone, with triangles: the floor is no part of the mesh.
Gbuffer mesh_gbuffer(const rays::RayScene& scene, const Rays& rays, int width, int height);

// Which of the samples of each pixel meet the scene, or its floor: bit i stands for the sample that is shifted by
// shifts[i] (pixels) from the center. At most 16 shifts.
struct Coverage {
  std::vector<std::uint16_t> any, floor;  // pixel by pixel
};
Coverage coverage(const rays::RayScene& scene, const Rays& rays, int width, int height,
                  const std::vector<std::array<double, 2>>& shifts);

// The surface point of a pixel, which shows something.
rays::Spot spot_at(const rays::RayScene& scene, const VisibleSurface& surface, int x, int y);

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
