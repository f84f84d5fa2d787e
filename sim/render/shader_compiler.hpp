// The memory of LLVM, with which Mesa compiles shaders. It is not needed to draw.
#pragma once

namespace constrictor {

/// Gives the memory of LLVM's code back, and what the compilation freed. LLVM may be used afterwards, by any thread:
/// the kernel reads the code from the file again, page by page.
void release_shader_compiler();

/// Calls release_shader_compiler() after those images for which a shader was compiled, or read from the cache. OpenGL
/// does not say so, but the thread that draws then meets many pages of memory that it has not used before.
class ShaderCompilerMemory {
 public:
  /// Call after each image, in the thread that draws.
  void after_image();

 private:
  long page_faults_ = 0;  ///< of this thread until the last call
};

}  // namespace constrictor
