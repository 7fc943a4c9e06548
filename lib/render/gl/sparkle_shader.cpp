#include "render/gl/sparkle_shader.h"

#include <cmath>

#include "base/angles.h"
#include "base/text.h"
#include "render/gl/gbuffer_shader.h"
#include "render/gl/shader_parts.h"
#include "render/scene_effects.h"

namespace goniochrome::render {

namespace {

// A cell is as large as the box or up to twice as large along each axis, so that a box meets two of them. Flakes have
// places in their cell, while their number follows the part of its tilts by inversion.
constexpr const char* kCounts = R"(
uint mixed(uint a, uint b) {
  uint z = (a + 0x9E3779B9u * (b + 1u)) * 747796405u + 2891336453u;
  z = ((z >> ((z >> 28u) + 4u)) ^ z) * 277803737u;
  return (z >> 22u) ^ z;
}
float poisson(float mean, float u) {
  if (mean > 8.0) {  // normal, by a rational approximation of its quantile
    float p = min(u, 1.0 - u), q = sqrt(-2.0 * log(p));
    float z = q - (2.515517 + q * (0.802853 + q * 0.010328)) / (1.0 + q * (1.432788 + q * (0.189269 + q * 0.001308)));
    return mean + sqrt(mean) * (u < 0.5 ? -z : z);
  }
  float probability = exp(-mean), sum = probability, count = 0.0;
  for (; u > sum && count < 40.0; sum += probability) probability *= mean / ++count;
  return count;
}
float count_flakes(vec4 low, vec4 size, float expected, uint seed) {
  vec4 level = ceil(log2(size)), cell = exp2(level), first = floor(low / cell), dense = cell / size;
  ivec4 levels = ivec4(level);
  for (int axis = 0; axis < 4; ++axis) seed = mixed(seed, uint(levels[axis]));
  float count = 0.0, mean = expected * dense.x * dense.y * dense.z * dense.w;
  uint keys[4];
  for (int k = 0; k < 16; ++k) {
    vec4 at = first + vec4(k >> 3, (k >> 2) & 1, (k >> 1) & 1, k & 1);
    vec4 begin = max(low / cell - at, 0.0), end = min((low + size) / cell - at, 1.0), part = max(end - begin, 0.0);
    at.w = mod(at.w, 1.0 / cell.w);  // turns come around
    if ((k & 7) == 0) keys[0] = mixed(seed, uint(int(at.x)));
    if ((k & 3) == 0) keys[1] = mixed(keys[0], uint(int(at.y)));
    if ((k & 1) == 0) keys[2] = mixed(keys[1], uint(int(at.z)));
    if (part.x * part.y * part.z * part.w == 0.0) continue;
    uint key = mixed(keys[2], uint(int(at.w)));
    float here = mean * part.z * part.w, u = (float(key >> 8) + 0.5) / 16777216.0;
    if (here > 8.0) {
      count += poisson(here * part.x * part.y, u);
      continue;
    }
    for (float left = poisson(here, u); left > 0.0; --left) {
      key = mixed(key, 1u);
      vec2 place = (vec2(key & 0xFFFFu, key >> 16) + 0.5) / 65536.0;
      if (all(greaterThan(place, begin.xy)) && all(lessThan(place, end.xy))) ++count;
    }
  }
  return count;
}
)";

// The box of the pixel's flakes: places in the plane of two axes of the mesh, along whose third the surface is seen.
constexpr const char* kBox = R"(  if (!(area > 0.0)) return;
  vec3 facing = abs(face) / area;
  int axis = facing.x > max(facing.y, facing.z) ? 0 : facing.y > facing.z ? 1 : 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
  vec2 size = vec2(abs(a[u]) + abs(b[u]), abs(a[v]) + abs(b[v]));
  size *= sqrt(area * facing[axis] / (size.x * size.y));
  vec2 low = unit_m * vec2(place[u], place[v]) - 0.5 * size;
  vec3 across = vec3(u == 0, u == 1, u == 2);
  across.xz = vec2(turn.x * across.x - turn.y * across.z, turn.y * across.x + turn.x * across.z);
  vec3 x = across - dot(across, r) * r, y = cross(r, x);
  float light = dot(luminance, texelFetch(picture, ivec2(gl_FragCoord.xy), 0).rgb), lit = 1.0 - float(int(abs(point.w)) >> 3) / 15.0;
)";

}  // namespace

