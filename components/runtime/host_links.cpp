// What a process's members say and hear over DDS, and how the conductor's words go out.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <random>

#include "constrictor/reflect.hpp"
#include "runtime/host_impl.hpp"
#include "runtime/numeric_profile.hpp"
#include "runtime/version.hpp"

namespace constrictor {
namespace {

namespace wire = dds::barrier_topics;

std::string host_name() {
  char name[64] = {};
  ::gethostname(name, sizeof(name) - 1);
  return name;
}

}  // namespace

void Host::Impl::make_endpoints() {
  const dds_entity_t participant = domain_.participant();
  std::uint64_t reads = 0;
  std::uint64_t writes = 0;
  for (const auto& local : members_) {
    reads |= local.member->reads();
    writes |= local.member->writes();
  }
  for (const auto& topic : topics::kInfos) {
    const std::string writer(topic.writer);
    const bool in_roster = std::count(options_.roster.begin(), options_.roster.end(), writer) > 0;
    if (here(writer) || !in_roster) reads &= ~(std::uint64_t{1} << topic.id);
  }
  bus_ = std::make_unique<dds::MemberBus>(participant, reads, writes, identity_);
  hello_writer_ = {participant, wire::kHello, 1};
  waiting_writer_ = {participant, wire::kWaiting, 4};
  status_writer_ = {participant, wire::kStatus, 1};
  refused_reader_ = dds::Reader<msg::Refused>::member(participant, wire::kRefused);
  hello_reader_ = dds::Reader<msg::Hello>::member(participant, wire::kHello);
  if (plant_) {
    tick_writer_ = {participant, wire::kTick, wire::kTickDepth};
    epoch_writer_ = {participant, wire::kEpochStart, 1};
    resume_writer_ = {participant, wire::kResume, 1};
    refused_writer_ = {participant, wire::kRefused, 8};
    done_reader_ = dds::Reader<msg::TickDone>::member(participant, wire::kTickDone);
    ready_reader_ = dds::Reader<msg::Ready>::member(participant, wire::kReady);
    control_reader_ = dds::Reader<msg::RunControl>::member(participant, wire::kRunControl);
    run_state_writer_ = {participant, wire::kRunState, 1};
  } else {
    done_writer_ = {participant, wire::kTickDone, 4};
    ready_writer_ = {participant, wire::kReady, 1};
    tick_reader_ = dds::Reader<msg::Tick>::member(participant, wire::kTick);
    epoch_reader_ = dds::Reader<msg::EpochStart>::member(participant, wire::kEpochStart);
    resume_reader_ = dds::Reader<msg::Resume>::member(participant, wire::kResume);
    run_state_reader_ = dds::Reader<msg::RunState>::member(participant, wire::kRunState);
  }
  wait_set_ = dds::Entity(dds_create_waitset(participant), "dds_create_waitset");
  const auto attach = [&](dds_entity_t reader, std::function<void()> taker) {
    if (reader <= 0) return;
    dds::check(dds_set_status_mask(reader, DDS_DATA_AVAILABLE_STATUS), "dds_set_status_mask");
    dds::check(dds_waitset_attach(wait_set_.get(), reader, static_cast<dds_attach_t>(takers_.size())), "dds_waitset_attach");
    takers_.push_back(std::move(taker));
  };
  const auto each = [this](auto&& use) {
    for (auto& local : members_) use(*local.member);
  };
  attach(epoch_reader_.get(), [this, each] {
    epoch_reader_.take([&](const msg::EpochStart& start) {
      if (!acceptable(wire::kEpochStart, start)) return;
      // The first run that is heard is the one taken part in: it must be ours.
      if (!of_our_run(wire::kEpochStart, start.run_id)) return;
      if (start.config_hash != config_hash_) {
        return refuse_message(wire::kEpochStart, fmt::format("config_hash: found '{}', accepted {}", start.config_hash, config_hash_));
      }
      each([&](Member& member) { member.on_epoch({start.run_id, start.epoch}, start.seed); });
      for (auto& local : members_) local.ready_said = false;
    });
  });
  attach(resume_reader_.get(), [this, each] {
    resume_reader_.take([&](const msg::Resume& message) {
      if (!acceptable(wire::kResume, message)) return;
      if (!of_our_run(wire::kResume, message.run_id)) return;
      each([&](Member& member) {
        if (member.name() != message.component || member.incarnation() != message.incarnation || member.in_epoch()) return;
        if (const auto resumption = dds::from_wire(message)) return member.on_resume(*resumption);
        member.refuse("resume.checkpoint: damaged");
      });
    });
  });
  attach(tick_reader_.get(), [this, each] {
    tick_reader_.take([&](const msg::Tick& message) {
      if (!acceptable(wire::kTick, message)) return;
      each([&](Member& member) {
        const std::int64_t newest = member.newest_tick();
        member.on_tick(message);
        if (member.newest_tick() > newest) last_progress_ = SteadyClock::now();  // the run goes on, whoever is due
      });
    });
  });
  attach(refused_reader_.get(), [this] {
    refused_reader_.take([&](const msg::Refused& message) {
      if (!acceptable(wire::kRefused, message)) return;
      if (message.pid != ::getpid() || message.host != host_name() || message.incarnation != options_.incarnation || !here(message.component)) return;
      if (!of_our_run(wire::kRefused, message.run_id)) return;
      std::fprintf(stderr, "%s: the run refuses this process: %s\n", message.component, message.reason);
      exit_status_ = exit_status::kRefused;
    });
  });
  attach(hello_reader_.get(), [this] { hello_reader_.take([this](const msg::Hello& message) { take_hello(message); }); });
  attach(done_reader_.get(), [this] {
    done_reader_.take([this](const msg::TickDone& message) { take_done(message); });
  });
  attach(ready_reader_.get(), [this] {
    ready_reader_.take([this](const msg::Ready& message) {
      const EpochId epoch{message.run_id, message.epoch};
      if (!acceptable(wire::kReady, message)) return;
      if (const auto why = conductor_->stranger(message.component, epoch, message.incarnation)) return refuse_message(wire::kReady, *why);
      conductor_->on_ready(message.component, epoch, message.incarnation);
    });
  });
  attach(run_state_reader_.get(), [this, each] {
    run_state_reader_.take([&](const msg::RunState& state) {
      if (!acceptable(wire::kRunState, state) || (!state.paused && !state.held)) return;
      // Said once a second as long as the conductor lives: the run stands still, but is not stuck.
      each([&](const Member& member) {
        if (member.in_epoch() && member.epoch() == EpochId{state.run_id, state.epoch}) last_progress_ = SteadyClock::now();
      });
    });
  });
  attach(control_reader_.get(), [this] { control_reader_.take([this](const msg::RunControl& c) { take_control(c); }); });
  for (auto& local : members_) {
    if (!local.member->outside()) continue;
    outside_link_ = std::make_unique<dds::OutsideLink>(participant, options_.setup.robot_id);
    outside_link_->watch(*local.member->outside());
    attach(outside_link_->get(), [this, &member = *local.member] {
      outside_link_->take(*member.outside(), [&](const std::string& reason) { member.refuse(reason); });
    });
  }
  for (const auto& [topic_id, reader] : bus_->readers()) {
    attach(reader, [this, each, id = topic_id] {
      bus_->take(id, [&](const Sample& sample) {
        note_authority(topics::kInfos[id], sample);
        each([&](Member& member) {
          if (member.reads() >> id & 1) member.on_sample(id, sample);
        });
      });
    });
  }
}

void Host::Impl::make_conductor() {
  ConductorOptions conductor;
  std::random_device entropy;  // names the run; nothing computed depends on it
  conductor.run_id = options_.run_id != 0 ? options_.run_id : (static_cast<std::uint64_t>(entropy()) << 32 | entropy()) | 1;
  conductor.roster = options_.roster;
  conductor.plant = options_.plant;
  conductor.idl_hash = std::string(msg::kIdlHash);
  conductor.config_hash = config_hash_;
  conductor.numeric_profile = numeric_profile();
  conductor.seed = options_.setup.seed;
  conductor.realtime = options_.realtime;
  conductor.period_ns = static_cast<Plant&>(plant_->component()).period_ns();
  if (options_.max_sim_time_s > 0) {
    conductor.last_index = std::llround(options_.max_sim_time_s * 1e9 / static_cast<double>(conductor.period_ns));
  }
  if (options_.hash_log && !options_.setup.output_dir.empty()) {
    hash_log_ = std::make_unique<HashLog>(options_.setup.output_dir, options_.record);
  }
  conductor_ = std::make_unique<Conductor>(conductor, static_cast<ConductorSink&>(*this));
}

std::uint64_t Host::Impl::run_id() const {
  if (options_.run_id != 0) return options_.run_id;
  if (conductor_ && conductor_->epoch()) return conductor_->run_id();
  const auto begun = std::find_if(members_.begin(), members_.end(), [](const LocalMember& local) { return local.member->in_epoch(); });
  return begun == members_.end() ? 0 : begun->member->epoch().run_id;
}

bool Host::Impl::of_our_run(const char* topic, std::uint64_t named) {
  const std::uint64_t ours = run_id();
  if (ours == 0 || named == ours) return true;
  refuse_message(topic, "run_id: of another run");
  return false;
}

void Host::Impl::refuse_message(const std::string& topic, const std::string& reason) {
  (plant_ ? plant_ : members_.front().member.get())->refuse(topic + "." + reason);
}

template <class T>
bool Host::Impl::acceptable(const char* topic, const T& message) {
  const auto violation = validate(message);
  if (violation) refuse_message(topic, *violation);
  return !violation;
}

void Host::Impl::take_done(const msg::TickDone& message) {
  if (!acceptable(wire::kTickDone, message)) return;
  const auto refuse = [this](const std::string& reason) { refuse_message(wire::kTickDone, reason); };
  if (const auto why = conductor_->stranger(message.component, {message.run_id, message.epoch}, message.incarnation)) return refuse(*why);
  const auto step = dds::from_wire(message);
  if (!step) return refuse("checkpoint: damaged");
  if (const auto why = conductor_->implausible(*step)) return refuse(*why);
  if (!conductor_->on_done(*step)) return;
  last_progress_ = SteadyClock::now();
  if (!hash_log_) return;
  for (const auto& written : step->written) hash_log_->add(written.topic, written.bytes);
}

Greeting Host::Impl::greeting_of(const LocalMember& local) const {
  const Member& member = *local.member;
  Greeting greeting;
  greeting.component = member.name();
  greeting.run_id = options_.run_id;
  greeting.incarnation = member.incarnation();
  greeting.pid = ::getpid();
  greeting.host = host_name();
  greeting.idl_hash = std::string(msg::kIdlHash);
  greeting.config_hash = config_hash_;
  greeting.component_hash = local.config_hash;
  greeting.numeric_profile = numeric_profile();
  greeting.timing = member.timing();
  greeting.reads = member.reads();
  greeting.writes = member.writes();
  return greeting;
}

void Host::Impl::greet() {
  for (const auto& local : members_) {
    const Greeting greeting = greeting_of(local);
    hello_writer_.write(dds::to_wire(greeting, kVersion));
    if (conductor_) conductor_->on_greeting(greeting);
  }
}

void Host::Impl::take_hello(const msg::Hello& message) {
  if (!acceptable(wire::kHello, message)) return;
  const Greeting greeting = dds::from_wire(message);
  if (greeting.run_id != 0 && !of_our_run(wire::kHello, greeting.run_id)) return;
  // What is of another run replaces nobody and is waited for by nobody; the conductor tells it so.
  const bool ours = !difference(greeting, greeting_of(members_.front()));
  if (here(greeting.component)) {
    if (greeting.pid == ::getpid() && greeting.host == host_name()) return;  // our own
    if (!conductor_ && ours && greeting.incarnation > options_.incarnation) {
      std::fprintf(stderr, "%s: replaced by incarnation %u (pid %d on %s)\n", greeting.component.c_str(),
                   greeting.incarnation, greeting.pid, greeting.host.c_str());
      exit_status_ = exit_status::kRefused;
      return;
    }
  } else if (ours && std::count(options_.roster.begin(), options_.roster.end(), greeting.component) > 0) {
    greetings_[greeting.component] = greeting;
  }
  if (conductor_) conductor_->on_greeting(greeting);
}

void Host::Impl::publish(const TopicInfo& topic, const Sample& sample) {
  for (auto& local : members_) {
    if (local.member->reads() >> topic.id & 1) local.member->on_sample(topic.id, sample);
  }
  note_authority(topic, sample);
  bus_->write(topic, sample);
  if (hash_log_ && conductor_) hash_log_->add(topic, sample);
}

void Host::Impl::done(const StepDone& step) {
  if (conductor_) {
    conductor_->on_done(step);
    return;
  }
  std::string block;
  done_writer_.write(dds::to_wire(step, block));
}

void Host::Impl::start_epoch(const EpochId& epoch, std::uint64_t seed) {
  msg::EpochStart start{};
  start.run_id = epoch.run_id;
  start.epoch = epoch.epoch;
  start.seed = seed;
  dds::set_text(start.scenario, options_.setup.scenario_file.filename().string());
  dds::set_text(start.config_hash, config_hash_);
  epoch_writer_.write(start);
  for (auto& local : members_) {
    local.ready_said = false;
    local.member->on_epoch(epoch, seed);
  }
  pacer_.restart();
  pacer_.operator_holds(false);
  if (hash_log_) hash_log_->restart();
}

void Host::Impl::tick(const msg::Tick& message) {
  tick_writer_.write(message);
  for (auto& local : members_) local.member->on_tick(message);
}

void Host::Impl::resume(const Resumption& resumption) {
  std::string block;
  resume_writer_.write(dds::to_wire(resumption, block));
}

void Host::Impl::refuse(const Greeting& greeting, const std::string& reason) {
  std::fprintf(stderr, "%s (pid %d on %s) refused: %s\n", greeting.component.c_str(), greeting.pid, greeting.host.c_str(),
               reason.c_str());
  msg::Refused message{};
  dds::set_text(message.component, greeting.component);
  message.run_id = conductor_->run_id();
  message.incarnation = greeting.incarnation;
  message.pid = greeting.pid;
  dds::set_text(message.host, greeting.host);
  dds::set_text(message.reason, reason);
  refused_writer_.write(message);
}

void Host::Impl::say_ready() {
  // Each for itself: after a restart the members of one process are resumed one by one, perhaps far apart.
  const auto owes = [](const LocalMember& local) { return local.member->in_epoch() && !local.ready_said; };
  if (std::none_of(members_.begin(), members_.end(), owes)) return;
  const auto now = SteadyClock::now();
  if (now - last_match_check_ < std::chrono::milliseconds(10)) return;
  last_match_check_ = now;
  std::map<std::size_t, std::vector<std::string>> readers_of;
  for (const auto& name : options_.roster) {
    if (here(name)) continue;
    const auto greeting = greetings_.find(name);
    if (greeting == greetings_.end()) return;  // not heard of yet
    for (const auto& topic : topics::kInfos) {
      if (greeting->second.reads >> topic.id & 1) readers_of[topic.id].push_back(name);
    }
  }
  unmatched_ = bus_->unmatched(readers_of);
  if (!unmatched_.empty()) return;
  for (auto& local : members_) {
    if (!owes(local)) continue;
    const Member& member = *local.member;
    local.ready_said = true;
    if (conductor_) {
      conductor_->on_ready(member.name(), member.epoch(), member.incarnation());
    } else {
      msg::Ready ready{};
      dds::set_text(ready.component, member.name());
      ready.run_id = member.epoch().run_id;
      ready.epoch = member.epoch().epoch;
      ready.incarnation = member.incarnation();
      ready_writer_.write(ready);
    }
  }
}

}  // namespace constrictor
