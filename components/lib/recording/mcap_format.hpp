// The file format MCAP (https://mcap.dev/spec): its records as values, and their bytes. All numbers are little-endian.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace constrictor::mcap {

/// The file cannot be read or written; what() names the file, what was found and, where it helps, what to do.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

using Bytes = std::span<const std::uint8_t>;

inline constexpr std::string_view kMagic{"\x89MCAP0\r\n", 8};

enum class Op : std::uint8_t {
  kHeader = 0x01,
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kChunk = 0x06,
  kMessageIndex = 0x07,
  kChunkIndex = 0x08,
  kAttachment = 0x09,
  kAttachmentIndex = 0x0A,
  kStatistics = 0x0B,
  kMetadata = 0x0C,
  kMetadataIndex = 0x0D,
  kSummaryOffset = 0x0E,
  kDataEnd = 0x0F,
};

inline constexpr std::size_t kRecordHeader = 9;    ///< [byte] opcode and length of a record
inline constexpr std::size_t kMessageHeader = 22;  ///< [byte] fields of a Message before its data
inline constexpr std::uint64_t kLargestChunk = 1
                                               << 28;  ///< [byte] larger chunks are refused: they would fill the memory

using Texts = std::map<std::string, std::string>;

struct Schema {
  std::uint16_t id = 0;  ///< from 1
  std::string name;
  std::string encoding;  ///< "ros2msg"
  std::string data;
  bool operator==(const Schema&) const = default;
};

struct Channel {
  std::uint16_t id = 0;
  std::uint16_t schema_id = 0;  ///< 0: the messages have no schema
  std::string topic;
  std::string message_encoding;  ///< "cdr"
  Texts metadata;
  bool operator==(const Channel&) const = default;
};

struct Message {
  std::uint16_t channel_id = 0;
  std::uint32_t sequence = 0;
  std::uint64_t log_time = 0;      ///< [ns]
  std::uint64_t publish_time = 0;  ///< [ns]
  Bytes data;                      ///< valid until the next message is read
};

struct Attachment {
  std::uint64_t log_time = 0;  ///< [ns]
  std::string name;
  std::string media_type;
  std::string data;
};

struct Metadata {
  std::string name;
  Texts entries;
};

struct ChunkIndex {
  std::uint64_t start_time = 0;  ///< [ns] log time of the first message
  std::uint64_t end_time = 0;
  std::uint64_t offset = 0;  ///< [byte] of the Chunk record in the file
  std::uint64_t length = 0;  ///< [byte] of the Chunk record
  std::map<std::uint16_t, std::uint64_t> message_index_offsets;
  std::uint64_t message_index_length = 0;
  std::string compression;
  std::uint64_t compressed_size = 0;
  std::uint64_t uncompressed_size = 0;
};

struct AttachmentIndex {
  std::uint64_t offset = 0;
  std::uint64_t length = 0;
  std::uint64_t log_time = 0;
  std::uint64_t data_size = 0;
  std::string name;
  std::string media_type;
};

struct MetadataIndex {
  std::uint64_t offset = 0;
  std::uint64_t length = 0;
  std::string name;
};

struct Statistics {
  std::uint64_t message_count = 0;
  std::uint16_t schema_count = 0;
  std::uint32_t channel_count = 0;
  std::uint32_t attachment_count = 0;
  std::uint32_t metadata_count = 0;
  std::uint32_t chunk_count = 0;
  std::uint64_t start_time = 0;  ///< [ns] log time of the first message; 0: no message
  std::uint64_t end_time = 0;
  std::map<std::uint16_t, std::uint64_t> channel_message_counts;
  bool operator==(const Statistics&) const = default;
};

/// The content of a summary section: everything about the data section but the messages themselves.
struct Contents {
  std::string profile;
  std::string library;
  std::map<std::uint16_t, Schema> schemas;
  std::map<std::uint16_t, Channel> channels;
  std::vector<ChunkIndex> chunks;
  std::vector<AttachmentIndex> attachments;
  std::vector<MetadataIndex> metadata;
  Statistics statistics;  ///< its counts of schemas, channels, attachments, metadata and chunks are those above

