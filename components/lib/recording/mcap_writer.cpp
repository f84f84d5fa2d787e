#include "recording/mcap_writer.hpp"

#include <fmt/format.h>
#include <zstd.h>

#include <algorithm>
#include <limits>

#include "recording/mcap_reader.hpp"

namespace constrictor::mcap {
namespace {

constexpr int kCompressionLevel = 1;  // higher levels cost more time than they save space for this data
constexpr std::size_t kMostIds = std::numeric_limits<std::uint16_t>::max();

template <class T>
std::uint16_t next_id(const std::map<std::uint16_t, T>& known, const char* what) {
  if (known.size() >= kMostIds)
    throw Error(fmt::format("found {} {}, accepted at most {}", known.size() + 1, what, kMostIds));
  return static_cast<std::uint16_t>(known.empty() ? 1 : known.rbegin()->first + 1);
}

/// Appends the indexes of messages, which begin at `offset` of the file.
void append_index(std::string& bytes, std::uint64_t offset, ChunkIndex& index, std::uint16_t channel,
                  const MessageIndex& messages) {
  const std::size_t before = bytes.size();
  index.message_index_offsets[channel] = offset + before;
  append_message_index(bytes, channel, messages);
  index.message_index_length += bytes.size() - before;
}

}  // namespace

Writer::Writer(const std::filesystem::path& path, const std::string& profile, const std::string& library)
    : file_(path, File::Mode::kCreate), compressor_(ZSTD_createCCtx(), ZSTD_freeCCtx) {
  contents_.profile = profile;
  contents_.library = library;
  std::string header;
  Encoder encoder(header);
  encoder.text(profile);
  encoder.text(library);
  std::string bytes(kMagic);
  append_record(bytes, Op::kHeader, header);
  append({bytes});
}

Writer::Writer(const Reader& reader)
    : file_(reader.path(), File::Mode::kChange),
      compressor_(ZSTD_createCCtx(), ZSTD_freeCCtx),
      contents_(reader.contents()),
      end_(reader.data_end()) {
  for (const auto& [id, schema] : contents_.schemas) defined_schemas_[id] = true;
  for (const auto& [id, channel] : contents_.channels) defined_channels_[id] = true;
  std::string indexes;
  if (!reader.missing_indexes().empty()) {
    // The writer was killed after it had written a chunk, and before it had written all indexes of the chunk.
    ChunkIndex& last = contents_.chunks.back();
    end_ = last.offset + last.length;
    last.message_index_offsets.clear();
    last.message_index_length = 0;
    std::map<std::uint16_t, MessageIndex> all;
    std::string buffer;
    const std::string chunk = file_.read(last.offset + kRecordHeader, last.length - kRecordHeader);
    for_each_record(uncompress_chunk(bytes_of(chunk), buffer), [&](Op op, Bytes content, std::uint64_t offset) {
      if (op != Op::kMessage) return;
      const Message message = decode_message(content);
      all[message.channel_id].emplace_back(message.log_time, offset);
    });
    for (const auto& [channel, messages] : all) append_index(indexes, end_, last, channel, messages);
  }
  summary_size_ = encode_end(contents_, end_).size();
  file_.truncate(end_);
  append({indexes});
}

Writer::~Writer() = default;

void Writer::append(std::initializer_list<std::string_view> parts) {
  std::uint64_t size = 0;
  for (const auto part : parts) size += part.size();
  if (size == 0) return;
  try {
    if (left_free_ > 0) file_.leave_free(left_free_, size + summary_size_ + kReserve);
    file_.reserve(end_, size + summary_size_ + kReserve);  // the end of the file must find space, too
    std::uint64_t at = end_;
    for (const auto part : parts) {
      file_.write(at, part);
      at += part.size();
    }
  } catch (const DiskFull&) {
    file_.truncate(end_);
    throw;
  }
  end_ += size;
}

std::uint16_t Writer::add_schema(const std::string& name, const std::string& encoding, const std::string& data) {
  for (const auto& [id, known] : contents_.schemas) {
    if (known.name == name && known.encoding == encoding && known.data == data) return id;
  }
  const std::uint16_t id = next_id(contents_.schemas, "schemas");
  contents_.schemas[id] = {id, name, encoding, data};
  summary_size_ += kRecordHeader + encode(contents_.schemas[id]).size();
  return id;
}

std::uint16_t Writer::add_channel(std::uint16_t schema, const std::string& topic, const std::string& message_encoding,
                                  const Texts& metadata) {
  for (const auto& [id, known] : contents_.channels) {
    if (known == Channel{id, schema, topic, message_encoding, metadata}) return id;
  }
  const std::uint16_t id = next_id(contents_.channels, "channels");
  contents_.channels[id] = {id, schema, topic, message_encoding, metadata};
  summary_size_ += kRecordHeader + encode(contents_.channels[id]).size();
  return id;
}

void Writer::define_schema(std::uint16_t id) {
  if (id == 0 || defined_schemas_.contains(id)) return;
  append_record(chunk_, Op::kSchema, encode(contents_.schemas.at(id)));
  defined_schemas_[id] = false;
}

void Writer::define(std::uint16_t id) {
  if (defined_channels_.contains(id)) return;
  const Channel& channel = contents_.channels.at(id);
  define_schema(channel.schema_id);
  append_record(chunk_, Op::kChannel, encode(channel));
  defined_channels_[id] = false;
}

void Writer::note(const Message& message, std::uint64_t offset) {
  if (chunk_index_.size() <= message.channel_id) chunk_index_.resize(std::size_t{message.channel_id} + 1);
  chunk_index_[message.channel_id].emplace_back(message.log_time, offset);
  chunk_start_ = chunk_messages_ == 0 ? message.log_time : std::min(chunk_start_, message.log_time);
  chunk_end_ = chunk_messages_ == 0 ? message.log_time : std::max(chunk_end_, message.log_time);
  ++chunk_messages_;
}

void Writer::write(const Message& message) {
  if (finished_) throw Error(file_.path().string() + ": is finished; nothing can be added");
  // A channel that has a message in this chunk is defined.
  if (message.channel_id >= chunk_index_.size() || chunk_index_[message.channel_id].empty()) define(message.channel_id);
  note(message, chunk_.size());
  Encoder encoder(chunk_);
  encoder.number(static_cast<std::uint8_t>(Op::kMessage));
  encoder.number(static_cast<std::uint64_t>(kMessageHeader + message.data.size()));
  encoder.number(message.channel_id);
  encoder.number(message.sequence);
  encoder.number(message.log_time);
  encoder.number(message.publish_time);
  encoder.raw(text_of(message.data));
  if (chunk_.size() >= kChunkSize) close_chunk();
}

void Writer::restore(std::string_view records) {
  forget_chunk();
  for_each_record(bytes_of(records), [&](Op op, Bytes content, std::uint64_t offset) {
    if (op == Op::kSchema) {
      const Schema schema = decode_schema(content);
      contents_.schemas[schema.id] = schema;
      defined_schemas_[schema.id] = false;
    } else if (op == Op::kChannel) {
      const Channel channel = decode_channel(content);
      contents_.channels[channel.id] = channel;
      defined_channels_[channel.id] = false;
    } else if (op == Op::kMessage) {
      const Message message = decode_message(content);
      if (!defined_channels_.contains(message.channel_id))
        throw Error("open chunk: found a channel without definition");
      note(message, offset);
    }
  });
  chunk_ = records;
}

void Writer::close_chunk() {
  if (chunk_.empty()) return;
  const std::size_t bound = ZSTD_compressBound(chunk_.size());
  if (compressed_.size() < bound) compressed_.resize(bound);
  const std::size_t size = ZSTD_compressCCtx(compressor_.get(), compressed_.data(), compressed_.size(), chunk_.data(),
                                             chunk_.size(), kCompressionLevel);
  if (ZSTD_isError(size) != 0) throw Error(fmt::format("zstd: {}", ZSTD_getErrorName(size)));
  std::string fields;
  Encoder encoder(fields);
  encoder.number(chunk_start_);
  encoder.number(chunk_end_);
  encoder.number(static_cast<std::uint64_t>(chunk_.size()));
  encoder.number(crc32(bytes_of(chunk_)));
  encoder.text("zstd");
  encoder.number(static_cast<std::uint64_t>(size));
  std::string head;
  Encoder record(head);
  record.number(static_cast<std::uint8_t>(Op::kChunk));
  record.number(static_cast<std::uint64_t>(fields.size() + size));
  record.raw(fields);
  const std::uint64_t length = head.size() + size;
  ChunkIndex index{chunk_start_, chunk_end_, end_, length, {}, 0, "zstd", size, chunk_.size()};
  indexes_.clear();
  for (std::size_t channel = 0; channel < chunk_index_.size(); ++channel) {
    if (!chunk_index_[channel].empty())
      append_index(indexes_, end_ + length, index, static_cast<std::uint16_t>(channel), chunk_index_[channel]);
  }
  append({head, std::string_view(compressed_).substr(0, size), indexes_});
  Statistics& all = contents_.statistics;
  if (chunk_messages_ > 0) {
    all.start_time = all.message_count == 0 ? chunk_start_ : std::min(all.start_time, chunk_start_);
    all.end_time = all.message_count == 0 ? chunk_end_ : std::max(all.end_time, chunk_end_);
  }
  all.message_count += chunk_messages_;
  for (std::size_t channel = 0; channel < chunk_index_.size(); ++channel) {
    if (!chunk_index_[channel].empty())
      all.channel_message_counts[static_cast<std::uint16_t>(channel)] += chunk_index_[channel].size();
  }
  summary_size_ += kRecordHeader + encode(index).size();
  contents_.chunks.push_back(std::move(index));
  for (auto* defined : {&defined_schemas_, &defined_channels_}) {
    for (auto& [id, in_file] : *defined) in_file = true;
  }
  forget_chunk();
}

void Writer::forget_chunk() {
  for (auto* defined : {&defined_schemas_, &defined_channels_})
    std::erase_if(*defined, [](const auto& entry) { return !entry.second; });
  chunk_.clear();
  for (auto& messages : chunk_index_) messages.clear();
  chunk_messages_ = chunk_start_ = chunk_end_ = 0;
}

void Writer::attach(const Attachment& attachment) {
  std::string bytes;
  append_record(bytes, Op::kAttachment, encode(attachment));
  const std::uint64_t offset = end_;
  append({bytes});
  contents_.attachments.push_back(
      {offset, bytes.size(), attachment.log_time, attachment.data.size(), attachment.name, attachment.media_type});
  summary_size_ += kRecordHeader + encode(contents_.attachments.back()).size();
}

void Writer::add_metadata(const Metadata& metadata) {
  std::string bytes;
  append_record(bytes, Op::kMetadata, encode(metadata));
  const std::uint64_t offset = end_;
  append({bytes});
  contents_.metadata.push_back({offset, bytes.size(), metadata.name});
  summary_size_ += kRecordHeader + encode(contents_.metadata.back()).size();
}

void Writer::finish(const std::vector<Metadata>& last) {
  if (finished_) return;
  try {
    close_chunk();
  } catch (const DiskFull&) {
    forget_chunk();
  }
  finished_ = true;
  // From here on everything is written into the space that was reserved.
  for (const auto& metadata : last) {
    std::string record;
    append_record(record, Op::kMetadata, encode(metadata));
    file_.write(end_, record);
    contents_.metadata.push_back({end_, record.size(), metadata.name});
    end_ += record.size();
  }
  // A reader of the summary expects definitions in the data section, too.
  std::erase_if(contents_.channels, [&](const auto& entry) { return !defined_channels_.contains(entry.first); });
  std::erase_if(contents_.schemas, [&](const auto& entry) { return !defined_schemas_.contains(entry.first); });
  const std::string bytes = encode_end(contents_, end_);
  file_.write(end_, bytes);
  end_ += bytes.size();
  file_.truncate(end_);  // gives back what was reserved
}

}  // namespace constrictor::mcap
