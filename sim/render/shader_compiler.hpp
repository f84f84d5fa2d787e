// The memory of LLVM, with which Mesa compiles shaders. It is not needed to draw.
#pragma once

#include <cstdint>

namespace constrictor {

/// Gives the memory of LLVM's code back, and what the compilation freed. LLVM may be used afterwards, by any thread:
/// the kernel reads the code from the file again, page by page.
void release_shader_compiler();

/// Calls release_shader_compiler() after the first image, and after later ones for which a shader was compiled, or read
/// from the cache. OpenGL does not say so, but LLVM's code then brings many pages of its file into memory.
class ShaderCompilerMemory {
 public:
  /// Call after each image.
  void after_image();

 private:
  std::int64_t file_bytes_ = -1;  ///< of files in this process's memory after the last release, or the least since then
};

}  // namespace constrictor
