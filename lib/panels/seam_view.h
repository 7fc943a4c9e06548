// Looking at a seam: the words that say which, in what light and from where; a camera before it, and where its places
// fall in the picture.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mesh/mesh.h"
#include "mesh/seam.h"
#include "panels/goniogeom_seam.h"
#include "render/camera.h"

namespace goniochrome::panels {

// What the options of a tool say of a seam: the file of a mesh, two parts A,B, auto | m | cm | mm, and lights and
// viewers in the world as AZIMUTH,ELEVATION of orbit_direction(), or a prefiltered environment.
struct SeamTexts {
  std::string mesh, seam, unit = "auto", environment;
  double max_gap_mm = 0;
  std::vector<std::string> lights_from, views_from;
  bool names_anything_but_mesh() const;
};

// What the words mean. Error (usage): the option, its value and what it takes, or lights without viewers and the like.
struct SeamWorld {
  std::string part_a, part_b;
  mesh::SeamOptions seam;
  std::vector<Vec3> lights, viewers;  // directions, unit
  bool in_world = false;              // else lights and viewers stand to every place alike
};
Result<SeamWorld> seam_world(const SeamTexts& texts);

// The mesh, its seam, who sees it in what light, and the environment where there is one. Lights and viewers stand to
// every place as `geometries` and `seam_deg` say, or in the world. Error: a file that cannot be read, parts that do not
// meet, or no viewer who sees both panels.
struct SeamStage {
  mesh::Mesh mesh;
  mesh::Seam seam;
  std::vector<SeamView> views;
  envmap::PrefilteredEnvironment env;
};
Result<SeamStage> seam_stage(const SeamTexts& texts, const SeamWorld& world, const GeometryList& geometries,
                             double seam_deg);

// A line that says in what light the seam is seen, and one that says what is left out.
std::string seam_light_text(const SeamTexts& texts, const SeamWorld& world, const GeometryList& geometries);

// A camera that sees the whole seam from outside, a little from above, its field of view as given; `aspect` is the
// picture's width over height. `margin` 1 just fits the seam in.
render::Camera seam_camera(const mesh::Seam& seam, double aspect, double fov_deg, double margin);

// The same from a direction, such as orbit_direction().
render::Camera seam_camera_from(const mesh::Seam& seam, const Vec3& direction, double aspect, double fov_deg,
                                double margin);

// The picture's (x, y) of a world point, in pixels from the upper left corner; none behind the camera.
struct PicturePoint {
  double x = 0, y = 0;
};
std::optional<PicturePoint> projected(const render::Camera& camera, const render::Rays& rays, const Vec3& point);

}  // namespace goniochrome::panels
