// The conductor, called directly: which members it accepts, when it sends a tick, which samples the tick makes visible,
// and which reports of members it recognises as impossible.
#include <limits>

#include "conductor_fixture.hpp"

namespace constrictor {
namespace {

TEST_F(ConductorTest, TheEpochBeginsWithTheLastHelloAndTicksWithTheLastReady) {
  conductor_.on_hello(hello("physics"));
  EXPECT_TRUE(record_.epochs.empty());
  ASSERT_EQ(conductor_.owed().size(), 1u);
  EXPECT_EQ(conductor_.owed()[0].component, "navigation");
  EXPECT_STREQ(conductor_.owed()[0].what, "Hello");
  conductor_.on_hello(hello("navigation"));
  ASSERT_EQ(record_.epochs.size(), 1u);
  EXPECT_EQ(record_.epochs[0].first, kEpoch);
  conductor_.on_ready("physics", kEpoch, 1);
  conductor_.on_ready("navigation", {kEpoch.run_id, 9}, 1);
  conductor_.on_ready("navigation", kEpoch, 2);
  conductor_.on_ready("nobody", kEpoch, 1);
  EXPECT_FALSE(conductor_.may_tick());
  EXPECT_STREQ(conductor_.owed().at(0).what, "Ready");
  conductor_.on_ready("navigation", kEpoch, 1);
  EXPECT_TRUE(conductor_.may_tick());
}

TEST_F(ConductorTest, ATickWaitsForTheStepsThatItMakesVisible) {
  begin();
  tick();
  EXPECT_FALSE(conductor_.may_tick());
  conductor_.on_done(plant_step(0));
  EXPECT_FALSE(conductor_.may_tick());
  ASSERT_EQ(conductor_.owed().size(), 1u);
  EXPECT_STREQ(conductor_.owed()[0].what, "TickDone");
  conductor_.on_done(step(0, 2));
  ASSERT_TRUE(conductor_.may_tick());
  EXPECT_EQ(record_.ticks.back().visible[kEvents], 0u);
  EXPECT_EQ(record_.ticks.back().visible[kJoints], 1u) << "the plant's samples are visible in their own tick";
  tick();
  EXPECT_EQ(record_.ticks.back().visible[kEvents], 2u);
  EXPECT_EQ(record_.ticks.back().incarnations[kEvents], 1u);
}

TEST_F(ConductorTest, ProcessesThatAreNoMembersOfTheRunAreRefusedWithTheReason) {
  conductor_.on_hello(hello("nobody"));
  EXPECT_EQ(last_refusal(), "no component of this name is in the roster");
  const auto refused = [&](const auto& change, const std::string& reason) {
    Hello other = hello("navigation");
    change(other);
    conductor_.on_hello(other);
    EXPECT_EQ(last_refusal(), reason);
  };
  refused([](Hello& h) { h.idl_hash = "x"; }, "IDL hash differs: found x, the run has idl");
  refused([](Hello& h) { h.config_hash = "x"; }, "configuration hash differs: found x, the run has config");
  refused([](Hello& h) { h.numeric_profile = "x"; }, "numeric profile differs: found x, the run has profile");
  conductor_.on_hello(hello("physics"));
  EXPECT_TRUE(record_.epochs.empty()) << "the epoch must not begin before navigation has joined";
  begin();
  const std::size_t refusals = record_.refusals.size();
  conductor_.on_hello(hello("navigation"));
  EXPECT_EQ(record_.refusals.size(), refusals) << "a repeated Hello must not be refused";
  refused([](Hello& h) { h.pid = 4711; },
          "two members of one name: incarnation 1 runs as pid 101 on here; a replacement "
          "needs a higher --incarnation");
  conductor_.on_hello(hello("physics", 2));
  EXPECT_EQ(last_refusal(), "the plant cannot be replaced in a run");
  refused([](Hello& h) { h.incarnation = 2, h.component_hash = "edited"; },
          "its configuration or scenario file differs from the one that the run began with: found hash edited, the run "
          "has own");
}

TEST_F(ConductorTest, ALatencyForWhichTheTopicsKeepTooLittleIsRefusedBeforeTheRunBegins) {
  conductor_.on_hello(hello("physics"));
  Hello slow = hello("navigation");
  slow.reads = TopicSet::of(topics::kJointState);
  slow.timing.latency = 17;
  conductor_.on_hello(slow);
  EXPECT_TRUE(last_refusal().starts_with("latency_ticks of navigation: found 17, accepted at most 16"));
  EXPECT_TRUE(record_.epochs.empty());
  slow.timing.latency = 16;
  conductor_.on_hello(slow);
  EXPECT_EQ(record_.epochs.size(), 1u);
}

TEST_F(ConductorTest, ARunThatIsOverTakesBackItsOwnProcessesAndNoOthers) {
  begin();
  run_to(3);
  conductor_.end_run();
  tick();
  ASSERT_TRUE(conductor_.ended());
  conductor_.on_hello(hello("navigation", 2));
  EXPECT_EQ(last_refusal(), "the run is over");
  Hello own = hello("navigation", 2);
  own.run_id = kEpoch.run_id;
  conductor_.on_hello(own);
  ASSERT_EQ(record_.resumes.size(), 1u);
  EXPECT_EQ(record_.resumes[0].index, 3);
}

TEST_F(ConductorTest, ImpossibleReportsAreRecognisedWithTheReason) {
  begin();
  run_to(3);
  const auto why = [&](const TickDone& done) { return conductor_.implausible(done).value_or(""); };
  tick();  // 4
  EXPECT_EQ(why(step(4, 5)), "");
  EXPECT_EQ(why(step(3, 0)), "") << "a step that is known is ignored";
  EXPECT_NE(why(step(5, 5)).find("index: found 5"), std::string::npos) << "a tick that was not sent";
  EXPECT_NE(why(step(std::numeric_limits<std::int64_t>::max(), 5)).find("index"), std::string::npos);
  EXPECT_NE(why(step(4, 3)).find("published: found 3 of topic"), std::string::npos) << "a count that falls";
  EXPECT_NE(why(step(4, 4 + topics::kTaskEvent.max_per_tick + 1)).find("published: found"), std::string::npos);
  EXPECT_NE(why(step(4, std::numeric_limits<std::uint64_t>::max())).find("published: found"), std::string::npos);
  TickDone foreign_topic = step(4, 5);
  foreign_topic.published = {{kJoints, 1}};
  EXPECT_NE(why(foreign_topic).find("which the member does not write"), std::string::npos);
  foreign_topic.published = {{200, 1}};
  EXPECT_NE(why(foreign_topic).find("found topic 200"), std::string::npos);
  TickDone foreign_output = step(4, 5);
  foreign_output.written = {{kJoints, "x"}};
  EXPECT_NE(why(foreign_output).find("checkpoint: found topic"), std::string::npos);
}

TEST_F(ConductorTest, MessagesOfAnotherRunOrOfAnUnknownIncarnationAreForeign) {
  begin();
  EXPECT_FALSE(conductor_.foreign("navigation", kEpoch, 1));
  EXPECT_FALSE(conductor_.foreign("navigation", kEpoch, 0)) << "an older incarnation is only late";
  EXPECT_NE(conductor_.foreign("navigation", kEpoch, 2).value_or("").find("has sent no Hello"), std::string::npos);
  EXPECT_TRUE(conductor_.foreign("navigation", {kEpoch.run_id + 1, 1}, 1));
  EXPECT_TRUE(conductor_.foreign("navigation", {kEpoch.run_id, 2}, 1));
  EXPECT_NE(conductor_.foreign("", kEpoch, 1).value_or("").find("accepted one of the roster"), std::string::npos);
}

TEST_F(ConductorTest, TheRunEndsWhenTheRequestBecomesVisibleOrAtTheLastTick) {
  begin();
  tick();
  TickDone end = step(0, 0);
  end.end_of_run = true;
  conductor_.on_done(plant_step(0));
  conductor_.on_done(end);
  EXPECT_TRUE(conductor_.next_is_final());
  tick();
  EXPECT_TRUE(record_.ticks.back().final_tick);
  EXPECT_TRUE(conductor_.ended());
  EXPECT_FALSE(conductor_.may_tick());

  ConductorOptions limited = options();
  limited.last_index = 0;
  ConductorRecord record;
  Conductor other(limited, static_cast<ConductorSink&>(record));
  EXPECT_TRUE(other.next_is_final());
}

TEST_F(ConductorTest, AResetBeginsAnEpochWithoutTheStateOfTheOneBefore) {
  conductor_.reset(9);
  EXPECT_TRUE(record_.epochs.empty()) << "the run has not begun";
  begin();
  run_to(2);
  conductor_.reset(9);
  ASSERT_EQ(record_.epochs.size(), 2u);
  EXPECT_EQ(record_.epochs[1], (std::pair{EpochId{kEpoch.run_id, 2}, std::uint64_t{9}}));
  EXPECT_EQ(conductor_.next_index(), 0);
  EXPECT_FALSE(conductor_.may_tick());
  EXPECT_FALSE(conductor_.on_done(step(3, 4))) << "the step belongs to the epoch before";
  conductor_.on_ready("physics", {kEpoch.run_id, 2}, 1);
  conductor_.on_ready("navigation", {kEpoch.run_id, 2}, 1);
  ASSERT_TRUE(conductor_.may_tick());
  conductor_.tick({});
  EXPECT_EQ(record_.ticks.back().visible[kEvents], 0u);
}

TEST_F(ConductorTest, AtRealTimePaceTicksWaitForThePlantAlone) {
  ConductorOptions options = ConductorTest::options();
  options.realtime = true;
  ConductorRecord record;
  Conductor conductor(options, static_cast<ConductorSink&>(record));
  conductor.on_hello(hello("physics"));
  conductor.on_hello(hello("navigation"));
  conductor.on_ready("physics", kEpoch, 1);
  EXPECT_FALSE(conductor.may_tick()) << "the first tick waits until all are ready";
  conductor.on_ready("navigation", kEpoch, 1);
  conductor.tick({});
  EXPECT_FALSE(conductor.may_tick());
  conductor.on_done(plant_step(0));
  EXPECT_TRUE(conductor.may_tick());
  EXPECT_TRUE(record.ticks.back().realtime);
}

}  // namespace
}  // namespace constrictor
