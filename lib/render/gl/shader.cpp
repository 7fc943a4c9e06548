#include "render/gl/shader.h"

#include <algorithm>

#include "base/angles.h"
#include "base/text.h"
#include "brdf/disc_light.h"
#include "brdf/lobe_model.h"
#include "render/gl/tilt_shader.h"
#include "render/internal/product_forms.h"

namespace goniochrome::render {

namespace {

// A GLSL constant, which needs a point or an exponent to be a float.
std::string glsl(double value) {
  const std::string text = fmt::format("{}", static_cast<float>(value));
  return text.find_first_of(".e") == std::string::npos ? text + ".0" : text;
}

// The first line of every program.
constexpr const char* kHead = "#version 330 core\n";

// Pixels as rays; both programs see the same, so a viewing direction needs no position.
constexpr const char* kRays =
    R"(uniform vec3 corner, right, down;  // the ray through (x, y), in pixels from the upper left
vec3 ray() { return normalize(corner + gl_FragCoord.x * right + gl_FragCoord.y * down); }
)";

// How products with the environment's maps are taken: in plain RGB, in the four forms of the operator (which the maps
// and their weights hold already), or by the operator itself.
using Product = TiltProduct;

Product product_of(const Effects& effects, const ProductForms& forms) {
  if (!effects.reflection) return Product::kPlain;
  return forms.count == 4 ? Product::kForms : Product::kOperator;
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

// Where the weights of this point begin, and how far into its segment the view is.
constexpr const char* kWeight = R"(
int row, column = 0;
float t;
vec4 W(int slot) {
  ivec2 at = ivec2(column + 2 * slot, row);
  return texelFetch(weights, at, 0) + t * texelFetch(weights, at + ivec2(1, 0), 0);
}
)";

std::string row_of_view(const Effects& effects) {
  if (!effects.depends_on_view()) return "  t = c;\n";
  return fmt::format(R"(  float view = {0}.0 * sqrt(c);
  int segment = min(int(view), {1});
  column = {2} * segment;
  t = view - float(segment);
)",
                     kViewSegments, kViewSegments - 1, 2 * slots_of(effects).slots);
}

// brdf's fresnel_dielectric() with the refracted cosine g/n written in c: r_s = (c-g)/(c+g), r_p = (n^2 c-g)/(n^2 c+g).
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

// What a coat lets in, by brdf's form of the Fresnel reflectance; `index2` is the square of its index, 1 without a
// coat.
constexpr const char* kLetIn = R"(
float let_in(float c, float index2) {
  float contrast = index2 - 1.0, g = sqrt(contrast + c * c), s = c + g, p = index2 * c + g;
  float r_s = contrast / (s * s), r_p = contrast * ((index2 + 1.0) * c * c - 1.0) / (p * p);
  return 1.0 - 0.5 * (r_s * r_s + r_p * r_p);
}
)";

// cos^E from 1 - cos, which is exact where cos is 1 but for the last digits.
constexpr const char* kCosPower = R"(
float cos_power(float versine, float exponent) {
  if (versine >= 1.0) return 0.0;
  float s = versine;
  float log_cos = s < 0.02 ? -s * (1.0 + s * (0.5 + s * (0.33333333 + s * 0.25))) : log(1.0 - s);
  return exp(exponent * log_cos);
}
)";

// What a lobe gathers of a disc, by the chord from the mirror direction to its middle; and how much of a disc stands
// above the horizon, by the cosine to its middle relative to the sine of its radius: irradiance and part.
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

// The product of two colors: each channel by itself, or by the operator.
std::string times(const Effects& effects, const std::string& a, const std::string& b) {
  return effects.reflection ? fmt::format("times({}, {})", a, b) : fmt::format("{} * {}", a, b);
}

std::string reflection_function(const color::ReflectionOperator& op) {
  std::string text = "\nvec3 times(vec3 a, vec3 b) {  // bilinear reflection\n  return vec3(";
  for (std::size_t c = 0; c < 3; ++c) {
    text += fmt::format("{}dot(a, mat3(", c == 0 ? "" : "              ");
    for (std::size_t e = 0; e < 3; ++e) {
      for (std::size_t d = 0; d < 3; ++d) text += fmt::format("{}{}", e + d == 0 ? "" : ", ", glsl(op.k[c][d][e]));
    }
    text += c == 2 ? ") * b));\n}\n" : ") * b),\n";
  }
  return text;
}

