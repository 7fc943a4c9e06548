#include "render/gl/gbuffer_shader.h"

namespace goniochrome::render {

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

}  // namespace goniochrome::render
