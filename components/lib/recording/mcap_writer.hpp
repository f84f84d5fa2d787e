// Writes an MCAP file: chunks that are compressed by zstd, each followed by the indexes of its messages, and at the end
// a summary. After each chunk, everything before it can be read, whatever happens to the process.
#pragma once

#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "recording/mcap_file.hpp"
#include "recording/mcap_format.hpp"

struct ZSTD_CCtx_s;

namespace constrictor::mcap {

class Reader;

class Writer {
 public:
  /// [byte] of messages in a chunk, at which it is closed.
  static constexpr std::size_t kChunkSize = 1 << 20;
  /// [byte] that stay reserved on the disk for the end of the file, its summary not included.
  static constexpr std::uint64_t kReserve = 64 << 10;

  /// Creates the file, or empties it. Throws Error.
  Writer(const std::filesystem::path& path, const std::string& profile, const std::string& library);
  /// Continues the file that `reader` has read: cuts off incomplete records and the summary. Throws Error.
  explicit Writer(const Reader& reader);
  /// From now on the disk counts as full while fewer bytes than these are left on it for other files.
  void leave_free(std::uint64_t bytes) { left_free_ = bytes; }
  /// Ends without a summary if finish() was not called. The file can then still be read and recovered.
  ~Writer();
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

  /// Returns its id; an equal one keeps its id. Throws Error if there are 65,535 already.
  std::uint16_t add_schema(const std::string& name, const std::string& encoding, const std::string& data);
  /// `schema`: 0 if the messages have no schema.
  std::uint16_t add_channel(std::uint16_t schema, const std::string& topic, const std::string& message_encoding,
                            const Texts& metadata = {});
  /// Adds a message to the open chunk, and closes the chunk if it is large enough. `message.channel_id` must be the
  /// result of add_channel(). Throws Error; DiskFull leaves the file as it was after the chunk before.
  void write(const Message& message);
  void attach(const Attachment& attachment);
  void add_metadata(const Metadata& metadata);
  /// Compresses and writes the messages since the last chunk. Throws like write().
  void close_chunk();
  /// Closes the chunk, and writes `last` and the summary. If the disk is full, the open chunk is dropped and only the
  /// others are written, for which space was reserved. Nothing can be written afterwards.
  void finish(const std::vector<Metadata>& last = {});

  /// Number of chunks that are in the file.
  [[nodiscard]] std::uint64_t chunks() const { return contents_.chunks.size(); }
  /// The records of the open chunk, not compressed: a successor gets them back with restore().
  [[nodiscard]] std::string_view open_chunk() const { return chunk_; }
  /// Makes these records the open chunk of a file that was just opened. Throws Error if they are damaged.
  void restore(std::string_view records);
  [[nodiscard]] const Contents& contents() const { return contents_; }
  /// [byte] in the file.
  [[nodiscard]] std::uint64_t size() const { return end_; }

 private:
  void append(std::initializer_list<std::string_view> parts);
  void define(std::uint16_t channel);
  void define_schema(std::uint16_t schema);
  void note(const Message& message, std::uint64_t offset);
  void forget_chunk();

  File file_;
  std::unique_ptr<ZSTD_CCtx_s, std::size_t (*)(ZSTD_CCtx_s*)> compressor_;
  Contents contents_;  ///< of the chunks in the file, and all schemas and channels
  std::uint64_t end_ = 0;
  std::uint64_t left_free_ = 0;        ///< [byte] on the disk
  std::uint64_t summary_size_ = 1024;  ///< [byte] about what finish() will write
  bool finished_ = false;
  std::string chunk_;
  std::vector<MessageIndex> chunk_index_;  ///< by channel; also those of earlier chunks, empty, for their memory
  std::uint64_t chunk_messages_ = 0;
  std::uint64_t chunk_start_ = 0;  ///< [ns] log time of the first message
  std::uint64_t chunk_end_ = 0;
  // Memory that close_chunk() uses again and again: memory of this size that is freed goes back to the kernel, which
  // clears it each time.
  std::string compressed_;
  std::string indexes_;
  std::map<std::uint16_t, bool> defined_schemas_;   ///< value: in the file; else in the open chunk
  std::map<std::uint16_t, bool> defined_channels_;  ///< likewise
};

/// The summary section and the end of a file whose data section ends at `offset`, from DataEnd to the last magic.
[[nodiscard]] std::string encode_end(const Contents& contents, std::uint64_t offset);

}  // namespace constrictor::mcap
