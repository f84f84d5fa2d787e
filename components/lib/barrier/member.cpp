#include "barrier/member.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "barrier/plant_topics.hpp"
#include "barrier/topic_ops.hpp"
#include "component/data_path.hpp"
#include "constrictor/reflect.hpp"

namespace constrictor {
namespace {

constexpr std::size_t kMaxEarly = 4096;  // samples, and ticks, that are kept until the epoch is known

[[noreturn]] void bug(const std::string& component, const std::string& what) {
  std::fprintf(stderr, "constrictor: bug in component %s: %s\n", component.c_str(), what.c_str());
  std::abort();
}

}  // namespace

class Member::MemberWiring : public Wiring {
 public:
  explicit MemberWiring(Member& member) : member_(member) {}
  void request_end_of_run() override { member_.end_requested_ = true; }
  void count_refusal(const std::string& reason) override { member_.refuse_from_component(reason); }
  std::shared_ptr<ClientRequests> client_requests() override { return made(member_.client_requests_); }
  std::shared_ptr<StopOrders> stop_orders() override { return made(member_.stop_orders_); }
  std::shared_ptr<HardwareLink> hardware_link() override { return made(member_.hardware_link_); }

  const InputSlot* input(const TopicInfo& topic, bool events) override {
    if (member_.reads_.contains(topic.id)) bug(member_.name(), fmt::format("declares input {} twice", topic.name));
    member_.reads_.insert(topic.id);
    return &member_.inputs_.emplace_back(std::make_unique<InputBuffer>(topic, events))->slot();
  }
  const OutputSlot* output_slot(const TopicInfo& topic) override {
    if (member_.writes_.contains(topic.id)) bug(member_.name(), fmt::format("declares output {} twice", topic.name));
    // A plant of another name than that of the simulated one is checked when it is built.
    if (topic.writer != member_.name() && !is_written_by_plant(topic)) {
      bug(member_.name(), fmt::format("declares output {}, which only {} may write", topic.name, topic.writer));
    }
    member_.writes_.insert(topic.id);
    auto& port = *member_.outputs_.emplace_back(std::make_unique<OutputPort>());
    port.slot.topic = &topics::kInfos[topic.id];
    port.slot.write = [&member = member_, &port](const void* message) { member.write(port, message); };
    return &port.slot;
  }