// The color that products of the four forms stand for, and the environment itself again.
std::string forms_functions(const ProductForms& forms, bool background) {
  std::string columns, white;
  for (std::size_t i = 0; i < 4; ++i) {
    for (int c = 0; c < 3; ++c) columns += (columns.empty() ? "" : ", ") + glsl(forms.out[i][c]);
    white += (white.empty() ? "" : ", ") + glsl(forms.of(static_cast<int>(i), {1, 1, 1}));
  }
  std::string text = fmt::format(
      "\nvec3 color_of(vec4 products) {{  // of weights and maps, both in the four forms of bilinear reflection\n"
      "  return mat4x3({}) * products;\n}}\n",
      columns);
  if (background) {
    text += fmt::format("vec3 unreflected(vec4 forms) {{ return color_of(forms * vec4({})); }}  // by white\n", white);
  }
  return text;
}

// One term of what the environment shows.
std::string product_with_map(Product product, int slot, const std::string& map, const std::string& direction) {
  const std::string weight = fmt::format("W({})", slot), light = fmt::format("textureLod({}, {}, 0.0)", map, direction);
  if (product == Product::kForms) return weight + " * " + light;
  if (product == Product::kPlain) return weight + ".rgb * " + light + ".rgb";
  return fmt::format("times({}.rgb, {}.rgb)", weight, light);
}

const char* sum_type(Product product) {
  return product == Product::kForms ? "vec4" : "vec3";
}

// The weights that discs meet are fetched once for a point, and not again for each of its discs.
std::string disc_weights(const Effects& effects) {
  std::string text = "\nvec4 lit_base;\n";
  for (std::size_t j = 0; j < effects.lobes.size(); ++j) text += fmt::format("vec3 flake_{0}, gloss_{0};\n", j);
  return text;
}

std::string fetched_disc_weights(const Effects& effects) {
  const WeightTable slots = slots_of(effects);
  std::string text = fmt::format("  lit_base = W({});\n", slots.light_slot());
  for (std::size_t j = 0; j < effects.lobes.size(); ++j) {
    const auto weight = [&](bool used, int slot) { return used ? fmt::format("W({}).rgb", slot) : "vec3(0.0)"; };
    text += fmt::format("  flake_{0} = {1};\n  gloss_{0} = {2};\n", j,
                        weight(effects.lobes[j].directional_diffuse, slots.directional_diffuse_slot(j)),
                        weight(effects.lobes[j].gloss, slots.gloss_slot(j)));
  }
  return text;
}

// What the lobes send from a disc: one part with the cosine and the coat at the disc, the other with those at r.
std::string disc_lobes(const Effects& effects) {
  std::string text = fmt::format(
      "\nvec3 lit_lobes(vec3 r, vec3 l, vec3 n, vec3 wo, int light, float irradiance, float above) {{\n"
      "  float chord = distance(r, l), cos_r = max(dot(n, r), 0.0), coat = {};\n  vec3 sum = vec3(0.0);\n  vec4 of;\n",
      lit_gloss(effects) ? "fresnel(sqrt(max(0.5 + 0.5 * dot(r, wo), 0.0)))" : "1.0");
  if (effects.coat) text += "  cos_r *= let_in(cos_r, lit_base.a);\n";
  for (std::size_t j = 0; j < effects.lobes.size(); ++j) {
    const Effects::LobeUse& lobe = effects.lobes[j];
    text += fmt::format(
        "  if (flake_{0} != vec3(0.0) || gloss_{0} != vec3(0.0)) {{\n    of = disc_lobe(light, {0}, chord);\n", j);
    if (lobe.directional_diffuse) text += fmt::format("    sum += (of.x * irradiance + of.y * cos_r) * flake_{};\n", j);
    if (lobe.gloss) text += fmt::format("    sum += (of.z * above + of.w * coat) * gloss_{};\n", j);
    text += "  }\n";
  }
  return text + "  return sum;\n}\n";
}

