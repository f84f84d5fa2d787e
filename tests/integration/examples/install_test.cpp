// The installed package.
#include <algorithm>

#include "example_run.hpp"

namespace constrictor::testing {
namespace {

using namespace std::chrono_literals;

TEST_F(ExampleRun, ARunFromThePrefixUsesThePrefixsFiles) {
  Process launcher = run("short", {"--pace", "2x", "--max-sim-time", "4"});
  ASSERT_GT(domain_of(launcher), 0u) << launcher.output() << launcher.errors();
  // Programs and files alike, although the source tree still exists.
  std::string command_line;
  const auto end = std::chrono::steady_clock::now() + 10s;
  while (command_line.empty() && std::chrono::steady_clock::now() < end) {
    for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
      std::ifstream file(entry.path() / "cmdline");
      const std::string line{std::istreambuf_iterator<char>(file), {}};
      if (line.find("/control") < line.find('\0') && line.find(dir_.string()) != std::string::npos) command_line = line;
    }
  }
  std::replace(command_line.begin(), command_line.end(), '\0', ' ');
  EXPECT_EQ(command_line.rfind(CONSTRICTOR_PREFIX "/libexec/constrictor/control ", 0), 0u) << command_line;
  EXPECT_NE(command_line.find("--robot " CONSTRICTOR_PREFIX "/share/constrictor/components/robot/mamba.yaml"), std::string::npos) << command_line;
  EXPECT_NE(command_line.find("--scenario " CONSTRICTOR_PREFIX "/share/constrictor/sim/scenarios/short.yaml"), std::string::npos) << command_line;
  ASSERT_TRUE(launcher.wait(60s));
  EXPECT_NE(launcher.output().find("4.0 s simulated"), std::string::npos) << launcher.output() << launcher.errors();
}

}  // namespace
}  // namespace constrictor::testing
