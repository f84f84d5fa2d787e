// A component as a participant in the barrier: it knows which tick is due and which inputs the step needs, and reports
// each finished step. Without DDS and clock: its owner delivers the messages. Messages of one writer must be delivered
// in the order in which they were sent; messages of different writers may come in any order.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "barrier/input_buffer.hpp"
#include "barrier/protocol.hpp"
#include "component/client_requests.hpp"
#include "component/component.hpp"
#include "component/hardware_link.hpp"
#include "component/plant_stop.hpp"
#include "constrictor/sha256.hpp"

namespace constrictor {

/// Receives what a member sends.
class MemberSink {
 public:
  virtual ~MemberSink() = default;
  virtual void publish(const TopicInfo& topic, const Sample& sample) = 0;
  virtual void done(const TickDone& done) = 0;
};

/// The input for which a member waits; for log lines and `Waiting` messages.
struct MissingInput {
  std::int64_t tick = -1;
  const TopicInfo* topic = nullptr;  ///< null: it waits for the next Tick
  std::uint64_t have = 0;
  std::uint64_t want = 0;
};

class Member {
 public:
  /// `checkpoints`: TickDone carries state and outputs, so that the member can be restarted. Not needed if the
  /// conductor is in the same process. Throws what the component's constructor throws.
  Member(ComponentFactory factory, Setup setup, std::uint32_t incarnation, bool checkpoints, MemberSink& sink);
  ~Member();
  Member(const Member&) = delete;
  Member& operator=(const Member&) = delete;

  [[nodiscard]] const std::string& name() const { return setup_.component; }
  /// The setup from which the component is built, with the configuration file that is in force.
  [[nodiscard]] const Setup& setup() const { return setup_; }
  [[nodiscard]] std::uint32_t incarnation() const { return incarnation_; }
  [[nodiscard]] Timing timing() const { return timing_; }
  [[nodiscard]] TopicSet reads() const { return reads_; }
  [[nodiscard]] TopicSet writes() const { return writes_; }
  [[nodiscard]] Component& component() { return *component_; }
  /// The latch of clients' requests to this component; null if the component takes none.
  [[nodiscard]] const std::shared_ptr<ClientRequests>& client_requests() const { return client_requests_; }
  /// The latch of emergency stops for this component; null if it takes none.
  [[nodiscard]] const std::shared_ptr<StopOrders>& stop_orders() const { return stop_orders_; }
  /// The latch of a process outside the barrier; null if the component relays to none.
  [[nodiscard]] const std::shared_ptr<HardwareLink>& hardware_link() const { return hardware_link_; }
  /// Counts a message that was rejected; `reason` names what was found and what is accepted.
  void refuse(const std::string& reason);

  /// Begins a new epoch: the component is built anew. A restarted member (incarnation > 1) first waits for its Resume,
  /// which belongs to this epoch, or to the previous one if the run was reset in the meantime.
  void on_epoch(const EpochId& epoch, std::uint64_t seed);
  /// Continues after the last finished step of the previous incarnation, and publishes its last outputs again. Throws
  /// std::runtime_error if the component cannot load the state; other damage is rejected and counted.
  void on_resume(const Resume& resume);
  void on_tick(const msg::Tick& tick);
  /// Validates the sample. A rejected sample keeps its place in the sequence, so that no step waits for it.
  void on_sample(std::size_t topic_id, const Sample& sample);

  /// Plant only: lets the component measure at the instant of the next tick. published() then has the counts. The
  /// samples are kept until publish_sample(), so that the checkpoint can be stored before any process receives them.
  PlantCheckpoint measure(std::int64_t index, std::int64_t time_ns, std::int64_t period_ns);
  /// Plant only: publishes what measure() has kept.
  void publish_sample();
  /// Plant only: measure() and publish_sample().
  void sample_plant(std::int64_t index, std::int64_t time_ns, std::int64_t period_ns);
  /// Samples of each topic that it writes, since the epoch began. Valid until the next call or step.
  [[nodiscard]] const std::vector<TickDone::Count>& published();

