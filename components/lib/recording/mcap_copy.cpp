#include "recording/mcap_copy.hpp"

namespace constrictor::mcap {

Copy::Copy(const std::filesystem::path& file, const Reader& source)
    : source_(source), writer_(file, source.contents().profile, source.contents().library) {}

void Copy::copy(const Channel& channel, const Message& message) {
  const auto [id, is_new] = channels_.try_emplace(channel.id, 0);
  if (is_new) {
    const Schema* schema = source_.schema_of(channel);
    id->second = writer_.add_channel(
        schema ? writer_.add_schema(schema->name, schema->encoding, schema->data) : std::uint16_t{0}, channel.topic,
        channel.message_encoding, channel.metadata);
  }
  Message copied = message;
  copied.channel_id = id->second;
  writer_.write(copied);
}

void Copy::finish(const std::vector<Metadata>& last) {
  writer_.close_chunk();
  writer_.finish(last);
}

}  // namespace constrictor::mcap
