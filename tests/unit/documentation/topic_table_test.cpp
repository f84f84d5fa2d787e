// The table of topics against the documentation that repeats it and against the components.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <regex>
#include <set>
#include <string>

#include "constrictor/topics.hpp"
#include "support/project.hpp"
#include "topic_tables.hpp"

namespace constrictor {
namespace {

using Names = std::set<std::string>;

/// The words of a list such as "guidance, control, observers".
Names names_in(const std::string& list) {
  Names names;
  static const std::regex word("[a-z_]+");
  for (std::sregex_iterator at(list.begin(), list.end(), word), end; at != end; ++at) names.insert(at->str());
  return names;
}

/// The documentation of each message type: the comment of its struct in the IDL.
template <class... Messages>
std::map<std::string, std::string> docs_of(TypeList<Messages...>) {
  return {{Description<Messages>::kName, Description<Messages>::kDoc}...};
}
const std::map<std::string, std::string> kDocs = docs_of(AllMessages{});

/// The part of a comment after "Writer:", "Readers:" or "Rate:", up to the full stop.
std::string said(const std::string& doc, const std::string& what) {
  std::smatch match;
  return std::regex_search(doc, match, std::regex(what + ": ([^.]*)\\.")) ? match[1].str() : "";
}

TEST(TopicTable, EqualsTheTablesInIdlReadme) {
  std::ifstream file(testing::source_path("idl/README.md"));
  const std::string readme{std::istreambuf_iterator<char>(file), {}};
  EXPECT_EQ(documentation::with_topic_tables(readme), readme)
      << "to update the tables: cmake --build build/release --target topic_tables";
}

// The comment of a type that several topics carry cannot name one writer, one list of readers and one rate; the table
// has them. Request is such a type: a member topic and a client topic carry it.
TEST(TopicTable, AgreesWithTheCommentsOfTheIdlOnMemberTopics) {
  int checked = 0;
  for (const auto& topic : topics::kInfos) {
    const auto same = [&](const TopicInfo& other) { return other.type == topic.type; };
    if (std::count_if(topics::kInfos.begin(), topics::kInfos.end(), same) > 1 || topic.type == "Request") continue;
    const std::string& doc = kDocs.at(std::string(topic.type));
    const std::string writer = said(doc, "Writer");
    EXPECT_EQ(writer == "plant" ? "physics" : writer, topic.writer) << topic.type;
    EXPECT_EQ(said(doc, "Rate"), topic.rate) << topic.type;
    Names readers = names_in(said(doc, "Readers?"));
    EXPECT_FALSE(readers.empty()) << topic.type;
    if (readers.erase("plant") > 0) readers.insert("physics");
    std::erase_if(readers, [](const std::string& name) { return !documentation::members().contains(name); });
    EXPECT_EQ(readers, documentation::readers_of(topic)) << topic.type;
    ++checked;
  }
  EXPECT_GT(checked, 15);
}

TEST(TopicTable, AgreesWithTheCommentsOfTheIdlOnBarrierAndClientTopics) {
  for (const auto& topic : barrier_topics::kInfos) {
    if (topic.type == "Request") continue;
    const std::string& doc = kDocs.at(std::string(topic.type));
    EXPECT_EQ(said(doc, "Writers?"), topic.writers) << topic.type;
    EXPECT_EQ(said(doc, "Readers?"), topic.readers) << topic.type;
    EXPECT_EQ(said(doc, "Rate"), topic.rate) << topic.type;
  }
}

// A restarted reader repeats tick k. The run does not publish tick k + latency of the reader before the reader has
// finished, so a writer has written at most what becomes visible at k + reader's latency - 1 + its own latency.
TEST(TopicTable, KeepsTheSampleThatARestartedReaderNeeds) {
  int checked = 0;
  for (const auto& topic : topics::kInfos) {
    if (topic.rate != "every tick") continue;
    const int steps = topic.depth / topic.max_per_tick;
    const int writer = documentation::members().at(std::string(topic.writer))->timing().latency;
    for (const auto& name : documentation::readers_of(topic)) {
      EXPECT_GE(steps, writer + documentation::members().at(name)->timing().latency) << topic.name << ", " << name;
      ++checked;
    }
  }
  EXPECT_GT(checked, 15);
}

TEST(TopicTable, NamesEachTopicOnce) {
  Names names;
  for (const auto& topic : topics::kInfos) EXPECT_TRUE(names.insert(std::string(topic.name)).second) << topic.name;
  for (const auto& topic : barrier_topics::kInfos) EXPECT_TRUE(names.insert(topic.name).second) << topic.name;
}

}  // namespace
}  // namespace constrictor
