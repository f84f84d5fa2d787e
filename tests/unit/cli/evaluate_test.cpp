// The parts of `constrictor evaluate`: its statistics, and what it reads from a run.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>

#include "cli/evaluate/mission_result.hpp"
#include "cli/evaluate/page.hpp"
#include "cli/evaluate/result_table.hpp"
#include "cli/evaluate/statistics.hpp"
#include "cli/evaluate/summary.hpp"
#include "cli/evaluate/variation.hpp"
#include "configuration/quantiles.hpp"
#include "constrictor/messages.hpp"
#include "support/temporary_folder.hpp"

namespace constrictor::cli {
namespace {

using nlohmann::json;
using testing::TemporaryFolder;

// Source: R. G. Newcombe, Two-sided confidence intervals for the single proportion, Statistics in Medicine 17 (1998),
// table I, method 3.
TEST(WilsonInterval, HasThePublishedValues) {
  struct Case {
    std::size_t successes, trials;
    double low, high;
  };
  for (const auto& [successes, trials, low, high] : {Case{81, 263, 0.2553, 0.3662}, Case{15, 148, 0.0624, 0.1605},
                                                     Case{0, 20, 0.0, 0.1611}, Case{1, 29, 0.0061, 0.1718}}) {
    const Interval interval = wilson_interval(successes, trials);
    EXPECT_NEAR(interval.low, low, 5e-5) << successes << " of " << trials;
    EXPECT_NEAR(interval.high, high, 5e-5) << successes << " of " << trials;
    const Interval mirrored = wilson_interval(trials - successes, trials);
    EXPECT_NEAR(mirrored.low, 1 - interval.high, 1e-12);
  }
  EXPECT_EQ(wilson_interval(0, 0).low, 0.0);
  EXPECT_EQ(wilson_interval(0, 0).high, 1.0);
}

TEST(Quantile, InterpolatesBetweenTheSortedValues) {
  // numpy.quantile([3, 1, 4, 1, 5, 9, 2, 6], q)
  const std::vector<double> values{3, 1, 4, 1, 5, 9, 2, 6};
  EXPECT_DOUBLE_EQ(interpolated_quantile(values, 0.5), 3.5);
  EXPECT_DOUBLE_EQ(interpolated_quantile(values, 0.25), 1.75);
  EXPECT_DOUBLE_EQ(interpolated_quantile(values, 0.95), 7.95);
  EXPECT_DOUBLE_EQ(interpolated_quantile(values, 0), 1);
  EXPECT_DOUBLE_EQ(interpolated_quantile(values, 1), 9);
  EXPECT_TRUE(std::isnan(interpolated_quantile({}, 0.5)));
}

/// The planner's goal was aborted.
json aborted(double at_s, const std::string& detail) {
  return {{"sim_time_s", at_s},
          {"task", "grasp"},
          {"event", "goal_aborted"},
          {"parameters", {{"goal_id", std::uint64_t{msg::kAuthorityPlanner} << 48}, {"detail", detail}}}};
}

json example_report() {
  return {{"success", false},
          {"believed", "succeeded"},
          {"reason", "green lies 0.51 m from the centre, \"outside\""},
          {"sim_time_s", 102.0},
          {"mission_time_s", 100.0},
          {"wall_time_s", 9.0},
          {"recoveries", 2},
          {"state_hash", "ab"},
          {"line", {{"rms_cross_track_m", 0.05}}},
          {"pose_error", {{"rms_m", nullptr}}},
          {"effort", {{"cost_of_transport", 1.5}}},
          {"objects",
           {{{"colour", "green"}, {"grasped", true}, {"dropped", true}, {"in_zone", false}, {"zone_distance_m", 0.51}},
            {{"colour", "red"}, {"grasped", true}, {"dropped", false}, {"in_zone", false}, {"zone_distance_m", 4.0}}}},
          {"demanded", {"green", "red"}},
          {"states",
           {{{"sim_time_s", 0.0}, {"state", "search object"}},
            {{"sim_time_s", 30.0}, {"state", "grasp"}},
            {{"sim_time_s", 70.0}, {"state", "search object"}}}},
          {"events", {aborted(70.0, "no object between the arms")}}};
}

TEST(MissionResult, IsReadFromTheReport) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "report.json") << example_report();
  const MissionResult result = read_result(folder.path(), 1);
  EXPECT_FALSE(result.success);
  EXPECT_TRUE(result.believed);
  EXPECT_FALSE(result.error());
  EXPECT_EQ(result.recoveries, 2);
  EXPECT_DOUBLE_EQ(result.mission_time_s, 100.0);
  EXPECT_DOUBLE_EQ(result.time_in_state_s.at("search object"), 60.0);
  EXPECT_DOUBLE_EQ(result.time_in_state_s.at("grasp"), 40.0);
  EXPECT_EQ(result.recoveries_by_cause,
            (std::map<std::string, int>{{"grasp: no object between the arms", 1}, {"other", 1}}));
  EXPECT_DOUBLE_EQ(result.longest_recovery.duration_s, 30.0) << "until the end of the mission";
  EXPECT_TRUE(std::isnan(result.rms_pose_error_m));
  EXPECT_TRUE(reached(result, 0));
  EXPECT_FALSE(reached(result, 1));
  EXPECT_FALSE(reached(result, 3));
}

