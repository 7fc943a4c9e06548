#include "render/gl/exact_lookups.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "base/random_for_test.h"
#include "envmap/cube_map.h"
#include "render/gl/gl.h"
#include "render/scenes_for_test.h"

namespace goniochrome::render::exact_lookups_test {
namespace {

constexpr int kSide = 64;  // directions in a row, and rows

const std::string kVertex = R"(#version 330 core
void main() { gl_Position = vec4(4.0 * float(gl_VertexID & 1) - 1.0, 4.0 * float(gl_VertexID >> 1) - 1.0, 0.0, 1.0); }
)";
const std::string kFragment = R"(#version 330 core
uniform sampler2D directions;
uniform samplerCube map;
layout(location = 0) out vec4 color;
void main() {
  vec3 d = texelFetch(directions, ivec2(gl_FragCoord.xy), 0).xyz;
  color = vec4(textureLod(map, d, 0.0).rgb, 1.0);
}
)";

// All over the sphere; across the edges of the cube; and about its corners, where three texels meet.
std::vector<Vec3> directions() {
  std::vector<Vec3> all;
  TestNumbers random(5);
  const auto within = [&](double most) { return most * (2 * random() - 1); };
  while (all.size() < kSide * kSide) {
    const double sign_x = within(1) < 0 ? -1 : 1, sign_y = within(1) < 0 ? -1 : 1, sign_z = within(1) < 0 ? -1 : 1;
    all.push_back({within(1), within(1), within(1)});
    all.push_back({sign_x, sign_y * (1 + within(0.1)), within(1)});
    all.push_back({sign_x * (1 + within(0.1)), sign_y * (1 + within(0.1)), sign_z * (1 + within(0.1))});
    all.push_back({sign_x, sign_y, sign_z});
  }
  all.resize(kSide * kSide);
  return all;
}

// The values that a program reads of the map in these directions, by the filter of the textures.
std::vector<float> looked_up(const GlContext& gl, const std::string& fragment, const envmap::CubeMap& map,
                             const std::vector<Vec3>& toward, GLint filter) {
  std::vector<float> rgba;
  for (const Vec3& d : toward)
    for (const double value : {d.x, d.y, d.z, 0.0}) rgba.push_back(static_cast<float>(value));
  const auto program = gl.program(kVertex, fragment);
  EXPECT_TRUE(program.ok()) << program.error().message;
  GLuint texture = 0, target = 0, cube = 0, nothing = 0;
  gl.float_target(kSide, kSide, texture, target);
  gl.GenVertexArrays(1, &nothing);
  gl.BindVertexArray(nothing);
  gl.Viewport(0, 0, kSide, kSide);
  gl.UseProgram(*program);
  gl.ActiveTexture(GL_TEXTURE0);
  gl.float_texture(kSide, kSide, rgba.data());
  gl.Uniform1i(gl.GetUniformLocation(*program, "directions"), 0);
  gl.ActiveTexture(GL_TEXTURE0 + 1);
  gl.GenTextures(1, &cube);
  gl.BindTexture(GL_TEXTURE_CUBE_MAP, cube);
  for (int face = 0; face < 6; ++face)
    gl.TexImage2D(GL_TEXTURE_CUBE_MAP_POSITIVE_X + static_cast<GLenum>(face), 0, GL_RGB32F, map.size, map.size, 0,
                  GL_RGB, GL_FLOAT, map.at(face, 0, 0));
  gl.TexParameteri(GL_TEXTURE_CUBE_MAP, GL_TEXTURE_MIN_FILTER, filter);
  gl.TexParameteri(GL_TEXTURE_CUBE_MAP, GL_TEXTURE_MAG_FILTER, filter);
  gl.Uniform1i(gl.GetUniformLocation(*program, "map"), 1);
  gl.DrawArrays(GL_TRIANGLES, 0, 3);
  gl.ReadPixels(0, 0, kSide, kSide, GL_RGBA, GL_FLOAT, rgba.data());
  EXPECT_TRUE(gl.status("testing").ok());
  return rgba;
}

double worst_error(const std::vector<float>& rgba, const envmap::CubeMap& map, const std::vector<Vec3>& toward) {
  double worst = 0;
  for (std::size_t i = 0; i < toward.size(); ++i) {
    const Vec3 wanted = envmap::bilinear(map, toward[i]);
    for (int c = 0; c < 3; ++c)
      worst = std::max(worst, std::abs(rgba[4 * i + static_cast<std::size_t>(c)] - wanted[c]));
  }
  return worst;
}

// Texels go from 0 to 1. Coordinates on a face of n texels are known to some n * 2^-23, and so is the share of a texel:
// 3e-6 of the difference of two texels at n = 23. The nearest texel alone is the control, and so are shares in steps
// of 1/256, as GPUs have them, which err by up to 1/512.
TEST(ExactLookups, InterpolateAsTheProcessorDoes) {
  const auto gl = GlContext::create();
  if (!gl.ok()) GTEST_SKIP() << gl.error().message;
  const std::vector<Vec3> toward = directions();
  for (const int size : {1, 2, 5, 23}) {
    TestNumbers random(9);
    const envmap::CubeMap map = cube_of(size, [&](const Vec3&) { return Vec3{random(), random(), random()}; });
    const std::string exact = with_exact_lookups(kFragment);
    EXPECT_LT(worst_error(looked_up(*gl, exact, map, toward, GL_NEAREST), map, toward), 1e-5) << size;
    EXPECT_GT(worst_error(looked_up(*gl, kFragment, map, toward, GL_NEAREST), map, toward), size > 1 ? 0.3 : 0.1);
  }
}

TEST(ExactLookups, ReplaceEveryLookup) {
  const std::string text = with_exact_lookups("#version 330 core\nA textureLod(a, d, 0.0) textureLod(b, d, 0.0)\n");
  EXPECT_TRUE(text.starts_with("#version 330 core\n"));
  EXPECT_NE(text.find("A exact_lookup(a, d, 0.0) exact_lookup(b, d, 0.0)"), std::string::npos);
}

}  // namespace
}  // namespace goniochrome::render::exact_lookups_test
