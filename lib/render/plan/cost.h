// What shading costs, predicted: the arithmetic of both engines, counted, times the speed of this machine as measured.
#pragma once

#include "render/effects.h"

namespace goniochrome::render {

// Nanoseconds a point on one core of the machine the counts were taken on (2.6 GHz, AVX-512). goniochrome-theory(7),
// PLAN.
struct PointCounts {
  double tilts = 1;  // normals that lobes are drawn about, mean over the visible points
  int forms = 3;     // of the product that the operator stands for
};
double point_ns(const Scene& scene, const Effects& effects, Engine engine, const PointCounts& counts);

// What a textured point adds, whatever the engine; `lobes` of its texture.
double textured_point_ns(const Effects& effects, int lobes);

// What the colors of a color map add to a point under the scene's lights, whatever the engine.
double mapped_point_ns(const Effects& effects);

// Nanoseconds a pixel of the picture, whether the mesh is seen there or not.
double pixel_ns(Engine engine);

// What the GL engine costs once: compiling its program.
constexpr double kCompileMs = 110;

}  // namespace goniochrome::render
