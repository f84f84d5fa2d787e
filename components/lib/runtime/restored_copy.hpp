// A copy of a recording in which images get their pixels.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <utility>

#include "constrictor/topics.hpp"
#include "recording/mcap_copy.hpp"

namespace constrictor {

class RestoredCopy {
 public:
  /// `reader`: of the recording, which must outlive this object. Throws mcap::Error.
  RestoredCopy(const std::filesystem::path& file, const mcap::Reader& reader) : copy_(file, reader) {}
  void copy(const mcap::Attachment& attachment) { copy_.copy(attachment); }
  void copy(mcap::Metadata metadata);
  void copy(const mcap::Channel& channel, const mcap::Message& message) { copy_.copy(channel, message); }
  /// An image without pixels: it is written when they have been computed.
  void expect(const TopicInfo& topic, const mcap::Channel& channel, const mcap::Message& message);
  void complete(const TopicInfo& topic, const msg::CameraImage& computed);
  /// Ends the file. Throws mcap::Error. Returns how many images have not got their pixels.
  [[nodiscard]] std::size_t finish();

 private:
  struct Waiting {
    mcap::Channel channel;
    mcap::Message message;
    msg::CameraImage image;
  };
  mcap::Copy copy_;
  std::map<std::pair<std::uint8_t, std::uint64_t>, Waiting> waiting_;  ///< by topic and sequence number
};

}  // namespace constrictor
