#include "runtime/restored_copy.hpp"

#include <string>

#include "recording/message_cdr.hpp"

namespace constrictor {

void RestoredCopy::copy(mcap::Metadata metadata) {
  if (metadata.name == "recording") metadata.entries["images"] = "on";
  copy_.copy(metadata);
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
  copy_.finish();
  return waiting_.size();
}

}  // namespace constrictor
