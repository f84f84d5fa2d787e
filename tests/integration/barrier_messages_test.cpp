// The tests send barrier messages themselves: as a conductor that resumes one member at a time, as a member without
// checkpoints, and as a process that is not part of the run.
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <limits>

#include "component/topic_set.hpp"
#include "cyclone/domain.hpp"
#include "cyclone/domain_claim.hpp"
#include "integration/stranger.hpp"
#include "runtime/host.hpp"
#include "runtime/member_bus.hpp"
#include "runtime/wire.hpp"
#include "support/eventually.hpp"
#include "support/process.hpp"

namespace constrictor::testing {
namespace {

using namespace std::chrono_literals;
namespace wire = barrier_topics;

Process toys(const std::string& group, const std::string& roster, std::uint32_t domain, std::vector<std::string> more) {
  std::vector<std::string> arguments = {program("toy_host"), group,  "--domain", std::to_string(domain),
                                        "--roster",          roster, "--robot",  ""};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return Process(std::move(arguments));
}

/// Waits for the newest Hello of an incarnation; if none arrives in time, the newest of any.
msg::Hello hello_of(const dds::Reader<msg::Hello>& hellos, std::uint32_t incarnation) {
  msg::Hello newest{};
  static_cast<void>(eventually([&] {
    hellos.take([&](const msg::Hello& message) { newest = message; });
    return newest.incarnation == incarnation;
  }));
  return newest;
}

// Both members were in one process that died. The time between their two Resume messages is not bounded.
TEST(BarrierMessages, EachMemberOfARestartedProcessSendsReadyOnceItIsResumed) {
  const DomainClaim claim;
  const dds::Domain domain(claim.domain());
  const dds_entity_t participant = domain.participant();
  const auto reads = TopicSet::of(topics::kJointCommand);
  const auto writes = TopicSet::of(topics::kJointState);
  const MemberBus plant(participant, reads, writes, "physics");
  const auto hellos = dds::Reader<msg::Hello>::member(participant, wire::kHello);
  const auto readies = dds::Reader<msg::Ready>::member(participant, wire::kReady);
  const dds::Writer<msg::Hello> hello(participant, wire::kHello, 1);
  const dds::Writer<msg::Resume> resume(participant, wire::kResume, 1);
  Process process = toys("navigation,control", "physics,navigation,control", claim.domain(),
                         {"--incarnation", "2", "--scenario", "100"});

  msg::Hello physics = hello_of(hellos, 2);
  ASSERT_EQ(physics.incarnation, 2u);
  dds::set_text(physics.component, "physics");
  physics.incarnation = 1;
  physics.reads = reads.bits();
  physics.writes = writes.bits();
  hello.write(physics);

  std::vector<std::string> ready;
  const auto take_ready = [&] {
    readies.take([&](const msg::Ready& message) {
      EXPECT_EQ(message.run_id, 7u) << message.component;
      EXPECT_EQ(message.epoch, 3u) << message.component;
      ready.emplace_back(message.component);
    });
  };
  for (const std::string name : {"navigation", "control"}) {
    msg::Resume message{};
    dds::set_text(message.component, name);
    message.run_id = 7;
    message.epoch = 3;
    message.incarnation = 2;
    message.index = -1;
    message.seed = 1;
    resume.write(message);
    EXPECT_TRUE(eventually([&] {
      take_ready();
      return !ready.empty();
    })) << name
        << ": " << process.errors();
    EXPECT_EQ(ready, std::vector<std::string>{name});
    ready.clear();
  }
  process.signal(SIGTERM);
  EXPECT_EQ(process.wait(10s), exit_status::kOk) << process.errors();
}

TEST(BarrierMessages, ImpossibleMessagesAreRejectedAndCountedAndTheRunGoesOn) {
  const std::string roster = "physics,navigation,control,planner,report";
  const auto run = [&](const std::vector<std::string>& groups, std::uint32_t number,
                       const std::vector<std::string>& more) {
    std::vector<Process> processes;
    for (const auto& group : groups) processes.push_back(toys(group, roster, number, more));
    return processes;
  };
  const DomainClaim quiet;
  auto alone = run({roster}, quiet.domain(), {"--scenario", "400"});
  ASSERT_EQ(alone.front().wait(30s), exit_status::kOk);

  const DomainClaim claim;
  const dds::Domain domain(claim.domain());
  const auto states = dds::Reader<msg::RunState>::member(domain.participant(), wire::kRunState);
  const auto statuses = dds::Reader<msg::ComponentStatus>::member(domain.participant(), wire::kStatus);
  const std::vector<std::string> options = {"--scenario", "400", "--pace", "2"};
  auto processes = run({"navigation", "control", "planner", "report"}, claim.domain(), options);
  Stranger stranger(domain.participant());
  ASSERT_TRUE(eventually([&] { return stranger.matched_members(); }));
  stranger.command();  // before the run begins
  processes.push_back(toys("physics", roster, claim.domain(), options));
  std::optional<msg::RunState> state;
  const auto newest_state = [&] {
    states.take([&](const msg::RunState& message) {
      if (message.epoch == 1) state = message;  // the stranger's messages have epoch 0
    });
    return state.has_value();
  };
  ASSERT_TRUE(eventually(newest_state)) << processes.front().errors();
  stranger.learn(*state);
  ASSERT_TRUE(eventually([&] { return stranger.matched(); }));
  // A process that has received no message of its run yet would obey the refusal of any run.
  bool planner_knows_its_run = false;
  ASSERT_TRUE(eventually([&] {
    statuses.take([&](const msg::ComponentStatus& status) {
      planner_knows_its_run |= status.component == std::string("planner") && status.tick >= 0;
    });
    return planner_knows_its_run;
  }));
  stranger.send_all();
  stranger.refuse("planner", processes.at(2).pid());
  stranger.refuse("physics", processes.back().pid());
  for (auto& process : processes) EXPECT_EQ(process.wait(60s), exit_status::kOk) << process.errors();
  EXPECT_EQ(processes.at(3).output(), alone.front().output());
  std::map<std::string, std::string> last;
  std::map<std::string, std::uint64_t> refused;
  statuses.take([&](const msg::ComponentStatus& status) {
    refused[status.component] = status.refused_count;
    last[status.component] = status.last_refusal;
  });
  EXPECT_GT(refused["physics"], 500u);
  for (const char* name : {"navigation", "control", "planner", "report"}) {
    EXPECT_GT(refused[name], 0u) << name;
    EXPECT_FALSE(last[name].empty()) << name;
  }
}

// Two hosts may choose the same domain: their runs have the same components, roster and configuration, and differ only
// in the run id of their launchers.
TEST(BarrierMessages, TwoRunsInOneDomainLeaveEachOtherAlone) {
  const std::string roster = "physics,navigation,control,planner,report";
  std::map<std::string, std::string> expected;  // by the number of ticks
  for (const std::string ticks : {"200", "300"}) {
    const DomainClaim quiet;
    Process alone = toys(roster, roster, quiet.domain(), {"--scenario", ticks});
    ASSERT_EQ(alone.wait(30s), exit_status::kOk);
    expected[ticks] = alone.output();
  }
  const DomainClaim claim;
  std::map<std::string, std::vector<Process>> runs;
  for (const std::string group : {"physics,planner", "navigation,control", "report"}) {
    for (const auto& [ticks, result] : expected)
      runs[ticks].push_back(toys(group, roster, claim.domain(), {"--scenario", ticks, "--run-id", ticks}));
  }
  for (auto& [ticks, processes] : runs) {
    for (auto& process : processes) EXPECT_EQ(process.wait(60s), exit_status::kOk) << process.errors();
    EXPECT_EQ(processes.back().output(), expected[ticks]);
  }
}

TEST(BarrierMessages, AMemberWithoutCheckpointsWorksUntilItDies) {
  const DomainClaim claim;
  const dds::Domain domain(claim.domain());
  const dds_entity_t participant = domain.participant();
  const auto writes = TopicSet::of(topics::kMissionStatus);
  const MemberBus bus(participant, {}, writes, "planner");
  const auto hellos = dds::Reader<msg::Hello>::member(participant, wire::kHello);
  const auto starts = dds::Reader<msg::EpochStart>::member(participant, wire::kEpochStart);
  const auto ticks = dds::Reader<msg::Tick>::member(participant, wire::kTick);
  const auto refusals = dds::Reader<msg::Refused>::member(participant, wire::kRefused);
  const dds::Writer<msg::Hello> hello(participant, wire::kHello, 1);
  const dds::Writer<msg::Ready> ready(participant, wire::kReady, 1);
  const dds::Writer<msg::TickDone> done(participant, wire::kTickDone, 4);
  Process rest = toys("physics,navigation,control,report", "physics,navigation,control,planner,report", claim.domain(),
                      {"--scenario", "100000"});

  msg::Hello mine = hello_of(hellos, 1);
  ASSERT_EQ(mine.incarnation, 1u);
  dds::set_text(mine.component, "planner");
  mine.pid = 1;
  mine.reads = 0;
  mine.writes = writes.bits();
  mine.period_ticks = mine.latency_ticks = 1;
  hello.write(mine);
  msg::Ready here{};
  dds::set_text(here.component, "planner");
  here.incarnation = 1;
  ASSERT_TRUE(eventually([&] {
    starts.take([&](const msg::EpochStart& start) { here.run_id = start.run_id, here.epoch = start.epoch; });
    return here.run_id != 0;
  }));
  ready.write(here);
  std::int64_t last = -1;
  ASSERT_TRUE(eventually([&] {
    ticks.take([&](const msg::Tick& tick) {
      msg::TickDone step{};
      dds::set_text(step.component, "planner");
      step.run_id = tick.run_id;
      step.epoch = tick.epoch;
      step.incarnation = 1;
      step.index = last = tick.index;
      step.published_count = 1;
      step.published[0].topic = topics::kMissionStatus.id;
      done.write(step);
    });
    return last >= 20;
  })) << last
      << ": " << rest.errors();
  mine.incarnation = 2;
  hello.write(mine);
  std::string reason;
  EXPECT_TRUE(eventually([&] {
    refusals.take([&](const msg::Refused& message) { reason = message.reason; });
    return !reason.empty();
  }));
  EXPECT_NE(reason.find("cannot be resumed: its TickDone carried no checkpoint"), std::string::npos) << reason;
  rest.signal(SIGTERM);
  EXPECT_EQ(rest.wait(10s), exit_status::kOk);
}

}  // namespace
}  // namespace constrictor::testing
