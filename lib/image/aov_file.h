// The pictures that render-osmesa writes with --aov, read back: the picture itself, the buffers beside it (normals,
// angles, parts), and what the header tells of camera, lights and effects. goniochrome-sketches(7), "SKETCH FITTING".
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "base/vec3.h"
#include "color/reflection.h"
#include "image/exr.h"
#include "image/image.h"

namespace goniochrome::image {

// A lamp as the file tells it: the direction to it, the color of a white diffuser that faces it, and the angle that it
// spans, 0 for a point. Of a lamp at a place, all are those in the middle of the mesh, which is `distance` away.
struct AovLight {
  Vec3 direction, white{1, 1, 1};
  double extent_deg = 0;
  bool is_placed = false;
  Vec3 place = {};
  double distance = 0;
};

struct AovFile {
  std::string path;
  Image image;  // R G B A and the buffers; those of kPointsName last
  // From the file's header; where it does not tell them, the exposure is 0 and the white is 1.
  double exposure_stops = 0, white_luminance = 1;
  // Stops that bring the light of the buffers to the exposure of a PNG that is exposed automatically.
  double automatic_stops = 0;
  int samples = 1;               // in every pixel of the picture; the buffers have one, in the center of the pixel
  Vec3 light{0, 1, 0};           // the light that the buffers aspecular and lambert are relative to
  std::vector<AovLight> lights;  // all lights of the picture
  std::string environment;       // "" for none
  bool has_rays = false;
  std::optional<Vec3> eye;   // where the rays begin; files of earlier versions do not tell it
  Vec3 corner, right, down;  // the ray through x, y (pixels from the upper left) is corner + x right + y down
  std::vector<std::string> parts, materials;  // one material for each part, "" where the mesh named none
  std::vector<int> trim;                      // numbers, from 1, of the parts that --trim dressed
  std::string command;                        // the command that made the file
  std::vector<std::string> drawn;             // the effects that the picture shows, by render-osmesa's names
  std::vector<std::string> left_out;          // the effects that the scene has and the picture does not show
  // Those of them that the picture shows by tracing rays (shadow, self, bounce, floor), with what each is worth, as in
  // "shadow (dE00 6.2), bounce (dE00 1.3)"; "" for none. A pixel's color is then not told by its normal alone.
  std::string drawn_by_rays;
  color::ReflectionOperator reflection = color::iso_rgb_operator();  // with which the effect "operator" was drawn
  std::string transport;  // what the header says of a transport, JSON; "" where the file has none
  ExrPart layer;          // the parts after the picture: those of a transport

  // The channel's place in a pixel. Error: the file lacks it; the message has the command that makes it.
  Result<int> channel(const std::string& name) const;
  // The unit direction to the viewer at the center of a pixel, or beside it.
  Vec3 to_viewer(double x, double y) const { return -normalized(corner + (x + 0.5) * right + (y + 0.5) * down); }
  // The number, from 1, of the part that has that name. Error: the names that there are.
  Result<int> part(const std::string& name) const;
};

// AovFile::drawn_by_rays of a picture that was read without its buffers; "" where it does not tell.
std::string drawn_by_rays(const ImagePart& picture);
// True where the effect of that name is in AovFile::drawn of such a picture.
bool is_drawn(const ImagePart& picture, const std::string& effect);
// AovFile::left_out of such a picture; nothing where it does not tell.
std::optional<std::vector<std::string>> left_out(const ImagePart& picture);

// The part beside the picture that has the normals and the parts of a transport's points.
inline constexpr const char* kPointsName = "points";

// The file, or of its picture and buffers only the channels named, in that order and as far as it has them. Error: it
// is not an EXR file, or its header is not one that render-osmesa writes.
Result<AovFile> read_aov_file(const std::string& path, const std::vector<std::string>& channels = {});

}  // namespace goniochrome::image
