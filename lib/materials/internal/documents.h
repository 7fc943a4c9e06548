// Documents with one shader and its material: MaterialX and USD.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "materials/material.h"

namespace goniochrome::materials {

// The inputs of a shader, in order: a name, and one number or three.
using ShaderInputs = std::vector<std::pair<const char*, std::vector<double>>>;

// A document of MaterialX of that version, with the shader `kind` in linear Rec.709.
std::string mtlx_of_shader(const char* kind, const char* version, const ShaderInputs& inputs, const Naming& naming);

// A layer of USD. `terminal` is the output of the material that the shader feeds: "surface" or "mtlx:surface". `more`
// are further lines of the shader, which are not numbers.
std::string usda_of_shader(const char* id, const char* terminal, const std::string& more, const ShaderInputs& inputs,
                           const Naming& naming);

// A text between quotes, in one line.
std::string quoted(const std::string& text);

}  // namespace goniochrome::materials
