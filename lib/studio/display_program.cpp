#include "studio/display_program.h"

#include <fmt/format.h>

#include "color/color.h"

namespace goniochrome::studio {

std::string display_program() {
  return fmt::format(R"(#version 300 es
precision highp float;
precision highp sampler2D;
uniform sampler2D picture;  // linear Rec.2020
uniform float gain;
uniform mat3 to_screen;
uniform int rows, stride;  // of the screen; pixels of it from one of the picture to the next
out vec4 color;

float srgb_signal(float light) {{
  float v = clamp(light, 0.0, 1.0);
  return v <= 0.0031308 ? 12.92 * v : 1.055 * pow(v, 1.0 / 2.4) - 0.055;
}}

vec3 paint_view(vec3 c, float luminance) {{  // in the screen's primaries; goniochrome-rendering(7), "RENDERING"
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
  vec4 p = texelFetch(picture, ivec2(int(gl_FragCoord.x), rows - 1 - int(gl_FragCoord.y)) / stride, 0);
  vec3 light = gain * p.rgb + (1.0 - p.a) * 0.18;
  float luminance = dot(light, vec3({2:.9e}, {3:.9e}, {4:.9e}));
  vec3 shown = paint_view(to_screen * light, luminance);
  color = vec4(srgb_signal(shown.r), srgb_signal(shown.g), srgb_signal(shown.b), 1.0);
}}
)",
                     display::kKnee, 1 - display::kKnee, color::luminance({1, 0, 0}), color::luminance({0, 1, 0}),
                     color::luminance({0, 0, 1}));
}

std::vector<double> to_screen(display::Screen screen) {
  std::vector<double> columns;
  for (const color::Rgb& unit : {color::Rgb{1, 0, 0}, color::Rgb{0, 1, 0}, color::Rgb{0, 0, 1}}) {
    const color::Rgb column = display::screen_light(unit, screen);
    for (int c = 0; c < 3; ++c) columns.push_back(column[c]);
  }
  return columns;
}

std::string overlay_program() {
  return R"(#version 300 es
precision highp float;
precision highp sampler2D;
uniform sampler2D gbuffer;  // normal, part + 1
uniform vec3 corner, right, down;  // the ray through a pixel, from the upper left
uniform vec3 toward;  // the light
uniform float travel, edge;  // degrees
uniform int rows;
out vec4 color;  // times its share of the pixel

vec4 over(vec4 below, vec3 above, float share) { return vec4(share * above, share) + (1.0 - share) * below; }

void main() {
  ivec2 at = ivec2(int(gl_FragCoord.x), rows - 1 - int(gl_FragCoord.y));
  vec4 point = texelFetch(gbuffer, at, 0);
  vec3 wo = -normalize(corner + gl_FragCoord.x * right + (float(rows) - gl_FragCoord.y) * down);
  vec3 r = 2.0 * dot(point.xyz, wo) * point.xyz - wo;
  float angle = degrees(atan(length(cross(r, toward)), dot(r, toward)));
  float pixel = clamp(fwidth(angle), 0.02, 3.0);
  color = vec4(0.0);
  if ((int(abs(point.w)) & 7) != 1 || dot(point.xyz, toward) <= 0.0) return;  // the first row of weights is the paint
  if (angle < edge) {
    bool even = ((at.x / 6 + at.y / 6) & 1) == 0;
    color = over(color, vec3(even ? 1.0 : 0.0), 0.45);
  }
  float angles[3] = float[3](15.0, 45.0, travel);
  vec3 colors[3] = vec3[3](vec3(1.0, 0.83, 0.1), vec3(0.2, 0.9, 1.0), vec3(1.0, 0.45, 0.9));
  for (int i = 0; i < 3; ++i) {
    float apart = abs(angle - angles[i]) / pixel;
    color = over(color, vec3(0.0), 0.6 * (1.0 - smoothstep(2.0, 3.0, apart)));
    color = over(color, colors[i], 1.0 - smoothstep(0.8, 1.6, apart));
  }
}
)";
}

}  // namespace goniochrome::studio