TEST(MissionResult, APhaseIsReachedByTheObjectsThatTheMissionDemands) {
  MissionResult result;
  result.objects = {{"green", true, true, true, 0.1}, {"green", true, false, false, 3.0}, {"red", false, false, false}};
  const auto phases = [&](std::vector<std::string> demanded) {
    result.demanded = std::move(demanded);
    return std::vector<bool>{reached(result, 0), reached(result, 1), reached(result, 2)};
  };
  EXPECT_EQ(phases({"green"}), std::vector<bool>({true, true, true}));
  EXPECT_EQ(phases({"green", "green"}), std::vector<bool>({true, false, false}));
  EXPECT_EQ(phases({"green", "red"}), std::vector<bool>({false, false, false}));
  EXPECT_EQ(phases({}), std::vector<bool>({false, false, false})) << "there is nothing to grasp";
}

TEST(MissionResult, AMissionThatDidNotEndLastsAsLongAsItsRun) {
  const TemporaryFolder folder;
  json report = example_report();
  report["mission_time_s"] = nullptr;
  std::ofstream(folder.path() / "report.json") << report;
  const MissionResult result = read_result(folder.path(), 1);
  EXPECT_DOUBLE_EQ(result.mission_time_s, 102.0);
  EXPECT_DOUBLE_EQ(result.time_in_state_s.at("search object"), 62.0);
}

TEST(MissionResult, WithoutAVerdictIsAnError) {
  const TemporaryFolder folder;
  EXPECT_TRUE(read_result(folder.path(), 1).error()) << "there is no report, for example because the disk was full";
  std::ofstream(folder.path() / "run.log") << "run 2: begins\nthere is no report: the disk is full\n";
  EXPECT_TRUE(read_result(folder.path(), 1).reason.ends_with("there is no report: the disk is full"));
  json report{{"success", false}, {"reason", "time limit"}, {"state_hash", nullptr}, {"states", nullptr}};
  report["members"] = {{{"name", "physics"}}, {{"name", "report"}}};
  std::ofstream(folder.path() / "report.json") << report;
  const MissionResult result = read_result(folder.path(), 1);
  EXPECT_TRUE(result.error());
  EXPECT_NE(result.reason.find("missing in report.json"), std::string::npos) << result.reason;
  report["judged_by"] = "ground truth";
  std::ofstream(folder.path() / "report.json") << report;
  EXPECT_FALSE(read_result(folder.path(), 1).error());
}

