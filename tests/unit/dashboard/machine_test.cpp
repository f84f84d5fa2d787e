// The files of the page: the diagram against the state machine of the planner, and what no script may do.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <utility>

#include "constrictor/constants.hpp"
#include "planner/mission_state.hpp"
#include "support/project.hpp"

namespace constrictor::dashboard {
namespace {

using nlohmann::json;

json diagram() {
  std::ifstream file(testing::source_path("components/tools/dashboard/page/machine.json"));
  return json::parse(file);
}

TEST(Machine, TheDiagramHasEachStateOfThePlannerAtAPlaceOfItsOwn) {
  const json machine = diagram();
  std::set<std::string> names;
  for (std::size_t i = 0; i < kMissionStates; ++i) names.insert(name_of(static_cast<MissionState>(i)));
  std::set<std::string> drawn;
  std::set<std::pair<int, int>> places;
  for (const auto& [name, place] : machine.at("states").items()) {
    drawn.insert(name);
    EXPECT_TRUE(places.emplace(place.at(0), place.at(1)).second) << name;
    EXPECT_LT(place.at(0), machine.at("columns")) << name;
    EXPECT_LT(place.at(1), machine.at("rows")) << name;
  }
  EXPECT_EQ(drawn, names);
}

TEST(Machine, TheDiagramHasEachTransitionOfThePlannersTable) {
  const json machine = diagram();
  std::set<std::pair<std::string, std::string>> drawn;
  for (const auto& way : machine.at("transitions")) EXPECT_TRUE(drawn.emplace(way.at(0), way.at(1)).second) << way;
  for (std::size_t i = 0; i < kMissionStates; ++i) {
    const StateRow& row = row_of(static_cast<MissionState>(i));
    std::set<MissionState> next = {row.succeeded, row.failed};
    for (const auto& loss : row.losses) {
      if (loss.event != msg::kEventNone) next.insert(loss.to);
    }
    next.erase(row.state);  // to stay is not an arrow
    for (const MissionState to : next)
      EXPECT_TRUE(drawn.contains({row.name, name_of(to)})) << row.name << " to " << name_of(to);
  }
}

// "One place for each fact" (CONTRIBUTING.md): a new task, colour or direction appears without a change of the page.
TEST(Page, ListsNeitherTasksNorColoursNorDirections) {
  std::ifstream file(testing::source_path("components/tools/dashboard/page/tasks.js"));
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  ASSERT_NE(text.find("export function buildTasks"), std::string::npos);
  for (const auto& group : {constants::kTask, constants::kColour, constants::kDirection}) {
    for (const auto& name : names_of(group, 1)) EXPECT_EQ(text.find(name), std::string::npos) << name;
  }
}

// Names and reasons come from the run, and from every program that can send to it.
TEST(Page, InsertsNothingAsHtml) {
  int files = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(testing::source_path("components/tools/dashboard/page"))) {
    if (entry.path().extension() != ".js") continue;
    ++files;
    std::ifstream file(entry.path());
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    for (const char* word : {"innerHTML", "outerHTML", "insertAdjacentHTML", "document.write", "eval(", "DOMParser"})
      EXPECT_EQ(text.find(word), std::string::npos) << entry.path() << ": " << word;
  }
  EXPECT_GT(files, 10);
}

}  // namespace
}  // namespace constrictor::dashboard
