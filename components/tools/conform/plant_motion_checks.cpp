// One joint after the other is moved by a small angle and back: does the right joint move, in the right direction, as
// far as commanded, soon?
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "configuration/counted.hpp"
#include "configuration/quantiles.hpp"
#include "conform/plant_conformance.hpp"
#include "conform/unit_factor.hpp"

namespace constrictor::conform {
namespace {

constexpr double kMovedShare = 0.3;  // of the amplitude: less is not a motion
constexpr double kWrongRate = 4.0;   // a rate that is larger by this factor has a wrong unit, even at one joint only

/// Names up to eight joints: "joints 0, 3, 4".
std::string names_of(const std::vector<std::size_t>& joints) {
  std::string text = joints.size() == 1 ? "joint " : "joints ";
  for (std::size_t i = 0; i < joints.size() && i < 8; ++i) text += fmt::format("{}{}", i ? ", " : "", joints[i]);
  return joints.size() > 8 ? text + fmt::format(" and {} more", joints.size() - 8) : text;
}

/// [s] when a value has passed half of its way, interpolated; empty if it never does.
template <class Value, class Time>
std::optional<double> half_way_s(const std::vector<Instant>& motion, double from, double to, Value value, Time time) {
  const double half = 0.5 * (from + to);
  for (std::size_t i = 1; i < motion.size(); ++i) {
    const double before = value(motion[i - 1]) - half, now = value(motion[i]) - half;
    if ((before < 0) == (now < 0)) continue;
    const double share = before / (before - now);
    return time(motion[i - 1]) + share * (time(motion[i]) - time(motion[i - 1]));
  }
  return {};
}

/// Integral of the measured rate by the way of the measured angle; empty if that way is shorter than `least_rad`. A
/// sample that comes much sooner or later than usual after the one before is left out: a driver that stood still for a
/// moment measures its rate over a duration that can differ from the time between the samples.
std::optional<double> velocity_ratio(const std::vector<Instant>& motion, std::size_t joint, double least_rad) {
  std::vector<const JointSample*> samples;
  for (const Instant& at : motion) {
    if (samples.empty() || at.sample.number != samples.back()->number) samples.push_back(&at.sample);
  }
  if (samples.size() < 3) return {};
  const auto duration_s = [&](std::size_t i) {
    return 1e-9 * static_cast<double>(samples[i]->time_ns - samples[i - 1]->time_ns);
  };
  std::vector<double> durations_s;
  for (std::size_t i = 1; i < samples.size(); ++i) durations_s.push_back(duration_s(i));
  const double usual_s = upper_median(durations_s);
  const auto usual = [&](std::size_t i) { return duration_s(i) > 0.5 * usual_s && duration_s(i) < 1.5 * usual_s; };
  double rate_rad = 0.0, way_rad = 0.0;
  for (std::size_t i = 2; i < samples.size(); ++i) {
    if (!usual(i - 1) || !usual(i)) continue;
    rate_rad += 0.5 * (samples[i]->velocity_rad_s[joint] + samples[i - 1]->velocity_rad_s[joint]) * duration_s(i);
    way_rad += samples[i]->position_rad[joint] - samples[i - 1]->position_rad[joint];
  }
  if (std::abs(way_rad) <= least_rad) return {};
  return rate_rad / way_rad;
}

/// [Nm] mean over the last samples of a motion, when the joint rests.
double last_torque_nm(const std::vector<Instant>& motion, std::size_t joint) {
  constexpr std::size_t kLast = 6;
  const std::size_t count = std::min(kLast, motion.size());
  double mean_nm = 0.0;
  for (std::size_t i = motion.size() - count; i < motion.size(); ++i)
    mean_nm += motion[i].sample.torque_nm[joint] / static_cast<double>(count);
  return mean_nm;
}

}  // namespace

struct PlantConformance::Moved {
  double ratio = 0.0;  ///< measured by commanded motion
  bool escaped = false;
  std::size_t other = 0;   ///< the joint that moved most, apart from the commanded one
  double other_rad = 0.0;  ///< how far
  std::optional<double> delay_s;
  std::optional<double> velocity_ratio;  ///< measured rate by the rate of the measured angle
  double torque_nm = 0.0;                ///< load at the goal minus load at the start, along the motion
};

PlantConformance::Moved PlantConformance::move_joint(std::size_t joint) {
  Moved moved;
  const double start_rad = hand_.setpoint_rad(joint), goal_rad = hand_.goal_rad(joint);
  const double way_rad = goal_rad - start_rad;
  const std::vector<double> before_rad = hand_.mean_rad(hand_.hold(5 * profile_.period_s));
  const std::vector<Instant> away = hand_.move(joint, goal_rad, &moved.escaped);
  if (moved.escaped) {
    // The motion of the joints until they were held: the largest step divided by the commanded one.
    const JointSample& last = away.back().sample;
    double most_rad = 0.0;
    for (std::size_t i = 0; i < before_rad.size() && i < last.position_rad.size(); ++i) {
      const double step_rad = last.position_rad[i] - before_rad[i];
      if (i == joint) moved.ratio = step_rad / way_rad;
      else if (std::abs(step_rad) > most_rad) {
        most_rad = std::abs(step_rad);
        moved.other = i;
      }
    }
    moved.other_rad = most_rad;
    const double commanded = std::max(std::abs(away.back().setpoint_rad - start_rad), 1e-6);
    if (std::abs(moved.ratio) > kMovedShare) moved.ratio *= std::max(1.0, std::abs(way_rad) / commanded);
    return moved;
  }
  const std::vector<double> after_rad = hand_.mean_rad(hand_.hold(5 * profile_.period_s));
  const std::vector<Instant> back = hand_.move(joint, start_rad, &moved.escaped);
  moved.ratio = (after_rad[joint] - before_rad[joint]) / way_rad;
  for (std::size_t i = 0; i < after_rad.size(); ++i) {
    const double step_rad = std::abs(after_rad[i] - before_rad[i]);
    if (i == joint || step_rad <= moved.other_rad) continue;
    moved.other_rad = step_rad;
    moved.other = i;
  }
  if (std::abs(moved.ratio) < kMovedShare) return moved;
  const auto angle = [joint](const Instant& at) { return at.sample.position_rad[joint]; };
  const auto commanded_s = half_way_s(
      away, start_rad, goal_rad, [](const Instant& at) { return at.setpoint_rad; },
      [](const Instant& at) { return at.time_s; });
  const auto measured_s = half_way_s(away, before_rad[joint], after_rad[joint], angle,
                                     [](const Instant& at) { return at.sample.arrival_s; });
  if (commanded_s && measured_s) moved.delay_s = *measured_s - *commanded_s;
  moved.velocity_ratio = velocity_ratio(away, joint, kMovedShare * std::abs(way_rad));
  // A bent joint carries a weight, or friction that it has overcome: both point along the way that it has moved.
  const double load_nm = last_torque_nm(away, joint) - last_torque_nm(back, joint);
  moved.torque_nm = std::copysign(load_nm, load_nm * way_rad * moved.ratio);
  return moved;
}

void PlantConformance::check_motions() {
  std::vector<std::size_t> still, negative, degrees, weak, late, rates;
  std::string order, gains, delays, velocities;
  std::vector<JointLoad> loads;
  double longest_s = 0.0, least = 1e9, most = -1e9;
  std::vector<double> velocity_ratios;
  for (const double number : profile_.joints) {
    const auto joint = static_cast<std::size_t>(number);
    const Moved moved = move_joint(joint);
    const double ratio = moved.ratio;
    const bool other = moved.other_rad > 0.5 * profile_.amplitude_rad && std::abs(ratio) < 0.6;
    least = std::min(least, ratio);
    most = std::max(most, ratio);
    if (std::abs(ratio) > kUnitFactor || (std::abs(ratio) > 0.5 / 57.3 && std::abs(ratio) < 2.0 / 57.3 && !other &&
                                          std::abs(ratio) * profile_.amplitude_rad > 0.0008)) {
      degrees.push_back(joint);
      continue;
    }
    if (other) {
      order +=
          fmt::format("{}joint {} moved when joint {} was commanded", order.empty() ? "" : "; ", moved.other, joint);
      continue;
    }
    if (std::abs(ratio) < kMovedShare) {
      still.push_back(joint);
      continue;
    }
    if (ratio < 0.0) {
      negative.push_back(joint);
      continue;
    }
    if (std::abs(ratio - 1.0) > profile_.gain_tolerance) {
      weak.push_back(joint);
      gains = fmt::format("; joint {} moved {:.2f} times as far as commanded", joint, ratio);
    }
    if (moved.delay_s) longest_s = std::max(longest_s, *moved.delay_s);
    if (moved.delay_s && *moved.delay_s > profile_.delay_s) late.push_back(joint);
    if (moved.velocity_ratio) velocity_ratios.push_back(*moved.velocity_ratio);
    if (moved.velocity_ratio && (*moved.velocity_ratio < 0.0 || *moved.velocity_ratio > kWrongRate)) {
      rates.push_back(joint);
      velocities =
          fmt::format("; that of joint {} is {:.2f} times the rate of its angle", joint, *moved.velocity_ratio);
    }
    loads.push_back({joint, moved.torque_nm});
  }
  const auto list = [](const std::vector<std::size_t>& joints, const std::string& more, const std::string& fine) {
    return joints.empty() ? fine : names_of(joints) + more;
  };
  const std::string moved_joints = counted(profile_.joints.size(), "joint") + " moved";
  report_.judge("moves", !still.empty(), list(still, " did not move", moved_joints),
                "check power, wiring, torque limit and the servo's number; a frozen measurement looks the same");
  // A joint that moves 57 times too far may still move when the next joint is commanded.
  if (!degrees.empty() && !order.empty()) report_.skip("order", "cannot be judged before the unit is right");
  else
    report_.pass_unless("order", order, "each joint by itself",
                        "correct the order of the joints, or of their servo numbers; joint 0 is next to the head");
  report_.judge("sign", !negative.empty(), list(negative, " moved the other way", "the right way"),
                "invert these joints' direction, for commands and measurements alike (yaw: positive is left, pitch: "
                "positive is nose down)");
  report_.judge("unit", !degrees.empty(), list(degrees, " moved by about 57 times too much or too little", "radians"),
                "convert: commands and measurements are in radians, not in degrees or steps");
  const std::string ratios = fmt::format("{:.2f} to {:.2f} times as far as commanded", least, most);
  report_.judge("gain", !weak.empty(), list(weak, gains, ratios),
                "check the steps of a turn and the gear ratio of these joints");
  report_.judge(
      "delay", !late.empty(),
      list(late, fmt::format(" followed {:.2f} s later", longest_s), fmt::format("{:.0f} ms at most", longest_s * 1e3)),
      "obey each command as it arrives, keep no queue of commands, and measure afresh for each sample");
  if (velocity_ratios.empty()) {
    report_.skip("velocity", "no joint moved as commanded");
  } else {
    // One short motion shows a rate only roughly, because samples are few; the median of the joints is better.
    const double middle = upper_median(velocity_ratios);
    report_.judge("velocity", !rates.empty() || std::abs(middle - 1.0) > profile_.velocity_share,
                  list(rates, velocities, fmt::format("{:.2f} times the rate of the angle, the median", middle)),
                  "velocity_rad_s must be the rate of position_rad: check its sign and unit");
  }
  judge_torque_sign(loads);
}

void PlantConformance::judge_torque_sign(const std::vector<JointLoad>& loads) {
  constexpr std::size_t kFewest = 3;
  std::vector<std::size_t> against;
  double sum_nm = 0.0, most_nm = 0.0;
  for (const auto& load : loads) {
    sum_nm += load.along_nm;
    most_nm = std::min(most_nm, load.along_nm);
    if (load.along_nm < -profile_.against_nm) against.push_back(load.joint);
  }
  // A wrong sign may concern only some joints: those whose servos turn the other way.
  if (!against.empty())
    return report_.judge(
        "torque_sign", true,
        fmt::format("that of {} points against the way, by up to {:.2f} Nm", names_of(against), -most_nm),
        "invert torque_nm of these joints: it is the servo's torque, with the sign of position_rad. If "
        "the sign is right, the torque is filtered for too long: filter it as the robot file says "
        "(torque_filter_s), and only once");
  if (loads.size() < kFewest)
    return report_.skip("torque_sign", fmt::format("{} joints are too few to show a sign", loads.size()));
  const auto count = static_cast<double>(loads.size());
  const double mean_nm = sum_nm / count;
  double squares = 0.0;
  for (const auto& load : loads) squares += (load.along_nm - mean_nm) * (load.along_nm - mean_nm);
  const double error_nm = std::sqrt(squares / (count - 1.0) / count);  // standard error of the mean
  const std::string found =
      fmt::format("{:.2f} Nm on average along the way, at most {:.2f} Nm against it", mean_nm, std::abs(most_nm));
  if (std::abs(mean_nm) < std::max(profile_.felt_nm, 2.0 * error_nm))
    return report_.skip("torque_sign", found + ": too little to show a sign");
  report_.judge("torque_sign", mean_nm < 0.0, found,
                "invert torque_nm: it is the servo's torque, with the sign of position_rad");
}

}  // namespace constrictor::conform
