#include "render/gbuffer.h"

#include <algorithm>
#include <cmath>

#include "render/gl/gbuffer_shader.h"
#include "render/gl/gl.h"

namespace goniochrome::render {

int Gbuffer::part(int x, int y) const {
  return static_cast<int>(std::abs(at(x, y)[3])) - 1;
}

bool Gbuffer::shows_inside() const {
  for (std::size_t i = 3; i < data.size(); i += 4)
    if (data[i] < 0) return true;
  return false;
}

Vec3 Gbuffer::normal(int x, int y) const {
  const float* n = at(x, y);
  return normalized({n[0], n[1], n[2]});
}

VisiblePoint Gbuffer::point(int x, int y, const std::vector<TexturePlace>& places, const mesh::Mesh* mesh) const {
  VisiblePoint point{normal(x, y), to_viewer(x, y), part(x, y)};
  if (mesh != nullptr && !triangles.empty()) point.position = mesh_point(*mesh, *this, x, y).position;
  if (places.empty()) return point;
  const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  point.placed = true, point.place = places[index(x, y)];
  for (std::size_t i = index(x, y) + pixels; i < places.size(); i += pixels) point.over.push_back(places[i]);
  return point;
}

// By Cramer's rule from the origin's place beside the first corner: in the edges a and b, the ray meets the plane at
// (share of a, share of b) = (d x b . s, d . s x a)/(d x b . a).
PlaneHit plane_hit(const mesh::Mesh& mesh, std::uint32_t triangle, const Vec3& origin, const Vec3& direction) {
  const auto& corners = mesh.triangles[triangle];
  const Vec3 &p = mesh.positions[corners[0]], &q = mesh.positions[corners[1]], &r = mesh.positions[corners[2]];
  const Vec3 a = q - p, b = r - p, s = origin - p, across = cross(direction, b);
  const double determinant = dot(across, a);
  PlaneHit hit;
  if (determinant == 0) return hit;
  const Vec3 turned = cross(s, a);
  const double v = dot(across, s) / determinant, w = dot(direction, turned) / determinant;
  hit.shares = {1 - v - w, v, w};
  hit.ahead = dot(b, turned) / determinant > 0;
  return hit;
}

MeshPoint mesh_point(const mesh::Mesh& mesh, std::uint32_t triangle, const Vec3& origin, const Vec3& direction) {
  const auto& corners = mesh.triangles[triangle];
  const Vec3& p = mesh.positions[corners[0]];
  const Vec3 a = mesh.positions[corners[1]] - p, b = mesh.positions[corners[2]] - p;
  MeshPoint point{triangle, plane_hit(mesh, triangle, origin, direction).shares, {}, normalized(cross(a, b))};
  double sum = 0;
  for (double& share : point.shares) share = std::max(0.0, share), sum += share;
  for (double& share : point.shares) share /= sum;
  point.position = p + point.shares[1] * a + point.shares[2] * b;
  return point;
}

MeshPoint mesh_point(const mesh::Mesh& mesh, const Gbuffer& gbuffer, int x, int y) {
  return mesh_point(mesh, gbuffer.triangles[gbuffer.index(x, y)], gbuffer.rays.eye,
                    gbuffer.rays.direction(x + 0.5, y + 0.5));
}

std::vector<std::array<double, 2>> sample_shifts(int samples) {
  const int k = static_cast<int>(std::lround(std::sqrt(samples)));
  std::vector<std::array<double, 2>> shifts;
  for (int i = 0; i < k; ++i) {
    for (int j = 0; j < k; ++j) {
      shifts.push_back({(i * k + (k - 1 - j) + 0.5) / samples - 0.5, (j * k + i + 0.5) / samples - 0.5});
    }
  }
  return shifts;
}

Result<Rasterizer> Rasterizer::create(const GlContext& gl) {
  Rasterizer rasterizer(gl);
  GONIO_ASSIGN(rasterizer.program_, gl.program(gbuffer_vertex_shader(), gbuffer_fragment_shader()));
  gl.GenVertexArrays(1, &rasterizer.vertex_array_);
  gl.GenBuffers(1, &rasterizer.positions_);
  gl.GenBuffers(1, &rasterizer.normals_);
  gl.GenBuffers(1, &rasterizer.indices_);
  gl.FrontFace(GL_CW);  // counter-clockwise, seen with y down
  return rasterizer;
}

void Rasterizer::upload(const mesh::Mesh& mesh) {
  const GlContext& gl = *gl_;
  const auto attribute = [&](GLuint buffer, GLuint index, const std::vector<Vec3>& values, const Vec3& origin) {
    std::vector<float> floats;
    floats.reserve(3 * values.size());
    for (const Vec3& v : values) {
      for (int axis = 0; axis < 3; ++axis) floats.push_back(static_cast<float>(v[axis] - origin[axis]));
    }
    gl.BindBuffer(GL_ARRAY_BUFFER, buffer);
    gl.BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(floats.size() * sizeof(float)), floats.data(),
                  GL_STATIC_DRAW);
    gl.VertexAttribPointer(index, 3, GL_FLOAT, GL_FALSE, 0, nullptr);
    gl.EnableVertexAttribArray(index);
  };
  mesh_ = &mesh;
  box_ = mesh::bounding_box(mesh);
  origin_ = mesh::float_origin(box_);
  box_ = {box_.low - origin_, box_.high - origin_};
  gl.BindVertexArray(vertex_array_);
  attribute(positions_, 0, mesh.positions, origin_);
  attribute(normals_, 1, mesh.normals, {});
  gl.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_);
  gl.BufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(mesh.triangles.size() * sizeof(mesh.triangles[0])),
                mesh.triangles.data(), GL_STATIC_DRAW);
}

