#include "prefilter/internal/prefilter_cost.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "prefilter/internal/bright_texels.h"
#include "prefilter/internal/horizon_band.h"
#include "prefilter/internal/local_sums.h"
#include "prefilter/internal/mirror.h"

// Processor seconds on one core. The constants are fits to timed runs of probes of 512 x 256 to 4096 x 2048 texels, to
// 32 to 512 texels a face at tolerances of 1e-1 to 1e-6.

namespace goniochrome::prefilter {

namespace {

double count(const envmap::Environment& env) {
  return static_cast<double>(env.width()) * env.height();
}

// Transforms of every row and column; Legendre sums of degree^2/2 terms at as many rings as the degree.
double transform_time_s(const envmap::Environment& env, int degree) {
  const double l = degree;
  // Points of a cube or a probe are spread over 14 x 14 nodes of a grid.
  const double texel = env.layout() == envmap::Environment::Layout::kLatLong ? 2.9e-8 : 1.5e-6;
  return 2e-3 + texel * count(env) + 4.3e-10 * l * l * l;
}

// A grid of 4 L x 2 L, and 4 to 14 taps each way at every texel.
double evaluation_time_s(int degree, double texels) {
  const double l = degree;
  return 1e-3 + 1.6e-5 * l + 7.5e-7 * l * l + 1.1e-7 * texels;
}

// Polar angles and azimuths of a size that the lobe before had not.
double angles_time_s(double texels) {
  return 9e-8 * texels;
}

// Finding the texels that outshine the mean, and how far the harmonics of the rest are off.
double parting_time_s(const envmap::Environment& env) {
  return 3e-8 * count(env);
}

// The bright texels one by one: as their middles for exponent 1, else as four points with a power.
double bright_time_s(double bright, double exponent, double texels) {
  return (exponent == 1 ? 8.5e-10 : 3.4e-9) * bright * texels;
}

// About how many texels of a cube of maps share their weights (strip_map.h).
double directions_alike(const envmap::Rotation& turn) {
  if (turn.is_identity()) return 16;
  return std::fabs(turn.to_environment({0, 1, 0}).y) > 1 - 1e-9 ? 8 : 2;
}

// Bands about as wide as a tolerance of 1e-5 wants them, texel by texel, and the rows that they cross. The deeper the
// tolerance, the wider is the band.
double horizon_time_s(const envmap::Environment& env, int degree, double tolerance, double texels, double alike) {
  const double reach = std::clamp(8 - 2 * std::log10(tolerance / 1e-5), 2.0, 40.0) / degree;
  const double weigh = 1.7e-8 * HorizonBand::texels_beside(env, reach) + 6e-8 * env.height();
  if (env.grid().is_cube()) return weigh * texels;
  return (weigh / alike + 1e-9 * HorizonBand::texels_beside(env, reach)) * texels;
}

// A sharp lobe cuts few texels into many cells, or into the pieces of a quadrature of its own (lobe_patch.cpp); a wide
// one walks along its horizon.
double blocks_time_s(const envmap::Environment& env, double exponent, double texels) {
  const bool by_pieces =
      env.layout() == envmap::Environment::Layout::kLatLong && 2 * env.largest_texel_rad() * std::sqrt(exponent) > 0.5;
  return (exponent > 100 ? (by_pieces ? 1.4e-4 : 6e-2) : 8e-5 * env.width()) * texels;
}

// The weights of the texels, in pieces of 8 x 8 nodes, are found once for all directions that lie alike to the texels.
double local_time_s(const envmap::Environment& env, double exponent, double texels, double alike) {
  const double pieces = std::max(1.0, kPi / env.height() * std::sqrt(exponent) / 1.3);
  return LocalSums::texels_within(env, exponent) * (3e-7 * pieces * pieces / alike + 1e-9) * texels;
}

// A cell costs its own corners, the sides of texels that cross it and the texels themselves.
double mirror_time_s(const envmap::Environment& env, double texels, bool symmetric) {
  const double across = std::sqrt(count(env) / 2 / (texels / 6)) / 2;  // texels of the environment across a cell
  return (1.4e-6 + 8.8e-7 * across + 4.3e-7 * across * across) * texels / (symmetric ? 12 : 1);
}

// Degrees that lobes with a kink turn out to take in maps that are nowhere very dark.
int usual_degree(int most, double tolerance) {
  return std::clamp(static_cast<int>(64 * std::sqrt(1e-3 / tolerance)), 64, most);
}

}  // namespace

void predict_times(const envmap::Environment& env, const PrefilterRequest& request, std::vector<LobePlan>& plan) {
  using Method = LobePlan::Method;
  int highest = 0;
  for (const LobePlan& lobe : plan)
    if (lobe.method == Method::kHarmonics) highest = std::max(highest, lobe.degree);
  const double alike = directions_alike(request.turn);
  bool transformed = false, parted = false, rest_transformed = false;
  int angles_size = 0;
  double bright = 0;
  for (LobePlan& lobe : plan) {
    const envmap::SphereGrid grid = envmap::map_grid(request.layout, lobe.size);
    const double texels = static_cast<double>(grid.width()) * grid.height();
    double time_s = 0;
    if (lobe.method == Method::kHarmonics || lobe.method == Method::kBrightHarmonics ||
        lobe.method == Method::kHorizon) {
      if (angles_size != lobe.size) time_s += angles_time_s(texels);
      angles_size = lobe.size;
    }
    if (lobe.method == Method::kBrightHarmonics || lobe.method == Method::kHorizon) {
      if (!parted) time_s += parting_time_s(env), bright = static_cast<double>(bright_count(env));
      parted = true;
      time_s += bright_time_s(bright, lobe.exponent, texels);
    }
    switch (lobe.method) {
      case Method::kHarmonics:
        if (!transformed) time_s += transform_time_s(env, highest);
        transformed = true;
        time_s += evaluation_time_s(lobe.degree, texels);
        break;
      case Method::kBrightHarmonics:
        if (!rest_transformed) time_s += transform_time_s(env, lobe.degree);
        rest_transformed = true;
        time_s += evaluation_time_s(usual_degree(lobe.degree, request.tolerance), texels);
        // Half of the texels are done once more where little light is left of the tolerance.
        if (lobe.exponent < 1 && request.tolerance < 2e-3) time_s += blocks_time_s(env, lobe.exponent, texels / 2);
        break;
      case Method::kHorizon:
        if (!rest_transformed) time_s += transform_time_s(env, lobe.degree);
        rest_transformed = true;
        time_s +=
            evaluation_time_s(lobe.degree, texels) + horizon_time_s(env, lobe.degree, request.tolerance, texels, alike);
        break;
      case Method::kLocal:
        time_s += local_time_s(env, lobe.exponent, texels, alike);
        break;
      case Method::kBlocks:
        time_s += blocks_time_s(env, lobe.exponent, texels);
        break;
      case Method::kMirror:
        time_s += mirror_time_s(env, texels, mirror_is_symmetric(env, grid, request.turn));
        break;
    }
    lobe.predicted_time_s = time_s / threads();
  }
}

}  // namespace goniochrome::prefilter
