#include "log/log.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <thread>
#include <tuple>
#include <vector>

#include "constrictor/messages.hpp"
#include "support/temporary_folder.hpp"

namespace constrictor {
namespace {

class LogTest : public ::testing::Test {
 protected:
  [[nodiscard]] std::vector<std::string> lines() const {
    std::ifstream file(file_);
    std::vector<std::string> lines;
    for (std::string line; std::getline(file, line);) lines.push_back(line);
    return lines;
  }
  [[nodiscard]] std::string text_after_time(std::size_t line) const {
    const std::string text = lines().at(line);
    return text.substr(text.find("Z ") + 2);
  }

  const testing::TemporaryFolder folder_;
  const std::filesystem::path file_ = folder_.path() / "a.log";
};

TEST_F(LogTest, ALineNamesLevelComponentAndTick) {
  const Log log("physics", file_);
  log.info("begins");
  log.at(7, 1, 812);
  log.warning("no Hello of \"{}\" for {} s", "planner", 2);
  log.at(7, 2, 3);
  log.about("camera").error("gone");
  EXPECT_EQ(text_after_time(0), "info physics: begins");
  EXPECT_EQ(text_after_time(1), "warning physics tick 812: no Hello of \"planner\" for 2 s");
  EXPECT_EQ(text_after_time(2), "error camera epoch 2 tick 3: gone");
}

TEST_F(LogTest, TheTimeIsTheWallClockInUtc) {
  const auto before = std::chrono::system_clock::now();
  Log("physics", file_).info("now");
  const auto after = std::chrono::system_clock::now();
  const auto record = read_log_text(lines().at(0));
  ASSERT_TRUE(record);
  EXPECT_GE(record->time, before - std::chrono::milliseconds(1));  // the text has milliseconds
  EXPECT_LE(record->time, after);
}

TEST_F(LogTest, EveryLineOfATextIsALineOfItsOwnWithoutControlCharacters) {
  const Log log("a", file_);
  std::vector<LogRecord> seen;
  log.forward([&](const LogRecord& record) { seen.push_back(record); });
  log.info("one\ntwo\t2\r\n\x1b[31mthree\x07");
  ASSERT_EQ(lines().size(), 3u);
  EXPECT_EQ(text_after_time(0), "info a: one");
  EXPECT_EQ(text_after_time(1), "info a: two 2?");
  EXPECT_EQ(text_after_time(2), "info a: ?[31mthree?");
  ASSERT_EQ(seen.size(), 3u);
  EXPECT_EQ(seen[2].number, 3u);
  EXPECT_EQ(seen[2].text, "?[31mthree?");
  EXPECT_EQ(seen[0].time, seen[2].time);
}

TEST_F(LogTest, LinesOfAllThreadsAreWholeAndNumberedInTheOrderOfTheFile) {
  constexpr int kThreads = 4;
  constexpr int kLines = 500;
  const Log log("a", file_);
  std::vector<std::string> forwarded;
  std::uint64_t last = 0;
  bool rising = true;
  log.forward([&](const LogRecord& record) {
    rising = rising && record.number == ++last;
    forwarded.push_back(record.text);
  });
  std::vector<std::thread> threads;
  for (int t = 0; t < kThreads; ++t) {
    threads.emplace_back([&log, t] {
      for (int i = 0; i < kLines; ++i) log.about("c" + std::to_string(t)).info("line {} of {}", i, t);
    });
  }
  for (auto& thread : threads) thread.join();
  EXPECT_TRUE(rising);
  const auto written = lines();
  ASSERT_EQ(written.size(), static_cast<std::size_t>(kThreads * kLines));
  ASSERT_EQ(forwarded.size(), written.size());
  for (std::size_t i = 0; i < written.size(); ++i) EXPECT_TRUE(written[i].ends_with(": " + forwarded[i])) << written[i];
}

TEST_F(LogTest, NothingIsForwardedAfterTheSinkIsTakenAway) {
  const Log log("a", file_);
  int seen = 0;
  log.forward([&](const LogRecord&) { ++seen; });
  log.info("one");
  log.forward(nullptr);
  log.info("two");
  EXPECT_EQ(seen, 1);
  EXPECT_EQ(lines().size(), 2u);
}

TEST(LogText, IsReadBack) {
  LogRecord record;
  record.time = std::chrono::system_clock::time_point(std::chrono::milliseconds(1'795'409'730'125));
  record.level = msg::kLogError;
  record.subject = "navigation,control";
  record.epoch = 3;
  record.tick = 1234567890123;
  record.text = "physics tick 3: a text that looks like a line";
  EXPECT_EQ(log_text(record),
            "2026-11-23T04:55:30.125Z error navigation,control epoch 3 tick 1234567890123: physics tick 3: a text that "
            "looks like a line");
  const auto read = read_log_text(log_text(record));
  ASSERT_TRUE(read);
  const auto all = [](const LogRecord& r) { return std::tuple(r.time, r.level, r.subject, r.epoch, r.tick, r.text); };
  EXPECT_EQ(all(*read), all(record));
}

TEST(LogText, OfAnythingElseIsNotALine) {
  for (const char* text : {"", "ODE Message 3: LCP internal error", "2026-11-23T04:55:30.125Z loud physics: hello",
                           "2026-11-23T04:55:30Z info physics: no milliseconds",
                           "2026-11-23T04:55:30.125Z info physics tick 99999999999999999999: too large"})
    EXPECT_FALSE(read_log_text(text)) << text;
}

}  // namespace
}  // namespace constrictor