Result<void> Rasterizer::resize(int width, int height) {
  if (width == width_ && height == height_) return {};
  const GlContext& gl = *gl_;
  gl.float_target(width, height, texture_, target_);
  gl.DeleteTextures(1, &triangles_);
  gl.GenTextures(1, &triangles_);
  gl.BindTexture(GL_TEXTURE_2D, triangles_);
  gl.TexImage2D(GL_TEXTURE_2D, 0, GL_R32UI, width, height, 0, GL_RED_INTEGER, GL_UNSIGNED_INT, nullptr);
  gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT1, GL_TEXTURE_2D, triangles_, 0);
  constexpr GLenum kTargets[] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
  gl.DrawBuffers(2, kTargets);
  gl.DeleteRenderbuffers(1, &depth_);
  gl.GenRenderbuffers(1, &depth_);
  gl.BindRenderbuffer(GL_RENDERBUFFER, depth_);
  gl.RenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT32F, width, height);
  gl.FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth_);
  GONIO_TRY(gl.status("making the framebuffer"));
  if (gl.CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
    return input_error("OpenGL cannot draw float pictures of {} x {}", width, height);
  }
  width_ = width, height_ = height;
  return {};
}

void Rasterizer::draw(const Camera& camera, const Rays& rays, double shift_x, double shift_y) {
  const GlContext& gl = *gl_;
  Camera near = camera;
  near.eye = near.eye - origin_, near.target = near.target - origin_;
  const auto matrix = clip_matrix(near, rays, width_, height_, box_, shift_x, shift_y);
  drawn_ = rays;
  drawn_.corner += shift_x * rays.right + shift_y * rays.down;
  gl.BindFramebuffer(GL_FRAMEBUFFER, target_);
  gl.Viewport(0, 0, width_, height_);
  gl.Enable(GL_DEPTH_TEST);
  constexpr GLfloat kNothing[4] = {0, 0, 0, 0};
  constexpr GLuint kNone[4] = {kNoTriangle, 0, 0, 0};
  gl.ClearBufferfv(GL_COLOR, 0, kNothing);
  gl.ClearBufferuiv(GL_COLOR, 1, kNone);
  gl.Clear(GL_DEPTH_BUFFER_BIT);
  gl.UseProgram(program_);
  gl.UniformMatrix4fv(gl.GetUniformLocation(program_, "clip"), 1, GL_FALSE, matrix.data());
  gl.set_rays(program_, drawn_);
  gl.BindVertexArray(vertex_array_);
  const GLint part_location = gl.GetUniformLocation(program_, "part"),
              first_location = gl.GetUniformLocation(program_, "first");
  for (std::size_t part = 0; part < mesh_->parts.size(); ++part) {
    const mesh::MeshPart& range = mesh_->parts[part];
    gl.Uniform1i(part_location, static_cast<GLint>(part));
    gl.Uniform1i(first_location, static_cast<GLint>(range.first));
    gl.DrawElements(GL_TRIANGLES, static_cast<GLsizei>(3 * range.count), GL_UNSIGNED_INT,
                    reinterpret_cast<const void*>(range.first * sizeof(mesh_->triangles[0])));
  }
}

void Rasterizer::read(Gbuffer& gbuffer, bool with_triangles) const {
  gbuffer.width = width_, gbuffer.height = height_;
  gbuffer.rays = drawn_;
  const std::size_t pixels = static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
  gbuffer.data.resize(pixels * 4);
  gl_->BindFramebuffer(GL_FRAMEBUFFER, target_);
  gl_->ReadBuffer(GL_COLOR_ATTACHMENT0);
  gl_->ReadPixels(0, 0, width_, height_, GL_RGBA, GL_FLOAT, gbuffer.data.data());
  if (!with_triangles) return gbuffer.triangles.clear();
  gbuffer.triangles.resize(pixels);
  gl_->ReadBuffer(GL_COLOR_ATTACHMENT1);
  gl_->ReadPixels(0, 0, width_, height_, GL_RED_INTEGER, GL_UNSIGNED_INT, gbuffer.triangles.data());
}

}  // namespace goniochrome::render
