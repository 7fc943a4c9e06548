// The light that each lobe of a basis gathers of an environment where no surface is in the way, by the environment's
// prefiltered maps and its bright spots or, where these err by too much, by sums over the environment.
// goniochrome-rendering(7), "RENDERING" and goniochrome-transport(7), "TRANSPORT".
#pragma once

#include <map>
#include <optional>
#include <vector>

#include "base/result.h"
#include "envmap/open_maps.h"
#include "render/effects.h"
#include "render/gbuffer.h"
#include "render/path/lobe_columns.h"
#include "render/path/summed_light.h"
#include "render/unit_weights.h"

namespace goniochrome::render {

// A point of a surface as it is seen: both unit, on one side.
struct OpenView {
  Vec3 normal, to_viewer;
};

class OpenLight {
 public:
  // For columns whose exponents are among those of the environment. `tilts` of each part, as tilts_of() has them; none:
  // isotropic. `coats`: the index of the coat of each part; none where there are fewer. The environment must outlive
  // it. Error: a lobe that it lacks, the diffuse map, or the mirror part.
  static Result<OpenLight> create(const envmap::PrefilteredEnvironment& env, const LobeColumns& columns,
                                  std::vector<std::vector<brdf::Tilt>> tilts, std::vector<double> coats = {});

  // From now on the diffuse part and the wide lobes are summed over the environment itself, within a color difference
  // at 95 of 100 points. The tree must outlive it.
  void sum(const envmap::BlockTree& tree, double tolerance_de00);

  // Writes the light of each column with weight 1 at a point seen from there; both vectors unit, on one side.
  void at(const Vec3& normal, const Vec3& to_viewer, int part, color::Rgb* light) const;

  // Writes the mean of that over views of a part which lie close together. Wide lobes that are summed are so at the
  // first view alone: at the others they differ from it as the maps do.
  void mean(const std::vector<OpenView>& views, int part, color::Rgb* light) const;

  // The light of the mirror's column alone.
  color::Rgb mirror(const OpenView& view, int part) const;

 private:
  OpenLight() = default;
  std::vector<LobeAxis> axes(const OpenView& view, int part) const;
  double coat_of(int part) const;
  void look_up(const OpenView& view, int part, color::Rgb* light) const;

  const envmap::PrefilteredEnvironment* env_ = nullptr;
  LobeColumns columns_;
  std::vector<envmap::MapPointer> lobes_;     // of the columns' exponents; these and the next two without bright spots
  std::vector<const envmap::CubeMap*> maps_;  // the same
  std::vector<std::vector<brdf::Tilt>> tilts_;
  std::vector<double> coats_;
  envmap::MapPointer diffuse_, coat_diffuse_;  // the second where any part has a coat
  std::map<double, UnitWeights> weights_;      // by coat
  std::vector<UnitWeights::Disc> spots_;
  std::optional<SummedLight> summed_;
};

// How far both are apart at these points: the 95th percentile of the largest color difference over the columns, in the
// gray paint of nominal_weight().
double open_difference_de00(const OpenLight& a, const OpenLight& b, const LobeColumns& columns,
                            const std::vector<VisiblePoint>& points, double white_luminance);

}  // namespace goniochrome::render
