// A run from the installed package.
#include <algorithm>

#include "example_run.hpp"

namespace constrictor::testing {
namespace {

using namespace std::chrono_literals;

TEST_F(ExampleRun, ARunFromThePrefixUsesTheFilesOfThePrefix) {
  Process launcher = run("short", {"--pace", "2x", "--max-sim-time", "4"});
  ASSERT_GT(domain_of(launcher), 0u) << launcher.output() << launcher.errors();
  // Programs and files alike, although the source tree still exists.
  std::string command_line;
  ASSERT_TRUE(eventually([&] {
    for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
      std::ifstream file(entry.path() / "cmdline");
      const std::string line{std::istreambuf_iterator<char>(file), {}};
      if (line.find("/control") < line.find('\0') && line.find(dir_.string()) != std::string::npos) command_line = line;
    }
    return !command_line.empty();
  }));
  std::replace(command_line.begin(), command_line.end(), '\0', ' ');
  EXPECT_EQ(command_line.rfind(CONSTRICTOR_PREFIX "/libexec/constrictor/control ", 0), 0u) << command_line;
  EXPECT_NE(command_line.find("--robot " CONSTRICTOR_PREFIX "/share/constrictor/components/lib/robot/mamba.yaml"),
            std::string::npos)
      << command_line;
  EXPECT_NE(command_line.find("--scenario " CONSTRICTOR_PREFIX "/share/constrictor/sim/scenarios/short.yaml"),
            std::string::npos)
      << command_line;
  ASSERT_TRUE(launcher.wait(60s));
  EXPECT_NE(launcher.output().find("4.0 s simulated"), std::string::npos) << launcher.output() << launcher.errors();
}

TEST_F(ExampleRun, ThePythonPackageOfThePrefixIsImported) {
  const std::string folder = CONSTRICTOR_PREFIX "/lib/python3/dist-packages";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "this build has no Python package";
  Process python({"/usr/bin/python3", "-B", "-c", "import constrictor; print(constrictor.__file__)"},
                 {{"PYTHONPATH", folder}});
  EXPECT_EQ(python.wait(30s), 0) << python.errors();
  EXPECT_EQ(python.output(), folder + "/constrictor/__init__.py\n");
}

}  // namespace
}  // namespace constrictor::testing
