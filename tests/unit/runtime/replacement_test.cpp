// Another component takes the place of a member while the run goes on.
#include <gtest/gtest.h>

#include "barrier/conductor.hpp"
#include "barrier/protocol.hpp"
#include "member_fixture.hpp"

namespace constrictor {
namespace {

class Replacement : public MemberTest {
 protected:
  explicit Replacement(bool realtime = true) : conductor_(options(realtime), sink()) {}
  static ConductorOptions options(bool realtime) {
    ConductorOptions options;
    options.run_id = kEpoch.run_id;
    options.roster = {"physics", "control"};
    options.plant = "physics";
    options.realtime = realtime;
    return options;
  }
  static Hello hello(const std::string& component, std::uint32_t incarnation, const std::string& hash) {
    Hello hello;
    hello.component = component;
    hello.incarnation = incarnation;
    hello.pid = static_cast<int>(incarnation);
    hello.component_hash = hash;
    hello.writes = component == "control" ? TopicSet::of(topics::kJointCommand) : TopicSet::of(topics::kJointState);
    return hello;
  }
  ConductorSink& sink() { return conductor_record_; }
  /// A step of control, and what the conductor learns of it.
  void begin() {
    for (const std::string name : {"physics", "control"}) conductor_.on_hello(hello(name, 1, "own"));
    for (const std::string name : {"physics", "control"}) conductor_.on_ready(name, kEpoch, 1);
    first_ = make();
    first_->on_epoch(kEpoch, 1);
    conductor_.tick({{topics::kJointState.id, 1}}, {});
    give_joints(*first_, 1);
    first_->on_tick(tick_at(0, visible(1, 0)));
    ASSERT_TRUE(first_->try_step());
    ASSERT_TRUE(conductor_.on_done(record_.steps.back()));
  }

  ConductorRecord conductor_record_;
  Conductor conductor_;
  std::unique_ptr<Member> first_;
};

class LockStepReplacement : public Replacement {
 protected:
  LockStepReplacement() : Replacement(false) {}
};

TEST_F(Replacement, BeginsAnewAndCountsItsSamplesOn) {
  begin();
  conductor_.on_hello(hello("control", 2, replacing("another")));
  ASSERT_TRUE(conductor_record_.refusals.empty()) << conductor_record_.refusals[0].second;
  ASSERT_EQ(conductor_record_.resumes.size(), 1U);
  const Resume& resume = conductor_record_.resumes[0];
  EXPECT_EQ(resume.state, kBeginAnew) << "it does not understand the memory of its predecessor";
  EXPECT_EQ(resume.outputs.size(), 1U);

  MemberRecord record;
  const auto second = make(2, &record);
  second->on_resume(resume);
  give_joints(*second, 1);
  give_joints(*second, 2);
  second->on_tick(tick_at(1, visible(2, 0)));
  ASSERT_TRUE(second->try_step());
  EXPECT_EQ(record.steps.back().published[0].count, 2U);
  EXPECT_EQ(record.published.back().second.header->sequence_number, 2U);

  // Its own successor continues from its memory, as that of any member.
  conductor_.tick({{topics::kJointState.id, 2}}, {});
  EXPECT_EQ(conductor_.implausible(record.steps.back()), std::nullopt);
  EXPECT_TRUE(conductor_.on_done(record.steps.back()));
  conductor_.on_hello(hello("control", 3, replacing("another")));
  ASSERT_EQ(conductor_record_.resumes.size(), 2U);
  EXPECT_EQ(conductor_record_.resumes[1].state, record.steps.back().state);
}

TEST_F(Replacement, MustBeAskedForMustWriteWhatWasWrittenAndIsNotThePlant) {
  begin();
  conductor_.on_hello(hello("control", 2, "another"));
  EXPECT_NE(conductor_record_.refusals.back().second.find("configuration"), std::string::npos);
  Hello mute = hello("control", 2, replacing("another"));
  mute.writes = {};
  conductor_.on_hello(mute);
  EXPECT_NE(conductor_record_.refusals.back().second.find("does not write joint_command"), std::string::npos);
  conductor_.on_hello(hello("physics", 2, replacing("another")));
  EXPECT_EQ(conductor_record_.refusals.size(), 3U);
  EXPECT_TRUE(conductor_record_.resumes.empty());
}

TEST_F(LockStepReplacement, IsRefusedBecauseTheRunWouldNotStayRepeatable) {
  begin();
  conductor_.on_hello(hello("control", 2, replacing("another")));
  ASSERT_EQ(conductor_record_.refusals.size(), 1U);
  EXPECT_NE(conductor_record_.refusals[0].second.find("real-time pace"), std::string::npos);
}

TEST(ReplacingHash, FitsIntoTheMessageAndKeepsTheScenario) {
  const std::string hash = replacing(component_hash(std::string(64, 'a'), std::string(64, 'b')));
  EXPECT_LE(hash.size(), 64U);
  EXPECT_TRUE(replaces(hash));
  EXPECT_FALSE(replaces(component_hash(std::string(64, 'a'), std::string(64, 'b'))));
  EXPECT_EQ(scenario_part(hash), std::string(28, 'a'));
}

}  // namespace
}  // namespace constrictor
