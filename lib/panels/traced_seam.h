// The light of an environment at a seam with the mesh in its way: the light that the mesh blocks, and the light that it
// sends back in the paint that it wears. goniochrome-panels(7), "GONIOGEOMETRIC INDEX" and
// goniochrome-transport(7), "TRANSPORT".
#pragma once

#include <memory>
#include <vector>

#include "base/result.h"
#include "panels/seam.h"

namespace goniochrome::panels {

class TracedSeam {
 public:
  // The mesh and the environment must outlive it. Error: the environment lacks its mirror part, which is the light that
  // rays meet, or it has too many lobes; or the mesh cannot be traced. `open`: the mesh is not in the way; what lobes
  // gather is cut at the horizon of each panel either way.
  static Result<TracedSeam> create(const mesh::Mesh& mesh, const envmap::PrefilteredEnvironment& env,
                                   bool open = false);
  TracedSeam(TracedSeam&&) noexcept;
  TracedSeam& operator=(TracedSeam&&) noexcept;
  ~TracedSeam();
  bool is_open() const;

  // The light of each view on one panel, `part` of the mesh by name, while all parts wear this paint. Rays start a
  // thousandth of the mesh's size beside the edge, on the panel. Both sides of a place are sampled alike, so that their
  // noise is much the same. Bit-identical for any number of threads. Error: a lobe that the environment lacks.
  struct Seen {
    std::vector<EnvironmentPanels::Light> lights;  // one for each view
    std::vector<EnvironmentPanels::Light> open;    // the same without the mesh
    std::size_t beside = 0;  // views whose panel was not found under the place, which get their light in the open
  };
  Result<Seen> seen(const paint::LobeFit& worn, const mesh::Seam& seam, const std::vector<SeamView>& views,
                    SeamSide side, const std::string& part, std::uint64_t seed = 1) const;

 private:
  struct State;
  explicit TracedSeam(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

// The light that both panels get in each view, with the mesh in its way.
struct SeamLights {
  std::vector<EnvironmentPanels::Light> a, b;
  std::size_t beside = 0;  // views of which a panel was not found under its place
  // The change of the difference (CIE 1976) of the panels by the random directions, one standard deviation, at 95 % of
  // the views; from a second tracing of at most 100 of them. 0 in open light.
  double noise_de76 = 0;
  // The change of that difference by the mesh, at 95 % of the views.
  double worth_de76 = 0;
};
// `traced` null: open light, whose lobes are not cut at the horizon. `worn` is what all parts wear. Error: as
// TracedSeam::seen().
Result<SeamLights> seam_lights(const EnvironmentPanels& panels, const TracedSeam* traced, const paint::LobeFit& worn,
                               const mesh::Seam& seam, const std::vector<SeamView>& views, const std::string& part_a,
                               const std::string& part_b);

}  // namespace goniochrome::panels