TEST(MissionResult, WhateverIsInTheReportDoesNoHarm) {
  const TemporaryFolder folder;
  EXPECT_TRUE(read_result(folder.path(), 70).error());
  const std::string whole = example_report().dump();
  for (const char* text : {"", "[]", "null", "{}", "{\"objects\": 3, \"events\": {\"a\": 1}, \"states\": \"x\"}",
                           "{\"success\": 1, \"recoveries\": 1e300, \"objects\": [null, 3]}"}) {
    std::ofstream(folder.path() / "report.json") << text;
    const MissionResult result = read_result(folder.path(), 1);
    EXPECT_FALSE(result.success) << text;
    EXPECT_EQ(result.recoveries, 0) << text;
  }
  for (std::size_t size = 0; size < whole.size(); size += 7) {
    std::ofstream(folder.path() / "report.json") << whole.substr(0, size);
    EXPECT_EQ(read_result(folder.path(), 1).recoveries, 0) << size;
  }
}

class SummaryTest : public ::testing::Test {
 protected:
  void SetUp() override {
    std::ofstream(folder_.path() / "report.json") << example_report();
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      MissionResult result = read_result(folder_.path(), 1);
      result.seed = seed;
      result.command = "constrictor run";
      if (seed == 4) {
        result = MissionResult();
        result.seed = 4;
        result.exit_status = 70;
      }
      results_.push_back(std::move(result));
    }
    results_[0].success = true;
    results_[0].mission_time_s = 80.0;
  }
  TemporaryFolder folder_;
  std::vector<Variant> variants_ = make_variants({});
  std::vector<MissionResult> results_;
};

TEST_F(SummaryTest, CountsErrorsAsNotSuccessfulAndWhatWasOnlyBelieved) {
  const VariantSummary summary = summarise(variants_, results_).front();
  EXPECT_EQ(summary.runs, 4u);
  EXPECT_EQ(summary.errors, 1u);
  EXPECT_EQ(summary.successes(), 1u);
  EXPECT_EQ(summary.false_successes, 2u);
  EXPECT_EQ(summary.placement_m.values.size(), 3u) << "only of objects that were dropped";
  EXPECT_DOUBLE_EQ(summary.mission_time_s.at(0.5), 80.0) << "of successful missions";
  EXPECT_DOUBLE_EQ(summary.mean_time_in_state_s.at("grasp"), 40.0);
  EXPECT_EQ(summary.recoveries_by_cause.at("grasp: no object between the arms"), 3);
  EXPECT_DOUBLE_EQ(summary.worst_recovery.duration_s, 30.0);
  EXPECT_EQ(summary.worst_seed, 1u) << "the first of equal ones";
  const auto written = to_json({summary}).at(0);
  EXPECT_EQ(written.at("longest_recovery").at("duration_s"), 30.0);
  EXPECT_EQ(written.at("longest_recovery").at("seed"), 1);
  EXPECT_EQ(written.at("phases").at("objects grasped").at("runs"), 3);
}

TEST_F(SummaryTest, CountsWhatThePlannerDidNotNotice) {
  json report = example_report();
  report["all_in_zones"] = true;
  std::ofstream(folder_.path() / "report.json") << report;
  EXPECT_FALSE(read_result(folder_.path(), 1).unnoticed()) << "the planner ended it as succeeded";
  report["believed"] = "failed";
  std::ofstream(folder_.path() / "report.json") << report;
  EXPECT_FALSE(read_result(folder_.path(), 70).unnoticed()) << "the run has failed";
  EXPECT_EQ(to_table(summarise(variants_, results_), 80).find("unnoticed"), std::string::npos);
  results_[1] = read_result(folder_.path(), 1);
  const auto summaries = summarise(variants_, results_);
  EXPECT_EQ(summaries.front().unnoticed_successes, 1u);
  EXPECT_EQ(summaries.front().false_successes, 1u);
  EXPECT_EQ(to_json(summaries).at(0).at("unnoticed_successes"), 1);
  const std::string table = to_table(summaries, 120);
  EXPECT_NE(table.find("  not true  unnoticed  errors"), std::string::npos) << table;
  EXPECT_NE(table.find("(unnoticed: missions that ended without success"), std::string::npos) << table;
  const std::string page = make_page({"short", "about", 4, variants_, results_});
  EXPECT_NE(page.find("true, but not noticed"), std::string::npos);
  EXPECT_NE(page.find("&quot;outside&quot; (all objects lie in their zones)"), std::string::npos);
}

