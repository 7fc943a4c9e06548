#include "render/gl/gl.h"

namespace goniochrome::render {

GlContext::GlContext(GlDriverPointer driver) : driver_(std::move(driver)) {}

Result<GlContext> GlContext::create(OpenGlBy by) {
  GONIO_ASSIGN(GlDriverPointer driver, gl_driver(by));
  GlContext gl(std::move(driver));
#define GONIO_GL_LOAD(type, name)                                    \
  gl.name = reinterpret_cast<type>(gl.driver_->address("gl" #name)); \
  if (gl.name == nullptr) return input_error("the OpenGL of {} lacks gl" #name ": update its driver", gl.library());
  GONIO_GL_FUNCTIONS(GONIO_GL_LOAD)
#undef GONIO_GL_LOAD
  gl.Enable(GL_TEXTURE_CUBE_MAP_SEAMLESS);
  return gl;
}

void GlContext::make_current() const {
  driver_->make_current();
}

const char* GlContext::library() const {
  return driver_->name();
}

bool GlContext::on_gpu() const {
  return driver_->on_gpu();
}

Result<GLuint> GlContext::program(const std::string& vertex, const std::string& fragment) const {
  const GLuint program = CreateProgram();
  GLint done = 0;
  char log[4096] = "";
  for (const auto& [kind, text] : {std::pair{GL_VERTEX_SHADER, &vertex}, std::pair{GL_FRAGMENT_SHADER, &fragment}}) {
    const GLuint shader = CreateShader(static_cast<GLenum>(kind));
    const char* source = text->c_str();
    ShaderSource(shader, 1, &source, nullptr);
    CompileShader(shader);
    GetShaderiv(shader, GL_COMPILE_STATUS, &done);
    if (done == 0) {
      GetShaderInfoLog(shader, sizeof log, nullptr, log);
      return Error{ErrorKind::kBug, fmt::format("shader does not compile: {}\n{}", log, *text)};
    }
    AttachShader(program, shader);
    DeleteShader(shader);  // lives on as long as the program
  }
  LinkProgram(program);
  GetProgramiv(program, GL_LINK_STATUS, &done);
  if (done == 0) {
    GetProgramInfoLog(program, sizeof log, nullptr, log);
    return Error{ErrorKind::kBug, fmt::format("shaders do not link: {}\n{}", log, fragment)};
  }
  return program;
}

Result<void> GlContext::status(const char* doing) const {
  const GLenum error = GetError();
  if (error == GL_NO_ERROR) return {};
  if (error == GL_OUT_OF_MEMORY)
    return input_error("OpenGL is out of memory when {}: make the picture or the maps smaller", doing);
  return Error{ErrorKind::kBug, fmt::format("OpenGL error 0x{:04x} when {}", error, doing)};
}

int GlContext::integer(GLenum name) const {
  GLint value = 0;
  GetIntegerv(name, &value);
  return value;
}

GLuint GlContext::float_texture(int columns, int rows, const float* rgba) const {
  GLuint texture = 0;
  GenTextures(1, &texture);
  BindTexture(GL_TEXTURE_2D, texture);
  TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, columns, rows, 0, GL_RGBA, GL_FLOAT, rgba);
  TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  return texture;
}

void GlContext::float_target(int columns, int rows, GLuint& texture, GLuint& framebuffer) const {
  DeleteTextures(1, &texture);
  DeleteFramebuffers(1, &framebuffer);
  texture = float_texture(columns, rows, nullptr);
  GenFramebuffers(1, &framebuffer);
  BindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture, 0);
}

void GlContext::set(GLuint program, const std::string& name, const Vec3& value) const {
  const auto [x, y, z] = floats(value);
  Uniform3f(GetUniformLocation(program, name.c_str()), x, y, z);
}

void GlContext::set_rays(GLuint program, const Rays& rays) const {
  set(program, "corner", rays.corner);
  set(program, "right", rays.right);
  set(program, "down", rays.down);
}

std::string GlContext::engine() const {
  return reinterpret_cast<const char*>(GetString(GL_RENDERER));
}

}  // namespace goniochrome::render
