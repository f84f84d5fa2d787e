// The barrier's messages spoken by hand: a conductor that says less at a time than the real one, and strangers that say what is absurd.
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <functional>
#include <limits>
#include <thread>

#include "runtime/dds/domain.hpp"
#include "runtime/dds/member_bus.hpp"
#include "runtime/dds/wire.hpp"
#include "runtime/domain_claim.hpp"
#include "runtime/host.hpp"
#include "support/process.hpp"

namespace constrictor::testing {
namespace {

using namespace std::chrono_literals;
namespace wire = dds::barrier_topics;

/// Calls `look` until it is true; false if it is not within 20 s.
bool eventually(const std::function<bool()>& look) {
  for (int i = 0; i < 4000; ++i) {
    if (look()) return true;
    std::this_thread::sleep_for(5ms);
  }
  return false;
}

Process toys(const std::string& group, const std::string& roster, std::uint32_t domain, std::vector<std::string> more) {
  std::vector<std::string> arguments = {program("toy_host"), group, "--domain", std::to_string(domain), "--roster", roster, "--robot", ""};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return Process(std::move(arguments));
}

// Both were one process that died; between the two Resumes anything may happen.
TEST(BarrierMessages, EachMemberOfARestartedProcessSaysReadyOnceItIsResumed) {
  const DomainClaim claim;
  const dds::Domain domain(claim.domain());
  const dds_entity_t participant = domain.participant();
  const std::uint64_t reads = std::uint64_t{1} << topics::kJointCommand.id;
  const std::uint64_t writes = std::uint64_t{1} << topics::kJointState.id;
  const dds::MemberBus plant(participant, reads, writes, "physics");
  const auto hellos = dds::Reader<msg::Hello>::member(participant, wire::kHello);
  const auto readies = dds::Reader<msg::Ready>::member(participant, wire::kReady);
  const dds::Writer<msg::Hello> hello(participant, wire::kHello, 1);
  const dds::Writer<msg::Resume> resume(participant, wire::kResume, 1);
  Process process = toys("navigation,control", "physics,navigation,control", claim.domain(), {"--incarnation", "2", "--scenario", "100"});

  msg::Hello physics{};
  ASSERT_TRUE(eventually([&] {
    hellos.take([&](const msg::Hello& message) { physics = message; });
    return physics.incarnation == 2;
  }));
  dds::set_text(physics.component, "physics");
  physics.incarnation = 1;
  physics.reads = reads;
  physics.writes = writes;
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
    })) << name << ": " << process.errors();
    EXPECT_EQ(ready, std::vector<std::string>{name});
    ready.clear();
  }
  process.signal(SIGTERM);
  EXPECT_EQ(process.wait(10s), exit_status::kOk) << process.errors();
}

/// Says to a run all that obeys the types and makes no sense.
class Stranger {
 public:
  explicit Stranger(dds_entity_t participant)
      : hello_(participant, wire::kHello, 64), ready_(participant, wire::kReady, 64), done_(participant, wire::kTickDone, 64),
        epoch_(participant, wire::kEpochStart, 8), tick_(participant, wire::kTick, 8), resume_(participant, wire::kResume, 8),
        refused_(participant, wire::kRefused, 8), state_(participant, wire::kRunState, 8), control_(participant, wire::kRunControl, 8) {}

  [[nodiscard]] bool heard_by_members() const { return epoch_.readers() > 3 && tick_.readers() > 3 && resume_.readers() > 3; }
  [[nodiscard]] bool heard() const {
    return heard_by_members() && hello_.readers() > 4 && ready_.readers() > 0 && done_.readers() > 0;
  }
  void learn(const msg::RunState& run) { run_ = run; }
  void speak() {
    greet();
    for (const char* name : {"navigation", "planner", "physics", "nobody", ""}) {
      for (const std::uint64_t run_id : {run_.run_id, run_.run_id + 1, std::uint64_t{0}}) {
        for (const std::uint32_t incarnation : {0u, 1u, 2u, std::numeric_limits<std::uint32_t>::max()}) {
          msg::Ready ready{};
          dds::set_text(ready.component, name);
          ready.run_id = run_id;
          ready.epoch = run_.epoch;
          ready.incarnation = incarnation;
          ready_.write(ready);
          say_done(name, run_id, incarnation);
        }
      }
    }
    command();
  }

