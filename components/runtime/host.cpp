#include "runtime/host.hpp"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <random>
#include <set>

#include "constrictor/reflect.hpp"
#include "runtime/barrier/conductor.hpp"
#include "runtime/barrier/member.hpp"
#include "runtime/config_hash.hpp"
#include "runtime/dds/domain.hpp"
#include "runtime/dds/member_bus.hpp"
#include "runtime/dds/wire.hpp"
#include "runtime/hash_log.hpp"
#include "runtime/numeric_profile.hpp"
#include "runtime/pacer.hpp"
#include "runtime/status_meter.hpp"
#include "runtime/version.hpp"

namespace constrictor {
namespace {

namespace wire = dds::barrier_topics;
using SteadyClock = std::chrono::steady_clock;

volatile std::sig_atomic_t g_stop = 0;
void on_signal(int) { g_stop = 1; }

std::string join(const std::vector<std::string>& names) { return fmt::format("{}", fmt::join(names, ",")); }

std::string host_name() {
  char name[64] = {};
  ::gethostname(name, sizeof(name) - 1);
  return name;
}

}  // namespace

class Host::Impl : private MemberSink, private ConductorSink {
 public:
  Impl(HostOptions options, std::vector<ComponentFactory> factories);
  int run();

 private:
  struct LocalMember {
    std::unique_ptr<Member> member;
    StatusMeter meter;
    bool ready_said = false;
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
  [[nodiscard]] Greeting greeting_of(const Member& member) const;
  [[nodiscard]] bool here(const std::string& component) const;
  void take(std::size_t reader);
  void take_hello(const msg::Hello& message);
  void take_control(const msg::RunControl& control);
  void say_ready();
  bool conduct();
  bool step_members();
  void watch();
  void report_waiting(const std::string& component, const std::string& what, const std::string& whom, std::int64_t tick,
                      std::uint64_t have, std::uint64_t want);
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
  dds::Writer<msg::Tick> tick_writer_;
  dds::Writer<msg::EpochStart> epoch_writer_;
  dds::Writer<msg::Resume> resume_writer_;
  dds::Writer<msg::Refused> refused_writer_;
  dds::Writer<msg::Hello> hello_writer_;
  dds::Writer<msg::TickDone> done_writer_;
  dds::Writer<msg::Ready> ready_writer_;
  dds::Writer<msg::Waiting> waiting_writer_;
  dds::Writer<msg::ComponentStatus> status_writer_;
  dds::Entity wait_set_;
  std::vector<std::function<void()>> takers_;  ///< by index attached to the wait set

