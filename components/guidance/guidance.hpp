// The component: estimates the pose of the head and keeps the map.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "component/component.hpp"
#include "component/parameters.hpp"
#include "component/robot_views.hpp"
#include "guidance/field_mapper.hpp"
#include "robot/ground_slope.hpp"

namespace constrictor {

struct GuidanceState {
  std::int64_t last_tick = 0;  ///< tick of the joints that were used last
  std::int64_t imu_tick = 0;   ///< tick of the newest plausible IMU sample
  std::int64_t map_tick = -5;  ///< in which the map was published last
  bool imu_silent = false;     ///< the IMU has been silent for kSilent_s
  bool left_out = false;       ///< the map is full, and images have shown more
  guidance::OdometryState odometry;
  GroundSlope slope;
  int scale_loaded = -1;  ///< the scale of the filter is that of a robot with (1) or without (0) an object; -1: unknown
  bool brushes = false;   ///< the body may push an object without feeling it
  double pitch_rate_rad_s = 0.0;  ///< smoothed mean rate of the pitch joints, without sign
  guidance::PoseFilterState filter;
  /// Poses from dead reckoning, with the scale of the filter, one per tick, the oldest first. They give the motion
  /// between two ticks, independently of later corrections by the filter.
  std::vector<std::int64_t> track_tick;
  std::vector<double> track_x_m, track_y_m, track_yaw_rad;
  guidance::FieldState field;
  double body_turn_rad = 0.0;  ///< mean heading of the modules relative to the head
  ParameterState parameters;
  template <class Archive>
  void serialize(Archive& archive) {
    archive(last_tick, imu_tick, map_tick, imu_silent, left_out, odometry, slope, scale_loaded, brushes,
            pitch_rate_rad_s, filter, track_tick, track_x_m, track_y_m, track_yaw_rad, field, body_turn_rad,
            parameters);
  }
};

/// Estimates the pose of the head in M from the motion of the body (odometry), the yaw of the IMU, and recognised
/// landmarks; keeps the map. Publishes the pose in every tick. Before the first joint and IMU samples it is the start
/// pose with zero covariance. Without new plausible joint and IMU samples the pose does not change; the next samples
/// then give the motion over the whole time since the last ones. If IMU samples are missing for kSilent_s, or the robot
/// has no IMU, the turns follow from the joints alone, less exactly, and the ground counts as level.
class Guidance : public TunableComponent<GuidanceState, guidance::GuidanceConfig> {
 public:
  Guidance(Wiring& wiring, const Setup& setup);
  [[nodiscard]] bool has_short_steps() const override { return true; }
  void step(const Tick& tick) override;

 private:
  /// Whether a new message has arrived and is plausible. An implausible message is counted as a refusal.
  template <class Message, class... Limits>
  bool believed(const Latest<Message>& input, const char* topic, Limits... limits);
  /// The same for the samples of a topic that several cameras share: the plausible ones of the robot's further cameras.
  template <class Message>
  std::vector<const Message*> believed(const Events<Message>& input, const char* topic);
  /// Maps what the further cameras have seen. `level`: the head is not tilted.
  void map_further(const Tick& tick, guidance::FieldMapper& mapper, const guidance::BodyChain& chain, bool level);
  /// Reports the first object or zone for which a full map has no room, once until it has room again.
  void report_full_map(const guidance::FieldMapper& mapper);
  /// Maps objects and zones, and gives landmarks up that are not there any more.
  void map_objects(const Tick& tick, guidance::FieldMapper& mapper, const msg::ObjectPercepts& objects,
                   const guidance::BodyChain& chain, bool level);
  /// `imu`: the inertial unit measures the attitude of the head.
  void dead_reckon(const Tick& tick, const guidance::BodyChain& chain, bool imu);
  /// Whether modules leave the ground, by the rate of the pitch joints; the odometry has no equations for that. Reports
  /// when it begins.
  bool watch_lifting(double dt_s);
  /// Appends a step to the track of dead-reckoned poses.
  void remember(std::int64_t tick, const Eigen::Vector2d& step_m, double turn_rad);
  /// Pose of the head at an earlier tick, in the head's present frame.
  [[nodiscard]] PlanarPose past(std::int64_t tick) const;
  [[nodiscard]] double speed_m_s(double period_s) const;

  Log log_;
  RobotModel model_;
  BodyView body_{wiring_};
  Latest<msg::ImuState> imu_ = wiring_.latest(topics::kImuState);
  PerceptView percepts_{wiring_};
  std::optional<FurtherPerceptView> further_;  // of a robot that has further cameras
  Latest<msg::TaskStatus> task_ = wiring_.latest(topics::kTaskStatus);
  Output<msg::RobotPose> pose_ = wiring_.output(topics::kRobotPose);
  Output<msg::FieldMap> map_ = wiring_.output(topics::kFieldMap);
};

/// Declares the component to the runtime.
ComponentFactory make_guidance_factory();

}  // namespace constrictor
