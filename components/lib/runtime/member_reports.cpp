// The part of MemberSide that reports the states of its members, and what they wait for.
#include <unistd.h>

#include "component/device_owner.hpp"
#include "configuration/counted.hpp"
#include "cyclone/gathered_sends.hpp"
#include "runtime/member_side.hpp"
#include "runtime/version.hpp"

namespace constrictor {

void MemberSide::publish_status(LocalMember& local, std::uint8_t state) {
  const Member& member = *local.member;
  msg::ComponentStatus status{};
  dds::set_text(status.component, member.name());
  if (member.in_epoch()) {
    status.run_id = member.epoch().run_id;
    status.epoch = member.epoch().epoch;
  }
  status.incarnation = member.incarnation();
  status.state = state;
  status.tick = member.last_done();
  local.meter.fill(status);
  local.jitter.fill(status);
  dds::set_text(status.scheduling, context_.scheduling);
  // The thread of a member that steps meanwhile uses its component.
  if (const auto* owner = dynamic_cast<DeviceOwner*>(&local.member->component()); owner && !member.stepping())
    dds::set_text(status.device, owner->device_status());
  status.overruns = member.counters().skipped;
  status.refused_count = member.counters().refused;
  dds::set_text(status.last_refusal, member.counters().last_refusal);
  dds::set_text(status.version, kVersion);
  dds::set_text(status.idl_hash, std::string(msg::kIdlHash));
  status.pid = ::getpid();
  dds::set_text(status.host, context_.host_name);
  status_writer_.write(status);
}

void MemberSide::report_waiting() {
  if (!unmatched_.empty()) context_.log.warning("{}", bus_->explain(unmatched_));
  for (auto& local : members_) {
    if (local.member->stepping()) continue;
    const MissingInput missing = local.member->missing();
    if (missing.topic) {
      report_waiting(*local.member, std::string(missing.topic->name), std::string(missing.topic->writer), missing.tick,
                     missing.have, missing.want);
    } else if (!conductor_) {
      report_waiting(*local.member, local.member->in_epoch() ? "Tick" : "EpochStart", context_.options.plant,
                     missing.tick, 0, 1);
    }
    publish_status(local, msg::kComponentWaiting);
  }
  // A process that has not received the Hello of this one does not accept its messages. A repeated Hello does no harm.
  send_hello();
}

void MemberSide::report_waiting(const Member& waiter, const std::string& topic, const std::string& writer,
                                std::int64_t tick, std::uint64_t have, std::uint64_t want) {
  context_.log.about(waiter.name())
      .warning("waits for {} of {} at tick {} (has {}, needs {}) for {:.0f} s", topic, writer, tick, have, want,
               context_.waited_s());
  msg::Waiting message{};
  dds::set_text(message.component, waiter.name());
  if (waiter.in_epoch()) message.run_id = waiter.epoch().run_id;
  message.tick = tick;
  dds::set_text(message.topic, topic);
  dds::set_text(message.writer, writer);
  message.have = have;
  message.want = want;
  message.waited_s = context_.waited_s();
  waiting_writer_.write(message);
}

void MemberSide::publish_last_statuses() {
  // Only the final tick ends a run. A process that a signal ends earlier reports that its members are running.
  for (auto& local : members_)
    publish_status(local, local.member->ended() ? msg::kComponentEnded : msg::kComponentRunning);
}

void MemberSide::finish() {
  // First of all: a servo whose torque is on stops with a tripped watchdog when its bus is silent.
  for (auto& local : members_) {
    if (!local.member->stepping()) local.member->release_device();
  }
  publish_last_statuses();
  // The ticks arrive once in a process, whichever of its members they are for.
  if (const std::string late = members_.front().jitter.histogram(); !late.empty()) context_.log.info("{}", late);
  if (const auto sent = dds::GatheredSends::counts(); sent.messages > 0)
    context_.log.info("sent {} of its steps in {}", counted(sent.messages, "message"),
                      counted(sent.datagrams, "datagram"));
}

}  // namespace constrictor
