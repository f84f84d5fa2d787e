// The parts of the terminal client that are pure functions: keys and driving.
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
#include "cli/usage.hpp"
#include "client/task_names.hpp"
#include "robot/drive_motion.hpp"

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

TEST(DriveMotion, HasTheSignsOfSpeedAndTurnAndStaysWithinTheRangesOfTheMessage) {
  EXPECT_GT(drive_motion(0.3, 0.0).speed_m_s, 0.0);
  EXPECT_LT(drive_motion(-0.3, 0.0).speed_m_s, 0.0);
  EXPECT_GT(drive_motion(0.3, 0.2).curvature_1_m, 0.0);
  EXPECT_LT(drive_motion(0.0, -0.5).curvature_1_m, -2.0);
  EXPECT_EQ(drive_motion(0.0, 0.0).speed_m_s, 0.0);
  for (const double v : {-1e9, -1.0, 0.0, 0.01, 5.0, std::numeric_limits<double>::infinity(), std::nan("")}) {
    for (const double w : {-1e9, 0.0, 1e-6, 3.0, std::nan("")}) {
      const DriveMotion motion = drive_motion(v, w);
      EXPECT_LE(std::abs(motion.speed_m_s), 2.0) << v << " " << w;
      EXPECT_LE(std::abs(motion.curvature_1_m), 5.0) << v << " " << w;
    }
  }
}

}  // namespace
}  // namespace constrictor::cli
