// Filters an environment by every lobe of a basis, each by the cheapest method that keeps the tolerance. The lobes are
// cosine powers, because paints are, and any other zonal kernel on request.
// goniochrome-prefiltering(7), "PREFILTERING".
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "envmap/environment.h"
#include "envmap/prefiltered.h"

namespace goniochrome::prefilter {

class ZonalKernel;  // internal/kernel.h
using KernelPointer = std::shared_ptr<const ZonalKernel>;

struct PrefilterRequest {
  std::vector<double> exponents;  // finite, >= 0; the diffuse lobe (1) comes by itself
  bool mirror = true;
  int size = 0;             // of every face; 0 chooses each lobe's own
  double tolerance = 1e-3;  // relative to the larger of the local value and 1e-3 of the mean
  envmap::SphereGrid::Layout layout =
      envmap::SphereGrid::Layout::kCube;    // of the maps: a cube of either kind, or lat-long
  envmap::Rotation turn = {};               // of the environment
  std::vector<int> sizes = {};              // of each exponent's map; empty: `size` says it
  bool diffuse = true;                      // false: not by itself
  int spots = envmap::kUsualSpots;          // bright spots at most
  std::vector<KernelPointer> kernels = {};  // more lobes, which follow those of the exponents
};

// Exponents as a request has them: ascending, each once, and without 1 where the diffuse lobe, which has it, comes by
// itself.
std::vector<double> filter_exponents(std::vector<double> exponents, bool diffuse = true);

// How a lobe will be computed.
struct LobePlan {
  enum class Method {
    kHarmonics,        // zonal harmonics with a bound on what is left out
    kBrightHarmonics,  // the same for the rest after the brightest texels; texels beyond the bound by blocks
    kHorizon,  // exponents up to 1: harmonics of a smoother kernel, bands beside the horizon, the brightest texels
    kLocal,    // sums over the texels that a sharp lobe reaches
    kBlocks,   // the tree of texel blocks
    kMirror,   // exact overlaps
  };
  double exponent = 1;        // of the kernel; of one that is no cosine power, of the power that is as sharp
  KernelPointer kernel = {};  // none: the mirror
  int size = 0;
  Method method = Method::kHarmonics;
  int degree = 0;              // of the harmonics
  double predicted_error = 0;  // relative, as the tolerance; with the rounding of the file
  double predicted_time_s = 0;
  double lookup_error = 0;  // what a bilinear lookup adds, typically: E h^2/8
};
const char* method_name(LobePlan::Method method);

// The size of face that a bilinear lookup of a lobe needs to err by no more than ten times the tolerance.
int own_size(double exponent, double tolerance);

// The plan of a request: diffuse first, then the exponents and the other kernels as given, then the mirror.
std::vector<LobePlan> prefilter_plan(const envmap::Environment& env, const PrefilterRequest& request);

// The lobe of a plan that is there already, or nothing. It is asked for cosine powers and the mirror alone, since a
// file names a lobe by its exponent.
using LobeSource = std::function<std::optional<envmap::PrefilteredLobe>(const LobePlan&)>;

// Carries a plan out, but for the lobes that `known` has. `done` is called after each lobe with the time that it took,
// in seconds. The maps are as the file will hold them (round_to_storage()). Bit-identical for any number of threads.
envmap::PrefilteredEnvironment prefiltered(
    const envmap::Environment& env, const PrefilterRequest& request, const std::vector<LobePlan>& plan,
    const std::function<void(const envmap::PrefilteredLobe&, double time_s)>& done, const LobeSource& known = {});

// The flux of a map over that of the environment, all channels together; 1 when nothing is lost. 1 where there is
// no light.
double energy_ratio(const Vec3& flux, const envmap::PrefilteredLobe& lobe);

}  // namespace goniochrome::prefilter
