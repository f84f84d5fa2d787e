// The interface between the module that draws the scene and its user. Both are built together, so that C++ types may
// cross.
#pragma once

#include <memory>
#include <string>

#include "sim/overview/lazy_view.hpp"

namespace constrictor {

inline constexpr const char* kViewModule = "constrictor_overview.so";  // beside the programs
inline constexpr const char* kMakeView = "constrictor_make_view";
/// `error`: empty, or why there is no view.
using MakeView = std::unique_ptr<LazyView> (*)(const msg::SceneDescription& description,
                                               const Eigen::Vector3d& head_camera_m, std::string& error);

}  // namespace constrictor
