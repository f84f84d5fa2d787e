#include "cli/teleop_screen.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cli/task_names.hpp"

namespace constrictor::cli {
namespace {

constexpr std::size_t kColumns = 80;
constexpr std::size_t kRows = 24;
constexpr int kBar = 12;
constexpr double kFullBar_nm = 6.0;
constexpr double kSilent_s = 2.5;  // the run speaks once a second at least
constexpr std::size_t kJointRows = 8;  // three joints in each: 24 joints

/// Cut to the screen, without anything that is not a printable character.
std::string line(std::string text) {
  std::replace_if(text.begin(), text.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  if (text.size() > kColumns) text.resize(kColumns);
  return text;
}

std::string authority_line(const TeleopScreen& s) {
  if (!s.authority) return "authority  no word of `input` yet";
  const msg::Authority& a = *s.authority;
  std::string text = fmt::format("authority  {}", authority_name(a.level));
  if (*a.source) text += fmt::format(" {}{}", a.source, s.source == a.source ? " (you)" : "");
  return text + fmt::format("   refused {}", a.refused_count);
}

std::string time_line(const TeleopScreen& s) {
  std::string text = fmt::format("teleop  run {:.22}", s.run);
  if (s.view.run) text += fmt::format(" seed {}", s.view.run->seed);  // a reset changes it
  if (!s.view.run) return text + "  waiting for it";
  const msg::RunState& run = *s.view.run;
  text += fmt::format("  tick {}", run.tick);
  if (s.view.silent_s > kSilent_s) return text + fmt::format("  SILENT for {:.0f} s", s.view.silent_s);
  if (run.paused) return text + "  PAUSED";
  const std::string pace = run.realtime ? "real time" : run.pace > 0.0 ? fmt::format("at most {}x", run.pace) : "lock-step";
  if (std::isfinite(run.real_time_factor)) text += fmt::format("  {:.2f}x", run.real_time_factor);
  return text + fmt::format(" ({}{})", pace, run.operator_cap ? ", operator" : "");
}

std::string task_line(const TeleopScreen& s) {
  if (!s.view.task) return "task       -";
  const msg::TaskStatus& t = *s.view.task;
  return fmt::format("task       {} {} {}  {:3.0f} %{}  {}", task_word(t.task), goal_state_name(t.state), t.phase, 100.0 * t.progress,
                     t.carrying ? "  carrying" : "", t.reason);
}

std::string joint_cell(const msg::JointState& joints, std::size_t j) {
  const double torque_nm = joints.torque_nm[j];
  const int full = static_cast<int>(std::lround(std::clamp(std::abs(torque_nm) / kFullBar_nm, 0.0, 1.0) * kBar));
  return fmt::format("{:2} {:+5.2f}|{:<{}}|{:4.1f} ", j, joints.position_rad[j], std::string(static_cast<std::size_t>(full), '#'), kBar,
                     std::abs(torque_nm));
}

void joint_lines(const TeleopScreen& s, std::vector<std::string>& lines) {
  lines.push_back(fmt::format("joints     angle [rad], torque [Nm], a full bar is {:.0f} Nm", kFullBar_nm));
  for (std::size_t row = 0; row < kJointRows; ++row) {
    std::string text;
    for (std::size_t j = row; s.view.joints && j < std::min<std::size_t>(s.view.joints->joint_count, 3 * kJointRows); j += kJointRows) {
      text += joint_cell(*s.view.joints, j);
    }
    lines.push_back(text);
  }
}

std::string contact_line(const TeleopScreen& s) {
  std::string text = "touch      ";
  if (!s.view.contacts) return text + "-";
  for (std::size_t m = 0; m < std::min<std::size_t>(s.view.contacts->module_count, msg::kMaxModules); ++m) {
    const msg::Vector3& f = s.view.contacts->force_n[m];
    const double lateral_n = std::hypot(f.x, f.y);
    text += lateral_n < 0.5 ? '.' : lateral_n < 2.0 ? 'o' : lateral_n < 8.0 ? 'O' : '#';
  }
  return text + "  head to tail";
}

}  // namespace

std::vector<std::string> render(const TeleopScreen& s) {
  std::vector<std::string> lines;
  lines.push_back(time_line(s));
  lines.push_back(authority_line(s));
  lines.push_back(task_line(s));
  lines.push_back(s.view.mission ? fmt::format("mission    {} {} of {}  {}", s.view.mission->state, s.view.mission->object_index,
                                               s.view.mission->object_count, s.view.mission->reason)
                                 : "mission    no planner");
  lines.push_back(fmt::format("drive      {:+.1f} m/s  turn {:+.2f} rad/s   speed {:.1f} m/s   look {:+.2f} rad", s.drive.drive_m_s(),
                              s.drive.turn_rad_s(), s.drive.speed_m_s, s.drive.look_rad));
  joint_lines(s, lines);
  lines.push_back(contact_line(s));
  lines.emplace_back("events");
  for (const auto& event : s.view.events) lines.push_back(event);
  while (lines.size() < kRows - 5) lines.emplace_back();
  lines.push_back(s.prompt ? "" : s.notice);
  for (const char* help : kTeleopHelp) lines.emplace_back(help);
  lines.push_back(s.prompt ? "task> " + *s.prompt + "_" : "");
  for (auto& text : lines) text = line(text);
  lines.resize(kRows);
  return lines;
}

}  // namespace constrictor::cli
