// Warnings about how an image of light was read.
#pragma once

#include <string>
#include <vector>

#include "envmap/environment.h"

namespace goniochrome::envmap {

// Light in the corners of an angular probe, texels that were replaced, and colors that were clipped: a line each.
std::vector<std::string> remarks(const Environment& env);

}  // namespace goniochrome::envmap
