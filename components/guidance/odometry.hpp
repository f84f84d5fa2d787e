// Motion of the head over the ground, from the deformation of the body. The skin slides easily along the body and
// hardly across it.
#pragma once

#include <Eigen/Core>
#include <cereal/types/vector.hpp>
#include <vector>

#include "robot/robot_model.hpp"

namespace constrictor::guidance {

/// The defaults are in GuidanceConfig.
struct OdometryConfig {
  double friction_along_share = 0.0;  ///< multiplies the robot file's friction coefficient along the modules
  double slip_scale_m_s = 0.0;        ///< sliding speed above which the full Coulomb friction acts
  double joint_gain = 0.0;            ///< share of a joint's measured angle; the rest is its integrated rate
};

struct OdometryState {
  bool started = false;
  double yaw_rad = 0.0;               ///< yaw of the IMU at the previous step
  std::vector<double> joint_rad;      ///< smoothed angles
  std::vector<double> joint_rad_s;    ///< measured rates of the previous step
  double vx_m_s = 0.0, vy_m_s = 0.0;  ///< velocity of the centre of mass, in the head's frame
  template <class Archive>
  void serialize(Archive& archive) {
    archive(started, yaw_rad, joint_rad, joint_rad_s, vx_m_s, vy_m_s);
  }
};

/// The measurements of one step.
struct OdometryInput {
  const double* joint_rad = nullptr;  ///< angles of all joints, head to tail; finite
  const double* joint_rad_s = nullptr;
  double yaw_rad = 0.0;              ///< yaw of the IMU; finite
  std::vector<double> load_n;        ///< normal force on each module; empty: the weight is spread evenly
  Eigen::Vector2d push_n{0.0, 0.0};  ///< sum of the contact forces, except those of the ground; in the head's frame
  double dt_s = 0.02;
};

struct HeadStep {
  Eigen::Vector2d step_m{0.0, 0.0};  ///< motion of the head; x is its heading in the middle of the step
  double turn_rad = 0.0;
  double slip_m_s = 0.0;  ///< mean sideways slip of the modules, weighted by load
};

/// One step of the body's balance of momentum in the plane with Coulomb friction under each module, as a convex
/// problem: the velocity V of the centre of mass minimises
///   M |V - V_before - push dt / M|^2 / (2 dt) + sum_i N_i (mu_across |v_i across| + mu_along |v_i along|),
/// where v_i is V plus what the joints and the measured turn add (implicit Euler on the dissipation potential; solved
/// by iteratively reweighted least squares). With high friction across the body, the modules hardly slip sideways;
/// without friction, the centre of mass keeps its velocity. The first call only initialises `state`.
HeadStep advance_odometry(OdometryState& state, const RobotModel& model, const OdometryConfig& config,
                          const OdometryInput& input);

}  // namespace constrictor::guidance
