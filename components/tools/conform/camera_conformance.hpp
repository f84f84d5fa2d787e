// Checks whether a camera keeps the contract of idl/CLIENTS.md. The head is turned and lifted slowly, by the plant of
// the run, if there is one that obeys.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "conform/camera_profile.hpp"
#include "conform/part_port.hpp"
#include "conform/report.hpp"
#include "robot/robot_model.hpp"

namespace constrictor::conform {

/// All checks, in the order in which they are made.
[[nodiscard]] std::vector<Check> camera_checks();

class CameraConformance {
 public:
  /// All arguments must outlive this object. `may_move`: the port can send joint_command, and a plant reads it.
  CameraConformance(PartPort& port, const RobotModel& robot, const CameraProfile& profile, bool may_move,
                    Report& report)
      : port_(port),
        robot_(robot),
        profile_(profile),
        in_barrier_(may_move),
        may_move_(may_move && profile.moves),
        report_(report) {}

  /// Makes all checks that can be made. Throws PartGone; the report then has the results so far.
  void run();

 private:
  /// One image.
  struct Frame {
    std::int64_t arrival_tick = 0;  ///< at which it could be read
    std::int64_t written_tick = 0, exposure_tick = 0;
    int width = 0, height = 0;
    std::size_t bytes = 0;
    cv::Mat rgb;   ///< CV_8UC3; empty if the size is wrong
    cv::Mat grey;  ///< CV_32FC1, 0 to 1
  };
  /// The turned head.
  struct Motion {
    double wanted_rad = 0.0, seen_rad = 0.0;
    double likeness = 0.0, at_rest = 0.0;
    bool obeyed = false;          ///< the measured angle has followed
    std::optional<double> lag_s;  ///< of the images behind their stamps
  };

  // At rest (camera_checks.cpp).
  bool check_arrival();
  void check_model();
  void check_frames();
  void check_stamps();
  void check_pictures();
  void check_colour();
  void check_restart();
  // While the head moves (camera_motion_checks.cpp).
  void check_motion();
  void judge_motion(const Motion& yaw, const std::optional<Motion>& pitch);
  Motion turn(std::size_t joint, const Eigen::Vector3d& axis_H, double angle_rad);
  void move_to(std::size_t joint, double goal_rad);

  void tick();
  void watch(double seconds);
  [[nodiscard]] double angle_at(std::int64_t tick, std::size_t joint) const;

  PartPort& port_;
  const RobotModel& robot_;
  const CameraProfile& profile_;
  bool in_barrier_;  ///< the port makes every tick; an observer does not know at which tick an image can be read
  bool may_move_;
  Report& report_;
  std::optional<msg::CameraInfo> info_;
  std::size_t infos_ = 0;
  bool info_changed_ = false;
  std::int64_t info_tick_ = 0;
  std::vector<Frame> frames_;
  struct Posture {
    std::int64_t tick = 0;
    std::vector<double> angles_rad;
  };
  std::vector<Posture> postures_;  ///< measured
  std::vector<double> setpoints_rad_;
};

}  // namespace constrictor::conform
