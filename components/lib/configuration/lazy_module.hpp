// Modules that a program loads only when it needs them, because their libraries would cost each of its starts time and
// memory.
#pragma once

#include <dlfcn.h>

#include <filesystem>
#include <stdexcept>
#include <string>

namespace constrictor {

/// The variable `name` of the module `file`, which lies beside the program. The module is loaded once and never
/// unloaded: GLib and LLVM cannot be removed from a process. `what`: for the message, for example "the figure". Throws
/// std::runtime_error if module or variable is missing.
template <class Variable>
const Variable& lazy_variable(const char* file, const char* name, const std::string& what) {
  const auto path = std::filesystem::read_symlink("/proc/self/exe").parent_path() / file;
  void* module = ::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
  const void* variable = module == nullptr ? nullptr : ::dlsym(module, name);
  if (variable == nullptr) throw std::runtime_error("cannot load the module of " + what + ": " + ::dlerror());
  return *static_cast<const Variable*>(variable);
}

}  // namespace constrictor
