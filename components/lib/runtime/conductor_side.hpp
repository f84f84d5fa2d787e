// The conductor in the plant's process: it sends ticks at the run's pace, collects what the other members report, and
// obeys `run_control`.
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "barrier/conductor.hpp"
#include "barrier/member.hpp"
#include "runtime/hash_log.hpp"
#include "runtime/host_context.hpp"
#include "runtime/links.hpp"
#include "runtime/pacer.hpp"
#include "runtime/rate_limit.hpp"
#include "runtime/run_control_answers.hpp"
#include "runtime/run_recorder.hpp"
#include "runtime/run_store.hpp"
#include "runtime/wire.hpp"

namespace constrictor {

class MemberSide;

class ConductorSide : private ConductorSink {
 public:
  /// The plant must be one of `members`. All arguments must outlive this object. Throws dds::Error, or
  /// std::runtime_error if the hash log cannot be written.
  ConductorSide(HostContext& context, Links& links, MemberSide& members);

  [[nodiscard]] std::optional<EpochId> epoch() const { return conductor_->epoch(); }
  /// Sends the next tick if the members and the pace allow it. Returns whether it did.
  bool tick();
  /// True while only the pace delays the next tick, and no member does.
  [[nodiscard]] bool held() const { return pacer_.holding() || conductor_->may_tick(); }
  /// [ns] time until the pace may allow the next tick.
  [[nodiscard]] std::int64_t wait_ns() const { return pacer_.wait_ns(); }
  /// To be called at least every 100 ms.
  void poll_recording();
  /// To be called before each wait: in lock-step it ends when all TickDone are there that the next tick waits for.
  void expect_done();
  /// Publishes RunState once a second, and at once if `changed`; not before the run has begun.
  void publish_run_state(bool changed);

  // Reports of the members of this process.
  void on_hello(const Hello& hello) { conductor_->on_hello(hello); }
  /// Answers a Hello that is rejected, within a limit for each second.
  void refuse_hello(const Hello& hello, const std::string& reason) { refuse(hello, reason); }
  void on_ready(const Member& member) { conductor_->on_ready(member.name(), member.epoch(), member.incarnation()); }
  void on_done(const TickDone& step);
  /// To be called when the members of this process have sent Hello. The successor of a process that died lets them
  /// continue, and publishes again what died with its predecessor.
  void continue_epoch() { conductor_->continue_epoch(); }

  /// Adapts the pace to the source that has authority. Samples of other topics and runs are ignored.
  void note_authority(const TopicInfo& topic, const Sample& sample);
  /// A member of this process has written `sample`: adds it to hash log and recording, if this run has them.
  void record(const TopicInfo& topic, const Sample& sample);
  /// True after the final tick while the process has to stay for other members: one that is restarted now needs its
  /// checkpoint and the final tick. At most 30 s.
  [[nodiscard]] bool stays();
  /// Reports the members that delay the next tick.
  void report_waiting();
  /// True if all members in other processes have reported that they have ended.
  [[nodiscard]] bool all_ended() const;
  /// Closes hash log and recording.
  void finish();

 private:
  // ConductorSink
  void start_epoch(const EpochId& epoch, std::uint64_t seed) override;
  void continue_epoch(const EpochId& epoch, std::uint64_t seed, const std::vector<msg::Tick>& ticks) override;
  void tick(const msg::Tick& tick) override;
  void resume(const Resume& resume) override;
  void refuse(const Hello& hello, const std::string& reason) override;

  void make_endpoints();
  void make_conductor();
  [[nodiscard]] ConductorOptions conductor_options() const;
  // Defined in conductor_store.cpp.
  void open_store();
  void make_successor(ConductorOptions options, const Checkpoint& found);
  /// Stores a checkpoint. To be called before anything is sent that a successor must know.
  void save();
  void flush_hash_log();
  /// Begins the recording if this run is recorded; `from`: continues that of the predecessor.
  void open_recording(std::optional<RecordingPosition> from);
  /// Adds what a member has written, as canonical bytes, to hash log and recording.
  void log(const std::vector<TickDone::Written>& written);
  [[nodiscard]] msg::EpochStart epoch_start(const EpochId& epoch, std::uint64_t seed) const;
  void send_epoch(const EpochId& epoch, std::uint64_t seed);
  void use_done(const TickDone& step);
  void take_done(const msg::TickDone& message);
  void take_ready(const msg::Ready& message);
  void stay_longer();
  void take_status(const msg::ComponentStatus& status);
  void take_control(const msg::RunControl& control);
  /// Answers a process that may not command the run, within a limit for each second.
  void refuse_stranger(const msg::RunControl& control, const std::string& reason);
  void take_stop(const msg::EmergencyStop& stop);
  /// Connects a plant that relays to a process outside the barrier with the topics hardware/*.
  void connect_hardware();
  /// Returns why the command is refused; empty if it was obeyed.
  [[nodiscard]] std::string obey(const msg::RunControl& control);
  [[nodiscard]] msg::RunState current_run_state() const;
  [[nodiscard]] std::int64_t period_ns() const;

  HostContext& context_;
  Links& links_;
  MemberSide& members_;
  Member& plant_;
  Pacer pacer_;
  std::unique_ptr<RunStore> store_;  ///< null: this run keeps no checkpoints
  Blob control_answers_bytes_;       ///< of control_answers_; null: to be made anew
  Checkpoint checkpoint_;            ///< the last one; kept for its memory, like the next two
  std::string head_of_conductor_;
  std::map<std::string, TickDone> last_done_;  ///< of each member in another process
  std::vector<TickDone> early_;  ///< of a tick that the predecessor of this conductor has sent, and it not yet
  std::unique_ptr<HashLog> hash_log_;
  std::unique_ptr<RunRecorder> recorder_;
  std::unique_ptr<Conductor> conductor_;
  RunControlAnswers control_answers_;
  std::set<std::string> ended_;  ///< members whose last status has arrived
  std::optional<HostContext::Clock::time_point> stays_until_;
  /// Answers to processes that may not take part or command, so that a flood of their messages causes no other flood.
  RateLimit strangers_;
  std::atomic<int> strange_controls_{0};  ///< DDS counts them in its threads
  RateLimit refusals_;
  msg::RunState run_state_{};  ///< tick and real-time factor of the last second
  HostContext::Clock::time_point last_run_state_{};
  dds::Reader<msg::TickDone> done_reader_;
  dds::Reader<msg::Ready> ready_reader_;
  dds::Reader<msg::RunControl> control_reader_;
  dds::Reader<msg::ComponentStatus> status_reader_;
  dds::Reader<msg::EmergencyStop> stop_reader_;
  dds::Reader<msg::HardwareJointState> hardware_joints_;
  dds::Reader<msg::HardwareContactState> hardware_contacts_;
  dds::Reader<msg::HardwareImuState> hardware_imus_;
  dds::Writer<msg::HardwareJointCommand> hardware_commands_;
  dds::Writer<msg::Tick> tick_writer_;
  dds::Writer<msg::EpochStart> epoch_writer_;
  dds::Writer<msg::Resume> resume_writer_;
  dds::Writer<msg::Refused> refused_writer_;
  dds::Writer<msg::RunControlAnswer> control_answer_writer_;
  dds::Writer<msg::RunState> run_state_writer_;
};

}  // namespace constrictor
