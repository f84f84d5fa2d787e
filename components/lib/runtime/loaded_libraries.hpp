// The versions of the shared libraries that compute results.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace constrictor {

/// The libraries of ODE, OpenCV, Mesa, LLVM, libm, libstdc++ and Cyclone DDS that this process has loaded, by name,
/// each with its file name and the first digits of its build id: "ode", "libode.so.8.2.2 0a1b2c3d4e5f". Two libraries
/// with equal texts are the same binary. Compilers choose the file's build id; "unknown" if a library has none.
std::vector<std::pair<std::string, std::string>> loaded_libraries();

}  // namespace constrictor