 private:
  template <class Latch>
  static const std::shared_ptr<Latch>& made(std::shared_ptr<Latch>& latch) {
    if (!latch) latch = std::make_shared<Latch>();
    return latch;
  }
  Member& member_;
};

Member::Member(ComponentFactory factory, Setup setup, std::uint32_t incarnation, bool checkpoints, MemberSink& sink)
    : factory_(std::move(factory)),
      setup_(std::move(setup)),
      incarnation_(incarnation),
      checkpoints_(checkpoints),
      sink_(sink) {
  setup_.component = factory_.name;
  if (setup_.config_file.empty() && !factory_.default_config.empty())
    setup_.config_file = data_path(factory_.default_config);
  build(setup_.seed);
}

Member::~Member() = default;

void Member::build(std::uint64_t seed) {
  if (component_ && fresh_component_ && seed == setup_.seed) return;
  component_.reset();  // it points to its ports
  inputs_.clear();
  outputs_.clear();
  reads_ = writes_ = {};
  setup_.seed = seed;
  wiring_ = std::make_unique<MemberWiring>(*this);
  component_ = factory_.create(*wiring_, setup_);
  is_plant_ = dynamic_cast<Plant*>(component_.get()) != nullptr;
  for (const auto& topic : topics::kInfos) {
    if (writes_.contains(topic.id) && is_written_by_plant(topic) && !is_plant_ && topic.writer != name())
      bug(name(), fmt::format("declares output {}, which only a plant may write", topic.name));
  }
  timing_ = component_->timing();
  timing_.latency = std::max(timing_.latency, setup_.latency_ticks);
  fresh_component_ = true;
  resumed_ = false;
  if (timing_.period < 1 || timing_.latency < 1) bug(name(), "period and latency must be at least 1 tick");
}

const EpochId& Member::epoch() const {
  if (!epoch_) bug(name(), "asked for its epoch before it was in one");
  return *epoch_;
}

void Member::refuse(const std::string& reason) {
  ++counters_.refused;
  counters_.last_refusal = reason;
}

void Member::refuse_from_component(const std::string& reason) {
  // During a step the owner may count refusals in another thread.
  if (step_) step_->refusals.push_back(reason);
  else refuse(reason);
}

void Member::on_epoch(const EpochId& epoch, std::uint64_t seed) {
  if (epoch_ == epoch) return;
  if (!epoch_ && incarnation_ > 1) {
    if (!epoch_after_resume_ || epoch.epoch > epoch_after_resume_->first.epoch) epoch_after_resume_ = {epoch, seed};
    return;
  }
  if (epoch_ && (epoch.run_id != epoch_->run_id || epoch.epoch < epoch_->epoch)) {
    return refuse("epoch: it belongs to another run, or is older than the present one");
  }
  step_.reset();  // its outputs belong to the previous epoch
  written_.clear();
  sample_.clear();
  build(seed);
  epoch_ = epoch;
  ticks_.clear();
  last_done_ = newest_tick_ = -1;
  ended_ = end_requested_ = false;
  concludes_at_.reset();
  output_hash_ = {};
  replay_early();
}

void Member::replay_early() {
  for (const auto& [topic, sample] : std::exchange(early_, {})) on_sample(topic, sample);
  for (const auto& tick : std::exchange(early_ticks_, {})) on_tick(tick);
}

void Member::on_tick(const msg::Tick& tick) {
  if (!epoch_) {
    if (early_ticks_.size() < kMaxEarly) early_ticks_.push_back(tick);
    return;
  }
  if (tick.run_id != epoch_->run_id || tick.epoch != epoch_->epoch)
    return refuse("tick: it belongs to another run or epoch");
  if (tick.index < 0 || tick.period_ns <= 0)
    return refuse(fmt::format("tick: found index {} and period_ns {}, accepted an index from 0 and a period above 0",
                              tick.index, tick.period_ns));
  if (tick.index <= last_done_ && !tick.final_tick) return;  // from history, after a restart
  if (tick.final_tick && !ended_) conclude(tick);
  newest_tick_ = std::max(newest_tick_, tick.index);
  for (auto& input : inputs_) input->announce(tick.visible[input->topic().id]);
  if (tick.index % timing_.period != 0 || tick.final_tick) return;
  const auto at = std::lower_bound(ticks_.begin(), ticks_.end(), tick.index,
                                   [](const msg::Tick& one, std::int64_t index) { return one.index < index; });
  if (at == ticks_.end() || at->index != tick.index) ticks_.insert(at, tick);
}

void Member::on_sample(std::size_t topic_id, const Sample& sample) {
  if (!epoch_) {
    if (early_.size() < kMaxEarly) early_.emplace_back(topic_id, sample);
    return;
  }
  const auto found = std::find_if(inputs_.begin(), inputs_.end(),
                                  [topic_id](const auto& input) { return input->topic().id == topic_id; });
  if (found == inputs_.end()) return;
  const msg::Header& header = *sample.header;
  const std::string_view topic = (*found)->topic().name;
  if (header.run_id != epoch_->run_id || header.epoch != epoch_->epoch)
    return refuse(fmt::format("{}: it belongs to another run or epoch", topic));
  const InputBuffer::Arrival arrival = (*found)->classify(header);
  if (arrival == InputBuffer::Arrival::kTooFarAhead) {
    return refuse(fmt::format("{}.sequence_number: found {}, accepted at most {} more than {}", topic,
                              header.sequence_number, InputBuffer::kFarthestAhead,
                              (*found)->farthest() - InputBuffer::kFarthestAhead));
  }
  if (arrival != InputBuffer::Arrival::kNew) ++counters_.duplicates;
  if (arrival == InputBuffer::Arrival::kDuplicate) return;
  const auto violation = topic_ops(topic_id).validate(sample.message.get());
  if (violation) refuse(fmt::format("{}.{}", topic, *violation));
  (*found)->keep(sample, !violation);
  if (concludes_at_) conclude(*concludes_at_);
}

const msg::Tick* Member::due() const { return epoch_ && !ticks_.empty() && !ended_ ? &ticks_.front() : nullptr; }

void Member::skip_to_newest() {
  while (ticks_.size() > 1 && ticks_[1].realtime) {
    ticks_.erase(ticks_.begin());
    ++counters_.skipped;
  }
}

bool Member::try_step() {
  if (!begin_step()) return false;
  run_step();
  finish_step();
  return true;
}

bool Member::begin_step() {
  if (step_) return false;
  skip_to_newest();
  const msg::Tick* tick = due();
  if (!tick) return false;
  for (const auto& input : inputs_) {
    if (!input->complete(*tick)) return false;
  }
  for (const auto& input : inputs_) input->present(*tick);
  stamp_ = {tick->run_id, tick->epoch, incarnation_, tick->index, tick->time_ns, 0};
  for (auto& port : outputs_) port->in_this_step = 0;
  const std::int64_t elapsed = last_done_ < 0 ? timing_.period : tick->index - last_done_;
  fresh_component_ = resumed_ = false;
  step_ = Step{Tick{tick->index, tick->time_ns, tick->period_ns, elapsed, tick->run_id, tick->epoch},
               std::move(outputs_memory_)};
  return true;
}

void Member::run_step() {
  if (!step_) bug(name(), "ran a step that had not begun");
  component_->step(step_->tick);
}

const std::vector<TickDone::Count>& Member::published() {
  done_.published.clear();
  for (const auto& port : outputs_) done_.published.push_back({port->slot.topic->id, port->count});
  return done_.published;
}

void Member::write(OutputPort& port, const void* message) {
  const TopicInfo& topic = *port.slot.topic;
  const auto& ops = topic_ops(topic.id);
  if (port.in_this_step == topic.max_per_tick) {
    return refuse_from_component(fmt::format("{}: more than {} in one step", topic.name, topic.max_per_tick));
  }
  if (const auto violation = ops.validate(message))
    return refuse_from_component(std::string(topic.name) + "." + *violation);
  ++port.in_this_step;
  msg::Header header = stamp_;
  header.sequence_number = ++port.count;
  const Sample sample = ops.stamp(message, header, setup_.robot_id);
  if (step_) step_->outputs.emplace_back(&topic, sample);
  else if (measuring_) sample_.emplace_back(&topic, sample);
  else sink_.publish(topic, sample);
  message_bytes_.clear();
  ops.append_bytes(sample.message.get(), message_bytes_);
  const auto all = std::as_bytes(std::span(message_bytes_));
  const std::size_t header_at = ops.header_at(all).value();
  // The output hash must not depend on the random run id, nor on how often the member was restarted.
  hash_.update(std::as_bytes(std::span(output_hash_)));
  hash_.update(all.first(header_at));
  hash_.update(header_bytes(neutral_header(header)));
  hash_.update(all.subspan(header_at + kHeaderSize));
  output_hash_ = hash_.finish();
  if (checkpoints_) written_.push_back({topic.id, message_bytes_});
}

void Member::finish_step() {
  if (!step_) bug(name(), "finished a step that had not begun");
  Step step = *std::exchange(step_, std::nullopt);
  for (const auto& [topic, sample] : step.outputs) sink_.publish(*topic, sample);
  for (const auto& reason : step.refusals) refuse(reason);
  step.outputs.clear();
  outputs_memory_ = std::move(step.outputs);
  last_done_ = step.tick.index;
  done_.component = name();
  done_.epoch = *epoch_;
  done_.incarnation = incarnation_;
  done_.index = step.tick.index;
  static_cast<void>(published());
  done_.consumed.clear();
  for (const auto& input : inputs_) done_.consumed.push_back({input->topic().id, input->consumed()});
  done_.output_hash = output_hash_;
  done_.end_of_run = end_requested_;
  // The plant's checkpoint is made by measure(), just before the next tick.
  if (checkpoints_ && !is_plant_) done_.state = state_bytes(std::move(done_.state));
  if (!is_plant_) {
    std::swap(done_.written, written_);
    written_.clear();
  }
  std::erase_if(ticks_, [&](const msg::Tick& tick) { return tick.index == step.tick.index; });
  sink_.done(done_);
  if (concludes_at_) conclude(*concludes_at_);
}

}  // namespace constrictor
