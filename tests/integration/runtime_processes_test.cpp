// The runtime with toy components as real processes: same result in any grouping, after kills, stops and pauses; clear
// refusals. Toy components mix every input into every output, so one lost or doubled message changes the result.
#include <gtest/gtest.h>
#include <signal.h>

#include <fstream>
#include <random>
#include <thread>

#include "runtime/dds/domain.hpp"
#include "runtime/dds/endpoint.hpp"
#include "runtime/dds/wire.hpp"
#include "runtime/domain_claim.hpp"
#include "runtime/host.hpp"
#include "support/process.hpp"
#include "support/temporary_folder.hpp"

namespace constrictor::testing {
namespace {

using namespace std::chrono_literals;

const std::string kRoster = "physics,navigation,control,planner,report";
const std::vector<std::string> kEach = {"physics", "navigation", "control", "planner", "report"};

/// A run of the toys; `groups` are the processes.
struct ToyRun {
  DomainClaim claim;
  long ticks;
  std::vector<std::string> extra;
  std::map<std::string, Process> processes;

  explicit ToyRun(long run_ticks, std::vector<std::string> options = {}) : ticks(run_ticks), extra(std::move(options)) {}

  void start(const std::string& group, int incarnation = 1, const std::map<std::string, std::string>& environment = {},
             const std::string& roster = kRoster) {
    std::vector<std::string> arguments = {program("toy_host"), group, "--domain", std::to_string(claim.domain()), "--roster", roster,
                                          "--scenario", std::to_string(ticks), "--robot", "", "--incarnation", std::to_string(incarnation)};
    arguments.insert(arguments.end(), extra.begin(), extra.end());
    processes.insert_or_assign(group, Process(arguments, environment));
  }
  void start_all(const std::vector<std::string>& groups) {
    for (const auto& group : groups) start(group);
  }
  /// Waits until an incarnation of a member has done a step.
  [[nodiscard]] bool wait_for_step_of(const std::string& component, std::uint32_t incarnation) const {
    return wait_for_step_of(dds::Domain(claim.domain()), component, incarnation);
  }
  [[nodiscard]] static bool wait_for_step_of(const dds::Domain& domain, const std::string& component, std::uint32_t incarnation) {
    const auto reader = dds::Reader<msg::ComponentStatus>::member(domain.participant(), dds::barrier_topics::kStatus);
    bool seen = false;
    for (int i = 0; i < 4000 && !seen; ++i) {
      reader.take([&](const msg::ComponentStatus& s) { seen |= s.component == component && s.incarnation == incarnation && s.tick >= 0; });
      std::this_thread::sleep_for(5ms);
    }
    return seen;
  }
  /// Waits for the report's result; the empty string if anything failed.
  std::string result(std::chrono::seconds bound = 60s) {
    std::string text;
    for (auto& [group, process] : processes) {
      const auto status = process.wait(bound);
      if (status != exit_status::kOk) ADD_FAILURE() << group << " ended with " << status.value_or(-1) << ": " << process.errors();
      text += process.output();
    }
    return text;
  }
};

std::string reference(long ticks) {
  ToyRun run(ticks);
  run.start_all({kRoster});
  return run.result();
}

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

TEST(RuntimeProcesses, EachMemberButThePlantMayBeKilledAtAnyTick) {
  const long ticks = 4000;
  const std::string expected = reference(ticks);
  std::mt19937 random(20261121);
  for (const std::string victim : {"navigation", "control", "planner"}) {
    ToyRun run(ticks, {"--pace", "30"});  // 2.7 s at least: nobody is killed when it is over, for nobody would resume him
    run.start_all(kEach);
    int kills = 0;
    for (int incarnation = 2; incarnation < 8; ++incarnation) {
      std::this_thread::sleep_for(std::chrono::microseconds(20'000 + random() % 150'000));  // somewhere in the run
      if (!run.processes.at("physics").running()) break;
      run.processes.at(victim).signal(SIGKILL);
      ASSERT_TRUE(run.processes.at(victim).wait(10s));
      run.start(victim, incarnation);
      ++kills;
    }
    EXPECT_EQ(run.result(), expected) << victim << " after " << kills << " kills";
    EXPECT_GE(kills, 3) << "the run was over too soon to mean anything";
  }
}

// The members of such a process are resumed one by one.
TEST(RuntimeProcesses, AProcessOfSeveralMembersMayBeKilledAtAnyTick) {
  const long ticks = 4000;
  const std::string expected = reference(ticks);
  std::mt19937 random(20261122);
  const std::string victim = "navigation,control,planner";
  ToyRun run(ticks, {"--patience", "20", "--pace", "20"});  // 4 s at least, longer than the kills
  run.start_all({"physics,report", victim});
  int kills = 0;
  for (int incarnation = 2; incarnation < 11; ++incarnation) {
    std::this_thread::sleep_for(std::chrono::microseconds(20'000 + random() % 200'000));  // before, while and after it joins
    if (!run.processes.at("physics,report").running()) break;
    run.processes.at(victim).signal(SIGKILL);
    ASSERT_TRUE(run.processes.at(victim).wait(10s));
    run.start(victim, incarnation);
    ++kills;
  }
  EXPECT_EQ(run.result(), expected) << "after " << kills << " kills";
  EXPECT_GE(kills, 6) << "the run was over too soon to mean anything";
}

TEST(RuntimeProcesses, AnyProcessMayBeStoppedAndContinued) {
  const std::string expected = reference(3000);
  for (const std::string& stopped : kEach) {
    ToyRun run(3000);
    run.start_all(kEach);
    std::this_thread::sleep_for(250ms);
    run.processes.at(stopped).signal(SIGSTOP);
    std::this_thread::sleep_for(2s);
    run.processes.at(stopped).signal(SIGCONT);
    EXPECT_EQ(run.result(), expected) << stopped;
  }
}

TEST(RuntimeProcesses, CappedPaceGivesTheSameResult) {
  const std::string expected = reference(100);
  ToyRun run(100, {"--pace", "4"});
  const auto start = std::chrono::steady_clock::now();
  run.start_all(kEach);
  EXPECT_EQ(run.result(), expected);
  EXPECT_GE(std::chrono::steady_clock::now() - start, 480ms);  // 100 ticks of 20 ms at four times real time
}

// Whoever is seldom due, and whoever has to wait long for the next tick, is not stuck.
TEST(RuntimeProcesses, ASlowPaceIsNoStall) {
  const auto run_at = [](long ticks, std::vector<std::string> options) {
    ToyRun run(ticks, std::move(options));
    const std::string roster = kRoster + ",overview";
    for (const auto& name : kEach) run.start(name, 1, {}, roster);
    run.start("overview", 1, {}, roster);
    const std::string result = run.result();
    for (const auto& [group, process] : run.processes) EXPECT_EQ(process.errors().find("gave up"), std::string::npos) << process.errors();
    return result;
  };
  EXPECT_EQ(run_at(60, {"--pace", "0.2", "--patience", "4"}), run_at(60, {}));    // 5 s between two steps of overview
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

TEST(RuntimeProcesses, RealtimePaceWaitsForNobodyAndCountsWhatWasSkipped) {
  ToyRun run(150, {"--realtime"});
  const dds::Domain domain(run.claim.domain());
  const auto statuses = dds::Reader<msg::ComponentStatus>::member(domain.participant(), dds::barrier_topics::kStatus);
  std::map<std::string, std::uint64_t> skipped;
  std::map<std::string, bool> ended;
  const auto listen = [&] {
    statuses.take([&](const msg::ComponentStatus& status) {
      skipped[status.component] = status.overruns;
      ended[status.component] = status.state == msg::kComponentEnded;
    });
  };
  const auto start = std::chrono::steady_clock::now();
  run.start_all(kEach);
  ASSERT_TRUE(run.wait_for_step_of(domain, "planner", 1));
  run.processes.at("planner").signal(SIGSTOP);  // lock-step would stand still for as long
  EXPECT_EQ(run.processes.at("report").wait(20s), exit_status::kOk);
  const auto elapsed = std::chrono::steady_clock::now() - start;
  run.processes.at("planner").signal(SIGCONT);
  EXPECT_NE(run.result().find("result"), std::string::npos);
  EXPECT_GE(elapsed, 2900ms);  // 150 ticks of 20 ms on the wall clock
  EXPECT_LE(elapsed, 8s);
  for (int i = 0; i < 1000 && !ended["planner"]; ++i) {
    listen();
    std::this_thread::sleep_for(5ms);
  }
  ASSERT_TRUE(ended["planner"]);
  // It was stopped for all but its first step or few, and did the last tick alone. A busy machine may cost the others some.
  EXPECT_GT(skipped["planner"], 75u);
  EXPECT_LT(skipped["planner"], 150u);
  for (const std::string other : {"physics", "navigation", "control", "report"}) {
    ASSERT_TRUE(skipped.contains(other)) << other;
    EXPECT_LT(skipped[other], 20u) << other;
  }
  EXPECT_EQ(skipped["physics"], 0u) << "who makes the ticks misses none";
}

TEST(RuntimeProcesses, ASecondMemberOfOneNameIsRefusedAndTheRunGoesOn) {
  const std::string expected = reference(2000);
  ToyRun run(2000, {"--pace", "8"});  // 5 s at least
  run.start_all(kEach);
  ASSERT_TRUE(run.wait_for_step_of("navigation", 1));
  Process second({program("toy_host"), "navigation", "--domain", std::to_string(run.claim.domain()), "--roster", kRoster,
                  "--scenario", "2000", "--robot", ""});
  EXPECT_EQ(second.wait(20s), exit_status::kRefused);
  EXPECT_NE(second.errors().find("two members of one name"), std::string::npos) << second.errors();
  EXPECT_EQ(run.result(), expected);
}

TEST(RuntimeProcesses, AMissingMemberIsNamedAndTheOthersGiveUp) {
  ToyRun run(100, {"--patience", "4"});
  run.start_all({"physics", "navigation", "control", "report"});
  for (auto& [group, process] : run.processes) EXPECT_EQ(process.wait(20s), exit_status::kWaitedTooLong) << group;
  EXPECT_NE(run.processes.at("physics").errors().find("waits for Hello of planner"), std::string::npos)
      << run.processes.at("physics").errors();
}

// Whoever stands in for a member with a writer that does not suit is told so by that writer's own QoS.
TEST(RuntimeProcesses, AnEndpointThatDoesNotSuitIsNamedWithItsQos) {
  const DomainClaim claim;
  const dds::Domain domain(claim.domain());
  const auto hellos = dds::Reader<msg::Hello>::member(domain.participant(), dds::barrier_topics::kHello);
  const dds::Writer<msg::Hello> hello(domain.participant(), dds::barrier_topics::kHello, 1);
  Process physics({program("toy_host"), "physics", "--domain", std::to_string(claim.domain()), "--roster", "physics,control", "--robot", ""});
  msg::Hello control{};
  for (int i = 0; i < 4000 && control.incarnation == 0; ++i) {
    hellos.take([&](const msg::Hello& message) { control = message; });
    std::this_thread::sleep_for(5ms);
  }
  ASSERT_EQ(control.incarnation, 1u) << physics.errors();
  dds::set_text(control.component, "control");
  control.pid = ::getpid();
  control.reads = 0;
  control.writes = std::uint64_t{1} << topics::kJointCommand.id;
  hello.write(control);
  const std::string here = "joint_command: the reader here (reliable, transient-local, keep-all) has not met the writer of control";
  EXPECT_TRUE(physics.wait_for(here + ", which is not there", 20s)) << physics.errors();

  const dds::Entity topic(dds_create_topic(domain.participant(), &dds::descriptor<msg::JointCommand>(), "joint_command", nullptr, nullptr),
                          "dds_create_topic");
  const dds::Qos qos = dds::make_qos();
  dds_qset_reliability(qos.get(), DDS_RELIABILITY_BEST_EFFORT, 0);
  dds_qset_durability(qos.get(), DDS_DURABILITY_TRANSIENT_LOCAL);
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, 3);
  const auto write_as = [&](const std::string& name) {
    dds_qset_userdata(qos.get(), name.data(), name.size());
    return dds::Entity(dds_create_writer(domain.participant(), topic.get(), qos.get(), nullptr), "dds_create_writer");
  };
  {
    const dds::Entity named = write_as("control");
    EXPECT_TRUE(physics.wait_for(here + " (best effort, transient-local, keep-last 3); reliability: the writer offers best effort, the reader "
                                        "wants reliable", 20s)) << physics.errors();
  }
  dds_qset_reliability(qos.get(), DDS_RELIABILITY_RELIABLE, DDS_SECS(1));
  {
    const dds::Entity nameless = write_as("");
    EXPECT_TRUE(physics.wait_for("there is a writer without a name (reliable, transient-local, keep-last 3); its user data must be 'control'",
                                 20s)) << physics.errors();
  }
  const dds::Entity suits = write_as("control");
  EXPECT_TRUE(physics.wait_for("waits for Ready of control", 20s)) << "the only thing left to say: " << physics.errors();
}

TEST(RuntimeProcesses, AnotherNumericProfileIsRefused) {
  ToyRun run(100, {"--patience", "6"});
  run.start_all({"physics", "navigation", "control", "report"});
  run.start("planner", 1, {{"GLIBC_TUNABLES", "glibc.malloc.perturb=0"}});
  EXPECT_EQ(run.processes.at("planner").wait(20s), exit_status::kRefused);
  EXPECT_NE(run.processes.at("planner").errors().find("numeric profile differs"), std::string::npos);
}

TEST(RuntimeProcesses, MaskingMoreOfTheCpuInsideTheProfileChangesNothing) {
  const std::string expected = reference(300);
  ToyRun run(300);
  run.start_all({"physics", "navigation", "control", "report"});
  run.start("planner", 1, {{"GLIBC_TUNABLES", "glibc.cpu.hwcaps=-FMA,-FMA4,-AVX2,-AVX,-AVX512F,-SSE4_2,-ERMS"}});
  EXPECT_EQ(run.result(), expected);
}

TEST(RuntimeProcesses, AnotherRosterIsRefused) {
  ToyRun run(100, {"--patience", "6"});
  run.start_all({"physics", "navigation", "control", "report"});
  run.start("planner", 1, {}, "physics,navigation,control,planner");
  EXPECT_EQ(run.processes.at("planner").wait(20s), exit_status::kRefused);
  EXPECT_NE(run.processes.at("planner").errors().find("configuration hash differs"), std::string::npos);
}

// What it reads at its start is part of the run: a change shows when it comes back, not in the result.
TEST(RuntimeProcesses, AMemberThatComesBackWithAnotherConfigurationIsRefused) {
  const TemporaryFolder folder;
  const std::filesystem::path config = folder.path() / "planner.yaml";
  std::ofstream(config) << "first: 1\n";
  ToyRun run(100'000, {"--config", "planner=" + config.string(), "--patience", "20"});
  run.start_all(kEach);
  ASSERT_TRUE(run.wait_for_step_of("planner", 1));
  run.processes.at("planner").signal(SIGKILL);
  run.processes.at("planner").wait(10s);
  run.start("planner", 2);
  ASSERT_TRUE(run.wait_for_step_of("planner", 2)) << "the same file is welcome";
  std::ofstream(config) << "first: 2\n";
  run.processes.at("planner").signal(SIGKILL);
  run.processes.at("planner").wait(10s);
  run.start("planner", 3);
  EXPECT_EQ(run.processes.at("planner").wait(20s), exit_status::kRefused);
  EXPECT_NE(run.processes.at("planner").errors().find("its configuration or scenario file is not the one that the run began with"), std::string::npos)
      << run.processes.at("planner").errors();
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
