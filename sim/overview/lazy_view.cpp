#include "sim/overview/lazy_view.hpp"

#include <stdexcept>
#include <string>

#include "configuration/lazy_module.hpp"
#include "sim/overview/view_module.hpp"

namespace constrictor {

std::unique_ptr<LazyView> make_view_lazily(const msg::SceneDescription& description,
                                           const Eigen::Vector3d& head_camera_m) {
  const auto make = lazy_variable<MakeView>(kViewModule, kMakeView, "the scene");
  std::string error;
  auto view = make(description, head_camera_m, error);
  if (!error.empty()) throw std::runtime_error(error);
  return view;
}

}  // namespace constrictor
