// The error of prefiltered maps in the light that the diffuse part and the wide lobes of paints gather where no surface
// is in the way: the sum over the environment itself, less the light of the engines of maps. It changes slowly with
// normal and view, so that it is told at the nodes of a grid that a picture meets, and is linear between them.
// goniochrome-rendering(7), "Sums".
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "image/image.h"
#include "render/cpu/cpu_engine.h"
#include "render/path/summed_light.h"
#include "render/path/transport_shading.h"
#include "render/path/view_grid.h"

namespace goniochrome::render {

class OpenResidual {
 public:
  // The tree is that of the environment which the maps of the scenes were made from, and must outlive it.
  explicit OpenResidual(const envmap::BlockTree& tree) : tree_(&tree) {}

  // True if there is anything to correct: image light, and effects of which the sums have all that the engines draw.
  static bool applies(const Effects& effects) { return effects.environment && effects.horizon; }

  // Takes a scene as engines draw it with these effects, whose tolerance decides how close the nodes are. Sums that
  // were made before are kept as far as they hold. Brushed parts, those with textures or color maps, and the gloss of
  // rough coats are left as the maps have them. An engine that was loaded with the scene shares its maps.
  // Error: as the engine cpu loads it, and as column_weights().
  Result<void> load(const Scene& scene, const Effects& effects, const CpuEngine* loaded = nullptr);
  // Takes other paints for the scene and the effects that were loaded. Error: as column_weights().
  Result<void> load_paints(const Scene& scene);

  // Adds `gain` times it at every pixel that shows the mesh; the sums that it takes are made and kept. Bit-identical
  // for any number of threads.
  void add(const Gbuffer& seen, float gain, image::Image& picture);
  std::vector<color::Rgb> at(const std::vector<VisiblePoint>& points);

  std::size_t count() const;  // of sums by now

 private:
  static constexpr std::int32_t kNone = -1;
  // Sums are the same for all paints under such a coat: three for each column.
  struct Surface {
    double coat_index;
    std::unique_ptr<NodeValues> sums;
  };
  // The paints of several parts.
  struct Wear {
    std::size_t surface = 0;
    int part = 0;  // one of them
    TransportPaint paint;
    std::unique_ptr<NodeValues> residual;
  };

  Result<void> set_paints(const Scene& scene);
  std::size_t surface_of(double coat_index);
  // Null where nothing is corrected.
  const Wear* wear_of(int part) const;
  std::size_t floats() const { return 3 * (1 + 2 * columns_.exponents.size()); }
  // Forgets what was found if it is too much.
  void forget();
  void sum(const Surface& surface, const ViewGrid::Facing& at, float* sums) const;
  color::Rgb shown(const TransportPaint& paint, const float* sums, double cos_o) const;
  color::Rgb told(const Wear& wear, const Vec3& normal, const Vec3& to_viewer) const;

  const envmap::BlockTree* tree_;
  double tolerance_de00_ = 0;
  ViewGrid grid_{1, 1};
  LobeColumns columns_;  // wide lobes alone
  std::unique_ptr<SummedLight> light_;
  std::vector<Surface> surfaces_;
  std::vector<Wear> wears_;
  std::vector<std::int32_t> wear_of_part_;  // or kNone
  Scene scene_;                             // what is summed of it
  Effects loaded_, effects_;                // those of the picture, and those of what is summed
  CpuEngine engine_;
};

}  // namespace goniochrome::render
