#include "render/gl/exact_lookups.h"

#include <string_view>

namespace goniochrome::render {

namespace {

// The text that the generator of programs writes where a cube map is looked up, and its replacement.
constexpr std::string_view kLookup = "textureLod(", kExact = "exact_lookup(";

// A face is a square from -1 to 1 in p, before the eye at a distance of 1 along its axis. Each of the four texels is
// asked for by the direction of its center, where the nearest texel is the one that is meant, however a GPU rounds. The
// center of the texel beside an edge of the face lies on the neighboring face: there the coordinate that left the face
// is 1, and what was the axis has become a coordinate of the neighbor, half a texel from its edge.
constexpr std::string_view kFunctions = R"(
vec4 texel_toward(samplerCube map, vec3 axis, vec3 across, vec3 along, vec2 p, float texel) {
  float depth = 1.0;
  if (abs(p.x) > 1.0) {
    p.x = sign(p.x);
    depth -= texel;
  } else if (abs(p.y) > 1.0) {
    p.y = sign(p.y);
    depth -= texel;
  }
  return textureLod(map, depth * axis + p.x * across + p.y * along, 0.0);
}

vec4 exact_lookup(samplerCube map, vec3 d, float level) {
  vec3 size = abs(d), axis, across, along;
  vec2 p;
  if (size.x >= size.y && size.x >= size.z) {
    axis = vec3(sign(d.x), 0.0, 0.0), across = vec3(0.0, 1.0, 0.0), along = vec3(0.0, 0.0, 1.0), p = d.yz / size.x;
  } else if (size.y >= size.z) {
    axis = vec3(0.0, sign(d.y), 0.0), across = vec3(1.0, 0.0, 0.0), along = vec3(0.0, 0.0, 1.0), p = d.xz / size.y;
  } else {
    axis = vec3(0.0, 0.0, sign(d.z)), across = vec3(1.0, 0.0, 0.0), along = vec3(0.0, 1.0, 0.0), p = d.xy / size.z;
  }
  float n = float(textureSize(map, 0).x), texel = 1.0 / n;
  vec2 at = clamp(0.5 * n * (p + 1.0) - 0.5, -0.5, n - 0.5), whole = floor(at), part = at - whole;
  vec2 low = (2.0 * whole + 1.0) * texel - 1.0, high = low + 2.0 * texel;
  vec4 a = texel_toward(map, axis, across, along, low, texel);
  vec4 b = texel_toward(map, axis, across, along, vec2(high.x, low.y), texel);
  vec4 c = texel_toward(map, axis, across, along, vec2(low.x, high.y), texel);
  vec4 e = texel_toward(map, axis, across, along, high, texel);
  bool before_x = whole.x < 0.0, before_y = whole.y < 0.0, behind_x = whole.x > n - 1.5, behind_y = whole.y > n - 1.5;
  if (before_x && before_y) a = (b + c + e) / 3.0;
  if (behind_x && before_y) b = (a + c + e) / 3.0;
  if (before_x && behind_y) c = (a + b + e) / 3.0;
  if (behind_x && behind_y) e = (a + b + c) / 3.0;
  return mix(mix(a, b, part.x), mix(c, e, part.x), part.y);
}
)";

}  // namespace

std::string with_exact_lookups(const std::string& program) {
  const std::size_t head = program.find('\n') + 1;  // the version stands in the first line
  std::string text = program;
  for (std::size_t at = text.find(kLookup); at != std::string::npos; at = text.find(kLookup, at + kExact.size()))
    text.replace(at, kLookup.size(), kExact);
  return text.insert(head, kFunctions);
}

}  // namespace goniochrome::render
