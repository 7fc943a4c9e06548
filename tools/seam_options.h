// The options that the tools for misaligned panels share: lights and viewers, and a seam of a mesh.
#pragma once

#include <vector>

#include "cli/options.h"
#include "panels/geometry_sets.h"
#include "panels/seam.h"

namespace goniochrome::tool {

inline std::vector<cli::Option> geometry_options(panels::GeometryTexts& geometries, double& seam_deg) {
  return {
      {.name = "lights",
       .value = "LIST",
       .help = "lights, degrees from the normal",
       .target = &geometries.lights,
       .alias = "light"},
      {.name = "views",
       .value = "LIST",
       .help = "viewers, degrees from the normal or as and the aspecular angle",
       .target = &geometries.views,
       .alias = "view"},
      {.name = "out-of-plane",
       .value = "LIST",
       .help = "azimuths of the viewers about the normal, 0 in the plane of incidence",
       .target = &geometries.azimuths},
      {.name = "seam-axis",
       .value = "DEG",
       .help = "direction of the seam from the plane of incidence; 90 lies across it, where a turn counts most",
       .target = &seam_deg,
       .low = -360,
       .high = 360},
  };
}

inline std::vector<cli::Option> seam_options(panels::SeamTexts& seam) {
  return {
      {.name = "mesh", .value = "FILE", .help = "take the panels from a seam of this mesh (OBJ)", .target = &seam.mesh},
      {.name = "seam", .value = "A,B", .help = "the two parts of the mesh", .target = &seam.seam},
      {.name = "unit",
       .value = "UNIT",
       .help = "length of one unit of the mesh",
       .target = &seam.unit,
       .choices = {"auto", "m", "cm", "mm"}},
      {.name = "max-gap",
       .value = "MM",
       .help = "wider gaps are no seam; 0 is a hundredth of the mesh's size",
       .target = &seam.max_gap_mm,
       .low = 0,
       .high = 1e6},
      {.name = "light-from",
       .value = "AZ,EL",
       .help = "a light in the world: azimuth from +Z toward +X and elevation, degrees; repeatable",
       .target = &seam.lights_from},
      {.name = "view-from",
       .value = "AZ,EL",
       .help = "a distant viewer in the world; repeatable",
       .target = &seam.views_from},
      {.name = "environment",
       .value = "FILE",
       .help = "light of a prefiltered environment, for --view-from",
       .target = &seam.environment},
  };
}

}  // namespace goniochrome::tool
