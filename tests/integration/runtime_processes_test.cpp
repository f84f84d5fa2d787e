// Runs of toy components as real processes: the result is the same in any grouping of components, and after kills and
// stops. Each toy mixes every input into every output, so one lost or doubled message changes the result.
#include <gtest/gtest.h>
#include <signal.h>

#include <random>
#include <regex>
#include <thread>

#include "integration/toy_run.hpp"

namespace constrictor::testing {
namespace {

TEST(RuntimeProcesses, EveryGroupingGivesTheSameResult) {
  const std::string expected = reference(300);
  ASSERT_NE(expected.find("result"), std::string::npos);
  for (const std::vector<std::string>& groups :
       {kEach, {"physics,control", "navigation,planner", "report"}, {"physics", "navigation,control,planner,report"}}) {
    ToyRun run(300);
    run.start_all(groups);
    EXPECT_EQ(run.result(), expected);
  }
}

// A datagram for each message would need half as much CPU time again (components/lib/cyclone/README.md).
TEST(RuntimeProcesses, SendAllMessagesOfAStepToAProcessAsOneDatagram) {
  const int ticks = 300;
  ToyRun run(ticks);
  run.start_all(kEach);
  ASSERT_NE(run.result().find("result"), std::string::npos);
  for (const auto& [name, process] : run.processes) {
    const std::string log = process.errors();
    std::smatch found;
    ASSERT_TRUE(std::regex_search(log, found, std::regex("sent (\\d+) messages of its steps in (\\d+) datagrams")))
        << name << ": " << log;
    const int messages = std::stoi(found[1]);
    const int datagrams = std::stoi(found[2]);
    EXPECT_LE(datagrams, (ticks + 2) * static_cast<int>(kEach.size() - 1)) << name;
    if (name != "physics") continue;
    EXPECT_GT(messages, 4 * datagrams / 3) << "Cyclone DDS does not call the sendmsg of the program";
  }
}

TEST(RuntimeProcesses, EachMemberExceptThePlantMayBeKilledAtAnyTick) {
  const long ticks = 4000;
  const std::string expected = reference(ticks);
  std::mt19937 random(20261121);
  for (const std::string victim : {"navigation", "control", "planner"}) {
    ToyRun run(ticks, {"--pace", "30"});  // at least 2.7 s: a member that is killed after the end cannot be resumed
    run.start_all(kEach);
    int kills = 0;
    for (int incarnation = 2; incarnation < 8; ++incarnation) {
      std::this_thread::sleep_for(
          std::chrono::microseconds(20'000 + random() % 150'000));  // at a random time in the run
      if (!run.processes.at("physics").running()) break;
      run.processes.at(victim).signal(SIGKILL);
      ASSERT_TRUE(run.processes.at(victim).wait(10s));
      run.start(victim, incarnation);
      ++kills;
    }
    EXPECT_EQ(run.result(), expected) << victim << " after " << kills << " kills";
    EXPECT_GE(kills, 3) << "the run ended before enough kills";
  }
}

// The members of such a process are resumed one after the other.
TEST(RuntimeProcesses, AProcessOfSeveralMembersMayBeKilledAtAnyTick) {
  const long ticks = 4000;
  const std::string expected = reference(ticks);
  std::mt19937 random(20261122);
  const std::string victim = "navigation,control,planner";
  ToyRun run(ticks, {"--patience", "20", "--pace", "20"});  // 4 s at least, longer than the kills
  run.start_all({"physics,report", victim});
  int kills = 0;
  for (int incarnation = 2; incarnation < 11; ++incarnation) {
    std::this_thread::sleep_for(
        std::chrono::microseconds(20'000 + random() % 200'000));  // before, while and after the process joins
    if (!run.processes.at("physics,report").running()) break;
    run.processes.at(victim).signal(SIGKILL);
    ASSERT_TRUE(run.processes.at(victim).wait(10s));
    run.start(victim, incarnation);
    ++kills;
  }
  EXPECT_EQ(run.result(), expected) << "after " << kills << " kills";
  EXPECT_GE(kills, 6) << "the run ended before enough kills";
}

TEST(RuntimeProcesses, AnyProcessMayBeStoppedAndContinued) {
  const std::string expected = reference(2000);
  for (const std::string& stopped : kEach) {
    ToyRun run(2000, {"--pace", "20"});  // at least 2 s, so that the process is stopped before the end
    run.start_all(kEach);
    ASSERT_TRUE(run.wait_for_step_of(stopped, 1)) << stopped;
    run.processes.at(stopped).signal(SIGSTOP);
    const bool plant = stopped == "physics";
    Process& waiter = run.processes.at(plant ? "navigation" : "physics");
    EXPECT_TRUE(waiter.wait_for(plant ? "waits for Tick of physics" : "waits for TickDone of " + stopped, 20s))
        << stopped << ": " << waiter.errors();
    run.processes.at(stopped).signal(SIGCONT);
    EXPECT_EQ(run.result(), expected) << stopped;
  }
}

// As a virtual machine that is stopped, or a computer that sleeps.
TEST(RuntimeProcesses, AFreezeOfAllProcessesLongerThanThePatienceEndsNoRun) {
  const std::string expected = reference(1000);
  ToyRun run(1000, {"--pace", "10", "--patience", "2"});
  run.start_all(kEach);
  ASSERT_TRUE(run.wait_for_step_of("report", 1));
  for (auto& [group, process] : run.processes) process.signal(SIGSTOP);
  std::this_thread::sleep_for(2500ms);  // nothing happens meanwhile for which the test could wait
  for (auto& [group, process] : run.processes) process.signal(SIGCONT);
  EXPECT_EQ(run.result(), expected);
}

TEST(RuntimeProcesses, CappedPaceGivesTheSameResult) {
  const std::string expected = reference(100);
  ToyRun run(100, {"--pace", "4"});
  const auto start = std::chrono::steady_clock::now();
  run.start_all(kEach);
  EXPECT_EQ(run.result(), expected);
  EXPECT_GE(std::chrono::steady_clock::now() - start, 480ms);  // 100 ticks of 20 ms at four times real time
}

// A member must not give up because its steps are far apart or because it waits long for the next tick.
TEST(RuntimeProcesses, NoMemberGivesUpAtASlowPace) {
  const auto run_at = [](long ticks, std::vector<std::string> options) {
    ToyRun run(ticks, std::move(options));
    const std::string roster = kRoster + ",overview";
    for (const auto& name : kEach) run.start(name, 1, {}, roster);
    run.start("overview", 1, {}, roster);
    std::string result = run.result();
    for (const auto& [group, process] : run.processes)
      EXPECT_EQ(process.errors().find("gave up"), std::string::npos) << process.errors();
    return result;
  };
  EXPECT_EQ(run_at(60, {"--pace", "0.2", "--patience", "4"}), run_at(60, {}));  // 5 s between two steps of overview
  EXPECT_EQ(run_at(2, {"--pace", "0.005", "--patience", "3"}), run_at(2, {}));  // 4 s between two ticks
}

TEST(RuntimeProcesses, AnEmergencyStopKeepsTheOperatorsPace) {
  const std::string roster = kRoster + ",input";
  ToyRun run(150);
  const auto start = std::chrono::steady_clock::now();
  run.start(roster, 1, {}, roster);
  EXPECT_NE(run.result().find("result"), std::string::npos);
  EXPECT_GE(std::chrono::steady_clock::now() - start, 2500ms);  // from tick 20 on, 20 ms each
}

TEST(RuntimeProcesses, RealtimePaceDoesNotWaitForMembersAndCountsSkippedSteps) {
  ToyRun run(150, {"--realtime"});
  const dds::Domain domain(run.claim.domain());
  const auto statuses = dds::Reader<msg::ComponentStatus>::member(domain.participant(), barrier_topics::kStatus);
  std::map<std::string, std::uint64_t> skipped;
  std::map<std::string, bool> ended;
  std::map<std::string, double> late_us;
  std::uint64_t ticks = 0;  // on a busy machine the report asks for the end a few ticks late
  const auto listen = [&] {
    statuses.take([&](const msg::ComponentStatus& status) {
      skipped[status.component] = status.overruns;
      late_us[status.component] = status.jitter_max_us;
      if (std::string_view(status.component) == "physics") ticks = static_cast<std::uint64_t>(status.tick + 1);
      ended[status.component] = status.state == msg::kComponentEnded;
    });
  };
  const auto start = std::chrono::steady_clock::now();
  run.start_all(kEach);
  ASSERT_TRUE(run.wait_for_step_of(domain, "planner", 1));
  run.processes.at("planner").signal(SIGSTOP);  // in lock-step the run would wait for this member
  const auto report_ended = [&] {
    listen();
    return ended["report"];
  };
  EXPECT_TRUE(eventually(report_ended, 20s));
  const auto elapsed = std::chrono::steady_clock::now() - start;
  run.processes.at("planner").signal(SIGCONT);
  EXPECT_NE(run.result().find("result"), std::string::npos);
  EXPECT_GE(elapsed, 2900ms);  // 150 ticks of 20 ms on the wall clock
  EXPECT_LE(elapsed, 8s);
  ASSERT_TRUE(eventually([&] {
    listen();
    return ended["planner"] && ended["physics"];
  }));
  // The planner was stopped after its first few steps, and then did only the last tick. The others skip a tick only
  // where the machine was too busy for their process, so always fewer than the process that stood still.
  EXPECT_GT(skipped["planner"], 75u);
  EXPECT_LT(skipped["planner"], ticks);
  for (const std::string other : {"physics", "navigation", "control", "report"}) {
    ASSERT_TRUE(skipped.contains(other)) << other;
    EXPECT_LT(skipped[other], skipped["planner"]) << other;
  }
  EXPECT_EQ(skipped["physics"], 0u) << "the plant skips no tick";
  for (const auto& [name, us] : late_us) {
    EXPECT_GT(us, 0.0) << name << ": of 150 ticks, at least one comes later than a period after the one before";
    EXPECT_LT(us, 1e-3 * static_cast<double>(std::chrono::nanoseconds(elapsed).count())) << name;
  }
}

TEST(RuntimeProcesses, MaskedCpuFeaturesWithinTheSameNumericProfileDoNotChangeTheResult) {
  const std::string expected = reference(300);
  ToyRun run(300);
  run.start_all({"physics", "navigation", "control", "report"});
  run.start("planner", 1, {{"GLIBC_TUNABLES", "glibc.cpu.hwcaps=-FMA,-FMA4,-AVX2,-AVX,-AVX512F,-SSE4_2,-ERMS"}});
  EXPECT_EQ(run.result(), expected);
}

TEST(RuntimeProcesses, SigtermEndsEveryProcessWithinTwoSeconds) {
  ToyRun run(1'000'000);
  run.start_all(kEach);
  ASSERT_TRUE(run.wait_for_step_of("report", 1));
  for (auto& [group, process] : run.processes) process.signal(SIGTERM);
  for (auto& [group, process] : run.processes) EXPECT_EQ(process.wait(2s), exit_status::kOk) << group;
}

}  // namespace
}  // namespace constrictor::testing
