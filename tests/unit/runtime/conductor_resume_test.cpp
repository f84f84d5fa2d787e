// What the conductor gives a restarted member.
#include "conductor_fixture.hpp"

namespace constrictor {
namespace {

TEST_F(ConductorTest, ARestartedMemberGetsItsLastStateAndAsManyOutputsAsTheTopicKeeps) {
  begin();
  const auto last = static_cast<std::int64_t>(topics::kTaskEvent.depth) + 5;
  run_to(last);
  conductor_.on_hello(hello("navigation", 2));
  ASSERT_EQ(record_.resumes.size(), 1u);
  const Resume& resume = record_.resumes[0];
  EXPECT_EQ(resume.index, last);
  EXPECT_EQ(resume.incarnation, 2u);
  EXPECT_EQ(resume.state, "state after " + std::to_string(last));
  ASSERT_EQ(resume.outputs.size(), topics::kTaskEvent.depth);
  EXPECT_EQ(resume.outputs.back().bytes, "event of " + std::to_string(last));
  EXPECT_FALSE(conductor_.may_tick()) << "the restarted member must send Ready again";
  conductor_.on_ready("navigation", kEpoch, 2);
  ASSERT_TRUE(conductor_.may_tick());
  tick();
  EXPECT_FALSE(conductor_.on_done(step(last + 1, static_cast<std::uint64_t>(last + 2), 1)))
      << "the message is from the dead incarnation";
  EXPECT_TRUE(conductor_.on_done(step(last + 1, static_cast<std::uint64_t>(last + 2), 2)));
  EXPECT_FALSE(conductor_.on_done(step(last + 1, static_cast<std::uint64_t>(last + 2), 2)))
      << "the step was done before";
}

TEST_F(ConductorTest, AMemberWithoutCheckpointsCannotBeResumed) {
  begin();
  tick();
  TickDone bare = step(0, 1);
  bare.state.clear();
  bare.written.clear();
  conductor_.on_done(bare);
  conductor_.on_hello(hello("navigation", 2));
  EXPECT_EQ(last_refusal(), "it cannot be resumed: its TickDone carried no checkpoint");
  EXPECT_EQ(conductor_.incarnation("navigation"), 1u);
}

TEST_F(ConductorTest, ARepeatedHelloIsAnsweredByTheSameResumeUntilTheMemberIsReady) {
  begin();
  run_to(3);
  const Hello restarted = hello("navigation", 2);
  for (int i = 0; i < 3; ++i) conductor_.on_hello(restarted);
  ASSERT_EQ(record_.resumes.size(), 3u);
  for (const Resume& resume : record_.resumes) {
    EXPECT_EQ(resume.component, "navigation");
    EXPECT_EQ(resume.incarnation, 2u);
    EXPECT_EQ(resume.index, 3);
    EXPECT_EQ(resume.state, record_.resumes[0].state);
  }
  conductor_.on_ready("navigation", kEpoch, 2);
  conductor_.on_hello(restarted);
  EXPECT_EQ(record_.resumes.size(), 3u) << "a member that is ready has received it";
}

}  // namespace
}  // namespace constrictor
