// The robot on two hosts (namespaces with an sshd each), placed as in deploy/two_hosts.yaml: with keys, continued by
// another launcher, and at real-time pace over a slow link.
#include <cstdlib>
#include <sstream>

#include "integration/long_hosts.hpp"

namespace constrictor::testing {
namespace {

class HostsMission : public LongHosts {
 protected:
  /// Makes two hosts, and writes two_hosts.yaml with the address of host2 on host1.
  void make_two() {
    make(2);
    std::ifstream file(testing::source_path("deploy/two_hosts.yaml"));
    std::string text(std::istreambuf_iterator<char>(file), {});
    const std::string example = "snake@10.0.0.2, directory: /opt/constrictor";
    const auto at = text.find(example);
    ASSERT_NE(at, std::string::npos);
    std::ofstream(hosts_->tmp(1) / "two.yaml") << text.replace(at, example.size(), "root@10.77.0.2");
  }
  [[nodiscard]] Process constrictor(const std::string& words) const {
    return hosts_->on(1, "exec constrictor " + words);
  }
  /// The state hash of the run in one process that computes the same.
  std::string one(const std::string& options) {
    Process run = constrictor("run " + options + " --manifest two.yaml --in-process --report one");
    EXPECT_TRUE(run.wait(300s)) << run.output() << run.errors();
    return report("one").value("state_hash", "none");
  }
};

TEST_F(HostsMission, ASecuredRunOverALossyLinkHasTheResultOfOneProcess) {
  make_two();
  Process keys = constrictor("keys keys --manifest two.yaml");
  ASSERT_EQ(keys.wait(60s), 0) << keys.output() << keys.errors();
  Process doctor = constrictor("doctor --manifest two.yaml --secure keys");
  ASSERT_EQ(doctor.wait(60s), 0) << doctor.output() << doctor.errors();
  hosts_->network("loss 0.01");
  Process run = constrictor("run --manifest two.yaml --secure keys --max-sim-time 4 --report two");
  ASSERT_EQ(run.wait(300s), 1) << run.output() << run.errors();  // the mission is not over after 4 s
  EXPECT_EQ(report("two").value("state_hash", "a"), one("--max-sim-time 4")) << run.output();
  expect_nothing_left(2);
}

TEST_F(HostsMission, ARunWhoseLauncherIsKilledIsContinuedWithTheSameResult) {
  make_two();
  auto run = std::make_unique<Process>(constrictor("run --manifest two.yaml --max-sim-time 20 --report two"));
  for (int i = 0; i < 2; ++i) {
    ASSERT_TRUE(eventually([&] { return newest_tick() > 100 + 300 * i; }, 120s)) << run->output() << run->errors();
    for (const pid_t launcher : hosts_->processes(1, i == 0 ? "--report" : "--resume")) ::kill(launcher, SIGKILL);
    ASSERT_TRUE(run->wait(20s));
    // Once after the agent has given up, once while it still waits.
    if (i == 0) {
      ASSERT_TRUE(eventually([&] { return hosts_->processes(2, "--incarnation").empty(); }, 60s));
    }
    run = std::make_unique<Process>(constrictor("run --resume two"));
  }
  ASSERT_EQ(run->wait(300s), 1) << run->output() << run->errors();
  EXPECT_EQ(report("two").value("state_hash", "a"), one("--max-sim-time 20")) << run->output();
  expect_nothing_left(2);
}

// Ten processes, of which seven are on the other host. The time is only printed, because it depends on the machine.
TEST_F(HostsMission, TenProcessesMakeTheirFirstTick) {
  make_two();
  std::ofstream(hosts_->tmp(1) / "two.yaml", std::ios::app)
      << "  - {components: [overview], program: constrictor_host, host: robot}\n";
  for (const char* delay : {"0 0", "5 1", "25 1"}) {
    hosts_->network(std::string("delay ") + delay);
    const auto begin = std::chrono::steady_clock::now();
    Process run = constrictor("run --manifest two.yaml --max-sim-time 1 --report two");
    const auto ticked = [&] {  // the plant has written more than the header of its hashes
      std::error_code none;
      for (const auto& entry : std::filesystem::directory_iterator(hosts_->tmp(2) / "state/constrictor", none)) {
        if (std::filesystem::file_size(entry.path() / "hashes.bin", none) > 64 && !none) return true;
      }
      return false;
    };
    ASSERT_TRUE(eventually(ticked, 60s)) << run.output() << run.errors();
    const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - begin;
    ASSERT_EQ(run.wait(120s), 1) << run.output() << run.errors();  // the mission is not over after 1 s
    EXPECT_EQ(report("two")["processes"].size(), 10u);
    std::printf("delay %s ms: the first tick after %.1f s\n", delay, passed.count());
    std::fflush(stdout);
  }
  expect_nothing_left(2);
}

TEST_F(HostsMission, AHostThatRebootsComesBackIntoTheRun) {
  make_two();
  const std::string expected = one("--max-sim-time 20");
  Process run = constrictor("run --manifest two.yaml --max-sim-time 20 --report two");
  ASSERT_TRUE(eventually([&] { return newest_tick() > 300; }, 120s)) << run.output() << run.errors();
  hosts_->reboot(2, 20);
  ASSERT_EQ(run.wait(300s), 1) << run.output() << run.errors();  // the mission is not over after 20 s
  EXPECT_GE(report("two").value("wall_time_s", 0.0), 20.0) << "the reboot was in the run";
  EXPECT_EQ(report("two").value("state_hash", "a"), expected) << run.output() << run.errors();
  Process diff = constrictor("diff one two");
  EXPECT_EQ(diff.wait(30s), 0) << diff.output();
  expect_nothing_left(2);
}

// The whole case study. CONSTRICTOR_LINKS ("0/0 10/0.01": round trip in ms / loss) chooses other networks, and
// CONSTRICTOR_MISSION another scenario. The speed is only printed, because it depends on the machine.
TEST_F(HostsMission, TheCaseStudyHasTheResultOfOneProcessOverALossyLink) {
  make_two();
  const char* mission = std::getenv("CONSTRICTOR_MISSION");
  const char* links = std::getenv("CONSTRICTOR_LINKS");
  const std::string scenario = mission ? mission : "case_study";
  const std::string expected = one(scenario);
  ASSERT_EQ(report("one").value("success", false), true) << report("one").value("reason", "");
  std::istringstream list(links ? links : "10/0.01");
  char slash = 0;
  double loss = 0.0;
  for (int round_trip_ms = 0; list >> round_trip_ms >> slash >> loss;) {
    const std::string jitter = round_trip_ms == 0 ? " 0" : " 1";
    hosts_->network("delay " + std::to_string(round_trip_ms / 2) + jitter);
    hosts_->network("loss " + std::to_string(loss));
    Process run = constrictor("run " + scenario + " --manifest two.yaml --report two");
    EXPECT_EQ(run.wait(1200s), 0) << run.output() << run.errors();
    const auto json = report("two");
    EXPECT_EQ(json.value("state_hash", "none"), expected) << round_trip_ms << " ms, loss " << loss;
    std::printf("round trip %2d ms, loss %.2f: %.1f s simulated in %.1f s\n", round_trip_ms, loss,
                json.value("sim_time_s", 0.0), json.value("wall_time_s", 0.0));
    std::fflush(stdout);
  }
  expect_nothing_left(2);
}

TEST_F(HostsMission, BlackoutsChangeNothingInTheCaseStudy) {
  make_two();
  const std::string expected = one("case_study");
  for (const int seconds : {1, 10, 30}) {
    Process run = constrictor("run case_study --manifest two.yaml --report two");
    ASSERT_TRUE(eventually([&] { return newest_tick() > 1000; }, 120s)) << run.output() << run.errors();
    hosts_->network("blackout " + std::to_string(seconds));
    ASSERT_EQ(run.wait(600s), 0) << seconds << " s: " << run.output() << run.errors();
    const auto json = report("two");
    EXPECT_EQ(json.value("state_hash", "none"), expected) << seconds << " s";
    for (const auto& process : json["processes"]) EXPECT_EQ(process["restarts"], 0) << process;
    std::printf("black-out of %2d s: %.1f s simulated in %.1f s\n", seconds, json.value("sim_time_s", 0.0),
                json.value("wall_time_s", 0.0));
    std::fflush(stdout);
  }
  expect_nothing_left(2);
}

// CONSTRICTOR_MISSION and CONSTRICTOR_SEEDS ("1 2 3") choose other missions. At real-time pace a tick that control
// leaves out is an overrun; on a busy host the load itself causes some, so that the figure is only printed.
TEST_F(HostsMission, AtRealTimePacePerceptionAndPlannerMayBe50MsAway) {
  make_two();
  hosts_->network("delay 25 1");
  hosts_->network("loss 0.01");
  const char* mission = std::getenv("CONSTRICTOR_MISSION");
  const char* seeds = std::getenv("CONSTRICTOR_SEEDS");
  std::istringstream list(seeds ? seeds : "1");
  for (int seed = 0; list >> seed;) {
    Process run = constrictor("run " + std::string(mission ? mission : "line") + " --seed " + std::to_string(seed) +
                              " --manifest two.yaml --pace realtime --report two");
    EXPECT_EQ(run.wait(600s), 0) << "seed " << seed << ": " << run.output() << run.errors();
    const auto json = report("two");
    EXPECT_TRUE(json.value("success", false)) << json.value("reason", "");
    std::printf("seed %d: %.1f s simulated in %.1f s;", seed, json.value("sim_time_s", 0.0),
                json.value("wall_time_s", 0.0));
    for (const auto& process : json["processes"])
      std::printf(" %s %d", process["name"].get<std::string>().c_str(), process["overruns"].get<int>());
    std::printf(" ticks left out\n");
    std::fflush(stdout);
  }
}

}  // namespace
}  // namespace constrictor::testing
