// What tracing rays would add to a picture, measured at some of its points before it is drawn: how much it is seen, and
// how long it takes. goniochrome-theory(7), PLAN, Effects of rays.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "mesh/mesh.h"
#include "render/effects.h"
#include "render/gbuffer.h"
#include "render/path/transport.h"

namespace goniochrome::render {

// A visible point as rays leave it.
struct RayPoint {
  rays::Spot spot;
  rays::Float3 to_viewer;
};

// The point that a pixel of a rasterized G-buffer shows, on the very triangle that was drawn there. The pixel must show
// the mesh, and the G-buffer must have triangles.
RayPoint ray_point(const rays::RayScene& scene, const mesh::Mesh& mesh, const Gbuffer& gbuffer, int x, int y);

// The change of a picture: the 95th percentile of CIEDE2000 over its points, and the standard error of that figure,
// which comes from the choice of points and from the noise of each.
struct Worth {
  double de00_p95 = 0, standard_error = 0;
};

// What drawing takes.
struct RayCost {
  double traced_share = 0;  // of the visible points: those that cannot be told to see all of the light around
  double samples = 0;       // the mean over the visible points
  double ms = 0;            // on all cores together
};

// Some points, with the light that the mesh takes from them and sends to them. Immutable.
class RayProbe {
 public:
  // Traces. The probe keeps no reference to the transport. `base` is what the points show
  // without the mesh in the way. Bit-identical for any number of threads, but for the time that it measures.
  static RayProbe traced(const Transport& transport, const std::vector<RayPoint>& points, std::vector<color::Rgb> base,
                         double white_luminance, int bounces, std::uint64_t seed);

  // Whether no ray of any point met the mesh, so that all effects of rays are worth exactly nothing.
  bool free() const { return blocked_ == 0; }
  // The share of the points of which some ray met the mesh.
  double blocked_share() const { return points_.empty() ? 0 : static_cast<double>(blocked_) / points_.size(); }
  std::size_t size() const { return points_.size(); }
  // What the effects add to the radiance of a point.
  color::Rgb added(std::size_t point, const RayEffects& effects) const;
  // What changing the effects changes. Both pictures are told from the same rays. Noise makes points differ that are
  // the same, so that its share is taken off: theory(7) says how.
  Worth worth(const RayEffects& with, const RayEffects& without) const;
  // Of drawing so many visible points until their noise is within the tolerance, in so many samples of each pixel.
  RayCost cost(const RayEffects& effects, double tolerance_de00, double visible_points, int samples) const;

 private:
  struct Point {
    LightShares sure;
    std::vector<LightShares> batches;
    bool certain = false, blocked = false;
  };
  void trace(const Transport& transport, const std::vector<RayPoint>& points, const std::vector<int>& more,
             std::uint64_t seed);
  std::vector<int> more(double share, int batches) const;
  double squared_difference(std::size_t point, const RayEffects& with, const RayEffects& without) const;

  std::vector<Point> points_;
  std::vector<color::Rgb> base_;
  double white_ = 1;
  int bounces_ = 0;
  std::size_t blocked_ = 0;
  double passed_ms_ = 0, direct_ms_ = 0;  // of a batch, with light passed on and without
};

}  // namespace goniochrome::render
