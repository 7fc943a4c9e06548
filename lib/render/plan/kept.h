// Whether a picture is going to be within its tolerance, all errors together. goniochrome-theory(7), PLAN, The whole.
#pragma once

#include <string>
#include <vector>

#include "envmap/block_tree.h"
#include "render/effects.h"
#include "render/gbuffer.h"
#include "render/plan.h"
#include "render/plan/ray_plan.h"

namespace goniochrome::render {

// Color differences at some points, in units of CIEDE2000.
struct Missed {
  double mean = 0, p95 = 0;
};

// The exact sum of the open light at some points.
class OpenTruth {
 public:
  // Of some of the points, with all effects of the scene.
  OpenTruth(const Scene& scene, const Effects& all, const std::vector<VisiblePoint>& points,
            const envmap::BlockTree& texels, double white);
  // Those at which it was summed.
  const std::vector<VisiblePoint>& points() const { return points_; }
  // What they miss of it; `planned` has one radiance for each of all points. `more` has what is added to it at
  // points(); empty: nothing.
  Missed error(const std::vector<color::Rgb>& planned, const std::vector<color::Rgb>& more = {}) const;
  // The 95th percentile of what is changed by adding that.
  double change(const std::vector<color::Rgb>& planned, const std::vector<color::Rgb>& more) const;
  // The same of the difference to another truth of the same points.
  double difference(const OpenTruth& other) const;

 private:
  std::size_t step_;
  double white_;
  std::vector<VisiblePoint> points_;
  std::vector<color::Rgb> exact_;
};

// Why a picture is not going to be within the tolerance, and what would be; "" where it is, or where that is unknown.
std::string reason_not_kept(const Plan& plan, const RayChoice& rays, const PlanRequest& request, bool has_maps);

}  // namespace goniochrome::render
