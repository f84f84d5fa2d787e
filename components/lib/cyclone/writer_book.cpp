#include "cyclone/writer_book.hpp"

#include <algorithm>

#include "cyclone/matched.hpp"

namespace constrictor::dds {
namespace {

constexpr std::size_t kMostDead = 512;  // deleted writers whose samples may still wait in a reader

GuidPrefix prefix_of(const dds_guid_t& guid) {
  GuidPrefix prefix{};
  std::copy_n(guid.v, prefix.size(), prefix.begin());
  return prefix;
}

}  // namespace

GuidPrefix own_prefix(dds_entity_t entity) {
  dds_guid_t guid{};
  check(dds_get_guid(entity, &guid), "dds_get_guid");
  return prefix_of(guid);
}

WriterBook::WriterBook() : listener_(dds_create_listener(this), dds_delete_listener) {
  dds_lset_subscription_matched(listener_.get(),
                                [](dds_entity_t reader, const dds_subscription_matched_status_t status, void* book) {
                                  static_cast<WriterBook*>(book)->note(reader, status.last_publication_handle);
                                });
}

void WriterBook::watch(dds_entity_t reader) {
  check(dds_set_listener(reader, listener_.get()), "dds_set_listener");
  for (const dds_instance_handle_t writer : matched_endpoints(reader, false)) note(reader, writer);
}

void WriterBook::note(dds_entity_t reader, dds_instance_handle_t writer) {
  // The answer of Cyclone under the lock decides, not the status, which may be older than another thread's answer.
  const std::lock_guard lock(mutex_);
  dds_builtintopic_endpoint_t* data = dds_get_matched_publication_data(reader, writer);
  const auto known = writers_.find(writer);
  if (!data) {
    if (known == writers_.end() || known->second.readers.erase(reader) == 0 || !known->second.readers.empty()) return;
    ++dead_;
    return forget_some_dead();
  }
  const GuidPrefix participant = prefix_of(data->key);
  dds_builtintopic_free_endpoint(data);
  if (writers_.size() >= kMost && known == writers_.end()) return;
  Entry& entry = writers_[writer];
  entry.participant = participant;
  entry.readers.insert(reader);
  noted_.notify_all();
}

void WriterBook::forget_some_dead() {
  if (dead_ <= kMostDead) return;
  std::erase_if(writers_, [](const auto& entry) { return entry.second.readers.empty(); });
  dead_ = 0;
}

std::optional<GuidPrefix> WriterBook::participant_of(dds_instance_handle_t writer) const {
  std::unique_lock lock(mutex_);
  noted_.wait_for(lock, kLongestWait, [&] { return writers_.contains(writer) || writers_.size() >= kMost; });
  const auto known = writers_.find(writer);
  return known == writers_.end() ? std::nullopt : std::optional(known->second.participant);
}

bool WriterBook::lives(const GuidPrefix& participant) const {
  const std::lock_guard lock(mutex_);
  return std::any_of(writers_.begin(), writers_.end(), [&](const auto& entry) {
    return !entry.second.readers.empty() && entry.second.participant == participant;
  });
}

}  // namespace constrictor::dds
