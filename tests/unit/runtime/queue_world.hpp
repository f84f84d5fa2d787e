// A run on queues in which each delivery, step, tick, crash and restart is an explicit action, so that a test can try
// all orders. The plant's process, in which the conductor is, may crash as well: it continues from the checkpoint that
// it saved last, and receives again what the living members have kept for late readers. There is a channel for each
// combination of writer incarnation, topic and reader. As in DDS, messages keep their order within a channel, and the
// order of messages of different channels is arbitrary.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "barrier/conductor.hpp"
#include "barrier/member.hpp"
#include "queue_action.hpp"
#include "toy_components.hpp"

namespace constrictor::testing::toys {

class QueueWorld : private ConductorSink {
 public:
  using Action = QueueAction;

  /// `checkpoints`: the plant may crash.
  QueueWorld(std::vector<ComponentFactory> factories, std::int64_t final_tick, bool checkpoints)
      : factories_(std::move(factories)), final_tick_(final_tick), checkpoints_(checkpoints) {
    for (const auto& factory : factories_) options_.roster.push_back(factory.name);
    options_.plant = options_.roster.front();
    conductor_ = std::make_unique<Conductor>(options_, static_cast<ConductorSink&>(*this));
    for (std::size_t i = 0; i < factories_.size(); ++i) start(i, 1);
  }

  [[nodiscard]] bool finished() const {
    for (const auto& node : nodes_) {
      if (!node->member->ended() || !conductor_->ended() || node->member->epoch() != *conductor_->epoch()) return false;
    }
    return true;
  }

  /// All actions that are possible now. Only members in `mortal` may crash; a reset is possible only if `may_reset`.
  [[nodiscard]] std::vector<Action> actions(const std::set<std::string>& mortal, bool may_reset) const {
    std::vector<Action> list;
    for (const auto& [name, queue] : channels_) {
      if (!queue.empty()) list.push_back({Action::kDeliver, name, 0});
    }
    for (const auto& node : nodes_) {
      if (can_step(*node->member)) list.push_back({Action::kStep, node->member->name(), 0});
      if (!mortal.contains(node->member->name()) || (node->member->ended() && node->index != 0)) continue;
      int most = 0;
      for (const auto& [name, queue] : channels_) {
        if (sent_by(name, *node)) most = std::max(most, static_cast<int>(queue.size()));
      }
      for (int lost = 0; lost <= most; ++lost) list.push_back({Action::kCrash, node->member->name(), lost});
    }
    if (conductor_->may_tick()) list.push_back({Action::kTick, "", 0});
    if (may_reset && conductor_->epoch() && !conductor_->ended()) list.push_back({Action::kReset, "", 0});
    return list;
  }

  void apply(const Action& action) {
    switch (action.kind) {
      case Action::kDeliver: {
        auto& queue = channels_[action.what];
        const auto deliver = std::move(queue.front().deliver);
        queue.pop_front();
        deliver();
        break;
      }
      case Action::kStep:
        find(action.what).member->try_step();
        break;
      case Action::kTick: {
        Member& plant = *nodes_.front()->member;
        if (conductor_->next_index() == final_tick_) conductor_->end_run();
        PlantCheckpoint checkpoint = plant.measure(conductor_->next_index(), conductor_->next_time_ns(), 20'000'000);
        conductor_->tick(plant.published(), std::move(checkpoint));
        break;
      }
      case Action::kCrash:
        if (action.what == options_.plant) crash_plant(action.lost);
        else crash(action.what, action.lost);
        break;
      case Action::kReset:
        conductor_->reset(5);
        break;
    }
  }

  /// Delivers all messages until there are none. For tests that do not explore the orders of the start.
  void settle() {
    for (bool any = true; any;) {
      any = false;
      for (auto& [name, queue] : channels_) {
        if (queue.empty()) continue;
        any = true;
        apply({Action::kDeliver, name, 0});
        break;
      }
    }
  }

