#include "render/gl/texture_shader.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/text.h"
#include "render/gl/shader_parts.h"
#include "render/surface_layer.h"

namespace goniochrome::render {

namespace {

std::size_t bordered(int size) {
  return static_cast<std::size_t>(size) + 2;
}

// All cubes in the order of TextureProgram.
std::vector<LobeMap> cubes_of(const SbrdfShader& shader) {
  std::vector<LobeMap> cubes = shader.maps();
  if (shader.diffuse().texels != nullptr) cubes.push_back(shader.diffuse());
  return cubes;
}

}  // namespace

TextureProgram texture_program(const Scene& scene, const Effects& effects) {
  TextureProgram program;
  if (scene.layer == nullptr || !scene.layer->textured()) return program;
  const SbrdfShader& shader = *scene.layer->shader();
  program.depth = static_cast<int>(scene.layer->depth()), program.dims = scene.layer->dims();
  for (const std::size_t number : scene.layer->drawn(effects)) {
    TextureProgram::Texture& texture = program.textures.emplace_back();
    texture.lobes = shader.packed(number).lobes;
    int row = 0;
    for (int level = 1; effects.texture_filter && level <= shader.levels(number); ++level) {
      const PackedTexture& packed = shader.packed(number, level, effects.texture_lobes);
      texture.levels.push_back({packed.width, packed.height, row});
      texture.level_lobes = std::max(texture.level_lobes, packed.lobes);
      row += packed.height;
    }
  }
  if (!effects.environment) return program;
  int row = 0;
  for (const LobeMap& map : cubes_of(shader)) {
    program.cubes.push_back({map.size, row});
    row += map.size + 2;
  }
  program.horizon_rows = shader.horizon_rows();
  return program;
}

bool TextureProgram::filtered() const {
  return std::ranges::any_of(textures, [](const Texture& texture) { return !texture.levels.empty(); });
}

namespace {

// From the row on, in a texture of so many texels a layer.
void put_layers(const PackedTexture& texture, int row, TextureLayers& result) {
  const std::size_t texels = static_cast<std::size_t>(result.width) * static_cast<std::size_t>(result.height),
                    wide = static_cast<std::size_t>(texture.width);
  for (std::size_t i = 0; i < wide * static_cast<std::size_t>(texture.height); ++i) {
    const float *color = texture.colors_of(i), *shape = texture.shape_of(i);
    float* to = &result.rgba[4 * ((static_cast<std::size_t>(row) + i / wide) * static_cast<std::size_t>(result.width) +
                                  i % wide)];
    std::copy_n(color, 3, to);
    for (int lobe = 0; lobe < texture.lobes; ++lobe, shape += kShapeFloats) {
      to += 4 * texels;
      std::copy_n(color += 4, 3, to);
      to[3] = shape[kLobeAlbedo];
      to += 4 * texels;
      std::copy_n(shape + kLobeAxes, 4, to);
      to += 4 * texels;
      to[0] = shape[kLobeMap] + shape[kLobeMap + 1];
      to[1] = shape[kLobeHorizon] + shape[kLobeHorizon + 1];
      to[2] = std::atan2(shape[kLobeTurn + 1], shape[kLobeTurn]);
    }
  }
}

TextureLayers empty_layers(int width, int height, int lobes) {
  TextureLayers result{width, height, 1 + kTextureLobeLayers * lobes, {}};
  result.rgba.resize(4 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height) *
                     static_cast<std::size_t>(result.layers));
  // Lobes that are not there have the logarithm of no albedo.
  const std::size_t layer = 4 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  for (std::size_t lobe = 0; lobe < static_cast<std::size_t>(lobes); ++lobe) {
    float* first = &result.rgba[(1 + kTextureLobeLayers * lobe) * layer];
    for (std::size_t i = 3; i < layer; i += 4) first[i] = kNoLobe;
  }
  return result;
}

}  // namespace

TextureLayers texture_layers(const PackedTexture& texture) {
  TextureLayers result = empty_layers(texture.width, texture.height, texture.lobes);
  put_layers(texture, 0, result);
  return result;
}

TextureLayers level_layers(const SbrdfShader& shader, std::size_t number, std::uint32_t lobes,
                           const TextureProgram::Texture& texture) {
  const TextureProgram::Level &first = texture.levels.front(), &last = texture.levels.back();
  TextureLayers result = empty_layers(first.width, last.row + last.height, texture.level_lobes);
  for (std::size_t i = 0; i < texture.levels.size(); ++i)
    put_layers(shader.packed(number, static_cast<int>(i) + 1, lobes), texture.levels[i].row, result);
  return result;
}

