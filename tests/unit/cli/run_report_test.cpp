#include "cli/run_report.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "constrictor/text.hpp"

namespace constrictor::cli {
namespace {

namespace fs = std::filesystem;

class RunReport : public ::testing::Test {
 protected:
  RunReport() : dir_(fs::temp_directory_path() / ("run_report_" + std::to_string(::getpid()))) {
    fs::create_directories(dir_);
  }
  ~RunReport() override { fs::remove_all(dir_); }
  void write_mission(const std::string& text) const { std::ofstream(dir_ / "mission.json") << text; }
  /// Expects that a run has no success, and that its verdict and report.json name the same reason. Returns this reason.
  [[nodiscard]] std::string reason_of(const RunOutcome& outcome) const {
    const RunVerdict verdict = write_report(dir_, outcome, {}, {});
    EXPECT_FALSE(verdict.success);
    EXPECT_EQ(report()["success"], false);
    EXPECT_EQ(report()["reason"], verdict.reason);
    return verdict.reason;
  }
  [[nodiscard]] nlohmann::json report() const { return nlohmann::json::parse(std::ifstream(dir_ / "report.json")); }
  fs::path dir_;
};

TEST_F(RunReport, CombinesTheMissionWithTheProcesses) {
  std::ofstream(dir_ / "mission.json")
      << R"({"success": true, "sim_time_s": 20.0, "ticks": 1001, "state_hash": "ab", "objects": []})";
  RunView view;
  view.overruns["a"] = 2;
  view.overruns["b"] = 3;
  view.refused["b"] = 4;
  view.components["a"].jitter_max_us = std::nan("");
  view.components["b"].jitter_max_us = 1500.0;
  set_text(view.components["a"].scheduling, "FIFO 5");
  const std::vector<ProcessRecord> processes = {{"a+b", {"a", "b"}, 1.5, 30.0, 1}, {"c", {"c"}, 0.5, 10.0, 0}};
  const RunVerdict verdict = write_report(dir_, {"case_study", 7, 4.0, "", ""}, view, processes);
  EXPECT_TRUE(verdict.success);
  EXPECT_EQ(verdict.reason, "");
  EXPECT_EQ(verdict.sim_time_s, 20.0);
  const auto json = report();
  for (const char* key : {"success", "reason", "seed", "scenario", "sim_time_s", "wall_time_s", "real_time_factor",
                          "ticks", "state_hash", "objects", "line", "pose_error", "events", "states", "processes"}) {
    EXPECT_TRUE(json.contains(key)) << key;
  }
  EXPECT_EQ(json["seed"], 7);
  EXPECT_EQ(json["ticks"], 1001);
  EXPECT_DOUBLE_EQ(json["real_time_factor"], 5.0);
  EXPECT_EQ(json["processes"][0]["overruns"], 5);
  EXPECT_EQ(json["processes"][0]["refused"], 4);
  EXPECT_EQ(json["processes"][0]["restarts"], 1);
  EXPECT_EQ(json["processes"][1]["refused"], 0);
  EXPECT_EQ(json["processes"][0]["jitter_max_us"], 1500.0);
  EXPECT_EQ(json["processes"][0]["scheduling"], "FIFO 5");
  EXPECT_TRUE(json["processes"][1]["jitter_max_us"].is_null()) << "no component of the process has measured it";
}

TEST_F(RunReport, WithoutAMissionFileTheRunHasNoSuccess) {
  EXPECT_EQ(reason_of({"s", 1, 1.0, "", ""}), "no report component judged the mission");
  EXPECT_TRUE(report()["state_hash"].is_null());
}

TEST_F(RunReport, AFailedRunHasNoSuccessEvenIfTheMissionSucceeded) {
  write_mission(R"({"success": true, "reason": ""})");
  EXPECT_EQ(reason_of({"s", 1, 1.0, "control ended", "ended by user at 1.0 s"}), "control ended");
  EXPECT_EQ(report()["error"], "control ended");
}

TEST_F(RunReport, WithADamagedMissionFileTheRunHasNoSuccess) {
  write_mission("{\"success\": tr");
  EXPECT_EQ(reason_of({"s", 1, 1.0, "", ""}), "no report component judged the mission");
}

TEST_F(RunReport, TakesTheReasonOfTheReportComponent) {
  write_mission(R"({"success": false, "reason": "green lies 0.51 m from its zone"})");
  EXPECT_EQ(reason_of({"s", 1, 1.0, "", ""}), "green lies 0.51 m from its zone");
}

TEST_F(RunReport, GivesTheReasonThatAUserEndedTheRun) {
  write_mission(R"({"success": false, "reason": ""})");
  EXPECT_EQ(reason_of({"s", 1, 1.0, "", "ended by user at 46.2 s"}), "ended by user at 46.2 s");
  EXPECT_FALSE(report().contains("error"));
}

TEST_F(RunReport, HasAReasonEvenIfTheReportComponentGivesNone) {
  write_mission(R"({"success": false})");
  EXPECT_EQ(reason_of({"s", 1, 1.0, "", ""}), "the report component gave no reason");
}

// On a disk without space, the verdict is still heard.
TEST_F(RunReport, FilesThatCouldNotBeWrittenChangeNoVerdict) {
  write_mission(R"({"success": true, "files_not_written": ["cannot write a.png: No space", "cannot write b.png: x"]})");
  EXPECT_EQ(write_report(dir_, {}, {}, {}).notices,
            std::vector<std::string>{"files are missing in the report: cannot write a.png: No space; 1 more"});
  fs::remove(dir_ / "report.json");
  fs::create_directory(dir_ / "report.json");
  const RunVerdict verdict = write_report(dir_, {}, {}, {});
  EXPECT_TRUE(verdict.success);
  ASSERT_EQ(verdict.notices.size(), 2u);
  EXPECT_NE(verdict.notices.back().find("report.json"), std::string::npos) << verdict.notices.back();
}

}  // namespace
}  // namespace constrictor::cli
