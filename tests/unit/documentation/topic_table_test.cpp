// Documentation that repeats code is held to it.
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "runtime/topics.hpp"

namespace constrictor {
namespace {

std::string trimmed(std::string text) {
  const auto strip = [](char c) { return c == ' ' || c == '`'; };
  while (!text.empty() && strip(text.back())) text.pop_back();
  while (!text.empty() && strip(text.front())) text.erase(0, 1);
  return text;
}

/// Rows of idl/README.md whose first cell is a number, by topic name.
std::map<std::string, std::vector<std::string>> documented_topics() {
  std::map<std::string, std::vector<std::string>> rows;
  std::ifstream file(std::string(CONSTRICTOR_SOURCE_DIR) + "/idl/README.md");
  for (std::string line; std::getline(file, line);) {
    std::vector<std::string> cells;
    std::istringstream stream(line);
    for (std::string cell; std::getline(stream, cell, '|');) cells.push_back(trimmed(cell));
    if (cells.size() != 10 || cells[1].empty() || cells[1].find_first_not_of("0123456789") != std::string::npos) continue;
    rows[cells[2]] = cells;
  }
  return rows;
}

TEST(TopicTable, IdlReadmeSaysWhatTheCodeSays) {
  const auto rows = documented_topics();
  EXPECT_EQ(rows.size(), topics::kCount);
  for (const auto& topic : topics::kInfos) {
    const auto entry = rows.find(std::string(topic.name));
    ASSERT_NE(entry, rows.end()) << topic.name;
    const auto& cells = entry->second;
    EXPECT_EQ(cells[1], std::to_string(topic.id)) << topic.name;
    EXPECT_EQ(cells[3], topic.type) << topic.name;
    EXPECT_EQ(cells[4], topic.writer) << topic.name;
    EXPECT_EQ(cells[6], topic.rate) << topic.name;
    EXPECT_EQ(cells[7], std::to_string(topic.max_per_tick)) << topic.name;
    EXPECT_EQ(cells[8], std::to_string(topic.depth)) << topic.name;
    EXPECT_EQ(cells[9], std::string(topic.doc) + (topic.simulation_only ? " (simulation only)" : "")) << topic.name;
  }
}

}  // namespace
}  // namespace constrictor
