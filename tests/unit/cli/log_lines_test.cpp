// Log files of a run: their bound, their order, and which lines a user wants.
#include <gtest/gtest.h>

#include <atomic>
#include <fstream>
#include <thread>

#include "cli/log/log_files.hpp"
#include "cli/log/log_lines.hpp"
#include "constrictor/text.hpp"
#include "support/temporary_folder.hpp"

namespace constrictor::cli {
namespace {

namespace fs = std::filesystem;

class LogFiles : public ::testing::Test {
 protected:
  LogFiles() { fs::create_directory(folder_.path() / "logs"); }
  [[nodiscard]] fs::path file(const std::string& name) const { return folder_.path() / "logs" / name; }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(file(name), std::ios::app) << text;
  }
  [[nodiscard]] std::string text(const std::string& name) const {
    std::ifstream stream(file(name));
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  [[nodiscard]] std::vector<std::string> messages(const LogFilter& filter = {}) const {
    std::vector<std::string> messages;
    for (const auto& entry : read_logs(folder_.path(), filter)) messages.push_back(entry.record.text);
    return messages;
  }

  const testing::TemporaryFolder folder_;
};

using Texts = std::vector<std::string>;

TEST_F(LogFiles, AreMergedInTheOrderOfTimeAndEachKeepsItsOrder) {
  write("physics.log",
        "2026-11-23T04:00:00.100Z info physics: a\nODE Message 3: LCP internal error\n"
        "2026-11-23T04:00:03.000Z warning physics tick 9: d\n"
        "2026-11-23T04:00:01.000Z info physics tick 10: e, after the clock was set back\n");
  write("camera+report.log",
        "2026-11-23T04:00:00.200Z info camera,report: b\n2026-11-23T04:00:02.000Z error report tick 5: c\n");
  EXPECT_EQ(messages(),
            (Texts{"a", "ODE Message 3: LCP internal error", "b", "c", "d", "e, after the clock was set back"}));
}

TEST_F(LogFiles, AreFilteredByLevelComponentTickAndText) {
  write("physics.log",
        "2026-11-23T04:00:00.000Z info physics: begins\nODE Message 3: LCP internal error\n"
        "2026-11-23T04:00:01.000Z warning physics tick 9: slow step\n"
        "2026-11-23T04:00:02.000Z error physics epoch 2 tick 3: no step\n");
  write("camera+report.log",
        "2026-11-23T04:00:00.500Z info camera,report: begin\n2026-11-23T04:00:01.500Z warning report tick 12: slow "
        "disk\n");
  LogFilter filter;
  filter.least_level = msg::kLogWarning;
  EXPECT_EQ(messages(filter), (Texts{"ODE Message 3: LCP internal error", "slow step", "slow disk", "no step"}));
  filter = {};
  filter.components = {"report"};
  EXPECT_EQ(messages(filter), (Texts{"begin", "slow disk"}));
  filter.components = {"camera"};
  EXPECT_EQ(messages(filter), (Texts{"begin"})) << "the line about report is not about camera";
  filter.components = {"camera", "physics"};
  filter.since_tick = 3;
  EXPECT_EQ(messages(filter), (Texts{"slow step", "no step"}));
  filter = {};
  filter.text = "slow";
  EXPECT_EQ(messages(filter), (Texts{"slow step", "slow disk"}));
}

TEST_F(LogFiles, ShowNoControlCharacters) {
  write("physics.log", "2026-11-23T04:00:00.000Z info physics: \x1b[2Jgone\n\x1b]0;title\x07\n");
  EXPECT_EQ(messages(), (Texts{"?[2Jgone", "?]0;title?"}));
}

TEST_F(LogFiles, OfNobodyAreRefused) {
  EXPECT_THROW(static_cast<void>(read_logs(folder_.path(), {})), std::runtime_error);
}

TEST_F(LogFiles, AreBoundedAndSayWhatWasDropped) {
  const std::string first(600, 'a');
  const std::string second(700, 'b');
  const std::string third(800, 'c');
  write("physics.log", first);
  EXPECT_FALSE(bound_log(file("physics.log"), 600));
  write("physics.log", "\n");
  EXPECT_TRUE(bound_log(file("physics.log"), 600));
  EXPECT_EQ(text("physics.old.log"), first + "\n");
  EXPECT_NE(text("physics.log").find("older lines of this log are in physics.old.log"), std::string::npos);
  write("physics.log", second + "\n");
  EXPECT_TRUE(bound_log(file("physics.log"), 600));
  EXPECT_NE(text("physics.old.log").find(second), std::string::npos);
  EXPECT_NE(text("physics.log").find("601 bytes of still older lines were dropped"), std::string::npos)
      << text("physics.log");
  write("physics.log", third + "\n");
  bound_logs(folder_.path() / "logs", 600);
  EXPECT_EQ(log_files(folder_.path() / "logs"), (std::vector{file("physics.old.log"), file("physics.log")}));
  EXPECT_LT(text("physics.log").size(), 600u);
  EXPECT_NE(text("physics.old.log").find(third), std::string::npos);
  EXPECT_EQ(text("physics.old.log").find(second), std::string::npos);
  remove_log(file("physics.log"));
  EXPECT_TRUE(log_files(folder_.path() / "logs").empty());
}

// A process appends its lines while the launcher puts the log aside.
TEST_F(LogFiles, KeepTheOrderOfAProcessThatGoesOnWriting) {
  constexpr int kCuts = 5;
  std::atomic<bool> enough = false;
  std::thread writer([&] {
    const Log log("physics", file("physics.log"));
    for (int i = 0; !enough; ++i) log.info("line {}", i);
  });
  std::vector<std::string> whole;
  for (int cuts = 0; cuts < kCuts;) {
    if (!bound_log(file("physics.log"), 100'000)) continue;
    ++cuts;
    for (const auto& entry : read_log_file(file("physics.old.log"), {})) whole.push_back(entry.record.text);
  }
  enough = true;
  writer.join();
  for (const auto& entry : read_log_file(file("physics.log"), {})) whole.push_back(entry.record.text);
  int gaps = 0;
  int last = -1;
  for (const auto& message : whole) {
    if (!message.starts_with("line ")) continue;
    const int number = std::stoi(message.substr(5));
    EXPECT_GT(number, last) << "in order, and none twice";
    if (number != last + 1) ++gaps;
    last = number;
  }
  EXPECT_GT(last, 5000) << "each time, more than 100,000 bytes were put aside";
  EXPECT_LE(gaps, kCuts) << "only what is written between a copy and its cut is lost";
}

TEST(LogEntryOfAMessage, HasAllThatTheMessageHas) {
  msg::LogLine line{};
  set_text(line.host, "pi");
  line.pid = 12;
  set_text(line.process, "navigation,control");
  line.incarnation = 2;
  line.run_id = 7;
  line.epoch = 3;
  line.tick = 40;
  line.wall_time_ns = 1'795'409'730'125'000'000;
  line.number = 5;
  line.level = msg::kLogError;
  set_text(line.message, "gone");
  LogEntry entry = entry_of(line);
  EXPECT_EQ(text_of(entry, "pi"), "2026-11-23T04:55:30.125Z error navigation,control epoch 3 tick 40: gone");
  set_text(line.component, "control");
  entry = entry_of(line);
  EXPECT_EQ(text_of(entry, "here"), "2026-11-23T04:55:30.125Z error control@pi epoch 3 tick 40: gone");
  EXPECT_EQ(to_json(entry), nlohmann::ordered_json::parse(R"({"wall_time_ns": 1795409730125000000, "level": "error",
    "component": "control", "process": "navigation,control", "host": "pi", "pid": 12, "incarnation": 2, "epoch": 3,
    "tick": 40, "number": 5, "foreign": false, "message": "gone"})"));
}

}  // namespace
}  // namespace constrictor::cli
