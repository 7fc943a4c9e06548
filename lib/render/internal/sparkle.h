// The effect sparkle: the flakes of a paint one by one, or the grain that many of them leave. A picture has the mean of
// their light; what a pixel's own flakes differ from it is added, so that the mean over many pixels stays. The counts
// are those of flakes that lie on the mesh, see brdf/flake_tree.h. goniochrome-flakes(7).
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "brdf/flake_tree.h"
#include "image/image.h"
#include "rays/ray_scene.h"
#include "render/effects.h"
#include "render/gbuffer.h"

namespace goniochrome::render {

class Sparkle {
 public:
  // The scene must outlive it and have a mesh.
  Sparkle(const Scene& scene, const Effects& effects);

  // Why there is nothing to draw; "" where there is. What is drawn, and on what paints it is not.
  const std::string& absent() const { return absent_; }
  const std::string& reason() const { return reason_; }

  // The standard deviation of what a pixel of a G-buffer with triangles shows, by channel. `shown` is the radiance of
  // the pixel, of which flakes have no more than all.
  color::Rgb deviation(const Gbuffer& gbuffer, int x, int y, const color::Rgb& shown) const;

  // Adds to each pixel what its flakes differ from their mean. Flakes show no lamp that is behind `blockers`; null:
  // nothing is in the way. Bit-identical for any number of threads.
  void add(const Gbuffer& gbuffer, const rays::RayScene* blockers, image::Image& picture) const;

 private:
  struct Footprint;
  struct Source;
  struct Lamp;
  struct Part;
  struct Grain;
  struct Place;
  std::optional<Footprint> footprint(const Gbuffer& gbuffer, int x, int y, const MeshPoint& point) const;
  void move(Footprint& to, const Gbuffer& gbuffer, int x, int y, const Vec3& position) const;
  using Lit = std::function<bool(const Grain&)>;  // nothing is in the way of that lamp
  Place place(const Part& part, const Footprint& at, const Lit& lit) const;
  static void add_further(std::vector<Grain>& grains);
  // Calls see(grain, mean) for each lit grain that is seen at a pixel that shows this radiance.
  template <class See>
  static void visit_seen(Place& place, const color::Rgb& shown, const Lit& lit, const See& see);
  double change(const Part& part, const Footprint& at, const Grain& grain) const;

  const Scene& scene_;
  bool reflection_;
  double unit_m_;
  std::vector<Light> lamps_;
  std::vector<std::shared_ptr<const Part>> parts_;  // null: no sparkle
  std::string absent_, reason_;
};

}  // namespace goniochrome::render
