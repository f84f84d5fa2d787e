#include "component/client_requests.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

namespace constrictor {
namespace {

/// Requests that are bounded together.
enum Pool : std::size_t { kStops, kStanding, kOther };

struct Room {
  std::size_t of_source;
  std::size_t of_all;
};
constexpr std::array<Room, 3> kRooms{{{1, 8}, {4, 16}, {12, 48}}};

Pool pool_of(const msg::Request& request) {
  switch (request.kind) {
    case msg::kRequestEmergencyStop:
      return kStops;
    case msg::kRequestRelease:
    case msg::kRequestClearStop:
      return kStanding;
    case msg::kRequestMotion:
      return request.motion == msg::kMotionStand ? kStanding : kOther;
    default:
      return kOther;
  }
}

}  // namespace

void ClientRequests::add(const msg::Request& request, const WriterId& writer) {
  const std::lock_guard lock(mutex_);
  ClientEvent item{request.source, false, request, writer, {}, 1};
  const Pool pool = pool_of(request);
  std::size_t of_source = 0;
  std::size_t of_all = 0;
  auto own = items_.end();     // oldest motion of this source in the pool; if it has no motion: its oldest request
  auto lowest = items_.end();  // oldest request of the lowest level in the pool
  for (auto at = items_.begin(); at != items_.end(); ++at) {
    if (at->died) continue;
    const bool same = at->source == item.source;
    if (same && at->writer == writer && at->request.header.sequence_number == request.header.sequence_number) return;
    if (pool_of(at->request) != pool) continue;
    ++of_all;
    if (lowest == items_.end() || at->request.level < lowest->request.level) lowest = at;
    if (!same) continue;
    ++of_source;
    const auto is_motion = [](const ClientEvent& i) { return i.request.kind == msg::kRequestMotion; };
    if (own == items_.end() || (is_motion(*at) && !is_motion(*own))) own = at;
  }
  if (of_source >= kRooms[pool].of_source) {
    ClientEvent gone = std::move(*own);
    items_.erase(own);
    if (pool != kStops) drop(std::move(gone));  // a stop is not refused: the newer one replaces it
  } else if (of_all >= kRooms[pool].of_all) {
    if (pool == kStops) return;  // the stops in the pool already stop the robot
    if (lowest->request.level > request.level) return drop(std::move(item));
    ClientEvent gone = std::move(*lowest);
    items_.erase(lowest);
    drop(std::move(gone));
  }
  items_.push_back(std::move(item));
}

void ClientRequests::add_refused(const msg::Request& request, const std::string& reason) {
  const std::lock_guard lock(mutex_);
  refuse({request.source, false, request, {}, {}, 1}, reason);
}

void ClientRequests::add_stranger(const msg::Request& request, const std::string& reason) {
  const std::lock_guard lock(mutex_);
  if (++strangers_ > kMostStrangers) ++dropped_;
  else refuse({request.source, false, request, {}, {}, 1}, reason);
}

void ClientRequests::drop(ClientEvent item) {
  ++dropped_;
  refuse(std::move(item),
         "too many requests between two ticks; newer requests, and requests of higher levels, were kept");
}

void ClientRequests::refuse(ClientEvent item, const std::string& reason) {
  if (refused_.size() >= kMostRefusals) {
    ++refused_.back().times;
    return;
  }
  item.refusal = reason;
  refused_.push_back(std::move(item));
}

void ClientRequests::add_death(const std::string& source) {
  const std::lock_guard lock(mutex_);
  // One entry for each source, so that the number of deaths between two ticks is bounded.
  const auto same = [&](const ClientEvent& item) { return item.died && item.source == source; };
  if (std::none_of(items_.begin(), items_.end(), same)) items_.push_back({source, true, {}, {}, {}, 1});
}

void ClientRequests::check_writers_with(std::function<bool(const WriterId&)> lives) {
  const std::lock_guard lock(mutex_);
  lives_ = std::move(lives);
}

std::vector<ClientEvent> ClientRequests::latch(const std::vector<LivingSource>& living) {
  std::vector<ClientEvent> items;
  std::vector<ClientEvent> refused;
  std::function<bool(const WriterId&)> lives;
  {
    const std::lock_guard lock(mutex_);
    items.swap(items_);
    refused.swap(refused_);
    strangers_ = 0;
    lives = lives_;
  }
  for (const auto& [source, writer] : living) {
    if (lives && writer != WriterId{} && !lives(writer)) items.push_back({source, true, {}, writer, {}, 1});
  }
  // If a death does not name the writer, the source's previous writer has died. Such a death is removed if a request of
  // a new writer of the same source has arrived: `input` concludes from this request that the previous writer is dead.
  const auto is_known_otherwise = [&](const ClientEvent& death) {
    const auto known =
        std::find_if(living.begin(), living.end(), [&](const LivingSource& l) { return l.source == death.source; });
    return death.died && death.writer == WriterId{} && known != living.end() &&
           std::any_of(items.begin(), items.end(), [&](const ClientEvent& item) {
             return !item.died && item.source == death.source && item.writer != WriterId{} &&
                    item.writer != known->writer;
           });
  };
  for (auto at = items.begin(); at != items.end();) at = is_known_otherwise(*at) ? items.erase(at) : std::next(at);
  // If one source has several writers, they are processes that followed each other: the requests of the earlier one
  // come first, whatever their sequence numbers.
  std::vector<std::pair<std::size_t, ClientEvent>> ordered;
  for (auto& item : items) {
    std::size_t turn = 0;
    for (const auto& [earlier_turn, earlier] : ordered) {
      if (!earlier.died && earlier.source == item.source)
        turn = earlier.writer == item.writer ? earlier_turn : earlier_turn + 1;
    }
    ordered.emplace_back(turn, std::move(item));
  }
  const auto order = [](const std::pair<std::size_t, ClientEvent>& entry) {
    const auto& [turn, item] = entry;
    return std::make_tuple(item.died, -int{item.request.level}, std::cref(item.source), turn,
                           item.request.header.sequence_number);
  };
  std::stable_sort(ordered.begin(), ordered.end(), [&](const auto& a, const auto& b) { return order(a) < order(b); });
  for (auto& [turn, item] : ordered) refused.push_back(std::move(item));
  return refused;
}

std::uint64_t ClientRequests::dropped() const {
  const std::lock_guard lock(mutex_);
  return dropped_;
}

}  // namespace constrictor
