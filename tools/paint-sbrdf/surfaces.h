// The surfaces that a map is made of: paints, maps and pictures.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "brdf/lobe_surface.h"
#include "cli/tool.h"
#include "image/image.h"
#include "tool.h"

namespace goniochrome::tool {

// One of them. A paint is the same everywhere; maps and pictures have texels, and repeat.
struct Surface {
  std::string name;
  std::string kind;                               // "paint", "map", "picture" or "nothing"
  brdf::LobeSurface paint;                        // of a paint
  std::shared_ptr<const brdf::SbrdfTexture> map;  // of a map
  std::shared_ptr<const image::Image> picture;    // of a picture: reflectances
  double strength_error = 0;                      // of the gloss of a paint, see brdf::PaintedSurface

  int width() const { return map ? map->width : picture ? picture->width : 0; }  // 0: the same everywhere
  int height() const { return map ? map->height : picture ? picture->height : 0; }
  // The most lobes of a texel.
  int lobes() const { return map ? map->lobes : static_cast<int>(paint.lobes.size()); }
  brdf::LobeSurface texel(int column, int row) const;
  Vec3 normal(int column, int row) const;
  // The part of what lies beneath that it covers there.
  double alpha(int column, int row) const;
};

struct Surfaces {
  std::vector<Surface> all;
  double mirror_exponent = 0;  // that mirrors become
  std::string basis;           // of the paints; "" where there are none
};

// The surfaces that the command line names, in order. FILE#NAMES that means several paints is as many surfaces. Error:
// a paint that has no lobes, is brushed, or was fitted with another basis; a file that is none of these.
Result<Surfaces> read_surfaces(const Options& options, cli::Session& session);

}  // namespace goniochrome::tool
