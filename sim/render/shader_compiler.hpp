// The memory of LLVM, with which Mesa compiles shaders. It is not needed to draw.
#pragma once

namespace constrictor {

/// Gives the memory of LLVM's code back, and what the compilation freed. LLVM may be used afterwards, by any thread:
/// the kernel reads the code from the file again, page by page.
void release_shader_compiler();

}  // namespace constrictor
