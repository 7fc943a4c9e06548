// The Enterprise PBR Shading Model of Dassault Systemes, 2022x, as far as paints need it: opaque and thin-walled,
// without sheen, flakes and anisotropy.
#pragma once

#include "materials/internal/one_lobe.h"

namespace goniochrome::materials {

// Its reflectance along the normal, F_0 times the specular tint. An index of refraction of 38 has the most, 0.9.
color::Rgb enterprise_normal_reflectance(const OneLobe& p);

// f in 1/sr, Rec.709. base is the albedo, strength the parameter "specular".
color::Rgb enterprise_seen(const OneLobe& p, const Vec3& to_light, const Vec3& to_viewer);

}  // namespace goniochrome::materials
