// The samples of one topic that have arrived for a member, and what its steps may see of them.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "component/ports.hpp"

namespace constrictor {

/// Samples may arrive early, late, twice, or in several incarnations of their writer. A step sees exactly the samples
/// that the tick makes visible (`Tick.visible`), so that the order of arrival has no effect. Before the first epoch
/// the buffer is empty.
class InputBuffer {
 public:
  /// The treatment of an arriving sample.
  enum class Arrival {
    kNew,          ///< keep() it
    kReplacement,  ///< keep() it: a newer incarnation of the writer repeated a step that this reader has not seen
    kDuplicate,    ///< drop it: it is known already, which is normal after a restart
    kTooFarAhead,  ///< reject it: no writer can be so many samples ahead
  };
  /// Sequence numbers beyond the newest one that was consumed or announced.
  static constexpr std::uint64_t kFarthestAhead = 4096;

  /// `events`: the component wants every sample, not only the newest.
  InputBuffer(const TopicInfo& topic, bool events);
  InputBuffer(const InputBuffer&) = delete;  // ports point to slot()
  InputBuffer& operator=(const InputBuffer&) = delete;

  [[nodiscard]] const TopicInfo& topic() const { return *slot_.topic; }
  [[nodiscard]] const InputSlot& slot() const { return slot_; }

  [[nodiscard]] Arrival classify(const msg::Header& header) const;
  /// A sample that is not valid keeps its place in the sequence, so that no step waits for it, but no step sees it.
  void keep(const Sample& sample, bool valid);
  /// Whether every sample that a step at `tick` must see has arrived. At real-time pace nothing is waited for.
  [[nodiscard]] bool complete(const msg::Tick& tick) const;
  /// A tick has said that the topic has this many samples. At real-time pace a reader may have missed any number.
  void announce(std::uint64_t count) { announced_ = std::max(announced_, count); }
  /// Fills slot() for a step at `tick`; at real-time pace with everything that has arrived.
  void present(const msg::Tick& tick);

  /// For a restarted member that has not stepped yet: whether the sample has arrived that its last step saw as the
  /// newest, or a later one.
  [[nodiscard]] bool complete_again() const;
  /// Fills slot() with this sample, as it was after the step at `tick`; no sample is fresh.
  void present_again(std::int64_t tick);

  /// The newest sequence number that a sample may have.
  [[nodiscard]] std::uint64_t farthest() const { return std::max(consumed_, announced_) + kFarthestAhead; }
  /// Newest sequence number that a step has seen; 0 before the first.
  [[nodiscard]] std::uint64_t consumed() const { return consumed_; }
  /// Newest sequence number that has arrived; 0 before the first.
  [[nodiscard]] std::uint64_t newest() const { return samples_.empty() ? consumed_ : samples_.back().sequence(); }

  /// The part of a checkpoint; the samples themselves come from the writers' histories.
  template <class Archive>
  void serialize(Archive& archive) {
    archive(consumed_, last_valid_);
  }

 private:
  struct Entry {
    Sample sample;
    bool valid = true;
    [[nodiscard]] std::uint64_t sequence() const { return sample.header->sequence_number; }
  };
  using Entries = std::vector<Entry>;
  /// The first sample from this sequence number on, or after it; end() if there is none.
  [[nodiscard]] Entries::const_iterator from(std::uint64_t sequence) const;
  [[nodiscard]] Entries::const_iterator after(std::uint64_t sequence) const;
  /// The sample with this sequence number; end() if it has not arrived.
  [[nodiscard]] Entries::const_iterator find(std::uint64_t sequence) const;
  /// Newest valid sequence number up to `target`; 0 if there is none.
  [[nodiscard]] std::uint64_t newest_valid(std::uint64_t target) const;

  InputSlot slot_;
  Entries samples_;  ///< in the order of their sequence numbers; a vector, which keeps its memory from step to step
  std::uint64_t consumed_ = 0;
  std::uint64_t announced_ = 0;
  std::uint64_t last_valid_ = 0;  ///< newest valid sequence number up to consumed_
};

}  // namespace constrictor
