// `constrictor robot export`: the examples of its help, what it writes, and what it refuses.
#include "integration/run_command_fixture.hpp"

namespace constrictor::testing {
namespace {

class RobotExport : public RunCommand {};

TEST_F(RobotExport, TheExamplesOfItsHelpWork) {
  EXPECT_EQ(run_examples({"robot", "export"}), 5);
  EXPECT_NE(
      read("mamba.urdf").find("<mesh filename=\"file://" + fs::canonical(dir_).string() + "/meshes/module.stl\"/>"),
      std::string::npos);
  EXPECT_NE(read("mamba.xml").find("<mujoco model=\"mamba\">"), std::string::npos);
  EXPECT_NE(read("serpens.xml").find("<mujoco model=\"serpens\">"), std::string::npos);
  EXPECT_NE(read("mamba.sdf").find("<model name=\"mamba\">"), std::string::npos);
  Process check({"/usr/bin/check_urdf", (dir_ / "mamba.urdf").string()});
  ASSERT_EQ(check.wait(20s), 0) << check.errors() << " (liburdfdom-tools is installed by scripts/setup.sh tests)";
  EXPECT_NE(check.output().find("root Link: base_link has 2 child(ren)"), std::string::npos) << check.output();
  EXPECT_NE(check.output().find("module_23"), std::string::npos);
}

TEST_F(RobotExport, KeepsAMeshThatIsNotItsOwn) {
  const auto export_with_mesh = [&] {
    Process made =
        command({"robot", "export", "--urdf", "--meshes", dir_.string(), "--output", (dir_ / "robot.urdf").string()});
    EXPECT_EQ(made.wait(20s), exit_status::kOk) << made.errors();
    return made.errors();
  };
  EXPECT_EQ(export_with_mesh(), "");
  const std::string own = read("module.stl");
  EXPECT_GT(own.size(), 1000u);
  EXPECT_EQ(export_with_mesh(), "") << "its own mesh is replaced";
  write("module.stl", "solid mine");
  EXPECT_NE(export_with_mesh().find("is kept, because it is a mesh of your own"), std::string::npos);
  EXPECT_EQ(read("module.stl"), "solid mine");
}

TEST_F(RobotExport, WritesTheSameToAFileAsToTheStandardOutput) {
  Process printed = command({"robot", "export", "--mjcf", "--robot", "serpens"});
  EXPECT_EQ(printed.wait(20s), exit_status::kOk) << printed.errors();
  write("old.xml", std::string(100'000, 'x'));
  Process written =
      command({"robot", "export", "--mjcf", "--robot", "serpens", "--output", (dir_ / "old.xml").string()});
  EXPECT_EQ(written.wait(20s), exit_status::kOk) << written.errors();
  EXPECT_EQ(written.output(), "");
  EXPECT_EQ(read("old.xml"), printed.output()) << "an existing file is replaced";
}

TEST_F(RobotExport, RefusesWrongOptionsRobotsAndFiles) {
  struct Case {
    std::vector<std::string> options;
    int status;
    std::string said;
  };
  write("robot.yaml", "name: none\n");
  const std::string missing = (dir_ / "no_such_folder" / "robot.xml").string();
  const std::vector<Case> cases = {
      {{}, exit_status::kUsage, "[--mjcf,--urdf,--sdf]"},
      {{"--urdf", "--sdf"}, exit_status::kUsage, "[--mjcf,--urdf,--sdf]"},
      {{"--urdf", "mamba"}, exit_status::kUsage, "mamba"},
      {{"--mjcf", "--meshes", "meshes"}, exit_status::kUsage, "--meshes"},
      {{"--urdf", "--mesh-uri", "package://p"}, exit_status::kUsage, "--meshes"},
      {{"--urdf", "--meshes", "/dev/null/meshes"}, exit_status::kSoftware, "/dev/null/meshes"},
      {{"--mjfc"}, exit_status::kUsage, "--mjcf"},
      {{"--mjcf", "mamba"}, exit_status::kUsage, "mamba"},
      {{"--mjcf", "--robot", "mambo"}, exit_status::kConfiguration, "robot: found 'mambo'"},
      {{"--mjcf", "--robot", (dir_ / "robot.yaml").string()}, exit_status::kConfiguration, "robot.yaml:1: module: "},
      {{"--mjcf", "--output", missing}, exit_status::kSoftware, missing + ": No such file or directory"},
      {{"--mjcf", "--output", dir_.string()}, exit_status::kSoftware, dir_.string() + ": Is a directory"},
      {{"--mjcf", "--output", "/dev/full"}, exit_status::kSoftware, "/dev/full: No space left on device"},
  };
  for (const auto& [options, status, said] : cases) {
    std::vector<std::string> arguments = {"robot", "export"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    Process refused = command(arguments);
    EXPECT_EQ(refused.wait(20s), status) << said << refused.output() << refused.errors();
    EXPECT_NE(refused.errors().find(said), std::string::npos) << said << " in: " << refused.errors();
    EXPECT_EQ(refused.output(), "") << said;
  }
  Process full({"/bin/sh", "-c", program("constrictor") + " robot export --mjcf > /dev/full"}, environment_);
  EXPECT_EQ(full.wait(20s), exit_status::kSoftware);
  EXPECT_NE(full.errors().find("the standard output: No space left on device"), std::string::npos) << full.errors();
}

}  // namespace
}  // namespace constrictor::testing
