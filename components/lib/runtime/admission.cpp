#include "runtime/admission.hpp"

#include <algorithm>
#include <utility>

namespace constrictor {
namespace {

constexpr std::size_t kMostIncarnations = 4;  // whose late samples are accepted
constexpr std::size_t kMostRivals = 8;

bool contains(const std::vector<dds::GuidPrefix>& list, const dds::GuidPrefix& participant) {
  return std::find(list.begin(), list.end(), participant) != list.end();
}

}  // namespace

bool Admission::announce(const std::string& component, std::uint32_t incarnation, const dds::GuidPrefix& participant) {
  Announced& known = announced_[component];
  auto& participants = known.participants;
  const bool same = !participants.empty() && participants.front() == participant;
  if (!participants.empty() && !same && incarnation <= known.incarnation) {
    // Two processes of one name: the first one counts as long as it is there. Then also a lower number is right: the
    // plant of a new run begins with 1.
    if (book_.lives(participants.front())) {
      if (known.rivals.size() < kMostRivals && !contains(known.rivals, participant))
        known.rivals.push_back(participant);
      return false;
    }
  }
  if (incarnation > known.incarnation) known.rivals.clear();
  known.incarnation = incarnation;
  if (!same) participants.insert(participants.begin(), participant);
  if (participants.size() > kMostIncarnations) participants.pop_back();
  deliver_waiting(component);
  return true;
}

bool Admission::lives(const std::string& component) const {
  const auto known = announced_.find(component);
  if (known == announced_.end()) return false;
  const auto& participants = known->second.participants;
  return std::any_of(participants.begin(), participants.end(),
                     [this](const dds::GuidPrefix& participant) { return book_.lives(participant); });
}

Admission::Verdict Admission::judge(const std::string& component, dds_instance_handle_t writer) {
  const auto known = announced_.find(component);
  if (known == announced_.end()) return Verdict::kUnknown;
  auto& [incarnation, participants, rivals] = known->second;
  const auto participant = book_.participant_of(writer);
  if (!participant) return Verdict::kStranger;
  if (contains(participants, *participant)) return Verdict::kAccepted;
  if (!contains(rivals, *participant) || book_.lives(participants.front())) return Verdict::kStranger;
  std::erase(rivals, *participant);
  participants.insert(participants.begin(), *participant);
  return Verdict::kAccepted;
}

bool Admission::has_room(dds_instance_handle_t writer, std::size_t bytes) const {
  const auto load = load_.find(writer);
  if (load == load_.end()) return load_.size() < kMostWriters && bytes <= kMostBytes;
  return load->second.messages < kMostMessages && load->second.bytes + bytes <= kMostBytes;
}

bool Admission::keep(const std::string& component, dds_instance_handle_t writer, std::size_t bytes,
                     std::function<void()> deliver) {
  if (!has_room(writer, bytes)) return false;
  Load& load = load_[writer];
  ++load.messages;
  load.bytes += bytes;
  waiting_.push_back({component, writer, bytes, std::move(deliver)});
  return true;
}

void Admission::deliver_waiting(const std::string& component) {
  std::vector<Waiting> due;
  for (auto at = waiting_.begin(); at != waiting_.end();) {
    if (at->component != component) {
      ++at;
      continue;
    }
    due.push_back(std::move(*at));
    at = waiting_.erase(at);
  }
  for (const Waiting& message : due) {
    Load& load = load_[message.writer];
    load.bytes -= message.bytes;
    if (--load.messages == 0) load_.erase(message.writer);
  }
  for (const Waiting& message : due) {
    if (judge(component, message.writer) == Verdict::kAccepted) message.deliver();
  }
}

}  // namespace constrictor
