#include "runtime/member_side.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <stdexcept>

#include "barrier/plant_topics.hpp"
#include "configuration/configuration.hpp"
#include "cyclone/gathered_sends.hpp"
#include "runtime/component_check.hpp"
#include "runtime/conductor_side.hpp"
#include "runtime/config_hash.hpp"
#include "runtime/numeric_profile.hpp"
#include "runtime/version.hpp"

namespace constrictor {
namespace {

constexpr auto kMatchCheckInterval = std::chrono::milliseconds(10);
constexpr auto kHelloInterval = std::chrono::seconds(1);

}  // namespace

MemberSide::MemberSide(HostContext& context, Links& links, std::vector<ComponentFactory> factories)
    : context_(context), links_(links) {
  const HostOptions& options = context.options;
  const bool conducts = std::any_of(factories.begin(), factories.end(),
                                    [&](const ComponentFactory& factory) { return factory.name == options.plant; });
  members_.reserve(factories.size());
  for (auto& factory : factories) {
    Setup setup = options.setup;
    const auto config = options.config_files.find(factory.name);
    if (config != options.config_files.end()) setup.config_file = config->second;
    const auto latency = options.latency_ticks.find(factory.name);
    if (latency != options.latency_ticks.end()) setup.latency_ticks = latency->second;
    const bool checkpoints = !conducts || (options.checkpoints && !options.setup.output_dir.empty());
    setup.log = context.log.about(factory.name);
    auto member = std::make_unique<Member>(std::move(factory), std::move(setup), options.incarnation, checkpoints,
                                           static_cast<MemberSink&>(*this));
    if (member->name() == options.plant) plant_ = member.get();
    const std::string config_hash = component_config_hash(member->setup().config_file, member->setup().scenario_file);
    members_.push_back({std::move(member), {}, {}, false, config_hash, nullptr});
  }
  if (plant_ && !dynamic_cast<Plant*>(&plant_->component())) {
    throw std::runtime_error(fmt::format("--plant: found '{}', accepted a component that is a plant", options.plant));
  }
  // Before the first message: a plant that takes part in no tick touches no device.
  if (plant_) {
    if (const std::string why = pace_violation(options, plant_->component()); !why.empty())
      throw ConfigurationError(why);
  }
  make_endpoints();
  make_threads();
}

MemberSide::~MemberSide() = default;

void MemberSide::make_threads() {
  // The conductor waits for the outputs of a step when they become visible. If that is not at the next tick, the other
  // members of the process can go on, as if the slow one were in another process.
  if (members_.size() == 1) return;
  for (auto& local : members_) {
    if (local.member->timing().latency > 1) local.thread = std::make_unique<StepThread>([this] { links_.wake(); });
  }
}

void MemberSide::connect(ConductorSide& conductor) { conductor_ = &conductor; }

bool MemberSide::hosts(const std::string& component) const {
  return std::any_of(members_.begin(), members_.end(),
                     [&](const LocalMember& local) { return local.member->name() == component; });
}

Hello MemberSide::hello_of(const LocalMember& local) const {
  const Member& member = *local.member;
  Hello hello;
  hello.component = member.name();
  hello.run_id = context_.options.run_id;
  hello.incarnation = member.incarnation();
  hello.pid = ::getpid();
  hello.host = context_.host_name;
  hello.release = kVersion;
  hello.idl_hash = std::string(msg::kIdlHash);
  hello.config_hash = context_.config_hash;
  hello.component_hash = context_.options.replace ? replacing(local.config_hash) : local.config_hash;
  hello.numeric_profile = numeric_profile();
  hello.timing = member.timing();
  hello.reads = member.reads();
  hello.writes = member.writes();
  const std::string& token = context_.options.token;
  if (!token.empty()) hello.proof = hello_proof(token, hello, dds::own_prefix(links_.participant()));
  return hello;
}

void MemberSide::send_hello() {
  last_hello_ = HostContext::Clock::now();
  for (const auto& local : members_) {
    const Hello hello = hello_of(local);
    hello_writer_.write(to_wire(hello));
    if (conductor_) conductor_->on_hello(hello);
  }
}

void MemberSide::repeat_hello() {
  if (conductor_ || context_.options.incarnation == 1) return;
  const auto now = HostContext::Clock::now();
  if (now - last_hello_ < kHelloInterval) return;
  last_hello_ = now;
  for (const auto& local : members_) {
    if (!local.member->in_epoch()) hello_writer_.write(to_wire(hello_of(local)));
  }
}

void MemberSide::on_epoch(const EpochId& epoch, std::uint64_t seed) {
  for (auto& local : members_) {
    // The successor of a conductor announces the present epoch again.
    if (local.member->in_epoch() && local.member->epoch() == epoch) continue;
    const bool stepping = local.member->stepping();
    if (stepping) local.thread->wait();
    context_.log.at(epoch.run_id, epoch.epoch, -1);
    local.member->on_epoch(epoch, seed);
    // The step of the previous epoch has been dropped. An epoch that is known already changes nothing.
    if (stepping && !local.member->stepping()) local.thread->collect();
    local.ready_sent = false;
    local.jitter.begin();
  }
}

void MemberSide::on_pause() {
  for (auto& local : members_) local.jitter.interrupt();
}

bool MemberSide::on_resume(const Resume& resume) {
  if (!hosts(resume.component)) return false;
  for (auto& local : members_) {
    if (local.member->name() == resume.component && local.member->incarnation() == resume.incarnation)
      local.member->on_resume(resume);
  }
  return true;
}

void MemberSide::on_tick(const msg::Tick& tick) {
  context_.log.at(tick.run_id, tick.epoch, tick.index);
  for (auto& local : members_) {
    local.member->on_tick(tick);
    if (tick.realtime) local.jitter.arrived(HostContext::Clock::now(), tick.time_ns);
  }
}

void MemberSide::send_ready() {
  // Each member sends its own Ready, because after a restart the members of a process are resumed one by one.
  const auto owes = [](const LocalMember& local) { return local.member->in_epoch() && !local.ready_sent; };
  if (std::none_of(members_.begin(), members_.end(), owes)) return;
  const auto now = HostContext::Clock::now();
  if (now - last_match_check_ < kMatchCheckInterval) return;
  last_match_check_ = now;
  std::map<std::size_t, std::vector<std::string>> readers_of;
  TopicSet unwritten;  // a plant of your own need not write every topic of the table
  for (const auto& name : context_.options.roster) {
    if (hosts(name)) continue;
    const auto hello = hellos_.find(name);
    if (hello == hellos_.end()) return;  // the member's topics are not known before its Hello
    for (const auto& topic : topics::kInfos) {
      if (hello->second.reads.contains(topic.id)) readers_of[topic.id].push_back(name);
      if (writer_in_run(topic, context_.options.plant) == name && !hello->second.writes.contains(topic.id))
        unwritten.insert(topic.id);
    }
  }
  unmatched_ = bus_->unmatched(readers_of, unwritten, context_.options.plant);
  if (!unmatched_.empty()) return;
  for (auto& local : members_) {
    if (!owes(local)) continue;
    const Member& member = *local.member;
    local.ready_sent = true;
    if (conductor_) {
      conductor_->on_ready(member);
      continue;
    }
    msg::Ready ready{};
    dds::set_text(ready.component, member.name());
    ready.run_id = member.epoch().run_id;
    ready.epoch = member.epoch().epoch;
    ready.incarnation = member.incarnation();
    ready_writer_.write(ready);
  }
}

bool MemberSide::step() {
  bool any = false;
  // Threads first, so that they have something to do while this thread steps the other members.
  for (auto& local : members_) {
    if (local.thread) any |= step_in_thread(local);
  }
  for (auto& local : members_) {
    if (local.thread) continue;
    for (;;) {
      const auto start = HostContext::Clock::now();
      if (!local.member->begin_step()) break;
      local.member->run_step();
      finish_step(*local.member);
      note_step(local, HostContext::Clock::now() - start);
      any = true;
    }
  }
  return any;
}

bool MemberSide::step_in_thread(LocalMember& local) {
  Member& member = *local.member;
  const bool finished = member.stepping() && local.thread->finished();
  if (finished) {
    const auto duration = local.thread->collect();
    finish_step(member);
    note_step(local, duration);
  }
  if (member.begin_step()) local.thread->start([&member] { member.run_step(); });
  return finished;
}

void MemberSide::finish_step(Member& member) {
  // The outputs and the TickDone. The others use the outputs at the next tick.
  const dds::GatheredSends gathered(dds::GatheredSends::Receivers::kMayWait);
  member.finish_step();
}

void MemberSide::note_step(LocalMember& local, std::chrono::nanoseconds duration) {
  local.meter.add(duration);
  if (local.meter.due(local.member->last_done())) publish_status(local, msg::kComponentRunning);
}

bool MemberSide::stepping() const {
  return std::any_of(members_.begin(), members_.end(), [](const auto& local) { return local.member->stepping(); });
}

bool MemberSide::all_ended() const {
  return std::all_of(members_.begin(), members_.end(), [](const auto& local) { return local.member->ended(); });
}

void MemberSide::conclude_anyway() {
  for (auto& local : members_) {
    if (!local.member->concluding() || local.member->stepping()) continue;
    const MissingInput missing = local.member->missing();
    context_.log.warning("{} ends after its step in tick {}, without the last samples of {}: they have not arrived",
                         local.member->name(), local.member->last_done(),
                         missing.topic ? missing.topic->name : "an input");
    local.member->conclude_anyway();
  }
}

bool MemberSide::plant_lives() const {
  return plant_ || (!new_run_ && links_.admission().lives(context_.options.plant));
}

bool MemberSide::want_inputs() const {
  return std::any_of(members_.begin(), members_.end(), [](const auto& local) {
    return !local.ready_sent || local.member->has_due_tick() || local.member->concluding();
  });
}

bool MemberSide::all_ready() const {
  return std::all_of(members_.begin(), members_.end(), [](const auto& local) { return local.ready_sent; });
}

bool MemberSide::have_short_steps() const {
  return std::all_of(members_.begin(), members_.end(),
                     [](const auto& local) { return !local.thread && local.member->component().has_short_steps(); });
}

void MemberSide::publish(const TopicInfo& topic, const Sample& sample) {
  for (auto& local : members_) {
    if (local.member->reads().contains(topic.id)) local.member->on_sample(topic.id, sample);
  }
  if (conductor_) conductor_->note_authority(topic, sample);
  bus_->write(topic, sample);
  if (conductor_) conductor_->record(topic, sample);
}

void MemberSide::done(const TickDone& step) {
  if (conductor_) return conductor_->on_done(step);
  dds::GatheredSends::wake_receivers();
  done_writer_.write(to_wire(step, checkpoint_block_));
}

}  // namespace constrictor