// What the lobes show of the environment in a mirror direction, and what they send from a light.
std::string lobe_functions(const Effects& effects, Product product) {
  std::string text;
  if (effects.environment) {
    text += fmt::format(
        "\n{0} lobes(vec3 r, vec3 n) {{  // the light that a lobe gathers comes from r + s n\n  {0} sum = {0}(0.0);\n",
        sum_type(product));
    const WeightTable slots = slots_of(effects);
    for (std::size_t j = 0; j < effects.lobes.size(); ++j) {
      const bool shifted = is_shifted(effects, effects.lobes[j].exponent);
      const std::string toward = shifted ? fmt::format("r + W({}).{} * n", slots.shift_slot(j), "rgba"[j % 4]) : "r";
      text += fmt::format("  sum += {};\n",
                          product_with_map(product, WeightTable::lobe_slot(j), fmt::format("lobe_{}", j), toward));
    }
    text += "  return sum;\n}\n";
  }
  if (effects.single_lights() == 0) return text;
  const WeightTable slots = slots_of(effects);
  if (effects.discs()) return text + disc_lobes(effects);
  text += "\nvec3 lit_lobes(vec3 r, vec3 l, float base, float F) {  // without the gloss term's 1/cos_i\n";
  text += "  float versine = 0.5 * dot(r - l, r - l);\n  vec3 sum = vec3(0.0);\n";
  for (std::size_t j = 0; j < effects.lobes.size(); ++j) {
    const Effects::LobeUse& lobe = effects.lobes[j];
    std::string weight;
    if (lobe.directional_diffuse) weight = fmt::format("base * W({}).rgb", slots.directional_diffuse_slot(j));
    if (lobe.gloss) weight += fmt::format("{}F * W({}).rgb", weight.empty() ? "" : " + ", slots.gloss_slot(j));
    text += fmt::format("  sum += ({}) * cos_power(versine, {});\n", weight, glsl(lobe.exponent));
  }
  return text + "  return sum;\n}\n";
}

// Adds to `sum` a function of the mirror direction: about the normal, or averaged over the tilted normals.
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

// L = K_D pi P_1(n) + sum W_j P_Ej(r) + K_M F P_inf(r)
std::string environment_terms(const Effects& effects, Product product, bool tilted) {
  std::string text = "\n  // the environment\n";
  const std::string sum = product == Product::kForms ? "products" : "radiance";
  if (product == Product::kForms) text += "  vec4 products = vec4(0.0);\n";
  const auto term = [&](int slot, const char* map, const char* direction) {
    text += fmt::format("  {} += {};\n", sum, product_with_map(product, slot, map, direction));
  };
  if (effects.diffuse) term(WeightTable::diffuse_slot(), "diffuse", "n");
  if (effects.diffuse && effects.coat) term(slots_of(effects).coat_diffuse_slot(), "coat_diffuse", "n");
  if (!effects.lobes.empty()) text += over_tilts(effects, sum, "lobes", ", n");
  if (effects.mirror) term(slots_of(effects).mirror_slot(), "mirror", "r");
  if (tilted) text += fmt::format("  {} += tilted_lobes(r, n, wo);\n", sum);
  if (product == Product::kForms) text += "  radiance += color_of(products);\n";
  return text;
}

