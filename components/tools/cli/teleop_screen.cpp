#include "cli/teleop_screen.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "client/task_names.hpp"

namespace constrictor::cli {
namespace {

constexpr ScreenSize kLargest{240, 80};
constexpr std::size_t kUsualRows = 24;  // a terminal with more shows more joints, longer bars and more events
constexpr std::size_t kCell = 27;       // columns of a joint at least; a cell ends with a blank
constexpr std::size_t kBesideBar = 15;  // columns of a cell that are not its bar
constexpr std::size_t kLongestBar = 100;
constexpr std::size_t kUsualJoints = 24;
constexpr std::size_t kUsualEvents = 3;
constexpr const char* kShortHelp = "i/, j/l k drive  r release  q quit";  // where the whole help does not fit
constexpr std::size_t kLinesBelow = 3;       // notice, emergency stop, prompt: they are always there
constexpr std::size_t kLinesBeforeHelp = 4;  // time, authority, drive and task: more important than the help
constexpr double kFullBar_nm = 6.0;
constexpr double kSilent_s = 2.5;  // the conductor sends a RunState once a second at least

/// Lines that are shown together or not at all. If the screen is too small, blocks with the highest `rank` are left out
/// first.
struct Block {
  int rank;
  std::vector<std::string> lines;
};

/// The help in lines of at most `columns` characters. Two blanks separate its entries; lines break only there.
std::vector<std::string> help_lines(std::size_t columns) {
  std::vector<std::string> lines(1);
  for (const std::string_view text : {kTeleopHelp[0], kTeleopHelp[1]}) {
    for (std::size_t at = 0; at < text.size();) {
      const std::size_t end = std::min(text.find("  ", at), text.size());
      const std::string_view entry = text.substr(at, end - at);
      const bool fits = lines.back().empty() || lines.back().size() + 2 + entry.size() <= columns;
      if (!fits) lines.emplace_back();
      if (!lines.back().empty()) lines.back() += "  ";
      lines.back() += entry;
      at = end + 2;
    }
  }
  return lines;
}

std::vector<std::string> too_small(ScreenSize size) {
  std::vector<std::string> lines = {
      "SPACE emergency stop", "q quit", fmt::format("terminal too small: {}x{}", size.columns, size.rows),
      fmt::format("make it {}x{} or larger", kSmallestScreen.columns, kSmallestScreen.rows)};
  for (auto& text : lines) text = screen_line(text, size.columns);
  lines.resize(std::min(lines.size(), size.rows));
  return lines;
}

std::string authority_line(const TeleopScreen& s) {
  if (!s.authority) return "authority  waiting for `input`";
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
  const std::string pace = run.realtime     ? "real time"
                           : run.pace > 0.0 ? fmt::format("at most {}x", run.pace)
                                            : "lock-step";
  if (std::isfinite(run.real_time_factor)) text += fmt::format("  {:.2f}x", run.real_time_factor);
  return text + fmt::format(" ({}{})", pace, run.operator_pace ? ", operator" : "");
}

std::string task_line(const TeleopScreen& s) {
  if (!s.view.task) return "task       -";
  const msg::TaskStatus& t = *s.view.task;
  return fmt::format("task       {} {} {}  {:3.0f} %{}  {}", task_word(t.task), goal_state_name(t.goal_state), t.phase,
                     100.0 * t.progress, t.carrying ? "  carrying" : "", t.reason);
}

std::string joint_cell(const msg::JointState& joints, std::size_t j, std::size_t bar) {
  const double torque_nm = std::abs(joints.torque_nm[j]);
  const double full = std::clamp(torque_nm / kFullBar_nm, 0.0, 1.0) * static_cast<double>(bar);
  return fmt::format("{:2} {:+5.2f}|{:<{}}|{:4.1f} ", j, joints.position_rad[j],
                     std::string(static_cast<std::size_t>(std::lround(full)), '#'), bar, torque_nm);
}

/// The joints in as few columns as `rows` lines allow, so that their bars are long. A third of the lines is left for
/// earlier events.
std::vector<std::string> joint_lines(const TeleopScreen& s, ScreenSize size, std::size_t rows) {
  std::vector<std::string> lines = {
      fmt::format("joints     angle [rad], torque [Nm], a full bar is {:.0f} Nm", kFullBar_nm)};
  const std::size_t known = s.view.joints ? std::min<std::size_t>(s.view.joints->joint_count, msg::kMaxJoints) : 0;
  const bool large = size.rows > kUsualRows;
  const std::size_t most = large && known > 0 ? known : kUsualJoints;
  const std::size_t count = std::min(known, most);
  const std::size_t most_across = std::max<std::size_t>((size.columns + 1) / kCell, 1);
  const std::size_t usable = std::max<std::size_t>(rows * 2 / 3, 1);
  const std::size_t fitting = large ? (most + usable - 1) / usable : most_across;
  const std::size_t across = std::clamp<std::size_t>(fitting, 1, most_across);
  const std::size_t below = (most + across - 1) / across;
  const std::size_t bar = large ? std::min((size.columns + 1) / across - kBesideBar, kLongestBar) : kCell - kBesideBar;
  for (std::size_t row = 0; row < below; ++row) {
    std::string text;
    for (std::size_t j = row; j < count; j += below) text += joint_cell(*s.view.joints, j, bar);
    lines.push_back(text);
  }
  return lines;
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

std::string mission_line(const TeleopScreen& s) {
  if (!s.view.mission) return "mission    no planner";
  const msg::MissionStatus& m = *s.view.mission;
  return fmt::format("mission    {}, {} of {} delivered  {}", m.state, m.delivered_count, m.object_count, m.reason);
}

/// The newest events, at most `most`.
std::vector<std::string> event_lines(const TeleopScreen& s, std::size_t most) {
  std::vector<std::string> lines = {"events"};
  const std::size_t count = std::min(most, s.view.events.size());
  lines.insert(lines.end(), s.view.events.end() - static_cast<std::ptrdiff_t>(count), s.view.events.end());
  return lines;
}

std::size_t line_count(const std::vector<Block>& blocks) {
  std::size_t count = 0;
  for (const Block& block : blocks) count += block.lines.size();
  return count;
}

/// Keeps the blocks with the lowest ranks that have at most `rows` lines together, in their order on the screen.
void fit(std::vector<Block>& blocks, std::size_t rows) {
  std::vector<Block*> by_rank;
  for (Block& block : blocks) by_rank.push_back(&block);
  std::stable_sort(by_rank.begin(), by_rank.end(), [](const Block* a, const Block* b) { return a->rank < b->rank; });
  for (Block* block : by_rank) {
    if (block->lines.size() > rows) block->lines.clear();
    rows -= block->lines.size();
  }
}

}  // namespace

std::vector<std::string> render(const TeleopScreen& s, ScreenSize size) {
  if (size.columns < kSmallestScreen.columns || size.rows < kSmallestScreen.rows) return too_small(size);
  size = {std::min(size.columns, kLargest.columns), std::min(size.rows, kLargest.rows)};
  const std::string drive =
      fmt::format("drive      {:+.1f} m/s  turn {:+.2f} rad/s   speed {:.1f} m/s   look {:+.2f} rad",
                  s.drive.drive_m_s(), s.drive.turn_rad_s(), s.drive.speed_m_s, s.drive.look_rad);
  std::vector<Block> above = {{0, {time_line(s)}},
                              {0, {authority_line(s)}},
                              {2, {task_line(s)}},
                              {5, {mission_line(s)}},
                              {1, {drive}},
                              {7, {}},  // the joints
                              {6, {contact_line(s)}},
                              {4, event_lines(s, kUsualEvents)},
                              {3, help_lines(size.columns)}};
  Block& joints = above[5];
  Block& events = above[7];
  Block& help = above[8];
  if (help.lines.size() + kLinesBeforeHelp + kLinesBelow > size.rows) help.lines = {kShortHelp};
  joints.lines = joint_lines(s, size, size.rows - std::min(size.rows, line_count(above) + kLinesBelow + 1));
  fit(above, size.rows - kLinesBelow);
  const std::size_t used = line_count(above) + kLinesBelow;
  // The rows that are left show earlier events.
  if (!events.lines.empty() && used < size.rows) events.lines = event_lines(s, kUsualEvents + size.rows - used);
  const std::vector<std::string> keys = std::move(help.lines);
  above.pop_back();

  std::vector<std::string> lines;
  for (const Block& block : above) lines.insert(lines.end(), block.lines.begin(), block.lines.end());
  while (lines.size() + keys.size() + kLinesBelow < size.rows) lines.emplace_back();
  lines.push_back(s.prompt ? "" : s.notice);
  lines.insert(lines.end(), keys.begin(), keys.end());
  // In the prompt the space bar is a blank between words.
  lines.push_back(s.prompt ? "Esc SPACE emergency stop  Enter start" : kTeleopHelp[2]);
  lines.push_back(s.prompt ? "task> " + *s.prompt + "_" : "");
  for (auto& text : lines) text = screen_line(text, size.columns);
  return lines;
}

}  // namespace constrictor::cli
