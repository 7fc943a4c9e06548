// What tracing rays would add to a picture, measured at some of its points before it is drawn: how much it is seen, and
// how long it takes. goniochrome-theory(7), PLAN, Effects of rays.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "mesh/mesh.h"
#include "render/effects.h"
#include "render/gbuffer.h"
#include "render/path/transport.h"
#include "render/plan/sampled_light.h"

namespace goniochrome::render {

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
  // Traces from the points, which follow the picture in both directions and are evenly spread over it, until the worth
  // of the effects is known or a fixed number of samples is spent. `base` is what they show without the mesh in the
  // way. Bit-identical for any number of threads, but for the time that it measures.
  static RayProbe traced(const ProbeSetting& setting, const std::vector<RayPoint>& points,
                         const std::vector<color::Rgb>& base);

  // Whether no ray of any point met the mesh or the floor, so that all effects of rays are worth exactly nothing.
  bool free() const { return blocked_ == 0; }
  // The share of the points of which some ray met the mesh or the floor.
  double blocked_share() const { return points_.empty() ? 0 : static_cast<double>(blocked_) / points_.size(); }
  std::size_t size() const { return points_.size(); }
  // Of all points together.
  std::size_t samples() const;
  // What changing the effects changes. Both pictures are told from the same rays.
  Worth worth(const RayEffects& with, const RayEffects& without) const;
  // What the floor changes on the mesh where all other effects are drawn, told from some of the points; nothing where
  // no floor was probed.
  std::optional<Worth> floor_worth() const;
  // As cost(), of all effects on the mesh without the floor that was probed, told from these points.
  RayCost cost_without_floor(double tolerance_de00, double visible_points, int samples,
                             const RayLimits& limits = {}) const;
  // Of drawing so many visible points until their noise is within the tolerance or a limit is reached, in so many
  // samples of each pixel.
  RayCost cost(const RayEffects& effects, double tolerance_de00, double visible_points, int samples,
               const RayLimits& limits = {}) const;

 private:
  using Lights = std::vector<SampledLight>;
  // With the floor, if there is one, in both; or `floor`: in the first alone.
  struct Comparison {
    RayEffects with, without;
    bool floor = false;
  };
  // What it changes at points, and the percentile of that.
  struct Changes {
    Comparison of;
    std::vector<double> de00;
    Worth worth;
  };
  std::size_t fans(std::size_t point) const;  // with the floor and without it
  void trace(const ProbeSetting& setting, const std::vector<int>& more);
  void tell_floor();
  void refine(const ProbeSetting& setting);
  void compare();
  std::vector<std::size_t> in_doubt() const;
  void time(const ProbeSetting& setting, double of_point_ms);
  double change(std::size_t point, const Comparison& comparison) const;
  // The standard error of that by the samples of the point alone, in CIEDE2000.
  double noise(std::size_t point, const Comparison& comparison) const;
  Changes changes(const Comparison& comparison) const;
  std::vector<double> needs(const Lights& lights, std::size_t step, const RayEffects& effects) const;
  RayCost cost_of(const Lights& lights, const std::vector<double>& needs, const RayEffects& effects,
                  double tolerance_de00, double visible_points, int samples, const RayLimits& limits) const;

  std::vector<RayPoint> points_;
  std::vector<color::Rgb> base_;
  Lights drawn_;
  Lights without_floor_, of_floor_;  // of every so many-th point, and what the floor adds there
  std::size_t floor_step_ = 1;
  std::vector<Changes> compared_;  // as compare() makes them
  // The variance of one fan at each point, in CIEDE2000: of drawing with `self`, with `bounce`, with both and with
  // neither, and of all effects without the floor.
  std::array<std::vector<double>, 4> needs_;
  std::vector<double> needs_without_floor_;
  double white_ = 1, visible_points_ = 0;
  std::size_t blocked_ = 0;
  // Of a fan, with light passed on and without, and of a point apart from its fans.
  double passed_ms_ = 0, direct_ms_ = 0, point_ms_ = 0;
};

}  // namespace goniochrome::render
