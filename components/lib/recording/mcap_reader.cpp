#include "recording/mcap_reader.hpp"

#include <fmt/format.h>
#include <zstd.h>

#include <algorithm>

namespace constrictor::mcap {
namespace {

constexpr std::uint64_t kFooterLength = 20;

struct ChunkHeader {
  std::uint64_t start_time;
  std::uint64_t end_time;
  std::uint64_t uncompressed_size;
  std::uint32_t crc;
  std::string compression;
  Bytes records;
};

ChunkHeader decode_chunk(Bytes content) {
  Decoder decoder(content, "Chunk record");
  ChunkHeader chunk{};
  chunk.start_time = decoder.number<std::uint64_t>();
  chunk.end_time = decoder.number<std::uint64_t>();
  chunk.uncompressed_size = decoder.number<std::uint64_t>();
  chunk.crc = decoder.number<std::uint32_t>();
  chunk.compression = decoder.text();
  chunk.records = decoder.take(decoder.number<std::uint64_t>());
  return chunk;
}

template <class T>
void add(std::map<std::uint16_t, T>& known, T value, const char* what) {
  const auto [at, is_new] = known.emplace(value.id, value);
  if (!is_new && at->second != value)
    throw Error(fmt::format("{} record: found a second definition of id {}, accepted the same one", what, value.id));
}

constexpr std::size_t kCheckedOfFooter = kRecordHeader + 16;  // [byte] that the checksum of the summary covers

}  // namespace

Bytes uncompress_chunk(Bytes content, std::string& buffer) {
  const ChunkHeader chunk = decode_chunk(content);
  const auto damaged = [](const std::string& why) { return Error("Chunk record: " + why); };
  if (chunk.uncompressed_size > kLargestChunk)
    throw damaged(fmt::format("found {} bytes, accepted at most {}", chunk.uncompressed_size, kLargestChunk));
  Bytes records = chunk.records;
  if (chunk.compression == "zstd") {
    buffer.resize(chunk.uncompressed_size);
    const std::size_t size = ZSTD_decompress(buffer.data(), buffer.size(), records.data(), records.size());
    if (ZSTD_isError(size) != 0) throw damaged(fmt::format("zstd: {}", ZSTD_getErrorName(size)));
    records = bytes_of(buffer).first(size);
  } else if (!chunk.compression.empty()) {
    throw damaged(fmt::format("found compression '{}', accepted zstd or none", chunk.compression));
  }
  if (records.size() != chunk.uncompressed_size)
    throw damaged(fmt::format("found {} bytes, but it states {}", records.size(), chunk.uncompressed_size));
  if (chunk.crc != 0 && chunk.crc != crc32(records))
    throw damaged("does not have the content that its checksum states");
  return records;
}

void for_each_record(Bytes records, const std::function<void(Op, Bytes, std::uint64_t)>& use) {
  Decoder decoder(records, "record in a chunk");
  while (decoder.left() > 0) {
    const std::uint64_t offset = records.size() - decoder.left();
    const auto op = static_cast<Op>(decoder.number<std::uint8_t>());
    use(op, decoder.take(decoder.number<std::uint64_t>()), offset);
  }
}

Reader::Reader(const std::filesystem::path& path) : file_(path, File::Mode::kRead) {
  const std::string start = file_.read(0, kMagic.size() + kRecordHeader);
  if (start.empty()) throw Error(path.string() + ": is empty; accepted are files of `constrictor record`");
  if (!start.starts_with(kMagic))
    throw Error(path.string() + ": is not an MCAP file (its first bytes differ); accepted are files of " +
                "`constrictor record` and `constrictor run --record`");
  if (start.size() < kMagic.size() + kRecordHeader)
    throw Error(path.string() + ": the file ends within its header and contains no messages");
  Decoder decoder(bytes_of(start).subspan(kMagic.size()), place(kMagic.size()) + "Header record");
  const auto op = static_cast<Op>(decoder.number<std::uint8_t>());
  const auto length = decoder.number<std::uint64_t>();
  if (op != Op::kHeader) decoder.damaged("found another record");
  content_ = file_.read(kMagic.size() + kRecordHeader, std::min<std::uint64_t>(length, 1 << 20));
  Decoder header(bytes_of(content_), place(kMagic.size()) + "Header record");
  if (content_.size() < length) header.damaged("is longer than accepted, or the file ends here");
  contents_.profile = header.text();
  contents_.library = header.text();
  first_record_ = data_end_ = kMagic.size() + kRecordHeader + length;
}

std::string Reader::place(std::uint64_t offset) const {
  return fmt::format("{}: damaged at byte {}: ", file_.path().string(), offset);
}

const Schema* Reader::schema_of(const Channel& channel) const {
  const auto found = contents_.schemas.find(channel.schema_id);
  return found == contents_.schemas.end() ? nullptr : &found->second;
}

void Reader::read(const Visitor& visitor) { read_all(visitor, nullptr); }

void Reader::read_undamaged(const Visitor& visitor, const LeftOut& left_out) {
  learn_definitions();
  read_all(visitor, &left_out);
}

void Reader::learn_definitions() {
  const std::uint64_t end = kRecordHeader + kFooterLength + kMagic.size();
  const std::uint64_t size = file_.size();
  if (size < first_record_ + end) return;
  const std::string tail = file_.read(size - end, end);
  if (!std::string_view(tail).ends_with(kMagic)) return;
  try {
    Decoder footer(bytes_of(tail).subspan(kRecordHeader), "Footer record");
    const auto start = footer.number<std::uint64_t>();
    if (start < first_record_ || start > size - end) return;
    footer.number<std::uint64_t>();
    const auto crc = footer.number<std::uint32_t>();
    const std::string summary = file_.read(start, size - end - start);
    // A wrong definition here would make the right one in the data section look wrong.
    if (crc != 0 && crc != crc32(bytes_of(tail).first(kCheckedOfFooter), crc32(bytes_of(summary)))) return;
    for_each_record(bytes_of(summary), [this](Op op, Bytes content, std::uint64_t) {
      if (op == Op::kSchema) add_schema(content);
      else if (op == Op::kChannel) add_channel(content);
    });
  } catch (const Error&) {  // a missing part counts as damage where it is needed
  }
}

void Reader::read_all(const Visitor& visitor, const LeftOut* left_out) {
  const std::uint64_t size = file_.size();
  std::uint64_t at = first_record_;
  incomplete_ = "it has no end: its writer was killed, or is still writing it";
  bool after_damage = false;
  const auto rest = [&] {
    if (left_out && at < size) (*left_out)(at, size - at, "the file ends within a record, or the length is wrong");
  };
  while (at < size) {
    const std::string header = file_.read(at, kRecordHeader);
    if (header.size() < kRecordHeader) return rest();
    Decoder decoder(bytes_of(header), "");
    const auto op = static_cast<Op>(decoder.number<std::uint8_t>());
    const auto length = decoder.number<std::uint64_t>();
    if (length > size - at - kRecordHeader) return rest();
    content_ = file_.read(at + kRecordHeader, length);
    if (content_.size() < length) return rest();
    if (op != Op::kMessageIndex) after_damage = false;
    try {
      if (op == Op::kDataEnd) {
        data_end_ = at;
        Decoder(bytes_of(content_), "DataEnd record").number<std::uint32_t>();
        if (left_out) return;  // a summary does not fit to what is left
        return read_summary(at + kRecordHeader + length);
      }
      read_record(op, bytes_of(content_), at, kRecordHeader + length, visitor);
    } catch (const DiskFull&) {
      throw;  // of what the visitor writes
    } catch (const Error& error) {
      if (!left_out) throw Error(place(at) + error.what() + "; `constrictor recover` keeps what can be read");
      last_index_.clear();
      // Indexes are made anew. Those of a damaged chunk fit to nothing.
      if (op != Op::kMessageIndex) (*left_out)(at, kRecordHeader + length, error.what());
      else if (!after_damage) (*left_out)(at, 0, error.what());
      after_damage = true;
    }
    at += kRecordHeader + length;
    data_end_ = at;
  }
}

void Reader::read_record(Op op, Bytes content, std::uint64_t offset, std::uint64_t length, const Visitor& visitor) {
  if (op == Op::kMessageIndex) return read_message_index(content, offset, length);
  last_index_.clear();
  switch (op) {
    case Op::kChunk:
      return read_chunk(content, offset, length, visitor);
    case Op::kSchema:
    case Op::kChannel:
    case Op::kMessage:
      return read_inner(op, content, visitor);
    case Op::kAttachment: {
      const Attachment attachment = decode_attachment(content);
      contents_.attachments.push_back(
          {offset, length, attachment.log_time, attachment.data.size(), attachment.name, attachment.media_type});
      if (visitor.attachment) visitor.attachment(attachment);
      return;
    }
    case Op::kMetadata: {
      const Metadata metadata = decode_metadata(content);
      contents_.metadata.push_back({offset, length, metadata.name});
      if (visitor.metadata) visitor.metadata(metadata);
      return;
    }
    default:
      // The specification reserves the codes from 0x80 for other programs. All others that may stand here are above.
      if (static_cast<std::uint8_t>(op) < 0x80)
        throw Error(
            fmt::format("found opcode 0x{:02x}, accepted a record of the data section", static_cast<unsigned>(op)));
  }
}

void Reader::read_chunk(Bytes content, std::uint64_t offset, std::uint64_t length, const Visitor& visitor) {
  const ChunkHeader header = decode_chunk(content);
  const Bytes records = uncompress_chunk(content, uncompressed_);
  ChunkIndex index{header.start_time,     header.end_time,         offset, length, {}, 0, header.compression,
                   header.records.size(), header.uncompressed_size};
  std::map<std::uint16_t, MessageIndex> messages;
  for_each_record(records, [&](Op op, Bytes inner, std::uint64_t at) {
    if (op == Op::kMessage) {
      const Message message = decode_message(inner);
      if (message.log_time < header.start_time || message.log_time > header.end_time)
        throw Error("Chunk record: a message is not within its times");
      messages[message.channel_id].emplace_back(message.log_time, at);
    } else if (op != Op::kSchema && op != Op::kChannel) {
      throw Error(fmt::format("found opcode 0x{:02x} in a chunk, accepted schemas, channels and messages",
                              static_cast<unsigned>(op)));
    }
  });
  for_each_record(records, [&](Op op, Bytes inner, std::uint64_t) { read_inner(op, inner, visitor); });
  contents_.chunks.push_back(std::move(index));
  last_index_ = std::move(messages);
}

void Reader::read_inner(Op op, Bytes content, const Visitor& visitor) {
  if (op == Op::kSchema) return add_schema(content);
  if (op == Op::kChannel) return add_channel(content);
  const Message message = decode_message(content);
  const Channel& channel = channel_of(message);
  contents_.note_message(channel.id, message.log_time);
  if (visitor.message) visitor.message(channel, message);
}

void Reader::add_schema(Bytes content) { add(contents_.schemas, decode_schema(content), "Schema"); }

void Reader::add_channel(Bytes content) {
  Channel channel = decode_channel(content);
  if (channel.schema_id != 0 && !contents_.schemas.contains(channel.schema_id))
    throw Error(fmt::format("Channel record: found schema {}, which is not defined", channel.schema_id));
  add(contents_.channels, std::move(channel), "Channel");
}

const Channel& Reader::channel_of(const Message& message) const {
  const auto channel = contents_.channels.find(message.channel_id);
  if (channel == contents_.channels.end())
    throw Error(fmt::format("Message record: found channel {}, which is not defined", message.channel_id));
  return channel->second;
}

void Reader::read_message_index(Bytes content, std::uint64_t offset, std::uint64_t length) {
  Decoder decoder(content, "MessageIndex record");
  const auto channel = decoder.number<std::uint16_t>();
  Decoder entries = decoder.part();
  MessageIndex found;
  while (entries.left() > 0) {
    const auto time = entries.number<std::uint64_t>();
    found.emplace_back(time, entries.number<std::uint64_t>());
  }
  if (found.empty()) return;  // some writers write an index for channels without messages
  const auto expected = last_index_.find(channel);
  if (expected == last_index_.end()) decoder.damaged("found a channel without messages in the chunk before");
  // The order of messages with equal times is not specified.
  std::sort(found.begin(), found.end());
  std::sort(expected->second.begin(), expected->second.end());
  if (found != expected->second) decoder.damaged("does not agree with the chunk before");
  last_index_.erase(expected);
  contents_.chunks.back().message_index_offsets[channel] = offset;
  contents_.chunks.back().message_index_length += length;
}

void Reader::read_summary(std::uint64_t start) {
  last_index_.clear();  // a finished file need not have indexes
  incomplete_ = "its summary is not complete";
  const std::uint64_t size = file_.size();
  if (size < start + kRecordHeader + kFooterLength + kMagic.size()) return;
  const std::uint64_t footer_at = size - kMagic.size() - kRecordHeader - kFooterLength;
  const std::string bytes = file_.read(start, size - start);
  if (!std::string_view(bytes).ends_with(kMagic)) return;
  Decoder footer(bytes_of(bytes).subspan(footer_at - start), "Footer record");
  if (static_cast<Op>(footer.number<std::uint8_t>()) != Op::kFooter || footer.number<std::uint64_t>() != kFooterLength)
    return;
  const auto summary_start = footer.number<std::uint64_t>();
  footer.number<std::uint64_t>();
  const auto crc = footer.number<std::uint32_t>();
  if (summary_start != 0 && summary_start != start) footer.damaged("does not say where the summary is");
  if (crc != 0 && crc != crc32(bytes_of(bytes).first(footer_at - start + kCheckedOfFooter)))
    footer.damaged("the summary does not have the content that its checksum states");
  for_each_record(bytes_of(bytes).first(footer_at - start), [&](Op op, Bytes content, std::uint64_t) {
    if (op == Op::kSchema) add_schema(content);
    else if (op == Op::kChannel) add_channel(content);
    else if (op == Op::kStatistics && decode_statistics(content) != contents_.complete_statistics())
      throw Error("Statistics record: does not agree with the messages in the file");
  });
  incomplete_.clear();
}

}  // namespace constrictor::mcap
