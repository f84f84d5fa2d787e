// The programs of the core alone: which libraries they need, and what the command says about a group that is missing.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <set>

#include "cli/program_groups.hpp"
#include "runtime/host.hpp"
#include "support/process.hpp"
#include "support/temporary_folder.hpp"

namespace constrictor::testing {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

TEST(CorePrograms, LoadNoLibraryOfAnotherGroup) {
  for (const char* name : {"physics", "camera", "perception", "guidance", "navigation", "control", "input", "planner",
                           "report", "constrictor_host", "constrictor"}) {
    Process ldd({"/usr/bin/ldd", program(name)});
    ASSERT_EQ(ldd.wait(30s), 0) << ldd.errors();
    ASSERT_NE(ldd.output().find("libddsc"), std::string::npos) << name;
    for (const char* library : {"opencv_imgcodecs", "opencv_videoio", "opencv_calib3d", "opencv_highgui", "libgdal",
                                "libavcodec", "libgst", "libpython", "libcairo", "libpango"})
      EXPECT_EQ(ldd.output().find(library), std::string::npos) << name << " loads " << library;
  }
}

TEST(CorePrograms, TheScriptsAcceptEachGroup) {
  std::set<std::string> groups;
  for (const auto& [name, group] : cli::program_groups()) groups.insert(group);
  ASSERT_TRUE(groups.contains("hardware"));
  Process setup({source_path("scripts/setup.sh").string(), "no_such_group"});
  EXPECT_EQ(setup.wait(30s), exit_status::kUsage);
  Process build({source_path("scripts/build.sh").string(), "--no-such-group"});
  EXPECT_EQ(build.wait(30s), exit_status::kUsage);
  for (const auto& group : groups) {
    EXPECT_NE(setup.errors().find(" " + group + ","), std::string::npos) << setup.errors();
    EXPECT_NE(build.errors().find(" --" + group + " "), std::string::npos) << build.errors();
  }
}

TEST(CorePrograms, TheHelpOfAScriptInstallsAndBuildsNothing) {
  for (const char* script : {"scripts/run.sh", ".ci/run"}) {
    Process help({source_path(script).string(), "--help"});
    EXPECT_EQ(help.wait(10s), exit_status::kOk) << script;
    EXPECT_NE(help.output().find(std::string("\nUsage: ") + script + " ["), std::string::npos) << help.output();
    EXPECT_EQ(help.output().find("build: "), std::string::npos) << help.output();
  }
}

/// A folder that contains only the programs of the core that the command itself needs.
class MissingGroups : public ::testing::Test {
 protected:
  MissingGroups() {
    for (const char* name : {"constrictor", "constrictor_host"}) fs::copy_file(program(name), dir_ / name);
  }
  /// Expects that the command refuses these arguments, and names the commands that install and build the group.
  void expect_refused(std::vector<std::string> arguments, int status, const std::string& missing,
                      const std::string& group) const {
    arguments.insert(arguments.begin(), (dir_ / "constrictor").string());
    Process refused(arguments, {{"XDG_RUNTIME_DIR", dir_.string()}});
    EXPECT_EQ(refused.wait(30s), status) << arguments[1] << refused.output() << refused.errors();
    EXPECT_EQ(refused.output(), "") << arguments[1];
    for (const std::string& said : {missing + " belongs to the group of programs '" + group + "', which was not built",
                                    "./scripts/setup.sh " + group + " && ./scripts/build.sh --" + group})
      EXPECT_NE(refused.errors().find(said), std::string::npos) << said << " in: " << refused.errors();
    EXPECT_FALSE(fs::exists(dir_ / "report")) << "no run may be started";
  }

  TemporaryFolder folder_;
  fs::path dir_ = folder_.path();
};

TEST_F(MissingGroups, ARunNamesTheCommandsThatBuildItsPrograms) {
  const std::string report = (dir_ / "report").string();
  const int refused = exit_status::kConfiguration;
  const std::string served = (dir_ / "real_servos.yaml").string();
  std::ofstream(served) << "plant: servo_bus\nreal_time: true\nrobot: components/lib/robot/mamba.yaml\n"
                           "scenario: sim/scenarios/line.yaml\nprocesses:\n"
                           "  - components: [servo_bus]\n  - components: [guidance]\n";
  expect_refused({"run", "--manifest", "emulated_hardware", "--report", report}, refused, "servo_emulator", "hardware");
  expect_refused({"check", "--manifest", "outside_plant"}, refused, "plant_relay", "hardware");
  expect_refused({"serve", "servo_bus", "--domain", "9", "--manifest", served}, refused, "servo_bus", "hardware");
  expect_refused({"run", "--view", "--report", report}, refused, "dashboard", "web");
  expect_refused({"host", "guidance,servo_bus"}, refused, "servo_bus", "hardware");
}

// constrictor_host contains the components of the core, so that it can check their files; their programs are missing.
TEST_F(MissingGroups, AProgramOfTheCoreThatWasNotBuiltIsFoundBeforeARunStarts) {
  const auto command = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), (dir_ / "constrictor").string());
    return Process(arguments, {{"XDG_RUNTIME_DIR", dir_.string()}});
  };
  const std::string report = (dir_ / "report").string();
  for (const auto& arguments :
       std::initializer_list<std::vector<std::string>>{{"check"}, {"run", "--report", report}}) {
    Process refused = command(arguments);
    EXPECT_EQ(refused.wait(30s), exit_status::kConfiguration) << refused.output() << refused.errors();
    EXPECT_NE(refused.errors().find("process physics: found no program " + (dir_ / "physics").string()),
              std::string::npos)
        << refused.errors();
  }
  EXPECT_FALSE(fs::exists(report)) << "no run may be started";
  fs::copy_file(program("physics"), dir_ / "physics");
  Process next = command({"check"});
  EXPECT_EQ(next.wait(30s), exit_status::kConfiguration);
  EXPECT_EQ(next.errors().find("process physics"), std::string::npos) << next.errors();
}

TEST_F(MissingGroups, ASubcommandNamesTheCommandsThatBuildItsProgram) {
  const int missing = exit_status::kSoftware;
  expect_refused({"camera", "--help"}, missing, "camera_setup", "hardware");
  expect_refused({"conform", "plant", "--domain", "5"}, missing, "conform", "hardware");
  expect_refused({"dashboard"}, missing, "dashboard", "web");
}

TEST_F(MissingGroups, TheCommandItselfIsComplete) {
  for (const std::vector<std::string>& arguments : std::initializer_list<std::vector<std::string>>{
           {"--version"}, {"--help"}, {"completion", "bash"}, {"list", "components"}, {"man-pages", dir_ / "man"}}) {
    std::vector<std::string> words = {(dir_ / "constrictor").string()};
    words.insert(words.end(), arguments.begin(), arguments.end());
    Process command(words);
    EXPECT_EQ(command.wait(30s), exit_status::kOk) << arguments[0] << command.errors();
  }
}

}  // namespace
}  // namespace constrictor::testing
