#include "render/gl/shader_parts.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/angles.h"
#include "base/text.h"
#include "brdf/disc_light.h"
#include "brdf/lobe_model.h"

namespace goniochrome::render {

namespace {

constexpr double kSharpestBands = 8;  // exponent
constexpr double kAsMirror = 20;  // A lobe so many times as sharp as the sharpest of all shows what the mirror does.

bool is_sharp(double exponent) {
  return exponent > 2 * kSharpestBands;
}

}  // namespace

std::string glsl(double value) {
  const std::string text = fmt::format("{}", static_cast<float>(value));
  return text.find_first_of(".e") == std::string::npos ? text + ".0" : text;
}

std::string uniforms(const Effects& effects) {
  std::string text = R"(uniform sampler2D gbuffer;  // normal, part + 1 (negative: seen from inside)
uniform sampler2D weights;  // a row for each part; two texels for each slot of each segment of the view
)";
  if (effects.anisotropy) text += "uniform sampler2D tilts;  // a row for each part: normal in its frame, share\n";
  if (effects.environment) {
    if (effects.diffuse) text += "uniform samplerCube diffuse;  // P_1\n";
    if (effects.diffuse && effects.coat) text += "uniform samplerCube coat_diffuse;  // P_1 as a coat lets light in\n";
    for (std::size_t j = 0; j < effects.lobes.size(); ++j) {
      text += fmt::format("uniform samplerCube lobe_{};  // P_E, E = {}\n", j, shortest(effects.lobes[j].exponent));
    }
    if (effects.mirror || effects.background == Background::kEnvironment) {
      text += "uniform samplerCube mirror;  // the environment itself\n";
    }
  }
  if (effects.single_lights() > 0) {
    text += fmt::format("uniform vec3 light_direction[{0}], light_white[{0}];\n", effects.single_lights());
    if (effects.discs()) {
      text += fmt::format(
          "uniform vec3 light_disc[{}];  // sine and chord of the radius, 1/(pi sine^2)\n"
          "uniform sampler2D discs;  // for each light a row for each lobe, then one for the horizon\n",
          effects.single_lights());
    }
  }
  if (effects.background == Background::kColor) text += "uniform vec3 background;\n";
  return text;
}

std::string row_of_view(const Effects& effects) {
  if (!effects.depends_on_view()) return "  t = c;\n";
  return fmt::format(R"(  float view = {0}.0 * sqrt(c);
  int segment = min(int(view), {1});
  column = {2} * segment;
  t = view - float(segment);
)",
                     kViewSegments, kViewSegments - 1, 2 * slots_of(effects).slots);
}

std::string fresnel_function() {
  return fmt::format(R"(
float fresnel(float c) {{  // unpolarized, index {0}
  float g = sqrt({1} + c * c), s = (c - g) / (c + g), p = ({2} * c - g) / ({2} * c + g);
  return 0.5 * (s * s + p * p);
}}
)",
                     glsl(brdf::kCoatIndex), glsl(brdf::kCoatIndex * brdf::kCoatIndex - 1),
                     glsl(brdf::kCoatIndex * brdf::kCoatIndex));
}

std::string disc_functions(std::size_t lobes) {
  return fmt::format(R"(
vec4 disc_node(int row, float x) {{
  x = max(x, 0.0);
  int node = int(x);
  return mix(texelFetch(discs, ivec2(node, row), 0), texelFetch(discs, ivec2(node + 1, row), 0), x - float(node));
}}
vec4 disc_lobe(int light, int lobe, float chord) {{
  int row = {0} * light + lobe;
  vec4 steps = texelFetch(discs, ivec2({1}, row), 0);
  float x = (chord - steps.x) * steps.y;
  return x < {1}.0 - 1.0 ? disc_node(row, x) : vec4(0.0);
}}
vec2 disc_horizon(int light, float part) {{
  return disc_node({0} * light + {2}, min(0.5 * (part + 1.0) * ({1}.0 - 1.0), {1}.0 - 1.001)).xy;
}}
)",
                     lobes + 1, brdf::DiscLobeTable::kNodes, lobes);
}

bool lit_gloss(const Effects& effects) {
  return effects.single_lights() > 0 && effects.fresnel &&
         std::any_of(effects.lobes.begin(), effects.lobes.end(), [](const Effects::LobeUse& use) { return use.gloss; });
}