  std::map<std::string, Greeting> greetings_;  ///< of members elsewhere
  std::map<std::string, std::uint64_t> control_sequences_;
  Pacer pacer_;
  SteadyClock::time_point last_progress_ = SteadyClock::now();
  SteadyClock::time_point last_waiting_report_ = SteadyClock::now();
  SteadyClock::time_point last_match_check_{};
  std::string unmatched_;
  int exit_status_ = -1;
};

Host::Impl::Impl(HostOptions options, std::vector<ComponentFactory> factories)
    : options_(std::move(options)), domain_(options_.domain), pacer_(options_.realtime ? 1.0 : options_.pace) {
  std::vector<std::string> names;
  for (const auto& factory : factories) names.push_back(factory.name);
  identity_ = join(names);
  const bool conducts = here(options_.plant) || std::count(names.begin(), names.end(), options_.plant) > 0;
  config_hash_ = run_config_hash(options_.setup.robot_file, options_.roster, options_.plant);
  members_.reserve(factories.size());
  for (auto& factory : factories) {
    Setup setup = options_.setup;
    const auto config = options_.config_files.find(factory.name);
    if (config != options_.config_files.end()) setup.config_file = config->second;
    const bool checkpoints = !conducts || options_.record;
    members_.push_back({std::make_unique<Member>(std::move(factory), std::move(setup), options_.incarnation, checkpoints,
                                                 static_cast<MemberSink&>(*this)),
                        {}, false});
    if (members_.back().member->name() == options_.plant) plant_ = members_.back().member.get();
  }
  if (plant_ && !dynamic_cast<Plant*>(&plant_->component())) {
    throw std::runtime_error(options_.plant + " is named as the plant but is not one");
  }
  make_endpoints();
  if (plant_) make_conductor();
}

bool Host::Impl::here(const std::string& component) const {
  return std::any_of(members_.begin(), members_.end(),
                     [&](const LocalMember& local) { return local.member->name() == component; });
}

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
  } else {
    done_writer_ = {participant, wire::kTickDone, 4};
    ready_writer_ = {participant, wire::kReady, 1};
    tick_reader_ = dds::Reader<msg::Tick>::member(participant, wire::kTick);
    epoch_reader_ = dds::Reader<msg::EpochStart>::member(participant, wire::kEpochStart);
    resume_reader_ = dds::Reader<msg::Resume>::member(participant, wire::kResume);
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
      each([&](Member& member) { member.on_epoch({start.run_id, start.epoch}, start.seed); });
      for (auto& local : members_) local.ready_said = false;
    });
  });
  attach(resume_reader_.get(), [this, each] {
    resume_reader_.take([&](const msg::Resume& message) {
      each([&](Member& member) {
        if (member.name() == message.component && member.incarnation() == message.incarnation) {
          member.on_resume(dds::from_wire(message));
        }
      });
    });
  });
  attach(tick_reader_.get(), [this, each] {
    tick_reader_.take([&](const msg::Tick& message) { each([&](Member& member) { member.on_tick(message); }); });
  });
  attach(refused_reader_.get(), [this] {
    refused_reader_.take([&](const msg::Refused& message) {
      if (message.pid != ::getpid() || !here(message.component)) return;
      std::fprintf(stderr, "%s: the run refuses this process: %s\n", message.component, message.reason);
      exit_status_ = exit_status::kRefused;
    });
  });
  attach(hello_reader_.get(), [this] { hello_reader_.take([this](const msg::Hello& message) { take_hello(message); }); });
  attach(done_reader_.get(), [this] {
    done_reader_.take([this](const msg::TickDone& message) {
      const StepDone step = dds::from_wire(message);
      if (!conductor_->on_done(step)) return;
      last_progress_ = SteadyClock::now();
      if (!hash_log_) return;
      for (const auto& written : step.written) hash_log_->add(written.topic, written.bytes);
    });
  });
  attach(ready_reader_.get(), [this] {
    ready_reader_.take([this](const msg::Ready& message) {
      conductor_->on_ready(message.component, {message.run_id, message.epoch}, message.incarnation);
    });
  });
  attach(control_reader_.get(), [this] { control_reader_.take([this](const msg::RunControl& c) { take_control(c); }); });
  for (const auto& [topic_id, reader] : bus_->readers()) {
    attach(reader, [this, each, id = topic_id] {
      bus_->take(id, [&](const Sample& sample) {
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
  conductor.run_id = (static_cast<std::uint64_t>(entropy()) << 32 | entropy()) | 1;
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

Greeting Host::Impl::greeting_of(const Member& member) const {
  Greeting greeting;
  greeting.component = member.name();
  greeting.incarnation = member.incarnation();
  greeting.pid = ::getpid();
  greeting.host = host_name();
  greeting.idl_hash = std::string(msg::kIdlHash);
  greeting.config_hash = config_hash_;
  greeting.numeric_profile = numeric_profile();
  greeting.timing = member.timing();
  greeting.reads = member.reads();
  greeting.writes = member.writes();
  return greeting;
}

void Host::Impl::greet() {
  for (const auto& local : members_) {
    const Greeting greeting = greeting_of(*local.member);
    hello_writer_.write(dds::to_wire(greeting, kVersion));
    if (conductor_) conductor_->on_greeting(greeting);
  }
}

void Host::Impl::take_hello(const msg::Hello& message) {
  if (const auto violation = validate(message)) return;
  const Greeting greeting = dds::from_wire(message);
  if (here(greeting.component)) {
    if (greeting.pid == ::getpid() && greeting.host == host_name()) return;  // our own
    if (!conductor_ && greeting.incarnation > options_.incarnation) {
      std::fprintf(stderr, "%s: replaced by incarnation %u (pid %d on %s)\n", greeting.component.c_str(),
                   greeting.incarnation, greeting.pid, greeting.host.c_str());
      exit_status_ = exit_status::kRefused;
      return;
    }
  } else {
    greetings_[greeting.component] = greeting;
  }
  if (conductor_) conductor_->on_greeting(greeting);
}

void Host::Impl::take_control(const msg::RunControl& control) {
  if (const auto violation = validate(control)) {
    std::fprintf(stderr, "run_control from %s refused: %s\n", control.source, violation->c_str());
    return;
  }
  std::uint64_t& sequence = control_sequences_[control.source];
  if (control.sequence_number <= sequence) return;
  sequence = control.sequence_number;
  switch (control.command) {
    case msg::kRunReset: conductor_->reset(control.seed); break;
    case msg::kRunEnd: conductor_->end_run(); break;
    default: pacer_.control(control.command, control.pace); break;
  }
}

void Host::Impl::publish(const TopicInfo& topic, const Sample& sample) {
  for (auto& local : members_) {
    if (local.member->reads() >> topic.id & 1) local.member->on_sample(topic.id, sample);
  }
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
  message.incarnation = greeting.incarnation;
  message.pid = greeting.pid;
  dds::set_text(message.reason, reason);
  refused_writer_.write(message);
}

void Host::Impl::say_ready() {
  if (std::all_of(members_.begin(), members_.end(), [](const auto& local) { return local.ready_said; })) return;
  if (!members_.front().member->in_epoch()) return;
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
    const Member& member = *local.member;
    local.ready_said = true;
    if (conductor_) {
      conductor_->on_ready(member.name(), *conductor_->epoch(), member.incarnation());
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

bool Host::Impl::conduct() {
  if (!conductor_ || !conductor_->may_tick() || !pacer_.may_tick(conductor_->next_time_ns())) return false;
  const std::int64_t period = static_cast<Plant&>(plant_->component()).period_ns();
  plant_->sample_plant(conductor_->next_index(), conductor_->next_time_ns(), period);
  conductor_->tick(plant_->published());
  pacer_.ticked();
  return true;
}

bool Host::Impl::step_members() {
  bool any = false;
  for (auto& local : members_) {
    for (;;) {
      const auto start = SteadyClock::now();
      if (!local.member->try_step()) break;
      local.meter.add(SteadyClock::now() - start);
      any = true;
      if (local.meter.due(local.member->last_done())) publish_status(local, msg::kComponentRunning);
    }
  }
  return any;
}

void Host::Impl::publish_status(LocalMember& local, std::uint8_t state) {
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
  status.overruns = member.counters().skipped;
  status.refused = member.counters().refused;
  dds::set_text(status.last_refusal, member.counters().last_refusal);
  dds::set_text(status.version, kVersion);
  dds::set_text(status.idl_hash, std::string(msg::kIdlHash));
  status.pid = ::getpid();
  dds::set_text(status.host, host_name());
  status_writer_.write(status);
}

void Host::Impl::report_waiting(const std::string& component, const std::string& what, const std::string& whom,
                                std::int64_t tick, std::uint64_t have, std::uint64_t want) {
  const double waited = std::chrono::duration<double>(SteadyClock::now() - last_progress_).count();
  std::fprintf(stderr, "%s waits for %s of %s at tick %lld (has %llu, needs %llu) for %.0f s\n", component.c_str(),
               what.c_str(), whom.c_str(), static_cast<long long>(tick), static_cast<unsigned long long>(have),
               static_cast<unsigned long long>(want), waited);
  msg::Waiting message{};
  dds::set_text(message.component, component);
  message.tick = tick;
  dds::set_text(message.topic, what);
  dds::set_text(message.writer, whom);
  message.have = have;
  message.want = want;
  message.waited_s = waited;
  waiting_writer_.write(message);
}

void Host::Impl::watch() {
  const auto now = SteadyClock::now();
  if (pacer_.holding()) last_progress_ = now;
  const double waited = std::chrono::duration<double>(now - last_progress_).count();
  if (waited < 2.0 || now - last_waiting_report_ < std::chrono::seconds(1)) return;
  last_waiting_report_ = now;
  const std::int64_t next = conductor_ ? conductor_->next_index() : members_.front().member->newest_tick() + 1;
  if (!unmatched_.empty()) std::fprintf(stderr, "%s: %s\n", identity_.c_str(), unmatched_.c_str());
  if (conductor_) {
    for (const auto& owed : conductor_->owed()) {
      report_waiting(options_.plant, owed.what, owed.component, next, static_cast<std::uint64_t>(std::max<std::int64_t>(owed.have, 0)),
                     static_cast<std::uint64_t>(owed.want));
    }
  }
  for (auto& local : members_) {
    const MissingInput missing = local.member->missing();
    if (missing.topic) {
      report_waiting(local.member->name(), std::string(missing.topic->name), std::string(missing.topic->writer), missing.tick,
                     missing.have, missing.want);
    } else if (!conductor_) {
      report_waiting(local.member->name(), local.member->in_epoch() ? "Tick" : "EpochStart", options_.plant, missing.tick, 0, 1);
    }
    publish_status(local, msg::kComponentWaiting);
  }
  if (options_.patience_s > 0 && waited > options_.patience_s) {
    std::fprintf(stderr, "%s: gave up after %.0f s of waiting\n", identity_.c_str(), waited);
    exit_status_ = exit_status::kWaitedTooLong;
  }
}

void Host::Impl::finish() {
  for (auto& local : members_) publish_status(local, msg::kComponentEnded);
  // The final tick must reach everybody before its writer goes; bounded, since a stopped process must not hold the end up.
  if (conductor_ && exit_status_ == exit_status::kOk) dds_wait_for_acks(tick_writer_.get(), DDS_SECS(2));
  if (hash_log_) hash_log_->close();
}

int Host::Impl::run() {
  struct sigaction action {};
  action.sa_handler = on_signal;
  ::sigaction(SIGTERM, &action, nullptr);
  ::sigaction(SIGINT, &action, nullptr);
  greet();
  std::vector<dds_attach_t> triggered(takers_.size());
  for (std::size_t i = 0; i < takers_.size(); ++i) takers_[i]();
  while (exit_status_ < 0) {
    if (g_stop) {
      exit_status_ = exit_status::kOk;
      break;
    }
    say_ready();
    const bool stepped = step_members();
    const bool ticked = conduct();
    if (stepped || ticked) last_progress_ = SteadyClock::now();
    if (std::all_of(members_.begin(), members_.end(), [](const auto& local) { return local.member->ended(); })) {
      exit_status_ = exit_status::kOk;
      break;
    }
    const bool settled = members_.front().ready_said;
    const dds_duration_t timeout = stepped || ticked ? 0 : std::min<dds_duration_t>(pacer_.wait_ns(), settled ? DDS_MSECS(100) : DDS_MSECS(10));
    const int count = dds::check(dds_waitset_wait(wait_set_.get(), triggered.data(), triggered.size(), timeout), "dds_waitset_wait");
    for (std::size_t i = 0; i < std::min<std::size_t>(static_cast<std::size_t>(count), triggered.size()); ++i) {
      takers_[static_cast<std::size_t>(triggered[i])]();
    }
    if (!stepped && !ticked) watch();
  }
  finish();
  return exit_status_;
}

Host::Host(HostOptions options, std::vector<ComponentFactory> factories)
    : impl_(std::make_unique<Impl>(std::move(options), std::move(factories))) {}
Host::~Host() = default;
int Host::run() { return impl_->run(); }

}  // namespace constrictor
