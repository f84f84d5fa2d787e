// Reads an MCAP file from its beginning to its end. Everything that is read is checked: lengths, checksums, ids, and
// whether the summary agrees with the data. Also reads a file whose writer was killed, up to its last complete chunk.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "recording/mcap_file.hpp"
#include "recording/mcap_format.hpp"

namespace constrictor::mcap {

/// Functions that are called with the content of a file, in its order. A function may be unset.
struct Visitor {
  std::function<void(const Channel&, const Message&)> message;
  std::function<void(const Attachment&)> attachment;
  std::function<void(const Metadata&)> metadata;
};

class Reader {
 public:
  /// Opens a file. Throws Error if it is not an MCAP file.
  explicit Reader(const std::filesystem::path& path);

  /// Reads everything. Throws Error, which names the byte, if the file is damaged. A file that ends too early is no
  /// error: see incomplete().
  void read(const Visitor& visitor = {});
  /// The same, but damaged records are left out, and `left_out` is called with the offset [byte], the length [byte] and
  /// the reason of each; the length is 0 for an index, which says nothing that the file does not have. Bytes that
  /// cannot be divided into records count as one record.
  using LeftOut = std::function<void(std::uint64_t offset, std::uint64_t length, const std::string& why)>;
  void read_undamaged(const Visitor& visitor, const LeftOut& left_out);

  /// Schemas, channels and indexes: after read(), of everything that was read.
  [[nodiscard]] const Contents& contents() const { return contents_; }
  /// Null if there is no such schema.
  [[nodiscard]] const Schema* schema_of(const Channel& channel) const;
  /// After read(): empty if the file ends as a finished file does, else why not.
  [[nodiscard]] const std::string& incomplete() const { return incomplete_; }
  /// After read(), also if it threw an error: [byte] where the last complete record of the data section ends.
  [[nodiscard]] std::uint64_t data_end() const { return data_end_; }
  /// The indexes of the last chunk's messages if the file does not have all of them; else empty.
  [[nodiscard]] const std::map<std::uint16_t, MessageIndex>& missing_indexes() const { return last_index_; }
  [[nodiscard]] const std::filesystem::path& path() const { return file_.path(); }

 private:
  void read_all(const Visitor& visitor, const LeftOut* left_out);
  /// Takes schemas and channels from the summary, because the chunk that defines them may be damaged.
  void learn_definitions();
  void read_record(Op op, Bytes content, std::uint64_t offset, std::uint64_t length, const Visitor& visitor);
  void read_chunk(Bytes content, std::uint64_t offset, std::uint64_t length, const Visitor& visitor);
  void read_inner(Op op, Bytes content, const Visitor& visitor);
  void read_message_index(Bytes content, std::uint64_t offset, std::uint64_t length);
  void read_summary(std::uint64_t start);
  void add_schema(Bytes content);
  void add_channel(Bytes content);
  const Channel& channel_of(const Message& message) const;
  [[nodiscard]] std::string place(std::uint64_t offset) const;

  File file_;
  Contents contents_;
  std::string incomplete_;
  std::string content_;       ///< of the present record
  std::string uncompressed_;  ///< of the present chunk
  std::uint64_t first_record_ = 0;
  std::uint64_t data_end_ = 0;
  std::map<std::uint16_t, MessageIndex> last_index_;  ///< of the last chunk, without what the file has
};

/// The uncompressed records of a Chunk record. Throws Error if they do not agree with the record. `buffer` holds them.
[[nodiscard]] Bytes uncompress_chunk(Bytes content, std::string& buffer);

/// Calls `use(opcode, content, offset in the chunk)` for each record in the uncompressed chunk. Throws Error.
void for_each_record(Bytes records, const std::function<void(Op, Bytes, std::uint64_t)>& use);

}  // namespace constrictor::mcap