std::string sparkle_vertex_shader() {
  return std::string(kHead) + R"(layout(location = 0) in vec3 position;
uniform mat4 clip;
invariant gl_Position;  // depths are those of the G-buffer
out vec3 place;
void main() {
  place = position;
  gl_Position = clip * vec4(position, 1.0);
}
)";
}

std::string sparkle_fragment_shader(const Effects& effects, const color::ReflectionOperator& op) {
  if (effects.single_lights() == 0) return {};
  const WeightTable slots = slots_of(effects);
  std::string text = std::string(kHead) + uniforms(effects) + kPixel + kRays + kWeight + luminance_constant() +
                     disc_functions(effects.lobes.size()) + R"(
uniform sampler2D flakes, picture;
uniform float per_m2, unit_m, least;  // least: part of the pixel's light below which deviations are not drawn
uniform vec2 turn;  // cosine and sine by which the environment was turned
uniform int own_lamps;
in vec3 place;
layout(location = 0) out vec4 color;
)" + kCounts;
  if (effects.coat) text += kLetIn;
  if (effects.reflection) text += reflection_function(op);
  text += start_of_main(effects, true,
                        "  color = vec4(0.0);\n"
                        "  vec3 a = unit_m * dFdx(place), b = unit_m * dFdy(place), face = cross(a, b);\n"
                        "  float area = length(face);\n",
                        "");
  text += kBox;
  text += fmt::format("  vec4 base = W({});\n  float cos_r = max(c, 0.0){};\n", slots.light_slot(),
                      effects.coat ? " * let_in(max(c, 0.0), base.a)" : "");
  text += disc_loop(effects, "base.a") + R"(    if (cos_i <= 0.0) continue;
    float chord = distance(r, l);
    vec3 weight = vec3(0.0);
    vec4 of;
)";
  for (std::size_t j = 0; j < effects.lobes.size(); ++j)
    if (effects.lobes[j].directional_diffuse)
      text +=
          fmt::format("    of = disc_lobe(i, {}, chord);\n    weight += (of.x * seen.x + of.y * cos_r) * W({}).rgb;\n",
                      j, slots.directional_diffuse_slot(j));
  text += fmt::format(
      R"(    vec3 mean = {0};
    float seen_mean = dot(luminance, mean);  // more than the light of the pixel at outlines that were smoothed
    float step = chord * {1};
    int node = min(int(step), {2});
    vec4 shown = mix(texelFetch(flakes, ivec2(node, i), 0), texelFetch(flakes, ivec2(node + 1, i), 0), step - float(node));
    float expected = per_m2 * area * shown.x * cos_i;
    if (!(seen_mean > least * sqrt(expected) * light) || seen_mean > light) continue;
    float turns = clamp(shown.z / ({3} * max(1e-9, length(cross(r, l)))), shown.x, 1.0), tilts = min(1.0, shown.x / turns);
    vec4 box = vec4(low, clamp(shown.y - 0.5 * tilts, 0.0, 1.0 - tilts), atan(dot(l, y), dot(l, x)) / {4} - 0.5 * turns + 1.0);
    color.rgb += (count_flakes(box, vec4(size, tilts, turns), expected, uint(3 * i + axis)) / expected - 1.0) * mean;
  }}
}}
)",
      color_of(effects,
               product(effects, fmt::format("(i < own_lamps ? 1.0 : lit) * {} * light_white[i]", glsl(kPi)), "weight")),
      glsl((kFlakeNodes - 1) / kMostFlakeChord), kFlakeNodes - 2, glsl(2 * std::sqrt(kPi)), glsl(2 * kPi));
  return text;
}

}  // namespace goniochrome::render
