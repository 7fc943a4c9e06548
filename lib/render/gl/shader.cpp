#include "render/gl/shader.h"

#include <algorithm>

#include "base/angles.h"
#include "base/text.h"
#include "render/gl/shader_parts.h"

namespace goniochrome::render {

namespace {

// cos^E from 1 - cos, which is exact where cos is 1 but for the last digits.
constexpr const char* kCosPower = R"(
float cos_power(float versine, float exponent) {
  if (versine >= 1.0) return 0.0;
  float s = versine;
  float log_cos = s < 0.02 ? -s * (1.0 + s * (0.5 + s * (0.33333333 + s * 0.25))) : log(1.0 - s);
  return exp(exponent * log_cos);
}
)";

// One term of what the environment shows.
std::string product_with_map(const Effects& effects, int slot, const std::string& map, const std::string& direction,
                             double exponent, bool shaded) {
  return product(effects, fmt::format("W({}).rgb", slot), lobe_light(shaded, exponent, map, direction));
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

// The light of a disc by the lobes: one part with the cosine and the coat at the disc, the other with those at r.
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

// The light of the lobes from the environment in a mirror direction, and from a light.
std::string lobe_functions(const Effects& effects, bool shaded) {
  std::string text;
  if (effects.environment) {
    text += fmt::format(
        "\n{0} lobes(vec3 r, vec3 n) {{  // the light that a lobe gathers comes from r + s n\n  {0} sum = {0}(0.0);\n",
        sum_type(effects));
    const WeightTable slots = slots_of(effects);
    for (std::size_t j = 0; j < effects.lobes.size(); ++j) {
      const bool shifted = is_shifted(effects, effects.lobes[j].exponent);
      const std::string shift = shifted ? fmt::format(" + W({}).{} * n", slots.shift_slot(j), "rgba"[j % 4]) : "";
      text +=
          fmt::format("  sum += {};\n", product_with_map(effects, WeightTable::lobe_slot(j), fmt::format("lobe_{}", j),
                                                         "r" + shift, effects.lobes[j].exponent, shaded));
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

// L = K_D pi P_1(n) + sum W_j P_Ej(r) + K_M F P_inf(r)
std::string environment_terms(const Effects& effects, bool shaded) {
  std::string text = "\n  // the environment\n";
  const auto term = [&](int slot, const char* map, const std::string& direction, double exponent) {
    text += fmt::format("  products += {};\n", product_with_map(effects, slot, map, direction, exponent, shaded));
  };
  if (effects.diffuse) term(WeightTable::diffuse_slot(), "diffuse", "n", kDiffusePart);
  if (effects.diffuse && effects.coat) term(slots_of(effects).coat_diffuse_slot(), "coat_diffuse", "n", kDiffusePart);
  if (!effects.lobes.empty()) text += over_tilts(effects, "products", "lobes", ", n");
  if (effects.mirror) term(slots_of(effects).mirror_slot(), "mirror", "r", paint::kMirrorExponent);
  return text;
}

// The end of a loop over lamps.
std::string lit_sum(const Effects& effects, bool shaded) {
  const char* share = shaded ? "(i < own_lamps ? 1.0 : lit) * " : "";
  return fmt::format("    products += {};\n  }}\n",
                     product(effects, fmt::format("{}{} * light_white[i]", share, glsl(kPi)), "reflected"));
}

// The terms of discs, with their mirror images.
std::string disc_terms(const Effects& effects, bool shaded) {
  std::string text = fmt::format(
      R"(
  // the lamps
{}{}    vec3 reflected = {};
)",
      fetched_disc_weights(effects), disc_loop(effects, "lit_base.a"),
      effects.diffuse ? "seen.x * lit_base.rgb" : "vec3(0.0)");
  if (!effects.lobes.empty()) {
    text += over_tilts(effects, "reflected", "lit_lobes",
                       fmt::format(", l, n, wo, i, seen.x, seen.y * {}", disc_fresnel(effects)));
  }
  if (effects.mirror)
    text += fmt::format("    if (distance(r, l) <= disc.y) reflected += disc.z * W({}).rgb;\n",
                        slots_of(effects).lamp_mirror_slot());
  return text + lit_sum(effects, shaded);
}

// The exact BRDF times cos_i, so that the gloss term's 1/cos_i is gone.
std::string light_terms(const Effects& effects, bool shaded) {
  if (effects.discs()) return disc_terms(effects, shaded);
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
  return text + lit_sum(effects, shaded);
}

}  // namespace

std::string shading_vertex_shader() {
  return std::string(kHead) + R"(void main() {  // one triangle that covers the picture
  gl_Position = vec4(4.0 * float(gl_VertexID & 1) - 1.0, 4.0 * float(gl_VertexID >> 1) - 1.0, 0.0, 1.0);
}
)";
}

std::string shading_fragment_shader(const Effects& effects, const color::ReflectionOperator& op, bool on_page) {
  const bool lit_lobes = effects.single_lights() > 0 && !effects.lobes.empty(), shaded = is_shaded(effects, on_page);
  // 1. What the program is given, and the functions that it needs.
  std::string text = std::string(kHead) + "// goniochrome-rendering(7), \"RENDERING\"\n";
  text += uniforms(effects) + kPixel + kRays + "layout(location = 0) out vec4 color;\n" + kWeight +
          page_functions(effects, on_page);
  if (effects.reflection) text += reflection_function(op);
  if (lit_gloss(effects)) text += fresnel_function();
  if (effects.coat && effects.single_lights() > 0) text += kLetIn;
  if (lit_lobes && !effects.discs()) text += kCosPower;
  if (effects.single_lights() > 0 && effects.discs())
    text += disc_functions(effects.lobes.size()) + disc_weights(effects);
  if (!effects.lobes.empty()) text += lobe_functions(effects, shaded);
  const bool projected_ground = on_page && effects.background == Background::kEnvironment;
  // 2. Where nothing is seen the program shows the background; else it finds the view and the row of weights.
  if (projected_ground) text += kMeshColor;
  text += start_of_main(
      effects, on_page, "",
      background_colors(effects, projected_ground) +
          (projected_ground ? "    color = shown + vec4(mesh_color * sent, 0.0);\n" : "    color = shown;\n"));
  text += fmt::format("  {0} products = {0}(0.0);\n", sum_type(effects));
  if (shaded) text += occlusion_start(effects) + "  sent = mesh_color * occluded.a;\n";
  // 3. The sum of what the environment and the lights show.
  text += tilt_frame(effects);
  if (effects.environment) text += environment_terms(effects, shaded);
  if (effects.single_lights() > 0) text += light_terms(effects, shaded);
  return text + fmt::format("  color = vec4({}, 1.0);\n}}\n", color_of(effects, "products"));
}

std::string for_opengl_es(const std::string& program) {
  return "#version 300 es\nprecision highp float;\nprecision highp int;\nprecision highp sampler2D;\n"
         "precision highp samplerCube;\nprecision highp sampler2DArray;\n" +
         program.substr(std::string_view(kHead).size());
}

}  // namespace goniochrome::render
