#include "cli/recording/recorded_messages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <map>
#include <tuple>

#include "barrier/topic_ops.hpp"
#include "cli/usage.hpp"
#include "constrictor/topics.hpp"
#include "recording/mcap_reader.hpp"
#include "recording/message_cdr.hpp"
#include "runtime/recording_options.hpp"

namespace constrictor::cli {
namespace {

namespace fs = std::filesystem;
using Use = std::function<void(const TopicInfo&, const msg::Header&, mcap::Bytes cdr)>;

/// Calls `use` for each message of a member topic; `next_epoch` before the first one of each epoch.
void for_each_member_message(const fs::path& recording, const std::function<void()>& next_epoch, const Use& use) {
  std::map<std::string, const TopicInfo*, std::less<>> members;
  for (const auto& info : topics::kInfos) members.emplace(info.name, &info);
  std::pair<std::uint64_t, std::uint32_t> epoch{0, 0};
  mcap::Reader reader(recording);
  reader.read({[&](const mcap::Channel& channel, const mcap::Message& message) {
                 const auto info = members.find(channel.topic);
                 if (info == members.end()) return;
                 const auto header = find_codec(info->second->type)->header(message.data);
                 if (!header) return;
                 if (epoch != std::pair(header->run_id, header->epoch)) {
                   epoch = {header->run_id, header->epoch};
                   next_epoch();
                 }
                 use(*info->second, *header, message.data);
               },
               nullptr, nullptr});
}

}  // namespace

fs::path recording_of(const fs::path& run) {
  const fs::path file = fs::is_directory(run) ? run / kRecordingFile : run;
  return fs::exists(file) ? file : fs::path();
}

fs::path recording_or_throw(const std::string& name) {
  fs::path recording = recording_of(name);
  if (!recording.empty()) return recording;
  throw UsageError(fmt::format(
      "FILE: found {}, which has no run.mcap, accepted a recording, or the report directory of a run with --record",
      name));
}

bool has_images(const fs::path& recording) {
  bool images = true;
  mcap::Reader(recording).read({nullptr, nullptr, [&](const mcap::Metadata& metadata) {
                                  const auto found = metadata.entries.find("images");
                                  if (metadata.name == "recording" && found != metadata.entries.end())
                                    images = found->second == "on";
                                }});
  return images;
}

std::vector<HashLog::Entry> recorded_hashes(const fs::path& recording, bool images) {
  std::vector<HashLog::Entry> entries;
  MessageHasher hasher;
  for_each_member_message(
      recording, [&] { entries.clear(); },
      [&](const TopicInfo& info, const msg::Header&, mcap::Bytes cdr) {
        if (!images && info.type == Description<msg::CameraImage>::kName) return;
        std::string canonical;
        if (!find_codec(info.type)->from_cdr(cdr, canonical)) return;
        if (const auto entry = hasher.entry_of(info.id, canonical)) entries.push_back(*entry);
      });
  std::stable_sort(entries.begin(), entries.end(), [](const HashLog::Entry& a, const HashLog::Entry& b) {
    return std::tie(a.tick, a.topic, a.sequence_number) < std::tie(b.tick, b.topic, b.sequence_number);
  });
  return entries;
}

std::optional<std::string> recorded_message(const fs::path& recording, std::uint8_t topic,
                                            std::uint64_t sequence_number) {
  std::optional<std::string> found;
  for_each_member_message(
      recording, [&] { found.reset(); },
      [&](const TopicInfo& info, const msg::Header& header, mcap::Bytes cdr) {
        if (info.id != topic || header.sequence_number != sequence_number) return;
        std::string canonical;
        if (find_codec(info.type)->from_cdr(cdr, canonical)) found = neutral_message(topic, std::move(canonical));
      });
  return found;
}

}  // namespace constrictor::cli
