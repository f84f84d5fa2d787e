// Move-only owners of an OSMesa context and of OpenGL names (textures, buffers, ...). Free a name while its context is
// current.
#pragma once

#define GL_GLEXT_PROTOTYPES  // NOLINT: OSMesa exports the functions, no loader is needed
#include <GL/osmesa.h>

// After osmesa.h: it uses the types of GL/gl.h without including it.
#include <GL/glext.h>

#include <array>
#include <mutex>
#include <utility>

namespace constrictor {

/// An OSMesa context of OpenGL 3.3 core. It is current in the calling thread only while a ContextScope exists, so a
/// renderer may be used from several threads, one at a time. Several renderers may be used from several threads: they
/// take turns, because contexts share state of Mesa.
class GlContext {
 public:
  GlContext();
  GlContext(const GlContext&) = delete;
  GlContext& operator=(const GlContext&) = delete;
  ~GlContext();

 private:
  friend class ContextScope;
  OSMesaContext context_ = nullptr;
  // The renderer draws into framebuffer objects, but OSMesa requires a window.
  std::array<unsigned char, 4 * 4 * 4> window_{};
};

/// A thread must not have two of them at a time.
class ContextScope {
 public:
  explicit ContextScope(GlContext& context);
  ContextScope(const ContextScope&) = delete;
  ContextScope& operator=(const ContextScope&) = delete;
  ~ContextScope() { OSMesaMakeCurrent(nullptr, nullptr, 0, 0, 0); }

 private:
  std::unique_lock<std::mutex> turn_;
};

/// One OpenGL name. `Traits` has create() and destroy(GLuint).
template <class Traits>
class GlName {
 public:
  GlName() = default;
  static GlName create() { return GlName(Traits::create()); }
  GlName(GlName&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
  GlName& operator=(GlName&& other) noexcept {
    std::swap(name_, other.name_);
    return *this;
  }
  GlName(const GlName&) = delete;
  GlName& operator=(const GlName&) = delete;
  ~GlName() {
    if (name_ != 0) Traits::destroy(name_);
  }
  [[nodiscard]] GLuint get() const { return name_; }

 private:
  explicit GlName(GLuint name) : name_(name) {}
  GLuint name_ = 0;
};

/// Names that OpenGL generates and deletes in arrays.
template <void (*kGenerate)(GLsizei, GLuint*), void (*kDelete)(GLsizei, const GLuint*)>
struct ArrayTraits {
  static GLuint create() {
    GLuint n = 0;
    kGenerate(1, &n);
    return n;
  }
  static void destroy(GLuint n) { kDelete(1, &n); }
};
struct ProgramTraits {
  static GLuint create() { return glCreateProgram(); }
  static void destroy(GLuint n) { glDeleteProgram(n); }
};
using GlBuffer = GlName<ArrayTraits<glGenBuffers, glDeleteBuffers>>;
using GlVertexArray = GlName<ArrayTraits<glGenVertexArrays, glDeleteVertexArrays>>;
using GlTexture = GlName<ArrayTraits<glGenTextures, glDeleteTextures>>;
using GlFramebuffer = GlName<ArrayTraits<glGenFramebuffers, glDeleteFramebuffers>>;
using GlRenderbuffer = GlName<ArrayTraits<glGenRenderbuffers, glDeleteRenderbuffers>>;
using GlProgram = GlName<ProgramTraits>;

/// Compiles and links a shader program. Throws std::runtime_error with the message of the compiler.
GlProgram build_program(const char* vertex_source, const char* fragment_source);

/// Throws std::runtime_error if OpenGL has a pending error. `doing` names the activity in the message.
void check_gl(const char* doing);

}  // namespace constrictor
