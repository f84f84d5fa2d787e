#include "runtime/conductor_side.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "cyclone/gathered_sends.hpp"
#include "runtime/config_hash.hpp"
#include "runtime/member_side.hpp"
#include "runtime/numeric_profile.hpp"
#include "runtime/version.hpp"

namespace constrictor {
namespace {

namespace wire = barrier_topics;

constexpr int kMostStrangeControls = 4096;  // without the token, in the life of the process

}  // namespace

ConductorSide::ConductorSide(HostContext& context, Links& links, MemberSide& members)
    : context_(context),
      links_(links),
      members_(members),
      plant_(*members.plant()),
      pacer_(context.options.realtime ? 1.0 : context.options.pace, context.options.operator_pace) {
  make_conductor();
  make_endpoints();
}

ConductorOptions ConductorSide::conductor_options() const {
  const HostOptions& options = context_.options;
  std::random_device entropy;  // for the run id, on which no result depends
  ConductorOptions conductor;
  conductor.run_id =
      options.run_id != 0 ? options.run_id : (static_cast<std::uint64_t>(entropy()) << 32 | entropy()) | 1;
  conductor.roster = options.roster;
  conductor.plant = options.plant;
  conductor.idl_hash = std::string(msg::kIdlHash);
  conductor.release = kVersion;
  conductor.config_hash = context_.config_hash;
  conductor.component_hash = component_config_hash(plant_.setup().config_file, plant_.setup().scenario_file);
  conductor.numeric_profile = numeric_profile();
  conductor.seed = options.setup.seed;
  conductor.realtime = options.realtime;
  conductor.period_ns = period_ns();
  if (options.max_sim_time_s > 0) {
    conductor.last_index = std::llround(options.max_sim_time_s * 1e9 / static_cast<double>(conductor.period_ns));
  }
  return conductor;
}

void ConductorSide::make_conductor() {
  open_store();
  const HostOptions& options = context_.options;
  if (store_ && options.incarnation > 1) {
    if (const auto found = store_->read()) return make_successor(conductor_options(), *found);
  }
  if (options.hash_log && !options.setup.output_dir.empty()) {
    hash_log_ = std::make_unique<HashLog>(options.setup.output_dir);
  }
  open_recording({});
  conductor_ = std::make_unique<Conductor>(conductor_options(), static_cast<ConductorSink&>(*this));
}

void ConductorSide::make_endpoints() {
  const dds_entity_t participant = links_.participant();
  tick_writer_ = {participant, wire::kTick};
  epoch_writer_ = {participant, wire::kEpochStart};
  resume_writer_ = {participant, wire::kResume};
  refused_writer_ = {participant, wire::kRefused};
  control_answer_writer_ = {participant, wire::kRunControlAnswer};
  // Programs that find a run by its messages learn the plant's name from this writer.
  run_state_writer_ = {participant, wire::kRunState, context_.options.plant};
  dds::WriterBook& book = links_.admission().book();
  const auto in_roster = [&roster = context_.options.roster](const auto& message) {
    return std::find(roster.begin(), roster.end(), message.component) != roster.end();
  };
  done_reader_ = dds::Reader<msg::TickDone>::guarded(participant, wire::kTickDone, book, in_roster);
  ready_reader_ = dds::Reader<msg::Ready>::guarded(participant, wire::kReady, book, in_roster);
  // A source of its own costs memory as long as its process lives, so the sources without the token are limited.
  control_reader_ = dds::Reader<msg::RunControl>::guarded(
      participant, wire::kRunControl, book, [this](const msg::RunControl& message) {
        const std::string& token = context_.options.token;
        return token.empty() || same_token(message.token, token) || strange_controls_++ < kMostStrangeControls;
      });
  stop_reader_ = dds::Reader<msg::EmergencyStop>::command(participant, wire::kEmergencyStop);
  links_.attach(stop_reader_.get(),
                [this] { stop_reader_.take([this](const msg::EmergencyStop& m) { take_stop(m); }); });
  const auto named = [](const auto& message) { return std::string(message.component); };
  links_.attach(done_reader_, wire::kTickDone, named, [this](const msg::TickDone& m) { take_done(m); });
  links_.attach(ready_reader_, wire::kReady, named, [this](const msg::Ready& m) { take_ready(m); });
  status_reader_ = dds::Reader<msg::ComponentStatus>::guarded(participant, wire::kStatus, book, in_roster);
  links_.attach(status_reader_, wire::kStatus, named, [this](const msg::ComponentStatus& m) { take_status(m); });
  // Commands are not validated here, because a command that violates its IDL must be answered, too.
  links_.attach(control_reader_.get(),
                [this] { control_reader_.take([this](const msg::RunControl& m) { take_control(m); }); });
  connect_hardware();
}

std::int64_t ConductorSide::period_ns() const { return static_cast<const Plant&>(plant_.component()).period_ns(); }

void ConductorSide::take_ready(const msg::Ready& message) {
  const EpochId epoch{message.run_id, message.epoch};
  if (const auto why = conductor_->foreign(message.component, epoch, message.incarnation))
    return members_.reject(wire::kReady, *why);
  conductor_->on_ready(message.component, epoch, message.incarnation);
}

void ConductorSide::take_done(const msg::TickDone& message) {
  const auto reject = [this](const std::string& reason) { members_.reject(wire::kTickDone, reason); };
  if (const auto why = conductor_->foreign(message.component, {message.run_id, message.epoch}, message.incarnation))
    return reject(*why);
  TickDone& last = last_done_[message.component];
  auto step = from_wire(message, std::move(last));
  if (!step) return reject("checkpoint: damaged");
  if (conductor_->is_early(*step)) early_.push_back(*step);
  else if (const auto why = conductor_->implausible(*step)) reject(*why);
  else use_done(*step);
  last = std::move(*step);
}

void ConductorSide::use_done(const TickDone& step) {
  if (!conductor_->on_done(step)) return;
  context_.note_progress();
  log(step.written);
  if (recorder_) recorder_->add(step);
}

void ConductorSide::log(const std::vector<TickDone::Written>& written) {
  for (const auto& [topic, bytes] : written) {
    if (hash_log_) hash_log_->add(topic, bytes);
    if (recorder_) recorder_->add(topic, bytes);
  }
}

void ConductorSide::on_done(const TickDone& step) {
  if (store_) return use_done(step);
  // record() has seen what it wrote.
  if (conductor_->on_done(step) && recorder_) recorder_->add(step);
}

bool ConductorSide::tick() {
  if (!conductor_->may_tick() || !pacer_.may_tick(conductor_->next_time_ns())) return false;
  PlantCheckpoint checkpoint = plant_.measure(conductor_->next_index(), conductor_->next_time_ns(), period_ns());
  if (store_) log(checkpoint.written);
  pacer_.ticked();
  conductor_->tick(plant_.published(), std::move(checkpoint));
  if (!store_) flush_hash_log();
  for (const auto& step : std::exchange(early_, {})) {
    if (!conductor_->implausible(step)) use_done(step);
  }
  if (pacer_.holding()) publish_run_state(true);  // this was the last tick that `step` asked for
  return true;
}

void ConductorSide::start_epoch(const EpochId& epoch, std::uint64_t seed) {
  if (hash_log_) hash_log_->restart();
  if (recorder_) recorder_->add(epoch_start(epoch, seed));
  early_.clear();
  ended_.clear();
  save();
  send_epoch(epoch, seed);
  pacer_.restart();
  pacer_.operator_holds(false);
}

void ConductorSide::continue_epoch(const EpochId& epoch, std::uint64_t seed, const std::vector<msg::Tick>& ticks) {
  context_.log.warning("incarnation {} of the plant's process continues the run at tick {}",
                       context_.options.incarnation, conductor_->next_index());
  send_epoch(epoch, seed);
  for (const auto& tick : ticks) {
    tick_writer_.write(tick);
    members_.on_tick(tick);
  }
}

msg::EpochStart ConductorSide::epoch_start(const EpochId& epoch, std::uint64_t seed) const {
  msg::EpochStart start{};
  start.run_id = epoch.run_id;
  start.epoch = epoch.epoch;
  start.seed = seed;
  dds::set_text(start.scenario, context_.options.setup.scenario_file.filename().string());
  dds::set_text(start.config_hash, context_.config_hash);
  return start;
}

void ConductorSide::send_epoch(const EpochId& epoch, std::uint64_t seed) {
  epoch_writer_.write(epoch_start(epoch, seed));
  members_.on_epoch(epoch, seed);
}

void ConductorSide::tick(const msg::Tick& message) {
  if (recorder_) recorder_->add(message);
  save();
  {
    const dds::GatheredSends gathered;
    plant_.publish_sample();
    tick_writer_.write(message);
  }
  members_.on_tick(message);
}

void ConductorSide::resume(const Resume& resume) {
  save();
  if (members_.on_resume(resume)) return;
  if (stays_until_) stay_longer();
  std::string block;
  resume_writer_.write(to_wire(resume, block));
}

void ConductorSide::refuse(const Hello& hello, const std::string& reason) {
  if (!refusals_.allows(HostContext::Clock::now())) return;
  context_.log.warning("{} (pid {} on {}) refused: {}", hello.component, hello.pid, hello.host, reason);
  msg::Refused message{};
  dds::set_text(message.component, hello.component);
  message.run_id = conductor_->run_id();
  message.incarnation = hello.incarnation;
  message.pid = hello.pid;
  dds::set_text(message.host, hello.host);
  dds::set_text(message.reason, reason);
  refused_writer_.write(message);
}

void ConductorSide::record(const TopicInfo& topic, const Sample& sample) {
  if (store_) return;  // on_done() and tick() do it
  if (hash_log_) hash_log_->add(topic, sample);
  if (recorder_) recorder_->add(topic, sample);
}

void ConductorSide::report_waiting() {
  for (const auto& owed : conductor_->owed()) {
    members_.report_waiting(plant_, owed.what, owed.component, conductor_->next_index(),
                            static_cast<std::uint64_t>(std::max<std::int64_t>(owed.have, 0)),
                            static_cast<std::uint64_t>(owed.want));
  }
}

void ConductorSide::finish() {
  flush_hash_log();
  if (recorder_) recorder_->finish();
}

void ConductorSide::expect_done() {
  const auto& roster = context_.options.roster;
  const auto missing = std::count_if(roster.begin(), roster.end(), [this](const std::string& name) {
    return !members_.hosts(name) && conductor_->awaits_step(name);
  });
  links_.expect(done_reader_.get(), static_cast<std::size_t>(missing));
}

void ConductorSide::poll_recording() {
  if (recorder_) recorder_->poll();
}

}  // namespace constrictor
