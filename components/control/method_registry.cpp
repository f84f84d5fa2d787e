#include <cmath>

#include "control/control_method.hpp"
#include "robot/trajectory_path.hpp"

namespace constrictor {

bool ControlMethod::accepts(const msg::DesiredTrajectory& desired, const YawChain& chain) const {
  if (desired.shape_count > chain.joint_count() || !has_valid_path(desired)) return false;
  for (std::size_t k = 0; k < desired.shape_count; ++k) {
    if (!std::isfinite(desired.shape_rad[k])) return false;
  }
  return std::isfinite(desired.speed_m_s) && std::isfinite(desired.acceleration_m_s2) &&
         std::isfinite(desired.slide_m_s) && std::isfinite(desired.squeeze_rad);
}

void ControlMethod::start(const MethodInput&, BodyState&) const {}

MethodRegistry::MethodRegistry() : methods_(built_in_methods()) {}

void MethodRegistry::add(std::unique_ptr<ControlMethod> method) {
  std::erase_if(methods_, [&](const auto& known) { return known->name() == method->name(); });
  methods_.push_back(std::move(method));
}

const ControlMethod* MethodRegistry::find(std::string_view name) const {
  for (const auto& method : methods_) {
    if (method->name() == name) return method.get();
  }
  return nullptr;
}

std::vector<std::string_view> MethodRegistry::names() const {
  std::vector<std::string_view> names;
  for (const auto& method : methods_) names.push_back(method->name());
  return names;
}

}  // namespace constrictor
