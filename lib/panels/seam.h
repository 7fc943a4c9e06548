// Two parts of a mesh that meet at a seam: its viewers and lights, the colors of both parts there, and a camera that
// sees it. Lights and viewers stand to every place of the seam alike, or in the world; light may also come from an
// environment. goniochrome-panels(7), "GONIOGEOMETRIC INDEX".
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"

#include "mesh/mesh.h"
#include "mesh/seam.h"
#include "panels/geometry_sets.h"
#include "panels/trompe.h"
#include "render/camera.h"
#include "render/light_transport.h"

namespace goniochrome::fit {
class PaintFitter;
}

namespace goniochrome::panels {

// Fits face, flop and travel, without gloss, to these exponents by least squares.
fit::PaintFitter appearance_fitter(const std::vector<double>& exponents);

// The lobes of face, flop and travel under such a coat, whose Lab is relative to `condition`. Error: an illuminant
// without a known white.
Result<paint::LobeFit> appearance_lobes(const fit::PaintFitter& fitter, const paint::Appearance& appearance,
                                        const color::ViewingCondition& condition, double coat_index = paint::kNoCoat);

// One viewer of one place at the seam, and the light there; without a light it is the environment's.
struct SeamView {
  std::size_t point = 0;  // of the seam
  std::optional<Vec3> light;
  Vec3 view;  // both unit, world axes, away from the surface
  double weight = 1;
};

// Views in which light and viewer stand to the first panel at every place as `geometries` say; `seam_deg` is the
// direction of the seam from the plane of incidence. The light comes once from the first panel's side and once from the
// second's. Viewers who do not see both panels are left out.
std::vector<SeamView> views_at_seam(const mesh::Seam& seam, const GeometryList& geometries, double seam_deg);

// Views under distant lights and from distant viewers in the world, given by unit directions; without lights the light
// is the environment's. Left out are viewers who do not see both panels, lights below both panels, and viewers within
// kIndexGlare_deg of a mirror direction.
std::vector<SeamView> views_in_world(const mesh::Seam& seam, const std::vector<Vec3>& lights,
                                     const std::vector<Vec3>& viewers);

// At most `most` of the places 0..count-1: all in order, or `most` of them spread by the golden ratio, so that a
// geometry that comes again at every n-th place is neither favored nor missed.
std::vector<std::size_t> spread_places(std::size_t count, std::size_t most);

// The view of both panels by one viewer. The view must have a light.
PanelView panel_view(const mesh::Seam& seam, const SeamView& view);

// The differences at one place of a seam, over `views` views; NaN where there are none.
struct SeamDifference {
  double max = 0, rms = 0;
  int views = 0;
};
// The differences at each place. `de` has one value for each view.
std::vector<SeamDifference> by_place(const mesh::Seam& seam, const std::vector<SeamView>& views,
                                     const std::vector<double>& de);

// Panels without gloss in a prefiltered environment. White is the brightest that a white diffuser can be there.
class EnvironmentPanels {
 public:
  // Paints are fitted to the environment's own exponents, under a coat of that index; `condition` is what their Lab
  // values are relative to. Error: the environment has no lobes or no light, or the illuminant is unknown.
  static Result<EnvironmentPanels> make(const envmap::PrefilteredEnvironment& env,
                                        const color::ViewingCondition& condition, double coat_index = paint::kNoCoat);

  // The light that each column of the environment's lobes gathers at a place, as render::OpenLight has it without the
  // horizon.
  using Light = std::vector<color::Rgb>;
  Light light(const Vec3& normal, const Vec3& view) const;

  Result<paint::LobeFit> lobes(const paint::Appearance& appearance) const;
  color::Lab color(const paint::LobeFit& paint, const Light& light) const;

  const std::vector<double>& exponents() const { return columns_.exponents; }

 private:
  render::LobeColumns columns_;
  std::optional<render::OpenLight> open_;
  double coat_index_ = paint::kNoCoat;
  color::ViewingCondition condition_;
  color::Xyz white_;
  double luminance_ = 1;
  std::shared_ptr<const fit::PaintFitter> fitter_;
};

// The colors that one panel shows in every view, as a function of its paint. The function keeps the light of the views;
// `panels` must outlive it.
enum class SeamSide { kA, kB };
PanelColors seam_colors(const EnvironmentPanels& panels, const mesh::Seam& seam, const std::vector<SeamView>& views,
                        SeamSide side);
// Colors in known light, one for each view.
PanelColors seam_colors(const EnvironmentPanels& panels, std::vector<EnvironmentPanels::Light> lights);

// Words of the options about a seam: the file of a mesh, its two parts as A,B, its unit (auto | m | cm | mm), lights
// and viewers in the world as AZIMUTH,ELEVATION of render::orbit_direction(), and the file of an environment.
struct SeamTexts {
  std::string mesh, seam, unit = "auto", environment;
  double max_gap_mm = 0;
  bool open = false;  // whether the mesh is not in the way of the environment's light
  std::vector<std::string> lights_from, views_from;
  bool names_anything_but_mesh() const;
};

// The meaning of those words. Error (usage): an option has a value that it does not take, or lights lack viewers or the
// other way round.
struct SeamWorld {
  std::string part_a, part_b;
  mesh::SeamOptions seam;
  std::vector<Vec3> lights, viewers;  // directions, unit
  bool in_world = false;              // else lights and viewers stand to every place alike
};
Result<SeamWorld> seam_world(const SeamTexts& texts);

// The mesh, its seam, who sees it in what light, and the environment where there is one. Where lights and viewers do
// not stand in the world, they stand to every place as `geometries` and `seam_deg` say. Error: a file that cannot be
// read, parts that do not meet, or no viewer who sees both panels.
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

// A camera with this field of view that sees the whole seam from outside and a little from above. `aspect` is the width
// of the picture over its height. With `margin` 1 the seam just fits in.
render::Camera seam_camera(const mesh::Seam& seam, double aspect, double fov_deg, double margin);

// The camera from a direction, such as orbit_direction().
render::Camera seam_camera_from(const mesh::Seam& seam, const Vec3& direction, double aspect, double fov_deg,
                                double margin);

// Where a point of the world falls in the picture, in pixels from the upper left corner; none for a point behind the
// camera.
struct PicturePoint {
  double x = 0, y = 0;
};
std::optional<PicturePoint> projected(const render::Camera& camera, const render::Rays& rays, const Vec3& point);

}  // namespace goniochrome::panels