  /// The whole state as text: equal fingerprints mean that the same actions have the same results from here on.
  [[nodiscard]] std::string fingerprint() const;  // defined in queue_world_parts.hpp

  [[nodiscard]] double plant_value() const { return dynamic_cast<ToyPlant&>(nodes_[0]->member->component()).value(); }
  [[nodiscard]] std::map<std::string, std::array<std::uint8_t, 32>> output_hashes() const {
    return conductor_->output_hashes();
  }
  [[nodiscard]] std::uint64_t refused() const {
    std::uint64_t sum = 0;
    for (const auto& node : nodes_) sum += node->member->counters().refused;
    return sum;
  }

 private:
  struct Node : MemberSink {
    QueueWorld* world = nullptr;
    std::size_t index = 0;
    std::unique_ptr<Member> member;
    std::optional<EpochId> ready_in;                     ///< the epoch for which it has sent Ready
    std::map<std::uint8_t, std::deque<Sample>> history;  ///< kept for late readers, lost when the process dies
    Hello hello;                                         ///< likewise
    std::deque<TickDone> steps;                          ///< likewise
    void publish(const TopicInfo& topic, const Sample& sample) override {
      auto& kept = history[topic.id];
      kept.push_back(sample);
      if (kept.size() > topic.depth) kept.pop_front();
      for (const auto& reader : world->nodes_) {
        if (reader && reader->member && reader->member->reads().contains(topic.id))
          world->send(*this, topic.id, *reader, sample);
      }
    }
    void done(const TickDone& step) override {
      steps.push_back(step);
      if (steps.size() > kStepsKept) steps.pop_front();
      world->push_done(*this, step);
    }
  };
  static constexpr std::size_t kStepsKept = 16;  // the depth of barrier/tick_done
  void push_done(const Node& from, const TickDone& step) {
    push(key(from, "done", "conductor"), fmt::format("d{},{}", step.epoch.epoch, step.index),
         [this, step] { conductor_->on_done(step); });
  }
  void push_ready(const Node& from) {
    push(key(from, "ready", "conductor"), fmt::format("r{}", from.ready_in->epoch),
         [this, name = from.member->name(), incarnation = from.member->incarnation(), epoch = *from.ready_in] {
           conductor_->on_ready(name, epoch, incarnation);
         });
  }
  /// Whether the process of `from` has sent the messages in a channel.
  static bool sent_by(const std::string& channel, const Node& from) {
    return channel.starts_with(from.member->name() + ".") || (from.index == 0 && channel.starts_with("conductor>"));
  }

  /// A message that has not arrived: its text in the fingerprint, and the action of its arrival.
  struct Message {
    std::string what;
    std::function<void()> deliver;
  };
  void push(const std::string& channel, std::string what, std::function<void()> deliver) {
    channels_[channel].push_back({std::move(what), std::move(deliver)});
  }
  static std::string key(const Node& from, const std::string& topic, const std::string& to) {
    return from.member->name() + "." + std::to_string(from.member->incarnation()) + ">" + topic + ">" + to;
  }
  static bool can_step(const Member& member) { return member.has_due_tick() && member.missing().topic == nullptr; }
  Node& find(const std::string& name) {
    for (auto& node : nodes_)
      if (node->member->name() == name) return *node;
    throw std::logic_error("no " + name);
  }

  void send(const Node& from, std::uint8_t topic, Node& to, const Sample& sample) {
    if (to.member->name() == from.member->name()) return to.member->on_sample(topic, sample);
    const std::string name = key(from, std::string(topics::kInfos[topic].name), to.member->name());
    Node* reader = &to;
    const msg::Header& header = *sample.header;
    push(name, fmt::format("s{},{},{}", header.epoch, header.incarnation, header.sequence_number),
         [this, name, reader, topic, sample] {
           ++delivered_[name];
           reader->member->on_sample(topic, sample);
         });
  }

