#include "log/news_log.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "support/temporary_folder.hpp"

namespace constrictor {
namespace {

TEST(NewsLog, WritesABoundedNumberOfLines) {
  const testing::TemporaryFolder folder;
  const Log log("servo_bus", folder.path() / "log");
  std::vector<std::string> lines;
  log.forward([&](const LogRecord& record) { lines.push_back(record.text); });
  NewsLog news(log, 30, "more events were left out; servo_bus.json shows the newest ones");
  for (std::int64_t tick = 0; tick < 500; ++tick) {
    news.at(tick);
    news.write("servo 1 is lost", false);
  }
  EXPECT_EQ(lines.size(), 30u);
  news.at(500);
  EXPECT_EQ(lines.back(), "470 more events were left out; servo_bus.json shows the newest ones");
  news.write("servo 1 is back", true);
  EXPECT_EQ(lines.back(), "servo 1 is back");
}

}  // namespace
}  // namespace constrictor
