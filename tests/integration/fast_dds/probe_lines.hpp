// What ros_probe prints, and what it must show of the bridge's node.
#pragma once

#include <gtest/gtest.h>

#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace constrictor::testing {

struct Line {
  std::string kind;
  std::vector<std::string> words;
};

inline std::vector<Line> lines_of(const std::string& output) {
  std::vector<Line> lines;
  std::istringstream stream(output);
  for (std::string text; std::getline(stream, text);) {
    std::istringstream words(text);
    Line line;
    words >> line.kind;
    for (std::string word; words >> word;) line.words.push_back(word);
    lines.push_back(std::move(line));
  }
  return lines;
}

/// What ROS 2's commands show of the bridge: `ros2 node list` the node, `ros2 topic list -v` its readers and writers
/// with the hashes of their types.
inline void expect_node(const std::vector<Line>& lines, const std::string& bridge_output) {
  std::string participant, id_of_node;
  std::map<std::string, std::vector<std::string>> endpoints;  // "writer rt/clock": GUIDs
  std::set<std::string> ids, announced;
  for (const Line& line : lines) {
    if (line.kind == "participant" && line.words.size() == 2)  // this test's participant has no user data
      participant = line.words[0] + " " + line.words[1];
    if (line.kind == "node") {
      id_of_node = line.words.at(0);
      EXPECT_EQ(line.words.at(1), "/");
      EXPECT_EQ(line.words.at(2), "ros_bridge");
    }
    if (line.kind == "node_writer" || line.kind == "node_reader") announced.insert(line.words.at(0));
    // The probe also prints its own entities, which have no user data.
    const bool entity = (line.kind == "writer" || line.kind == "reader") && line.words.size() == 3;
    if (!entity) continue;
    EXPECT_EQ(line.words[2].size(), std::string("typehash=RIHS01_;").size() + 64) << line.words[2];
    EXPECT_EQ(line.words[2].rfind("typehash=RIHS01_", 0), 0u) << line.words[2];
    endpoints[line.kind + " " + line.words[0]].push_back(line.words[1]);
    if (line.words[0] != "ros_discovery_info") ids.insert(line.words[1]);
  }
  EXPECT_EQ(participant, id_of_node + " enclave=/;");
  EXPECT_EQ(announced, ids);
  // What the bridge says about itself is what is there.
  std::set<std::string> printed;
  std::string kind;
  for (const Line& line : lines_of(bridge_output)) {
    if (line.kind == "written:" || line.kind == "read:") kind = line.kind == "read:" ? "reader rt" : "writer rt";
    if (line.kind.front() == '/') printed.insert(kind + line.kind);
  }
  EXPECT_GE(printed.size(), 24u);
  for (const auto& entity : printed) EXPECT_TRUE(endpoints.contains(entity)) << entity;
  EXPECT_EQ(endpoints.size(), printed.size() + 1) << "and ros_discovery_info";
  EXPECT_EQ(endpoints["reader rt/emergency_stop"].size(), 2u) << "one for best-effort writers, one that loses nothing";
}

}  // namespace constrictor::testing
