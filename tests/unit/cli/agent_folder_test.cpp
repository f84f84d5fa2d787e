// Folders of the agents that follow each other in the same run.
#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <memory>

#include "cli/remote/agent.hpp"
#include "support/temporary_folder.hpp"

namespace constrictor::cli {
namespace {

// An agent that had ended removed its folder a second time, and with it what the agent of the continued run had made:
// the run was not found then.
TEST(AgentFolder, AnAgentThatHasEndedLeavesTheFolderOfItsSuccessorAlone) {
  const constrictor::testing::TemporaryFolder home;
  for (const char* name : {"XDG_RUNTIME_DIR", "XDG_STATE_HOME"}) ::setenv(name, home.path().c_str(), 1);
  auto first = std::make_unique<Agent>("run");
  ::raise(SIGTERM);  // the agent has blocked it, and reads it
  EXPECT_EQ(first->run(), 0);
  EXPECT_FALSE(std::filesystem::exists(agent_folder("run")));
  const Agent second("run");
  first.reset();
  EXPECT_TRUE(std::filesystem::exists(agent_folder("run") / "output"));
  EXPECT_TRUE(std::filesystem::exists(agent_folder("run") / "socket"));
}

}  // namespace
}  // namespace constrictor::cli
