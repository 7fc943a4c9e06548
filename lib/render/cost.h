// What shading costs, predicted: the arithmetic of both engines, counted, times the speed of this machine as measured.
#pragma once

#include "render/effects.h"

namespace goniochrome {

// Nanoseconds a point on one core of the machine the counts were taken on (2.6 GHz, AVX-512). goniochrome-theory(7),
// PLAN. `tilts` is the mean number of tilted normals of a visible point.
double point_ns(const Effects& effects, Engine engine, double tilts);

// What a textured point adds, whatever the engine; `lobes` of its texture.
double textured_point_ns(const Effects& effects, int lobes);

// Nanoseconds a pixel of the picture, whether the mesh is seen there or not.
double pixel_ns(Engine engine);

// What the GL engine costs once: compiling its program.
constexpr double kCompileMs = 110;

}  // namespace goniochrome
