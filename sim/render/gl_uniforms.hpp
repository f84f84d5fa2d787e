// Sets uniform variables of shader programs. The program must be in use.
#pragma once

#include <Eigen/Core>

#include "sim/render/gl_handles.hpp"
#include "sim/render/scene.hpp"

namespace constrictor {

inline void set_uniform(const GlProgram& program, const char* name, const Eigen::Matrix4f& value) {
  glUniformMatrix4fv(glGetUniformLocation(program.get(), name), 1, GL_FALSE, value.data());
}
inline void set_uniform(const GlProgram& program, const char* name, const Eigen::Vector3f& value) {
  glUniform3fv(glGetUniformLocation(program.get(), name), 1, value.data());
}
inline void set_uniform(const GlProgram& program, const char* name, const Rgb& value) {
  glUniform3f(glGetUniformLocation(program.get(), name), value.r, value.g, value.b);
}
inline void set_uniform(const GlProgram& program, const char* name, float value) {
  glUniform1f(glGetUniformLocation(program.get(), name), value);
}
inline void set_uniform(const GlProgram& program, const char* name, int value) {
  glUniform1i(glGetUniformLocation(program.get(), name), value);
}

}  // namespace constrictor
