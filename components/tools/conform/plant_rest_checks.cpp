// Checks of a plant while its joints rest.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "configuration/counted.hpp"

#include "conform/plant_conformance.hpp"

namespace constrictor::conform {
namespace {

constexpr double kWatch_s = 1.5;
constexpr double kBeyond_rad = 0.1;      // a measured angle may be beyond its limit by this much
constexpr double kStampTolerance = 0.2;  // share by which the clock of the stamps may differ

}  // namespace

std::vector<Check> plant_checks() {
  const auto one = [](const char* name, const char* expected) { return Check{name, expected, {}, {}, {}}; };
  return {
      one("arrives", "joint states arrive, also before the first command"),
      one("joint_count", "as many joints as the robot has"),
      one("finite", "angles, rates and torques are finite numbers"),
      one("range", "angles within the limits of the joints, in radians"),
      one("fault", "the plant reports no fault"),
      one("numbers", "one session, not 0, whose numbers rise by one"),
      one("stamps", "each stamp is the instant of the measurement, in nanoseconds, rising"),
      one("rate", "a sample in each control period, without gaps"),
      one("confirms", "the newest command is confirmed at once"),
      one("rests", "the joints rest while their setpoints rest"),
      one("imu", "a unit quaternion; at rest 9.81 m/s2 upwards and no rotation"),
      one("contacts", "one entry for each module, or none"),
      one("moves", "each joint moves when its setpoint moves"),
      one("order", "the joint that is commanded moves, and no other"),
      one("sign", "a larger setpoint makes the measured angle larger"),
      one("unit", "commands and measurements are in radians"),
      one("gain", "a joint moves as far as its setpoint"),
      one("delay", "a joint follows its setpoint soon"),
      one("velocity", "the measured rate is the rate of the measured angle"),
      one("torque_sign", "the torque of each joint that is bent points along its way: it carries weight, or friction"),
      one("limit", "a command beyond a joint's limits is ignored as a whole"),
      one("too_few", "a command for too few joints is ignored as a whole"),
      one("too_many", "a command for too many joints is ignored as a whole"),
      one("not_finite", "a command with a value that is not finite is ignored as a whole"),
      one("unknown_mode", "a command with an unknown mode is ignored as a whole"),
      one("old_command", "a command whose number does not rise is ignored"),
      one("stranger", "a command of a second session is ignored while the first one is alive"),
      one("torque_limit", "the torque stays within the limit of the command"),
      one("torque_turns", "in the mode torque each joint turns as its torque pushes it"),
      one("torque_order", "the joint whose torque is demanded turns, and no other in its place"),
      one("torque_bound", "a demanded torque stays within the limit of the command"),
      one("torque_silence", "torques end with the commands, and the posture is held"),
      one("silence", "without commands the joints come to rest, and the plant says that it holds"),
      one("returns", "commands are obeyed again after a silence"),
      one("new_session", "a new session, whose numbers begin at 1, is obeyed after a silence"),
      one("relaxed", "relaxed joints have no torque"),
      one("stop", "an emergency stop holds the posture until it is cleared"),
      one("epoch", "a new epoch begins with its own numbers, and is obeyed"),
      one("restart", "a process that was killed and started again reports its posture, moves nothing, and is obeyed")};
}

void PlantConformance::skip_all(const std::vector<const char*>& names, const std::string& reason) {
  for (const char* name : names) {
    if (report_.check(name).verdict == Verdict::kNotChecked) report_.skip(name, reason);
  }
}

bool PlantConformance::check_arrival() {
  const double begin_s = port_.now_s();
  while (!hand_.newest() && port_.now_s() - begin_s < profile_.patience_s) hand_.watch(profile_.period_s);
  report_.judge("arrives", !hand_.newest(),
                hand_.newest() ? fmt::format("the first after {:.2f} s", port_.now_s() - begin_s)
                               : fmt::format("none within {:.0f} s", profile_.patience_s),
                "start the plant in this DDS domain; `constrictor topic list` shows who writes, and as which type");
  return hand_.newest().has_value();
}

bool PlantConformance::check_samples(const std::vector<JointSample>& samples) {
  const std::size_t count = robot_.joints.size();
  std::size_t wrong_count = count;
  std::string not_finite, beyond, fault;
  for (const auto& sample : samples) {
    if (sample.position_rad.size() != count) {
      wrong_count = sample.position_rad.size();
      continue;
    }
    for (std::size_t i = 0; i < count; ++i) {
      if (!std::isfinite(sample.position_rad[i]) || !std::isfinite(sample.velocity_rad_s[i]) ||
          !std::isfinite(sample.torque_nm[i]))
        not_finite = fmt::format("joint {} is not finite", i);
      const auto& joint = robot_.joints[i];
      const double angle_rad = sample.position_rad[i];
      if (angle_rad < joint.min_rad - kBeyond_rad || angle_rad > joint.max_rad + kBeyond_rad)
        beyond = fmt::format("joint {} at {:.3f} rad, its limits are {:.3f} to {:.3f} rad", i, angle_rad, joint.min_rad,
                             joint.max_rad);
    }
    if (!sample.fault.empty()) fault = sample.fault;
  }
  report_.judge("joint_count", wrong_count != count || samples.empty(), counted(wrong_count, "joint"),
                fmt::format("write {} joints, or name the right robot file (--robot)", count));
  report_.pass_unless("finite", not_finite, "all values are finite",
                      "report `fault` instead of writing NaN when a joint cannot be measured");
  report_.pass_unless("range", beyond, "all angles are within their limits",
                      "check unit (radians), zero and sign of this joint");
  report_.pass_unless("fault", fault, "none", "repair what the plant reports");
  return !report_.failed("joint_count") && !report_.failed("finite") && !report_.failed("range") &&
         !report_.failed("fault");
}

void PlantConformance::check_stamps(const std::vector<JointSample>& samples) {
  std::string numbers, stamps;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (samples[i].session == 0) numbers = "session 0";
    if (i == 0) continue;
    const auto &before = samples[i - 1], &now = samples[i];
    if (now.session != before.session) numbers = fmt::format("sessions {:x} and {:x}", before.session, now.session);
    else if (now.number <= before.number) numbers = fmt::format("number {} after {}", now.number, before.number);
    if (now.time_ns <= before.time_ns) stamps = fmt::format("{} ns after {} ns", now.time_ns, before.time_ns);
  }
  if (samples.size() > 2 && stamps.empty()) {
    const double stamped_s = 1e-9 * static_cast<double>(samples.back().time_ns - samples.front().time_ns);
    const double passed_s = samples.back().arrival_s - samples.front().arrival_s;
    const double share = stamped_s / passed_s;
    if (std::abs(share - 1.0) > kStampTolerance)
      stamps = fmt::format("{:.4g} s by the stamps while {:.2f} s passed", stamped_s, passed_s);
  }
  const auto lost = samples.empty() ? 0 : samples.back().number - samples.front().number + 1 - samples.size();
  report_.pass_unless("numbers", numbers, fmt::format("rising, {} lost", lost),
                      "draw one random session when the process starts, and count its samples from 1");
  report_.pass_unless("stamps", stamps, "rising as time passes",
                      "write the instant of each measurement, in nanoseconds of a clock that is never set");
}

