// The part of MemberSide that creates its endpoints and takes the messages that arrive there.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>

#include "barrier/plant_topics.hpp"
#include "runtime/conductor_side.hpp"
#include "runtime/member_side.hpp"

namespace constrictor {
namespace {

namespace wire = barrier_topics;

/// The name in Admission of every plant, also of one whose hashes differ: only a plant may refuse a process.
constexpr const char* kRefuser = "(plants)";
/// [s] without a tick, after which the state of another run is not just late.
constexpr double kWaitBeforeNewRun_s = 2.0;
constexpr int kMostStrangeHellos = 16;  // of components outside the roster, in the life of the process

/// [byte] about what a sample holds in memory.
std::size_t size_of(const TopicInfo& topic, const Sample& sample) {
  const bool is_image = topic.type == Description<msg::CameraImage>::kName;
  return topic_ops(topic.id).max_size +
         (is_image ? static_cast<const msg::CameraImage*>(sample.message.get())->data._length : 0);
}

bool is_in(const std::vector<std::string>& roster, const char* component) {
  return std::find(roster.begin(), roster.end(), component) != roster.end();
}

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
    const std::string writer = writer_in_run(topic, context_.options.plant);
    const bool in_roster = std::count(roster.begin(), roster.end(), writer) > 0;
    if (hosts(writer) || !in_roster) reads.erase(topic.id);
  }
  bus_ = std::make_unique<MemberBus>(participant, reads, writes, context_.identity, &links_.admission().book());
  hello_writer_ = {participant, wire::kHello};
  waiting_writer_ = {participant, wire::kWaiting};
  status_writer_ = {participant, wire::kStatus};
  dds::WriterBook& book = links_.admission().book();
  refused_reader_ = dds::Reader<msg::Refused>::guarded(
      participant, wire::kRefused, book, [&roster](const msg::Refused& m) { return is_in(roster, m.component); });
  hello_reader_ = dds::Reader<msg::Hello>::guarded(participant, wire::kHello, book, [this](const msg::Hello& m) {
    // The conductor answers a few components that are not in the roster, because their users have made a mistake.
    return is_in(context_.options.roster, m.component) || (plant_ && strange_hellos_++ < kMostStrangeHellos);
  });
  if (!plant_) {
    done_writer_ = {participant, wire::kTickDone};
    ready_writer_ = {participant, wire::kReady};
    tick_reader_ = dds::Reader<msg::Tick>::guarded(participant, wire::kTick, book);
    epoch_reader_ = dds::Reader<msg::EpochStart>::guarded(participant, wire::kEpochStart, book);
    resume_reader_ = dds::Reader<msg::Resume>::guarded(
        participant, wire::kResume, book, [&roster](const msg::Resume& m) { return is_in(roster, m.component); });
    run_state_reader_ = dds::Reader<msg::RunState>::guarded(
        participant, wire::kRunState, book,
        [run_id = context_.options.run_id](const msg::RunState& m) { return run_id == 0 || m.run_id == run_id; });
  }
  attach_barrier_readers();
  attach_inputs();
}

void MemberSide::attach_barrier_readers() {
  const auto by_plant = [this](const auto&) { return context_.options.plant; };
  const auto by_a_plant = [](const auto&) { return std::string(kRefuser); };
  links_.attach(refused_reader_, wire::kRefused, by_a_plant, [this](const msg::Refused& m) { take_refused(m); });
  if (!plant_) {
    links_.attach(epoch_reader_, wire::kEpochStart, by_plant,
                  [this](const msg::EpochStart& m) { take_epoch_start(m); });
    links_.attach(resume_reader_, wire::kResume, by_plant, [this](const msg::Resume& m) { take_resume(m); });
    links_.attach(tick_reader_, wire::kTick, by_plant, [this](const msg::Tick& m) { take_tick(m); });
    links_.attach(run_state_reader_, wire::kRunState, by_plant, [this](const msg::RunState& m) { take_run_state(m); });
  }
  links_.attach(hello_reader_.get(), [this] {
    hello_reader_.take_from([this](const msg::Hello& message, dds_instance_handle_t writer) {
      if (const auto violation = validate(message)) return reject(wire::kHello, *violation);
      take_hello(message, writer);
    });
  });
}

void MemberSide::attach_inputs() {
  for (auto& local : members_) {
    Member& member = *local.member;
    if (!member.client_requests()) continue;
    client_link_ = std::make_unique<ClientLink>(
        links_.participant(), context_.options.setup.robot_id,
        [this](const msg::Request& request) {
          return context_.stranger(request.token, request.header.run_id, run_id());
        },
        kWriterGrace, context_.options.token);
    client_link_->track_writers_for(*member.client_requests());
    links_.attach(client_link_->get(), [this, &member] {
      client_link_->take(*member.client_requests(), [&](const std::string& reason) { member.refuse(reason); });
    });
  }
  for (const auto& [topic_id, reader] : bus_->readers()) {
    const auto take = [this, id = topic_id] {
      bus_->take(id, [&](const Sample& sample, dds_instance_handle_t writer) { take_sample(id, sample, writer); });
    };
    links_.attach(reader, take, Links::Wakes::kIfWanted);
  }
}

