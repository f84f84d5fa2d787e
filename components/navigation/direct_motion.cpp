#include "navigation/direct_motion.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "navigation/motions.hpp"

namespace constrictor {
namespace {

constexpr double kHeadRate_rad_s = 0.5;

/// The grip by which the motions keep a wrapped body in its posture and cap the torque of its base, although no object
/// was felt.
Grip posture_grip(const NavigationConfig& config, const GripSense& sense, const Grip& grip,
                  const DirectMotionState& state) {
  Grip now = grip;
  if (grip.carrying || state.wrapped_side == 0.0) return now;
  now.carrying = true;  // makes the motions keep the posture
  now.side = state.wrapped_side;
  now.shape_rad = sense.open_shape(now.side, config.grip.base_angle_rad);
  if (state.squeezed) {
    const double closing_rad = state.wrapped_side * config.grasp.squeeze_max_rad / config.grip.base_joints;
    for (double& angle_rad : now.shape_rad) {
      if (angle_rad != 0.0) angle_rad += closing_rad;
    }
  }
  now.hold_torque_nm = state.squeezed ? config.grip.hold_torque_nm : 0.0;
  return now;
}

}  // namespace

void begin_motion(const msg::MotionCommand& command, DirectMotionState& state, Grip& grip) {
  const bool same = state.active && state.motion == command.motion;
  state.begins = !same || command.motion == msg::kMotionWrap || command.motion == msg::kMotionSqueeze;
  state.active = true;
  state.motion = command.motion;
  state.speed_m_s = command.speed_m_s;
  state.curvature_1_m = command.curvature_1_m;
  state.angle_rad = command.angle_rad;
  switch (command.motion) {
    case msg::kMotionWrap:
      state.wrapped_side = command.angle_rad < 0.0 ? -1.0 : 1.0;
      state.squeezed = false;
      grip.pregrasped = grip.carrying = false;
      break;
    case msg::kMotionSqueeze:
      state.squeezed = state.wrapped_side != 0.0;
      break;
    case msg::kMotionOpen:
      state.wrapped_side = 0.0;
      state.squeezed = false;
      grip.pregrasped = grip.carrying = false;
      break;
    default:
      break;
  }
}

void step_motion(const NavigationConfig& config, const GripSense& sense, const Grip& grip, DirectMotionState& state,
                 TaskOutput& output) {
  const Grip body = posture_grip(config, sense, grip, state);
  output.new_motion = std::exchange(state.begins, false);
  switch (state.motion) {
    case msg::kMotionDrive: {
      output.phase = "drive";
      Pace pace = present_pace(config, body);
      pace.speed_m_s = std::abs(state.speed_m_s);
      move_along(pace, state.curvature_1_m, state.speed_m_s < 0.0 ? -1.0 : 1.0, body, output);
      if (grip.carrying) keep_upright(config, grip, output);
      break;
    }
    case msg::kMotionLook:
      output.phase = "look";
      bend_head(state.angle_rad / 3.0, kHeadRate_rad_s, body, output);
      break;
    case msg::kMotionWrap:
      output.phase = "wrap";
      wrap_round(sense, config.grasp.wrap_m_s, state.wrapped_side, config.grasp.wrap_speed_m_s, grip, output);
      break;
    case msg::kMotionSqueeze:
      output.phase = "squeeze";
      if (state.wrapped_side == 0.0) {
        stand(body, output);
        break;
      }
      squeeze_u(config, sense, state.wrapped_side, grip, output);
      break;
    case msg::kMotionOpen:
      output.phase = "open";
      bend_head(0.0, config.drop.straighten_rate_rad_s, body, output);
      break;
    default:
      output.phase = "stand";
      stand(body, output);
      break;
  }
}

}  // namespace constrictor
