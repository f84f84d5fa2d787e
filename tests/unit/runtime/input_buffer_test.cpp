// The samples of a topic that a step sees when samples arrive early, late, twice or damaged. Also: sets of topics.
#include "barrier/input_buffer.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "barrier_fixture.hpp"
#include "component/topic_set.hpp"

namespace constrictor {
namespace {

constexpr auto& kTopic = topics::kTaskEvent;
using Arrival = InputBuffer::Arrival;

msg::TaskEvent event(std::uint64_t goal_id) {
  msg::TaskEvent message{};
  message.goal_id = goal_id;
  return message;
}
Sample numbered(std::uint64_t sequence_number, std::uint32_t incarnation = 1) {
  return sample_of(kTopic, sequence_number, event(100 * incarnation + sequence_number), incarnation);
}
msg::Tick showing(std::uint64_t count, std::int64_t index = 1) { return tick_at(index, {{kTopic.id, count}}); }
std::vector<std::uint64_t> fresh(const InputBuffer& buffer) {
  std::vector<std::uint64_t> sequence_numbers;
  for (const auto& sample : buffer.slot().fresh) sequence_numbers.push_back(sample.header->sequence_number);
  return sequence_numbers;
}

TEST(InputBuffer, OrderOfArrivalHasNoEffect) {
  std::vector<std::uint64_t> order = {1, 2, 3, 4, 5};
  std::mt19937 random(20261122);
  for (int i = 0; i < 20; ++i) {
    InputBuffer buffer(kTopic, /*events=*/true);
    for (const std::uint64_t number : order) buffer.keep(numbered(number), true);
    ASSERT_TRUE(buffer.complete(showing(3)));
    buffer.present(showing(3));
    EXPECT_EQ(fresh(buffer), (std::vector<std::uint64_t>{1, 2, 3})) << "samples 4 and 5 came too early";
    buffer.present(showing(5, 2));
    EXPECT_EQ(fresh(buffer), (std::vector<std::uint64_t>{4, 5}));
    std::shuffle(order.begin(), order.end(), random);
  }
}

TEST(InputBuffer, EventsWaitForEverySampleAndTheLatestOnlyForTheNewest) {
  InputBuffer events(kTopic, true);
  InputBuffer latest(kTopic, false);
  for (const std::uint64_t number : {1, 3}) {
    events.keep(numbered(number), true);
    latest.keep(numbered(number), true);
  }
  EXPECT_FALSE(events.complete(showing(3)));
  EXPECT_TRUE(latest.complete(showing(3)));
  latest.present(showing(3));
  EXPECT_EQ(fresh(latest), std::vector<std::uint64_t>{3});
  EXPECT_EQ(latest.consumed(), 3u);
  latest.present(showing(3, 2));
  EXPECT_TRUE(fresh(latest).empty()) << "the sample is no longer fresh, but still the latest";
  EXPECT_EQ(latest.slot().latest.header->sequence_number, 3u);
}

TEST(InputBuffer, ASampleOfAnotherIncarnationThanTheTickNamesIsWaitedFor) {
  InputBuffer buffer(kTopic, false);
  buffer.keep(numbered(1, 1), true);
  msg::Tick tick = showing(1);
  tick.incarnations[kTopic.id] = 2;
  EXPECT_FALSE(buffer.complete(tick));
  ASSERT_EQ(buffer.classify(*numbered(1, 2).header), Arrival::kReplacement);
  buffer.keep(numbered(1, 2), true);
  EXPECT_TRUE(buffer.complete(tick));
  buffer.present(tick);
  EXPECT_EQ(buffer.slot().latest.header->incarnation, 2u);
}

TEST(InputBuffer, KnownSamplesAreDuplicatesAndSeenOnesAreNeverReplaced) {
  InputBuffer buffer(kTopic, false);
  EXPECT_EQ(buffer.classify(*numbered(0).header), Arrival::kDuplicate) << "sequence numbers begin at 1";
  EXPECT_EQ(buffer.classify(*numbered(1).header), Arrival::kNew);
  buffer.keep(numbered(1), true);
  EXPECT_EQ(buffer.classify(*numbered(1).header), Arrival::kDuplicate);
  buffer.present(showing(1));
  EXPECT_EQ(buffer.classify(*numbered(1, 2).header), Arrival::kDuplicate);
}

TEST(InputBuffer, ASequenceNumberFarAheadIsRejected) {
  InputBuffer buffer(kTopic, false);
  EXPECT_EQ(buffer.classify(*numbered(InputBuffer::kFarthestAhead).header), Arrival::kNew);
  EXPECT_EQ(buffer.classify(*numbered(InputBuffer::kFarthestAhead + 1).header), Arrival::kTooFarAhead);
}

TEST(InputBuffer, AnInvalidSampleKeepsItsPlaceAndThePreviousOneStaysInForce) {
  for (const bool events : {true, false}) {
    InputBuffer buffer(kTopic, events);
    buffer.keep(numbered(1), true);
    buffer.present(showing(1));
    buffer.keep(numbered(2), false);
    ASSERT_TRUE(buffer.complete(showing(2))) << "a step must not wait for an invalid sample";
    buffer.present(showing(2));
    EXPECT_TRUE(fresh(buffer).empty());
    EXPECT_EQ(buffer.slot().latest.header->sequence_number, 1u);
    EXPECT_EQ(buffer.consumed(), 2u);
  }
}

TEST(InputBuffer, AtRealTimePaceAStepSeesWhatHasArrived) {
  InputBuffer buffer(kTopic, true);
  msg::Tick tick = showing(9);
  tick.realtime = true;
  EXPECT_TRUE(buffer.complete(tick));
  buffer.keep(numbered(2), true);
  buffer.keep(numbered(4), true);
  buffer.present(tick);
  EXPECT_EQ(fresh(buffer), (std::vector<std::uint64_t>{2, 4}));
  EXPECT_EQ(buffer.consumed(), 4u);
}

TEST(TopicSet, HasWhatWasInsertedAndNoUnknownTopic) {
  TopicSet set = TopicSet::of(topics::kJointState, topics::kTaskEvent);
  EXPECT_TRUE(set.contains(topics::kJointState.id));
  EXPECT_TRUE(set.contains(topics::kTaskEvent.id));
  EXPECT_FALSE(set.contains(topics::kJointCommand.id));
  EXPECT_EQ(TopicSet::from_bits(set.bits()), set);
  set.erase(topics::kTaskEvent.id);
  EXPECT_EQ(set, TopicSet::of(topics::kJointState));
  set.erase(topics::kJointState.id);
  EXPECT_TRUE(set.empty());
  const TopicSet every = TopicSet::from_bits(~std::uint64_t{0});
  for (std::size_t id = 0; id < 300; ++id) EXPECT_EQ(every.contains(id), id < msg::kMaxTopics) << id;
}

}  // namespace
}  // namespace constrictor
