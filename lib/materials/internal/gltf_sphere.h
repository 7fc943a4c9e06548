// A file of glTF 2.0 with a sphere that wears one material.
#pragma once

#include <string>

#include "base/json.h"
#include "materials/material.h"

namespace goniochrome::materials {

// The text of the file.
std::string gltf_sphere(const Json& material, const Naming& naming);

// Extras of a material for people: its identifier and its distance from the paint.
Json gltf_extras(const Naming& naming, const Shown& shown);

}  // namespace goniochrome::materials
