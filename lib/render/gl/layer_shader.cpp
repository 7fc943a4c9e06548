#include "render/gl/layer_shader.h"

#include "base/angles.h"
#include "base/text.h"
#include "render/gl/shader_parts.h"

namespace goniochrome::render {

namespace {

// The light of a slot from the maps in a mirror direction, and that which a white mesh would send.
std::string map_light_function(const Effects& effects, bool shaded) {
  std::string text = "\nvec4 map_light(vec3 r, int slot, vec3 n) {\n  vec4 light = vec4(0.0);\n";
  for (const LightLayer& layer : light_layers(effects)) {
    if (layer.of_lamps) continue;
    std::string toward = layer.exponent == kDiffusePart ? "n" : "r";
    if (layer.shift_slot >= 0) toward += fmt::format(" + W({}).{} * n", layer.shift_slot, "rgba"[layer.shift_channel]);
    text += fmt::format("  if (slot == {}) light = vec4({}, {});\n", layer.slot,
                        lobe_light(shaded, layer.exponent, layer.sampler, toward), shaded ? "occluded.a" : "0.0");
  }
  return text + "  return light;\n}\n";
}

// The light of a disc by the flakes or the gloss of a lobe: the sums of the shading program, without weights.
std::string lamp_light_function(const Effects& effects) {
  return fmt::format(R"(
float lamp_light(vec3 r, int slot, vec3 l, vec3 n, vec3 wo, int light, vec2 seen) {{
  vec4 of = disc_lobe(light, (slot - {0}) / 2, distance(r, l));
  if (of == vec4(0.0)) return 0.0;
  if (((slot - {0}) & 1) == 1) return of.z * seen.y + of.w * {1};
  float cos_r = max(dot(n, r), 0.0);
{2}  return of.x * seen.x + of.y * cos_r;
}}
)",
                     slots_of(effects).directional_diffuse_slot(0),
                     lit_gloss(effects) ? "fresnel(sqrt(max(0.5 + 0.5 * dot(r, wo), 0.0)))" : "1.0",
                     effects.coat ? "  cos_r *= let_in(cos_r, index2);\n" : "");
}

// Sums over the lamps for each of the layers.
std::string lamp_layers(const Effects& effects, bool shaded) {
  const WeightTable slots = slots_of(effects);
  // Layers of maps are drawn without going through the lamps.
  std::string text =
      fmt::format("  if (max(max(slots[0], slots[1]), max(slots[2], slots[3])) >= {0}) {{\n  index2 = W({0}).a;\n",
                  slots.light_slot()) +
      disc_loop(effects, "index2");
  text += fmt::format(R"(    vec3 white = {}{} * light_white[i];
    vec2 let = vec2(seen.x, seen.y * {});
    for (int o = 0; o < {}; ++o) {{
      int slot = slots[o];
      float part = 0.0;
      if (slot == {}) part = seen.x;
)",
                      shaded ? "(i < own_lamps ? 1.0 : lit) * " : "", glsl(kPi), disc_fresnel(effects), kLayersAtOnce,
                      slots.light_slot());
  if (effects.mirror)
    text += fmt::format("      if (slot == {} && distance(r, l) <= disc.y) part = disc.z;\n", slots.lamp_mirror_slot());
  if (!effects.lobes.empty())
    text += fmt::format("      if (slot >= {} && slot <= {}) {{\n      {}      }}\n", slots.directional_diffuse_slot(0),
                        slots.gloss_slot(effects.lobes.size() - 1),
                        over_tilts(effects, "part", "lamp_light", ", slot, l, n, wo, i, let"));
  return text + "      sums[o].rgb += part * white;\n    }\n  }\n  }\n";
}

}  // namespace

std::vector<LightLayer> light_layers(const Effects& effects) {
  const WeightTable slots = slots_of(effects);
  std::vector<LightLayer> layers;
  if (effects.environment) {
    if (effects.diffuse) layers.push_back({WeightTable::diffuse_slot(), false, "diffuse", kDiffusePart});
    if (effects.diffuse && effects.coat)
      layers.push_back({slots.coat_diffuse_slot(), false, "coat_diffuse", kDiffusePart});
    for (std::size_t j = 0; j < effects.lobes.size(); ++j) {
      LightLayer layer{WeightTable::lobe_slot(j), false, fmt::format("lobe_{}", j), effects.lobes[j].exponent};
      if (is_shifted(effects, effects.lobes[j].exponent))
        layer.shift_slot = slots.shift_slot(j), layer.shift_channel = static_cast<int>(j % 4);
      layers.push_back(std::move(layer));
    }
    if (effects.mirror) layers.push_back({slots.mirror_slot(), false, "mirror", paint::kMirrorExponent});
  }
  if (effects.single_lights() == 0) return layers;
  if (effects.diffuse) layers.push_back({slots.light_slot(), true, ""});
  for (std::size_t j = 0; j < effects.lobes.size(); ++j) {
    if (effects.lobes[j].directional_diffuse) layers.push_back({slots.directional_diffuse_slot(j), true, ""});
    if (effects.lobes[j].gloss) layers.push_back({slots.gloss_slot(j), true, ""});
  }
  if (effects.mirror) layers.push_back({slots.lamp_mirror_slot(), true, ""});
  return layers;
}

std::string gathering_fragment_shader(const Effects& effects, bool on_page) {
  const bool lamps = effects.single_lights() > 0, shaded = is_shaded(effects, on_page);
  const bool projected_ground = on_page && effects.background == Background::kEnvironment;
  std::string text =
      std::string(kHead) + "// goniochrome-rendering(7), \"Layers\"\n" + uniforms(effects) + kPixel + kRays;
  text +=
      fmt::format("uniform int slots[{0}];\nuniform float scales[{0}];\nlayout(location = 0) out vec4 layers[{0}];\n",
                  kLayersAtOnce);
  text += kWeight + page_functions(effects, on_page);
  if (lit_gloss(effects)) text += fresnel_function();
  if (effects.coat && lamps) text += kLetIn;
  if (lamps) text += disc_functions(effects.lobes.size()) + "float index2;  // of the coat, squared\n";
  if (effects.environment) text += map_light_function(effects, shaded);
  if (lamps && !effects.lobes.empty()) text += lamp_light_function(effects);
  std::string beside, sums, written;
  for (int o = 0; o < kLayersAtOnce; ++o) {
    beside += fmt::format(
        "    layers[{0}] = slots[{0}] == {1} ? vec4(shown.rgb / scales[{0}], shown.a) : vec4(sent / scales[{0}], "
        "0.0);\n",
        o, kBesideLayer);
    sums += fmt::format("{}vec4(0.0)", o == 0 ? "" : ", ");
    written += fmt::format("  layers[{0}] = sums[{0}] / scales[{0}];\n", o);
  }
  text += start_of_main(effects, on_page, "", background_colors(effects, projected_ground) + beside);
  if (shaded) text += occlusion_start(effects);
  text += tilt_frame(effects) + fmt::format("  vec4 sums[{0}] = vec4[{0}]({1});\n", kLayersAtOnce, sums);
  if (effects.environment) {
    // A brushed surface has lobes about each of its normals; its diffuse part and its mirror have their own.
    const std::string whole = "  sums[o] += map_light(r, slots[o], n);\n";
    text += fmt::format("  for (int o = 0; o < {}; ++o) {{\n", kLayersAtOnce);
    if (effects.anisotropy && !effects.lobes.empty())
      text += fmt::format("    if (slots[o] >= {} && slots[o] <= {}) {{\n    {}    }} else {{\n    {}    }}\n",
                          WeightTable::lobe_slot(0), WeightTable::lobe_slot(effects.lobes.size() - 1),
                          over_tilts(effects, "sums[o]", "map_light", ", slots[o], n"), whole);
    else
      text += "  " + whole;
    text += "  }\n";
  }
  if (lamps) text += lamp_layers(effects, shaded);
  return text + written + "}\n";
}

std::string layers_fragment_shader(const Effects& effects, const color::ReflectionOperator& op) {
  std::string text = std::string(kHead) + "// goniochrome-rendering(7), \"Layers\"\n";
  text += fmt::format(
      R"(uniform sampler2D gbuffer;  // normal, part + 1 (negative: seen from inside)
uniform sampler2D weights;  // a row for each part; two texels for each slot of each segment of the view
uniform sampler2DArray layers;
uniform int count;
uniform ivec2 used[{0}];  // slot, place
uniform float scales[{0}], beside_scale;
uniform int stride;  // pixels of the layers from one of the picture to the next
vec2 pixel() {{ return float(stride) * (gl_FragCoord.xy - 0.5) + 0.5; }}
layout(location = 0) out vec4 color;
)",
      kMostLayers);
  text += std::string(kRays) + kMeshColor + kWeight;
  if (effects.reflection) text += reflection_function(op);
  text += start_of_main(
      effects, true, "  ivec2 at = ivec2(pixel());\n",
      "    vec4 shown = texelFetch(layers, ivec3(at, 0), 0);\n"
      "    color = vec4(beside_scale * shown.rgb, shown.a);\n"
      "    if (count > 0) color.rgb += mesh_color * scales[0] * texelFetch(layers, ivec3(at, used[0].y), 0).rgb;\n");
  return text + fmt::format(R"(  {0} products = {0}(0.0);
  for (int o = 0; o < count; ++o) {{
    vec4 layer = scales[o] * texelFetch(layers, ivec3(at, used[o].y), 0);
    vec3 light = layer.rgb + layer.a * mesh_color;
    products += {1};
  }}
  color = vec4({2}, 1.0);
}}
)",
                            sum_type(effects), product(effects, "light", "W(used[o].x).rgb"),
                            color_of(effects, "products"));
}

}  // namespace goniochrome::render
