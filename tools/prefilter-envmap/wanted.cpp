#include "wanted.h"

#include <algorithm>
#include <bit>
#include <map>

#include "base/angles.h"
#include "base/text.h"
#include "envmap/mip.h"
#include "formats/default_basis.h"
#include "formats/paint_source.h"

namespace goniochrome::tool {

namespace {

constexpr double kLeastTolerance = 1e-6;  // a float is rounded by 6e-8, and the reference is good to 1e-8

double largest(const color::Rgb& weights) {
  return std::max({weights[0], weights[1], weights[2]});
}

// The reflectance of a lobe in a constant environment at normal incidence: its weight times 2 pi/(E+1), and for the
// mirror its weight alone.
double reflectance(const paint::Lobe& lobe) {
  const double weight = largest(lobe.directional_diffuse) + largest(lobe.gloss);
  return lobe.is_mirror() ? weight : weight * 2 * kPi / (lobe.exponent + 1);
}

// The largest share of a paint's reflectance that each exponent has, over paints and views.
void add_shares(const color::Rgb& diffuse, const std::vector<paint::Lobe>& lobes, std::map<double, double>& shares) {
  double all = kPi * largest(diffuse);
  for (const paint::Lobe& lobe : lobes) all += reflectance(lobe);
  for (const paint::Lobe& lobe : lobes) {
    double& share = shares[lobe.exponent];
    if (all > 0) share = std::max(share, reflectance(lobe) / all);
  }
}

Result<void> want_those_of_paints(const Options& options, Wanted& wanted) {
  GONIO_ASSIGN(const formats::PaintSourcePointer source, formats::open_paints(options.paints));
  std::map<double, double> shares;
  for (;;) {
    GONIO_ASSIGN(const std::optional<paint::Paint> paint, source->next());
    if (!paint) break;
    ++wanted.paints;
    if (!paint->lobes)
      return input_error("{}: paint {} has no lobes: fit it with fit-paint", source->place(), paint->name);
    add_shares(paint->lobes->diffuse, paint->lobes->lobes, shares);
    for (const paint::ViewLobes& view : paint->lobes->views) add_shares(view.diffuse, view.lobes, shares);
    for (const paint::TiltedLobes& set : paint->lobes->tilts)
      for (const paint::TiltedLobe& lobe : set.lobes) shares[lobe.exponent] = 1;  // none of them can be missing
  }
  if (wanted.paints == 0) return input_error("{}: holds no paint: name paints that have lobes", options.paints);
  wanted.request.mirror = false;
  for (const auto& [exponent, share] : shares) {
    if (share <= wanted.request.tolerance)
      wanted.left_out.push_back({exponent, share});
    else if (paint::is_mirror(exponent))
      wanted.request.mirror = true;
    else
      wanted.request.exponents.push_back(exponent);
  }
  return {};
}

Result<void> set_geometry(const Options& options, prefilter::PrefilterRequest& request) {
  using Layout = envmap::SphereGrid::Layout;
  if (options.size != "auto") {
    const auto size = parse_integer(options.size);
    if (!size || *size < 1 || *size > 8192)
      return usage_error("--size is \"{}\": give auto or the texels along a face, 1 to 8192", options.size);
    request.size = static_cast<int>(*size);
  }
  if (options.layout == "openexr" && request.size == 1)
    return usage_error("--size 1 with --layout openexr: texel centers on the edges take a size of 2 or more");
  request.layout = options.layout == "latlong"   ? Layout::kLatLong
                   : options.layout == "openexr" ? Layout::kCubeEdges
                                                 : Layout::kCube;
  const std::vector<double>& turn = options.rotate;
  if (turn.size() > 3)
    return usage_error("--rotate has {} angles: give one to three, about +Y, +X and +Z", turn.size());
  const auto angle = [&](std::size_t i) { return i < turn.size() ? turn[i] * kDegree : 0; };
  request.spots = options.spots;
  request.turn = envmap::Rotation::about_axes(angle(0), angle(1), angle(2));
  return {};
}

// The levels of the mip-mapped cube, in place of diffuse lobe, lobes and mirror.
Result<void> set_levels(const Options& options, prefilter::PrefilterRequest& request) {
  if (request.exponents.empty())
    return usage_error("--layout {} without an exponent: give --exponents or --basis", options.layout);
  const double sharpest = *std::max_element(request.exponents.begin(), request.exponents.end());
  int size =
      request.size > 0
          ? request.size
          : static_cast<int>(std::bit_ceil(static_cast<unsigned>(prefilter::own_size(sharpest, request.tolerance))));
  GONIO_ASSIGN(request.exponents, envmap::mip_exponents(request.exponents, size));
  for (std::size_t i = 0; i < request.exponents.size(); ++i, size /= 2) request.sizes.push_back(size);
  request.diffuse = request.mirror = false;
  return {};
}

}  // namespace

bool has_levels(const Options& options) {
  return options.layout == "mip" || options.layout == "ktx2" || options.layout == "dds";
}

Result<Wanted> wanted_lobes(const Options& options) {
  if (int(!options.basis.empty()) + int(!options.exponents.empty()) + int(!options.paints.empty()) > 1)
    return usage_error("--basis, --exponents and --for exclude each other: give one of them");
  Wanted wanted;
  prefilter::PrefilterRequest& request = wanted.request;
  request.tolerance = options.common.tolerance;
  if (!(request.tolerance >= kLeastTolerance && request.tolerance < 1))
    return usage_error("--tolerance is {}: give {} or more, and less than 1", shortest(request.tolerance),
                       shortest(kLeastTolerance));
  GONIO_TRY(set_geometry(options, request));
  request.exponents = options.exponents;
  if (!options.paints.empty()) {
    GONIO_TRY(want_those_of_paints(options, wanted));
  } else if (options.exponents.empty()) {
    GONIO_ASSIGN(const formats::Basis basis, formats::basis_or_default(options.basis));
    request.exponents = basis.exponents;
  }
  if (options.no_mirror) request.mirror = false;
  const bool levels = has_levels(options);
  request.exponents = prefilter::filter_exponents(std::move(request.exponents), !levels);
  if (levels) GONIO_TRY(set_levels(options, request));
  return wanted;
}

}  // namespace goniochrome::tool
