// Messages and sinks for tests that speak to Member and Conductor directly.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "barrier/conductor.hpp"
#include "barrier/member.hpp"
#include "barrier/topic_ops.hpp"

namespace constrictor {

inline constexpr EpochId kEpoch{7, 1};

/// A sample of `topic` as its writer would publish it at `tick`.
template <class T>
Sample sample_of(const Topic<T>& topic, std::uint64_t sequence_number, const T& message = {},
                 std::uint32_t incarnation = 1, const EpochId& epoch = kEpoch) {
  const msg::Header header{epoch.run_id, epoch.epoch, incarnation, 0, 0, sequence_number};
  return topic_ops(topic.id).stamp(&message, header, 1);
}

/// Tick `index` that makes `counts` visible, all written by first incarnations.
inline msg::Tick tick_at(std::int64_t index, const std::vector<TickDone::Count>& counts = {},
                         const EpochId& epoch = kEpoch) {
  msg::Tick tick{};
  tick.run_id = epoch.run_id;
  tick.epoch = epoch.epoch;
  tick.index = index;
  tick.period_ns = 20'000'000;
  tick.time_ns = index * tick.period_ns;
  for (const auto& [topic, count] : counts) {
    tick.visible[topic] = count;
    tick.incarnations[topic] = 1;
  }
  return tick;
}

/// Keeps everything that a member sends.
struct MemberRecord : MemberSink {
  void publish(const TopicInfo& topic, const Sample& sample) override { published.emplace_back(topic.id, sample); }
  void done(const TickDone& step) override { steps.push_back(step); }
  std::vector<std::pair<std::uint8_t, Sample>> published;
  std::vector<TickDone> steps;
};

/// Keeps everything that a conductor sends.
struct ConductorRecord : ConductorSink {
  void start_epoch(const EpochId& epoch, std::uint64_t seed) override { epochs.emplace_back(epoch, seed); }
  void tick(const msg::Tick& tick) override { ticks.push_back(tick); }
  void resume(const Resume& resume) override { resumes.push_back(resume); }
  void refuse(const Hello& hello, const std::string& reason) override {
    refusals.emplace_back(hello.component, reason);
  }
  std::vector<std::pair<EpochId, std::uint64_t>> epochs;
  std::vector<msg::Tick> ticks;
  std::vector<Resume> resumes;
  std::vector<std::pair<std::string, std::string>> refusals;
};

}  // namespace constrictor
