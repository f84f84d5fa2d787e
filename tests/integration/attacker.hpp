// A participant that does not belong to the run: it reads everything that a run publishes, and forges messages of its
// members.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <map>
#include <optional>
#include <string>

#include "constrictor/topics.hpp"
#include "cyclone/endpoint.hpp"
#include "support/eventually.hpp"

namespace constrictor::testing {

namespace wire = barrier_topics;

class Attacker {
 public:
  /// Joins with a configuration of its own, which does not limit the size of samples.
  explicit Attacker(std::uint32_t domain)
      : domain_(dds_create_domain(domain, kConfiguration), "dds_create_domain"),
        participant_(dds_create_participant(domain, nullptr, nullptr), "dds_create_participant"),
        hellos_(dds::Reader<msg::Hello>::member(get(), wire::kHello)),
        states_(dds::Reader<msg::RunState>::member(get(), wire::kRunState)),
        joint_commands_(dds::Reader<msg::JointCommand>::member(get(), std::string(topics::kJointCommand.name))),
        answers_(dds::Reader<msg::RunControlAnswer>::member(get(), wire::kRunControlAnswer)),
        hello(get(), wire::kHello),
        done(get(), wire::kTickDone),
        ready(get(), wire::kReady),
        tick(get(), wire::kTick),
        start(get(), wire::kEpochStart),
        refused(get(), wire::kRefused),
        control(get(), wire::kRunControl),
        stop(get(), wire::kEmergencyStop),
        // The user data of the true writer, in case that a process trusts it.
        joint_command(get(), std::string(topics::kJointCommand.name), 8, "control") {}

  [[nodiscard]] dds_entity_t get() const { return participant_.get(); }
  void poll() {
    hellos_.take([this](const msg::Hello& message) { known[message.component] = message; });
    states_.take([this](const msg::RunState& message) { state = message; });
    joint_commands_.take([this](const msg::JointCommand& message) { newest_command = message; });
    answers_.take([this](const msg::RunControlAnswer& message) {
      if (message.source == std::string("attacker")) answers[message.sequence_number] = message.refusal;
    });
  }
  // It has readers of its own of Hello and of joint commands, which its writers meet.
  /// Waits until it has read what it forges, and its writers have met readers.
  [[nodiscard]] bool ready_to_forge(std::size_t members) {
    return eventually([&] {
      poll();
      return known.size() >= members && state && state->tick > 5 && newest_command && hello.readers() > 1 &&
             done.readers() > 0 && tick.readers() > 0 && control.readers() > 0 && joint_command.readers() > 1;
    });
  }
  /// True if it has read or met anything within `bound`.
  [[nodiscard]] bool meets_anybody(std::chrono::milliseconds bound) {
    return eventually(
        [&] {
          poll();
          return !known.empty() || state || newest_command || hello.readers() > 1 || done.readers() > 0 ||
                 tick.readers() > 0 || control.readers() > 0 || stop.readers() > 0 || joint_command.readers() > 1;
        },
        bound);
  }

  /// A member's Hello, with all that the true one contains, its proof included.
  void forge_hello(const std::string& component, std::uint32_t incarnation) {
    msg::Hello message = known.at(component);
    message.incarnation = incarnation;
    message.pid = ::getpid();
    hello.write(message);
  }
  /// A finished step of a member, `ahead` ticks after the present one.
  void forge_done(const std::string& component, std::uint32_t incarnation, std::int64_t ahead, bool end) {
    msg::TickDone message{};
    dds::set_text(message.component, component);
    message.run_id = state->run_id;
    message.epoch = state->epoch;
    message.incarnation = incarnation;
    message.index = state->tick + ahead;
    message.end_of_run = end;
    done.write(message);
  }
  void forge_tick(std::int64_t ahead, bool final) {
    msg::Tick message{};
    message.run_id = state->run_id;
    message.epoch = state->epoch;
    message.index = state->tick + ahead;
    message.period_ns = 20'000'000;
    message.time_ns = message.index * message.period_ns;
    message.final_tick = final;
    for (auto& count : message.visible) count = 1'000'000;
    tick.write(message);
  }
  /// A setpoint far away, with a later number and perhaps a newer incarnation than any true one.
  void forge_joint_command(std::uint64_t numbers_ahead, std::uint32_t incarnation) {
    msg::JointCommand message = *newest_command;
    message.header.sequence_number += numbers_ahead;
    message.header.tick += static_cast<std::int64_t>(numbers_ahead);
    message.header.incarnation = incarnation;
    for (double& angle : message.position_rad) angle = 1.0;
    joint_command.write(message);
  }
  std::uint64_t forge_control(std::uint8_t command, const std::string& token) {
    msg::RunControl message{};
    dds::set_text(message.source, "attacker");
    dds::set_text(message.token, token);
    message.sequence_number = ++number_;
    message.run_id = state ? state->run_id : 0;
    message.command = command;
    control.write(message);
    return number_;
  }

 private:
  static constexpr const char* kConfiguration = R"(<CycloneDDS><Domain>
<General><Interfaces><NetworkInterface name="lo" multicast="false"/></Interfaces>
<AllowMulticast>false</AllowMulticast><MaxMessageSize>65500B</MaxMessageSize></General>
<Discovery><ParticipantIndex>auto</ParticipantIndex><MaxAutoParticipantIndex>119</MaxAutoParticipantIndex>
<Peers><Peer Address="127.0.0.1"/></Peers></Discovery>
<Tracing><Verbosity>none</Verbosity></Tracing>
</Domain></CycloneDDS>)";

  dds::Entity domain_;
  dds::Entity participant_;
  dds::Reader<msg::Hello> hellos_;
  dds::Reader<msg::RunState> states_;
  dds::Reader<msg::JointCommand> joint_commands_;
  dds::Reader<msg::RunControlAnswer> answers_;
  std::uint64_t number_ = 0;

 public:
  dds::Writer<msg::Hello> hello;
  dds::Writer<msg::TickDone> done;
  dds::Writer<msg::Ready> ready;
  dds::Writer<msg::Tick> tick;
  dds::Writer<msg::EpochStart> start;
  dds::Writer<msg::Refused> refused;
  dds::Writer<msg::RunControl> control;
  dds::Writer<msg::EmergencyStop> stop;
  dds::Writer<msg::JointCommand> joint_command;

  std::map<std::string, msg::Hello> known;  ///< by component
  std::optional<msg::RunState> state;
  std::optional<msg::JointCommand> newest_command;
  std::map<std::uint64_t, std::string> answers;  ///< refusals of forged commands, by number
};

}  // namespace constrictor::testing
