#include "render/plan/kept.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "math/statistics.h"
#include "render/exact.h"
#include "render/integral/integral_engine.h"
#include "render/internal/seen.h"

namespace goniochrome::render {

OpenTruth::OpenTruth(const Scene& scene, const Effects& all, const std::vector<VisiblePoint>& points,
                     const envmap::BlockTree& texels, double white)
    : white_(white > 0 ? white : 1) {
  constexpr std::size_t kExact = 128;
  // Coarser sums would err by as much as the maps do.
  constexpr double kOfTolerance = 0.2;
  step_ = std::max<std::size_t>(1, points.size() / kExact);
  for (std::size_t i = 0; i < points.size(); i += step_) points_.push_back(points[i]);
  exact_ = exact_radiance(points_, scene, all, Surroundings(texels, spread_for(kOfTolerance * all.tolerance_de00)));
}

Missed OpenTruth::error(const std::vector<color::Rgb>& planned, const std::vector<color::Rgb>& more) const {
  std::vector<double> de00;
  for (std::size_t i = 0; i < exact_.size(); ++i)
    de00.push_back(
        seen_difference(more.empty() ? planned[i * step_] : planned[i * step_] + more[i], exact_[i], white_));
  const double mean = math::mean(de00);
  return {mean, percentile_95(std::move(de00))};
}

double OpenTruth::change(const std::vector<color::Rgb>& planned, const std::vector<color::Rgb>& more) const {
  std::vector<double> de00;
  for (std::size_t i = 0; i < exact_.size(); ++i)
    de00.push_back(seen_difference(planned[i * step_], planned[i * step_] + more[i], white_));
  return percentile_95(std::move(de00));
}

double OpenTruth::difference(const OpenTruth& other) const {
  std::vector<double> de00;
  for (std::size_t i = 0; i < exact_.size(); ++i) de00.push_back(seen_difference(other.exact_[i], exact_[i], white_));
  return percentile_95(std::move(de00));
}

namespace {

// To two digits.
std::string some_seconds(double ms) {
  const double s = ms / 1000;
  if (s < 10) return fmt::format("some {:.1g} s", s);
  const double digit = std::pow(10, std::floor(std::log10(s)) - 1);
  return fmt::format("some {:.0f} s", digit * std::round(s / digit));
}

}  // namespace

std::string reason_not_kept(const Plan& plan, const RayChoice& rays, const PlanRequest& request, bool has_maps) {
  if (!plan.whole_de00_p95 || *plan.whole_de00_p95 <= request.tolerance_de00) return "";
  const std::string start = fmt::format(
      "the picture is predicted to miss the truth by dE00 {:.2g} (p95), --tolerance is {:g}: ", *plan.whole_de00_p95,
      request.tolerance_de00);
  const double open = plan.open_de00_p95.value_or(0), noise = plan.rays_noise_de00, left = rays.left_out_de00_p95;
  if (open >= noise && open >= left && has_maps)
    return start + fmt::format(
                       "the prefiltered maps miss the open light by {:.2g}; --engine integral sums it within the "
                       "tolerance, and --engine path draws everything within it{}",
                       open, rays.path_ms > 0 ? " in " + some_seconds(rays.path_ms) : "");
  if (noise >= left && rays.most_in_all > 0)
    return start + fmt::format(
                       "the noise is {:.2g} after {:.0f} million samples of rays, and a picture takes no more where no "
                       "tolerance is asked for; --effects auto,+rays draws as many as it takes, in {}",
                       noise, 1e-6 * rays.most_in_all, some_seconds(rays.named_ms));
  if (noise >= left)
    return start +
           fmt::format(
               "the noise of {} samples a point is {:.2g}; --effects auto,+rays draws as many as it takes, in {}",
               rays.most_samples, noise, some_seconds(rays.named_ms));
  return start + fmt::format("the effects of rays that are left out are worth {:.2g}", left);
}

}  // namespace goniochrome::render
