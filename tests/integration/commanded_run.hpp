// A run without camera and perception, which a test commands by the command line.
#pragma once

#include "integration/run_watcher.hpp"
#include "runtime/host.hpp"

namespace constrictor::testing {

class CommandedRun : public CliFixture {
 protected:
  /// Starts a run of these processes, and waits until it ticks.
  [[nodiscard]] Process run(const std::string& pace, const std::string& processes = kBlindProcesses) {
    write("run.yaml", case_study_manifest(20, processes));
    Process process =
        start({"run", "--manifest", (dir_ / "run.yaml").string(), "--report", (dir_ / "r").string(), "--pace", pace});
    EXPECT_TRUE(process.wait_for("simulated", std::chrono::seconds(30))) << process.output() << process.errors();
    return process;
  }
  void end(Process& launcher) {
    EXPECT_EQ(command({"end"}), exit_status::kOk) << output_;
    EXPECT_EQ(launcher.wait(std::chrono::seconds(10)), 128 + SIGTERM);
  }
};

}  // namespace constrictor::testing
