// A mission of which some files cannot be written, as on a disk without space.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "barrier/local_run.hpp"
#include "component/data_path.hpp"
#include "sim/report/report.hpp"
#include "support/temporary_folder.hpp"
#include "synthetic_run.hpp"

namespace constrictor {
namespace {

namespace fs = std::filesystem;

TEST(UnwrittenFiles, LeaveTheVerdictAndAreNamedInIt) {
  const testing::TemporaryFolder folder;
  const fs::path run_folder = folder.path() / "run";
  fs::create_directories(run_folder / "events.jsonl");         // a folder where a file is needed
  std::ofstream(run_folder / "snapshots") << "and reversely";  // no picture can be written
  constrictor::Setup setup;
  setup.robot_file = data_path("components/lib/robot/mamba.yaml");
  setup.output_dir = run_folder;
  auto members = testing::story_members({});
  members.push_back(make_report_factory());
  LocalRun run(members, setup, {});
  run.advance(100);
  run.restart("report");
  run.advance(2000);
  ASSERT_TRUE(run.ended());
  const auto mission = nlohmann::json::parse(std::ifstream(run_folder / "mission.json"), nullptr, false);
  EXPECT_EQ(mission["success"], true) << mission["reason"];
  EXPECT_EQ(mission["events"].size(), 0u);
  EXPECT_GT(mission["states"].size(), 0u);
  std::string names;
  for (const std::string reason : mission["files_not_written"]) names += reason + "\n";
  EXPECT_NE(names.find("events.jsonl: Is a directory"), std::string::npos) << names;
  EXPECT_NE(names.find("snapshots/0000400_camera.png: Not a directory"), std::string::npos) << names;
  EXPECT_TRUE(fs::exists(run_folder / "figure.png")) << mission["figure_error"];
}

}  // namespace
}  // namespace constrictor
