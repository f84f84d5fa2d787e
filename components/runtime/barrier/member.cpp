#include "runtime/barrier/member.hpp"

#include <cereal/types/array.hpp>
#include <cereal/types/string.hpp>
#include <cereal/types/vector.hpp>
#include <cstdlib>
#include <stdexcept>

#include "constrictor/reflect.hpp"
#include "runtime/barrier/topic_ops.hpp"
#include "runtime/concluding.hpp"
#include "runtime/share.hpp"

namespace constrictor {
namespace {

constexpr std::size_t kMaxEarly = 4096;  // samples kept before the epoch is known

[[noreturn]] void bug(const std::string& component, const std::string& what) {
  std::fprintf(stderr, "constrictor: bug in component %s: %s\n", component.c_str(), what.c_str());
  std::abort();
}

}  // namespace

struct Member::Input {
  struct Entry {
    Sample sample;
    bool valid = true;
  };
  InputSlot slot;
  std::map<std::uint64_t, Entry> buffer;  ///< by sequence number
  std::uint64_t consumed = 0;             ///< newest sequence number that a step has seen
  std::uint64_t last_valid = 0;           ///< newest valid one among them

  /// Newest valid sequence number that would be visible with `target`; 0: none.
  [[nodiscard]] std::uint64_t newest_valid(std::uint64_t target) const {
    for (auto at = buffer.upper_bound(target); at != buffer.begin();) {
      --at;
      if (at->second.valid) return at->first;
    }
    return 0;
  }
};

struct Member::OutputPort {
  OutputSlot slot;
  std::uint64_t count = 0;
  int in_this_step = 0;
};

class Member::MemberWiring : public Wiring {
 public:
  explicit MemberWiring(Member& member) : member_(member) {}
  void request_end_of_run() override { member_.end_requested_ = true; }
  void count_refusal(const std::string& reason) override { member_.refuse(reason); }
  std::shared_ptr<OutsideRequests> outside_requests() override {
    if (!member_.outside_) member_.outside_ = std::make_shared<OutsideRequests>();
    return member_.outside_;
  }

  const InputSlot* input(const TopicInfo& topic, bool events) override {
    const std::uint64_t bit = std::uint64_t{1} << topic.id;
    if (member_.reads_ & bit) bug(member_.name(), "declares input " + std::string(topic.name) + " twice");
    member_.reads_ |= bit;
    auto& input = *member_.inputs_.emplace_back(std::make_unique<Input>());
    input.slot.topic = &topics::kInfos[topic.id];
    input.slot.events = events;
    return &input.slot;
  }
  const OutputSlot* output_slot(const TopicInfo& topic) override {
    const std::uint64_t bit = std::uint64_t{1} << topic.id;
    if (member_.writes_ & bit) bug(member_.name(), "declares output " + std::string(topic.name) + " twice");
    if (topic.writer != member_.name()) {
      bug(member_.name(), "writes " + std::string(topic.name) + ", which belongs to " + std::string(topic.writer));
    }
    member_.writes_ |= bit;
    auto& port = *member_.outputs_.emplace_back(std::make_unique<OutputPort>());
    port.slot.topic = &topics::kInfos[topic.id];
    port.slot.write = [&member = member_, &port](const void* message) { member.write(port, message); };
    return &port.slot;
  }

