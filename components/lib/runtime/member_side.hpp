// The members of one process: they announce themselves, get ready, step, and exchange messages with the other members.
#pragma once

#include <atomic>
#include <chrono>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "barrier/member.hpp"
#include "runtime/client_link.hpp"
#include "runtime/host_context.hpp"
#include "runtime/jitter_meter.hpp"
#include "runtime/links.hpp"
#include "runtime/member_bus.hpp"
#include "runtime/status_meter.hpp"
#include "runtime/step_thread.hpp"
#include "runtime/wire.hpp"

namespace constrictor {

class ConductorSide;

/// Without a conductor in the same process, ticks and epochs arrive over DDS; with one, by direct calls.
class MemberSide : private MemberSink {
 public:
  /// Builds the components and their endpoints. `context` and `links` must outlive this object. Throws
  /// ConfigurationError, dds::Error, or std::runtime_error if the member named as the plant is not a plant.
  MemberSide(HostContext& context, Links& links, std::vector<ComponentFactory> factories);
  ~MemberSide() override;
  /// Connects the conductor of this process. To be called before any message is taken.
  void connect(ConductorSide& conductor);

  /// The plant if it is in this process, else null.
  [[nodiscard]] Member* plant() const { return plant_; }
  /// Announces every member.
  void send_hello();
  /// Announces once a second every restarted member that still waits for its Resume: a message that is sent once would
  /// leave it waiting for ever if it were lost.
  void repeat_hello();
  /// Sends Ready for each member that is in an epoch and whose endpoints have all met their counterparts.
  void send_ready();
  /// Does every step that is due. Returns whether one was finished.
  bool step();
  /// Whether a member is stepping in a thread of its own.
  [[nodiscard]] bool stepping() const;
  [[nodiscard]] bool all_ended() const;
  /// Ends the members that were restarted at the end of the run, and for which inputs of their last step do not arrive.
  void conclude_anyway();
  /// Whether the plant is in this process, or its process is known, has not left the domain, and has begun no other
  /// run.
  [[nodiscard]] bool plant_lives() const;
  /// Whether a sample of a member topic may let a member step, or get ready. Otherwise all members wait for ticks, and
  /// samples can wait for the next tick, too.
  [[nodiscard]] bool want_inputs() const;
  /// False while a member has still to send Ready.
  [[nodiscard]] bool all_ready() const;
  /// Whether no step of this process takes long (Component::has_short_steps).
  [[nodiscard]] bool have_short_steps() const;

  // Messages of the conductor of this process.
  void on_epoch(const EpochId& epoch, std::uint64_t seed);
  void on_tick(const msg::Tick& tick);
  /// Ticks stop on purpose, so that the next one is not late.
  void on_pause();
  /// Returns whether the member is in this process.
  bool on_resume(const Resume& resume);

  /// Counts a rejected message in the ComponentStatus of a member of this process.
  void reject(const std::string& topic, const std::string& reason);
  /// True if a message belongs to the run of this process, or if that run is not known yet. Otherwise rejects the
  /// message and returns false.
  [[nodiscard]] bool accept_run(const char* topic, std::uint64_t run_id);
  /// Logs and publishes what each member waits for.
  void report_waiting();
  /// Logs and publishes that `waiter`, a member of this process, waits for a message of `writer`.
  void report_waiting(const Member& waiter, const std::string& topic, const std::string& writer, std::int64_t tick,
                      std::uint64_t have, std::uint64_t want);
  void publish_last_statuses();
  /// Puts the devices of the members to rest, and sends the last status of each member.
  void finish();
  /// Whether the component is in this process.
  [[nodiscard]] bool hosts(const std::string& component) const;

 private:
  struct LocalMember {
    std::unique_ptr<Member> member;
    StatusMeter meter;
    JitterMeter jitter;
    bool ready_sent = false;               ///< in the present epoch
    std::string config_hash;               ///< of its configuration and scenario file
    std::unique_ptr<StepThread> thread{};  ///< null: it steps in the thread of the process
  };

  // MemberSink
  void publish(const TopicInfo& topic, const Sample& sample) override;
  void done(const TickDone& done) override;

  void make_endpoints();
  void attach_barrier_readers();
  void attach_inputs();
  void take_epoch_start(const msg::EpochStart& start);
  void take_resume(const msg::Resume& message);
  void take_tick(const msg::Tick& tick);
  void take_refused(const msg::Refused& message);
  void take_hello(const msg::Hello& message, dds_instance_handle_t writer);
  /// The participant that has sent a Hello; empty if the Hello does not prove that it knows the run's token.
  [[nodiscard]] std::optional<dds::GuidPrefix> participant_that_proves(const Hello& hello,
                                                                       dds_instance_handle_t writer);
  void take_sample(std::size_t topic_id, const Sample& sample, dds_instance_handle_t writer);
  void take_run_state(const msg::RunState& state);
  [[nodiscard]] Hello hello_of(const LocalMember& local) const;
  /// The run of this process: the launcher's, else the one that has begun; 0: none yet.
  [[nodiscard]] std::uint64_t run_id() const;
  void make_threads();
  /// Finishes the step that the member's thread has done, if any, and starts the next one.
  bool step_in_thread(LocalMember& local);
  /// Publishes the outputs of a step and reports it.
  static void finish_step(Member& member);
  void note_step(LocalMember& local, std::chrono::nanoseconds duration);
  void publish_status(LocalMember& local, std::uint8_t state);

  HostContext& context_;
  Links& links_;
  std::atomic<int> strange_hellos_{0};  ///< DDS counts them in its threads
  std::uint32_t refusers_ = 0;
  bool new_run_ = false;  ///< the plant has begun another run after this one had ended
  std::vector<LocalMember> members_;
  Member* plant_ = nullptr;
  ConductorSide* conductor_ = nullptr;  ///< null: it is in another process
  std::string checkpoint_block_;        ///< of the last TickDone; kept for its memory
  std::unique_ptr<MemberBus> bus_;
  std::unique_ptr<ClientLink> client_link_;  ///< null: no member of this process takes requests
  dds::Reader<msg::Tick> tick_reader_;
  dds::Reader<msg::EpochStart> epoch_reader_;
  dds::Reader<msg::Resume> resume_reader_;
  dds::Reader<msg::Refused> refused_reader_;
  dds::Reader<msg::Hello> hello_reader_;
  dds::Reader<msg::RunState> run_state_reader_;
  dds::Writer<msg::Hello> hello_writer_;
  dds::Writer<msg::TickDone> done_writer_;
  dds::Writer<msg::Ready> ready_writer_;
  dds::Writer<msg::Waiting> waiting_writer_;
  dds::Writer<msg::ComponentStatus> status_writer_;
  std::map<std::string, Hello> hellos_;  ///< of members in other processes
  HostContext::Clock::time_point last_hello_{};
  HostContext::Clock::time_point last_match_check_{};
  Unmatched unmatched_;  ///< result of the last check
};

}  // namespace constrictor
