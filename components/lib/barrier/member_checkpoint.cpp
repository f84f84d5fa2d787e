// The part of Member that saves its state after a step, and continues from a saved state.
#include <algorithm>
#include <cereal/types/array.hpp>
#include <cereal/types/string.hpp>
#include <cereal/types/vector.hpp>
#include <stdexcept>

#include "barrier/member.hpp"
#include "barrier/topic_ops.hpp"
#include "constrictor/archive.hpp"

namespace constrictor {

void Member::on_resume(const Resume& resume) {
  if (epoch_ || resume.incarnation != incarnation_) return;
  if (incarnation_ == 1) return refuse("resume: the first incarnation begins with an epoch");
  const auto next = std::exchange(epoch_after_resume_, {});
  if (next && next->first.run_id == resume.epoch.run_id && next->first.epoch > resume.epoch.epoch) {
    epoch_ = resume.epoch;  // a reset has ended it already: only the newer epoch counts
    return on_epoch(next->first, next->second);
  }
  std::vector<std::pair<const TopicInfo*, Sample>> outputs;
  for (const auto& written : resume.outputs) {
    const Sample sample = topic_ops(written.topic).parse(std::as_bytes(std::span(written.bytes)));
    if (!sample.message) return refuse("resume.checkpoint: damaged output");
    outputs.emplace_back(&topics::kInfos[written.topic], sample);
  }
  build(resume.seed);
  epoch_ = resume.epoch;
  last_done_ = newest_tick_ = resume.index;
  if (resume.state == kBeginAnew) count_on(outputs);
  // The plant has measured before its first step, so that its state is older than its last step but not empty.
  else if (resume.index >= 0 || !resume.state.empty()) restore(resume.state);
  // The dead process's writers are gone, and with them their history. Readers that have not received it, or that start
  // later, receive it from the new writers.
  for (const auto& [topic, sample] : outputs) sink_.publish(*topic, sample);
  replay_early();
}

/// For a component that takes the place of another one: it begins anew, but the numbers of its samples go on.
void Member::count_on(const std::vector<std::pair<const TopicInfo*, Sample>>& outputs) {
  for (const auto& [topic, sample] : outputs) {
    for (auto& port : outputs_) {
      if (port->slot.topic->id == topic->id) port->count = std::max(port->count, sample.header->sequence_number);
    }
  }
}

std::string Member::state_bytes(std::string memory) const {
  BytesWriter archive(std::move(memory));
  for (const auto& input : inputs_) archive(*input);
  for (const auto& port : outputs_) archive(port->count);
  archive(output_hash_, end_requested_, component_->save());
  return archive.take();
}

void Member::restore(const std::string& state) {
  std::string component_state;
  try {
    BytesReader archive(state);
    for (auto& input : inputs_) archive(*input);
    for (auto& port : outputs_) archive(port->count);
    archive(output_hash_, end_requested_, component_state);
    component_->load(component_state);
  } catch (const cereal::Exception& error) {
    throw std::runtime_error("checkpoint of " + name() + ": " + error.what());
  }
  fresh_component_ = false;
  resumed_ = true;
}

}  // namespace constrictor
