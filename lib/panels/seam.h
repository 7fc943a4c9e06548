// Colors on both sides of a seam of a mesh: under lights that stand the same way to every place of it, under lights and
// viewers in the world, and in an environment. goniochrome-theory(7), GONIOGEOMETRIC INDEX.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "base/result.h"
#include "envmap/prefiltered.h"
#include "mesh/seam.h"
#include "panels/goniogeom_sets.h"
#include "panels/trompe.h"

namespace goniochrome::fit {
class PaintFitter;
}

namespace goniochrome::panels {

// A fitter to these exponents of face, flop and travel alone, without gloss, by least squares.
fit::PaintFitter appearance_fitter(const std::vector<double>& exponents);

// The lobes of face, flop and travel, whose Lab is relative to `condition`. Error: an illuminant without a known white.
Result<paint::LobeFit> appearance_lobes(const fit::PaintFitter& fitter, const paint::Appearance& appearance,
                                        const color::ViewingCondition& condition);

// One viewer of one place at the seam, and the light there: none means the environment's.
struct SeamView {
  std::size_t point = 0;  // of the seam
  std::optional<Vec3> light;
  Vec3 view;  // both unit, world axes, away from the surface
  double weight = 1;
};

// Light and viewer stand to the first panel at every place as `geometries` say; `seam_deg` is the direction of the seam
// from the plane of incidence. The light comes once from the first panel's side and once from the second's. Viewers who
// do not see both panels are left out.
std::vector<SeamView> views_at_seam(const mesh::Seam& seam, const GeometryList& geometries, double seam_deg);

// Distant lights and viewers in the world, directions unit; without lights the environment's. Left out are viewers who
// do not see both panels, lights below both, and viewers within kIndexGlare_deg of a mirror direction.
std::vector<SeamView> views_in_world(const mesh::Seam& seam, const std::vector<Vec3>& lights,
                                     const std::vector<Vec3>& viewers);

// At most `most` of the places 0..count-1: all in order, or `most` spread by the golden ratio, so that no geometry that
// comes round at every place is favored.
std::vector<std::size_t> spread_places(std::size_t count, std::size_t most);

// What a viewer sees of both panels; the view must have a light.
PanelView panel_view(const mesh::Seam& seam, const SeamView& view);

// Differences at each place of a seam; `views` is how many were looked at, and without any both are NaN.
struct SeamDifference {
  double max = 0, rms = 0;
  int views = 0;
};
// `de` has one value for each view.
std::vector<SeamDifference> by_place(const mesh::Seam& seam, const std::vector<SeamView>& views,
                                     const std::vector<double>& de);

// Panels in a prefiltered environment, without gloss. The white is the brightest that a white diffuser can be in it.
class EnvironmentPanels {
 public:
  // Paints are fitted to the environment's own exponents; `condition` is what their Lab values are relative to. Error:
  // the environment has no lobes or no light, or the illuminant is unknown.
  static Result<EnvironmentPanels> make(const envmap::PrefilteredEnvironment& env,
                                        const color::ViewingCondition& condition);

  // The light that a lobe model needs at a place: P of the normal, and of the mirrored view for every lobe.
  struct Light {
    color::Rgb diffuse;
    std::vector<color::Rgb> lobes;
    double cosine = 0;  // between normal and mirrored view
  };
  Light light(const Vec3& normal, const Vec3& view) const;

  Result<paint::LobeFit> lobes(const paint::Appearance& appearance) const;
  color::Lab color(const paint::LobeFit& paint, const Light& light) const;

  const std::vector<double>& exponents() const { return exponents_; }

 private:
  const envmap::PrefilteredEnvironment* env_ = nullptr;
  std::vector<double> exponents_;
  color::ViewingCondition condition_;
  color::Xyz white_;
  double luminance_ = 1;
  std::shared_ptr<const fit::PaintFitter> fitter_;
};

// The colors that one panel shows in every view, as a function of its paint; keeps the light of the views. `panels`
// must outlive it.
enum class SeamSide { kA, kB };
PanelColors seam_colors(const EnvironmentPanels& panels, const mesh::Seam& seam, const std::vector<SeamView>& views,
                        SeamSide side);

}  // namespace goniochrome::panels
