#include "render/renderer.h"

#include <algorithm>
#include <cmath>

#include "base/clock.h"
#include "base/text.h"
#include "render/gl.h"
#include "render/shader.h"

namespace goniochrome {

namespace {

// What a shading pass is drawn onto: samples after the first are added to the sum of those before.
enum class Onto { kNothing, kSum };

// Where the samples of a pixel lie, from its center: a grid turned so that no two share a row or a column, which
// resolves edges that are nearly upright or level in as many steps as there are samples.
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

// The lobe's map, or an error with the command that adds it.
Result<const PrefilteredLobe*> lobe_of(const PrefilteredEnvironment& env, double exponent,
                                       const std::vector<double>& wanted) {
  const PrefilteredLobe* lobe = env.lobe(exponent);
  if (lobe != nullptr) return lobe;
  std::string list;
  for (const double e : wanted) list += (list.empty() ? "" : ",") + shortest(e);
  return input_error(
      "the environment has no lobe of exponent {}, which a paint needs: make it with `prefilter-envmap {} --exponents "
      "{} "
      "-o ENV.env.exr`, or fit the paints to the basis it was made for",
      shortest(exponent), env.source.empty() ? "SOURCE" : env.source, list);
}

}  // namespace

int Gbuffer::part(int x, int y) const {
  return static_cast<int>(std::abs(at(x, y)[3])) - 1;
}

Vec3 Gbuffer::normal(int x, int y) const {
  const float* n = at(x, y);
  return normalized({n[0], n[1], n[2]});
}

struct Renderer::State {
  explicit State(GlContext context) : gl(std::move(context)) {}

  GlContext gl;
  Scene scene;
  Box box;
  Effects effects;
  std::string shader;
  GLuint gbuffer_program = 0, shading_program = 0;
  GLuint vertex_array = 0, positions = 0, normals = 0, indices = 0, no_vertices = 0;
  GLuint weights = 0;
  std::vector<std::pair<std::string, GLuint>> cubes;  // by the name of their sampler

  int width = 0, height = 0;
  GLuint gbuffer_texture = 0, gbuffer_depth = 0, gbuffer_target = 0, color_texture = 0, color_target = 0;

  Result<void> begin();
  void upload_mesh();
  Result<void> upload_environment();
  void upload_cube(const std::string& sampler, const CubeMap& map);
  void upload_weights();
  GLuint float_texture(int columns, int rows, const float* rgba) const;
  Result<void> resize(int new_width, int new_height);

  void set_rays(GLuint program, const Rays& rays) const;
  void rasterize(const Camera& camera, const Rays& rays, double shift_x, double shift_y) const;
  void shade(const Rays& rays, Onto onto) const;
  void read(GLuint target, std::vector<float>& rgba) const;
};

Result<void> Renderer::State::begin() {
  GONIO_ASSIGN(gbuffer_program, gl.program(gbuffer_vertex_shader(), gbuffer_fragment_shader()));
  gl.GenVertexArrays(1, &vertex_array);
  gl.GenVertexArrays(1, &no_vertices);
  gl.GenBuffers(1, &positions);
  gl.GenBuffers(1, &normals);
  gl.GenBuffers(1, &indices);
  gl.FrontFace(GL_CW);  // counter-clockwise, seen with y down
  gl.BlendFunc(GL_ONE, GL_ONE);
  return {};
}

void Renderer::State::upload_mesh() {
  const auto upload = [&](GLuint buffer, GLuint attribute, const std::vector<Vec3>& values) {
    std::vector<float> floats;
    floats.reserve(3 * values.size());
    for (const Vec3& v : values) {
      for (int axis = 0; axis < 3; ++axis) floats.push_back(static_cast<float>(v[axis]));
    }
    gl.BindBuffer(GL_ARRAY_BUFFER, buffer);
    gl.BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(floats.size() * sizeof(float)), floats.data(),
                  GL_STATIC_DRAW);
    gl.VertexAttribPointer(attribute, 3, GL_FLOAT, GL_FALSE, 0, nullptr);
    gl.EnableVertexAttribArray(attribute);
  };
  const Mesh& mesh = *scene.mesh;
  box = bounding_box(mesh);
  gl.BindVertexArray(vertex_array);
  upload(positions, 0, mesh.positions);
  upload(normals, 1, mesh.normals);
  gl.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices);
  gl.BufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(mesh.triangles.size() * sizeof(mesh.triangles[0])),
                mesh.triangles.data(), GL_STATIC_DRAW);
}

GLuint Renderer::State::float_texture(int columns, int rows, const float* rgba) const {
  GLuint texture = 0;
  gl.GenTextures(1, &texture);
  gl.BindTexture(GL_TEXTURE_2D, texture);
  gl.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, columns, rows, 0, GL_RGBA, GL_FLOAT, rgba);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  return texture;
}

void Renderer::State::upload_weights() {
  const WeightTable table = weight_table(scene, effects);
  gl.DeleteTextures(1, &weights);
  weights = float_texture(table.columns, table.rows, table.rgba.data());
}

