// Hashes of messages with a neutral header, for every topic.
#include "barrier/topic_ops.hpp"

#include <gtest/gtest.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

#include "../idl/random_message.hpp"
#include "runtime/hash_log.hpp"
#include "support/temporary_folder.hpp"

namespace constrictor {
namespace {

std::span<const std::byte> span_of(const std::string& bytes) { return std::as_bytes(std::span(bytes)); }

std::string bytes_of(std::size_t topic, const Sample& sample) {
  std::string bytes;
  topic_ops(topic).append_bytes(sample.message.get(), bytes);
  return bytes;
}

/// Calls `check(topic, message)` with a random message of each topic.
template <class Check>
void for_each_topic(Check check) {
  testing::RandomFiller fill(11);
  const auto one = [&](const auto& topic) {
    using Message = typename std::decay_t<decltype(topic)>::message_type;
    const auto message = std::make_unique<Message>();
    Description<Message>::visit(*message, fill);
    check(topic, *message);
  };
  std::apply([&](const auto&... topic) { (one(topic), ...); }, topics::kAll);
}

const msg::Header kHeader{0x1122334455667788, 3, 2, 77, 1'540'000'000, 9};

TEST(TopicOps, FindTheHeaderInTheBytesOfEveryMessage) {
  for_each_topic([](const auto& topic, const auto& message) {
    SCOPED_TRACE(topic.name);
    const std::string bytes = bytes_of(topic.id, topic_ops(topic.id).stamp(&message, kHeader, 0x0102));
    const auto at = topic_ops(topic.id).header_at(span_of(bytes));
    ASSERT_TRUE(at);
    EXPECT_EQ(bytes.substr(0, 2), "\x02\x01") << "the robot id comes first";
    const msg::Header found = parse_header(span_of(bytes).subspan(*at).template first<kHeaderSize>());
    EXPECT_EQ(found.run_id, kHeader.run_id);
    EXPECT_EQ(found.tick, kHeader.tick);
    EXPECT_EQ(found.sequence_number, kHeader.sequence_number);
    // The bytes of the same message with another header differ nowhere else.
    const msg::Header neutral = neutral_header(kHeader);
    std::string changed = bytes;
    const HeaderBytes replaced = header_bytes(neutral);
    changed.replace(*at, kHeaderSize, reinterpret_cast<const char*>(replaced.data()), replaced.size());
    EXPECT_EQ(changed, bytes_of(topic.id, topic_ops(topic.id).stamp(&message, neutral, 0x0102)));
    for (std::size_t size = 0; size < *at + kHeaderSize; ++size)
      EXPECT_FALSE(topic_ops(topic.id).header_at(span_of(bytes).first(size))) << size;
  });
}

TEST(HashLog, HoldsTheHashOfTheMessageWithANeutralHeaderAndWithoutRobot) {
  const testing::TemporaryFolder folder;
  std::vector<std::uint64_t> expected;
  {
    HashLog log(folder.path());
    for_each_topic([&](const auto& topic, const auto& message) {
      const TopicOps& ops = topic_ops(topic.id);
      const Sample sample = ops.stamp(&message, kHeader, 7);
      if (topic.id % 2 == 0) log.add(topics::kInfos[topic.id], sample);
      else log.add(static_cast<std::uint8_t>(topic.id), bytes_of(topic.id, sample));
      const std::string neutral = bytes_of(topic.id, ops.stamp(&message, {0, 0, 0, 77, 1'540'000'000, 9}, 0));
      expected.push_back(XXH3_64bits(neutral.data(), neutral.size()));
    });
    log.add(0, "too short");
  }
  const auto entries = HashLog::read(folder.path());
  ASSERT_EQ(entries.size(), expected.size());
  for (std::size_t i = 0; i < entries.size(); ++i) {
    EXPECT_EQ(entries[i].topic, i);
    EXPECT_EQ(entries[i].tick, 77);
    EXPECT_EQ(entries[i].sequence_number, 9u);
    EXPECT_EQ(entries[i].hash, expected[i]) << topics::kInfos[i].name;
  }
}

}  // namespace
}  // namespace constrictor
