// Runs of `constrictor evaluate` that are refused before their start, because of the scene that their seed draws.
#include <gtest/gtest.h>

#include <fstream>

#include "cli/evaluate/mission_result.hpp"
#include "cli/evaluate/page.hpp"
#include "cli/evaluate/summary.hpp"
#include "support/temporary_folder.hpp"

namespace constrictor::cli {
namespace {

TEST(RefusedRun, IsNoErrorBecauseARepetitionWouldBeRefusedToo) {
  const testing::TemporaryFolder folder;
  std::ofstream(folder.path() / "run.log") << "constrictor: configuration: wide.yaml: objects[0].radius_m: found 0.2\n";
  const MissionResult refused = read_result(folder.path(), 78);
  EXPECT_TRUE(refused.refused);
  EXPECT_FALSE(refused.error());
  EXPECT_FALSE(refused.unwritten());
  EXPECT_EQ(refused.reason, "constrictor: configuration: wide.yaml: objects[0].radius_m: found 0.2");
  EXPECT_STREQ(refused.kind(), "refused: ");
  EXPECT_FALSE(read_result(folder.path(), 70).refused);
  EXPECT_STREQ(read_result(folder.path(), 70).kind(), "error: ");
  std::ofstream(folder.path() / "report.json") << R"({"success": false, "reason": "a process was refused"})";
  EXPECT_FALSE(read_result(folder.path(), 78).refused) << "the run had begun";
  EXPECT_TRUE(read_result(folder.path(), 78).error());
}

TEST(RefusedRun, IsNoMission) {
  const auto variants = make_variants({});
  MissionResult succeeded;
  succeeded.exit_status = 0;
  succeeded.success = true;
  succeeded.mission_time_s = 50.0;
  succeeded.time_in_state_s = {{"grasp", 10.0}};
  std::vector<MissionResult> results(3, succeeded);
  const VariantSummary before = summarise(variants, results).front();
  MissionResult refused;
  refused.exit_status = 78;
  refused.refused = true;
  refused.reason = "objects[0].radius_m: found 0.2";
  results.push_back(refused);
  const VariantSummary summary = summarise(variants, results).front();
  EXPECT_EQ(summary.runs, 4u);
  EXPECT_EQ(summary.refused, 1u);
  EXPECT_EQ(summary.errors, 0u);
  EXPECT_EQ(summary.recoveries.values, before.recoveries.values);
  EXPECT_EQ(summary.longest_recovery_s.values, before.longest_recovery_s.values);
  EXPECT_EQ(summary.mean_time_in_state_s, before.mean_time_in_state_s);
  const auto written = to_json({summary}).at(0);
  EXPECT_EQ(written.at("refused"), 1);
  EXPECT_EQ(written.at("phases").at("mission succeeded"), to_json({before}).at(0).at("phases").at("mission succeeded"))
      << "the interval is that of the three missions";
  EXPECT_NE(make_page({"wide", "about", 4, variants, results}).find("refused: objects[0].radius_m: found 0.2"),
            std::string::npos);
}

}  // namespace
}  // namespace constrictor::cli