  /// Does one step if a tick is due and all of its inputs have arrived. Returns whether it did.
  bool try_step();
  /// The three parts of try_step(), for an owner that wants to call the component in another thread. Begins a step if
  /// none is in progress, a tick is due and all of its inputs have arrived; returns whether it did.
  bool begin_step();
  /// Calls the component once after begin_step(). Any thread may call it. Meanwhile messages may be delivered (on_tick,
  /// on_sample) and const functions may be called.
  void run_step();
  /// Publishes the outputs and reports the step, after run_step() has returned.
  void finish_step();
  /// Whether a step has begun that is not finished. on_epoch() drops it; run_step() must have returned by then.
  [[nodiscard]] bool stepping() const { return step_.has_value(); }
  /// Whether a tick is due whose step has not begun, because inputs are missing.
  [[nodiscard]] bool has_due_tick() const { return !stepping() && due() != nullptr; }
  /// True after the run's final tick and the last step.
  [[nodiscard]] bool ended() const { return ended_; }
  /// True after the final tick as long as steps before it are due, or a restarted member lacks inputs of its last step.
  [[nodiscard]] bool concluding() const { return concludes_at_.has_value(); }
  /// Puts the device of the component to rest, if it owns one. No step may be in progress, and none may follow. The
  /// final tick does the same.
  void release_device();
  /// Ends a member that is concluding() with the steps that it has done and the inputs that have arrived. Does nothing
  /// while a step is in progress.
  void conclude_anyway();
  /// Tick of the last finished step; -1 before the first.
  [[nodiscard]] std::int64_t last_done() const { return last_done_; }
  [[nodiscard]] std::int64_t newest_tick() const { return newest_tick_; }
  [[nodiscard]] bool in_epoch() const { return epoch_.has_value(); }
  /// The present epoch. Aborts if in_epoch() is false.
  [[nodiscard]] const EpochId& epoch() const;
  [[nodiscard]] MissingInput missing() const;

  struct Counters {
    std::uint64_t refused = 0;  ///< rejected messages: invalid, of another epoch, too many
    std::string last_refusal;
    std::uint64_t duplicates = 0;  ///< dropped samples that were known already; normal after a restart
    std::uint64_t skipped =
        0;  ///< due ticks without a step because the previous step took too long (real-time pace only)
  };
  [[nodiscard]] const Counters& counters() const { return counters_; }

 private:
  struct OutputPort {
    OutputSlot slot;
    std::uint64_t count = 0;  ///< samples since the epoch began
    int in_this_step = 0;
  };
  /// Inputs and results of a step in progress. Until finish_step(), only run_step() uses them.
  struct Step {
    Tick tick;
    std::vector<std::pair<const TopicInfo*, Sample>> outputs{};
    std::vector<std::string> refusals{};
  };
  class MemberWiring;
  void refuse_from_component(const std::string& reason);
  void build(std::uint64_t seed);
  void replay_early();
  /// Ends the member, at once or as soon as its last step is done and the inputs of that step have arrived again.
  void conclude(const msg::Tick& final_tick);
  /// Whether steps before the final tick are still to be finished. At real-time pace, those whose ticks have arrived.
  [[nodiscard]] bool is_behind(const msg::Tick& final_tick) const;
  /// The part of conclude() that follows the last step. By value, because it resets concludes_at_.
  void finish(msg::Tick final_tick);
  [[nodiscard]] const msg::Tick* due() const;
  void skip_to_newest();
  void write(OutputPort& port, const void* message);
  /// Uses the memory of `memory`, whose content is lost.
  [[nodiscard]] std::string state_bytes(std::string memory) const;
  void restore(const std::string& state);
  void count_on(const std::vector<std::pair<const TopicInfo*, Sample>>& outputs);

  ComponentFactory factory_;
  Setup setup_;
  std::uint32_t incarnation_;
  bool checkpoints_;
  MemberSink& sink_;
  std::unique_ptr<MemberWiring> wiring_;
  std::unique_ptr<Component> component_;
  bool fresh_component_ = true;  ///< it has not stepped since it was built
  bool resumed_ = false;         ///< it has not stepped since it loaded a checkpoint
  bool is_plant_ = false;
  Timing timing_;
  TopicSet reads_;
  TopicSet writes_;
  std::vector<std::unique_ptr<InputBuffer>> inputs_;
  std::vector<std::unique_ptr<OutputPort>> outputs_;
  std::optional<EpochId> epoch_;
  std::optional<std::pair<EpochId, std::uint64_t>>
      epoch_after_resume_;                             ///< with its seed: it was announced before the Resume came
  std::vector<std::pair<std::size_t, Sample>> early_;  ///< arrived before the epoch was known
  std::vector<msg::Tick> early_ticks_;                 ///< likewise
  std::vector<msg::Tick> ticks_;                       ///< due ticks whose step is not finished, in their order
  std::int64_t last_done_ = -1;
  std::int64_t newest_tick_ = -1;
  bool ended_ = false;
  std::optional<msg::Tick> concludes_at_{};  ///< the final tick, while concluding()
  bool end_requested_ = false;
  std::optional<Step> step_;
  std::vector<std::pair<const TopicInfo*, Sample>> outputs_memory_;  ///< for the outputs of the next step
  std::string message_bytes_;                                        ///< of one message
  TickDone done_;                                                    ///< the last one
  bool measuring_ = false;
  std::vector<std::pair<const TopicInfo*, Sample>> sample_;  ///< measured by the plant, and not published
  msg::Header stamp_{};                                      ///< header of the step in progress, sequence aside
  std::array<std::uint8_t, 32> output_hash_{};
  Sha256 hash_;
  std::vector<TickDone::Written> written_;  ///< by the step in progress
  Counters counters_;
  std::shared_ptr<ClientRequests> client_requests_;
  std::shared_ptr<StopOrders> stop_orders_;
  std::shared_ptr<HardwareLink> hardware_link_;
};

}  // namespace constrictor
