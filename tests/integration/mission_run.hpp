// A fixture for tests that run a whole mission with each component in its own process, and check the run's report.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "runtime/host.hpp"
#include "support/process.hpp"
#include "support/temporary_folder.hpp"

namespace constrictor::testing {

class MissionRun : public ::testing::Test {
 protected:
  /// Runs a scenario to its end and reads its report into `report_`. Returns the exit status; -1: the run hangs.
  int run(const std::string& scenario, double most_s, std::vector<std::string> more = {}) {
    write("report.yaml", "max_sim_time_s: " + std::to_string(most_s) +
                             "\nsettle_s: 2.0\ntorque_decimation_ticks: 5\ntorque_window_s: 30\n");
    std::vector<std::string> arguments = {program("constrictor"),
                                          "run",
                                          scenario,
                                          "--report",
                                          (dir_ / "out").string(),
                                          "--config",
                                          "report=" + (dir_ / "report.yaml").string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    Process process(std::move(arguments));
    const int status = process.wait(std::chrono::seconds(560)).value_or(-1);
    output_ = process.output() + process.errors();
    report_ = nlohmann::json::parse(std::ifstream(dir_ / "out" / "report.json"), nullptr, false);
    return status;
  }
  /// The same, and expects that the mission succeeds. Without a report the test ends.
  void succeeds(const std::string& scenario, double most_s) {
    EXPECT_EQ(run(scenario, most_s), exit_status::kOk) << output_;
    ASSERT_TRUE(report_.is_object()) << output_;
  }
  std::string scenario(const std::string& text) {
    write("scenario.yaml", text);
    return (dir_ / "scenario.yaml").string();
  }
  void write(const std::string& name, const std::string& text) const { std::ofstream(dir_ / name) << text; }

  /// Time of the first event of this name at or after `from_s`; NaN if there is none.
  [[nodiscard]] double event_s(const std::string& name, double from_s = 0.0) const {
    return first(report_["events"], "event", name, from_s);
  }
  [[nodiscard]] double state_s(const std::string& name, double from_s = 0.0) const {
    return first(report_["states"], "state", name, from_s);
  }

  /// Expects that something happened at `at_s`, and that the mission came into this state because of it.
  void expect_state_at(const std::string& state, double at_s) const {
    ASSERT_TRUE(std::isfinite(at_s)) << report_["events"];
    EXPECT_NEAR(state_s(state, at_s - 0.05), at_s, 0.05);
  }

  const TemporaryFolder folder_;
  const std::filesystem::path dir_ = folder_.path();
  std::string output_;
  nlohmann::json report_;

 private:
  static double first(const nlohmann::json& list, const char* key, const std::string& name, double from_s) {
    for (const auto& entry : list) {
      if (entry[key] == name && entry["sim_time_s"] >= from_s) return entry["sim_time_s"];
    }
    return std::numeric_limits<double>::quiet_NaN();
  }
};

}  // namespace constrictor::testing
