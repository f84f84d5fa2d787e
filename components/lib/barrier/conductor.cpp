#include "barrier/conductor.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "barrier/history_depth.hpp"

namespace constrictor {

Conductor::Conductor(ConductorOptions options, ConductorSink& sink)
    : options_(std::move(options)), sink_(sink), seed_(options_.seed) {
  for (const auto& name : options_.roster) members_[name];
}

void Conductor::on_hello(const Hello& hello) {
  const auto found = members_.find(hello.component);
  const auto refuse = [&](const std::string& reason) { sink_.refuse(hello, reason); };
  if (found == members_.end()) return refuse("no component of this name is in the roster");
  MemberState& member = found->second;
  if (member.hello_received && hello.pid == member.hello.pid && hello.host == member.hello.host &&
      hello.incarnation == member.hello.incarnation) {
    // A repeated Hello: its Resume has not arrived, or the predecessor of this conductor died before sending it.
    if (epoch_ && !member.ready && hello.incarnation > 1) send_resume(member);
    return;
  }
  if (member.hello_received && hello.incarnation <= member.hello.incarnation) {
    return refuse(
        fmt::format("two members of one name: incarnation {} runs as pid {} on {}; a replacement needs a "
                    "higher --incarnation",
                    member.hello.incarnation, member.hello.pid, member.hello.host));
  }
  const bool is_plant = hello.component == options_.plant;
  if (is_plant && member.hello_received && !awaits_plant_) return refuse("the plant cannot be replaced in a run");
  // A process that belongs to this run may still have to come back and conclude it.
  if (ended_ && hello.run_id == 0 && !is_plant) return refuse("the run is over");
  Hello ours;
  ours.idl_hash = options_.idl_hash;
  ours.release = options_.release;
  ours.component_hash = options_.component_hash;
  ours.config_hash = options_.config_hash;
  ours.numeric_profile = options_.numeric_profile;
  if (const auto what = difference(hello, ours)) return refuse(*what);
  if (const auto why = latency_violation(hello)) return refuse(*why);
  const bool differs = member.hello_received && hello.component_hash != member.hello.component_hash;
  if (differs && replaces(hello.component_hash)) {
    if (const auto why = replacement_violation(member.hello, hello)) return refuse(*why);
    // It begins anew, because it does not understand the memory of its predecessor.
    if (epoch_) member.state = std::make_shared<const std::string>(kBeginAnew);
  } else if (differs) {
    return refuse(
        fmt::format("its configuration or scenario file differs from the one that the run began with: found "
                    "hash {}, the run has {}",
                    hello.component_hash, member.hello.component_hash));
  }
  if (epoch_ && member.last_done >= 0 && !member.state) {
    return refuse("it cannot be resumed: its TickDone carried no checkpoint");
  }
  if (is_plant) awaits_plant_ = false;
  member.hello = hello;
  member.hello_received = true;
  member.ready = false;
  if (epoch_) {
    send_resume(member);
  } else if (std::all_of(members_.begin(), members_.end(),
                         [](const auto& entry) { return entry.second.hello_received; })) {
    epoch_ = EpochId{options_.run_id, 1};
    clear_epoch_state();
    sink_.start_epoch(*epoch_, seed_);
    // A member that was restarted before the epoch began waits for a Resume.
    for (const auto& [name, other] : members_) {
      if (other.hello.incarnation > 1) send_resume(other);
    }
  }
}

std::optional<std::string> Conductor::latency_violation(const Hello& hello) const {
  std::vector<Hello> all{hello};
  for (const auto& [name, other] : members_) {
    if (name == hello.component) continue;
    if (!other.hello_received) return {};  // the last Hello is compared with all others
    all.push_back(other.hello);
  }
  return depth_violation(all, options_.plant);
}

std::optional<std::string> Conductor::replacement_violation(const Hello& before, const Hello& hello) const {
  if (!options_.realtime || hello.component == options_.plant)
    return "--replace: accepted at real-time pace, for members other than the plant: in lock-step the run would not "
           "stay repeatable";
  for (const auto& topic : topics::kInfos) {
    if (before.writes.contains(topic.id) && !hello.writes.contains(topic.id))
      return fmt::format(
          "--replace: found a component that does not write {}, accepted one that writes what its "
          "predecessor wrote",
          topic.name);
  }
  return {};
}

void Conductor::send_resume(const MemberState& member) {
  Resume resume{member.hello.component,
                *epoch_,
                member.hello.incarnation,
                member.last_done,
                seed_,
                member.state ? *member.state : "",
                {}};
  for (const auto& [topic, samples] : member.history) {
    for (const auto& bytes : samples) resume.outputs.push_back({topic, *bytes});
  }
  sink_.resume(resume);
}

void Conductor::on_ready(const std::string& component, const EpochId& epoch, std::uint32_t incarnation) {
  const auto found = members_.find(component);
  if (found == members_.end() || epoch_ != epoch || found->second.hello.incarnation != incarnation) return;
  found->second.ready = true;
}

std::int64_t Conductor::newest_due(const MemberState& member, std::int64_t tick) const {
  const std::int64_t latest_start = tick - member.hello.timing.latency;
  if (latest_start < 0) return -1;
  return latest_start - latest_start % member.hello.timing.period;
}

std::optional<std::string> Conductor::foreign(const std::string& component, const EpochId& epoch,
                                              std::uint32_t incarnation) const {
  const auto found = members_.find(component);
  if (found == members_.end()) return fmt::format("component: found '{}', accepted one of the roster", component);
  if (epoch_ != epoch) return "of another run or epoch";
  if (incarnation > found->second.hello.incarnation)
    return fmt::format("incarnation: found {}, which has sent no Hello", incarnation);
  return {};
}

std::optional<std::string> Conductor::implausible(const TickDone& done) const {
  const MemberState& member = members_.at(done.component);
  if (done.incarnation < member.hello.incarnation || done.index <= member.last_done) return {};  // on_done() ignores it
  const std::int64_t period = member.hello.timing.period;
  if (done.index >= next_index_ || done.index % period != 0) {
    return fmt::format("index: found {}, accepted a tick that was sent and at which the member steps", done.index);
  }
  const auto steps =
      static_cast<std::uint64_t>((done.index - (member.last_done < 0 ? -period : member.last_done)) / period);
  for (const auto& [topic, count] : done.published) {
    if (topic >= topics::kCount || !member.hello.writes.contains(topic)) {
      return fmt::format("published: found topic {}, which the member does not write", topic);
    }
    const std::uint64_t before = member.published[topic];
    if (count < before || count - before > steps * topics::kInfos[topic].max_per_tick) {
      return fmt::format("published: found {} of topic {} after {}, accepted at most {} more", count, topic, before,
                         steps * topics::kInfos[topic].max_per_tick);
    }
  }
  for (const auto& written : done.written) {
    if (!member.hello.writes.contains(written.topic)) {
      return fmt::format("checkpoint: found topic {}, which the member does not write", written.topic);
    }
  }
  return {};
}

bool Conductor::is_early(const TickDone& done) const {
  return successor_ && done.index == next_index_ && done.incarnation == members_.at(done.component).hello.incarnation;
}

bool Conductor::on_done(const TickDone& done) {
  const auto found = members_.find(done.component);
  if (found == members_.end() || epoch_ != done.epoch) return false;
  MemberState& member = found->second;
  // A message of an older incarnation is late. A known step was repeated after a restart that had lost nothing.
  if (done.incarnation != member.hello.incarnation || done.index <= member.last_done || done.index >= next_index_)
    return false;
  member.last_done = done.index;
  if (done.component != options_.plant) {
    member.state = done.state.empty() ? nullptr : std::make_shared<const std::string>(done.state);
    member.state_index = done.index;
  }
  for (const auto& [topic, count] : done.published) member.published[topic] = count;
  member.pending.push_back({done.index, done.incarnation, member.published, done.output_hash});
  for (const auto& written : done.written) keep(member, written);
  if (done.end_of_run) {
    const std::int64_t at = done.index + member.hello.timing.latency;
    end_requested_at_ = std::min(end_requested_at_.value_or(at), at);
  }
  return true;
}

void Conductor::keep(MemberState& member, TickDone::Written written) {
  auto& history = member.history[written.topic];
  history.push_back(std::make_shared<const std::string>(std::move(written.bytes)));
  if (history.size() > topics::kInfos[written.topic].depth) history.pop_front();
}

bool Conductor::may_tick() const {
  if (!epoch_ || ended_) return false;
  return std::all_of(members_.begin(), members_.end(), [this](const auto& entry) {
    if (options_.realtime && entry.first != options_.plant) return entry.second.ready || next_index_ > 0;
    return entry.second.ready && entry.second.last_done >= newest_due(entry.second, next_index_);
  });
}

bool Conductor::awaits_step(const std::string& component) const {
  const MemberState& member = members_.at(component);
  return epoch_ && !ended_ && !options_.realtime && member.ready && member.last_done < newest_due(member, next_index_);
}

std::vector<Conductor::Owed> Conductor::owed() const {
  std::vector<Owed> owed;
  for (const auto& [name, member] : members_) {
    if (!member.hello_received) {
      owed.push_back({name, "Hello", 0, 1});
    } else if (epoch_ && !member.ready) {
      owed.push_back({name, "Ready", 0, 1});
    } else if (epoch_ && !options_.realtime && member.last_done < newest_due(member, next_index_)) {
      owed.push_back({name, "TickDone", member.last_done, newest_due(member, next_index_)});
    }
  }
  return owed;
}

void Conductor::tick(const std::vector<TickDone::Count>& plant, PlantCheckpoint checkpoint) {
  for (auto& [name, member] : members_) {
    auto step = member.pending.begin();
    for (; step != member.pending.end() && step->index + member.hello.timing.latency <= next_index_; ++step) {
      for (std::size_t topic = 0; topic < topics::kCount; ++topic) {
        if (step->published[topic] <= visible_[topic]) continue;
        incarnations_[topic] = step->incarnation;
        visible_[topic] = step->published[topic];
      }
      member.output_hash = step->output_hash;
    }
    member.pending.erase(member.pending.begin(), step);
  }
  MemberState& owner = members_.at(options_.plant);
  for (const auto& [topic, count] : plant) {
    if (count > visible_[topic]) incarnations_[topic] = owner.hello.incarnation;
    visible_[topic] = count;
  }
  if (!checkpoint.state.empty()) {
    owner.state = std::make_shared<const std::string>(std::move(checkpoint.state));
    owner.state_index = owner.last_done;
  }
  for (auto& written : checkpoint.written) keep(owner, std::move(written));
  msg::Tick tick{};
  tick.run_id = epoch_->run_id;
  tick.epoch = epoch_->epoch;
  tick.index = next_index_;
  tick.time_ns = next_time_ns();
  tick.period_ns = options_.period_ns;
  tick.final_tick = next_is_final();
  tick.realtime = options_.realtime;
  std::copy(visible_.begin(), visible_.end(), tick.visible);
  std::copy(incarnations_.begin(), incarnations_.end(), tick.incarnations);
  ended_ = tick.final_tick;
  ++next_index_;
  std::size_t most_late = 1;
  for (const auto& [name, member] : members_) most_late = std::max<std::size_t>(most_late, member.hello.timing.latency);
  ticks_.push_back(tick);
  if (ticks_.size() > most_late + 1) ticks_.erase(ticks_.begin());
  sink_.tick(tick);
}

void Conductor::clear_epoch_state() {
  for (auto& [name, member] : members_) {
    Hello hello = member.hello;
    member = MemberState{};
    member.hello = std::move(hello);
    member.hello_received = true;
  }
  next_index_ = 0;
  ended_ = false;
  ticks_.clear();
  end_requested_at_.reset();
  visible_ = {};
  incarnations_ = {};
}

void Conductor::reset(std::uint64_t seed) {
  if (!epoch_) return;
  ++epoch_->epoch;
  seed_ = seed;
  clear_epoch_state();
  sink_.start_epoch(*epoch_, seed_);
}

std::map<std::string, std::array<std::uint8_t, 32>> Conductor::output_hashes() const {
  std::map<std::string, std::array<std::uint8_t, 32>> hashes;
  for (const auto& [name, member] : members_) hashes[name] = member.output_hash;
  return hashes;
}

std::uint32_t Conductor::incarnation(const std::string& component) const {
  const auto found = members_.find(component);
  return found == members_.end() ? 0 : found->second.hello.incarnation;
}

}  // namespace constrictor
