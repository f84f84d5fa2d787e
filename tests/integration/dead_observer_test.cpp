// Observers that were killed or stopped, and never acknowledge a message again: the run must end as soon as without
// them, and lose nothing.
#include <csignal>

#include "constrictor/topics.hpp"
#include "cyclone/acknowledgements.hpp"
#include "cyclone/domain.hpp"
#include "cyclone/domain_claim.hpp"
#include "cyclone/endpoint.hpp"
#include "integration/cli_fixture.hpp"
#include "runtime/host.hpp"
#include "runtime/wire.hpp"

namespace constrictor::testing {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

class DeadObserver : public CliFixture, public ::testing::WithParamInterface<int> {
 protected:
  DeadObserver() {
    write("toys.yaml",
          "plant: physics\nrobot: components/lib/robot/mamba.yaml\nscenario: sim/scenarios/case_study.yaml\n"
          "processes:\n  - {components: [physics], program: toy_host}\n"
          "  - {components: [navigation, control], program: toy_host}\n"
          "  - {components: [planner], program: toy_host}\n  - {components: [report], program: toy_host}\n");
    write("250_ticks.yaml", "");
  }
  /// Makes a run of 5 s. An observer of all topics, if there is one, receives `signal` about 2 s before the end, so
  /// that DDS regards it as alive for another 8 s. Returns the time from the report's last file to the end of the
  /// launcher.
  Clock::duration ending(const std::string& report, int signal) const {
    Process run = start({"run", (dir_ / "250_ticks.yaml").string(), "--manifest", (dir_ / "toys.yaml").string(),
                         "--report", (dir_ / report).string(), "--pace", "1x", "--record"});
    const unsigned number = domain_of(run);
    const auto recording = dir_ / (report + ".mcap");
    std::optional<Process> observer;
    if (signal != 0) {
      observer.emplace(start({"record", recording.string(), "--run", std::to_string(number)}));
      expect_tick(number, 150);
      EXPECT_TRUE(eventually([&] { return std::filesystem::exists(recording); })) << observer->errors();
      observer->signal(signal);
    }
    EXPECT_TRUE(eventually([&] { return std::filesystem::exists(dir_ / report / "mission.json"); })) << run.errors();
    const auto begin = Clock::now();
    EXPECT_EQ(run.wait(40s), exit_status::kOk) << run.output() << run.errors();
    return Clock::now() - begin;
  }
  static void expect_tick(unsigned number, std::int64_t tick) {
    const dds::Domain outside(number);
    const auto ticks = dds::Reader<msg::Tick>::observer(outside.participant(), barrier_topics::kTick);
    EXPECT_TRUE(eventually([&] {
      std::int64_t newest = -1;
      ticks.take([&](const msg::Tick& message) { newest = std::max(newest, message.index); });
      return newest >= tick;
    }));
  }
};

// The bound allows for the time that the plant's process (1 s), the others (0.5 s) and the launcher (0.2 s) wait, and
// for a busy machine.
TEST_P(DeadObserver, DelaysTheEndOfARunByLessThanFourSecondsAndCostsItNothing) {
  const auto undisturbed = ending("undisturbed", 0);
  const auto disturbed = ending("disturbed", GetParam());
  EXPECT_LT(disturbed, undisturbed + 4s) << "undisturbed: " << std::chrono::duration<double>(undisturbed).count();
  for (const char* name : {"undisturbed", "disturbed"}) {
    EXPECT_EQ(report(name)["success"], true) << report(name);
    EXPECT_EQ(report(name)["ticks"], 250);
    EXPECT_EQ(report(name)["recording"]["proven_complete"], true) << report(name)["recording"];
    EXPECT_EQ(report(name)["members"].size(), 5u);
  }
  EXPECT_EQ(report("disturbed")["state_hash"], report("undisturbed")["state_hash"]);
  EXPECT_EQ(command({"diff", (dir_ / "undisturbed").string(), (dir_ / "disturbed").string()}), 0) << output_;
}

INSTANTIATE_TEST_SUITE_P(, DeadObserver, ::testing::Values(SIGKILL, SIGSTOP),
                         [](const auto& test) { return std::string(test.param == SIGKILL ? "Killed" : "Stopped"); });

/// Two participants of one domain: the process of the test, which writes, and a child, which reads.
class Acknowledgements : public CliFixture {
 protected:
  const DomainClaim claim_;
  const dds::Domain domain_{claim_.domain()};
  const dds::Writer<msg::RunState> first_{domain_.participant(), barrier_topics::kRunState};
  const dds::Writer<msg::Waiting> second_{domain_.participant(), barrier_topics::kWaiting};

  [[nodiscard]] Process reader() const {
    return start({"record", (dir_ / "x.mcap").string(), "--domain", std::to_string(claim_.domain())});
  }
  [[nodiscard]] bool matched() const { return first_.readers() > 0 && second_.readers() > 0; }
  void write_both() const {
    first_.write({});
    second_.write({});
  }
};

TEST_F(Acknowledgements, ArriveFromALivingReaderAndAreNotWaitedForWithoutOne) {
  write_both();
  EXPECT_TRUE(dds::wait_for_acknowledgements(domain_.participant(), 0)) << "there is no reader";
  Process living = reader();
  ASSERT_TRUE(eventually([&] { return matched(); })) << living.errors();
  write_both();
  EXPECT_TRUE(dds::wait_for_acknowledgements(domain_.participant(), DDS_SECS(20)));
}

TEST_F(Acknowledgements, OfAStoppedReaderAreWaitedForWithinOneBoundForAllWriters) {
  Process stopped = reader();
  ASSERT_TRUE(eventually([&] { return matched(); })) << stopped.errors();
  stopped.signal(SIGSTOP);
  write_both();
  const auto begin = Clock::now();
  EXPECT_FALSE(dds::wait_for_acknowledgements(domain_.participant(), DDS_SECS(1)));
  EXPECT_GE(Clock::now() - begin, 1s);
  EXPECT_LT(Clock::now() - begin, 1900ms) << "one bound for each writer would be 2 s";
  int asked = 0;
  EXPECT_FALSE(dds::wait_for_acknowledgements(domain_.participant(), DDS_SECS(20), [&] { return ++asked == 3; }));
  EXPECT_EQ(asked, 3);
  stopped.signal(SIGCONT);
  EXPECT_TRUE(dds::wait_for_acknowledgements(domain_.participant(), DDS_SECS(20)));
}

}  // namespace
}  // namespace constrictor::testing