FloatTexture lobe_map_texture(const SbrdfShader& shader) {
  FloatTexture texture;
  const std::vector<LobeMap> cubes = cubes_of(shader);
  for (const LobeMap& map : cubes) {
    texture.columns = std::max(texture.columns, 6 * (map.size + 2));
    texture.rows += map.size + 2;
  }
  texture.rgba.resize(4 * static_cast<std::size_t>(texture.columns) * static_cast<std::size_t>(texture.rows));
  float* to = texture.rgba.data();
  for (const LobeMap& map : cubes) {
    const std::size_t wide = bordered(map.size);
    for (std::size_t row = 0; row < wide; ++row, to += 4 * static_cast<std::size_t>(texture.columns))
      for (std::size_t face = 0; face < 6; ++face)
        std::copy_n(map.texels + 4 * wide * (face * wide + row), 4 * wide, to + 4 * face * wide);
  }
  return texture;
}

FloatTexture lobe_horizon_texture(const SbrdfShader& shader) {
  FloatTexture texture{kTextureHorizonSegments + 1, shader.horizon_rows(), {}};
  for (std::size_t i = 0; i + 1 < shader.horizon().size(); i += 2)
    texture.rgba.insert(texture.rgba.end(), {shader.horizon()[i], shader.horizon()[i + 1], 0.0F, 0.0F});
  return texture;
}

TextureLayers place_layers(const SurfaceLayer& layer, const Effects& effects, const Gbuffer& gbuffer,
                           const std::vector<TexturePlace>& places, double share) {
  const std::size_t pixels = static_cast<std::size_t>(gbuffer.width) * static_cast<std::size_t>(gbuffer.height);
  const auto layers = kPlaceLayers * layer.depth();
  TextureLayers result{gbuffer.width, gbuffer.height, static_cast<int>(layers), {}};
  result.rgba.assign(4 * layers * pixels, 0.0F);
  const std::vector<std::size_t> drawn = layer.drawn(effects);
  // The program counts from 0 to below 1, so that it has all digits for the place within the texture.
  const auto within = [](double x) {
    if (!std::isfinite(x)) return 0.0F;
    return std::min(static_cast<float>(x - std::floor(x)), 1 - std::numeric_limits<float>::epsilon());
  };
  SurfaceLayer::Stack seen;
  const double scale = std::sqrt(share);
  const auto put = [&](const SurfaceLayer::Shown& shown, float* to) {
    to[0] = within(shown.repeat * shown.place->u), to[1] = within(shown.repeat * shown.place->v);
    to[2] = static_cast<float>(std::ranges::find(drawn, shown.number) - drawn.begin() + 1);
    to[3] = static_cast<float>(shown.probes.level);
    to += 4 * pixels;
    std::copy_n(shown.repeated.tangent, 3, to);
    to[3] = static_cast<float>(kMostProbes * shown.probes.down + shown.probes.across - 1);
    to += 4 * pixels;
    for (std::size_t c = 0; c < 2; ++c) {
      to[c] = static_cast<float>(scale * shown.probes.wide * shown.repeated.across[c]);
      to[2 + c] = static_cast<float>(scale * shown.probes.high * shown.repeated.down[c]);
    }
    to += 4 * pixels;
    to[0] = static_cast<float>(shown.share);
  };
  for (std::size_t i = 0; i < pixels; ++i) {
    const int part = static_cast<int>(std::abs(gbuffer.data[4 * i + 3])) - 1;
    if (part < 0 || layer.surface(part).texture == nullptr) continue;
    layer.stack(part, &places[i], pixels, effects, scale, seen);
    for (std::size_t level = 0; level < seen.count; ++level)
      if (seen.shown[level].share > 0) put(seen.shown[level], &result.rgba[4 * (kPlaceLayers * level * pixels + i)]);
    result.rgba[4 * ((kPlaceLayers - 1) * pixels + i) + 1] = static_cast<float>(1 - seen.bare);
  }
  return result;
}

