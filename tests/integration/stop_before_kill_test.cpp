// An emergency stop that the plant has received is obeyed by its successor, although no tick came between the stop and
// the death of the process.
#include <signal.h>

#include "cli_fixture.hpp"
#include "runtime/host.hpp"

namespace constrictor::testing {
namespace {

using namespace std::chrono_literals;

class StopBeforeKill : public CliFixture {};

TEST_F(StopBeforeKill, TheSuccessorOfThePlantObeysAStopThatItHasReceived) {
  Process run = start({"run", "short", "--in-process", "--pace", "realtime", "--max-sim-time", "60", "--report",
                       (dir_ / "r").string()});
  std::optional<pid_t> plant;
  const auto find_plant = [&] {
    Process status = start({"status", "--json"});
    if (domain() == 0 || status.wait(20s) != exit_status::kOk) return false;
    const auto state = nlohmann::json::parse(status.output());
    for (const auto& one : state["components"])
      if (one["component"] == "physics") plant = one["pid"].get<pid_t>();
    return plant.has_value();
  };
  ASSERT_TRUE(eventually(find_plant, 30s)) << run.output() << run.errors();
  ASSERT_EQ(command({"pause"}), exit_status::kOk) << output_;
  // Nobody can confirm it: the run makes no tick.
  EXPECT_EQ(command({"stop"}), exit_status::kWaitedTooLong) << output_;
  EXPECT_NE(output_.find("the plant has received the stop"), std::string::npos) << output_;

  ASSERT_EQ(::kill(*plant, SIGKILL), 0);
  EXPECT_TRUE(eventually([&] { return command({"resume"}) == exit_status::kOk; }, 60s)) << output_;
  EXPECT_TRUE(eventually(
      [&] {
        return command({"topic", "echo", "emergency_stop/state", "--count", "1", "--timeout", "5"}) ==
                   exit_status::kOk &&
               output_.find("stopped: true") != std::string::npos;
      },
      20s))
      << output_;
  EXPECT_EQ(command({"end"}), exit_status::kOk) << output_;
  EXPECT_TRUE(run.wait(30s));
}

}  // namespace
}  // namespace constrictor::testing
