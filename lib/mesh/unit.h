// The unit of length of a mesh, also where its file does not state one.
#pragma once

#include <string_view>

#include "mesh/mesh.h"

namespace goniochrome::mesh {

struct LengthUnit {
  const char* name;  // in the plural, as in "taken as millimeters"
  double meters;
};

// The unit that a mesh of this size is taken to be in, by the diagonal of its box: meters up to 30 of them; inches, of
// which a car has some 200, up to 300; centimeters, of which it has some 500, up to 900; and millimeters above. A small
// part can be taken for a larger one of another unit, so that a tool must tell what it has taken.
LengthUnit likely_unit(const Box& box);

// The meters of one unit of length that the comments of an OBJ or PLY, or the header of an STL state, as in
// `# File units = inches`; 0 where none does.
double stated_unit_m(std::string_view content);

// The unit that the file of a mesh states, or else the likely one.
LengthUnit length_unit(const Mesh& mesh);

// The unit of that many meters, one of those above.
LengthUnit unit_of(double meters);

}  // namespace goniochrome::mesh
