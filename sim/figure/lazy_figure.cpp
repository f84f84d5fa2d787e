#include "sim/figure/lazy_figure.hpp"

#include <dlfcn.h>

#include <stdexcept>

#include "sim/figure/figure_module.hpp"

namespace constrictor::figure {

std::string draw_png_lazily(const Heading& heading, const std::vector<FileRow>& rows, const std::string& torques_csv,
                            double window_s) {
  const auto file = std::filesystem::read_symlink("/proc/self/exe").parent_path() / kFigureModule;
  // Loaded once and never unloaded: GLib cannot be removed from a process.
  void* module = ::dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
  if (module == nullptr) throw std::runtime_error(std::string("cannot load the module of the figure: ") + ::dlerror());
  const auto* draw = static_cast<const DrawPng*>(::dlsym(module, kDrawPng));
  if (draw == nullptr) throw std::runtime_error(std::string("cannot load the module of the figure: ") + ::dlerror());
  std::string error;
  std::string bytes = (*draw)(heading, rows, torques_csv, window_s, error);
  if (!error.empty()) throw std::runtime_error(error);
  return bytes;
}

}  // namespace constrictor::figure
