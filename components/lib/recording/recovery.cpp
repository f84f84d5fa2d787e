#include "recording/recovery.hpp"

#include <fmt/format.h>

#include <map>

#include "recording/mcap_reader.hpp"
#include "recording/mcap_writer.hpp"

namespace constrictor::mcap {

Recovered copy_undamaged(const std::filesystem::path& damaged, const std::filesystem::path& copy) {
  Recovered recovered;
  Reader reader(damaged);
  Writer writer(copy, reader.contents().profile, reader.contents().library);
  std::map<std::uint16_t, std::uint16_t> channels;  // of the copy
  Visitor visitor;
  visitor.message = [&](const Channel& channel, const Message& message) {
    const auto [place, added] = channels.try_emplace(channel.id);
    if (added) {
      const Schema* schema = reader.schema_of(channel);
      const std::uint16_t id = schema ? writer.add_schema(schema->name, schema->encoding, schema->data) : 0;
      place->second = writer.add_channel(id, channel.topic, channel.message_encoding, channel.metadata);
    }
    Message copied = message;
    copied.channel_id = place->second;
    writer.write(copied);
    ++recovered.messages;
  };
  visitor.attachment = [&](const Attachment& attachment) { writer.attach(attachment); };
  visitor.metadata = [&](const Metadata& metadata) { writer.add_metadata(metadata); };
  reader.read_undamaged(visitor, [&](std::uint64_t offset, std::uint64_t length, const std::string& why) {
    if (recovered.places++ == 0) recovered.why = fmt::format("damaged at byte {}: {}", offset, why);
    recovered.left_out_bytes += length;
  });
  writer.close_chunk();  // so that a full disk is reported: finish() would leave the chunk out
  writer.finish({{"recovered",
                  {{"cut_bytes", std::to_string(recovered.left_out_bytes)},
                   {"places", std::to_string(recovered.places)},
                   {"reason", recovered.why}}}});
  recovered.chunks = writer.chunks();
  return recovered;
}

}  // namespace constrictor::mcap
