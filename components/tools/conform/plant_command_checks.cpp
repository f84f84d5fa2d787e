// Commands that a plant must not obey, the end of commands, stops and new epochs.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "conform/plant_conformance.hpp"

namespace constrictor::conform {
namespace {

constexpr double kWrong_s = 0.2;  // for which wrong commands are sent

}  // namespace

void PlantConformance::refuses(const char* name, const PlantCommand& wrong, bool beside_proper, const char* todo) {
  std::vector<PlantCommand> commands;
  if (beside_proper) commands.push_back(hand_.command());
  commands.push_back(wrong);
  std::vector<JointSample> samples = hand_.send(commands, kWrong_s);
  const std::vector<JointSample> after = hand_.hold(profile_.settle_s);
  samples.insert(samples.end(), after.begin(), after.begin() + static_cast<std::ptrdiff_t>(after.size() / 2));
  const double strayed = strayed_rad(samples);
  const double bound_rad = std::max(profile_.rest_rad, 0.3 * profile_.amplitude_rad);
  report_.judge(name, !(strayed < bound_rad),
                strayed < bound_rad ? "ignored" : fmt::format("a joint moved by {:.3f} rad", strayed), todo);
  hand_.hold(profile_.settle_s);
}

void PlantConformance::check_commands() {
  const auto joint = static_cast<std::size_t>(profile_.joints.front());
  const double goal_rad = hand_.goal_rad(joint);
  const PlantCommand proper = hand_.command();
  PlantCommand moved = proper;
  moved.position_rad[joint] = goal_rad;

  PlantCommand wrong = proper;
  const auto& limits = robot_.joints[joint];
  wrong.position_rad[joint] = (goal_rad > proper.position_rad[joint] ? limits.max_rad : limits.min_rad) +
                              std::copysign(0.3, goal_rad - proper.position_rad[joint]);
  // A plant that obeys it must not move far: the torque is limited.
  wrong.torque_limit_nm[joint] *= 0.5;
  refuses("limit", wrong, false, "compare each position_rad with the joint's limits before anything moves");

  wrong = moved;
  wrong.position_rad.pop_back();
  wrong.velocity_rad_s.pop_back();
  wrong.torque_limit_nm.pop_back();
  wrong.torque_nm.pop_back();
  refuses("too_few", wrong, false, "compare joint_count with the number of joints before anything moves");
  wrong = moved;
  if (wrong.position_rad.size() < 64) {
    wrong.position_rad.push_back(0.0);
    wrong.velocity_rad_s.push_back(0.0);
    wrong.torque_limit_nm.push_back(0.0);
    wrong.torque_nm.push_back(0.0);
    refuses("too_many", wrong, false, "compare joint_count with the number of joints before anything moves");
  } else {
    report_.skip("too_many", "the robot has as many joints as a message can hold");
  }
  if (port_.abilities().raw) {
    wrong = moved;
    wrong.position_rad.back() = std::numeric_limits<double>::quiet_NaN();
    refuses("not_finite", wrong, false, "ignore the whole command if any value is not finite");
    wrong = moved;
    wrong.unknown_mode = true;
    refuses("unknown_mode", wrong, false, "ignore the whole command if its mode is none of kServo...");
  } else {
    skip_all({"not_finite", "unknown_mode"}, "a member cannot send such a message: the runtime refuses it");
  }
  if (port_.abilities().sessions) {
    wrong = moved;
    wrong.origin = PlantCommand::Origin::kOld;
    refuses("old_command", wrong, false, "obey only numbers that are higher than all before in the session");
    wrong = moved;
    wrong.origin = PlantCommand::Origin::kStranger;
    refuses("stranger", wrong, true, "follow one session; accept another one when it has been silent for 0.1 s");
  } else {
    skip_all({"old_command", "stranger"}, "the run itself stamps the commands of a member, and refuses strangers");
  }
  check_torque_limit(joint);
  check_torque_mode();
  check_silence(joint);
  check_return(joint, "returns", "obey commands again as soon as they arrive, from the measured posture on");
  if (port_.abilities().sessions) {
    hand_.watch(0.3);
    port_.begin_session();
    check_return(joint, "new_session", "accept another session after 0.1 s of silence; its numbers begin at 1");
  } else {
    skip_all({"new_session"}, "a member has epochs instead");
  }
  check_relaxed();
  check_stop(joint);
  check_epoch(joint);
  check_restart(joint);
}

void PlantConformance::check_torque_limit(std::size_t joint) {
  const double limit_nm = 0.05 * robot_.joints[joint].max_torque_nm;
  hand_.limit_torque(joint, limit_nm);
  hand_.hold(profile_.settle_s);
  const double start_rad = hand_.setpoint_rad(joint);
  double largest_nm = 0.0;
  for (const auto& at : hand_.move(joint, hand_.goal_rad(joint)))
    largest_nm = std::max(largest_nm, std::abs(at.sample.torque_nm[joint]));
  hand_.move(joint, start_rad);
  hand_.restore_torque();
  hand_.hold(profile_.settle_s);
  report_.judge("torque_limit", largest_nm > limit_nm + profile_.torque_nm,
                fmt::format("{:.2f} Nm with a limit of {:.2f} Nm", largest_nm, limit_nm),
                "limit the servo's torque to torque_limit_nm of each command; check the unit of torque_nm");
}

void PlantConformance::check_relaxed() {
  PlantCommand relaxed = hand_.command();
  relaxed.relaxed = true;
  hand_.send({relaxed}, 0.8);
  double largest_nm = 0.0;
  for (const auto& sample : hand_.send({relaxed}, 0.2)) {
    for (const double torque_nm : sample.torque_nm) largest_nm = std::max(largest_nm, std::abs(torque_nm));
  }
  hand_.begin_at_posture();
  hand_.hold(profile_.settle_s);
  report_.judge("relaxed", largest_nm > profile_.torque_nm, fmt::format("{:.2f} Nm at most", largest_nm),
                "switch the torque off in the mode relaxed");
}

void PlantConformance::break_motion_off(std::size_t joint) {
  const double start_rad = hand_.setpoint_rad(joint);
  const double half_rad = 0.5 * (start_rad + hand_.goal_rad(joint));
  const double way = std::copysign(1.0, half_rad - start_rad);
  PlantCommand command = hand_.command();
  const double step_rad = profile_.rate_rad_s * profile_.period_s;
  command.velocity_rad_s[joint] = way * profile_.rate_rad_s;
  for (double at_rad = start_rad; way * (half_rad - at_rad) > 0.0; at_rad += way * step_rad) {
    command.position_rad[joint] = at_rad;
    hand_.send({command}, profile_.period_s);
  }
  hand_.watch(profile_.stop_within_s);
}

void PlantConformance::check_silence(std::size_t joint) {
  break_motion_off(joint);
  const std::vector<double> rest_rad = hand_.mean_rad(hand_.watch(5 * profile_.period_s));
  const std::vector<JointSample> later = hand_.watch(0.5);
  std::string wrong;
  for (const auto& sample : later) {
    for (std::size_t i = 0; i < rest_rad.size() && i < sample.position_rad.size(); ++i) {
      const double moved_rad = std::abs(sample.position_rad[i] - rest_rad[i]);
      if (moved_rad > profile_.rest_rad)
        wrong = fmt::format("joint {} moved by {:.3f} rad, {:.1f} s after the last command", i, moved_rad,
                            profile_.stop_within_s + 0.5);
    }
  }
  if (later.empty()) wrong = "the joint states end with the commands";
  if (wrong.empty() && port_.abilities().sessions && !later.back().holding) wrong = "at rest, but holding is false";
  report_.pass_unless(
      "silence", wrong, "the joints rest",
      "hold the measured posture 0.1 s after the last command, set holding, and go on writing joint states");
  hand_.begin_at_posture();
}

void PlantConformance::check_return(std::size_t joint, const char* name, const char* todo) {
  hand_.begin_at_posture();
  hand_.hold(profile_.settle_s);
  bool escaped = false;
  const double start_rad = hand_.setpoint_rad(joint), goal_rad = hand_.goal_rad(joint);
  const auto before_rad = hand_.mean_rad(hand_.hold(5 * profile_.period_s));
  hand_.move(joint, goal_rad, &escaped);
  const auto after_rad = hand_.mean_rad(hand_.hold(5 * profile_.period_s));
  if (!escaped) hand_.move(joint, start_rad);
  const double ratio = (after_rad[joint] - before_rad[joint]) / (goal_rad - start_rad);
  const bool obeyed = std::abs(ratio - 1.0) < 2.0 * profile_.gain_tolerance && !escaped;
  report_.judge(name, !obeyed,
                obeyed ? "obeyed" : fmt::format("joint {} moved {:.2f} times as far as commanded", joint, ratio), todo);
  hand_.begin_at_posture();
}

void PlantConformance::check_stop(std::size_t joint) {
  if (!port_.abilities().stops)
    return report_.skip("stop", "plant_relay obeys emergency stops, so that this process need not");
  const double start_rad = hand_.setpoint_rad(joint), goal_rad = hand_.goal_rad(joint);
  port_.order_stop();
  for (const double begin_s = port_.now_s(); !port_.stopped() && port_.now_s() - begin_s < 2.0;)
    hand_.hold(profile_.period_s);
  std::string wrong = port_.stopped() ? "" : "emergency_stop/state does not show the stop";
  const auto before_rad = hand_.mean_rad(hand_.hold(5 * profile_.period_s));
  hand_.move(joint, goal_rad);
  const auto after_rad = hand_.mean_rad(hand_.hold(5 * profile_.period_s));
  const double moved_rad = std::abs(after_rad[joint] - before_rad[joint]);
  if (wrong.empty() && moved_rad > profile_.rest_rad)
    wrong = fmt::format("joint {} moved by {:.3f} rad during a stop", joint, moved_rad);
  hand_.move(joint, start_rad);
  port_.clear_stop();
  for (const double begin_s = port_.now_s(); port_.stopped() && port_.now_s() - begin_s < 5.0;)
    hand_.hold(profile_.period_s);
  if (wrong.empty() && port_.stopped()) wrong = "the stop stays in force after an operator has cleared it";
  report_.pass_unless(
      "stop", wrong, "held until it was cleared",
      "obey emergency_stop and emergency_stop/cleared, and write emergency_stop/state (PlantGate does it)");
}

void PlantConformance::check_epoch(std::size_t joint) {
  if (!port_.abilities().epochs) return report_.skip("epoch", "the process has sessions, not epochs");
  const std::uint32_t before = port_.epoch();
  port_.begin_epoch();
  for (const double begin_s = port_.now_s(); port_.epoch() == before && port_.now_s() - begin_s < 10.0;)
    hand_.watch(profile_.period_s);
  const auto samples = hand_.watch(0.5);
  if (port_.epoch() == before || samples.empty())
    return report_.fail("epoch", port_.epoch() == before ? "no new epoch begins" : "no joint states in the new epoch",
                        "construct the plant anew at each EpochStart");
  if (samples.back().number > 200)
    return report_.fail("epoch", fmt::format("number {} soon after the new epoch", samples.back().number),
                        "begin sequence numbers and state anew in each epoch");
  check_return(joint, "epoch", "obey commands of the new epoch");
}

}  // namespace constrictor::conform
