#include "runtime/host.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>

#include "runtime/config_hash.hpp"
#include "runtime/host_impl.hpp"
#include "runtime/version.hpp"

namespace constrictor {
namespace {

volatile std::sig_atomic_t g_stop = 0;
void on_signal(int) { g_stop = 1; }

std::string join(const std::vector<std::string>& names) { return fmt::format("{}", fmt::join(names, ",")); }

std::string host_name() {
  char name[64] = {};
  ::gethostname(name, sizeof(name) - 1);
  return name;
}

}  // namespace

Host::Impl::Impl(HostOptions options, std::vector<ComponentFactory> factories)
    : options_(std::move(options)), domain_(options_.domain), pacer_(options_.realtime ? 1.0 : options_.pace, options_.operator_pace) {
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
    auto member = std::make_unique<Member>(std::move(factory), std::move(setup), options_.incarnation, checkpoints,
                                           static_cast<MemberSink&>(*this));
    if (member->name() == options_.plant) plant_ = member.get();
    const std::string config_hash = component_config_hash(member->setup().config_file, member->setup().scenario_file);
    members_.push_back({std::move(member), {}, false, config_hash});
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

bool Host::Impl::conduct() {
  if (!conductor_ || !conductor_->may_tick() || !pacer_.may_tick(conductor_->next_time_ns())) return false;
  const std::int64_t period = static_cast<Plant&>(plant_->component()).period_ns();
  plant_->sample_plant(conductor_->next_index(), conductor_->next_time_ns(), period);
  conductor_->tick(plant_->published());
  pacer_.ticked();
  if (pacer_.holding()) publish_run_state(true);  // the last of the steps that were asked for
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

void Host::Impl::report_waiting(const Member& waiter, const std::string& what, const std::string& whom, std::int64_t tick,
                                std::uint64_t have, std::uint64_t want) {
  const std::string& component = waiter.name();
  const double waited = std::chrono::duration<double>(SteadyClock::now() - last_progress_).count();
  std::fprintf(stderr, "%s waits for %s of %s at tick %lld (has %llu, needs %llu) for %.0f s\n", component.c_str(),
               what.c_str(), whom.c_str(), static_cast<long long>(tick), static_cast<unsigned long long>(have),
               static_cast<unsigned long long>(want), waited);
  msg::Waiting message{};
  dds::set_text(message.component, component);
  if (waiter.in_epoch()) message.run_id = waiter.epoch().run_id;
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
  // Who may tick and does not is held back by the pace.
  if (conductor_ && (pacer_.holding() || conductor_->may_tick())) last_progress_ = now;
  const double waited = std::chrono::duration<double>(now - last_progress_).count();
  if (waited < 2.0 || now - last_waiting_report_ < std::chrono::seconds(1)) return;
  last_waiting_report_ = now;
  const std::int64_t next = conductor_ ? conductor_->next_index() : members_.front().member->newest_tick() + 1;
  if (!unmatched_.empty()) std::fprintf(stderr, "%s: %s\n", identity_.c_str(), bus_->explain(unmatched_).c_str());
  if (conductor_) {
    for (const auto& owed : conductor_->owed()) {
      report_waiting(*plant_, owed.what, owed.component, next, static_cast<std::uint64_t>(std::max<std::int64_t>(owed.have, 0)),
                     static_cast<std::uint64_t>(owed.want));
    }
  }
  for (auto& local : members_) {
    const MissingInput missing = local.member->missing();
    if (missing.topic) {
      report_waiting(*local.member, std::string(missing.topic->name), std::string(missing.topic->writer), missing.tick,
                     missing.have, missing.want);
    } else if (!conductor_) {
      report_waiting(*local.member, local.member->in_epoch() ? "Tick" : "EpochStart", options_.plant, missing.tick, 0, 1);
    }
    publish_status(local, msg::kComponentWaiting);
  }
  if (options_.patience_s > 0 && waited > options_.patience_s) {
    std::fprintf(stderr, "%s: gave up after %.0f s of waiting\n", identity_.c_str(), waited);
    exit_status_ = exit_status::kWaitedTooLong;
  }
}

void Host::Impl::finish() {
  // Only the final tick ends a run: whoever is told to go before that just goes, with its last counts.
  for (auto& local : members_) publish_status(local, local.member->ended() ? msg::kComponentEnded : msg::kComponentRunning);
  // The final tick must reach everybody before its writer goes; bounded, since a stopped process must not hold the end up.
  if (conductor_ && exit_status_ == exit_status::kOk) dds_wait_for_acks(tick_writer_.get(), DDS_SECS(2));
  if (plant_ && plant_->ended()) dds_wait_for_acks(status_writer_.get(), DDS_SECS(1));  // by it the launcher knows that this was the run's end
  if (hash_log_) hash_log_->close();
}

int Host::Impl::run() {
  if (!g_stop) greet();
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
    if (conductor_) publish_run_state(false);
    if (std::all_of(members_.begin(), members_.end(), [](const auto& local) { return local.member->ended(); })) {
      exit_status_ = exit_status::kOk;
      break;
    }
    const bool settled = std::all_of(members_.begin(), members_.end(), [](const auto& local) { return local.ready_said; });
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
void Host::heed_signals() {
  struct sigaction action {};
  action.sa_handler = on_signal;
  ::sigaction(SIGTERM, &action, nullptr);
  ::sigaction(SIGINT, &action, nullptr);
}
int Host::run() { return impl_->run(); }

}  // namespace constrictor
