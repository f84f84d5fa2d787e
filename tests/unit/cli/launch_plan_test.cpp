// Errors that make_launch_plan() finds before a run starts, and the command lines that it makes for the processes. Some
// files are those of the project, others are written by the tests.
#include "cli/launch_plan.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "cli/usage.hpp"
#include "configuration/configuration.hpp"
#include "support/project.hpp"
#include "support/temporary_folder.hpp"

namespace constrictor::cli {
namespace {

class LaunchPlanTest : public ::testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_.path() / name) << text;
    return (folder_.path() / name).string();
  }
  /// The reason why the options are refused, or the empty string if they are accepted.
  static std::string error(const RunOptions& options) {
    try {
      static_cast<void>(make_launch_plan(options));
    } catch (const ConfigurationError& error) {
      return error.what();
    } catch (const UsageError& error) {
      return std::string("usage: ") + error.what();
    }
    return "";
  }
  static void expect_refused(const RunOptions& options, std::initializer_list<std::string> parts) {
    for (const auto& part : parts)
      EXPECT_NE(error(options).find(part), std::string::npos) << part << ": " << error(options);
  }

  const testing::TemporaryFolder folder_;
  RunOptions options_;
};

TEST_F(LaunchPlanTest, FindsFilesByTheirNames) {
  options_.scenario = "line";
  options_.robot = "serpens";
  const LaunchPlan plan = make_launch_plan(options_);
  EXPECT_EQ(plan.manifest.scenario_file.filename(), "line.yaml");
  EXPECT_EQ(plan.manifest.robot_file.filename(), "serpens.yaml");
  EXPECT_TRUE(plan.manifest.scenario_file.is_absolute());
}

TEST_F(LaunchPlanTest, EachListedManifestCanBeLoaded) {
  const std::vector<std::string> names = names_of(kManifests);
  for (const std::string& name : names) {
    SCOPED_TRACE(name);
    EXPECT_FALSE(load_manifest(find_file(name, kManifests)).processes.empty());
  }
  std::vector<std::string> manifests;
  for (const auto& entry : std::filesystem::directory_iterator(testing::source_path("deploy"))) {
    if (entry.path().extension() == ".yaml") manifests.push_back(entry.path().stem());
  }
  std::sort(manifests.begin(), manifests.end());
  EXPECT_EQ(names, manifests);
  for (const char* name : {"case_study", "case_study_fast", "emulated_servos", "two_hosts"})
    EXPECT_EQ(std::count(names.begin(), names.end(), name), 1) << name;
}

TEST_F(LaunchPlanTest, ARealPlantFollowsTheWallClock) {
  options_.manifest = "emulated_servos";
  const LaunchPlan plan = make_launch_plan(options_);
  ASSERT_EQ(plan.manifest.beside.size(), 1u);
  EXPECT_EQ(plan.manifest.beside[0].program, "servo_emulator");
  const auto line = make_command_line(options_, plan, 7, "r", 1)(plan.manifest.processes[0], 1);
  EXPECT_EQ(std::count(line.begin(), line.end(), "--realtime"), 1);
  options_.pace = "2x";
  EXPECT_THROW(static_cast<void>(make_launch_plan(options_)), UsageError);
}

TEST_F(LaunchPlanTest, ImagesOfARealCameraCannotBeComputedAgain) {
  options_.manifest = "emulated_hardware";
  options_.record = true;
  EXPECT_EQ(make_launch_plan(options_).manifest.beside.size(), 2u);
  options_.images = "recompute";
  EXPECT_THROW(static_cast<void>(make_launch_plan(options_)), UsageError);
  options_.manifest = "case_study";
  static_cast<void>(make_launch_plan(options_));
}

// The robot's computer has the loop from joints to commands; what it need not wait for has a latency.
TEST_F(LaunchPlanTest, TheExampleOfTwoHostsPutsComponentsWhereTheyBelong) {
  options_.manifest = "two_hosts";
  const LaunchManifest manifest = make_launch_plan(options_).manifest;
  EXPECT_EQ(manifest.hosts.size(), 1u);
  EXPECT_EQ(manifest.host_of_plant(), "robot");
  for (const auto& process : manifest.processes) {
    const std::string& name = process.components.front();
    const bool far = name == "perception" || name == "planner" || name == "report";
    EXPECT_EQ(process.host, far ? "" : "robot") << name;
    EXPECT_EQ(manifest.latency_ticks.contains(name), far) << name;
  }
  options_.in_process = true;
  const LaunchManifest one = make_launch_plan(options_).manifest;
  EXPECT_TRUE(one.hosts.empty());
  EXPECT_EQ(one.host_of_plant(), "");
  EXPECT_EQ(one.latency_ticks, manifest.latency_ticks) << "the same run";
}

TEST_F(LaunchPlanTest, RefusesNamesThatDoNotExistAndProposesTheClosest) {
  options_.scenario = "lime";
  expect_refused(options_, {"scenario: found 'lime'", "case_study, channel", "did you mean 'line'?"});
  options_.scenario = "manual";
  expect_refused(options_, {"there is a manifest of this name: constrictor run --manifest manual"});
  options_ = {};
  options_.robot = "momba";
  expect_refused(options_, {"robot: found 'momba'", "did you mean 'mamba'?"});
  options_ = {};
  options_.manifest = "manuel";
  expect_refused(options_, {"manifest: found 'manuel'", "did you mean 'manual'?"});
}

