#include "sim/overview/lazy_view.hpp"

#include <dlfcn.h>

#include <filesystem>
#include <stdexcept>
#include <string>

#include "sim/overview/view_module.hpp"

namespace constrictor {

std::unique_ptr<LazyView> make_view_lazily(const msg::SceneDescription& description,
                                           const Eigen::Vector3d& head_camera_m) {
  const auto file = std::filesystem::read_symlink("/proc/self/exe").parent_path() / kViewModule;
  // Loaded once and never unloaded, because LLVM keeps state until the process ends.
  void* module = ::dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
  const auto* make = module == nullptr ? nullptr : static_cast<const MakeView*>(::dlsym(module, kMakeView));
  if (make == nullptr) throw std::runtime_error(std::string("cannot load the module of the scene: ") + ::dlerror());
  std::string error;
  auto view = (*make)(description, head_camera_m, error);
  if (!error.empty()) throw std::runtime_error(error);
  return view;
}

}  // namespace constrictor