void PlantConformance::check_rate(const std::vector<JointSample>& samples) {
  double longest_s = 0.0;
  for (std::size_t i = 1; i < samples.size(); ++i)
    longest_s = std::max(longest_s, samples[i].arrival_s - samples[i - 1].arrival_s);
  const double share = static_cast<double>(samples.size()) * profile_.period_s / kWatch_s;
  report_.judge("rate", share < profile_.rate_share || longest_s > profile_.longest_gap_s,
                fmt::format("{:.1f} samples a second, the longest gap {:.0f} ms",
                            static_cast<double>(samples.size()) / kWatch_s, longest_s * 1e3),
                fmt::format("write at least {:.0f} samples a second, evenly", 1.0 / profile_.period_s));
}

void PlantConformance::check_rest(const std::vector<JointSample>& samples) {
  const double strayed = strayed_rad(samples);
  report_.judge("rests", strayed > profile_.rest_rad, fmt::format("{:.4f} rad at most", strayed),
                "the joints must hold the setpoint; check the servo's gains, and what else commands them");
}

void PlantConformance::check_confirmation(const std::vector<JointSample>& samples) {
  if (!port_.abilities().sessions) return report_.skip("confirms", "a member confirms by its ticks");
  const auto bound = static_cast<std::uint64_t>(std::ceil(profile_.delay_s / profile_.period_s));
  const auto& newest = samples.back();
  const bool right = newest.confirmed_session == port_.session();
  const std::uint64_t behind = port_.number() - std::min(port_.number(), newest.confirmed_number);
  report_.judge(
      "confirms", !right || behind > bound,
      right ? counted(behind, "command") + " behind"
            : fmt::format("session {:x}, that of the commands is {:x}", newest.confirmed_session, port_.session()),
      "copy session and sequence_number of the newest obeyed command into command_session and "
      "command_number");
}