// Float texels: a half would have to be rounded first, since llvmpipe truncates, and is no faster to fetch.
void Renderer::State::upload_cube(const std::string& sampler, const CubeMap& map) {
  GLuint texture = 0;
  gl.GenTextures(1, &texture);
  gl.BindTexture(GL_TEXTURE_CUBE_MAP, texture);
  for (int face = 0; face < 6; ++face) {
    gl.TexImage2D(GL_TEXTURE_CUBE_MAP_POSITIVE_X + static_cast<GLenum>(face), 0, GL_RGB32F, map.size, map.size, 0,
                  GL_RGB, GL_FLOAT, map.at(face, 0, 0));
  }
  gl.TexParameteri(GL_TEXTURE_CUBE_MAP, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  gl.TexParameteri(GL_TEXTURE_CUBE_MAP, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  cubes.emplace_back(sampler, texture);
}

Result<void> Renderer::State::upload_environment() {
  for (const auto& [sampler, texture] : cubes) gl.DeleteTextures(1, &texture);
  cubes.clear();
  if (!effects.environment) return {};
  const PrefilteredEnvironment& env = *scene.env;
  upload_cube("diffuse", env.diffuse.map);
  std::vector<double> exponents;
  for (const Effects::LobeUse& use : effects.lobes) exponents.push_back(use.exponent);
  for (std::size_t j = 0; j < exponents.size(); ++j) {
    GONIO_ASSIGN(const PrefilteredLobe* lobe, lobe_of(env, exponents[j], exponents));
    upload_cube(fmt::format("lobe_{}", j), lobe->map);
  }
  if (effects.mirror || effects.background == Background::kEnvironment) {
    if (env.mirror.map.size == 0) {
      return input_error(
          "the environment has no mirror part, which {} needs: make it with a basis that holds <mirror/>",
          effects.mirror ? "a paint with a mirror lobe" : "--background env");
    }
    upload_cube("mirror", env.mirror.map);
  }
  if (static_cast<int>(cubes.size()) + 2 > gl.integer(GL_MAX_TEXTURE_IMAGE_UNITS)) {
    return input_error("the paints use {} lobes, but OpenGL has only {} texture units: fit them to one common basis",
                       exponents.size(), gl.integer(GL_MAX_TEXTURE_IMAGE_UNITS));
  }
  return {};
}

Result<void> Renderer::State::resize(int new_width, int new_height) {
  if (new_width == width && new_height == height) return {};
  const auto target = [&](GLuint& texture, GLuint& framebuffer) {
    gl.DeleteTextures(1, &texture);
    gl.DeleteFramebuffers(1, &framebuffer);
    texture = float_texture(new_width, new_height, nullptr);
    gl.GenFramebuffers(1, &framebuffer);
    gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture, 0);
  };
  target(color_texture, color_target);
  target(gbuffer_texture, gbuffer_target);
  gl.DeleteRenderbuffers(1, &gbuffer_depth);
  gl.GenRenderbuffers(1, &gbuffer_depth);
  gl.BindRenderbuffer(GL_RENDERBUFFER, gbuffer_depth);
  gl.RenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT32F, new_width, new_height);
  gl.FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, gbuffer_depth);
  GONIO_TRY(gl.status("making the framebuffer"));
  if (gl.CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
    return input_error("OpenGL cannot draw float pictures of {} x {}", new_width, new_height);
  }
  width = new_width, height = new_height;
  return {};
}

void Renderer::State::set_rays(GLuint program, const Rays& rays) const {
  for (const auto& [name, v] : {std::pair{"corner", rays.corner}, {"right", rays.right}, {"down", rays.down}}) {
    gl.Uniform3f(gl.GetUniformLocation(program, name), static_cast<float>(v.x), static_cast<float>(v.y),
                 static_cast<float>(v.z));
  }
}

void Renderer::State::rasterize(const Camera& camera, const Rays& rays, double shift_x, double shift_y) const {
  const auto matrix = clip_matrix(camera, rays, width, height, box, shift_x, shift_y);
  gl.BindFramebuffer(GL_FRAMEBUFFER, gbuffer_target);
  gl.Viewport(0, 0, width, height);
  gl.Enable(GL_DEPTH_TEST);
  gl.ClearColor(0, 0, 0, 0);
  gl.Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  gl.UseProgram(gbuffer_program);
  gl.UniformMatrix4fv(gl.GetUniformLocation(gbuffer_program, "clip"), 1, GL_FALSE, matrix.data());
  Rays shifted = rays;
  shifted.corner += shift_x * rays.right + shift_y * rays.down;
  set_rays(gbuffer_program, shifted);
  gl.BindVertexArray(vertex_array);
  const GLint part_location = gl.GetUniformLocation(gbuffer_program, "part");
  for (std::size_t part = 0; part < scene.mesh->parts.size(); ++part) {
    const MeshPart& range = scene.mesh->parts[part];
    gl.Uniform1i(part_location, static_cast<GLint>(part));
    gl.DrawElements(GL_TRIANGLES, static_cast<GLsizei>(3 * range.count), GL_UNSIGNED_INT,
                    reinterpret_cast<const void*>(range.first * sizeof(scene.mesh->triangles[0])));
  }
}