TEST_F(LaunchPlanTest, RefusesAConfigurationOfAComponentThatIsNotInTheRoster) {
  options_.config_files = {"nav=" + write("nav.yaml", "")};
  expect_refused(options_,
                 {"--config: found component 'nav'", "accepted physics, camera", "did you mean 'navigation'?"});
}

TEST_F(LaunchPlanTest, RefusesAConfigurationFileThatDoesNotExist) {
  options_.config_files = {"navigation=missing.yaml"};
  expect_refused(options_, {"--config navigation: found no file /", "missing.yaml"});
  options_ = {};
  options_.manifest = write("manifest.yaml",
                            "plant: physics\nrobot: components/lib/robot/mamba.yaml\n"
                            "scenario: sim/scenarios/line.yaml\nprocesses:\n"
                            "  - {components: [physics, control], config: {control: missing.yaml}}\n");
  expect_refused(options_, {"manifest: config of control: found no file /", "missing.yaml"});
}

TEST_F(LaunchPlanTest, RefusesConfigurationsThatAreNotNameAndFile) {
  for (const char* text : {"navigation", "=file.yaml", "navigation="}) {
    options_.config_files = {text};
    expect_refused(options_, {"usage: --config", "accepted NAME=FILE"});
  }
}

TEST_F(LaunchPlanTest, RefusesAProgramThatIsNoExecutableFile) {
  const std::string program = write("not_executable", "#!/bin/sh\n");
  options_.manifest = write("m.yaml",
                            "plant: physics\nrobot: components/lib/robot/mamba.yaml\nscenario: "
                            "sim/scenarios/line.yaml\nprocesses:\n  - {components: [physics], program: " +
                                program + "}\n");
  expect_refused(options_, {"process physics: found program " + program, "accepted an executable file"});
}

TEST_F(LaunchPlanTest, RefusesTextsThatAreNoPace) {
  for (const char* pace : {"fast", "", "0x", "-1x", "2", "nanx", "infx", "2xx", "0.0001x", "1001x"}) {
    options_.pace = pace;
    expect_refused(options_, {"usage: --pace", "accepted lockstep, realtime"});
  }
  for (const char* pace : {"lockstep", "realtime", "2x", "0.5x", "1000x"}) {
    options_.pace = pace;
    EXPECT_EQ(error(options_), "") << pace;
  }
}

TEST_F(LaunchPlanTest, TheRosterDoesNotDependOnTheGroupingIntoProcesses) {
  const LaunchPlan each = make_launch_plan(options_);
  options_.groups = {"report,physics"};
  const LaunchPlan grouped = make_launch_plan(options_);
  options_.groups.clear();
  options_.in_process = true;
  const LaunchPlan one = make_launch_plan(options_);
  EXPECT_EQ(each.roster, grouped.roster);
  EXPECT_EQ(each.roster, one.roster);
  EXPECT_EQ(each.manifest.processes.size(), each.roster.size());
  EXPECT_EQ(grouped.manifest.processes.size(), each.roster.size() - 1);
  EXPECT_EQ(one.manifest.processes.size(), 1u);
}

TEST_F(LaunchPlanTest, OnlyRealTimePaceAsksForScheduling) {
  LaunchPlan plan = make_launch_plan(options_);
  plan.manifest.processes[0].scheduling = {5, true, {0, 2}};
  const auto arguments = [&] {
    const auto line = make_command_line(options_, plan, 7, "r", 1)(plan.manifest.processes[0], 1);
    return fmt::format("{}", fmt::join(line, " "));
  };
  EXPECT_EQ(arguments().find("--priority"), std::string::npos);
  options_.pace = "realtime";
  EXPECT_NE(arguments().find("--priority 5 --lock-memory --cpus 0,2"), std::string::npos) << arguments();
}

TEST_F(LaunchPlanTest, CommandLinesNameTheConfigurationOfTheHostedComponentsOnly) {
  const std::string file = write("mine.yaml", "");
  options_.config_files = {"planner=" + file};
  options_.max_sim_time_s = 7.5;
  const LaunchPlan plan = make_launch_plan(options_);
  const CommandLine command_line = make_command_line(options_, plan, 5, "/tmp/r", 42);
  const auto joined = [&](const std::string& name, std::uint32_t incarnation) {
    for (const auto& process : plan.manifest.processes) {
      if (process.name() != name) continue;
      std::string text;
      for (const auto& argument : command_line(process, incarnation)) text += argument + " ";
      return text;
    }
    return std::string();
  };
  EXPECT_NE(joined("planner", 3).find("/planner --domain 5 --roster physics,camera,"), std::string::npos);
  EXPECT_NE(joined("planner", 3).find("--incarnation 3 --config planner=" + file), std::string::npos);
  EXPECT_NE(joined("planner", 3).find("--mission "), std::string::npos)
      << "the planner must receive the mission file instead of the scenario";
  EXPECT_NE(joined("report", 1).find("--max-sim-time 7.5"), std::string::npos)
      << "the report component needs the limit to name it as the reason";
  EXPECT_NE(joined("physics", 1).find("--max-sim-time 7.5"), std::string::npos);
  EXPECT_EQ(joined("physics", 1).find("--config"), std::string::npos);
}

}  // namespace
}  // namespace constrictor::cli
