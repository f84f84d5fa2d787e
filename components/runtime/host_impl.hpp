// The inside of Host: members of this process, the conductor if the plant is here, and their links to DDS.
#pragma once

#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "runtime/barrier/conductor.hpp"
#include "runtime/barrier/member.hpp"
#include "runtime/control_sources.hpp"
#include "runtime/dds/domain.hpp"
#include "runtime/dds/member_bus.hpp"
#include "runtime/dds/outside_link.hpp"
#include "runtime/dds/wire.hpp"
#include "runtime/hash_log.hpp"
#include "runtime/host.hpp"
#include "runtime/pacer.hpp"
#include "runtime/status_meter.hpp"

namespace constrictor {

class Host::Impl : private MemberSink, private ConductorSink {
 public:
  Impl(HostOptions options, std::vector<ComponentFactory> factories);
  int run();

 private:
  using SteadyClock = std::chrono::steady_clock;

  struct LocalMember {
    std::unique_ptr<Member> member;
    StatusMeter meter;
    bool ready_said = false;
    std::string config_hash;  ///< of what it was built from
  };
  // MemberSink
  void publish(const TopicInfo& topic, const Sample& sample) override;
  void done(const StepDone& done) override;
  // ConductorSink
  void start_epoch(const EpochId& epoch, std::uint64_t seed) override;
  void tick(const msg::Tick& tick) override;
  void resume(const Resumption& resumption) override;
  void refuse(const Greeting& greeting, const std::string& reason) override;

  void make_endpoints();
  void make_conductor();
  void greet();
  [[nodiscard]] Greeting greeting_of(const LocalMember& local) const;
  [[nodiscard]] bool here(const std::string& component) const;
  /// The run that this process belongs to: its launcher's, else the one that began; 0: none yet.
  [[nodiscard]] std::uint64_t run_id() const;
  void take(std::size_t reader);
  void take_hello(const msg::Hello& message);
  void take_done(const msg::TickDone& message);
  /// Counts and names a message that is not accepted, in the ComponentStatus of a member here.
  void refuse_message(const std::string& topic, const std::string& reason);
  /// Whether a message names this process's run, if that is known; otherwise it is refused.
  [[nodiscard]] bool of_our_run(const char* topic, std::uint64_t named);
  /// Whether it obeys its IDL; otherwise it is refused.
  template <class T>
  [[nodiscard]] bool acceptable(const char* topic, const T& message);
  void take_control(const msg::RunControl& control);
  [[nodiscard]] std::string obey_control(const msg::RunControl& control);
  void note_authority(const TopicInfo& topic, const Sample& sample);
  void publish_run_state(bool changed);
  void say_ready();
  bool conduct();
  bool step_members();
  void watch();
  /// `waiter` is a member here.
  void report_waiting(const Member& waiter, const std::string& what, const std::string& whom, std::int64_t tick, std::uint64_t have,
                      std::uint64_t want);
  void publish_status(LocalMember& local, std::uint8_t state);
  void finish();

  HostOptions options_;
  dds::Domain domain_;
  std::vector<LocalMember> members_;
  Member* plant_ = nullptr;
  std::unique_ptr<Conductor> conductor_;
  std::unique_ptr<dds::MemberBus> bus_;
  std::unique_ptr<HashLog> hash_log_;
  std::string config_hash_;
  std::string identity_;

  dds::Reader<msg::Tick> tick_reader_;
  dds::Reader<msg::EpochStart> epoch_reader_;
  dds::Reader<msg::Resume> resume_reader_;
  dds::Reader<msg::Refused> refused_reader_;
  dds::Reader<msg::Hello> hello_reader_;
  dds::Reader<msg::TickDone> done_reader_;
  dds::Reader<msg::Ready> ready_reader_;
  dds::Reader<msg::RunControl> control_reader_;
  dds::Reader<msg::RunState> run_state_reader_;
  dds::Writer<msg::Tick> tick_writer_;
  dds::Writer<msg::EpochStart> epoch_writer_;
  dds::Writer<msg::Resume> resume_writer_;
  dds::Writer<msg::RunState> run_state_writer_;
  dds::Writer<msg::Refused> refused_writer_;
  dds::Writer<msg::Hello> hello_writer_;
  dds::Writer<msg::TickDone> done_writer_;
  dds::Writer<msg::Ready> ready_writer_;
  dds::Writer<msg::Waiting> waiting_writer_;
  dds::Writer<msg::ComponentStatus> status_writer_;
  std::unique_ptr<dds::OutsideLink> outside_link_;  ///< if a member here listens to outside requests
  dds::Entity wait_set_;
  std::vector<std::function<void()>> takers_;  ///< by index attached to the wait set

  std::map<std::string, Greeting> greetings_;  ///< of members elsewhere
  ControlSources control_sources_;
  Pacer pacer_;
  msg::RunState run_state_{};                  ///< conductor: as published last
  SteadyClock::time_point last_run_state_{};
  SteadyClock::time_point last_progress_ = SteadyClock::now();
  SteadyClock::time_point last_waiting_report_ = SteadyClock::now();
  SteadyClock::time_point last_match_check_{};
  dds::Unmatched unmatched_;                   ///< when it was looked at last
  int exit_status_ = -1;
};

}  // namespace constrictor
