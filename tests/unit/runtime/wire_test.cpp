// The barrier's values on the wire: what is sent arrives unchanged, and damaged bytes are recognised.
#include "runtime/wire.hpp"

#include <gtest/gtest.h>

#include <random>

#include "runtime/config_hash.hpp"

namespace constrictor {
namespace {

TickDone a_step() {
  TickDone done;
  done.component = "navigation";
  done.epoch = {7, 3};
  done.incarnation = 2;
  done.index = 41;
  done.published = {{3, 10}, {17, 20}};
  done.consumed = {{0, 42}};
  done.output_hash[5] = 99;
  done.end_of_run = true;
  done.state = std::string("state\0with zeros", 16);
  done.written = {{17, "first"}, {17, ""}, {3, std::string(1000, 'x')}};
  return done;
}

void expect_equal(const std::vector<TickDone::Written>& a, const std::vector<TickDone::Written>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].topic, b[i].topic);
    EXPECT_EQ(a[i].bytes, b[i].bytes);
  }
}

TEST(Wire, ATickDoneArrivesAsItWasSent) {
  const TickDone sent = a_step();
  std::string block;
  const auto received = from_wire(to_wire(sent, block));
  ASSERT_TRUE(received);
  EXPECT_EQ(received->component, sent.component);
  EXPECT_EQ(received->epoch, sent.epoch);
  EXPECT_EQ(received->incarnation, sent.incarnation);
  EXPECT_EQ(received->index, sent.index);
  ASSERT_EQ(received->published.size(), 2u);
  EXPECT_EQ(received->published[1].topic, 17);
  EXPECT_EQ(received->published[1].count, 20u);
  ASSERT_EQ(received->consumed.size(), 1u);
  EXPECT_EQ(received->consumed[0].count, 42u);
  EXPECT_EQ(received->output_hash, sent.output_hash);
  EXPECT_TRUE(received->end_of_run);
  EXPECT_EQ(received->state, sent.state);
  expect_equal(received->written, sent.written);
}

TEST(Wire, AHelloAndAResumeArriveAsTheyWereSent) {
  Hello hello;
  hello.component = "control";
  hello.run_id = 9;
  hello.incarnation = 4;
  hello.pid = 4711;
  hello.host = "snake";
  hello.idl_hash = "a";
  hello.release = "1.0";
  hello.config_hash = "b";
  hello.component_hash = "c";
  hello.numeric_profile = "d";
  hello.timing = {5, 2};
  hello.reads = TopicSet::of(topics::kJointState);
  hello.writes = TopicSet::from_bits(~std::uint64_t{0});
  const Hello received = from_wire(to_wire(hello));
  EXPECT_FALSE(difference(received, hello));
  EXPECT_EQ(received.component, "control");
  EXPECT_EQ(received.run_id, 9u);
  EXPECT_EQ(received.incarnation, 4u);
  EXPECT_EQ(received.pid, 4711);
  EXPECT_EQ(received.host, "snake");
  EXPECT_EQ(received.release, "1.0");
  EXPECT_EQ(received.component_hash, "c");
  EXPECT_EQ(received.timing.period, 5);
  EXPECT_EQ(received.timing.latency, 2);
  EXPECT_EQ(received.reads, hello.reads);
  EXPECT_EQ(received.writes, hello.writes);

  const Resume resume{"control", {7, 3}, 4, 12, 99, "state", a_step().written};
  std::string block;
  const auto back = from_wire(to_wire(resume, block));
  ASSERT_TRUE(back);
  EXPECT_EQ(back->component, "control");
  EXPECT_EQ(back->epoch, resume.epoch);
  EXPECT_EQ(back->incarnation, 4u);
  EXPECT_EQ(back->index, 12);
  EXPECT_EQ(back->seed, 99u);
  EXPECT_EQ(back->state, "state");
  expect_equal(back->outputs, resume.outputs);
}

TEST(Wire, MoreTopicsThanTheMessageHasRoomForAreABug) {
  TickDone done = a_step();
  done.published.assign(1000, {3, 1});
  std::string block;
  EXPECT_THROW((void)to_wire(done, block), std::logic_error);
}

TEST(Wire, CountsBeyondTheArraysAreCutOff) {
  msg::TickDone message{};
  message.published_count = message.consumed_count = 255;
  const auto received = from_wire(message);
  ASSERT_TRUE(received);
  EXPECT_EQ(received->published.size(), std::size(message.published));
  EXPECT_EQ(received->consumed.size(), std::size(message.consumed));
}

TEST(Checkpoint, EveryTruncatedOrExtendedBlockIsDamaged) {
  const std::string block = pack_checkpoint("state", {{17, "event"}, {3, "scene"}});
  std::string state;
  std::vector<TickDone::Written> outputs;
  ASSERT_TRUE(unpack_checkpoint(block, state, outputs));
  for (std::size_t size = 1; size < block.size(); ++size) {
    EXPECT_FALSE(unpack_checkpoint(block.substr(0, size), state, outputs)) << size;
    EXPECT_TRUE(state.empty() && outputs.empty()) << size;
  }
  EXPECT_FALSE(unpack_checkpoint(block + "x", state, outputs));
  EXPECT_TRUE(unpack_checkpoint("", state, outputs)) << "a member without checkpoints";
}

TEST(Checkpoint, HugeLengthsAndUnknownTopicsAreDamaged) {
  std::string state;
  std::vector<TickDone::Written> outputs;
  const std::string huge(8, '\xff');
  const std::string zero(8, '\0');
  for (const std::string& block : {huge, huge + huge, zero + huge, zero + huge + huge}) {
    EXPECT_FALSE(unpack_checkpoint(block, state, outputs));
  }
  EXPECT_FALSE(unpack_checkpoint(pack_checkpoint("s", {{topics::kCount, "x"}}), state, outputs));
  std::mt19937 random(20261122);
  for (int i = 0; i < 20'000; ++i) {
    std::string noise(random() % 40, '\0');
    for (char& byte : noise) byte = static_cast<char>(random() % 3 == 0 ? random() : 0);
    if (!unpack_checkpoint(noise, state, outputs) || (state.empty() && outputs.empty())) continue;
    EXPECT_EQ(noise, pack_checkpoint(state, outputs)) << i;
  }
}

TEST(ConfigHash, DependsOnRosterAndPlant) {
  const std::string hash = run_config_hash("", {"physics", "control", "planner"}, "physics");
  EXPECT_EQ(run_config_hash("", {"physics", "control", "planner"}, "physics"), hash);
  EXPECT_NE(run_config_hash("", {"physics", "control"}, "physics"), hash);
  EXPECT_NE(run_config_hash("", {"physics", "controlplanner"}, "physics"), hash);
  EXPECT_NE(run_config_hash("", {"physics", "control", "planner"}, "control"), hash);
  EXPECT_NE(run_config_hash("", {"physics", "control", "planner"}, "physics", {{"control", 5}}), hash);
  EXPECT_NE(run_config_hash("", {"physics", "control", "planner"}, "physics", {{"control", 5}}),
            run_config_hash("", {"physics", "control", "planner"}, "physics", {{"planner", 5}}));
}

}  // namespace
}  // namespace constrictor