std::string texture_uniforms(const TextureProgram& textures, const Effects& effects) {
  if (!textures.any()) return "";
  std::string text =
      "uniform sampler2DArray places;  // for each texture of a part: u, v, number of the texture + 1, level; tangent, "
      "probes; footprint; share, part of the paint that is covered\n";
  for (std::size_t i = 0; i < textures.textures.size(); ++i) {
    text += fmt::format(
        "uniform sampler2DArray texture_{};  // diffuse; {} x (color, log albedo; axes, exponent; cube, row, angle)\n",
        i, textures.textures[i].lobes);
    if (!textures.textures[i].levels.empty())
      text += fmt::format("uniform sampler2DArray levels_{};  // likewise, {} lobes, one level below the other\n", i,
                          textures.textures[i].level_lobes);
  }
  if (!textures.cubes.empty()) {
    text +=
        "uniform sampler2D lobe_maps;  // P_E on cubes: faces with a border side by side, cube above cube\n"
        "uniform sampler2D lobe_horizon;  // a row for each exponent, by the root of the cosine\n";
  }
  if (effects.lights > 0)
    text += fmt::format("uniform float light_variance[{}];  // of the disc, in rad^2\n", effects.lights);
  return text;
}

namespace {

// The face that a direction meets as OpenGL has it (table 8.19 of the specification), and the four texels there.
std::string cube_functions(const TextureProgram& textures) {
  std::string list;
  for (const TextureProgram::Cube& cube : textures.cubes)
    list += fmt::format("{}ivec2({}, {})", list.empty() ? "" : ", ", cube.size, cube.row);
  const std::size_t count = textures.cubes.size();
  return fmt::format(R"(
const ivec2 kLobeMaps[{0}] = ivec2[{0}]({1});  // texels along a face, first row
vec3 lobe_light(int map, vec3 d) {{  // P_E toward d
  vec3 size = abs(d);
  float axis;
  vec2 p;
  int face;
  if (size.x >= size.y && size.x >= size.z) {{
    axis = d.x, p = vec2(axis < 0.0 ? d.z : -d.z, -d.y), face = 0;
  }} else if (size.y >= size.z) {{
    axis = d.y, p = vec2(d.x, axis < 0.0 ? -d.z : d.z), face = 2;
  }} else {{
    axis = d.z, p = vec2(axis < 0.0 ? -d.x : d.x, -d.y), face = 4;
  }}
  if (axis < 0.0) ++face;
  int wide = kLobeMaps[map].x + 2;
  float n = float(kLobeMaps[map].x);
  vec2 at = clamp(0.5 * n / abs(axis) * p + 0.5 * n + 0.5, 0.0, n + 0.999), whole = floor(at), part = at - whole;
  ivec2 first = ivec2(whole) + ivec2(face * wide, kLobeMaps[map].y);
  vec3 a = texelFetch(lobe_maps, first, 0).rgb, b = texelFetch(lobe_maps, first + ivec2(1, 0), 0).rgb;
  vec3 c = texelFetch(lobe_maps, first + ivec2(0, 1), 0).rgb, e = texelFetch(lobe_maps, first + ivec2(1, 1), 0).rgb;
  return mix(mix(a, b, part.x), mix(c, e, part.x), part.y);
}}
vec3 blended_lobe_light(float cube, vec3 d) {{  // of an exponent between those of two cubes
  int map = int(cube);
  float share = cube - float(map);
  vec3 light = lobe_light(map, d);
  return share > 0.0 ? mix(light, lobe_light(map + 1, d), share) : light;
}}
vec2 lobe_above(float row, float cosine) {{  // mean cosine of the part of a lobe above the surface, and its shift
  int low = int(row), high = min(low + 1, {2});
  float share = row - float(low), x = sqrt(min(cosine, 1.0)) * {3}.0;
  int at = min(int(x), {3} - 1);
  float t = x - float(at);
  vec2 a = mix(texelFetch(lobe_horizon, ivec2(at, low), 0).xy, texelFetch(lobe_horizon, ivec2(at + 1, low), 0).xy, t);
  vec2 b = mix(texelFetch(lobe_horizon, ivec2(at, high), 0).xy, texelFetch(lobe_horizon, ivec2(at + 1, high), 0).xy, t);
  return mix(a, b, share);
}}
)",
                     count, list, textures.horizon_rows - 1, kTextureHorizonSegments);
}

// Logarithms from the distance to 1, which are exact near it; and exp, 0 below what it holds.
constexpr const char* kPowers = R"(
float log_1p(float x) {
  return abs(x) < 0.02 ? x * (1.0 - x * (0.5 - x * (0.33333333 - x * 0.25))) : log(1.0 + x);
}
float bounded_exp(float x) { return x > -80.0 ? exp(min(x, 87.0)) : 0.0; }
)";

