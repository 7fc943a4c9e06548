// Shading of spatially varying surfaces under lights and a prefiltered environment. goniochrome-theory(7), SPATIALLY
// VARYING SURFACES; [McAllister2002] 4.1 and 6.1
#pragma once

#include <vector>

#include "base/result.h"
#include "brdf/sbrdf.h"
#include "envmap/prefiltered.h"
#include "render/scene.h"

namespace goniochrome {

// Lobe maps in one cube with levels: a quarter of the exponent and half the texels at each step from the finest.
struct MipCube {
  double finest_exponent = 1;
  std::vector<CubeMap> levels;  // sharpest first
};

// Made from an environment that holds such a chain of exponents. Error: the exponents that are missing, and the command
// that makes them.
Result<MipCube> mip_cube(const PrefilteredEnvironment& env);

// Shades under an environment and lights. With `mip` lobes are fetched there (trilinearly), else from the environment's
// own maps, two neighbors in exponent blended. Both may be null, and must outlive the shader.
class SbrdfShader {
 public:
  SbrdfShader(const PrefilteredEnvironment* env, const MipCube* mip, std::vector<Light> lights,
              const ReflectionOperator& reflection = component_wise());

  // Radiance in the working space toward `to_viewer` (unit, world), of a surface with unit normal and tangent; the
  // tangent is made perpendicular. 0 seen from below.
  Rgb shade(const SbrdfTexel& texel, const Vec3& normal, const Vec3& tangent, const Vec3& to_viewer) const;

  // The same at a place of a texture: its four texels shaded and blended.
  Rgb shade(const SbrdfTexture& texture, double u, double v, const Vec3& normal, const Vec3& tangent,
            const Vec3& to_viewer) const;

 private:
  Vec3 filtered(double exponent, const Vec3& direction) const;  // P_n

  const PrefilteredEnvironment* env_;
  const MipCube* mip_;
  std::vector<Light> lights_;
  ReflectionOperator reflection_;
  std::vector<double> exponents_;  // of the maps, ascending; the diffuse map is the lobe of exponent 1
  std::vector<const CubeMap*> maps_;
};

}  // namespace goniochrome
