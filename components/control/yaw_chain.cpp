#include "control/yaw_chain.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace constrictor {

YawChain::YawChain(const RobotModel& robot)
    : joints_(robot.yaw_joints()), has_pitch_joints_(joints_.size() < robot.joints.size()) {
  const double spacing_m = robot.module_length_m;
  // Joint j lies half a module behind the centre of module j.
  auto joint_arc_m = [&](std::size_t k) { return (static_cast<double>(joints_[k]) + 0.5) * spacing_m; };
  double front_m = -0.5 * spacing_m;
  for (std::size_t k = 0; k < link_count(); ++k) {
    const double back_m =
        k < joints_.size() ? joint_arc_m(k) : (static_cast<double>(robot.module_count) - 0.5) * spacing_m;
    front_m_.push_back(front_m);
    length_m_.push_back(back_m - front_m);
    arc_m_[k] = -0.5 * (front_m + back_m);
    front_m = back_m;
  }
  link_length_m_ = joints_.size() > 1 ? joint_arc_m(1) - joint_arc_m(0) : spacing_m;
}

LinkArray YawChain::headings(const LinkArray& shape_rad) const {
  LinkArray heading{};
  for (std::size_t k = 0; k < joint_count(); ++k) heading[k + 1] = heading[k] - shape_rad[k];
  return heading;
}

LinkArray YawChain::coordinates(const LinkArray& headings_rad) const {
  LinkArray x{};
  double front_x_m = -front_m_[0] * std::cos(headings_rad[0]);
  for (std::size_t k = 0; k < link_count(); ++k) {
    const double extent_m = length_m_[k] * std::cos(headings_rad[k]);
    x[k] = front_x_m - 0.5 * extent_m;
    front_x_m -= extent_m;
  }
  return x;
}

LinkArray YawChain::weights(const LinkArray& shape_rad, const WaveWeights& weights) const {
  LinkArray w{};
  for (std::size_t k = 0; k < link_count(); ++k) {
    const double ahead_rad = k > 0 ? std::abs(shape_rad[k - 1]) : 0.0;
    const double behind_rad = k < joint_count() ? std::abs(shape_rad[k]) : 0.0;
    w[k] = 1.0 - std::min(1.0, std::min(ahead_rad, behind_rad) / weights.rigid_bend_rad);
    if (k < weights.head.size()) w[k] *= weights.head[k];
  }
  return w;
}

LinkArray YawChain::joint_angles(const LinkArray& shape_rad, const Wave& wave, const WaveWeights& weights) const {
  const LinkArray theta = headings(shape_rad);
  const LinkArray x = coordinates(theta);
  const LinkArray w = this->weights(shape_rad, weights);
  const double wave_number = 2.0 * std::numbers::pi / wave.wavelength_m;
  LinkArray heading{};
  for (std::size_t k = 0; k < link_count(); ++k) {
    const double argument_m = wave.field * x[k] + (1.0 - wave.field) * arc_m_[k];
    heading[k] = theta[k] + wave.curvature_1_m * x[k] +
                 wave.amplitude_rad * w[k] * std::cos(wave_number * argument_m + wave.phase_rad);
  }
  LinkArray angle{};
  for (std::size_t k = 0; k < joint_count(); ++k) angle[k] = heading[k] - heading[k + 1];
  return angle;
}

LinkArray YawChain::slid(const LinkArray& shape_rad, double distance_m) const {
  LinkArray out{};
  const auto count = static_cast<double>(joint_count());
  for (std::size_t k = 0; k < joint_count(); ++k) {
    const double at = static_cast<double>(k) + distance_m / link_length_m_;
    const double lower = std::floor(at);
    const double share = at - lower;
    auto value = [&](double index) {
      return index >= 0.0 && index < count ? shape_rad[static_cast<std::size_t>(index)] : 0.0;
    };
    out[k] = (1.0 - share) * value(lower) + share * value(lower + 1.0);
  }
  return out;
}

}  // namespace constrictor
