#include "barrier/local_run.hpp"

#include <stdexcept>

namespace constrictor {
namespace {
constexpr std::size_t kTickHistory = 128;
}

LocalRun::LocalRun(std::vector<ComponentFactory> factories, Setup setup,
                   std::map<std::string, std::filesystem::path> config_files)
    : factories_(std::move(factories)), setup_(std::move(setup)), config_files_(std::move(config_files)) {
  options_.seed = setup_.seed;
  for (const auto& factory : factories_) options_.roster.push_back(factory.name);
  options_.plant = options_.roster.at(0);
  for (std::size_t i = 0; i < factories_.size(); ++i) members_.push_back(make(i, 1));
  auto* plant = dynamic_cast<Plant*>(&members_[0]->component());
  if (!plant) throw std::invalid_argument("LocalRun: " + options_.plant + " is not a plant");
  options_.period_ns = plant->period_ns();
  conductor_ = std::make_unique<Conductor>(options_, static_cast<ConductorSink&>(*this));
  for (const auto& member : members_) send_hello(*member);
}

LocalRun::~LocalRun() = default;

std::unique_ptr<Member> LocalRun::make(std::size_t index, std::uint32_t incarnation) {
  Setup setup = setup_;
  const auto config = config_files_.find(factories_[index].name);
  if (config != config_files_.end()) setup.config_file = config->second;
  return std::make_unique<Member>(factories_[index], setup, incarnation, /*checkpoints=*/true,
                                  static_cast<MemberSink&>(*this));
}

void LocalRun::send_hello(const Member& member) {
  Hello hello;
  hello.component = member.name();
  hello.incarnation = member.incarnation();
  hello.timing = member.timing();
  hello.reads = member.reads();
  hello.writes = member.writes();
  conductor_->on_hello(hello);
}

Member& LocalRun::member(const std::string& name) {
  for (auto& member : members_) {
    if (member->name() == name) return *member;
  }
  throw std::invalid_argument("LocalRun: no member " + name);
}

std::int64_t LocalRun::advance(std::int64_t ticks) {
  std::int64_t advanced = 0;
  for (; advanced < ticks && !ended(); ++advanced) {
    if (!conductor_->may_tick()) throw std::logic_error("LocalRun: a member did not finish its step");
    auto checkpoint = members_[0]->measure(conductor_->next_index(), conductor_->next_time_ns(),
                                           static_cast<Plant&>(members_[0]->component()).period_ns());
    conductor_->tick(members_[0]->published(), std::move(checkpoint));
    for (auto& member : members_) {
      while (member->try_step()) {}
    }
  }
  return advanced;
}

void LocalRun::restart_plant() {
  const Checkpoint saved = checkpoint();
  const std::uint32_t incarnation = members_[0]->incarnation() + 1;
  members_[0].reset();
  conductor_ = std::make_unique<Conductor>(options_, static_cast<ConductorSink&>(*this), saved);
  members_[0] = make(0, incarnation);
  for (std::size_t topic = 0; topic < topics::kCount; ++topic) {
    if (!members_[0]->reads().contains(topic)) continue;
    for (const auto& sample : history_[topic]) members_[0]->on_sample(topic, sample);
  }
  send_hello(*members_[0]);
  conductor_->continue_epoch();
  for (auto& member : members_) {
    while (member->try_step()) {}
  }
}

void LocalRun::restart(const std::string& name) {
  if (name == options_.plant) return restart_plant();
  for (std::size_t i = 1; i < members_.size(); ++i) {
    if (members_[i]->name() != name) continue;
    const std::uint32_t incarnation = members_[i]->incarnation() + 1;
    members_[i].reset();
    members_[i] = make(i, incarnation);
    for (std::size_t topic = 0; topic < topics::kCount; ++topic) {
      if (!members_[i]->reads().contains(topic)) continue;
      for (const auto& sample : history_[topic]) members_[i]->on_sample(topic, sample);
    }
    for (const auto& tick : ticks_) members_[i]->on_tick(tick);
    send_hello(*members_[i]);
    while (members_[i]->try_step()) {}
    return;
  }
  throw std::invalid_argument("LocalRun: no restartable member " + name);
}

void LocalRun::publish(const TopicInfo& topic, const Sample& sample) {
  auto& history = history_[topic.id];
  const bool again = !history.empty() && history.back().header->sequence_number >= sample.header->sequence_number &&
                     history.back().header->epoch == sample.header->epoch;
  if (!again) {
    history.push_back(sample);
    if (history.size() > topic.depth) history.pop_front();
    for (const auto& subscriber : subscribers_[topic.id]) subscriber(sample);
  }
  for (auto& member : members_) {
    if (member && member->reads().contains(topic.id)) member->on_sample(topic.id, sample);
  }
}

void LocalRun::done(const TickDone& done) { conductor_->on_done(done); }

void LocalRun::start_epoch(const EpochId& epoch, std::uint64_t seed) {
  for (auto& history : history_) history.clear();
  ticks_.clear();
  for (auto& member : members_) member->on_epoch(epoch, seed);
  for (auto& member : members_) conductor_->on_ready(member->name(), epoch, member->incarnation());
}

void LocalRun::continue_epoch(const EpochId& epoch, std::uint64_t seed, const std::vector<msg::Tick>& ticks) {
  for (auto& member : members_) {
    member->on_epoch(epoch, seed);
    for (const auto& tick : ticks) member->on_tick(tick);
  }
}

void LocalRun::tick(const msg::Tick& tick) {
  members_[0]->publish_sample();
  ticks_.push_back(tick);
  if (ticks_.size() > kTickHistory) ticks_.pop_front();
  for (auto& member : members_) member->on_tick(tick);
}

void LocalRun::resume(const Resume& resume) {
  member(resume.component).on_resume(resume);
  conductor_->on_ready(resume.component, resume.epoch, resume.incarnation);
}

void LocalRun::refuse(const Hello& hello, const std::string& reason) {
  throw std::logic_error("LocalRun: " + hello.component + " refused: " + reason);
}

}  // namespace constrictor