// The same of discs, with their mirror images.
std::string disc_terms(const Effects& effects) {
  std::string text = fmt::format(
      R"(
  // the lamps
{}  for (int i = 0; i < {}; ++i) {{
    vec3 l = light_direction[i], disc = light_disc[i];
    float cos_i = dot(n, l);
    if (cos_i <= -disc.x) continue;
    vec2 seen = cos_i >= disc.x ? vec2(cos_i, 1.0) : disc_horizon(i, cos_i / disc.x);
{}    vec3 reflected = {};
)",
      fetched_disc_weights(effects), effects.single_lights(),
      // At the mean cosine of what is seen of the disc.
      effects.coat ? "    seen.x *= let_in(min(seen.x / max(seen.y, 1e-6), 1.0), lit_base.a);\n" : "",
      effects.diffuse ? "seen.x * lit_base.rgb" : "vec3(0.0)");
  if (!effects.lobes.empty()) {
    const char* fresnel = lit_gloss(effects) ? "fresnel(sqrt(max(0.5 + 0.5 * dot(l, wo), 0.0)))" : "1.0";
    text += over_tilts(effects, "reflected", "lit_lobes", fmt::format(", l, n, wo, i, seen.x, seen.y * {}", fresnel));
  }
  if (effects.mirror)
    text += fmt::format("    if (distance(r, l) <= disc.y) reflected += disc.z * W({}).rgb;\n",
                        slots_of(effects).lamp_mirror_slot());
  return text +
         fmt::format("    radiance += {} * {};\n  }}\n", glsl(kPi), times(effects, "light_white[i]", "reflected"));
}

// The exact BRDF times cos_i, so that the gloss term's 1/cos_i is gone.
std::string light_terms(const Effects& effects) {
  if (effects.discs()) return disc_terms(effects);
  std::string text = fmt::format(
      R"(
  // the lights
  for (int i = 0; i < {}; ++i) {{
    vec3 l = light_direction[i];
    float cos_i = dot(n, l);
    if (cos_i <= 0.0) continue;
    float base = cos_i{};
    vec3 reflected = {};
)",
      effects.single_lights(),
      effects.coat ? fmt::format(" * let_in(cos_i, W({}).a)", slots_of(effects).light_slot()) : "",
      effects.diffuse ? fmt::format("base * W({}).rgb", slots_of(effects).light_slot()) : "vec3(0.0)");
  if (!effects.lobes.empty()) {
    const char* fresnel = lit_gloss(effects) ? "fresnel(sqrt(0.5 + 0.5 * dot(l, wo)))" : "1.0";
    text += over_tilts(effects, "reflected", "lit_lobes", fmt::format(", l, base, {}", fresnel));
  }
  return text +
         fmt::format("    radiance += {} * {};\n  }}\n", glsl(kPi), times(effects, "light_white[i]", "reflected"));
}

// What stands on the ground where a ray meets it was seen from ground_eye = 0; elsewhere it is the ray's own direction.
constexpr const char* kLaidGround = R"(uniform vec3 ground_eye;
uniform float ground_drop;
vec3 laid(vec3 ray) {
  float rise = ground_eye.y + ground_drop;
  return ground_drop > 0.0 && rise > 0.0 && ray.y < 0.0 ? ground_eye - (rise / ray.y) * ray : ray;
}
)";

std::string background_color(Background background, Product product, bool laid_ground) {
  switch (background) {
    case Background::kEnvironment: {
      const std::string seen = fmt::format("textureLod(mirror, {}, 0.0)", laid_ground ? "laid(-wo)" : "-wo");
      return product == Product::kForms ? fmt::format("vec4(unreflected({}), 1.0)", seen)
                                        : fmt::format("vec4({}.rgb, 1.0)", seen);
    }
    case Background::kColor:
      return "vec4(background, 1.0)";
    case Background::kNone:
      break;
  }
  return "vec4(0.0)";
}

}  // namespace

std::string gbuffer_vertex_shader() {
  return std::string(kHead) + R"(layout(location = 0) in vec3 position;
layout(location = 1) in vec3 vertex_normal;
uniform mat4 clip;
out vec3 normal;
void main() {
  normal = vertex_normal;
  gl_Position = clip * vec4(position, 1.0);
}
)";
}

std::string gbuffer_fragment_shader(bool with_triangles) {
  const char* number = with_triangles ? R"(uniform int first;  // the number of the part's first triangle
layout(location = 1) out uint triangle;
)"
                                      : "";
  return std::string(kHead) + kRays + number + R"(uniform int part;
in vec3 normal;
layout(location = 0) out vec4 gbuffer;
void main() {
  float side = gl_FrontFacing ? 1.0 : -1.0;
  vec3 n = side * normalize(normal), wo = -ray();
  // Near an outline the smooth normal can look away from the viewer: the nearest that does not.
  float cos_o = dot(n, wo);
  if (cos_o < 1e-3) n = normalize(n + (1e-3 - cos_o) * wo);
  gbuffer = vec4(n, side * float(part + 1));
)" + (with_triangles ? "  triangle = uint(first + gl_PrimitiveID);\n}\n" : "}\n");
}