  /// Another run's conductor does not want this process.
  void refuse(const char* name, pid_t pid) {
    msg::Refused refused{};
    dds::set_text(refused.component, name);
    refused.run_id = run_.run_id + 1;
    refused.incarnation = 1;
    refused.pid = pid;
    ::gethostname(refused.host, sizeof refused.host - 1);
    refused_.write(refused);
  }
  /// Another run's conductor, or what takes itself for one.
  void command() {
    msg::EpochStart epoch{};
    epoch.run_id = run_.run_id + 1;
    epoch.epoch = 9;
    epoch_.write(epoch);
    epoch.run_id = run_.run_id;
    epoch.epoch = 0;
    epoch_.write(epoch);
    msg::Tick tick{};
    tick.run_id = run_.run_id + 1;
    tick.index = std::numeric_limits<std::int64_t>::max();
    tick.final_tick = true;
    tick_.write(tick);
    tick.run_id = run_.run_id;
    tick.epoch = run_.epoch;
    tick.index = -5;
    tick.final_tick = false;
    tick_.write(tick);
    std::string block = "garbage";
    msg::Resume resume{};
    dds::set_text(resume.component, "navigation");
    resume.incarnation = 1;
    resume.index = std::numeric_limits<std::int64_t>::max();
    resume.checkpoint = {7, 7, reinterpret_cast<std::uint8_t*>(block.data()), false};
    resume_.write(resume);
    msg::RunState state{};
    state.run_id = run_.run_id + 1;
    state.pace = std::numeric_limits<double>::quiet_NaN();
    state_.write(state);
    msg::RunControl control{};
    dds::set_text(control.source, "stranger");
    control.sequence_number = 1;
    control.command = 200;
    control.pace = std::numeric_limits<double>::infinity();
    control_.write(control);
  }

 private:
  void say_done(const char* name, std::uint64_t run_id, std::uint32_t incarnation) {
    for (const std::int64_t index : {std::numeric_limits<std::int64_t>::min(), std::int64_t{-1}, std::int64_t{1} << 40,
                                     std::numeric_limits<std::int64_t>::max()}) {
      msg::TickDone done{};
      dds::set_text(done.component, name);
      done.run_id = run_id;
      done.epoch = run_.epoch;
      done.incarnation = incarnation;
      done.index = index;
      done_.write(done);
      done.published_count = done.consumed_count = 255;
      done_.write(done);
    }
    // At the very tick that is due, with a checkpoint that is none, lengths beyond all memory, topics that are not its own.
    std::string endless(8, '\xff');
    for (std::string block : {std::string("x"), endless, endless + endless, std::string(8, '\0') + endless, std::string(16, '\0') + "x"}) {
      msg::TickDone done{};
      dds::set_text(done.component, name);
      done.run_id = run_id;
      done.epoch = run_.epoch;
      done.incarnation = incarnation;
      done.index = run_.tick;
      done.checkpoint = {static_cast<std::uint32_t>(block.size()), static_cast<std::uint32_t>(block.size()),
                         reinterpret_cast<std::uint8_t*>(block.data()), false};
      done_.write(done);
    }
    for (std::int64_t index = run_.tick - 2; index < run_.tick + 14; ++index) {
      msg::TickDone done{};
      dds::set_text(done.component, name);
      done.run_id = run_id;
      done.epoch = run_.epoch;
      done.incarnation = incarnation;
      done.index = index;
      done.published_count = 2;
      done.published[0] = {63, 1};
      done.published[1] = {topics::kMissionStatus.id, std::numeric_limits<std::uint64_t>::max()};
      done_.write(done);
    }
  }
  void greet() {
    for (const char* name : {"planner", "navigation", "nobody", ""}) {
      msg::Hello hello{};
      dds::set_text(hello.component, name);
      hello.incarnation = 1000;
      hello.pid = -1;
      hello.reads = hello.writes = ~std::uint64_t{0};
      hello_.write(hello);  // neither period nor latency
      hello.period_ticks = hello.latency_ticks = 1;
      hello_.write(hello);  // of another IDL and configuration
    }
  }
  msg::RunState run_{};
  dds::Writer<msg::Hello> hello_;
  dds::Writer<msg::Ready> ready_;
  dds::Writer<msg::TickDone> done_;
  dds::Writer<msg::EpochStart> epoch_;
  dds::Writer<msg::Tick> tick_;
  dds::Writer<msg::Resume> resume_;
  dds::Writer<msg::Refused> refused_;
  dds::Writer<msg::RunState> state_;
  dds::Writer<msg::RunControl> control_;
};

