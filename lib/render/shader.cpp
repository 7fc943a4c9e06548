#include "render/shader.h"

#include <fmt/format.h>

#include <numbers>

#include "base/text.h"
#include "brdf/lobe_model.h"

namespace goniochrome {

namespace {

int directional_diffuse_column(std::size_t lobe) {
  return 1 + 2 * static_cast<int>(lobe);
}
int gloss_column(std::size_t lobe) {
  return 2 + 2 * static_cast<int>(lobe);
}
int mirror_column(const Effects& effects) {
  return 1 + 2 * static_cast<int>(effects.lobes.size());
}

// A GLSL constant, which needs a point or an exponent to be a float.
std::string glsl(double value) {
  const std::string text = fmt::format("{}", static_cast<float>(value));
  return text.find_first_of(".e") == std::string::npos ? text + ".0" : text;
}

// Pixels as rays; both programs see the same, so a viewing direction needs no position.
constexpr const char* kRays =
    R"(uniform vec3 corner, right, down;  // the ray through (x, y), in pixels from the upper left
vec3 ray() { return normalize(corner + gl_FragCoord.x * right + gl_FragCoord.y * down); }
)";

std::string uniforms(const Effects& effects) {
  std::string text = R"(uniform sampler2D gbuffer;  // normal, part + 1 (negative: seen from inside)
uniform sampler2D weights;  // a row for each part, 1/sr
)";
  if (effects.environment) {
    text += "uniform samplerCube diffuse;  // P_1\n";
    for (std::size_t j = 0; j < effects.lobes.size(); ++j) {
      text += fmt::format("uniform samplerCube lobe_{};  // P_E, E = {}\n", j, shortest(effects.lobes[j].exponent));
    }
    if (effects.mirror || effects.background == Background::kEnvironment) {
      text += "uniform samplerCube mirror;  // the environment itself\n";
    }
  }
  if (effects.lights > 0) {
    text += fmt::format("uniform vec3 light_direction[{0}], light_white[{0}];\n", effects.lights);
  }
  if (effects.background == Background::kColor) text += "uniform vec3 background;\n";
  return text;
}

// brdf's fresnel_dielectric() with the refracted cosine g/n written in c: r_s = (c-g)/(c+g), r_p = (n^2 c-g)/(n^2 c+g).
std::string fresnel_function() {
  return fmt::format(R"(
float fresnel(float c) {{  // unpolarized, index {0}
  float g = sqrt({1} + c * c), s = (c - g) / (c + g), p = ({2} * c - g) / ({2} * c + g);
  return 0.5 * (s * s + p * p);
}}
)",
                     glsl(kCoatIndex), glsl(kCoatIndex * kCoatIndex - 1), glsl(kCoatIndex * kCoatIndex));
}

// cos^E from 1 - cos, which is exact where cos is 1 but for the last digits.
constexpr const char* kCosPower = R"(
float cos_power(float versine, float exponent) {
  if (versine >= 1.0) return 0.0;
  float s = versine;
  float log_cos = s < 0.02 ? -s * (1.0 + s * (0.5 + s * (0.33333333 + s * 0.25))) : log(1.0 - s);
  return exp(exponent * log_cos);
}
)";

// L = K_D pi P_1(n) + c sum K_DD (2 pi/(E+1)) P_E(r) + sum K_G (2 pi/(E+1)) P_E(r) + K_M F P_inf(r)
std::string environment_terms(const Effects& effects) {
  std::string text = fmt::format("\n  // the environment\n  radiance += K(0) * {} * textureLod(diffuse, n, 0.0).rgb;\n",
                                 glsl(std::numbers::pi));
  for (std::size_t j = 0; j < effects.lobes.size(); ++j) {
    const Effects::LobeUse& lobe = effects.lobes[j];
    std::string weight;
    if (lobe.directional_diffuse) weight = fmt::format("c * K({})", directional_diffuse_column(j));
    if (lobe.gloss) weight += fmt::format("{}K({})", weight.empty() ? "" : " + ", gloss_column(j));
    text += fmt::format("  radiance += ({}) * {} * textureLod(lobe_{}, r, 0.0).rgb;\n", weight,
                        glsl(2 * std::numbers::pi / (lobe.exponent + 1)), j);
  }
  if (effects.mirror) {
    text += fmt::format("  radiance += K({}) * fresnel(c) * textureLod(mirror, r, 0.0).rgb;\n", mirror_column(effects));
  }
  return text;
}

// The exact BRDF times cos_i, so that the gloss term's 1/cos_i is gone.
std::string light_terms(const Effects& effects) {
  std::string text = fmt::format(R"(
  // the lights
  for (int i = 0; i < {}; ++i) {{
    float cos_i = dot(n, light_direction[i]);
    if (cos_i <= 0.0) continue;
    vec3 apart = r - light_direction[i];
    float versine = 0.5 * dot(apart, apart);
    vec3 reflected = cos_i * K(0);
)",
                                 effects.lights);
  for (std::size_t j = 0; j < effects.lobes.size(); ++j) {
    const Effects::LobeUse& lobe = effects.lobes[j];
    std::string weight;
    if (lobe.directional_diffuse) weight = fmt::format("cos_i * K({})", directional_diffuse_column(j));
    if (lobe.gloss) weight += fmt::format("{}K({})", weight.empty() ? "" : " + ", gloss_column(j));
    text += fmt::format("    reflected += ({}) * cos_power(versine, {});\n", weight, glsl(lobe.exponent));
  }
  return text + fmt::format("    radiance += {} * light_white[i] * reflected;\n  }}\n", glsl(std::numbers::pi));
}

std::string background_color(Background background) {
  switch (background) {
    case Background::kEnvironment:
      return "vec4(textureLod(mirror, -wo, 0.0).rgb, 1.0)";
    case Background::kColor:
      return "vec4(background, 1.0)";
    case Background::kNone:
      break;
  }
  return "vec4(0.0)";
}

}  // namespace

