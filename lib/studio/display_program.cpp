#include "studio/display_program.h"

#include <fmt/format.h>

#include "color/color.h"
#include "display/paint_view.h"

namespace goniochrome::studio {

namespace {

// A matrix in the order of columns, from the images of the unit vectors.
std::string columns(const color::Rgb& r, const color::Rgb& g, const color::Rgb& b) {
  std::string text;
  for (const color::Rgb& column : {r, g, b})
    for (int c = 0; c < 3; ++c) text += fmt::format("{}{:.9e}", text.empty() ? "" : ", ", column[c]);
  return "mat3(" + text + ")";
}

}  // namespace

std::string display_program() {
  const std::string to_rec709 = columns(color::rec709_from_rec2020({1, 0, 0}), color::rec709_from_rec2020({0, 1, 0}),
                                        color::rec709_from_rec2020({0, 0, 1}));
  return fmt::format(R"(#version 300 es
precision highp float;
precision highp sampler2D;
uniform sampler2D picture;  // linear Rec.2020
uniform float gain, share;
uniform int rows;
out vec4 color;

float srgb_signal(float light) {{
  float v = clamp(light, 0.0, 1.0);
  return v <= 0.0031308 ? 12.92 * v : 1.055 * pow(v, 1.0 / 2.4) - 0.055;
}}

vec3 paint_view(vec3 c, float luminance) {{  // linear Rec.709; goniochrome-theory(7), RENDERING
  float least = min(c.x, min(c.y, c.z));
  if (least < 0.0) {{
    float gray = max(0.0, luminance), keep = gray / (gray - least);
    c = keep * c + (1.0 - keep) * gray;
  }}
  float m = max(c.x, max(c.y, c.z));
  if (m <= {0:.9e}) return c;
  float x = (m - {0:.9e}) / {1:.9e};
  return ({0:.9e} + {1:.9e} * x / (1.0 + x)) / m * c;
}}

void main() {{
  vec4 p = texelFetch(picture, ivec2(int(gl_FragCoord.x), rows - 1 - int(gl_FragCoord.y)), 0);
  p *= share;
  vec3 light = gain * p.rgb + (1.0 - p.a) * 0.18;
  float luminance = dot(light, vec3({2:.9e}, {3:.9e}, {4:.9e}));
  vec3 shown = paint_view({5} * light, luminance);
  color = vec4(srgb_signal(shown.r), srgb_signal(shown.g), srgb_signal(shown.b), 1.0);
}}
)",
                     display::kKnee, 1 - display::kKnee, color::xyz_d65_from_rgb({1, 0, 0}).Y,
                     color::xyz_d65_from_rgb({0, 1, 0}).Y, color::xyz_d65_from_rgb({0, 0, 1}).Y, to_rec709);
}

}  // namespace goniochrome::studio
