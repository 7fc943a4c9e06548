// Options that goniogeom-index and trompe-fit share: for lights, viewers and seams, and the picture of one paint.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/file_names.h"
#include "base/text.h"
#include "cli/tool.h"
#include "image/image.h"
#include "panels/geometry_sets.h"
#include "panels/seam.h"
#include "panels/traced_seam.h"

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
  spec.option("mesh", "FILE", "testdata/speed-shape.obj", &seam.mesh,
              "take the panels from a seam of this mesh (OBJ or glTF 2.0)");
  spec.option("seam", "A,B", "Hood,Bumper_F", &seam.seam, "the two parts of the mesh that meet at the seam");
  spec.option("unit", "UNIT", "mm", &seam.unit, "length of one unit of the mesh")
      .one_of({"auto", "m", "in", "cm", "mm"})
      .more(
          "auto takes the unit that the file states: meters for glTF, or a comment such as \"# File units = inches\". "
          "Else it goes by the diagonal of the mesh's box: up to 30 units are meters, up to 300 inches, up to 900 "
          "centimeters, and more are millimeters. A message names the unit.");
  spec.option("max-gap", "MM", "8", &seam.max_gap_mm, "wider gaps are no seam; 0 is a hundredth of the mesh's size")
      .from(0, 1e6);
  spec.option("light-from", "AZ,EL", "0,75", &seam.lights_from, "a light in the world")
      .in("degrees: the azimuth from +Z toward +X, and the elevation");
  spec.option("view-from", "AZ,EL", "25,20", &seam.views_from, "a distant viewer in the world")
      .in("degrees, as for --light-from");
  spec.option("environment", "FILE", "studio.env.exr", &seam.environment,
              "light of a prefiltered environment, for --view-from")
      .more(
          "The light that the mesh blocks and sends to the seam is traced by rays; the report has its noise.");
  spec.flag("open", &seam.open, "let the light of --environment come to the seam as if there were no mesh");
}

// Warns of what the file of a mesh says that is not understood.
inline void tell_remarks(const mesh::Mesh& mesh, cli::Session& session) {
  for (const std::string& remark : mesh.remarks) session.warn(remark);
}

// Tells which pairs of light and viewer a run leaves out, and puts them into its report.
inline void tell_left_out(const std::vector<panels::LightView>& glare, int below_horizon, cli::Session& session) {
  constexpr std::size_t kNamed = 5;
  Json& pairs = session.results()["left_out"] = Json::array();
  std::string names;
  for (const panels::LightView& pair : glare) {
    pairs.push_back({{"light_deg", pair.light_deg},
                     {"view_deg", pair.view_deg},
                     {"azimuth_deg", pair.azimuth_deg},
                     {"aspecular_deg", panels::aspecular_deg(pair)}});
    if (pairs.size() <= kNamed)
      names += fmt::format("{}{}/{}", names.empty() ? "" : ", ", shortest(pair.light_deg), shortest(pair.view_deg));
  }
  if (glare.size() > kNamed) names += fmt::format(" and {} more", glare.size() - kNamed);
  if (!glare.empty())
    session.say(
        fmt::format("left out: {} of the pairs of light and viewer ({} deg), within {} deg of the mirror "
                    "direction, where gloss is seen in any paint",
                    glare.size(), names, panels::kIndexGlare_deg));
  if (below_horizon > 0)
    session.say(fmt::format("left out: {} viewers that lie below the horizon of the panel", below_horizon));
}

// The light at the seam where an environment is given, with the mesh in its way unless nobody wants that. Nothing, with
// a warning that says why and what that leaves out, where it cannot be traced.
inline std::optional<panels::TracedSeam> traced_seam(const panels::SeamTexts& texts, const panels::SeamStage& stage,
                                                     cli::Session& session) {
  if (texts.environment.empty()) return std::nullopt;
  auto traced = panels::TracedSeam::create(stage.mesh, stage.env, texts.open);
  if (traced.ok()) return std::optional<panels::TracedSeam>(*std::move(traced));
  if (!texts.open)
    session.warn(fmt::format("{}: {}; shadows and reflections of the mesh on itself are left out", texts.environment,
                             traced.error().message));
  return std::nullopt;
}

// Reports the tracing of a paint, and its noise; nothing of unoccluded light.
inline void tell_traced(const panels::SeamLights& lights, std::size_t views, const std::string& paint,
                        cli::Session& session) {
  if (lights.noise_de76 == 0 && lights.worth_de76 == 0 && lights.beside == 0) return;
  session.results()["traced"].push_back({{"paint", paint},
                                         {"worth_de76", lights.worth_de76},
                                         {"noise_de76", lights.noise_de76},
                                         {"panels_not_found", lights.beside}});
  session.say(fmt::format("{}: the mesh changes differences by {:.2f} (95 % of the views), known to {:.2f}{}", paint,
                          lights.worth_de76, lights.noise_de76,
                          lights.beside > 0
                              ? fmt::format("; of {} of {} views a panel is not found under its edge, and "
                                            "they get open light",
                                            lights.beside, 2 * views)
                              : ""));
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

// The files of --picture: one for the only paint of a run or, where its name has words in braces, one for each paint.
class PaintPictures {
 public:
  // `option_does` as check_only_paint() has it.
  PaintPictures(const std::string& pattern, const char* option_does) : pattern_(pattern), option_does_(option_does) {}

  // Error (usage): a word in braces that there is not; a second paint for one file.
  static Result<void> check(const std::string& pattern) { return FileNames::check(pattern, words(), "--picture"); }
  Result<void> write(const paint::Paint& paint, const image::Image& image, const cli::Session& session) {
    GONIO_ASSIGN(const std::string file, next(paint));
    return write_picture(file, image, session);
  }

 private:
  static std::vector<std::string> words() { return {"name", "code", "index"}; }

  Result<std::string> next(const paint::Paint& paint) {
    ++count_;
    if (!FileNames::is_pattern(pattern_)) {
      const Result<void> only = check_only_paint(count_, option_does_, paint.name);
      if (only.ok()) return pattern_;
      return Error{only.error().kind, only.error().message + ", or write {name} in the name of the file"};
    }
    if (!names_) {
      GONIO_ASSIGN(FileNames names, FileNames::create(pattern_, words(), "--picture"));
      names_.emplace(std::move(names));
    }
    return names_->next(static_cast<std::size_t>(count_), paint.name, paint.code);
  }

  std::string pattern_;
  const char* option_does_;
  std::optional<FileNames> names_;
  int count_ = 0;
};

}  // namespace goniochrome::tool
