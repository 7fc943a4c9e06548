// The contents of a pixel of a picture with buffers: the part, how it lies to viewer and lights, and its color.
#pragma once

#include <string>
#include <vector>

#include "base/result.h"
#include "base/vec3.h"
#include "color/color.h"
#include "image/aov_file.h"

namespace goniochrome::sketch {

struct Probe {
  int x = 0, y = 0;
  bool on_mesh = false;
  std::string part, material;  // "" beside the mesh
  // On the mesh alone:
  Vec3 normal;          // unit, turned to the viewer
  double view_deg = 0;  // of the viewer from the normal
  // The angle between the mirror direction of the viewer and each light of the picture, 0..180; where it has no lights,
  // one angle, to where the environment's irradiance is largest.
  std::vector<double> aspecular_deg;
  color::Rgb rgb;  // radiance of the pixel, without the exposure of the file
  color::Lab lab;  // of it, relative to D65 of the brightest that a white diffuser can be in this light
};

// The pixel in that column and row, from 0. Error: it lies outside of the picture, or the file lacks the buffers normal
// and part; the message has the command that makes them.
Result<Probe> probe(const image::AovFile& file, int x, int y);

}  // namespace goniochrome::sketch
