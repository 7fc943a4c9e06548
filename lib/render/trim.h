// Finishes of the parts of a vehicle that nobody paints: glass, rubber, seams, wheels and the underside.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "mesh/mesh.h"
#include "paint/paint.h"

namespace goniochrome::render {

enum class TrimKind : std::uint8_t { kGlass, kBlack, kMetal };
inline constexpr std::array kTrimKinds = {TrimKind::kGlass, TrimKind::kBlack, TrimKind::kMetal};

// The kind of a part that nobody paints, by the words in its name, or else in its material, whatever their case, or
// else by the look of that material:
//   glass, window, windshield, windscreen, or clear
//   black: tire, tires, tyre, tyres, rubber, seam, seams, underbody, underside
//   metal: rim, rims, wheel, wheels, chrome, metal, or polished metal
// Words are separated by anything that is not a letter, and by a capital behind a small letter or before one:
// WindowGlass1 has the words window and glass. Glass behind "fiber" is none, and a name with paint, painted, carpaint
// or body is that of a painted part, whatever its material looks like. Nothing where none of these is found.
std::optional<TrimKind> trim_kind(const mesh::MeshPart& part);

// The finish of such parts: glass is black under a coat that mirrors, black reflects 3 %, and metal is a gray of 20 %
// under a coat that mirrors. It has no lobes but the mirror, and that only `with_mirror`, so that any prefiltered
// environment shows it.
paint::LobeFit trim_finish(TrimKind kind, bool with_mirror);
std::optional<paint::LobeFit> trim_of(const mesh::MeshPart& part, bool with_mirror);

}  // namespace goniochrome::render