Effects effects_of(const Scene& scene) {
  Effects effects;
  effects.environment = scene.env != nullptr;
  effects.mirror = effects.environment && has_mirror(scene.paints);
  effects.lights = scene.lights.size();
  effects.background = scene.background;
  for (const double exponent : lobe_exponents(scene.paints)) {
    Effects::LobeUse use{exponent, false, false};
    for (const LobeFit& paint : scene.paints) {
      const Lobe* lobe = find_lobe(paint, exponent);
      if (lobe == nullptr) continue;
      use.directional_diffuse |= lobe->directional_diffuse != Rgb{};
      use.gloss |= lobe->gloss != Rgb{};
    }
    effects.lobes.push_back(use);
  }
  return effects;
}

WeightTable weight_table(const Scene& scene, const Effects& effects) {
  WeightTable table{mirror_column(effects) + 1, static_cast<int>(scene.paints.size()), {}};
  table.rgba.assign(static_cast<std::size_t>(table.columns) * scene.paints.size() * 4, 0.0F);
  for (std::size_t row = 0; row < scene.paints.size(); ++row) {
    const auto set = [&](int column, const Rgb& weight) {
      float* texel =
          &table.rgba[(row * static_cast<std::size_t>(table.columns) + static_cast<std::size_t>(column)) * 4];
      for (int channel = 0; channel < 3; ++channel) texel[channel] = static_cast<float>(weight[channel]);
    };
    const LobeFit& paint = scene.paints[row];
    set(0, paint.diffuse);
    for (std::size_t j = 0; j < effects.lobes.size(); ++j) {
      const Lobe* lobe = find_lobe(paint, effects.lobes[j].exponent);
      if (lobe == nullptr) continue;
      set(directional_diffuse_column(j), lobe->directional_diffuse);
      set(gloss_column(j), lobe->gloss);
    }
    const Lobe* mirror = find_lobe(paint, kMirrorExponent);
    if (mirror != nullptr) set(mirror_column(effects), mirror->gloss);
  }
  return table;
}

std::string gbuffer_vertex_shader() {
  return R"(#version 330 core
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 vertex_normal;
uniform mat4 clip;
out vec3 normal;
void main() {
  normal = vertex_normal;
  gl_Position = clip * vec4(position, 1.0);
}
)";
}

std::string gbuffer_fragment_shader() {
  return std::string("#version 330 core\n") + kRays + R"(uniform int part;
in vec3 normal;
layout(location = 0) out vec4 gbuffer;
void main() {
  float side = gl_FrontFacing ? 1.0 : -1.0;
  vec3 n = side * normalize(normal), wo = -ray();
  // Near an outline the smooth normal can look away from the viewer: the nearest that does not.
  float cos_o = dot(n, wo);
  if (cos_o < 1e-3) n = normalize(n + (1e-3 - cos_o) * wo);
  gbuffer = vec4(n, side * float(part + 1));
}
)";
}

std::string shading_vertex_shader() {
  return R"(#version 330 core
void main() {  // one triangle that covers the picture
  gl_Position = vec4(4.0 * float(gl_VertexID & 1) - 1.0, 4.0 * float(gl_VertexID >> 1) - 1.0, 0.0, 1.0);
}
)";
}

std::string shading_fragment_shader(const Effects& effects) {
  std::string text = "#version 330 core\n// goniochrome-theory(7), RENDERING\n";
  text += uniforms(effects) + kRays + "layout(location = 0) out vec4 color;\n\nint row;\n";
  text += "vec3 K(int column) { return texelFetch(weights, ivec2(column, row), 0).rgb; }\n";
  if (effects.mirror) text += fresnel_function();
  if (effects.lights > 0 && !effects.lobes.empty()) text += kCosPower;
  text += fmt::format(R"(
void main() {{
  vec4 point = texelFetch(gbuffer, ivec2(gl_FragCoord.xy), 0);
  vec3 wo = -ray();
  if (point.w == 0.0) {{
    color = {};
    return;
  }}
  row = int(abs(point.w)) - 1;
  vec3 n = point.xyz;
  float c = dot(n, wo);  // = n.r
  vec3 r = 2.0 * c * n - wo;
  vec3 radiance = vec3(0.0);
)",
                      background_color(effects.background));
  if (effects.environment) text += environment_terms(effects);
  if (effects.lights > 0) text += light_terms(effects);
  return text + "  color = vec4(radiance, 1.0);\n}\n";
}

}  // namespace goniochrome
