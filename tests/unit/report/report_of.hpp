// The report on a scripted mission.
#pragma once

#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "barrier/local_run.hpp"
#include "component/data_path.hpp"
#include "sim/report/report.hpp"
#include "support/temporary_folder.hpp"
#include "synthetic_run.hpp"

namespace constrictor::testing {

struct Outcome {
  nlohmann::json mission;
  std::map<std::string, std::string> files;
  std::int64_t last_tick = 0;
};

/// An end of the run before the mission's end.
struct EarlyEnd {
  std::int64_t end_tick = -1;  ///< last tick that the report steps; -1: the report ends the run
  double plant_limit_s = 0.0;
};

inline Outcome report_of(const Story& story, const std::vector<std::int64_t>& restarts = {},
                         const std::string& configuration = {}, EarlyEnd early = {}, const std::string& mission = {}) {
  const TemporaryFolder folder;
  const TemporaryFolder configurations;
  Setup setup;
  setup.robot_file = data_path("components/lib/robot/mamba.yaml");
  setup.output_dir = folder.path() / "run";
  setup.max_sim_time_s = early.plant_limit_s;
  setup.scenario_file = "/somewhere/blind_story.yaml";  // only its name is used, and only without ground truth
  setup.seed = 12;
  setup.mission = mission;
  std::map<std::string, std::filesystem::path> config_files;
  if (!configuration.empty()) {
    report::replace_file(configurations.path() / "report.yaml", configuration);
    config_files["report"] = configurations.path() / "report.yaml";
  }
  auto members = story_members(story);
  members.push_back(make_report_factory());
  LocalRun run(members, setup, config_files);
  for (const std::int64_t tick : restarts) {
    run.advance(tick - run.tick());
    run.restart("report");
  }
  if (early.end_tick >= 0) {
    run.advance(early.end_tick + 1 - run.tick());
    run.end_run();
  }
  run.advance(2000);
  EXPECT_TRUE(run.ended());
  Outcome outcome;
  outcome.files = folder.contents();
  outcome.last_tick = run.tick();
  if (outcome.files.count("run/mission.json") > 0)
    outcome.mission = nlohmann::json::parse(outcome.files.at("run/mission.json"));
  return outcome;
}

}  // namespace constrictor::testing
