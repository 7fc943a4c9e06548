#include "render/gl/gl.h"

#include <GL/osmesa.h>
#include <dlfcn.h>
#include <sys/mman.h>

#include <cstdlib>

#include "base/parallel.h"

namespace goniochrome::render {

namespace {

// OSMesa wants a window to draw in; everything here goes to framebuffer objects instead.
constexpr int kWindow = 4;
unsigned char window_pixels[kWindow * kWindow * 4];

// OSMesa brings a compiler of 100 MB with it: tools that may draw, but do not, start without it.
constexpr const char* kLibrary = "libOSMesa.so.8";
struct OSMesa {
  decltype(&OSMesaCreateContextAttribs) create = nullptr;
  decltype(&OSMesaMakeCurrent) make_current = nullptr;
  decltype(&OSMesaDestroyContext) destroy = nullptr;
  decltype(&OSMesaGetProcAddress) address = nullptr;
};

// The library, loaded once. Error: it is not there, or is another one.
Result<const OSMesa*> osmesa() {
  static std::string reason;
  static const OSMesa loaded = [] {
    OSMesa library;
    if (void* handle = dlopen(kLibrary, RTLD_NOW | RTLD_LOCAL)) {
      const auto find = [&](auto& function, const char* name) {
        function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(dlsym(handle, name));
      };
      find(library.create, "OSMesaCreateContextAttribs");
      find(library.make_current, "OSMesaMakeCurrent");
      find(library.destroy, "OSMesaDestroyContext");
      find(library.address, "OSMesaGetProcAddress");
    } else if (const char* why = dlerror()) {
      reason = fmt::format(" ({})", why);
    }
    return library;
  }();
  if (loaded.create && loaded.make_current && loaded.destroy && loaded.address) return &loaded;
  return input_error("{} of Mesa 22 or later cannot be loaded{}: install libosmesa6, or give more memory", kLibrary,
                     reason);
}

// Whether as much address space is to be had as Mesa takes beside its libraries: short of it, it crashes.
bool has_room() {
  constexpr std::size_t kRoom = std::size_t{448} << 20;
  void* room = mmap(nullptr, kRoom, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  return room != MAP_FAILED && munmap(room, kRoom) == 0;
}

void destroy(void* context) {
  (*osmesa())->destroy(static_cast<OSMesaContext>(context));
}

}  // namespace

GlContext::GlContext(void* context) : context_(context, destroy) {}

Result<GlContext> GlContext::create() {
  // Read once, when the first context of the process is made.
  setenv("LP_NUM_THREADS", std::to_string(threads()).c_str(), 0);
  const int wanted[] = {OSMESA_FORMAT,
                        OSMESA_RGBA,
                        OSMESA_DEPTH_BITS,
                        0,
                        OSMESA_PROFILE,
                        OSMESA_CORE_PROFILE,
                        OSMESA_CONTEXT_MAJOR_VERSION,
                        3,
                        OSMESA_CONTEXT_MINOR_VERSION,
                        3,
                        0};
  GONIO_ASSIGN(const OSMesa* library, osmesa());
  if (!has_room())
    return input_error("OpenGL takes some 450 MB of address space, which are not there: give more memory");
  void* context = library->create(wanted, nullptr);
  if (context == nullptr) {
    return input_error("OSMesa makes no OpenGL 3.3 core context: install libosmesa6 of Mesa 22 or later");
  }
  GlContext gl(context);
  gl.make_current();
#define GONIO_GL_LOAD(type, name)                                 \
  gl.name = reinterpret_cast<type>(library->address("gl" #name)); \
  if (gl.name == nullptr) return input_error("OSMesa lacks gl" #name ": install libosmesa6 of Mesa 22 or later");
  GONIO_GL_FUNCTIONS(GONIO_GL_LOAD)
#undef GONIO_GL_LOAD
  gl.Enable(GL_TEXTURE_CUBE_MAP_SEAMLESS);
  return gl;
}

void GlContext::make_current() const {
  (*osmesa())->make_current(static_cast<OSMesaContext>(context_.get()), window_pixels, GL_UNSIGNED_BYTE, kWindow,
                            kWindow);
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
  Uniform3f(GetUniformLocation(program, name.c_str()), static_cast<float>(value.x), static_cast<float>(value.y),
            static_cast<float>(value.z));
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
