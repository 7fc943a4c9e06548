#include "render/gl/tilt_shader.h"

#include <algorithm>

#include "base/text.h"
#include "render/gl/shader_parts.h"

namespace goniochrome::render {

namespace {

std::size_t header_texels(std::size_t maps) {
  return (maps + 4) / 4;
}

}  // namespace

TiltTexture tilt_texture(const TiltTable& table, std::size_t maps) {
  TiltTexture texture;
  const std::size_t header = header_texels(maps), parts = table.group_of_part.size();
  texture.stride = header + 4 * table.most();
  const std::size_t texels = parts + table.rows.size() * texture.stride;
  texture.rgba.assign(4 * kTiltTexels * ((texels + kTiltTexels - 1) / kTiltTexels), 0.0F);
  for (std::size_t part = 0; part < parts; ++part) {
    const auto first = static_cast<std::size_t>(table.group_of_part[part] * table.segments);
    texture.rgba[4 * part] = static_cast<float>(parts + first * texture.stride);
  }
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    float* to = &texture.rgba[4 * (parts + row * texture.stride)];
    std::size_t at = 0;
    for (std::size_t map = 0; map <= maps; ++map) {
      while (at < table.rows[row].size() && table.rows[row][at].map < map) ++at;
      to[map] = static_cast<float>(at);
    }
    to += 4 * header;
    for (const TiltLookup& of : table.rows[row]) {
      std::ranges::copy(of.axis, to), std::ranges::copy(of.axis_step, to + 4);
      std::ranges::copy(of.weight, to + 8), std::ranges::copy(of.weight_step, to + 12);
      to += 16;
    }
  }
  return texture;
}

std::string tilt_sampler(const Effects& effects, const std::vector<double>& exponents, double exponent) {
  const auto lobe = std::ranges::find(effects.lobes, exponent, &Effects::LobeUse::exponent);
  // Bright spots are taken out of the maps of lobes alone.
  if (lobe != effects.lobes.end() && effects.spots == 0) return fmt::format("lobe_{}", lobe - effects.lobes.begin());
  return fmt::format("tilted_{}", std::ranges::find(exponents, exponent) - exponents.begin());
}

std::string tilt_uniforms(const Effects& effects, const std::vector<double>& exponents) {
  if (exponents.empty()) return "";
  std::string text = "uniform sampler2D tilted;  // look-ups of tilted lobes\nuniform int tilt_stride;\n";
  for (const double exponent : exponents) {
    const std::string sampler = tilt_sampler(effects, exponents, exponent);
    if (sampler.starts_with("tilted_"))
      text += fmt::format("uniform samplerCube {};  // P_E, E = {}\n", sampler, shortest(exponent));
  }
  return text;
}

std::string tilt_function(const Effects& effects, const std::vector<double>& exponents) {
  if (exponents.empty()) return "";
  std::string text = fmt::format(R"(
vec4 tilt_texel(int at) {{ return texelFetch(tilted, ivec2(at % {0}, at / {0}), 0); }}

{1} tilted_lobes(vec3 r, vec3 n, vec3 wo) {{  // about axes a r + s n + c (n x wo)
  {1} sum = {1}(0.0);
  vec3 q = cross(n, wo);
  float view = {2}.0 * sqrt(dot(n, wo));
  int segment = min(int(view), {3});
  float share = view - float(segment);
  int base = int(tilt_texel(row).x) + segment * tilt_stride;
)",
                                 kTiltTexels, sum_type(effects), kViewSegments, kViewSegments - 1);
  for (std::size_t map = 0; map < exponents.size(); ++map) {
    const auto bound = [](std::size_t number) {
      return fmt::format("int(tilt_texel(base + {}).{})", number / 4, "rgba"[number % 4]);
    };
    const std::string light =
        fmt::format("textureLod({}, d, 0.0).rgb", tilt_sampler(effects, exponents, exponents[map]));
    const std::string term = product(effects, "(tilt_texel(at + 2) + share * tilt_texel(at + 3)).rgb", light);
    text += fmt::format(R"(  for (int k = {}, end = {}; k < end; ++k) {{
    int at = base + {} + 4 * k;
    vec3 axis = tilt_texel(at).xyz + share * tilt_texel(at + 1).xyz;
    vec3 d = axis.x * r + axis.y * n + axis.z * q;
    sum += {};
  }}
)",
                        bound(map), bound(map + 1), header_texels(exponents.size()), term);
  }
  return text + "  return sum;\n}\n";
}

}  // namespace goniochrome::render
