// The parts of the terminal client that are pure functions: keys, driving, and the screen at every size.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "cli/task_command.hpp"
#include "cli/task_request.hpp"
#include "cli/teleop_keys.hpp"
#include "cli/teleop_screen.hpp"
#include "cli/usage.hpp"
#include "client/task_names.hpp"
#include "robot/drive_gait.hpp"

namespace constrictor::cli {
namespace {

using namespace std::chrono_literals;

/// The actions for the bytes `typed` when they arrive in pieces of `piece` bytes.
std::vector<TeleopAction> actions(const std::string& typed, std::size_t piece) {
  KeyReader keys;
  std::vector<TeleopAction> list;
  for (std::size_t at = 0; at < typed.size(); at += piece) {
    keys.add(std::string_view(typed).substr(at, piece));
    for (std::string key = keys.next(); !key.empty(); key = keys.next()) list.push_back(action_of(key));
  }
  return list;
}

TEST(TeleopKeys, ReadsArrowsAndLettersInPiecesOfAnySize) {
  const std::vector<TeleopAction> expected = {
      TeleopAction::kForward, TeleopAction::kForward,       TeleopAction::kLeft, TeleopAction::kRight,
      TeleopAction::kStand,   TeleopAction::kEmergencyStop, TeleopAction::kQuit};
  for (std::size_t piece = 1; piece <= 16; ++piece)
    EXPECT_EQ(actions("i\033[A\033[1;5D\033OCk q", piece), expected) << piece;
}

TEST(TeleopKeys, ReadsEveryArrowOfABurst) {
  std::string burst;
  for (int i = 0; i < 30; ++i) burst += "\033[A";
  EXPECT_EQ(actions(burst, 64), std::vector<TeleopAction>(30, TeleopAction::kForward));
}

TEST(TeleopKeys, TheEscapeKeyDoesNothingAndTheNextKeyStillCounts) {
  KeyReader keys;
  keys.add("\033");
  EXPECT_EQ(keys.next(), "") << "the rest of an arrow key's sequence may follow";
  EXPECT_EQ(keys.next(/*quiet=*/true), "\033");
  EXPECT_EQ(action_of("\033"), TeleopAction::kNone);
  EXPECT_EQ(actions("\033 ", 2), (std::vector{TeleopAction::kNone, TeleopAction::kEmergencyStop}));
  EXPECT_EQ(actions("\033[ ", 1), (std::vector{TeleopAction::kNone, TeleopAction::kEmergencyStop}))
      << "the space after a broken sequence must still stop the robot";
  EXPECT_EQ(actions("\033[1;\003", 1), (std::vector{TeleopAction::kNone, TeleopAction::kQuit}));
}

TEST(TeleopKeys, ReadsArbitraryBytesToTheEnd) {
  std::string bytes;
  for (int i = 1; i < 256; ++i) bytes += static_cast<char>(i);
  bytes += std::string("\033[") + std::string(100, '1');
  KeyReader keys;
  keys.add(bytes);
  std::size_t taken = 0;
  int steps = 0;
  for (std::string key = keys.next(true); !key.empty() && ++steps < 1000; key = keys.next(true)) {
    taken += key.size();
    action_of(key);
  }
  EXPECT_EQ(taken, bytes.size());
}

struct HelpedKey {
  std::string key;
  TeleopAction action;
};

// The entries of the help exactly as it shows them, and the actions of their keys.
const std::map<std::string, std::vector<HelpedKey>> kHelped = {
    {"i/, forward/back", {{"i", TeleopAction::kForward}, {",", TeleopAction::kBack}}},
    {"j/l turn", {{"j", TeleopAction::kLeft}, {"l", TeleopAction::kRight}}},
    {"u/o rotate", {{"u", TeleopAction::kRotateLeft}, {"o", TeleopAction::kRotateRight}}},
    {"k stand", {{"k", TeleopAction::kStand}}},
    {"+/- speed", {{"+", TeleopAction::kFaster}, {"-", TeleopAction::kSlower}}},
    {"f/g/h look", {{"f", TeleopAction::kLookLeft}, {"g", TeleopAction::kLookAhead}, {"h", TeleopAction::kLookRight}}},
    {"w/e wrap", {{"w", TeleopAction::kWrapLeft}, {"e", TeleopAction::kWrapRight}}},
    {"s squeeze", {{"s", TeleopAction::kSqueeze}}},
    {"d open", {{"d", TeleopAction::kOpen}}},
    {"t task", {{"t", TeleopAction::kTask}}},
    {"x cancel task", {{"x", TeleopAction::kCancel}}},
    {"r release authority", {{"r", TeleopAction::kRelease}}},
    {"q quit", {{"q", TeleopAction::kQuit}}},
    {"SPACE emergency stop", {{" ", TeleopAction::kEmergencyStop}}},
    {"c clear it", {{"c", TeleopAction::kClearStop}}},
};

/// The entries of the help. Two blanks separate them.
std::vector<std::string> help_entries() {
  std::vector<std::string> entries;
  for (const std::string line : kTeleopHelp) {
    for (std::size_t at = 0; at < line.size();) {
      const std::size_t end = std::min(line.find("  ", at), line.size());
      entries.push_back(line.substr(at, end - at));
      at = end + 2;
    }
  }
  return entries;
}

/// The keys that an entry begins with: "f/g/h" are three keys, "SPACE" is one.
std::vector<std::string> keys_of(const std::string& entry) {
  const std::string word = entry.substr(0, entry.find(' '));
  if (word == "SPACE") return {" "};
  std::vector<std::string> keys;
  for (std::size_t at = 0; at < word.size(); at += 2) keys.push_back(word.substr(at, 1));
  return keys;
}

TEST(TeleopKeys, EachKeyHasTheActionThatTheHelpNames) {
  std::set<std::string> named;
  for (const std::string& entry : help_entries()) {
    SCOPED_TRACE(entry);
    const auto helped = kHelped.find(entry);
    ASSERT_NE(helped, kHelped.end()) << "add this entry of the help to kHelped";
    const std::vector<std::string> keys = keys_of(entry);
    ASSERT_EQ(keys.size(), helped->second.size());
    for (std::size_t i = 0; i < keys.size(); ++i) {
      EXPECT_EQ(keys[i], helped->second[i].key);
      EXPECT_NE(action_of(keys[i]), TeleopAction::kNone) << keys[i] << " does nothing";
      EXPECT_EQ(action_of(keys[i]), helped->second[i].action) << keys[i];
      EXPECT_EQ(actions(keys[i], 1), std::vector{helped->second[i].action}) << "when the key is typed";
      EXPECT_TRUE(named.insert(keys[i]).second) << keys[i] << " is in the help twice";
    }
  }
  EXPECT_EQ(help_entries().size(), kHelped.size()) << "the help lacks an entry of kHelped";
  // The reverse: each key with an action is in the help, or is an alternative to one that is.
  for (int c = 1; c < 256; ++c) {
    const std::string key(1, static_cast<char>(c));
    if (action_of(key) == TeleopAction::kNone || named.contains(key)) continue;
    EXPECT_TRUE(key == "=" || key == "\003") << "key " << c << " is not in the help";
  }
}

TEST(TeleopDrive, TurnKeysAlsoDriveButRotateKeysTurnOnTheSpot) {
  TeleopDrive drive;
  EXPECT_TRUE(drive.apply(TeleopAction::kLeft));
  EXPECT_GT(drive.drive_m_s(), 0.0);
  EXPECT_GT(drive.turn_rad_s(), 0.0);
  EXPECT_TRUE(drive.apply(TeleopAction::kRotateRight));
  EXPECT_EQ(drive.drive_m_s(), 0.0);
  EXPECT_LT(drive.turn_rad_s(), 0.0);
  EXPECT_TRUE(drive.apply(TeleopAction::kStand));
  EXPECT_EQ(drive.turn_rad_s(), 0.0);
  for (int i = 0; i < 30; ++i) drive.apply(TeleopAction::kFaster);
  EXPECT_LE(drive.speed_m_s, 0.9 + 1e-9);
  for (int i = 0; i < 30; ++i) drive.apply(TeleopAction::kSlower);
  EXPECT_GE(drive.speed_m_s, 0.1 - 1e-9);
}

TEST(DriveGait, HasTheSignsOfSpeedAndTurnAndStaysWithinTheRangesOfTheMessage) {
  EXPECT_GT(drive_gait(0.3, 0.0).frequency_hz, 0.0);
  EXPECT_LT(drive_gait(-0.3, 0.0).frequency_hz, 0.0);
  EXPECT_GT(drive_gait(0.3, 0.2).curvature_1_m, 0.0);
  EXPECT_LT(drive_gait(0.0, -0.5).curvature_1_m, -2.0);
  EXPECT_EQ(drive_gait(0.0, 0.0).frequency_hz, 0.0);
  for (const double v : {-1e9, -1.0, 0.0, 0.01, 5.0, std::numeric_limits<double>::infinity(), std::nan("")}) {
    for (const double w : {-1e9, 0.0, 1e-6, 3.0, std::nan("")}) {
      const DriveGait gait = drive_gait(v, w);
      EXPECT_LE(std::abs(gait.frequency_hz), 2.0) << v << " " << w;
      EXPECT_LE(std::abs(gait.curvature_1_m), 5.0) << v << " " << w;
    }
  }
}

TeleopScreen full_screen() {
  TeleopScreen s;
  s.run = "7 case_study_of_a_long_name";
  s.source = "teleop.host.1";
  s.authority = msg::Authority{};
  std::snprintf(s.authority->source, sizeof s.authority->source, "%s", s.source.c_str());
  s.authority->level = msg::kAuthorityOperator;
  s.view.run = msg::RunState{};
  s.view.run->tick = 1234567;
  s.view.run->seed = 7;
  s.view.run->real_time_factor = 0.987;
  s.view.run->pace = 1.0;
  s.view.run->operator_pace = true;
  s.view.task = msg::TaskStatus{};
  std::snprintf(s.view.task->reason, sizeof s.view.task->reason, "%s", std::string(126, 'r').c_str());
  s.view.mission = msg::MissionStatus{};
  s.view.joints = msg::JointState{};
  s.view.joints->joint_count = 64;
  for (double& torque : s.view.joints->torque_nm) torque = -1e6;
  s.view.contacts = msg::ContactState{};
  s.view.contacts->module_count = 64;
  for (int i = 0; i < 3; ++i) s.view.events.emplace_back(200, 'e');
  s.notice = "tab\tand escape \033[2J and umlaut \xc3\xa4";
  return s;
}

TEST(TeleopScreen, FitsATerminalOf80x24WithAnyContent) {
  for (const TeleopScreen& s : {TeleopScreen{}, full_screen()}) {
    const auto lines = render(s);
    EXPECT_EQ(lines.size(), 24u);
    for (const auto& line : lines) {
      EXPECT_LE(line.size(), 80u);
      for (const char c : line) EXPECT_TRUE(c >= ' ' && c <= '~');
    }
    EXPECT_NE(lines[22].find("SPACE emergency stop"), std::string::npos)
        << "the most important key must always be visible";
  }
}

// The key of the emergency stop must always be visible: at every size of the terminal, and while the user types a task.
TEST(TeleopScreen, ShowsTheEmergencyStopAtEverySize) {
  for (TeleopScreen s : {TeleopScreen{}, full_screen()}) {
    for (const bool prompt : {false, true}) {
      if (prompt) s.prompt = "rotate";
      for (std::size_t columns = 20; columns <= 200; columns += columns < 90 ? 1 : 30) {
        for (std::size_t rows = 1; rows <= 60; ++rows) {
          const auto lines = render(s, {columns, rows});
          ASSERT_LE(lines.size(), rows) << columns;
          for (const auto& line : lines) ASSERT_LE(line.size(), columns) << rows;
          const auto stop = std::find_if(lines.begin(), lines.end(), [](const std::string& line) {
            return line.find("SPACE emergency stop") != std::string::npos;
          });
          ASSERT_NE(stop, lines.end()) << columns << "x" << rows;
        }
      }
    }
  }
}

TEST(TeleopScreen, TheSmallestSizeShowsAuthorityDriveNoticeAndPrompt) {
  TeleopScreen s = full_screen();
  s.notice = "granted: drive";
  const auto text = [&](ScreenSize size) {
    std::string all;
    for (const auto& line : render(s, size)) all += line + "\n";
    return all;
  };
  for (const ScreenSize size : {kSmallestScreen, ScreenSize{60, 18}, ScreenSize{80, 24}}) {
    for (const char* part : {"teleop  run", "authority  operator", "drive  ", "granted: drive"})
      EXPECT_NE(text(size).find(part), std::string::npos) << part << " at " << size.columns << "x" << size.rows;
  }
  EXPECT_NE(text({60, 18}).find("q quit"), std::string::npos) << "this size has room for the help";
  s.prompt = "rotate";
  EXPECT_NE(text(kSmallestScreen).find("task> rotate_"), std::string::npos);
}

TEST(TeleopScreen, BelowTheSmallestSizeItNamesTheRequiredSize) {
  for (const ScreenSize size : {ScreenSize{39, 10}, ScreenSize{40, 9}}) {
    const auto lines = render(full_screen(), size);
    ASSERT_EQ(lines.size(), 4u);
    EXPECT_EQ(lines[0], "SPACE emergency stop");
    EXPECT_NE(lines[2].find("too small"), std::string::npos);
    EXPECT_NE(lines[3].find("40x10"), std::string::npos);
  }
}

TEST(TeleopScreen, ShowsAuthorityPromptSeedPauseAndSilence) {
  TeleopScreen s = full_screen();
  EXPECT_NE(render(s)[1].find("operator teleop.host.1 (you)"), std::string::npos);
  EXPECT_NE(render(s)[0].find("0.99x"), std::string::npos);
  s.prompt = "rotate direction=";
  EXPECT_EQ(render(s)[23], "task> rotate direction=_");
  EXPECT_NE(render(s)[0].find("seed 7"), std::string::npos) << render(s)[0];
  s.view.run->paused = true;
  EXPECT_NE(render(s)[0].find("PAUSED"), std::string::npos);
  s.view.silent_s = 12.3;
  EXPECT_NE(render(s)[0].find("SILENT for 12 s"), std::string::npos) << render(s)[0];
}

TEST(TeleopScreen, ALargeTerminalShowsAllJointsAndEarlierEvents) {
  TeleopScreen s = full_screen();
  s.view.events.clear();
  for (int i = 0; i < 64; ++i) s.view.joints->torque_nm[i] = 0, s.view.events.push_back(std::to_string(i) + " e.");
  const auto shows = [&](ScreenSize size, const std::string& text) {
    const auto lines = render(s, size);
    return std::any_of(lines.begin(), lines.end(), [&](const auto& line) { return line.find(text) != line.npos; });
  };
  EXPECT_TRUE(shows({80, 24}, "61 e.") && !shows({80, 24}, "60 e.") && !shows({80, 24}, "63 +0.00|"));
  EXPECT_TRUE(shows({200, 60}, "63 e.") && shows({200, 60}, "40 e.") && shows({200, 60}, "63 +0.00|"));
}

TEST(TeleopScreen, TheLengthOfABarIsProportionalToTheTorque) {
  TeleopScreen s;
  s.view.joints = msg::JointState{};
  s.view.joints->joint_count = 23;
  s.view.joints->torque_nm[0] = -3.0;  // half of a full bar
  const std::string first = render(s)[6];
  EXPECT_NE(first.find("|######      |"), std::string::npos) << first;
}

}  // namespace
}  // namespace constrictor::cli
