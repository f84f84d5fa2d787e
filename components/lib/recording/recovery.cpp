#include "recording/recovery.hpp"

#include <fmt/format.h>

#include "recording/mcap_copy.hpp"

namespace constrictor::mcap {

Recovered copy_undamaged(const std::filesystem::path& damaged, const std::filesystem::path& copy) {
  Recovered recovered;
  Reader reader(damaged);
  Copy made(copy, reader);
  Visitor visitor;
  visitor.message = [&](const Channel& channel, const Message& message) {
    made.copy(channel, message);
    ++recovered.messages;
  };
  visitor.attachment = [&](const Attachment& attachment) { made.copy(attachment); };
  visitor.metadata = [&](const Metadata& metadata) { made.copy(metadata); };
  reader.read_undamaged(visitor, [&](std::uint64_t offset, std::uint64_t length, const std::string& why) {
    if (recovered.places++ == 0) recovered.why = fmt::format("damaged at byte {}: {}", offset, why);
    recovered.left_out_bytes += length;
  });
  made.finish({{"recovered",
                {{"cut_bytes", std::to_string(recovered.left_out_bytes)},
                 {"places", std::to_string(recovered.places)},
                 {"reason", recovered.why}}}});
  recovered.chunks = made.writer().chunks();
  return recovered;
}

}  // namespace constrictor::mcap
