// The picture of the whole scene, drawn by a module that is loaded when the first picture is drawn: OSMesa and LLVM
// would make the start of every process that contains the report slower, and its memory larger.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <vector>

#include "constrictor/messages.hpp"

namespace constrictor {

/// OverviewView (overview_view.hpp) without its dependences.
class LazyView {
 public:
  virtual ~LazyView() = default;
  /// Returns RGB8 rows from the top, width() * height() * 3 bytes, valid until the next call.
  [[nodiscard]] virtual const std::vector<std::uint8_t>& draw(const msg::WorldState& world) = 0;
  [[nodiscard]] virtual int width() const = 0;
  [[nodiscard]] virtual int height() const = 0;
};

/// The view with its default options. The arguments are those of OverviewView. Throws std::runtime_error if OpenGL
/// fails, or if the module is missing.
[[nodiscard]] std::unique_ptr<LazyView> make_view_lazily(const msg::SceneDescription& description,
                                                         const Eigen::Vector3d& head_camera_m);

}  // namespace constrictor
