// Where the skin of a part ends: what a seam is made of. Internal to lib/mesh.
#pragma once

#include <array>
#include <vector>

#include "mesh/mesh.h"

namespace goniochrome::mesh {

// A face beside an edge: its smooth normals at both ends of the edge, and the way into the face.
struct RimFace {
  Vec3 normal0, normal1;
  Vec3 inward;  // unit, in the face, perpendicular to the edge
};

struct RimEdge {
  Vec3 p0, p1;
  std::vector<RimFace> faces;
};

struct Rim {
  std::vector<RimEdge> edges;
  int duplicate_faces = 0, non_manifold_edges = 0;
};

// The skin of a panel is what bends gently. It ends at open edges, at edges of more than two faces, and where it turns
// down into the gap: at folds of more than 30 degrees, and at bends of a radius below size/200, such as the first edge
// of a rounded or rolled border. Patches of less than a hundredth of the part's area are no skin. Only faces of the
// skin are listed. Vertices within a millionth of `size` are one.
Rim rim_of(const Mesh& mesh, const MeshPart& part, double size);

}  // namespace goniochrome::mesh