void PlantConformance::check_imu() {
  if (hand_.imus().empty()) return report_.skip("imu", "none arrived: the robot has no inertial unit");
  std::string wrong;
  std::array<double, 3> up{};
  double rate_rad_s = 0.0;
  for (const auto& imu : hand_.imus()) {
    const auto& [w, x, y, z] = imu.orientation;
    const double length = std::sqrt(w * w + x * x + y * y + z * z);
    if (!(std::abs(length - 1.0) < 0.01)) wrong = fmt::format("a quaternion of length {:.3f}", length);
    const auto& a = imu.acceleration_m_s2;
    // The head's acceleration in the level frame: a + 2 w (v x a) + 2 v x (v x a).
    const std::array<double, 3> t = {2 * (y * a[2] - z * a[1]), 2 * (z * a[0] - x * a[2]), 2 * (x * a[1] - y * a[0])};
    const std::array<double, 3> level = {a[0] + w * t[0] + y * t[2] - z * t[1], a[1] + w * t[1] + z * t[0] - x * t[2],
                                         a[2] + w * t[2] + x * t[1] - y * t[0]};
    const auto share = 1.0 / static_cast<double>(hand_.imus().size());
    for (std::size_t i = 0; i < 3; ++i) up[i] += level[i] * share;
    for (const double rate : imu.rate_rad_s) rate_rad_s += std::abs(rate) * share / 3.0;
  }
  const double error = std::hypot(up[0], up[1], up[2] - 9.81);
  if (wrong.empty() && !(error < profile_.gravity_m_s2))
    wrong = fmt::format("({:.2f}, {:.2f}, {:.2f}) m/s2 in the level frame", up[0], up[1], up[2]);
  if (wrong.empty() && !(rate_rad_s < 0.2)) wrong = fmt::format("{:.2f} rad/s on average at rest", rate_rad_s);
  report_.pass_unless(
      "imu", wrong, fmt::format("{:.2f} m/s2 upwards", up[2]),
      "check axes (x forward, y left, z up), units (m/s2, rad/s) and sign: at rest the unit shows +9.81 "
      "upwards");
}

void PlantConformance::check_contacts() {
  if (hand_.contacts().empty()) return report_.skip("contacts", "none arrived: the robot has no contact sensors");
  std::string wrong;
  const int modules = static_cast<int>(robot_.joints.size()) + 1;
  for (const auto& one : hand_.contacts()) {
    if (one.module_count != 0 && one.module_count != modules) wrong = counted(one.module_count, "module");
    if (!one.finite) wrong = "a force that is not finite";
  }
  report_.pass_unless("contacts", wrong, counted(hand_.contacts().back().module_count, "module"),
                      fmt::format("write {} modules, or 0 if the sensors do not answer", modules));
}

double PlantConformance::strayed_rad(const std::vector<JointSample>& samples) const {
  double most_rad = 0.0;
  const std::vector<double> goal_rad = hand_.command().position_rad;
  for (const auto& sample : samples) {
    if (sample.position_rad.size() != goal_rad.size()) continue;
    for (std::size_t i = 0; i < goal_rad.size(); ++i) {
      const double error_rad = std::abs(sample.position_rad[i] - goal_rad[i]);
      most_rad = error_rad > most_rad || std::isnan(error_rad) ? error_rad : most_rad;
    }
  }
  return most_rad;
}

void PlantConformance::run() {
  const auto skip_rest = [this](const std::string& reason) {
    for (const auto& one : plant_checks()) skip_all({one.name.c_str()}, reason);
  };
  if (!check_arrival()) return skip_rest("no joint states arrive");
  // No command before the measurements are known to be right.
  if (!check_samples(hand_.watch(0.5))) return skip_rest("nothing is commanded while the measurements are wrong");
  hand_.begin_at_posture();
  hand_.hold(0.5);
  hand_.begin_at_posture();
  const std::vector<JointSample> samples = hand_.hold(kWatch_s);
  if (samples.empty()) throw PlantGone("joint states have ended");
  check_stamps(samples);
  check_rate(samples);
  check_confirmation(samples);
  check_rest(samples);
  check_imu();
  check_contacts();
  check_motions();
  for (const char* name : {"order", "sign", "unit", "moves"}) {
    if (report_.failed(name)) return skip_rest(fmt::format("needs joints that move as commanded (see {})", name));
  }
  check_commands();
}

}  // namespace constrictor::conform
