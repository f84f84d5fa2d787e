// Parts of QueueWorld that are defined outside of the class: its state as text, and how processes die and their
// successors start.
#pragma once

#include "queue_world.hpp"

namespace constrictor::testing::toys {

inline void QueueWorld::crash(const std::string& name, int lost) {
  Node& dead = find(name);
  const std::size_t index = dead.index;
  const std::uint32_t incarnation = dead.member->incarnation() + 1;
  lose(dead, lost);
  nodes_[index]->member.reset();
  start(index, incarnation);
  Node& reborn = *nodes_[index];
  send_histories_to(reborn);
  for (const auto& tick : ticks_) send_tick(tick, reborn);
  if (conductor_->epoch()) send_epoch(reborn, *conductor_->epoch(), conductor_->seed());
}

inline void QueueWorld::lose(const Node& dead, int lost) {
  const std::string name = dead.member->name();
  const auto to_it = [&](const std::string& channel) {
    return channel.ends_with(">" + name) || (dead.index == 0 && channel.ends_with(">conductor"));
  };
  for (auto& [channel, queue] : channels_) {
    if (sent_by(channel, dead)) {
      for (int i = 0; i < lost && !queue.empty(); ++i) queue.pop_back();
    }
    if (to_it(channel)) queue.clear();
  }
  std::erase_if(delivered_, [&](const auto& entry) { return to_it(entry.first); });  // its buffers are lost
}

inline void QueueWorld::send_histories_to(Node& reborn) {
  for (const auto& node : nodes_) {
    if (node->index == reborn.index) continue;
    for (const auto& [topic, kept] : node->history) {
      if (!reborn.member->reads().contains(topic)) continue;
      for (const auto& sample : kept) send(*node, topic, reborn, sample);
    }
  }
}

inline void QueueWorld::crash_plant(int lost) {
  Node& dead = *nodes_.front();
  const std::uint32_t incarnation = dead.member->incarnation() + 1;
  lose(dead, lost);
  dead.member.reset();
  ticks_.clear();
  const auto saved = saved_;
  conductor_ = saved ? std::make_unique<Conductor>(options_, static_cast<ConductorSink&>(*this), *saved)
                     : std::make_unique<Conductor>(options_, static_cast<ConductorSink&>(*this));
  for (const auto& node : nodes_) {
    if (node->index == 0) continue;
    conductor_->on_hello(node->hello);
    if (node->ready_in) push_ready(*node);
    for (const auto& step : node->steps) push_done(*node, step);
  }
  start(0, incarnation);
  send_histories_to(*nodes_.front());
  conductor_->continue_epoch();
}

inline std::string QueueWorld::fingerprint() const {
  std::string text = std::to_string(conductor_->next_index()) + (conductor_->may_tick() ? "m" : "-") +
                     (conductor_->epoch() ? std::to_string(conductor_->epoch()->epoch) : "?");
  for (const auto& node : nodes_) text += "," + conductor_->known_of(node->member->name());
  for (const auto& node : nodes_) {
    const Member& member = *node->member;
    const MissingInput missing = member.missing();
    text += "|" + member.name() + std::to_string(member.incarnation()) + "," + std::to_string(member.last_done()) +
            "," + std::to_string(member.newest_tick()) + (member.ended() ? "e" : "") +
            (member.in_epoch() ? std::to_string(member.epoch().epoch) : "?") + "," + std::to_string(missing.tick) +
            (missing.topic ? std::string(missing.topic->name) : "-") + std::to_string(missing.have) +
            node->member->component().save();
  }
  for (const auto& [name, queue] : channels_) {
    if (!queue.empty()) text += "|" + name + ":";
    for (const auto& message : queue) text += message.what + ";";
  }
  for (const auto& [name, count] : delivered_) text += "," + name + std::to_string(count);
  if (saved_) text += "|" + saved_->head;  // from which the plant continues after a crash
  return text;
}

}  // namespace constrictor::testing::toys