// One lobe under the environment: log energy = log(2 pi/(n+1)) + log albedo, by the light about its middle.
std::string environment_lobe(const Effects& effects) {
  return fmt::format(R"(      if (m.z > 0.0) {{
        vec2 above = lobe_above(where.y, m.z);
        vec3 d = (turn.x * m.x - turn.y * m.y) * t + (turn.y * m.x + turn.x * m.y) * b + (m.z + above.y) * n;
        vec3 light = blended_lobe_light(where.x, d);
        vec3 of = share * above.x * bounded_exp(log(6.2831853 / (shape.w + 1.0)) + lobe.w + power) * lobe.rgb;
        sum += {};
      }}
)",
                     times(effects, "light", "of"));
}

// One lobe under the lights: the exact BRDF. Discs are Gaussians of the same variance.
std::string lit_lobe(const Effects& effects) {
  const bool finds = finds_lamps(effects);
  return fmt::format(R"(      for (int i = 0; i < {0}; ++i) {{
        vec3 l = vec3(dot({1}, t), dot({1}, b), dot({1}, n));
        if (l.z <= 0.0) continue;
        vec3 apart = m - vec3(turn.x * l.x + turn.y * l.y, turn.x * l.y - turn.y * l.x, l.z);
        float versine = 0.5 * dot(apart, apart), lowered = 1.0 / (shape.w * {2} + 1.0);
        if (versine >= 1.0) continue;
        vec3 of = share * l.z * lowered * bounded_exp(lowered * shape.w * log_1p(-versine) + power + lobe.w) * lobe.rgb;
        vec3 light = 3.14159265 * {3};
        sum += {4};
      }}
)",
                     effects.lights, lamp_direction(effects), finds ? "lamp_variance[i]" : "light_variance[i]",
                     lamp_white(effects), times(effects, "light", "of"));
}

std::string diffuse_terms(const TextureProgram& textures, const Effects& effects) {
  std::string text = "  vec3 light = vec3(0.0);\n";
  if (!textures.cubes.empty())
    text += fmt::format("  light += 3.14159265 * lobe_light({}, n);\n", textures.cubes.size() - 1);
  if (effects.lights > 0) {
    text += fmt::format("  for (int i = 0; i < {}; ++i) light += 3.14159265 * max(dot({}, n), 0.0) * {};\n",
                        effects.lights, lamp_direction(effects), lamp_white(effects));
  }
  return text + fmt::format("  return sum + {};\n", times(effects, "light", "diffuse"));
}

// The mean over the probes of a pixel, which lie within the texture once it is taken to repeat.
std::string probed_function(const TextureProgram& textures, std::uint32_t on) {
  std::string text = fmt::format(R"(vec3 textured(ivec2 at, int map, vec3 n, vec3 wo) {{
  ivec3 layer = ivec3(at, {} * map);
  vec4 place = texelFetch(places, layer, 0), tangent = texelFetch(places, layer + ivec3(0, 0, 1), 0);
  float share = texelFetch(places, layer + ivec3(0, 0, 3), 0).x;
)",
                                 kPlaceLayers);
  if (!textures.filtered()) {
    for (std::size_t i = 0; i < textures.textures.size(); ++i) {
      text += fmt::format(
          "  if (place.z == {0}.0) return share * texels(texture_{1}, {2}, {3}u, ivec3(textureSize(texture_{1}, 0).xy, "
          "0), "
          "place.xy, tangent.xyz, n, wo);\n",
          i + 1, i, textures.textures[i].lobes, on);
    }
    return text + "  return vec3(0.0);\n}\n";
  }
  text += fmt::format(R"(  if (place.z == 0.0) return vec3(0.0);
  vec4 footprint = texelFetch(places, layer + ivec3(0, 0, 2), 0);
  int across = int(tangent.w) % {0} + 1, down = int(tangent.w) / {0}, level = int(place.w);
  vec3 sum = vec3(0.0);
  for (int i = 0; i < across * down; ++i) {{
    vec2 in_pixel = (vec2(i % across, i / across) + 0.5) / vec2(across, down) - 0.5;
    vec2 probe = fract(place.xy + in_pixel.x * footprint.xy + in_pixel.y * footprint.zw);
)",
                      kMostProbes);
  for (std::size_t i = 0; i < textures.textures.size(); ++i) {
    const TextureProgram::Texture& texture = textures.textures[i];
    std::string levels;
    for (const TextureProgram::Level& level : texture.levels)
      levels += fmt::format("{}ivec3({}, {}, {})", levels.empty() ? "" : ", ", level.width, level.height, level.row);
    text += fmt::format(
        "    if (place.z == {}.0{}) sum += texels(texture_{}, {}, {}u, ivec3(textureSize(texture_{}, 0).xy, 0), "
        "probe, tangent.xyz, n, wo);\n",
        i + 1, levels.empty() ? "" : " && level == 0", i, texture.lobes, on, i);
    if (levels.empty()) continue;
    text += fmt::format(
        "    if (place.z == {}.0 && level > 0)\n      sum += texels(levels_{}, {}, ~0u, ivec3[{}]({})[level - 1], "
        "probe, tangent.xyz, n, wo);\n",
        i + 1, i, texture.level_lobes, texture.levels.size(), levels);
  }
  return text + "  }\n  return share / float(across * down) * sum;\n}\n";
}

}  // namespace

