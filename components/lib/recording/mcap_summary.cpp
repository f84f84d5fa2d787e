// The end of an MCAP file: DataEnd, the summary with its offsets, and the footer.
#include "recording/mcap_writer.hpp"

namespace constrictor::mcap {

std::string encode_end(const Contents& contents, std::uint64_t offset) {
  std::string bytes;
  std::string content;
  Encoder(content).number(std::uint32_t{0});  // no checksum of the data section: each chunk has its own
  append_record(bytes, Op::kDataEnd, content);

  const std::size_t summary_start = bytes.size();
  std::string offsets;
  const auto group = [&](Op op, const auto& list, const auto& encode_one) {
    const std::size_t start = bytes.size();
    for (const auto& one : list) append_record(bytes, op, encode_one(one));
    if (bytes.size() == start) return;
    std::string entry;
    Encoder encoder(entry);
    encoder.number(static_cast<std::uint8_t>(op));
    encoder.number(static_cast<std::uint64_t>(offset + start));
    encoder.number(static_cast<std::uint64_t>(bytes.size() - start));
    append_record(offsets, Op::kSummaryOffset, entry);
  };
  group(Op::kSchema, contents.schemas, [](const auto& entry) { return encode(entry.second); });
  group(Op::kChannel, contents.channels, [](const auto& entry) { return encode(entry.second); });
  group(Op::kStatistics, std::vector<Statistics>{contents.complete_statistics()},
        [](const Statistics& one) { return encode(one); });
  group(Op::kChunkIndex, contents.chunks, [](const ChunkIndex& one) { return encode(one); });
  group(Op::kAttachmentIndex, contents.attachments, [](const AttachmentIndex& one) { return encode(one); });
  group(Op::kMetadataIndex, contents.metadata, [](const MetadataIndex& one) { return encode(one); });
  const std::size_t offsets_start = bytes.size();
  bytes += offsets;

  std::string footer;
  Encoder encoder(footer);
  encoder.number(static_cast<std::uint64_t>(offset + summary_start));
  encoder.number(static_cast<std::uint64_t>(offset + offsets_start));
  // The checksum covers the summary and the footer before it.
  std::string checked = bytes.substr(summary_start);
  append_record(checked, Op::kFooter, footer + std::string(4, '\0'));
  checked.resize(checked.size() - 4);
  encoder.number(crc32(bytes_of(checked)));
  append_record(bytes, Op::kFooter, footer);
  bytes += kMagic;
  return bytes;
}

}  // namespace constrictor::mcap
