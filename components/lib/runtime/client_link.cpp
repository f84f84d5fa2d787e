#include "runtime/client_link.hpp"

#include <algorithm>
#include <utility>

#include "constrictor/reflect.hpp"
#include "cyclone/run_token.hpp"

namespace constrictor {
namespace {

constexpr int kMostStrange = 4096;

void on_liveliness(dds_entity_t, const dds_liveliness_changed_status_t status, void* tracker) {
  if (status.alive_count_change == 0) return;  // DDS deleted a writer that was already dead
  static_cast<WriterTracker*>(tracker)->note(status.last_publication_handle, status.alive_count_change > 0);
}

/// The emergency stop of a request, without all other fields: it must be obeyed even if the other fields are invalid.
msg::Request bare_stop(const msg::Request& request) {
  msg::Request stop{};
  stop.robot_id = request.robot_id;
  std::copy_n(request.source, sizeof stop.source, stop.source);
  stop.header.sequence_number = request.header.sequence_number;
  stop.kind = msg::kRequestEmergencyStop;
  stop.level = std::min(request.level, msg::kAuthorityOperator);
  return stop;
}

}  // namespace

void WriterTracker::note(dds_instance_handle_t writer, bool alive) {
  const std::lock_guard lock(mutex_);
  news_.emplace_back(writer, alive);
}

WriterId WriterTracker::id_of(dds_entity_t reader, dds_instance_handle_t writer) {
  if (const auto known = ids_.find(writer); known != ids_.end()) return known->second;
  WriterId id{};
  dds_builtintopic_endpoint_t* data = dds_get_matched_publication_data(reader, writer);
  if (!data) return id;  // the writer has gone; DDS reports its end with its instance
  std::copy_n(data->key.v, id.size(), id.begin());
  dds_builtintopic_free_endpoint(data);
  ids_[writer] = id;
  return id;
}

void WriterTracker::catch_up(dds_entity_t reader) {
  std::vector<std::pair<dds_instance_handle_t, bool>> news;
  {
    const std::lock_guard lock(mutex_);
    news.swap(news_);
  }
  for (const auto& [handle, alive] : news) {
    const WriterId id = id_of(reader, handle);
    if (id != WriterId{}) alive_[id] = alive;
    if (!alive) ids_.erase(handle);
  }
}

bool WriterTracker::lives(dds_entity_t reader, const WriterId& writer) {
  catch_up(reader);
  const bool looking = std::chrono::steady_clock::now() - since_ < grace_;
  if (!looking) std::erase_if(alive_, [](const auto& entry) { return !entry.second; });
  const auto known = alive_.find(writer);
  return known != alive_.end() ? known->second : looking;
}

bool ClientLink::Gate::passes(const msg::Request& request) {
  if (token.empty() || same_token(request.token, token)) return true;
  // A stop also reaches the plant, on a topic where a source costs no memory.
  return (request.kind == msg::kRequestEmergencyStop ? strange_stops++ : strange_requests++) < kMostStrange;
}

ClientLink::ClientLink(dds_entity_t participant, std::uint16_t robot_id, Admit admit, std::chrono::milliseconds grace,
                       std::string token)
    : robot_id_(robot_id),
      admit_(std::move(admit)),
      gate_(std::make_unique<Gate>()),
      tracker_(std::make_unique<WriterTracker>(grace)) {
  gate_->token = std::move(token);
  const dds::Qos qos = dds::make_qos();
  dds_qset_reliability(qos.get(), DDS_RELIABILITY_RELIABLE, DDS_SECS(1));
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_ALL, 0);
  dds_qset_durability(qos.get(), DDS_DURABILITY_VOLATILE);
  // DDS deletes the instance of a dead source 1 s after its end was taken, because a long run has many sources.
  dds_qset_reader_data_lifecycle(qos.get(), DDS_SECS(1), DDS_SECS(1));
  const dds::Entity topic(
      dds_create_topic(participant, &dds::descriptor<msg::Request>(), kRequestTopic, nullptr, nullptr),
      "dds_create_topic");
  const auto passes = [](const void* request, void* gate) {
    return static_cast<Gate*>(gate)->passes(*static_cast<const msg::Request*>(request));
  };
  dds::check(dds_set_topic_filter_and_arg(topic.get(), passes, gate_.get()), "dds_set_topic_filter_and_arg");
  // A listener receives every change; a status would keep only the last change. It is set before the reader exists, so
  // that it misses none.
  const std::unique_ptr<dds_listener_t, void (*)(dds_listener_t*)> listener(dds_create_listener(tracker_.get()),
                                                                            dds_delete_listener);
  dds_lset_liveliness_changed(listener.get(), on_liveliness);
  reader_ = dds::Entity(dds_create_reader(participant, topic.get(), qos.get(), listener.get()), "dds_create_reader");
}

void ClientLink::track_writers_for(ClientRequests& requests) const {
  requests.check_writers_with([tracker = tracker_.get(), reader = reader_.get()](const WriterId& writer) {
    return tracker->lives(reader, writer);
  });
}

void ClientLink::take(ClientRequests& requests, const std::function<void(const std::string&)>& refused) const {
  tracker_->catch_up(reader_.get());
  for (;;) {
    void* message = nullptr;  // one at a time: there are only a few requests in a tick
    dds_sample_info_t info{};
    const int count = dds::check(dds_take(reader_.get(), &message, &info, 1, 1), "dds_take");
    if (count == 0) return;
    const dds::Loan loan(reader_.get(), &message, 1);
    const auto& request = *static_cast<const msg::Request*>(message);
    if (request.robot_id != robot_id_) continue;
    if (info.valid_data) {
      const WriterId writer = tracker_->id_of(reader_.get(), info.publication_handle);
      const auto violation = validate(request);
      if (violation) refused(std::string(kRequestTopic) + "." + *violation);
      if (request.kind == msg::kRequestEmergencyStop) requests.add(bare_stop(request), writer);
      else if (violation) requests.add_refused(request, *violation);
      else if (const std::string why = admit_ ? admit_(request) : ""; !why.empty()) requests.add_stranger(request, why);
      else requests.add(request, writer);
    }
    if (info.instance_state != DDS_IST_ALIVE) requests.add_death(request.source);
  }
}

}  // namespace constrictor
