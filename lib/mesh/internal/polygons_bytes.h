// Polygons as bytes, in which a child process hands over what a library has read.
#pragma once

#include <string>
#include <string_view>

#include "base/child.h"
#include "base/result.h"
#include "mesh/internal/polygons.h"

namespace goniochrome::mesh {

// Writes the polygons. It throws std::bad_alloc where there is no memory for them.
void put(ChildOutput& output, const Polygons& polygons);

// The polygons that put() wrote in a child. The bytes are not trusted: every index is within its array and every
// position is finite, or it is an error about `path`.
Result<Polygons> polygons_of_bytes(std::string_view bytes, const std::string& path);

}  // namespace goniochrome::mesh
