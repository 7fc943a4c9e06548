// The seam between two parts of a mesh: where their edges face each other, how wide the gap between them is, and how
// far one panel stands above the other or turns away from it. goniochrome-panels(7), "GONIOGEOMETRIC INDEX".
#pragma once

#include <string>
#include <vector>

#include "base/result.h"
#include "mesh/mesh.h"

namespace goniochrome::mesh {

// One place at the seam, on an edge of the first part and at the nearest point of an edge of the second. World axes.
struct SeamPoint {
  Vec3 a, b;                // in the units of the mesh
  Vec3 normal_a, normal_b;  // smooth, unit, outward
  Vec3 along;               // unit, the direction of the edge of the first part
  Vec3 across;              // unit, in the first panel's plane, toward the second panel
  double distance_m = 0;    // along the seam from the beginning of its run
  int run = 0;              // a seam that is interrupted has several runs
  double gap_mm = 0;        // between the ends of the skins, in the first panel's plane
  double flush_mm = 0;      // the second edge above (+) or below (-) the first panel
  double angle_deg = 0;     // between the normals
  double fold_deg = 0;      // its part about the seam: positive where the panels form a ridge, negative for a valley
};

struct Seam {
  std::vector<SeamPoint> points;  // in order along each run
  double unit_m = 1;              // of the mesh
  bool unit_guessed = false;
  double length_m = 0;
  struct Repairs {
    int duplicate_faces = 0;     // left out
    int non_manifold_edges = 0;  // edges of more than two faces, taken as edges of the panel
    int turned = 0;              // sides of edges whose normals pointed inward and were turned
  } repairs;
  int not_continued = 0;  // places left out because the surfaces stand at more than 30 deg to each other
};

struct SeamOptions {
  double unit_m = 0;      // length of one unit of the mesh; 0: the likely one of mesh/unit.h
  double max_gap_mm = 0;  // wider gaps are no seam; 0: one part in a hundred of the mesh's size
};

// The panels meet where their skins end: at open edges, at folds, and where they bend down into the gap; a rolled
// border belongs to the gap. Points lie a thousandth of the mesh's size apart. Each point pairs with the nearest edge
// of the other part, provided that this edge's nearest point is near it in turn, and that the surfaces on both sides
// can be seen from outside. Error: a part that is not known (with the names that there are), the same part twice, a
// part without edges, parts that do not touch (with the gap), or a seam that is hidden everywhere.
Result<Seam> seam_between(const Mesh& mesh, const std::string& part_a, const std::string& part_b,
                          const SeamOptions& options = {});

}  // namespace goniochrome::mesh