  void start(std::size_t index, std::uint32_t incarnation) {
    auto node = std::make_unique<Node>();
    node->world = this;
    node->index = index;
    Setup setup;
    node->member =
        std::make_unique<Member>(factories_[index], setup, incarnation, true, static_cast<MemberSink&>(*node));
    nodes_.resize(std::max(nodes_.size(), index + 1));
    nodes_[index] = std::move(node);
    Hello& hello = nodes_[index]->hello;
    hello.component = nodes_[index]->member->name();
    hello.incarnation = incarnation;
    hello.run_id = conductor_->run_id();
    hello.pid = static_cast<int>(incarnation);
    hello.timing = nodes_[index]->member->timing();
    hello.reads = nodes_[index]->member->reads();
    hello.writes = nodes_[index]->member->writes();
    conductor_->on_hello(hello);
  }

  // Defined in queue_world_parts.hpp.
  void crash(const std::string& name, int lost);
  void crash_plant(int lost);
  /// Loses the newest messages that the process of `dead` has sent, and all that are on their way to it.
  void lose(const Node& dead, int lost);
  void send_histories_to(Node& reborn);

  void send_tick(const msg::Tick& tick, Node& to) {
    if (to.index == 0) return to.member->on_tick(tick);
    Node* reader = &to;
    const std::string name = "conductor>tick>" + to.member->name();
    push(name, fmt::format("t{},{}", tick.epoch, tick.index), [this, name, reader, tick] {
      ++delivered_[name];
      reader->member->on_tick(tick);
    });
  }
  void save() {
    if (checkpoints_) saved_ = conductor_->save();
  }
  void tick(const msg::Tick& tick) override {
    save();
    nodes_.front()->member->publish_sample();
    ticks_.push_back(tick);
    for (auto& node : nodes_) send_tick(tick, *node);
  }
  void start_epoch(const EpochId& epoch, std::uint64_t seed) override {
    save();
    ticks_.clear();
    for (auto& node : nodes_) send_epoch(*node, epoch, seed);
  }
  void continue_epoch(const EpochId& epoch, std::uint64_t seed, const std::vector<msg::Tick>& ticks) override {
    ticks_ = ticks;
    for (auto& node : nodes_) {
      send_epoch(*node, epoch, seed);
      for (const auto& each : ticks) send_tick(each, *node);
    }
  }
  void send_epoch(Node& to, const EpochId& epoch, std::uint64_t seed) {
    Node* reader = &to;
    const std::string name = "conductor>epoch>" + to.member->name();
    push(name, fmt::format("e{}", epoch.epoch), [this, name, reader, epoch, seed] {
      ++delivered_[name];
      reader->member->on_epoch(epoch, seed);
      send_ready(*reader);
    });
  }
  /// Sends Ready once for each epoch of the member, as the process of a member does.
  void send_ready(Node& from) {
    const Member& member = *from.member;
    if (!member.in_epoch() || from.ready_in == member.epoch()) return;
    from.ready_in = member.epoch();
    push_ready(from);
  }
  void resume(const Resume& resume) override {
    save();
    Node* reader = &find(resume.component);
    if (reader->index == 0) {  // in the conductor's own process
      reader->member->on_resume(resume);
      return send_ready(*reader);
    }
    const std::string what = fmt::format("R{},{}", resume.epoch.epoch, resume.index);
    push("conductor>resume>" + resume.component, what, [this, reader, resume] {
      reader->member->on_resume(resume);
      send_ready(*reader);
    });
  }
  void refuse(const Hello& hello, const std::string& reason) override {
    throw std::logic_error(hello.component + " refused: " + reason);
  }
  std::vector<ComponentFactory> factories_;
  std::int64_t final_tick_;
  bool checkpoints_;
  ConductorOptions options_;
  std::optional<Checkpoint> saved_;
  std::unique_ptr<Conductor> conductor_;
  std::vector<std::unique_ptr<Node>> nodes_;
  std::map<std::string, std::deque<Message>> channels_;
  std::map<std::string, int> delivered_;
  std::vector<msg::Tick> ticks_;
};

}  // namespace constrictor::testing::toys

#include "queue_world_parts.hpp"
