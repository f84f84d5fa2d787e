// Commands that demand torques: one joint after the other is pushed by a torque that rises slowly, until it turns.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "conform/plant_conformance.hpp"

namespace constrictor::conform {
namespace {

constexpr double kRise_s = 1.0;       // in which the torque rises to its largest value
constexpr double kTurnedShare = 0.5;  // of the amplitude: further, and the push ends; a fifth of it is not a motion
constexpr double kNoneShare = 0.1;
constexpr double kAfterHold_s = 0.5;  // so long a measured torque may contain that of a hold: drivers filter it
constexpr double kStillShare =
    0.15;  // of the other joint's angle: less, and the pushed joint is not the one that turns

}  // namespace

PlantConformance::Pushed PlantConformance::push_joint(std::size_t joint, double limit_nm) {
  Pushed pushed;
  const std::vector<double> start_rad = hand_.mean_rad(hand_.hold(5 * profile_.period_s));
  const double way = std::copysign(1.0, hand_.goal_rad(joint) - hand_.setpoint_rad(joint));
  PlantCommand command = hand_.command();
  command.torque = true;
  command.torque_limit_nm[joint] = limit_nm;
  double held_s = -kAfterHold_s;
  const auto periods = std::max(1L, std::lround(kRise_s / profile_.period_s));
  for (long i = 1; i <= periods; ++i) {
    command.torque_nm[joint] = way * profile_.push_nm * static_cast<double>(i) / static_cast<double>(periods);
    for (const JointSample& sample : hand_.send({command}, profile_.period_s)) {
      if (sample.position_rad.size() != start_rad.size()) continue;
      // A plant that holds, because this computer sent too late, exerts what holding needs.
      if (sample.holding) held_s = sample.arrival_s;
      if (sample.arrival_s - held_s > kAfterHold_s)
        pushed.largest_nm = std::max(pushed.largest_nm, std::abs(sample.torque_nm[joint]));
      pushed.turned_rad = way * (sample.position_rad[joint] - start_rad[joint]);
      pushed.other_rad = 0.0;
      for (std::size_t k = 0; k < start_rad.size(); ++k) {
        const double moved_rad = std::abs(sample.position_rad[k] - start_rad[k]);
        if (k == joint || moved_rad <= pushed.other_rad) continue;
        pushed.other_rad = moved_rad;
        pushed.other = k;
      }
    }
    pushed.demanded_nm = std::abs(command.torque_nm[joint]);
    if (std::max(std::abs(pushed.turned_rad), pushed.other_rad) > kTurnedShare * profile_.amplitude_rad) break;
  }
  hand_.begin_at_posture();
  hand_.hold(profile_.settle_s);
  hand_.return_to(start_rad);
  return pushed;
}

void PlantConformance::check_torque_mode() {
  const auto all = {"torque_turns", "torque_order", "torque_bound", "torque_silence"};
  if (!profile_.torque_mode)
    return skip_all(all, "the profile says that the plant exerts no torques on command (torque.mode)");
  std::string turns, order;
  double least_nm = 1e9, most_nm = 0.0;
  for (const double number : profile_.joints) {
    const auto joint = static_cast<std::size_t>(number);
    const Pushed pushed = push_joint(joint, robot_.joints[joint].max_torque_nm * profile_.torque_share);
    least_nm = std::min(least_nm, pushed.demanded_nm);
    most_nm = std::max(most_nm, pushed.demanded_nm);
    const double none_rad = kNoneShare * profile_.amplitude_rad;
    // The free end of the body may turn further than the joint that pushes it, but then both turn.
    if (pushed.other_rad > none_rad && std::abs(pushed.turned_rad) < kStillShare * pushed.other_rad)
      order +=
          fmt::format("{}joint {} turned when joint {} was pushed", order.empty() ? "" : "; ", pushed.other, joint);
    else if (pushed.turned_rad < -none_rad)
      turns += fmt::format("{}joint {} turned against its torque", turns.empty() ? "" : "; ", joint);
    else if (pushed.turned_rad < none_rad)
      turns +=
          fmt::format("{}joint {} did not turn with {:.2f} Nm", turns.empty() ? "" : "; ", joint, pushed.demanded_nm);
  }
  report_.pass_unless(
      "torque_turns", turns, fmt::format("with {:.2f} to {:.2f} Nm", least_nm, most_nm),
      "exert torque_nm in the mode torque, with the sign of position_rad; if the joints need more torque, "
      "raise torque.push_nm of the profile; a plant that exerts no torques on command: torque.mode: false");
  report_.pass_unless("torque_order", order, "each joint by itself",
                      "correct the order of the joints in torque_nm; joint 0 is next to the head");
  const auto joint = static_cast<std::size_t>(profile_.joints.front());
  const double limit_nm = 0.25 * profile_.push_nm;
  const double found_nm = push_joint(joint, limit_nm).largest_nm;
  report_.judge("torque_bound", found_nm > limit_nm + profile_.torque_nm,
                fmt::format("{:.2f} Nm with a limit of {:.2f} Nm", found_nm, limit_nm),
                "limit torque_nm to torque_limit_nm of the same command");
  check_torque_silence(joint);
}

void PlantConformance::check_torque_silence(std::size_t joint) {
  const std::vector<double> start_rad = hand_.mean_rad(hand_.hold(5 * profile_.period_s));
  PlantCommand command = hand_.command();
  command.torque = true;
  command.torque_nm[joint] = std::copysign(profile_.push_nm, hand_.goal_rad(joint) - hand_.setpoint_rad(joint));
  // The commands end while the joint turns.
  const auto periods = std::max(1L, std::lround(0.5 / profile_.period_s));
  for (long i = 0; i < periods; ++i) {
    hand_.send({command}, profile_.period_s);
    const double turned_rad = std::abs(hand_.newest()->position_rad[joint] - start_rad[joint]);
    if (turned_rad > kTurnedShare * profile_.amplitude_rad) break;
  }
  hand_.watch(profile_.stop_within_s);
  const std::vector<double> rest_rad = hand_.mean_rad(hand_.watch(5 * profile_.period_s));
  double moved_rad = 0.0;
  for (const auto& sample : hand_.watch(0.3)) {
    for (std::size_t i = 0; i < rest_rad.size() && i < sample.position_rad.size(); ++i)
      moved_rad = std::max(moved_rad, std::abs(sample.position_rad[i] - rest_rad[i]));
  }
  hand_.begin_at_posture();
  hand_.hold(profile_.settle_s);
  hand_.return_to(start_rad);
  report_.judge("torque_silence", moved_rad > profile_.rest_rad,
                fmt::format("{:.3f} rad at most after the last command", moved_rad),
                "end the torques 0.1 s after the last command, and hold the measured posture");
}

}  // namespace constrictor::conform