const char* sum_type(const Effects& effects) {
  return effects.reflection ? "mat3" : "vec3";
}

std::string product(const Effects& effects, const std::string& a, const std::string& b) {
  return effects.reflection ? fmt::format("outerProduct({}, {})", a, b) : fmt::format("{} * {}", a, b);
}

std::string color_of(const Effects& effects, const std::string& products) {
  return effects.reflection ? fmt::format("color_of({})", products) : products;
}

std::string reflection_function(const color::ReflectionOperator& op) {
  std::string text = "\nvec3 color_of(mat3 products) {  // bilinear reflection\n  return ";
  for (std::size_t e = 0; e < 3; ++e) {
    text += e == 0 ? "mat3(" : " +\n         mat3(";
    for (std::size_t d = 0; d < 3; ++d)
      for (std::size_t c = 0; c < 3; ++c) text += fmt::format("{}{}", d + c == 0 ? "" : ", ", glsl(op.k[c][d][e]));
    text += fmt::format(") * products[{}]", e);
  }
  return text + ";\n}\n";
}

std::string over_tilts(const Effects& effects, const std::string& sum, const std::string& function,
                       const std::string& more) {
  if (!effects.anisotropy) return fmt::format("  {} += {}(r{});\n", sum, function, more);
  return fmt::format(R"(  for (int k = 0; k < tilt_count; ++k) {{
    vec4 tilt = texelFetch(tilts, ivec2(k, row), 0);
    if (tilt.w == 0.0) break;
    vec3 m = tilt.x * x + tilt.y * y + tilt.z * n;
    float cos_m = dot(m, wo);
    vec3 r_m = 2.0 * cos_m * m - wo;
    if (cos_m > 0.0 && dot(r_m, n) > 0.0) {} += tilt.w * {}(r_m{});
  }}
)",
                     sum, function, more);
}

std::string luminance_constant() {
  constexpr color::Rgb kPrimaries[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  return fmt::format("const vec3 luminance = vec3({});\n",
                     joined(kPrimaries, ", ", [](const color::Rgb& rgb) { return glsl(color::luminance(rgb)); }));
}

std::string occlusion_start(const Effects& effects) {
  std::string text =
      "  tilted = 0.9375 * c * c - 0.3125;\n  occluded = texelFetch(occlusion, ivec2(gl_FragCoord.xy), 0);\n"
      "  lit = 1.0 - float(int(abs(point.w)) >> 3) / 15.0;\n";
  const auto off = [](const Effects::LobeUse& lobe) { return std::abs(std::log(lobe.exponent / kSharpestBands)); };
  const auto wide = std::ranges::min_element(effects.lobes, {}, off);
  if (wide == effects.lobes.end()) return text;
  const std::string map = fmt::format("lobe_{}", wide - effects.lobes.begin());
  text += fmt::format("  share = dot(luminance, {}) / max(dot(luminance, {}), 1e-6);\n",
                      lobe_light(true, wide->exponent, map, "r"), lobe_light(false, 0, map, "r"));
  return text + R"(  depth = fract(abs(point.w)) / reach;
  from = ground_eye + depth * (corner + gl_FragCoord.x * right + gl_FragCoord.y * down);
)";
}

std::string lobe_light(bool shaded, double exponent, const std::string& map, const std::string& axis) {
  const std::string look_up = fmt::format("textureLod({}, {}, 0.0).rgb", map, axis);
  if (!shaded) return look_up;
  if (exponent == kDiffusePart) return fmt::format("left({}, 2.0 * occluded.x)", look_up);
  if (is_sharp(exponent))
    return fmt::format("sharp({}, {}, {})", map, axis, glsl(1 / std::sqrt(std::min(exponent, 1e6))));
  return fmt::format("left({}, vec2({}, {}))", look_up, glsl((exponent + 1) / (exponent + 2)),
                     glsl(exponent / (exponent + 3)));
}