std::string texture_terms(const TextureProgram& textures) {
  if (!textures.any()) return "";
  std::string text = "\n  // the textures\n  ivec2 at = ivec2(gl_FragCoord.xy);\n";
  if (textures.dims)
    text += fmt::format("  radiance *= 1.0 - texelFetch(places, ivec3(at, {}), 0).y;  // the paint beneath\n",
                        kPlaceLayers - 1);
  if (textures.depth == 1) return text + "  radiance += textured(at, 0, n, wo);\n";
  return text +
         fmt::format("  for (int map = 0; map < {}; ++map) radiance += textured(at, map, n, wo);\n", textures.depth);
}

// The four texels around a place are shaded one by one, and their colors blended.
std::string texture_function(const TextureProgram& textures, const Effects& effects) {
  if (!textures.any()) return "";
  std::string text = kPowers;
  if (!textures.cubes.empty()) text += cube_functions(textures);
  text += fmt::format(
      R"(
vec3 texels(sampler2DArray map, int lobes, uint on, ivec3 level, vec2 place, vec3 tangent, vec3 n, vec3 wo) {{
  // The frame of the surface. A tangent along the normal says nothing: any direction in the surface will do.
  vec3 t = tangent - dot(tangent, n) * n, other = abs(n.x) < 0.7 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0);
  if (dot(t, t) < 1e-12) t = other - dot(other, n) * n;
  t = normalize(t);
  vec3 b = cross(n, t), v = vec3(dot(wo, t), dot(wo, b), dot(wo, n));
  if (v.z <= 0.0) return vec3(0.0);
  ivec2 size = level.xy;
  vec2 at = vec2(place.x, 1.0 - place.y) * vec2(size) - 0.5, low = floor(at), part = at - low;
  vec3 sum = vec3(0.0), diffuse = vec3(0.0);
  for (int tap = 0; tap < 4; ++tap) {{
    ivec2 next = ivec2(tap & 1, tap >> 1);
    float share = (next.x == 1 ? part.x : 1.0 - part.x) * (next.y == 1 ? part.y : 1.0 - part.y);
    if (share <= 0.0) continue;
    ivec2 texel = (ivec2(low) + next + size) % size + ivec2(0, level.z);
    diffuse += share * texelFetch(map, ivec3(texel, 0), 0).rgb;
    for (int k = 0; k < lobes; ++k) {{
      if ((on >> uint(k) & 1u) == 0u) continue;
      ivec3 layer = ivec3(texel, 1 + {} * k);
      vec4 lobe = texelFetch(map, layer, 0), shape = texelFetch(map, layer + ivec3(0, 0, 1), 0);
      vec3 where = texelFetch(map, layer + ivec3(0, 0, 2), 0).xyz;
      vec2 turn = vec2(cos(where.z), sin(where.z));  // from the tangent to the lobe's x axis
      vec3 w = vec3(turn.x * v.x + turn.y * v.y, turn.x * v.y - turn.y * v.x, v.z);
      // p = C wo, its direction m, and log |p|^n from |p|^2 - 1, which is exact where a lobe mirrors.
      vec3 p = shape.xyz * w;
      float size2 = max(dot(p, p), 1e-30), excess = dot((shape.xyz - 1.0) * (shape.xyz + 1.0), w * w);
      float power = 0.5 * shape.w * (size2 < 0.5 ? log(size2) : log_1p(max(excess, -0.5)));
      vec3 m = p * inversesqrt(size2);
{}{}    }}
  }}
{}}}
)",
      kTextureLobeLayers, textures.cubes.empty() ? "" : environment_lobe(effects),
      effects.lights > 0 ? lit_lobe(effects) : "", diffuse_terms(textures, effects));
  return text + probed_function(textures, effects.texture_lobes);
}

}  // namespace goniochrome::render