  /// Counts one message.
  void note_message(std::uint16_t channel, std::uint64_t log_time);
  /// The statistics with all counts.
  [[nodiscard]] Statistics complete_statistics() const;
};

/// The log times and offsets of one channel's messages within an uncompressed chunk.
using MessageIndex = std::vector<std::pair<std::uint64_t, std::uint64_t>>;

/// Appends the fields of records.
class Encoder {
 public:
  explicit Encoder(std::string& bytes) : bytes_(bytes) {}
  template <class T>
  void number(T value) {
    std::array<char, sizeof(T)> raw;
    for (std::size_t i = 0; i < sizeof(T); ++i) raw[i] = static_cast<char>(value >> (8 * i) & 0xff);
    bytes_.append(raw.data(), raw.size());
  }
  void text(std::string_view value) {
    number(static_cast<std::uint32_t>(value.size()));
    bytes_.append(value);
  }
  void texts(const Texts& entries);
  void raw(std::string_view value) { bytes_.append(value); }

 private:
  std::string& bytes_;
};

/// Reads the fields of a record. Each function throws Error if the record ends too early.
class Decoder {
 public:
  /// `what`: the record, for the error.
  Decoder(Bytes bytes, std::string what) : bytes_(bytes), what_(std::move(what)) {}
  template <class T>
  T number() {
    const Bytes raw = take(sizeof(T));
    T value = 0;
    for (std::size_t i = 0; i < sizeof(T); ++i) value = static_cast<T>(value | static_cast<T>(T{raw[i]} << (8 * i)));
    return value;
  }
  std::string text();
  Texts texts();
  /// A part of the record with its own length, 32 bits.
  Decoder part();
  Bytes take(std::uint64_t size);
  [[nodiscard]] std::size_t left() const { return bytes_.size(); }
  [[noreturn]] void damaged(const std::string& found) const;

 private:
  Bytes bytes_;
  std::string what_;
};

/// Appends a whole record.
void append_record(std::string& bytes, Op op, std::string_view content);

[[nodiscard]] std::string encode(const Schema& schema);
[[nodiscard]] std::string encode(const Channel& channel);
[[nodiscard]] std::string encode(const ChunkIndex& index);
[[nodiscard]] std::string encode(const Statistics& statistics);
[[nodiscard]] std::string encode(const Attachment& attachment);  ///< with its CRC
[[nodiscard]] std::string encode(const Metadata& metadata);
[[nodiscard]] std::string encode(const AttachmentIndex& index);
[[nodiscard]] std::string encode(const MetadataIndex& index);
/// Appends a whole MessageIndex record.
void append_message_index(std::string& bytes, std::uint16_t channel, const MessageIndex& index);

// Each throws Error if the bytes are not such a record.
[[nodiscard]] Schema decode_schema(Bytes bytes);
[[nodiscard]] Channel decode_channel(Bytes bytes);
[[nodiscard]] Message decode_message(Bytes bytes);
[[nodiscard]] Attachment decode_attachment(Bytes bytes);  ///< checks its CRC
[[nodiscard]] Metadata decode_metadata(Bytes bytes);
[[nodiscard]] Statistics decode_statistics(Bytes bytes);

/// CRC-32 (IEEE 802.3) of `bytes`, after that of earlier bytes.
[[nodiscard]] std::uint32_t crc32(Bytes bytes, std::uint32_t before = 0);

[[nodiscard]] inline Bytes bytes_of(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}
[[nodiscard]] inline std::string_view text_of(Bytes bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// Whether the file exists and begins as MCAP files do.
[[nodiscard]] bool is_mcap(const std::filesystem::path& path);

}  // namespace constrictor::mcap
