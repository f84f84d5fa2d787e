// Every shipped scenario succeeds with plain `constrictor run NAME`.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "runtime/host.hpp"
#include "support/process.hpp"
#include "support/project.hpp"
#include "support/temporary_folder.hpp"

namespace constrictor::testing {
namespace {

const std::filesystem::path kScenarios = testing::source_path("sim/scenarios");

std::vector<std::string> shipped_scenarios() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(kScenarios)) {
    if (entry.path().extension() == ".yaml") names.push_back(entry.path().stem());
  }
  std::sort(names.begin(), names.end());
  return names;
}

class ShippedScenario : public ::testing::TestWithParam<std::string> {};

TEST_P(ShippedScenario, Succeeds) {
  const TemporaryFolder folder;
  const std::filesystem::path report_dir = folder.path() / "out";
  Process run({program("constrictor"), "run", GetParam(), "--report", report_dir.string()});
  EXPECT_EQ(run.wait(std::chrono::seconds(560)), exit_status::kOk) << run.output() << run.errors();
  const auto report = nlohmann::json::parse(std::ifstream(report_dir / "report.json"), nullptr, false);
  ASSERT_TRUE(report.is_object()) << run.output();
  EXPECT_EQ(report["success"], true) << report["reason"];
  EXPECT_EQ(report["reason"], "");
  EXPECT_EQ(report["mission"], "succeeded");
  EXPECT_TRUE(std::filesystem::exists(report_dir / "figure.png"));
}

class OtherRobot : public ::testing::TestWithParam<std::string> {};

TEST_P(OtherRobot, DeliversItsObjects) {
  const TemporaryFolder folder;
  const std::filesystem::path report_dir = folder.path() / "out";
  Process run({program("constrictor"), "run", "--robot", GetParam(), "--report", report_dir.string()});
  EXPECT_EQ(run.wait(std::chrono::seconds(560)), exit_status::kOk) << run.output() << run.errors();
  const auto report = nlohmann::json::parse(std::ifstream(report_dir / "report.json"), nullptr, false);
  ASSERT_TRUE(report.is_object()) << run.output();
  EXPECT_EQ(report["success"], true) << report["reason"];
}

INSTANTIATE_TEST_SUITE_P(Robots, OtherRobot, ::testing::Values("mamba_no_skin", "mamba_yaw_only"),
                         [](const auto& made) { return made.param; });

INSTANTIATE_TEST_SUITE_P(Scenarios, ShippedScenario, ::testing::ValuesIn(shipped_scenarios()),
                         [](const auto& made) { return made.param; });

}  // namespace
}  // namespace constrictor::testing
