// What tracing rays would add to a picture, measured at some of its points before it is drawn: how much it is seen, and
// how long it takes. goniochrome-theory(7), PLAN, Effects of rays.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
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
// which comes from the choice of points and from the noise of those near the percentile.
struct Worth {
  double de00_p95 = 0, standard_error = 0;
};

// The samples that drawing may take.
struct RayLimits {
  double of_point = std::numeric_limits<double>::infinity();
  double in_all = std::numeric_limits<double>::infinity();  // of a picture
};

// What drawing takes.
struct RayCost {
  double traced_share = 0;  // of the visible points: those that cannot be told to see all of the light around
  double samples = 0;       // the mean over the visible points
  double most_samples = 0;  // of a point
  double noise = 1;         // that is left, in units of the tolerance: above 1 where limits end the samples before
  double ms = 0;            // on all cores together
};

// What a probe is traced by. The probe keeps no reference to the transports.
struct ProbeSetting {
  const Transport* transport = nullptr;
  // Where that is over a floor, the same mesh without it; null: there is no floor to be priced.
  const Transport* without_floor = nullptr;
  double white_luminance = 1;
  int bounces = 8;
  std::uint64_t seed = 1;
  // How many points the picture shows. Where the probe has all of them, their choice adds no error. 0: beyond number.
  double visible_points = 0;
};

// Some points, with the light that the mesh takes from them and sends to them. Immutable.
class RayProbe {
 public:
  // Traces from as many of the points as it takes to know the worth of the effects, within a fixed number of samples.
  // `points` are in any order that follows the picture; `base` is what they show without the mesh in the way.
  // Bit-identical for any number of threads, but for the time that it measures.
  static RayProbe traced(const ProbeSetting& setting, const std::vector<RayPoint>& points,
                         const std::vector<color::Rgb>& base);

  // Whether no ray of any point met the mesh or the floor, so that all effects of rays are worth exactly nothing.
  bool free() const { return blocked_ == 0; }
  // The share of the points of which some ray met the mesh or the floor.
  double blocked_share() const { return points_.empty() ? 0 : static_cast<double>(blocked_) / points_.size(); }
  std::size_t size() const { return points_.size(); }
  // Of all points together.
  std::size_t samples() const;
  // What the effects add to the radiance of a point.
  color::Rgb added(std::size_t point, const RayEffects& effects) const;
  // What changing the effects changes. Both pictures are told from the same rays. Noise makes points differ that are
  // the same, so that its share is taken off: theory(7) says how.
  Worth worth(const RayEffects& with, const RayEffects& without) const;
  // What the floor changes on the mesh where all other effects are drawn, told from some of the points; nothing where
  // no floor was probed.
  std::optional<Worth> floor_worth() const;
  // As cost(), of the mesh without the floor that was probed, told from these points.
  RayCost cost_without_floor(const RayEffects& effects, double tolerance_de00, double visible_points, int samples,
                             const RayLimits& limits = {}) const;
  // Of drawing so many visible points until their noise is within the tolerance or a limit is reached, in so many
  // samples of each pixel.
  RayCost cost(const RayEffects& effects, double tolerance_de00, double visible_points, int samples,
               const RayLimits& limits = {}) const;

 private:
  struct Light {
    LightShares sure;
    std::vector<LightShares> fans;  // means of kFan samples each
    bool certain = false, blocked = false;
  };
  struct Point {
    RayPoint at;
    color::Rgb base;
    Light drawn, without_floor;
  };
  // One difference at a point, and the standard error of it.
  struct Change {
    double de00 = 0, standard_error = 0;
  };
  // With the floor, if there is one, in both; or `floor`: in the first alone.
  struct Comparison {
    RayEffects with, without;
    bool floor = false;
  };
  static const std::vector<Comparison>& comparisons();
  void add_points(const std::vector<RayPoint>& points, const std::vector<color::Rgb>& base, std::size_t count);
  void trace(const ProbeSetting& setting, const std::vector<int>& more);
  void refine(const ProbeSetting& setting);
  void time(const ProbeSetting& setting, double of_point_ms);
  Change change(std::size_t point, const Comparison& comparison) const;
  std::vector<Change> changes(const Comparison& comparison) const;
  std::size_t count_for(const Comparison& comparison) const;
  int fans(std::size_t i) const {
    return static_cast<int>(std::max(points_[i].drawn.fans.size(), points_[i].without_floor.fans.size()));
  }
  Worth worth(std::vector<Change> changes) const;
  RayCost cost_of(Light Point::*light, std::size_t count, const RayEffects& effects, double tolerance_de00,
                  double visible_points, int samples, const RayLimits& limits) const;
  bool add_ambiguous(const std::vector<Change>& changes, const Worth& worth, std::vector<double>& wish) const;

  std::vector<Point> points_;
  std::size_t floor_points_ = 0;  // the first of them
  double white_ = 1, visible_points_ = 0;
  std::size_t blocked_ = 0;
  // Of a fan, with light passed on and without, and of a point apart from its fans.
  double passed_ms_ = 0, direct_ms_ = 0, point_ms_ = 0;
};

}  // namespace goniochrome::render
