// A copy of a recording, record by record: with more, less or other content than its source.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <vector>

#include "recording/mcap_reader.hpp"
#include "recording/mcap_writer.hpp"

namespace constrictor::mcap {

class Copy {
 public:
  /// `source` must outlive this object. Throws Error.
  Copy(const std::filesystem::path& file, const Reader& source);
  /// Each of them throws as Writer does.
  void copy(const Channel& channel, const Message& message);
  void copy(const Attachment& attachment) { writer_.attach(attachment); }
  void copy(const Metadata& metadata) { writer_.add_metadata(metadata); }
  /// For content that the source does not have.
  [[nodiscard]] Writer& writer() { return writer_; }
  [[nodiscard]] const Writer& writer() const { return writer_; }
  /// Writes what is left, `last` and the summary. Other than Writer::finish(), throws DiskFull if the last messages
  /// find no space: a copy is complete or worthless.
  void finish(const std::vector<Metadata>& last = {});

 private:
  const Reader& source_;
  Writer writer_;
  std::map<std::uint16_t, std::uint16_t> channels_;  ///< of the copy, by those of the source
};

}  // namespace constrictor::mcap
