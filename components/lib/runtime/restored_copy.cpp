#include "runtime/restored_copy.hpp"

#include <string>

#include "recording/message_cdr.hpp"

namespace constrictor {

RestoredCopy::RestoredCopy(const std::filesystem::path& file, const mcap::Reader& reader)
    : reader_(reader), writer_(file, reader.contents().profile, reader.contents().library) {}

void RestoredCopy::copy(mcap::Metadata metadata) {
  if (metadata.name == "recording") metadata.entries["images"] = "on";
  writer_.add_metadata(metadata);
}

void RestoredCopy::copy(const mcap::Channel& channel, const mcap::Message& message) {
  const auto [id, is_new] = ids_.try_emplace(channel.id, 0);
  if (is_new) {
    const mcap::Schema* schema = reader_.schema_of(channel);
    id->second = writer_.add_channel(
        schema ? writer_.add_schema(schema->name, schema->encoding, schema->data) : std::uint16_t{0}, channel.topic,
        channel.message_encoding, channel.metadata);
  }
  mcap::Message copied = message;
  copied.channel_id = id->second;
  writer_.write(copied);
}

void RestoredCopy::expect(const TopicInfo& topic, const mcap::Channel& channel, const mcap::Message& message) {
  const auto image = message_of<msg::CameraImage>(message.data);
  if (!image) return;
  Waiting& waiting = waiting_[{topic.id, image->header.sequence_number}];
  waiting = {channel, message, *image};
  waiting.message.data = {};
  waiting.image.data = {};
}

void RestoredCopy::complete(const TopicInfo& topic, const msg::CameraImage& computed) {
  const auto found = waiting_.find({topic.id, computed.header.sequence_number});
  if (found == waiting_.end()) return;
  Waiting& waiting = found->second;
  waiting.image.data = computed.data;
  const std::string cdr = cdr_of(waiting.image);
  waiting.message.data = mcap::bytes_of(cdr);
  copy(waiting.channel, waiting.message);
  waiting_.erase(found);
}

std::size_t RestoredCopy::finish() {
  writer_.finish();
  return waiting_.size();
}

}  // namespace constrictor
