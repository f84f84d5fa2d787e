#include "recording/mcap_format.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <fstream>
#include <type_traits>

namespace constrictor::mcap {

void Contents::note_message(std::uint16_t channel, std::uint64_t log_time) {
  Statistics& s = statistics;
  s.start_time = s.message_count == 0 ? log_time : std::min(s.start_time, log_time);
  s.end_time = s.message_count == 0 ? log_time : std::max(s.end_time, log_time);
  ++s.message_count;
  ++s.channel_message_counts[channel];
}

Statistics Contents::complete_statistics() const {
  Statistics complete = statistics;
  complete.schema_count = static_cast<std::uint16_t>(schemas.size());
  complete.channel_count = static_cast<std::uint32_t>(channels.size());
  complete.attachment_count = static_cast<std::uint32_t>(attachments.size());
  complete.metadata_count = static_cast<std::uint32_t>(metadata.size());
  complete.chunk_count = static_cast<std::uint32_t>(chunks.size());
  return complete;
}

void Encoder::texts(const Texts& entries) {
  std::string list;
  Encoder encoder(list);
  for (const auto& [name, value] : entries) {
    encoder.text(name);
    encoder.text(value);
  }
  text(list);
}

void Decoder::damaged(const std::string& found) const { throw Error(what_ + ": " + found); }

Bytes Decoder::take(std::uint64_t size) {
  if (size > bytes_.size()) damaged(fmt::format("ends {} bytes too early", size - bytes_.size()));
  const Bytes taken = bytes_.first(static_cast<std::size_t>(size));
  bytes_ = bytes_.subspan(static_cast<std::size_t>(size));
  return taken;
}

std::string Decoder::text() { return std::string(text_of(take(number<std::uint32_t>()))); }

Decoder Decoder::part() { return {take(number<std::uint32_t>()), what_}; }

Texts Decoder::texts() {
  Decoder list = part();
  Texts entries;
  while (list.left() > 0) {
    std::string name = list.text();
    entries[std::move(name)] = list.text();
  }
  return entries;
}

namespace {

/// The fields of a record one after the other, each in the form of its type.
template <class... Fields>
std::string encoded(const Fields&... fields) {
  std::string bytes;
  Encoder encoder(bytes);
  const auto put = [&](const auto& field) {
    using Field = std::decay_t<decltype(field)>;
    if constexpr (std::is_same_v<Field, std::string>) encoder.text(field);
    else if constexpr (std::is_same_v<Field, Texts>) encoder.texts(field);
    else encoder.number(field);
  };
  (put(fields), ...);
  return bytes;
}

/// Reads fields in the form in which encoded() writes them.
template <class... Fields>
void decode(Decoder& decoder, Fields&... fields) {
  const auto take = [&](auto& field) {
    using Field = std::decay_t<decltype(field)>;
    if constexpr (std::is_same_v<Field, std::string>) field = decoder.text();
    else if constexpr (std::is_same_v<Field, Texts>) field = decoder.texts();
    else field = decoder.number<Field>();
  };
  (take(fields), ...);
}

/// A list of pairs of numbers, to be written as a text.
template <class Pairs>
std::string pairs(const Pairs& numbers) {
  std::string bytes;
  for (Encoder encoder(bytes); const auto& [first, second] : numbers) {
    encoder.number(first);
    encoder.number(second);
  }
  return bytes;
}

}  // namespace

void append_record(std::string& bytes, Op op, std::string_view content) {
  Encoder encoder(bytes);
  encoder.number(static_cast<std::uint8_t>(op));
  encoder.number(static_cast<std::uint64_t>(content.size()));
  encoder.raw(content);
}

std::string encode(const Schema& schema) { return encoded(schema.id, schema.name, schema.encoding, schema.data); }

std::string encode(const Channel& channel) {
  return encoded(channel.id, channel.schema_id, channel.topic, channel.message_encoding, channel.metadata);
}

std::string encode(const ChunkIndex& index) {
  return encoded(index.start_time, index.end_time, index.offset, index.length, pairs(index.message_index_offsets),
                 index.message_index_length, index.compression, index.compressed_size, index.uncompressed_size);
}

std::string encode(const Statistics& statistics) {
  return encoded(statistics.message_count, statistics.schema_count, statistics.channel_count,
                 statistics.attachment_count, statistics.metadata_count, statistics.chunk_count, statistics.start_time,
                 statistics.end_time, pairs(statistics.channel_message_counts));
}

std::string encode(const Attachment& attachment) {
  // The second time is that at which it was created.
  std::string bytes = encoded(attachment.log_time, attachment.log_time, attachment.name, attachment.media_type,
                              static_cast<std::uint64_t>(attachment.data.size()));
  Encoder encoder(bytes);
  encoder.raw(attachment.data);
  encoder.number(crc32(bytes_of(bytes)));
  return bytes;
}

std::string encode(const Metadata& metadata) { return encoded(metadata.name, metadata.entries); }

std::string encode(const AttachmentIndex& index) {
  return encoded(index.offset, index.length, index.log_time, index.log_time, index.data_size, index.name,
                 index.media_type);
}

std::string encode(const MetadataIndex& index) { return encoded(index.offset, index.length, index.name); }

void append_message_index(std::string& bytes, std::uint16_t channel, const MessageIndex& index) {
  const std::uint32_t size = static_cast<std::uint32_t>(index.size() * 2 * sizeof(std::uint64_t));
  Encoder encoder(bytes);
  encoder.number(static_cast<std::uint8_t>(Op::kMessageIndex));
  encoder.number(static_cast<std::uint64_t>(sizeof channel + sizeof size + size));
  encoder.number(channel);
  encoder.number(size);
  for (const auto& [log_time, offset] : index) {
    encoder.number(log_time);
    encoder.number(offset);
  }
}

Schema decode_schema(Bytes bytes) {
  Decoder decoder(bytes, "Schema record");
  Schema schema;
  decode(decoder, schema.id);
  if (schema.id == 0) decoder.damaged("found id 0, accepted 1 to 65535");
  decode(decoder, schema.name, schema.encoding, schema.data);
  return schema;
}

Channel decode_channel(Bytes bytes) {
  Decoder decoder(bytes, "Channel record");
  Channel channel;
  decode(decoder, channel.id, channel.schema_id, channel.topic, channel.message_encoding, channel.metadata);
  return channel;
}

Message decode_message(Bytes bytes) {
  Decoder decoder(bytes, "Message record");
  Message message;
  decode(decoder, message.channel_id, message.sequence, message.log_time, message.publish_time);
  message.data = decoder.take(decoder.left());
  return message;
}

Attachment decode_attachment(Bytes bytes) {
  Decoder decoder(bytes, "Attachment record");
  Attachment attachment;
  std::uint64_t created = 0;
  decode(decoder, attachment.log_time, created, attachment.name, attachment.media_type);
  attachment.data = std::string(text_of(decoder.take(decoder.number<std::uint64_t>())));
  const std::size_t checked = bytes.size() - decoder.left();
  const auto crc = decoder.number<std::uint32_t>();
  if (crc != 0 && crc != crc32(bytes.first(checked)))
    decoder.damaged(fmt::format("'{}' does not have the content that its checksum states", attachment.name));
  return attachment;
}

Metadata decode_metadata(Bytes bytes) {
  Decoder decoder(bytes, "Metadata record");
  Metadata metadata;
  decode(decoder, metadata.name, metadata.entries);
  return metadata;
}

Statistics decode_statistics(Bytes bytes) {
  Decoder decoder(bytes, "Statistics record");
  Statistics statistics;
  decode(decoder, statistics.message_count, statistics.schema_count, statistics.channel_count,
         statistics.attachment_count, statistics.metadata_count, statistics.chunk_count, statistics.start_time,
         statistics.end_time);
  Decoder counts = decoder.part();
  while (counts.left() > 0) {
    const auto channel = counts.number<std::uint16_t>();
    statistics.channel_message_counts[channel] = counts.number<std::uint64_t>();
  }
  return statistics;
}

std::uint32_t crc32(Bytes bytes, std::uint32_t before) {
  if (bytes.empty()) return before;  // zlib takes a null pointer for a request of the initial value
  return static_cast<std::uint32_t>(::crc32_z(before, bytes.data(), bytes.size()));
}

bool is_mcap(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::string start(kMagic.size(), '\0');
  return file.read(start.data(), static_cast<std::streamsize>(start.size())) && start == kMagic;
}

}  // namespace constrictor::mcap