// The environment as a lobe of any exponent shows it, between the maps of two lobes.
std::string ground_map_function(const Effects& effects) {
  std::string text = "vec3 ground_map(vec3 at, float exponent) {\n";
  for (std::size_t j = 0; j < effects.lobes.size(); ++j) {
    const bool last = j + 1 == effects.lobes.size();
    const double from = effects.lobes[j].exponent, to = last ? kAsMirror * from : effects.lobes[j + 1].exponent;
    if (!last && !is_sharp(to)) continue;
    const auto map = [&](const std::string& name) { return fmt::format("textureLod({}, at, 0.0).rgb", name); };
    text += fmt::format("  if (exponent < {}) return mix({}, {}, clamp(log(exponent / {}) / {}, 0.0, 1.0));\n",
                        glsl(to), map(fmt::format("lobe_{}", j)), map(last ? "mirror" : fmt::format("lobe_{}", j + 1)),
                        glsl(from), glsl(std::log(to / from)));
  }
  return text + "  return textureLod(mirror, at, 0.0).rgb;\n}\n";
}

std::string page_functions(const Effects& effects, bool on_page) {
  if (!on_page || effects.background != Background::kEnvironment) return {};
  return std::string(kProjectedGround) + (effects.lobes.size() <= kMostLobesOverShade ? kKeptLight : "") +
         (is_shaded(effects, on_page) ? luminance_constant() + ground_map_function(effects) + kOcclusion : "");
}

std::string background_colors(const Effects& effects, bool projected_ground) {
  std::string shown = "vec4(0.0)", sent = "vec3(0.0)";
  if (effects.background == Background::kColor) shown = "vec4(background, 1.0)";
  if (effects.background == Background::kEnvironment) shown = "vec4(textureLod(mirror, -wo, 0.0).rgb, 1.0)";
  std::string before;
  if (effects.background == Background::kEnvironment && projected_ground) {
    const bool kept = effects.lobes.size() <= kMostLobesOverShade;
    before = fmt::format(
        "    bool ground = meets_ground(ground_eye, -wo);\n"
        "    vec3 at = ground ? on_ground(ground_eye, -wo) : -wo, seen = textureLod(mirror, at, 0.0).rgb;\n{}",
        kept ? "    vec4 kept = ground ? kept_light(at, 0.0) : vec4(1.0, 1.0, 1.0, 0.0);\n" : "");
    shown = kept ? "vec4(kept.rgb * seen, 1.0)" : "vec4(seen, 1.0)";
    if (kept) sent = "kept.a * seen";
  }
  return before + fmt::format("    vec4 shown = {};\n    vec3 sent = {};\n", shown, sent);
}

std::string disc_loop(const Effects& effects, const std::string& index2) {
  return fmt::format(
      R"(  for (int i = 0; i < {}; ++i) {{
    vec3 l = light_direction[i], disc = light_disc[i];
    float cos_i = dot(n, l);
    if (cos_i <= -disc.x) continue;
    vec2 seen = cos_i >= disc.x ? vec2(cos_i, 1.0) : disc_horizon(i, asin(cos_i) / asin(disc.x));
{})",
      effects.single_lights(),
      // At the mean cosine of what is seen of the disc.
      effects.coat ? fmt::format("    seen.x *= let_in(min(seen.x / max(seen.y, 1e-6), 1.0), {});\n", index2) : "");
}

std::string disc_fresnel(const Effects& effects) {
  return lit_gloss(effects) ? "fresnel(sqrt(max(0.5 + 0.5 * dot(l, wo), 0.0)))" : "1.0";
}

std::string start_of_main(const Effects& effects, bool on_page, const std::string& more, const std::string& beside) {
  return fmt::format(R"(
void main() {{
  vec4 point = texelFetch(gbuffer, ivec2(pixel()), 0);
  vec3 wo = -ray();
{}  if (point.w == 0.0) {{
{}    return;
  }}
  vec3 n = point.xyz;
  float c = dot(n, wo);  // = n.r
  vec3 r = 2.0 * c * n - wo;
  row = {} - 1;
{})",
                     more, beside, on_page ? "(int(abs(point.w)) & 7)" : "int(abs(point.w))", row_of_view(effects));
}

std::string tilt_frame(const Effects& effects) {
  if (!effects.anisotropy) return {};
  return R"(  int tilt_count = textureSize(tilts, 0).x;
  vec3 x = dot(n.xz, n.xz) > 1e-12 ? normalize(vec3(n.z, 0.0, -n.x)) : vec3(1.0, 0.0, 0.0), y = cross(n, x);
)";
}

}  // namespace goniochrome::render
