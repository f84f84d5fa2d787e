#include "sim/render/gl_handles.hpp"

#include <cstdlib>
#include <stdexcept>
#include <string>

#include "sim/render/shader_cache.hpp"

namespace constrictor {
namespace {

/// llvmpipe compiles shaders for the CPU of the machine; these variables make it compile the same code everywhere. They
/// are set before main, while there is only one thread. Values in the environment take precedence.
const bool environment_is_set = [] {
  ::setenv("LP_NATIVE_VECTOR_WIDTH", "256", 0);
  ::setenv("GALLIUM_OVERRIDE_CPU_CAPS", "sse4.1", 0);  // without FMA, which changes the last bits
  ::setenv("LP_NUM_THREADS", "0", 0);  // draw in the thread of the caller: the same bytes with the least CPU time
  set_up_shader_cache();
  return true;
}();

/// Held by the thread that uses Mesa.
std::mutex& mesa_mutex() {
  static std::mutex mutex;
  return mutex;
}

GLuint compile(GLenum kind, const char* source) {
  const GLuint shader = glCreateShader(kind);
  glShaderSource(shader, 1, &source, nullptr);
  glCompileShader(shader);
  GLint ok = GL_FALSE;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &ok);
  if (ok != GL_TRUE) {
    std::array<char, 2048> log{};
    glGetShaderInfoLog(shader, static_cast<GLsizei>(log.size()), nullptr, log.data());
    glDeleteShader(shader);
    throw std::runtime_error(std::string("renderer: a shader does not compile: ") + log.data());
  }
  return shader;
}

}  // namespace

GlContext::GlContext() {
  if (!environment_is_set) throw std::runtime_error("renderer: used before main");
  static constexpr std::array<int, 13> kAttributes{OSMESA_FORMAT,
                                                   OSMESA_RGBA,
                                                   OSMESA_DEPTH_BITS,
                                                   0,
                                                   OSMESA_PROFILE,
                                                   OSMESA_CORE_PROFILE,
                                                   OSMESA_CONTEXT_MAJOR_VERSION,
                                                   3,
                                                   OSMESA_CONTEXT_MINOR_VERSION,
                                                   3,
                                                   0,
                                                   0,
                                                   0};
  const std::lock_guard turn(mesa_mutex());
  context_ = OSMesaCreateContextAttribs(kAttributes.data(), nullptr);
  if (context_ == nullptr)
    throw std::runtime_error(
        "renderer: OSMesa offers no OpenGL 3.3 core context (is the package libosmesa6 installed?)");
}

GlContext::~GlContext() {
  const std::lock_guard turn(mesa_mutex());
  OSMesaDestroyContext(context_);
}

ContextScope::ContextScope(GlContext& context) : turn_(mesa_mutex()) {
  if (OSMesaMakeCurrent(context.context_, context.window_.data(), GL_UNSIGNED_BYTE, 4, 4) != GL_TRUE) {
    throw std::runtime_error("renderer: OSMesa cannot make its context current");
  }
}

GlProgram build_program(const char* vertex_source, const char* fragment_source) {
  GlProgram program = GlProgram::create();
  for (const GLuint shader : {compile(GL_VERTEX_SHADER, vertex_source), compile(GL_FRAGMENT_SHADER, fragment_source)}) {
    glAttachShader(program.get(), shader);
    glDeleteShader(shader);  // freed with the program
  }
  glLinkProgram(program.get());
  GLint ok = GL_FALSE;
  glGetProgramiv(program.get(), GL_LINK_STATUS, &ok);
  if (ok != GL_TRUE) {
    std::array<char, 2048> log{};
    glGetProgramInfoLog(program.get(), static_cast<GLsizei>(log.size()), nullptr, log.data());
    throw std::runtime_error(std::string("renderer: a shader program does not link: ") + log.data());
  }
  return program;
}

void check_gl(const char* doing) {
  const GLenum error = glGetError();
  if (error != GL_NO_ERROR) throw std::runtime_error(std::string(doing) + ": OpenGL error " + std::to_string(error));
}

}  // namespace constrictor
