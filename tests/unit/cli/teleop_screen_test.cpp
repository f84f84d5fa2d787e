// The screen of the terminal client at every size.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include "cli/teleop_screen.hpp"

namespace constrictor::cli {
namespace {

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
  for (const ScreenSize size : {kSmallestScreen, ScreenSize{60, 18}, ScreenSize{80, 24}}) {
    for (const char* key : {"q quit", "r release"})
      EXPECT_NE(text(size).find(key), std::string::npos) << key << " at " << size.columns << "x" << size.rows;
  }
  EXPECT_NE(text({60, 18}).find("u/o rotate"), std::string::npos) << "this size has room for the whole help";
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

TEST(TeleopScreen, ALineThatIsCutEndsWithAMark) {
  TeleopScreen s = full_screen();
  for (const std::size_t columns : {40, 60, 80}) {
    for (const auto& line : render(s, {columns, 24})) {
      if (line.find("rrr") != line.npos) {
        EXPECT_EQ(line.back(), '>') << line;
      }
    }
  }
  s.notice = std::string(60, 'n');
  const auto lines = render(s, {60, 24});
  EXPECT_NE(std::find(lines.begin(), lines.end(), s.notice), lines.end()) << "a line that just fits has no mark";
}

TEST(TeleopScreen, ALargeTerminalIsFilledWithLongBars) {
  TeleopScreen s;
  s.view.joints = msg::JointState{};
  s.view.joints->joint_count = 23;
  for (double& torque : s.view.joints->torque_nm) torque = 6.0;
  for (const ScreenSize size : {ScreenSize{145, 45}, ScreenSize{200, 60}, ScreenSize{100, 30}}) {
    const auto lines = render(s, size);
    const auto first = std::find_if(lines.begin(), lines.end(), [](const auto& l) { return l.starts_with(" 0 "); });
    ASSERT_NE(first, lines.end());
    EXPECT_GE(first->size() + 3, std::min<std::size_t>(size.columns, 115)) << *first;
    const auto joints =
        std::count_if(first, lines.end(), [](const auto& line) { return line.find("#|") != line.npos; });
    EXPECT_GE(3 * joints, 23) << "in at most three columns";
    EXPECT_EQ(lines.size(), size.rows);
  }
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
