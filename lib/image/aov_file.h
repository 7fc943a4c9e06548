// The picture with buffers that render-osmesa --aov writes, read back. goniochrome-theory(7), SKETCH FITTING.
#pragma once

#include <string>
#include <vector>

#include "base/result.h"
#include "base/vec3.h"
#include "color/reflection.h"
#include "image/image.h"

namespace goniochrome::image {

// A directional light as the file tells it: the way to it, and what a white diffuser that faces it shows.
struct AovLight {
  Vec3 direction, white{1, 1, 1};
};

struct AovFile {
  std::string path;
  Image image;  // R G B A and the buffers
  // Of the file's header; a file that does not say has exposure 0 and white 1.
  double exposure_stops = 0, white_luminance = 1;
  int samples = 1;               // of every pixel of the picture; the buffers are of the centers
  Vec3 light{0, 1, 0};           // that aspecular and lambert are relative to
  std::vector<AovLight> lights;  // all there were
  std::string environment;       // "" for none
  bool has_rays = false;
  Vec3 corner, right, down;  // the ray through the point (x, y), pixels from the upper left: corner + x right + y down
  std::vector<std::string> parts, materials;  // one material for each part, "" where the mesh named none
  std::string command;                        // that made the file
  std::vector<std::string> drawn;             // effects of the picture, by render-osmesa's names
  std::vector<std::string> left_out;          // and those that the scene has and the picture does not
  color::ReflectionOperator reflection = color::iso_rgb_operator();  // by which the effect "operator" was drawn

  // The channel's place in a pixel. Error: the file lacks it, with the command that makes it.
  Result<int> channel(const std::string& name) const;
  // The unit direction to the viewer at the center of a pixel, or beside it.
  Vec3 to_viewer(double x, double y) const { return -normalized(corner + (x + 0.5) * right + (y + 0.5) * down); }
  // The number of the part of that name, from 1. Error: the names there are.
  Result<int> part(const std::string& name) const;
};

// Error: not an EXR, or a header that says something else than render-osmesa writes.
Result<AovFile> read_aov_file(const std::string& path);

}  // namespace goniochrome::image