std::string shading_vertex_shader() {
  return std::string(kHead) + R"(void main() {  // one triangle that covers the picture
  gl_Position = vec4(4.0 * float(gl_VertexID & 1) - 1.0, 4.0 * float(gl_VertexID >> 1) - 1.0, 0.0, 1.0);
}
)";
}

std::string shading_fragment_shader(const Effects& effects, const color::ReflectionOperator& op,
                                    const std::vector<double>& tilted, bool laid_ground,
                                    const TextureProgram& textures) {
  const bool lit_lobes = effects.single_lights() > 0 && !effects.lobes.empty();
  const ProductForms forms = effects.reflection ? product_forms(op) : ProductForms{};
  const Product product = product_of(effects, forms);
  // 1. What the program is given, and the functions that it needs.
  std::string text = std::string(kHead) + "// goniochrome-theory(7), RENDERING\n";
  text += uniforms(effects) + tilt_uniforms(effects, tilted) + texture_uniforms(textures, effects) + kRays +
          "layout(location = 0) out vec4 color;\n" + kWeight;
  if (effects.reflection && (product == Product::kOperator || effects.single_lights() > 0 || textures.any()))
    text += reflection_function(op);
  if (effects.environment && product == Product::kForms)
    text += forms_functions(forms, effects.background == Background::kEnvironment);
  if (lit_gloss(effects)) text += fresnel_function();
  if (effects.coat && effects.single_lights() > 0) text += kLetIn;
  if (lit_lobes && !effects.discs()) text += kCosPower;
  if (effects.single_lights() > 0 && effects.discs())
    text += disc_functions(effects.lobes.size()) + disc_weights(effects);
  if (!effects.lobes.empty()) text += lobe_functions(effects, product);
  text += tilt_function(effects, tilted, product) + texture_function(textures, effects);
  laid_ground = laid_ground && effects.background == Background::kEnvironment;
  if (laid_ground) text += kLaidGround;
  // 2. Where nothing is seen the program shows the background; else it finds the view and the row of weights.
  text += fmt::format(R"(
void main() {{
  vec4 point = texelFetch(gbuffer, ivec2(gl_FragCoord.xy), 0);
  vec3 wo = -ray();
  if (point.w == 0.0) {{
    color = {};
    return;
  }}
  vec3 n = point.xyz;
  float c = dot(n, wo);  // = n.r
  vec3 r = 2.0 * c * n - wo;
  row = int(abs(point.w)) - 1;
{}  vec3 radiance = vec3(0.0);
)",
                      background_color(effects.background, product, laid_ground), row_of_view(effects));
  // 3. The sum of what the environment and the lights show.
  if (effects.anisotropy) {
    text += R"(  int tilt_count = textureSize(tilts, 0).x;
  vec3 x = dot(n.xz, n.xz) > 1e-12 ? normalize(vec3(n.z, 0.0, -n.x)) : vec3(1.0, 0.0, 0.0), y = cross(n, x);
)";
  }
  if (effects.environment) text += environment_terms(effects, product, !tilted.empty());
  if (effects.single_lights() > 0) text += light_terms(effects);
  if (textures.any()) text += "\n  // the textures\n  radiance += textured(ivec2(gl_FragCoord.xy), n, wo);\n";
  return text + "  color = vec4(radiance, 1.0);\n}\n";
}

std::string shading_fragment_shader(const Scene& scene, const Effects& effects) {
  return shading_fragment_shader(effects, scene.reflection, tilt_exponents(scene, effects), false,
                                 texture_program(scene, effects));
}

std::string for_opengl_es(const std::string& program) {
  return "#version 300 es\nprecision highp float;\nprecision highp int;\nprecision highp sampler2D;\n"
         "precision highp samplerCube;\nprecision highp sampler2DArray;\n" +
         program.substr(std::string_view(kHead).size());
}

}  // namespace goniochrome::render