TEST(BarrierMessages, WhatMakesNoSenseIsRefusedAndCountedAndTheRunGoesOn) {
  const std::string roster = "physics,navigation,control,planner,report";
  const auto run = [&](const std::vector<std::string>& groups, std::uint32_t number, const std::vector<std::string>& more) {
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
  ASSERT_TRUE(eventually([&] { return stranger.heard_by_members(); }));
  stranger.command();  // before there is a run to believe in
  processes.push_back(toys("physics", roster, claim.domain(), options));
  std::optional<msg::RunState> state;
  const auto newest_state = [&] {
    states.take([&](const msg::RunState& message) {
      if (message.epoch == 1) state = message;  // the stranger's have none
    });
    return state.has_value();
  };
  ASSERT_TRUE(eventually(newest_state)) << processes.front().errors();
  stranger.learn(*state);
  ASSERT_TRUE(eventually([&] { return stranger.heard(); }));
  stranger.speak();
  stranger.refuse("planner", processes.at(2).pid());
  stranger.refuse("physics", processes.back().pid());
  for (auto& process : processes) EXPECT_EQ(process.wait(60s), exit_status::kOk) << process.errors();
  EXPECT_EQ(processes.at(3).output(), alone.front().output());
  std::map<std::string, std::string> last;
  std::map<std::string, std::uint64_t> refused;
  statuses.take([&](const msg::ComponentStatus& status) {
    refused[status.component] = status.refused;
    last[status.component] = status.last_refusal;
  });
  EXPECT_GT(refused["physics"], 500u);
  for (const char* name : {"navigation", "control", "planner", "report"}) {
    EXPECT_GT(refused[name], 0u) << name;
    EXPECT_FALSE(last[name].empty()) << name;
  }
}

// As where two hosts have chosen one domain: the same components, roster and configuration, each with its launcher's number.
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
    for (const auto& [ticks, result] : expected) runs[ticks].push_back(toys(group, roster, claim.domain(), {"--scenario", ticks, "--run-id", ticks}));
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
  const std::uint64_t writes = std::uint64_t{1} << topics::kMissionStatus.id;
  const dds::MemberBus bus(participant, 0, writes, "planner");
  const auto hellos = dds::Reader<msg::Hello>::member(participant, wire::kHello);
  const auto starts = dds::Reader<msg::EpochStart>::member(participant, wire::kEpochStart);
  const auto ticks = dds::Reader<msg::Tick>::member(participant, wire::kTick);
  const auto refusals = dds::Reader<msg::Refused>::member(participant, wire::kRefused);
  const dds::Writer<msg::Hello> hello(participant, wire::kHello, 1);
  const dds::Writer<msg::Ready> ready(participant, wire::kReady, 1);
  const dds::Writer<msg::TickDone> done(participant, wire::kTickDone, 4);
  Process rest = toys("physics,navigation,control,report", "physics,navigation,control,planner,report", claim.domain(), {"--scenario", "100000"});

  msg::Hello mine{};
  ASSERT_TRUE(eventually([&] {
    hellos.take([&](const msg::Hello& message) { mine = message; });
    return mine.incarnation == 1;
  }));
  dds::set_text(mine.component, "planner");
  mine.pid = 1;
  mine.reads = 0;
  mine.writes = writes;
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
  })) << last << ": " << rest.errors();
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