TEST_F(SummaryTest, TheTerminalNamesTheRunWithTheLongestRecovery) {
  results_[1].longest_recovery = {12.0, 45.25, "drop: \"quoted\", and more"};
  EXPECT_NE(
      to_table(summarise(variants_, results_), 80).find("longest recovery: 45.2 s, seed 2, 12.0 s after the start"),
      std::string::npos)
      << to_table(summarise(variants_, results_), 80);
  EXPECT_NE(to_csv(variants_, results_).find(",45.25,\"drop: \"\"quoted\"\", and more\",1 grasp: no object"),
            std::string::npos);
  for (auto& result : results_) result.recoveries = 0, result.longest_recovery = {};
  EXPECT_EQ(to_table(summarise(variants_, results_), 80).find("longest recovery:"), std::string::npos);
  EXPECT_EQ(summarise(variants_, results_).front().longest_recovery_s.at(1.0), 0.0) << "no recovery lasts 0 s";
}

TEST_F(SummaryTest, TheTableOfTheTerminalFitsItsColumnsAndHasNoEmptyOnes) {
  const auto widest = [](const std::string& text) {
    std::size_t most = 0;
    for (std::istringstream lines(text); !lines.eof();) {
      std::string line;
      std::getline(lines, line);
      if (line.find("longest recovery:") != 0) most = std::max(most, line.size());
    }
    return most;
  };
  const std::string wide = to_table(summarise(variants_, results_), 120);
  EXPECT_NE(wide.find("  succeeded       95 %  not true  errors  time"), std::string::npos) << wide;
  EXPECT_EQ(wide.find("refused"), std::string::npos) << "no run was refused\n" << wide;
  variants_[0].name = "module.count=16, objects.0.radius_m=0.05, objects.0.height_m=0.1";
  const std::string narrow = to_table(summarise(variants_, results_), 80);
  EXPECT_LE(widest(narrow), 80u) << narrow;
  EXPECT_NE(narrow.find("\n" + variants_[0].name + "\n"), std::string::npos) << "on a line of its own\n" << narrow;
  for (auto& result : results_) result.exit_status = 0, result.believed = result.success;
  EXPECT_EQ(to_table(summarise(variants_, results_), 80).find("not true"), std::string::npos);
}

TEST_F(SummaryTest, EveryRowOfTheCsvHasAsManyFieldsAsItsHeading) {
  const std::string text = to_csv(variants_, results_);
  // A reader of RFC 4180 that knows nothing about the writer.
  std::vector<std::vector<std::string>> rows(1, {""});
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quoted && c == '"' && text[i + 1] == '"') rows.back().back() += text[++i];
    else if (c == '"') quoted = !quoted;
    else if (!quoted && c == ',') rows.back().emplace_back();
    else if (!quoted && c == '\r') rows.emplace_back(1, ""), ++i;
    else rows.back().back() += c;
  }
  ASSERT_EQ(rows.size(), 6u);  // heading, four runs, and the nothing behind the last line
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(rows[i].size(), rows[0].size()) << i;
  EXPECT_EQ(rows[2][5], "green lies 0.51 m from the centre, \"outside\"");
}

TEST_F(SummaryTest, ThePageShowsTextsAsTheyAre) {
  PageContent page{"<script>alert(1)</script>", "a & b", 5, variants_, results_};
  page.results[1].reason = "\x1b[31m<b>";
  page.variants[0].name = "x<y";
  page.results[2].recoveries_by_cause = {{"drop: <i>lost", 7}};
  const std::string html = make_page(page);
  EXPECT_EQ(html.find("<script>"), std::string::npos);
  EXPECT_EQ(html.find("<b>"), std::string::npos);
  EXPECT_EQ(html.find('\x1b'), std::string::npos);
  EXPECT_NE(html.find("4 of 5 runs are done"), std::string::npos);
  EXPECT_NE(html.find("x&lt;y"), std::string::npos);
  EXPECT_EQ(html.find("nan"), std::string::npos);
  EXPECT_NE(html.find("<td>drop: &lt;i&gt;lost</td><td class=\"n\">7</td>"), std::string::npos);
}

}  // namespace
}  // namespace constrictor::cli
