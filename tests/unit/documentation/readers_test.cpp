// Who reads what, as idl/README.md and the comments of the IDL say it, against what the components declare.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>

#include "known_components.hpp"
#include "runtime/barrier/member.hpp"
#include "runtime/share.hpp"

namespace constrictor {
namespace {

using Names = std::set<std::string>;

struct SilentSink : MemberSink {
  void publish(const TopicInfo&, const Sample&) override {}
  void done(const StepDone&) override {}
};

/// Readers of each topic by its id, of the components of this build.
std::map<std::size_t, Names> declared_readers() {
  std::map<std::size_t, Names> readers;
  constrictor::Setup setup;
  setup.robot_file = share_path("components/robot/mamba.yaml");
  setup.scenario_file = share_path("sim/scenarios/case_study.yaml");
  SilentSink sink;
  for (const auto& [name, make] : known_components()) {
    const Member member(make(), setup, 1, false, sink);
    for (std::size_t id = 0; id < topics::kCount; ++id) {
      if (member.reads() >> id & 1) readers[id].insert(name);
    }
  }
  return readers;
}

Names names_in(const std::string& list) {
  Names names;
  static const std::regex word("[a-z]+");
  for (std::sregex_iterator at(list.begin(), list.end(), word), end; at != end; ++at) names.insert(at->str());
  names.erase("none");
  return names;
}

std::string text_of(const std::filesystem::path& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

TEST(Readers, AreThoseOfTheTableInIdlReadme) {
  const auto readers = declared_readers();
  const std::string readme = text_of(std::filesystem::path(CONSTRICTOR_SOURCE_DIR) / "idl/README.md");
  for (const auto& topic : topics::kInfos) {
    const std::regex row("\n\\| " + std::to_string(topic.id) + " \\|[^|]*\\|[^|]*\\|[^|]*\\|([^|]*)\\|");
    std::smatch match;
    ASSERT_TRUE(std::regex_search(readme, match, row)) << topic.name;
    const auto found = readers.find(topic.id);
    EXPECT_EQ(names_in(match[1]), found == readers.end() ? Names{} : found->second) << topic.name;
  }
}

// Types that several topics carry, and Request, which comes from outside too, say who writes and reads in prose; the table has them.
TEST(Readers, AreThoseOfTheIdlsComments) {
  std::string idl;
  for (const auto& file : std::filesystem::directory_iterator(std::filesystem::path(CONSTRICTOR_SOURCE_DIR) / "idl/constrictor")) {
    if (file.path().extension() == ".idl") idl += text_of(file.path());
  }
  idl = std::regex_replace(idl, std::regex("\n// "), " ");  // a comment of several lines as one
  const auto readers = declared_readers();
  int checked = 0;
  for (const auto& topic : topics::kInfos) {
    const auto same = [&](const TopicInfo& other) { return other.type == topic.type; };
    if (std::count_if(topics::kInfos.begin(), topics::kInfos.end(), same) > 1 || topic.type == "Request") continue;
    const std::regex comment("Writer: ([a-z]+)\\. Readers?: ([^.;(]*)[^\n]*\n(?:const [^\n]*\n)*@final struct " + std::string(topic.type) + " ");
    std::smatch match;
    ASSERT_TRUE(std::regex_search(idl, match, comment)) << topic.type;
    EXPECT_EQ(match[1] == "plant" ? "physics" : match[1].str(), topic.writer) << topic.type;
    Names said = names_in(match[2]);
    if (said.erase("plant") > 0) said.insert("physics");
    std::erase_if(said, [](const std::string& word) { return !known_components().contains(word); });  // observers and who asked
    const auto found = readers.find(topic.id);
    EXPECT_EQ(said, found == readers.end() ? Names{} : found->second) << topic.type;
    ++checked;
  }
  EXPECT_GT(checked, 15);
}

}  // namespace
}  // namespace constrictor
