// How a texture is laid on a part of a mesh that has no texture coordinates of its own, or not the right ones.
// goniochrome-surfaces(7), "Projections".
#pragma once

#include "base/vec3.h"
#include "render/gbuffer.h"

namespace goniochrome::render {

enum class Projection {
  kOwn,       // the mesh's own coordinates; around the vertical axis where it has none
  kPlanar,    // along the axis, from both sides
  kBox,       // along the coordinate axis that is nearest to the normal
  kCylinder,  // around the axis
  kSphere,    // around the axis by longitude and latitude
  kDecal,     // along the axis, once and from one side; elsewhere, nothing or the texels of the edge
  kFacet,     // along one coordinate axis, with a share that grows as the normal comes near to it
};

struct TextureLaying {
  Projection projection = Projection::kOwn;
  Vec3 axis = {0, 1, 0};  // unit; from the surface toward who looks at the texture, or around which it is laid
  Vec3 center;            // where the middle of the texture lies
  double width = 1;       // of one repetition, in units of the mesh: planar, box and decal
  double aspect = 1;      // the height of the texture over its width
  double turn_rad = 0;    // of the texture about the axis, counterclockwise for who looks at it
  double around = 1;      // how often it is repeated around the axis, a whole number: cylinder and sphere
  double radius = 1;      // at which its texels are squares: cylinder
  double half_texel_u = 0, half_texel_v = 0;  // half of a texel, from which a decal keeps to its edge
  bool ends = false;                          // whether a decal shows nothing beyond its edge
  int facet = 0;                              // the coordinate axis: 0 to 2
};

// The fourth powers of the normal's components, of sum 1: the shares of the three facets of a triplanar projection.
Vec3 facet_shares(const Vec3& normal);

// The directions in which u and v grow for who looks along -axis: across x up = axis. Up is +Y, or -Z where the axis is
// nearly vertical and points up, +Z where it points down.
struct TextureAxes {
  Vec3 across, up;
};
TextureAxes texture_axes(const Vec3& axis, double turn_rad);

// The place of a point on its texture, and the tangent along growing u. Normal x tangent is the direction of growing v
// wherever the surface can be seen, so that no texture is mirrored.
TexturePlace projected(const TextureLaying& laying, const Vec3& position, const Vec3& normal);

}  // namespace goniochrome::render
