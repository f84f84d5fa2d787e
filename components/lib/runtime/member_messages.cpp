// The part of MemberSide that creates its endpoints and takes the messages that arrive there.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>

#include "runtime/conductor_side.hpp"
#include "runtime/member_side.hpp"

namespace constrictor {
namespace {

namespace wire = dds::barrier_topics;

}  // namespace

void MemberSide::make_endpoints() {
  const dds_entity_t participant = links_.participant();
  TopicSet reads;
  TopicSet writes;
  for (const auto& local : members_) {
    reads |= local.member->reads();
    writes |= local.member->writes();
  }
  const auto& roster = context_.options.roster;
  for (const auto& topic : topics::kInfos) {
    const std::string writer(topic.writer);
    const bool in_roster = std::count(roster.begin(), roster.end(), writer) > 0;
    if (hosts(writer) || !in_roster) reads.erase(topic.id);
  }
  bus_ = std::make_unique<dds::MemberBus>(participant, reads, writes, context_.identity);
  hello_writer_ = {participant, wire::kHello};
  waiting_writer_ = {participant, wire::kWaiting};
  status_writer_ = {participant, wire::kStatus};
  refused_reader_ = dds::Reader<msg::Refused>::member(participant, wire::kRefused);
  hello_reader_ = dds::Reader<msg::Hello>::member(participant, wire::kHello);
  if (!plant_) {
    done_writer_ = {participant, wire::kTickDone};
    ready_writer_ = {participant, wire::kReady};
    tick_reader_ = dds::Reader<msg::Tick>::member(participant, wire::kTick);
    epoch_reader_ = dds::Reader<msg::EpochStart>::member(participant, wire::kEpochStart);
    resume_reader_ = dds::Reader<msg::Resume>::member(participant, wire::kResume);
    run_state_reader_ = dds::Reader<msg::RunState>::member(participant, wire::kRunState);
  }
  attach_barrier_readers();
  attach_inputs();
}

void MemberSide::attach_barrier_readers() {
  if (!plant_) {
    links_.attach(epoch_reader_, wire::kEpochStart, [this](const msg::EpochStart& m) { take_epoch_start(m); });
    links_.attach(resume_reader_, wire::kResume, [this](const msg::Resume& m) { take_resume(m); });
    links_.attach(tick_reader_, wire::kTick, [this](const msg::Tick& m) { take_tick(m); });
    links_.attach(run_state_reader_, wire::kRunState, [this](const msg::RunState& m) { take_run_state(m); });
  }
  links_.attach(refused_reader_, wire::kRefused, [this](const msg::Refused& m) { take_refused(m); });
  links_.attach(hello_reader_, wire::kHello, [this](const msg::Hello& m) { take_hello(m); });
}

void MemberSide::attach_inputs() {
  for (auto& local : members_) {
    Member& member = *local.member;
    if (!member.client_requests()) continue;
    client_link_ = std::make_unique<dds::ClientLink>(links_.participant(), context_.options.setup.robot_id);
    client_link_->track_writers_for(*member.client_requests());
    links_.attach(client_link_->get(), [this, &member] {
      client_link_->take(*member.client_requests(), [&](const std::string& reason) { member.refuse(reason); });
    });
  }
  for (const auto& [topic_id, reader] : bus_->readers()) {
    const auto take = [this, id = topic_id] {
      bus_->take(id, [&](const Sample& sample) {
        if (conductor_) conductor_->note_authority(topics::kInfos[id], sample);
        for (auto& local : members_) {
          if (local.member->reads().contains(id)) local.member->on_sample(id, sample);
        }
      });
    };
    links_.attach(reader, take, Links::Wakes::kIfWanted);
  }
}

std::uint64_t MemberSide::run_id() const {
  if (context_.options.run_id != 0) return context_.options.run_id;
  if (conductor_ && conductor_->epoch()) return conductor_->epoch()->run_id;
  const auto begun =
      std::find_if(members_.begin(), members_.end(), [](const LocalMember& local) { return local.member->in_epoch(); });
  return begun == members_.end() ? 0 : begun->member->epoch().run_id;
}

bool MemberSide::accept_run(const char* topic, std::uint64_t named) {
  const std::uint64_t ours = run_id();
  if (ours == 0 || named == ours) return true;
  reject(topic, "run_id: of another run");
  return false;
}

void MemberSide::reject(const std::string& topic, const std::string& reason) {
  (plant_ ? plant_ : members_.front().member.get())->refuse(topic + "." + reason);
}

void MemberSide::take_hello(const msg::Hello& message) {
  const Hello hello = dds::from_wire(message);
  if (hello.run_id != 0 && !accept_run(wire::kHello, hello.run_id)) return;
  // A process of another run does not replace a member, and no member waits for it. The conductor sends it the reason.
  const bool same_run = !difference(hello, hello_of(members_.front()));
  const auto& roster = context_.options.roster;
  if (hosts(hello.component)) {
    if (hello.pid == ::getpid() && hello.host == context_.host_name) return;  // sent by this process itself
    if (!conductor_ && same_run && hello.incarnation > context_.options.incarnation) {
      context_.log.warning("replaced by incarnation {} of {} (pid {} on {}); this process ends", hello.incarnation,
                           hello.component, hello.pid, hello.host);
      context_.exit_status = exit_status::kRefused;
      return;
    }
  } else if (same_run && std::count(roster.begin(), roster.end(), hello.component) > 0) {
    hellos_[hello.component] = hello;
  }
  if (conductor_) conductor_->on_hello(hello);
}

void MemberSide::take_epoch_start(const msg::EpochStart& start) {
  // A process without --run-id joins the run of the first EpochStart that it receives.
  if (!accept_run(wire::kEpochStart, start.run_id)) return;
  if (start.config_hash != context_.config_hash) {
    return reject(wire::kEpochStart,
                  fmt::format("config_hash: found '{}', accepted {}", start.config_hash, context_.config_hash));
  }
  on_epoch({start.run_id, start.epoch}, start.seed);
}

void MemberSide::take_resume(const msg::Resume& message) {
  if (!accept_run(wire::kResume, message.run_id)) return;
  for (auto& local : members_) {
    Member& member = *local.member;
    if (member.name() != message.component || member.incarnation() != message.incarnation || member.in_epoch())
      continue;
    const auto resume = dds::from_wire(message);
    if (resume) member.on_resume(*resume);
    else member.refuse("resume.checkpoint: damaged");
  }
}

void MemberSide::take_tick(const msg::Tick& tick) {
  for (auto& local : members_) {
    const std::int64_t newest = local.member->newest_tick();
    local.member->on_tick(tick);
    // A new tick is progress of the run, even if no member of this process has a step to do.
    if (local.member->newest_tick() > newest) context_.note_progress();
  }
}

void MemberSide::take_refused(const msg::Refused& message) {
  if (message.pid != ::getpid() || message.host != context_.host_name ||
      message.incarnation != context_.options.incarnation || !hosts(message.component))
    return;
  if (!accept_run(wire::kRefused, message.run_id)) return;
  context_.log.error("the run refuses this process: {}", message.reason);
  context_.exit_status = exit_status::kRefused;
}

void MemberSide::take_run_state(const msg::RunState& state) {
  // The conductor sends RunState once a second. A run that is paused or held is not stuck.
  if (!state.paused && !state.ready_for_tick) return;
  const EpochId epoch{state.run_id, state.epoch};
  for (const auto& local : members_) {
    if (local.member->in_epoch() && local.member->epoch() == epoch) context_.note_progress();
  }
}

}  // namespace constrictor