void MemberSide::take_sample(std::size_t id, const Sample& sample, dds_instance_handle_t writer) {
  const TopicInfo& topic = topics::kInfos[id];
  const auto deliver = [this, id, sample] {
    if (conductor_) conductor_->note_authority(topics::kInfos[id], sample);
    for (auto& local : members_) {
      if (local.member->reads().contains(id)) local.member->on_sample(id, sample);
    }
  };
  const std::string component = writer_in_run(topic, context_.options.plant);
  const Admission::Verdict verdict = links_.admission().judge(component, writer);
  if (verdict == Admission::Verdict::kAccepted) return deliver();
  const bool kept = links_.admission().keep(component, writer, size_of(topic, sample), deliver);
  if (!kept || verdict == Admission::Verdict::kStranger) reject(std::string(topic.name), Links::kNotAnnounced);
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

std::optional<dds::GuidPrefix> MemberSide::participant_that_proves(const Hello& hello, dds_instance_handle_t writer) {
  const auto participant = links_.admission().book().participant_of(writer);
  const std::string& token = context_.options.token;
  if (!participant || token.empty() || same_token(hello.proof, hello_proof(token, hello, *participant)))
    return participant;
  return {};
}

void MemberSide::take_hello(const msg::Hello& message, dds_instance_handle_t writer) {
  const Hello hello = from_wire(message);
  if (hello.run_id != 0 && !accept_run(wire::kHello, hello.run_id)) return;
  if (hosts(hello.component) && hello.pid == ::getpid() && hello.host == context_.host_name)
    return;  // sent by this process itself
  const auto& roster = context_.options.roster;
  const auto participant = participant_that_proves(hello, writer);
  if (!participant && is_in(roster, hello.component.c_str())) {
    reject(wire::kHello, "proof: found none of the run's token");
    if (conductor_) conductor_->refuse_hello(hello, "it does not know the token of the run (see --token-file)");
    return;
  }
  Admission& admission = links_.admission();
  if (participant && hello.component == context_.options.plant) admission.announce(kRefuser, ++refusers_, *participant);
  // A process of another run does not replace a member, and no member waits for it. The conductor sends it the reason.
  const bool same_run = !difference(hello, hello_of(members_.front()));
  if (hosts(hello.component)) {
    if (!conductor_ && same_run && hello.incarnation > context_.options.incarnation) {
      context_.log.warning("replaced by incarnation {} of {} (pid {} on {}); this process ends", hello.incarnation,
                           hello.component, hello.pid, hello.host);
      context_.exit_status = exit_status::kRefused;
      return;
    }
  } else if (participant && same_run && is_in(roster, hello.component.c_str())) {
    if (admission.announce(hello.component, hello.incarnation, *participant)) hellos_[hello.component] = hello;
    else reject(wire::kHello, "another process has announced this member");
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
    const auto resume = from_wire(message);
    if (resume) member.on_resume(*resume);
    else member.refuse("resume.checkpoint: damaged");
  }
}

void MemberSide::take_tick(const msg::Tick& tick) {
  for (auto& local : members_) {
    const std::int64_t newest = local.member->newest_tick();
    local.member->on_tick(tick);
    // A new tick is progress of the run, even if no member of this process has a step to do.
    if (local.member->newest_tick() <= newest) continue;
    context_.note_progress();
    context_.log.at(tick.run_id, tick.epoch, tick.index);
    if (tick.realtime) local.jitter.arrived(HostContext::Clock::now(), tick.time_ns);
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
  // The plant has gone and come back with another run. This process can take part in it only as one that has just
  // begun.
  const std::uint64_t ours = run_id();
  const bool another = ours != 0 && state.run_id != ours;
  if (another && all_ended()) new_run_ = true;
  else if (another && context_.waited_s() > kWaitBeforeNewRun_s) {
    context_.log.warning(
        "{} has begun another run, {:016x}; this process ends, and can join it when it is started again",
        context_.options.plant, state.run_id);
    context_.exit_status = exit_status::kWaitedTooLong;
  }
  if (another) return;
  // The conductor sends RunState once a second. A run that is paused or held is not stuck.
  if (!state.paused && !state.ready_for_tick) return;
  const EpochId epoch{state.run_id, state.epoch};
  if (state.paused) on_pause();
  for (const auto& local : members_) {
    if (local.member->in_epoch() && local.member->epoch() == epoch) context_.note_progress();
  }
}

}  // namespace constrictor
