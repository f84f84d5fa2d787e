#include "sim/overview/view_module.hpp"

#include <exception>

#include "sim/overview/overview_view.hpp"

namespace {

using namespace constrictor;

class ModuleView final : public LazyView {
 public:
  ModuleView(const msg::SceneDescription& description, const Eigen::Vector3d& head_camera_m)
      : view_(description, OverviewConfig{}, head_camera_m) {}
  const std::vector<std::uint8_t>& draw(const msg::WorldState& world) override { return view_.draw(world); }
  int width() const override { return view_.camera().width; }
  int height() const override { return view_.camera().height; }

 private:
  OverviewView view_;
};

std::unique_ptr<LazyView> make_view(const msg::SceneDescription& description, const Eigen::Vector3d& head_camera_m,
                                    std::string& error) {
  try {
    return std::make_unique<ModuleView>(description, head_camera_m);
  } catch (const std::exception& caught) {
    error = caught.what();
    return nullptr;
  }
}

}  // namespace

// A variable, because a function with C linkage must not return a C++ type.
extern "C" __attribute__((visibility("default"))) const MakeView constrictor_make_view;
const MakeView constrictor_make_view = make_view;
