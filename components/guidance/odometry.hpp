// Motion of the head over the ground, from the deformation of the body. The skin slides more easily along the body than
// across it; how easily is measured while the robot drives.
#pragma once

#include <Eigen/Core>
#include <cereal/types/vector.hpp>
#include <vector>

#include "robot/robot_model.hpp"

namespace constrictor::guidance {

/// The defaults are in GuidanceConfig.
struct OdometryConfig {
  double slip_scale_m_s = 0.0;  ///< sliding speed above which the full Coulomb friction acts
  double joint_gain = 0.0;      ///< share of a joint's measured angle; the rest is its integrated rate
  double friction_along = 0.0;  ///< first guesses of the coefficients of friction on the ground
  double friction_across = 0.0;
  double friction_rate_1_s = 0.0;  ///< speed at which the estimates of the coefficients follow the measurements
  double stick_below = 0.0;        ///< a module sticks if its sideways force is below this share of its friction
  double stick_factor = 1.0;       ///< factor on the friction across a module that sticks
};

struct OdometryState {
  bool started = false;
  double yaw_rad = 0.0;               ///< yaw of the IMU at the previous step
  std::vector<double> joint_rad;      ///< smoothed angles
  std::vector<double> joint_rad_s;    ///< measured rates of the previous step
  double vx_m_s = 0.0, vy_m_s = 0.0;  ///< velocity of the centre of mass, in the head's frame
  double friction_along = 0.0;        ///< estimated coefficients
  double friction_across = 0.0;
  double driven_s = 0.0;  ///< time for which the coefficients have been estimated
  double spin_nms = 0.0;  ///< angular momentum after a step whose turn was not measured
  template <class Archive>
  void serialize(Archive& archive) {
    archive(started, yaw_rad, joint_rad, joint_rad_s, vx_m_s, vy_m_s, friction_along, friction_across, driven_s,
            spin_nms);
  }
};

/// Force of the ground on a module, in the module's frame. NaN: unknown, for example because something else touches the
/// module, too.
struct GroundForce {
  double along_n, across_n, normal_n;
};

/// The measurements of one step.
struct OdometryInput {
  const double* joint_rad = nullptr;  ///< angles of all joints, head to tail; finite
  const double* joint_rad_s = nullptr;
  double yaw_rad = 0.0;                ///< yaw of the IMU; NaN: not measured, the turn follows from the joints
  std::vector<double> load_n;          ///< normal force on each module; empty: the weight is spread evenly
  std::vector<GroundForce> ground;     ///< of each module; empty: not measured, the estimates of friction stay
  Eigen::Vector2d push_n{0.0, 0.0};    ///< sum of the contact forces, except those of the ground; in the head's frame
  Eigen::Vector2d downhill{0.0, 0.0};  ///< gravity along the ground, as a share of it; in the head's frame
  double dt_s = 0.02;
};

struct HeadStep {
  Eigen::Vector2d step_m{0.0, 0.0};  ///< motion of the head; x is its heading in the middle of the step
  /// The motion of the centre of mass in the same frame: the part of step_m that friction decides. The rest of it
  /// follows from the joints.
  Eigen::Vector2d drift_m{0.0, 0.0};
  double turn_rad = 0.0;
  double slip_m_s = 0.0;  ///< mean sideways slip of the modules, weighted by load
};

/// One step of the body's balance of momentum in the plane with Coulomb friction under each module, as a convex
/// problem: the velocity V of the centre of mass minimises
///   M |V - V_before - (push / M + g downhill) dt|^2 / (2 dt) + sum_i N_i (mu_across |v_i across| + mu_along |v_i
///   along|),
/// where v_i, the velocity of each end of a module, is V plus what the joints and the measured turn add (implicit Euler
/// on the dissipation potential; solved by iteratively reweighted least squares). With high friction across the body,
/// the modules hardly slip sideways; without friction, the centre of mass keeps its velocity. The coefficients mu are
/// estimated from the measured forces of the ground while the body drives: nearly all modules slide along themselves
/// then, so that mu_along is the median of their ratios of friction to load; only some slide sideways, so that
/// mu_across is the upper quartile. A module whose measured sideways force is clearly below its friction does not slide
/// sideways; small errors of the measured shape must not make it slide in the model, so that its term is multiplied by
/// `stick_factor`. Without a measured yaw, the turn comes first from the same balance, in which the rate of the turn is
/// a third unknown. The first call only initialises `state`.
HeadStep advance_odometry(OdometryState& state, const RobotModel& model, const OdometryConfig& config,
                          const OdometryInput& input);

}  // namespace constrictor::guidance
