// The component: where the head is, and what is around it.
#pragma once

#include <cstdint>
#include <vector>

#include "guidance/field_mapper.hpp"
#include "runtime/component.hpp"
#include "runtime/parameters.hpp"

namespace constrictor {

struct GuidanceState {
  std::int64_t last_tick = 0;          ///< of the samples last used
  guidance::OdometryState odometry;
  guidance::PoseFilterState filter;
  /// Dead reckoning alone, by tick, oldest first: relates poses of different ticks whatever the filter corrected since.
  std::vector<std::int64_t> track_tick;
  std::vector<double> track_x_m, track_y_m, track_yaw_rad;
  guidance::FieldState field;
  double body_turn_rad = 0.0;          ///< mean heading of the modules relative to the head's
  ParameterState parameters;
  template <class Archive>
  void serialize(Archive& archive) {
    archive(last_tick, odometry, filter, track_tick, track_x_m, track_y_m, track_yaw_rad, field, body_turn_rad, parameters);
  }
};

/// Estimates the head's pose in M from the body's motion (odometry on a skin that does not slip sideways), the IMU's
/// yaw and recognised landmarks; keeps the map. Writes the pose every tick, from the first: before joints and IMU were
/// seen it is the start, with zero covariance. While no new plausible joint or IMU sample comes the pose stays; the next one is
/// taken over the whole time since.
class Guidance : public StatefulComponent<GuidanceState> {
 public:
  Guidance(Wiring& wiring, const Setup& setup);
  void step(const Tick& tick) override;

  [[nodiscard]] const GuidanceState& state() const { return state_; }

 private:
  /// Whether a message has come that a robot can have; one that none can have is counted as refused.
  template <class Message, class... Limits>
  bool believed(const Latest<Message>& input, const char* topic, Limits... limits);
  void dead_reckon(const Tick& tick, const guidance::BodyChain& chain);
  void remember(std::int64_t tick, const Eigen::Vector2d& step_m, double turn_rad);
  /// Where the head was at a tick, seen from where it is now.
  [[nodiscard]] guidance::Pose2 past(std::int64_t tick) const;
  [[nodiscard]] double speed_m_s(double period_s) const;

  Wiring& wiring_;
  RobotModel model_;
  guidance::GuidanceConfig config_;
  Parameters parameters_;  ///< of config_
  Latest<msg::JointState> joints_;
  Latest<msg::ImuState> imu_;
  Latest<msg::ContactState> contacts_;
  Latest<msg::LinePercept> line_;
  Latest<msg::ObjectPercepts> objects_;
  Latest<msg::TaskStatus> task_;
  Output<msg::RobotPose> pose_;
  Output<msg::FieldMap> map_;
};

/// Declares the component to the runtime.
ComponentFactory make_guidance_factory();

}  // namespace constrictor
