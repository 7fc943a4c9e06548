// The surfaces that a camera sees, by rays: the G-buffer that every engine shades, and the surface points behind it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "rays/ray_scene.h"
#include "render/gbuffer.h"

namespace goniochrome::render {

// The points of all pixels that `rays` names, with triangles; the floor is the part after the mesh's. Bit-identical for
// any number of threads.
Gbuffer visible_surface(const rays::RayScene& scene, const Rays& rays, int width, int height);

// The visible surface of the mesh alone: the floor is no part of it.
Gbuffer mesh_gbuffer(const rays::RayScene& scene, const Rays& rays, int width, int height);

// The visible surface at samples of each pixel.
struct SampledSurface {
  std::vector<Gbuffer> samples;
  PixelFlags edges;  // pixels where rays found it
};
// The surface of the mesh at samples that are shifted by shifts[i] (pixels) from the centers that are given. Rays find
// it in pixels about which the centers show more than one flat piece of surface, in those at the border, and wherever
// the edges go on that are found there. All other pixels have the triangles of the centers, and normals that turn as
// those of their neighbors do. Bit-identical for any number of threads.
SampledSurface sampled_surface(const rays::RayScene& scene, const Gbuffer& centers,
                               const std::vector<std::array<double, 2>>& shifts);

// Which of the samples of each pixel meet the scene, or its floor: bit i stands for the sample that is shifted by
// shifts[i] (pixels) from the center. At most 16 shifts.
struct Coverage {
  std::vector<std::uint16_t> any, floor;  // pixel by pixel
};
Coverage coverage(const rays::RayScene& scene, const Rays& rays, int width, int height,
                  const std::vector<std::array<double, 2>>& shifts);

// The surface point of a pixel, which shows something: on the very triangle that a ray met. The G-buffer must have
// triangles.
rays::Spot spot_at(const rays::RayScene& scene, const Gbuffer& gbuffer, int x, int y);

// A visible point.
struct RayPoint {
  rays::Spot spot;
  rays::Float3 to_viewer;
};

// The place of the floor that a pixel beside the mesh sees, or nothing above the horizon.
rays::Hit floor_hit(const rays::RayScene& scene, const rays::Float3& eye, const rays::Float3& direction);

// Up to so many of the points of the floor that are seen beside the mesh, evenly spread.
std::vector<RayPoint> floor_points(const rays::RayScene& scene, const Gbuffer& gbuffer, std::size_t most);

}  // namespace goniochrome::render
