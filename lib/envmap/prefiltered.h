// A prefiltered environment (`*.env.exr`) has one map for each lobe, with the error that was measured.
// goniochrome-prefiltering(7), "PREFILTERING"; the file format is in goniochrome-paint(5).
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "base/result.h"
#include "envmap/bright_spots.h"
#include "envmap/cube_map.h"
#include "envmap/sphere_grid.h"
#include "image/image.h"
#include "paint/paint.h"

namespace goniochrome::envmap {

// P_E = (E+1)/(2 pi) * integral of L(w) max(0, d.w)^E dw: a constant map stays itself.
struct PrefilteredLobe {
  double exponent = 1;
  CubeMap map;  // in another layout it holds the texels row by row, and N of N x 6N or 2N x N texels
  SphereGrid::Layout layout = SphereGrid::Layout::kCube;
  double tolerance = 0;                  // asked for; relative
  double max_error = 0, mean_error = 0;  // measured on the verified texels; relative
  int verified_texels = 0;
  double predicted_error = 0;                // of the stored texels; relative
  double lookup_error = 0;                   // what a bilinear lookup between them adds; relative
  std::string method;                        // how it was computed
  std::shared_ptr<const CubeMap> open = {};  // the map without the bright spots; null where it was not made

  // The root of what the lobe gathers of the squared radiance that the bright spots leave, in texels of its own; null
  // where it was not made. goniochrome-flakes(7)
  std::shared_ptr<const CubeMap> rms = {};

  bool is_mirror() const { return paint::is_mirror(exponent); }
};

// The texels of a map: N along a face, or N rows of a lat-long map.
SphereGrid map_grid(SphereGrid::Layout layout, int n);

// How write_env() stores a lobe: halves where every value keeps half the tolerance, else floats.
image::PixelType storage_type(const PrefilteredLobe& lobe);

// Rounds every value to what the file will hold, so that memory and file agree: to a half, or to as many bits of a
// float as 1/64 of the tolerance needs (the zero bits left over compress well).
void round_to_storage(PrefilteredLobe& lobe);

struct PrefilteredEnvironment {
  PrefilteredLobe diffuse;             // exponent 1: pi P_1(n) is the irradiance; size 0 where absent
  std::vector<PrefilteredLobe> lobes;  // ascending exponents
  PrefilteredLobe mirror;              // the environment itself, exponent inf; size 0 where absent
  std::string source;
  std::vector<Spot> spots;  // the bright part of the light in the maps, once more; none where it is not known
  // The diffuse map under a coat, with and without the bright spots; null where they were not made.
  std::shared_ptr<const CubeMap> coat_diffuse = {}, open_coat_diffuse = {};

  // The lobe of this exponent (to 1e-6 relative), or null.
  const PrefilteredLobe* lobe(double exponent) const;
};

// Reads parts diffuse, lobe-NNN and mirror, or the levels of a mip-mapped cube. Of the lobes and the mirror it reads
// only those whose exponent is wanted; without the function it reads all. Error: the part, and what is wrong. Maps that
// follow from others, see open_maps.h, are read where the file has them in a version that is known here.
Result<PrefilteredEnvironment> read_env(const std::string& path,
                                        const std::function<bool(double exponent)>& is_wanted = {});

// Writes the parts; half floats unless a value or the tolerance needs float. `command` is kept for provenance. Lat-long
// maps and cubes with texel centers on the edges are written by OpenEXR's own conventions, tagged `envmap`. Maps that
// follow from others are written where they were made, by parts that readers which do not know them pass over.
Result<void> write_env(const std::string& path, const PrefilteredEnvironment& env, const std::string& command);

}  // namespace goniochrome::envmap
