// The light that each lobe of a basis gathers of an environment and of lamps far away where no surface is in the way,
// by the prefiltered maps of the environment and its bright spots or, where these err by too much, by sums over the
// environment. goniochrome-rendering(7), "RENDERING" and goniochrome-transport(7), "TRANSPORT".
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "base/result.h"
#include "brdf/ward.h"
#include "render/cpu/cpu_engine.h"
#include "render/gbuffer.h"
#include "render/path/lobe_columns.h"
#include "render/path/summed_light.h"
#include "render/path/view_grid.h"
#include "render/scene.h"

namespace goniochrome::render {

// A point of a surface as it is seen: both unit, on one side.
struct OpenView {
  Vec3 normal, to_viewer;
};

// Effects that the light may be gathered without, as pictures may be drawn.
struct OpenEffects {
  bool fresnel = true, horizon = true, spots = true, mirror = true;
};

class OpenLight {
 public:
  // The light of a scene by its environment, lamps and brushing, but not its paints, for columns whose exponents
  // are among those of the environment. `coats`: the index of the coat of each part; none where there are fewer. Lamps
  // have no images in mirrors. The environment must outlive it. Error: a lobe that it lacks, the diffuse map, or the
  // mirror part; or as the engine cpu loads it.
  static Result<OpenLight> create(const Scene& scene, const LobeColumns& columns, const std::vector<double>& coats = {},
                                  const OpenEffects& effects = {});

  // From now on the diffuse part and the wide lobes are summed over the environment itself, within a color difference
  // at 95 of 100 points: on brushed parts at every point, else at the nodes of a grid. The tree must outlive it.
  void sum(const envmap::BlockTree& tree, double tolerance_de00);

  // Writes the light of each column with weight 1 at a point seen from there; both vectors unit, on one side.
  void at(const Vec3& normal, const Vec3& to_viewer, int part, color::Rgb* light) const {
    mean({{normal, to_viewer}}, part, light);
    add_sums({normal, to_viewer}, part, light);
  }

  // Writes the mean of that over views of a part which lie close together, whatever is summed, and returns the light of
  // the mirror's column at each view.
  std::vector<color::Rgb> mean(const std::vector<OpenView>& views, int part, color::Rgb* light) const;
  // Adds what the light that is summed differs by from the maps at a view; nothing where nothing is summed.
  void add_sums(const OpenView& view, int part, color::Rgb* light) const;

  // Writes the light of all columns at each point in turn, whatever is summed.
  void look_up(const std::vector<VisiblePoint>& points, color::Rgb* light) const;

 private:
  // Parts that are brushed and coated alike.
  struct Surface {
    double coat_index = paint::kNoCoat;
    paint::Anisotropy brushed;
    std::vector<brdf::Tilt> tilts;             // as tilts_of() has them
    std::shared_ptr<const NodeValues> missed;  // by the maps, three for each column that is summed; null: no grid
  };
  OpenLight() = default;
  std::size_t surface_of(int part) const;
  // Writes what the maps miss of the columns that are summed, and 0 for the others.
  void find_missed(const OpenView& view, int part, color::Rgb* light) const;
  static std::vector<LobeAxis> axes(const OpenView& view, const Surface& surface);

  LobeColumns columns_;
  std::vector<Surface> surfaces_;      // the first has neither coat nor brushing
  std::vector<std::size_t> of_parts_;  // the surface of each
  std::shared_ptr<CpuEngine> engine_;  // its parts: for each surface one for each column
  std::optional<SummedLight> summed_;
  ViewGrid grid_{1, 1};
};

// How far both are apart at these points: the 95th percentile of the largest color difference over the columns, in the
// gray paint of nominal_weight().
double open_difference_de00(const OpenLight& a, const OpenLight& b, const LobeColumns& columns,
                            const std::vector<VisiblePoint>& points, double white_luminance);

}  // namespace goniochrome::render
