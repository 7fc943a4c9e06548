#include "render/gl/gbuffer_shader.h"

namespace goniochrome::render {

namespace {

// The light that a vertex loses, as moments: sums of d and of d d^T over directions, each times its luminance, its
// cosine and its part of the sphere. They are those of both sides, as if the surface were a mirror. Those of the light
// that a white mesh sends to it end with d.
constexpr const char* kMoments = R"(invariant gl_Position;
uniform sampler2D moments_0, moments_1, moments_2, moments_3;
uniform int moment_columns;  // of these pictures, which have a texel for each vertex; 0: nothing is lost
out vec4 first;  // x y z, xx
out vec4 second;  // yy zz xy yz
out vec3 third;  // zx; the light that the other side loses; the share of lamps that is hidden
out vec4 sent;  // x y z, and their number
void occlude() {
  first = second = sent = vec4(0.0), third = vec3(0.0);
  if (moment_columns == 0) return;
  ivec2 at = ivec2(gl_VertexID % moment_columns, gl_VertexID / moment_columns);
  first = texelFetch(moments_0, at, 0), second = texelFetch(moments_1, at, 0), third = texelFetch(moments_2, at, 0).xyz;
  sent = texelFetch(moments_3, at, 0);
}
)";

// The bands of spherical harmonics of what is lost about a direction: their zonal kernels are 2 l + 1 times the
// Legendre polynomials.
constexpr const char* kBands = R"(uniform vec2 turn;  // cosine and sine by which the environment was turned
uniform float reach;  // 1 over a depth that no point has
in vec4 first, second, sent;
in vec3 third;
layout(location = 1) out vec4 occlusion;
vec4 bands(vec3 d, float c) {  // and the light of a white mesh as a lobe of exponent 8 gathers it
  d.xz = vec2(dot(turn, d.xz), turn.x * d.z - turn.y * d.x);
  float all = first.w + second.x + second.y;
  float squares = first.w * d.x * d.x + second.x * d.y * d.y + second.y * d.z * d.z +
                  2.0 * (second.z * d.x * d.y + second.w * d.y * d.z + third.x * d.z * d.x);
  float gathered = max(sent.w + 2.7 * dot(sent.xyz, d), 0.0) / (0.27 + 0.68 * c * c);
  return vec4(all, 3.0 * dot(first.xyz, d), 2.5 * (3.0 * squares - all), gathered);
}
)";

}  // namespace

std::string gbuffer_vertex_shader() {
  return std::string(kHead) + R"(layout(location = 0) in vec3 position;
layout(location = 1) in vec3 vertex_normal;
uniform mat4 clip;
out vec3 normal;
)" + kMoments +
         R"(void main() {
  normal = vertex_normal;
  occlude();
  gl_Position = clip * vec4(position, 1.0);
}
)";
}

std::string gbuffer_fragment_shader() {
  return std::string(kHead) + kPixel + kRays + kBands + R"(uniform int part;
in vec3 normal;
layout(location = 0) out vec4 gbuffer;
void main() {
  float side = gl_FrontFacing ? 1.0 : -1.0;
  vec3 n = side * normalize(normal), wo = -ray();
  // Near an outline the smooth normal can look away from the viewer: the nearest that does not.
  float cos_o = dot(n, wo);
  if (cos_o < 1e-3) n = normalize(n + (1e-3 - cos_o) * wo);
  float hidden = float(part + 1 + 8 * int(15.0 * clamp(third.z, 0.0, 1.0) + 0.5));
  gbuffer = vec4(n, side * (hidden + reach / gl_FragCoord.w));
  float c = dot(n, wo);
  occlusion = gl_FrontFacing ? bands(2.0 * c * n - wo, c) : vec4(third.y, vec3(0.0));
}
)";
}

}  // namespace goniochrome::render
