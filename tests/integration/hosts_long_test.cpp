// Runs on two and three hosts (namespaces with an sshd each) over a network that loses, delays and reorders frames.
// Each run is started with `constrictor run` alone, and has the result of one process.
#include <cstdlib>

#include "integration/long_hosts.hpp"

namespace constrictor::testing {
namespace {

TEST_F(LongHosts, LossDelayAndReorderingChangeNoResult) {
  make(2);
  write_toys();
  struct Link {
    int delay_ms;
    long ticks;
  };
  for (const auto& [delay_ms, ticks] : {Link{0, 1000}, Link{10, 150}, Link{50, 50}}) {
    const std::string expected = reference(ticks);
    for (const char* loss : {"0", "0.01", "0.05"}) {
      hosts_->network("loss 0");
      hosts_->network("delay " + std::to_string(delay_ms) + (delay_ms == 0 ? " 0" : " 2"));
      hosts_->network(std::string("loss ") + loss);
      rate(ticks, expected, "delay " + std::to_string(delay_ms) + " ms, loss " + loss);
    }
  }
  hosts_->network("delay 10 5");
  hosts_->network("loss 0.01");
  hosts_->network("reorder 0.05");
  rate(150, reference(150), "delay 10 to 15 ms, loss 0.01, reorder 0.05");
  expect_nothing_left(2);
}

TEST_F(LongHosts, BlackoutsOfLessThanThePatienceOnlyDelayARun) {
  make(2);
  write_toys();
  const std::string expected = reference(400);
  for (const int seconds : {1, 10, 30}) {
    Process run = toys(400, "run", "--pace 1x");  // on a busy machine it takes seconds to see that ticks advance
    ASSERT_TRUE(eventually([&] { return newest_tick() > 20; }, 60s)) << run.output();
    hosts_->network("blackout " + std::to_string(seconds));
    ASSERT_EQ(run.wait(120s), 0) << seconds << " s: " << run.output() << run.errors();
    const auto json = report("run");
    EXPECT_EQ(json.value("state_hash", ""), expected) << seconds << " s";
    EXPECT_GE(json.value("wall_time_s", 0.0), seconds) << "the black-out was in the run";
    for (const auto& process : json["processes"]) EXPECT_EQ(process["restarts"], 0) << process;
    std::printf("black-out of %2d s: a run of 8 s took %.1f s\n", seconds, json.value("wall_time_s", 0.0));
  }
  expect_nothing_left(2);
}

// The runs alternate, so that the load of the machine acts on both kinds.
TEST_F(LongHosts, LostMessagesAreRepeatedInTimeForFourTimesTheTicksOfCyclonesTimes) {
  make(2);
  write_toys();
  const std::string expected = reference(600);
  hosts_->network("loss 0.01");
  double ours_s = 0, default_s = 0;
  for (int i = 0; i < 3; ++i) {
    ours_s += 600 / rate(600, expected, "loss 0.01");
    default_s += 600 / rate(600, expected, "loss 0.01, Cyclone's times", kDefaultTimes);
  }
  EXPECT_GE(default_s / ours_s, 4.0);
}

TEST_F(LongHosts, CommandsOnAnotherHostJoinARunWithoutSetUp) {
  make(2);
  write_toys();
  Process run = toys(100'000, "run", "--pace 1x --domain 9");
  ASSERT_TRUE(eventually([&] { return newest_tick() > 20; }, 60s)) << run.output();
  Process topics = hosts_->on(2, "exec constrictor topic echo joint_command --run 9 --count 1");
  EXPECT_EQ(topics.wait(30s), 0) << topics.output() << topics.errors();
  Process nodes = hosts_->on(2, "exec constrictor node list --run 9");
  EXPECT_EQ(nodes.wait(30s), 0);
  for (const char* host : {"host1", "host2"}) EXPECT_NE(nodes.output().find(host), std::string::npos) << nodes.output();
  Process end = hosts_->on(1, "exec constrictor end");
  EXPECT_EQ(end.wait(60s), 0) << end.output() << end.errors();
  expect_nothing_left(2);
}

TEST_F(LongHosts, WhenTheLauncherDiesOrTheHostIsAwayForTooLongNothingIsLeft) {
  make(2);
  write_toys(8);
  Process killed = toys(100'000, "killed", "--pace 1x");
  ASSERT_TRUE(eventually([&] { return hosts_->processes(2, "toy_host").size() == 3; }, 60s)) << killed.output();
  for (const pid_t launcher : hosts_->processes(1, "killed")) ::kill(launcher, SIGKILL);
  expect_nothing_left(2, true);
  Process away = toys(100'000, "away", "--pace 1x");
  ASSERT_TRUE(eventually([&] { return hosts_->processes(2, "toy_host").size() == 3; }, 60s)) << away.output();
  hosts_->network("blackout 60");
  const auto status = away.wait(60s);
  ASSERT_TRUE(status);
  EXPECT_NE(*status, 0) << away.output();
  expect_nothing_left(2, true);
  expect_nothing_left(1);
}

// With CONSTRICTOR_WHOLE_MISSION in the environment, to the end of the mission instead of the first 4 s.
TEST_F(LongHosts, TheSnakeOnThreeHostsHasTheResultOfOneProcess) {
  const bool whole = std::getenv("CONSTRICTOR_WHOLE_MISSION") != nullptr;
  make(3);
  std::ofstream(hosts_->tmp(1) / "three.yaml")
      << "plant: physics\nrobot: components/lib/robot/mamba.yaml\nscenario: sim/scenarios/case_study.yaml\n"
         "hosts: {robot: {ssh: root@10.77.0.2, interface: ctap2}, eye: {ssh: root@10.77.0.3, directory: "
         "/opt/constrictor}}\nprocesses:\n"
         "  - {components: [physics], host: robot}\n  - {components: [camera], host: eye}\n"
         "  - {components: [perception], host: eye}\n  - {components: [guidance], host: robot}\n"
         "  - {components: [navigation]}\n  - {components: [control], host: robot}\n"
         "  - {components: [input]}\n  - {components: [planner]}\n  - {components: [report], host: eye}\n";
  Process doctor = hosts_->on(1, "exec constrictor doctor --manifest three.yaml");
  ASSERT_EQ(doctor.wait(60s), 0) << doctor.output() << doctor.errors();
  // The second and the third host cannot reach each other, although both reach the launcher.
  ASSERT_EQ(hosts_->on(3, "ip route add blackhole " + NamespaceHosts::address(2) + "/32").wait(10s), 0);
  Process parted = hosts_->on(1, "exec constrictor doctor --manifest three.yaml");
  EXPECT_EQ(parted.wait(60s), 1) << parted.output() << parted.errors();
  EXPECT_NE(parted.output().find("no packet from 10.77.0.3 to UDP port 7660 of robot (10.77.0.2) came back"),
            std::string::npos)
      << parted.output();
  EXPECT_NE(parted.output().find("no packet from 10.77.0.2 to UDP port 7660 of eye (10.77.0.3) came back"),
            std::string::npos)
      << parted.output();
  ASSERT_EQ(hosts_->on(3, "ip route del blackhole " + NamespaceHosts::address(2) + "/32").wait(10s), 0);
  hosts_->network("loss 0.01");
  const std::string run =
      std::string("exec constrictor run --manifest three.yaml ") + (whole ? "" : "--max-sim-time 4 ");
  // The mission is not over after 4 s: the exit status is that of a mission that did not succeed.
  const int status = whole ? 0 : 1;
  Process three = hosts_->on(1, run + "--report three");
  ASSERT_EQ(three.wait(whole ? 1200s : 300s), status) << three.output() << three.errors();
  Process one = hosts_->on(1, run + "--in-process --report one");
  ASSERT_EQ(one.wait(120s), status) << one.output() << one.errors();
  Process diff = hosts_->on(1, "exec constrictor diff one three");
  EXPECT_EQ(diff.wait(30s), 0) << diff.output();
  EXPECT_EQ(report("three").value("state_hash", "a"), report("one").value("state_hash", "b"));
  int files = 0;  // those of the plant on host2, and of the report on host3
  for (const auto& entry : std::filesystem::recursive_directory_iterator(hosts_->tmp(1) / "one")) {
    const auto path = std::filesystem::relative(entry.path(), hosts_->tmp(1) / "one");
    if (!entry.is_regular_file() || path.begin()->string() == "logs") continue;
    EXPECT_TRUE(std::filesystem::exists(hosts_->tmp(1) / "three" / path)) << path;
    ++files;
  }
  EXPECT_GE(files, 4);
  EXPECT_EQ(report("three")["hosts"].size(), 3u);
  std::printf("three hosts, 1 %% loss: %.1f s simulated in %.1f s\n", report("three").value("sim_time_s", 0.0),
              report("three").value("wall_time_s", 0.0));
}

}  // namespace
}  // namespace constrictor::testing