void Renderer::State::shade(const Rays& rays, Onto onto) const {
  gl.BindFramebuffer(GL_FRAMEBUFFER, color_target);
  gl.Disable(GL_DEPTH_TEST);
  if (onto == Onto::kSum) gl.Enable(GL_BLEND);
  gl.UseProgram(shading_program);
  set_rays(shading_program, rays);
  GLint unit = 0;
  const auto bind = [&](const std::string& sampler, GLenum kind, GLuint texture) {
    gl.ActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
    gl.BindTexture(kind, texture);
    gl.Uniform1i(gl.GetUniformLocation(shading_program, sampler.c_str()), unit++);
  };
  bind("gbuffer", GL_TEXTURE_2D, gbuffer_texture);
  bind("weights", GL_TEXTURE_2D, weights);
  for (const auto& [sampler, texture] : cubes) bind(sampler, GL_TEXTURE_CUBE_MAP, texture);
  gl.ActiveTexture(GL_TEXTURE0);
  const auto set = [&](const std::string& name, const Vec3& v) {
    gl.Uniform3f(gl.GetUniformLocation(shading_program, name.c_str()), static_cast<float>(v.x), static_cast<float>(v.y),
                 static_cast<float>(v.z));
  };
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    set(fmt::format("light_direction[{}]", i), scene.lights[i].direction);
    set(fmt::format("light_white[{}]", i), scene.lights[i].white);
  }
  if (scene.background == Background::kColor) set("background", scene.background_color);
  gl.BindVertexArray(no_vertices);
  gl.DrawArrays(GL_TRIANGLES, 0, 3);
  gl.Disable(GL_BLEND);
}

void Renderer::State::read(GLuint target, std::vector<float>& rgba) const {
  rgba.resize(static_cast<std::size_t>(width) * height * 4);
  gl.BindFramebuffer(GL_FRAMEBUFFER, target);
  gl.ReadPixels(0, 0, width, height, GL_RGBA, GL_FLOAT, rgba.data());
}

Renderer::Renderer(std::unique_ptr<State> state) : state_(std::move(state)) {}
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer::~Renderer() = default;

Result<Renderer> Renderer::create() {
  GONIO_ASSIGN(GlContext context, GlContext::create());
  auto state = std::make_unique<State>(std::move(context));
  GONIO_TRY(state->begin());
  return Renderer(std::move(state));
}

std::string Renderer::engine() const {
  state_->gl.make_current();
  return state_->gl.engine();
}

const std::string& Renderer::shader() const {
  return state_->shader;
}

Result<void> Renderer::load(const Scene& scene) {
  State& s = *state_;
  s.gl.make_current();
  s.scene = scene;
  s.effects = effects_of(scene);
  const std::string shader = shading_fragment_shader(s.effects);
  if (shader != s.shader) {
    if (s.shading_program != 0) s.gl.DeleteProgram(s.shading_program);
    GONIO_ASSIGN(s.shading_program, s.gl.program(shading_vertex_shader(), shader));
    s.shader = shader;
  }
  s.upload_mesh();
  s.upload_weights();
  GONIO_TRY(s.upload_environment());
  return s.gl.status("uploading the scene");
}

Result<Frame> Renderer::draw(const Camera& camera, int width, int height, int samples, bool with_centers) {
  State& s = *state_;
  s.gl.make_current();
  GONIO_TRY(s.resize(width, height));
  GONIO_ASSIGN(const Rays pixel_rays, rays(camera, width, height));
  Frame frame;
  frame.gbuffer = {width, height, {}, pixel_rays};
  frame.picture = {width, height, 4, {}, {"R", "G", "B", "A"}};

  const Stopwatch whole;
  s.rasterize(camera, pixel_rays, 0, 0);
  s.gl.Finish();
  frame.gbuffer_ms = 1000 * whole.elapsed_s();
  s.read(s.gbuffer_target, frame.gbuffer.data);
  if (with_centers || samples == 1) {
    s.shade(pixel_rays, Onto::kNothing);
    s.read(s.color_target, frame.picture.data);
    if (with_centers) frame.centers = frame.picture;
  }
  if (samples > 1) {
    Onto onto = Onto::kNothing;
    for (const auto& [shift_x, shift_y] : sample_shifts(samples)) {
      Rays shifted = pixel_rays;
      shifted.corner += shift_x * pixel_rays.right + shift_y * pixel_rays.down;
      s.rasterize(camera, pixel_rays, shift_x, shift_y);
      s.shade(shifted, onto);
      onto = Onto::kSum;
    }
    s.read(s.color_target, frame.picture.data);
    for (float& value : frame.picture.data) value /= static_cast<float>(samples);
  }
  frame.frame_ms = 1000 * whole.elapsed_s();
  GONIO_TRY(s.gl.status("drawing"));
  return frame;
}

}  // namespace goniochrome
