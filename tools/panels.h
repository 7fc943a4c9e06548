// What goniogeom-index and trompe-fit share: the options for lights, viewers and seams, and the picture of one paint.
#pragma once

#include <string>
#include <vector>

#include "cli/tool.h"
#include "image/image.h"
#include "panels/geometry_sets.h"
#include "panels/seam.h"

namespace goniochrome::tool {

inline void add_geometry_options(cli::ToolSpec& spec, panels::GeometryTexts& geometries, double& seam_deg) {
  spec.heading = "lights and viewers";
  spec.option("lights,light", "LIST", "15,45:60:5", &geometries.lights, "polar angles of the lights")
      .in("degrees from the normal of the first panel")
      .more("A list has numbers, ranges FIRST:LAST:STEP and named sets, separated by commas.");
  spec.option("views,view", "LIST", "as15:105:10", &geometries.views, "polar angles of the viewers")
      .in("degrees from the normal of the first panel, positive on the far side of the normal from the light")
      .more("A list that begins with as holds aspecular angles.");
  spec.option("out-of-plane", "LIST", "-90:90:30", &geometries.azimuths, "azimuths of the viewers about the normal")
      .in("degrees from the plane of incidence");
  spec.option("seam-axis", "DEG", "0", &seam_deg, "direction of the seam from the plane of incidence")
      .from(-360, 360)
      .more("A seam at 90 lies across the plane, where a turn of the second panel counts most.");
}

inline void add_seam_options(cli::ToolSpec& spec, panels::SeamTexts& seam) {
  spec.heading = "seam of a mesh";
  spec.option("mesh", "FILE", "testdata/speed-shape.obj", &seam.mesh, "take the panels from a seam of this mesh (OBJ)");
  spec.option("seam", "A,B", "Hood,Bumper_F", &seam.seam, "the two parts of the mesh that meet at the seam");
  spec.option("unit", "UNIT", "mm", &seam.unit, "length of one unit of the mesh")
      .one_of({"auto", "m", "cm", "mm"})
      .more("auto takes a mesh of more than 30 units as millimeters, and a smaller one as meters.");
  spec.option("max-gap", "MM", "8", &seam.max_gap_mm, "wider gaps are no seam; 0 is a hundredth of the mesh's size")
      .from(0, 1e6);
  spec.option("light-from", "AZ,EL", "0,75", &seam.lights_from, "a light in the world")
      .in("degrees: the azimuth from +Z toward +X, and the elevation");
  spec.option("view-from", "AZ,EL", "25,20", &seam.views_from, "a distant viewer in the world")
      .in("degrees, as for --light-from");
  spec.option("environment", "FILE", "studio.env.exr", &seam.environment,
              "light of a prefiltered environment, for --view-from");
}

// For a picture that can show one paint only: `count` says which paint of the run this is, and `option_does` what the
// option does, as in "--picture shows". Error (usage): it is not the first paint.
inline Result<void> check_only_paint(int count, const char* option_does, const std::string& name) {
  if (count <= 1) return {};
  return usage_error("{} one paint and there is another, \"{}\": choose one by --only", option_does, name);
}

// A PNG that says which run made it.
inline Result<void> write_picture(const std::string& path, const image::Image& image, const cli::Session& session) {
  return image::write_png(
      path, image, {{"Software", session.tool() + " " + cli::Session::version()}, {"Comment", session.command_line()}});
}

}  // namespace goniochrome::tool
