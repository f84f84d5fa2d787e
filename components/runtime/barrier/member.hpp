// A component in the barrier: which tick is due, which inputs it needs, what it says when the step is done. Pure: no DDS,
// no clock; whoever owns it delivers messages in any order that keeps each writer's own.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "runtime/barrier/protocol.hpp"
#include "runtime/component.hpp"
#include "runtime/outside_requests.hpp"

namespace constrictor {

/// Where a member's words go.
class MemberSink {
 public:
  virtual ~MemberSink() = default;
  virtual void publish(const TopicInfo& topic, const Sample& sample) = 0;
  virtual void done(const StepDone& done) = 0;
};

/// What a member waits for, for people.
struct MissingInput {
  std::int64_t tick = -1;
  const TopicInfo* topic = nullptr;  ///< null: it waits for the next Tick
  std::uint64_t have = 0;
  std::uint64_t want = 0;
};

class Member {
 public:
  /// `checkpoints`: whether StepDone shall carry state and outputs (not needed when the conductor shares this process).
  Member(ComponentFactory factory, Setup setup, std::uint32_t incarnation, bool checkpoints, MemberSink& sink);
  ~Member();
  Member(const Member&) = delete;
  Member& operator=(const Member&) = delete;

  [[nodiscard]] const std::string& name() const { return setup_.component; }
  /// What its component is built from, with the configuration file that counts.
  [[nodiscard]] const Setup& setup() const { return setup_; }
  [[nodiscard]] std::uint32_t incarnation() const { return incarnation_; }
  [[nodiscard]] Timing timing() const { return timing_; }
  [[nodiscard]] std::uint64_t reads() const { return reads_; }    ///< bit i: topic i
  [[nodiscard]] std::uint64_t writes() const { return writes_; }
  [[nodiscard]] Component& component() { return *component_; }
  /// Where what outsiders ask of this component goes in; null if it does not listen to them.
  [[nodiscard]] const std::shared_ptr<OutsideRequests>& outside() const { return outside_; }
  /// Counts a message that could not be accepted.
  void refuse(const std::string& reason);

  /// A new epoch: the component is built anew. A restarted member (incarnation > 1) waits for its Resumption first: it is of this
  /// epoch, or of the one before if a reset came between.
  void on_epoch(const EpochId& epoch, std::uint64_t seed);
  /// Continue where the previous incarnation's last finished step ended; its last outputs are published again.
  /// Throws std::runtime_error if the state is not one of this component's; other damage is refused.
  void on_resume(const Resumption& resumption);
  void on_tick(const msg::Tick& tick);
  /// Validates the sample; a refused one still counts in its writer's order, so that nothing waits for it.
  void on_sample(std::size_t topic_id, const Sample& sample);

  /// Plant only: samples what is measured at the instant of the coming tick. Counts are then in published().
  void sample_plant(std::int64_t index, std::int64_t time_ns, std::int64_t period_ns);
  /// Cumulative counts of everything it writes.
  [[nodiscard]] std::vector<StepDone::Count> published() const;

  /// Does one step if a due tick and all of its inputs are there.
  bool try_step();
  /// True after the run's final tick.
  [[nodiscard]] bool ended() const { return ended_; }
  /// Index of the last step done, -1 before.
  [[nodiscard]] std::int64_t last_done() const { return last_done_; }
  [[nodiscard]] std::int64_t newest_tick() const { return newest_tick_; }
  [[nodiscard]] bool in_epoch() const { return epoch_.has_value(); }
  /// The epoch it is in; only if in_epoch(): anything else is a bug and aborts.
  [[nodiscard]] const EpochId& epoch() const;
  [[nodiscard]] MissingInput missing() const;

  struct Counters {
    std::uint64_t refused = 0;       ///< messages refused: invalid, of another epoch, too many
    std::string last_refusal;
    std::uint64_t duplicates = 0;    ///< dropped without a word: expected after a rejoin
    std::uint64_t skipped = 0;       ///< due ticks passed over because the step was late (real-time pace only)
  };
  [[nodiscard]] const Counters& counters() const { return counters_; }

 private:
  struct Input;
  struct OutputPort;
  class MemberWiring;
  void build(std::uint64_t seed);
  void replay_early();
  void conclude(const msg::Tick& final_tick);
  [[nodiscard]] const msg::Tick* due() const;
  [[nodiscard]] bool complete(const Input& input, const msg::Tick& tick) const;
  void present(Input& input, const msg::Tick& tick);
  void skip_to_newest();
  void write(OutputPort& port, const void* message);
  void finish_step(const msg::Tick& tick);
  [[nodiscard]] std::string state_bytes() const;
  void restore(const std::string& state);

  ComponentFactory factory_;
  Setup setup_;
  std::uint32_t incarnation_;
  bool checkpoints_;
  MemberSink& sink_;
  std::unique_ptr<MemberWiring> wiring_;
  std::unique_ptr<Component> component_;
  bool fresh_component_ = true;      ///< never stepped since it was built
  Timing timing_;
  std::uint64_t reads_ = 0;
  std::uint64_t writes_ = 0;
  std::vector<std::unique_ptr<Input>> inputs_;
  std::vector<std::unique_ptr<OutputPort>> outputs_;
  std::optional<EpochId> epoch_;
  std::optional<std::pair<EpochId, std::uint64_t>> epoch_after_resume_;  ///< with its seed: heard of before the Resumption
  std::vector<std::pair<std::size_t, Sample>> early_;  ///< arrived before the epoch was known
  std::vector<msg::Tick> early_ticks_;                 ///< likewise
  std::map<std::int64_t, msg::Tick> ticks_;   ///< arrived and not yet done
  std::int64_t last_done_ = -1;
  std::int64_t newest_tick_ = -1;
  bool ended_ = false;
  bool end_requested_ = false;
  msg::Header stamp_{};              ///< header of the step in progress, sequence aside
  std::array<std::uint8_t, 32> output_hash_{};
  std::vector<StepDone::Written> written_;    ///< by the step in progress
  Counters counters_;
  std::shared_ptr<OutsideRequests> outside_;
};

}  // namespace constrictor
