#include "sim/overview/overview.hpp"

#include "robot/robot_model.hpp"
#include "sim/render/image_message.hpp"

namespace constrictor {

Overview::Overview(Wiring& wiring, const Setup& setup)
    : ConfiguredComponent(wiring, setup),
      timing_{static_cast<std::uint16_t>(config_.period_ticks), static_cast<std::uint16_t>(config_.latency_ticks)},
      head_camera_m_(load_robot(setup.robot_file).camera.p_HC) {}

void Overview::step(const Tick&) {
  if (!world_ || !description_) return;
  if (!view_) view_ = std::make_unique<OverviewView>(*description_, config_, head_camera_m_);
  image_.write(image_message(view_->camera(), view_->draw(*world_), world_->header.tick));
  ++state_.frames;
}

ComponentFactory make_overview_factory() {
  return make_factory<Overview, OverviewConfig>("overview", "sim/overview/overview.yaml");
}

}  // namespace constrictor