 private:
  Member& member_;
};

Member::Member(ComponentFactory factory, Setup setup, std::uint32_t incarnation, bool checkpoints, MemberSink& sink)
    : factory_(std::move(factory)), setup_(std::move(setup)), incarnation_(incarnation), checkpoints_(checkpoints),
      sink_(sink) {
  setup_.component = factory_.name;
  if (setup_.config_file.empty() && !factory_.default_config.empty()) setup_.config_file = share_path(factory_.default_config);
  build(setup_.seed);
}

Member::~Member() = default;

void Member::build(std::uint64_t seed) {
  if (component_ && fresh_component_ && seed == setup_.seed) return;
  component_.reset();  // before its ports
  inputs_.clear();
  outputs_.clear();
  reads_ = writes_ = 0;
  setup_.seed = seed;
  wiring_ = std::make_unique<MemberWiring>(*this);
  component_ = factory_.create(*wiring_, setup_);
  timing_ = component_->timing();
  fresh_component_ = true;
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

void Member::on_epoch(const EpochId& epoch, std::uint64_t seed) {
  if (epoch_ == epoch) return;
  if (!epoch_ && incarnation_ > 1) {
    if (!epoch_after_resume_ || epoch.epoch > epoch_after_resume_->first.epoch) epoch_after_resume_ = {epoch, seed};
    return;
  }
  if (epoch_ && (epoch.run_id != epoch_->run_id || epoch.epoch < epoch_->epoch)) {
    return refuse("epoch: an epoch of another run or an earlier one");
  }
  build(seed);
  epoch_ = epoch;
  ticks_.clear();
  last_done_ = newest_tick_ = -1;
  ended_ = end_requested_ = false;
  output_hash_ = {};
  replay_early();
}

void Member::replay_early() {
  for (const auto& [topic, sample] : std::exchange(early_, {})) on_sample(topic, sample);
  for (const auto& tick : std::exchange(early_ticks_, {})) on_tick(tick);
}

void Member::on_resume(const Resumption& resumption) {
  if (epoch_ || resumption.incarnation != incarnation_) return;
  if (incarnation_ == 1) return refuse("resume: the first incarnation begins with an epoch");
  const auto next = std::exchange(epoch_after_resume_, {});
  if (next && next->first.run_id == resumption.epoch.run_id && next->first.epoch > resumption.epoch.epoch) {
    epoch_ = resumption.epoch;  // over already: only what began since counts
    return on_epoch(next->first, next->second);
  }
  std::vector<std::pair<const TopicInfo*, Sample>> outputs;
  for (const auto& written : resumption.outputs) {
    const Sample sample = topic_ops(written.topic).parse(std::as_bytes(std::span(written.bytes)));
    if (!sample.message) return refuse("resume.checkpoint: damaged output");
    outputs.emplace_back(&topics::kInfos[written.topic], sample);
  }
  build(resumption.seed);
  epoch_ = resumption.epoch;
  last_done_ = newest_tick_ = resumption.index;
  if (resumption.index >= 0) restore(resumption.state);
  // Readers that missed the last words of the dead process, or start later than it died, find them with the new writer.
  for (const auto& [topic, sample] : outputs) sink_.publish(*topic, sample);
  replay_early();
}

void Member::on_tick(const msg::Tick& tick) {
  if (!epoch_) {
    if (early_ticks_.size() < kMaxEarly) early_ticks_.push_back(tick);
    return;
  }
  if (tick.run_id != epoch_->run_id || tick.epoch != epoch_->epoch) return refuse("tick: of another epoch");
  if (tick.index < 0 || tick.period_ns <= 0) return refuse("tick: found neither index nor period, accepted an index from 0 and a period above 0");
  if (tick.index <= last_done_ && !tick.final_tick) return;  // history, after a rejoin
  if (tick.final_tick && !ended_) conclude(tick);
  newest_tick_ = std::max(newest_tick_, tick.index);
  if (tick.index % timing_.period == 0 && !tick.final_tick) ticks_.emplace(tick.index, tick);
}

void Member::conclude(const msg::Tick& final_tick) {
  ended_ = true;
  auto* concluding = dynamic_cast<Concluding*>(component_.get());
  if (!concluding || last_done_ < 0) return;
  const std::int64_t time_ns = final_tick.time_ns - (final_tick.index - last_done_) * final_tick.period_ns;
  concluding->conclude(Tick{last_done_, time_ns, final_tick.period_ns, 1, final_tick.run_id, final_tick.epoch});
}

void Member::on_sample(std::size_t topic_id, const Sample& sample) {
  if (!epoch_) {
    if (early_.size() < kMaxEarly) early_.emplace_back(topic_id, sample);
    return;
  }
  const msg::Header& header = *sample.header;
  const std::string topic(topics::kInfos[topic_id].name);
  for (auto& input : inputs_) {
    if (input->slot.topic->id != topic_id) continue;
    if (header.run_id != epoch_->run_id || header.epoch != epoch_->epoch) return refuse(topic + ": of another epoch");
    if (header.sequence_number < std::max<std::uint64_t>(input->last_valid, 1)) {
      ++counters_.duplicates;
      return;
    }
    if (header.sequence_number > input->consumed + 4096) return refuse(topic + ".sequence_number: from the future");
    const auto known = input->buffer.find(header.sequence_number);
    if (known != input->buffer.end()) {
      ++counters_.duplicates;
      // The step was done again by a newer incarnation before anybody could see its first outcome.
      if (header.sequence_number <= input->consumed || known->second.sample.header->incarnation >= header.incarnation) return;
    }
    const auto violation = topic_ops(topic_id).validate(sample.message.get());
    if (violation) refuse(topic + "." + *violation);
    input->buffer[header.sequence_number] = {sample, !violation};
    return;
  }
}

const msg::Tick* Member::due() const {
  return epoch_ && !ticks_.empty() && !ended_ ? &ticks_.begin()->second : nullptr;
}

bool Member::complete(const Input& input, const msg::Tick& tick) const {
  const std::size_t topic = input.slot.topic->id;
  const std::uint64_t target = tick.visible[topic];
  if (target == 0 || tick.realtime) return true;
  const auto newest = input.buffer.find(target);
  if (newest == input.buffer.end() || newest->second.sample.header->incarnation != tick.incarnations[topic]) return false;
  if (!newest->second.valid && input.last_valid > 0 && input.newest_valid(target) == 0) return false;
  if (!input.slot.events) return true;
  for (std::uint64_t sequence = input.consumed + 1; sequence < target; ++sequence) {
    if (!input.buffer.contains(sequence)) return false;
  }
  return true;
}

void Member::present(Input& input, const msg::Tick& tick) {
  const std::uint64_t arrived = input.buffer.empty() ? input.consumed : input.buffer.rbegin()->first;
  const std::uint64_t target = tick.realtime ? arrived : tick.visible[input.slot.topic->id];
  input.slot.now_tick = tick.index;
  input.slot.fresh.clear();
  const std::uint64_t newest = input.newest_valid(target);
  if (newest > 0) input.slot.latest = input.buffer.at(newest).sample;
  if (input.slot.events) {
    for (auto at = input.buffer.upper_bound(input.consumed); at != input.buffer.end() && at->first <= target; ++at) {
      if (at->second.valid) input.slot.fresh.push_back(at->second.sample);
    }
  } else if (newest > input.consumed) {
    input.slot.fresh.push_back(input.slot.latest);
  }
  input.consumed = std::max(input.consumed, target);
  input.last_valid = std::max(input.last_valid, newest);
  input.buffer.erase(input.buffer.begin(), input.buffer.lower_bound(input.last_valid));
}

void Member::skip_to_newest() {
  while (ticks_.size() > 1 && std::next(ticks_.begin())->second.realtime) {
    ticks_.erase(ticks_.begin());
    ++counters_.skipped;
  }
}

bool Member::try_step() {
  skip_to_newest();
  const msg::Tick* tick = due();
  if (!tick) return false;
  for (const auto& input : inputs_) {
    if (!complete(*input, *tick)) return false;
  }
  for (const auto& input : inputs_) present(*input, *tick);
  stamp_ = {tick->run_id, tick->epoch, incarnation_, tick->index, tick->time_ns, 0};
  for (auto& port : outputs_) port->in_this_step = 0;
  const std::int64_t elapsed = last_done_ < 0 ? timing_.period : tick->index - last_done_;
  fresh_component_ = false;
  component_->step(Tick{tick->index, tick->time_ns, tick->period_ns, elapsed, tick->run_id, tick->epoch});
  finish_step(*tick);
  return true;
}

void Member::sample_plant(std::int64_t index, std::int64_t time_ns, std::int64_t period_ns) {
  if (!epoch_) bug(name(), "sampled before the epoch");
  stamp_ = {epoch_->run_id, epoch_->epoch, incarnation_, index, time_ns, 0};
  for (auto& port : outputs_) port->in_this_step = 0;
  fresh_component_ = false;
  static_cast<Plant&>(*component_).sample(Tick{index, time_ns, period_ns, 1, epoch_->run_id, epoch_->epoch});
}

std::vector<StepDone::Count> Member::published() const {
  std::vector<StepDone::Count> counts;
  for (const auto& port : outputs_) counts.push_back({port->slot.topic->id, port->count});
  return counts;
}

void Member::write(OutputPort& port, const void* message) {
  const TopicInfo& topic = *port.slot.topic;
  const auto& ops = topic_ops(topic.id);
  if (port.in_this_step == topic.max_per_tick) {
    return refuse(std::string(topic.name) + ": more than " + std::to_string(topic.max_per_tick) + " in one step");
  }
  if (const auto violation = ops.validate(message)) return refuse(std::string(topic.name) + "." + *violation);
  ++port.in_this_step;
  msg::Header header = stamp_;
  header.sequence_number = ++port.count;
  const Sample sample = ops.stamp(message, header, setup_.robot_id);
  sink_.publish(topic, sample);
  // The hash must not depend on the run's random id nor on which incarnation wrote.
  msg::Header neutral = header;
  neutral.run_id = 0;
  neutral.epoch = neutral.incarnation = 0;
  Sha256 hash;
  hash.update(std::as_bytes(std::span(output_hash_)));
  std::string bytes;
  ops.append_bytes(ops.stamp(message, neutral, setup_.robot_id).message.get(), bytes);
  hash.update(std::as_bytes(std::span(bytes)));
  output_hash_ = hash.finish();
  if (checkpoints_) {
    bytes.clear();
    ops.append_bytes(sample.message.get(), bytes);
    written_.push_back({topic.id, std::move(bytes)});
  }
}

void Member::finish_step(const msg::Tick& tick) {
  last_done_ = tick.index;
  StepDone done;
  done.component = name();
  done.epoch = *epoch_;
  done.incarnation = incarnation_;
  done.index = tick.index;
  done.published = published();
  for (const auto& input : inputs_) done.consumed.push_back({input->slot.topic->id, input->consumed});
  done.output_hash = output_hash_;
  done.end_of_run = end_requested_;
  if (checkpoints_) done.state = state_bytes();
  done.written = std::exchange(written_, {});
  ticks_.erase(tick.index);  // `tick` lives there: last use
  sink_.done(done);
}

std::string Member::state_bytes() const {
  std::ostringstream stream;
  {
    cereal::PortableBinaryOutputArchive archive(stream);
    for (const auto& input : inputs_) archive(input->consumed, input->last_valid);
    for (const auto& port : outputs_) archive(port->count);
    archive(output_hash_, end_requested_, component_->save());
  }
  return std::move(stream).str();
}

void Member::restore(const std::string& state) {
  std::string component_state;
  try {
    std::istringstream stream(state);
    cereal::PortableBinaryInputArchive archive(stream);
    for (auto& input : inputs_) archive(input->consumed, input->last_valid);
    for (auto& port : outputs_) archive(port->count);
    archive(output_hash_, end_requested_, component_state);
    component_->load(component_state);
  } catch (const cereal::Exception& error) {
    throw std::runtime_error("checkpoint of " + name() + ": " + error.what());
  }
  fresh_component_ = false;
}

MissingInput Member::missing() const {
  const msg::Tick* tick = due();
  if (!tick) return {newest_tick_ + 1, nullptr, 0, 0};
  for (const auto& input : inputs_) {
    if (complete(*input, *tick)) continue;
    const std::uint64_t have = input->buffer.empty() ? input->consumed : input->buffer.rbegin()->first;
    return {tick->index, input->slot.topic, have, tick->visible[input->slot.topic->id]};
  }
  return {tick->index, nullptr, 0, 0};
}

}  // namespace constrictor
