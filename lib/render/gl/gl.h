// OpenGL: one context without a window, and the functions that are used.
#pragma once

#include <GL/glcorearb.h>

#include <memory>
#include <string>

#include "base/result.h"
#include "render/camera.h"
#include "render/gl/driver.h"

// Every OpenGL function in use. libepoxy aborts under OSMesa, so they are looked up here, by name.
#define GONIO_GL_FUNCTIONS(X)                            \
  X(PFNGLACTIVETEXTUREPROC, ActiveTexture)               \
  X(PFNGLATTACHSHADERPROC, AttachShader)                 \
  X(PFNGLBINDFRAMEBUFFERPROC, BindFramebuffer)           \
  X(PFNGLBINDTEXTUREPROC, BindTexture)                   \
  X(PFNGLBINDVERTEXARRAYPROC, BindVertexArray)           \
  X(PFNGLBLENDFUNCPROC, BlendFunc)                       \
  X(PFNGLCOMPILESHADERPROC, CompileShader)               \
  X(PFNGLCREATEPROGRAMPROC, CreateProgram)               \
  X(PFNGLCREATESHADERPROC, CreateShader)                 \
  X(PFNGLDELETEFRAMEBUFFERSPROC, DeleteFramebuffers)     \
  X(PFNGLDELETEPROGRAMPROC, DeleteProgram)               \
  X(PFNGLDELETESHADERPROC, DeleteShader)                 \
  X(PFNGLDELETETEXTURESPROC, DeleteTextures)             \
  X(PFNGLDISABLEPROC, Disable)                           \
  X(PFNGLDRAWARRAYSPROC, DrawArrays)                     \
  X(PFNGLENABLEPROC, Enable)                             \
  X(PFNGLFRAMEBUFFERTEXTURE2DPROC, FramebufferTexture2D) \
  X(PFNGLGENFRAMEBUFFERSPROC, GenFramebuffers)           \
  X(PFNGLGENTEXTURESPROC, GenTextures)                   \
  X(PFNGLGENVERTEXARRAYSPROC, GenVertexArrays)           \
  X(PFNGLGETERRORPROC, GetError)                         \
  X(PFNGLGETINTEGERVPROC, GetIntegerv)                   \
  X(PFNGLGETPROGRAMINFOLOGPROC, GetProgramInfoLog)       \
  X(PFNGLGETPROGRAMIVPROC, GetProgramiv)                 \
  X(PFNGLGETSHADERINFOLOGPROC, GetShaderInfoLog)         \
  X(PFNGLGETSHADERIVPROC, GetShaderiv)                   \
  X(PFNGLGETSTRINGPROC, GetString)                       \
  X(PFNGLGETUNIFORMLOCATIONPROC, GetUniformLocation)     \
  X(PFNGLLINKPROGRAMPROC, LinkProgram)                   \
  X(PFNGLREADPIXELSPROC, ReadPixels)                     \
  X(PFNGLSHADERSOURCEPROC, ShaderSource)                 \
  X(PFNGLTEXIMAGE2DPROC, TexImage2D)                     \
  X(PFNGLTEXPARAMETERIPROC, TexParameteri)               \
  X(PFNGLUNIFORM1IPROC, Uniform1i)                       \
  X(PFNGLUNIFORM3FPROC, Uniform3f)                       \
  X(PFNGLUSEPROGRAMPROC, UseProgram)                     \
  X(PFNGLVIEWPORTPROC, Viewport)

namespace goniochrome::render {

// A core profile context without a window. Everything made in it goes with it.
class GlContext {
 public:
  // Error: there is no such OpenGL on this machine, with what to install; it lacks a function.
  static Result<GlContext> create(OpenGlBy by = OpenGlBy::kSoftware);

  void make_current() const;

  // A linked program. Error (a bug of the generator): the compiler's message and the text.
  Result<GLuint> program(const std::string& vertex, const std::string& fragment) const;

  // Error: the first OpenGL error since the last call, after `doing`.
  Result<void> status(const char* doing) const;

  int integer(GLenum name) const;

  // A texture of RGBA floats, fetched by texel; null leaves it undefined. And one to draw into, with its framebuffer.
  GLuint float_texture(int columns, int rows, const float* rgba) const;
  void float_target(int columns, int rows, GLuint& texture, GLuint& framebuffer) const;

  // Sets the uniforms corner, right and down of a program.
  void set_rays(GLuint program, const Rays& rays) const;
  void set(GLuint program, const std::string& name, const Vec3& value) const;
  // "llvmpipe (LLVM 15.0.6, 256 bits)"
  std::string engine() const;
  // The library that made the context: "OSMesa" or "EGL".
  const char* library() const;
  // True if it draws on a GPU. GPUs interpolate between texels in steps of 1/256.
  bool on_gpu() const;

#define GONIO_GL_MEMBER(type, name) type name = nullptr;
  GONIO_GL_FUNCTIONS(GONIO_GL_MEMBER)
#undef GONIO_GL_MEMBER

 private:
  explicit GlContext(GlDriverPointer driver);
  GlDriverPointer driver_;
};

}  // namespace goniochrome::render
