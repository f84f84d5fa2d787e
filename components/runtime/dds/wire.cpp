#include "runtime/dds/wire.hpp"

#include <algorithm>
#include <stdexcept>

namespace constrictor::dds {
namespace {

dds_sequence_octet borrow(std::string& block) {
  dds_sequence_octet sequence{};
  sequence._length = sequence._maximum = static_cast<std::uint32_t>(block.size());
  sequence._buffer = reinterpret_cast<std::uint8_t*>(block.data());
  sequence._release = false;
  return sequence;
}

std::string bytes_of(const dds_sequence_octet& sequence) {
  return {reinterpret_cast<const char*>(sequence._buffer), sequence._length};
}

}  // namespace

msg::TickDone to_wire(const StepDone& done, std::string& block) {
  msg::TickDone message{};
  set_text(message.component, done.component);
  message.run_id = done.epoch.run_id;
  message.epoch = done.epoch.epoch;
  message.incarnation = done.incarnation;
  message.index = done.index;
  if (done.published.size() > std::size(message.published)) throw std::logic_error(done.component + " writes too many topics");
  message.published_count = static_cast<std::uint8_t>(done.published.size());
  for (std::size_t i = 0; i < done.published.size(); ++i) {
    message.published[i] = {done.published[i].topic, done.published[i].count};
  }
  if (done.consumed.size() > std::size(message.consumed)) throw std::logic_error(done.component + " reads too many topics");
  message.consumed_count = static_cast<std::uint8_t>(done.consumed.size());
  for (std::size_t i = 0; i < done.consumed.size(); ++i) message.consumed[i] = {done.consumed[i].topic, done.consumed[i].count};
  std::copy(done.output_hash.begin(), done.output_hash.end(), message.output_hash);
  message.end_of_run = done.end_of_run;
  block = pack_checkpoint(done.state, done.written);
  message.checkpoint = borrow(block);
  return message;
}

std::optional<StepDone> from_wire(const msg::TickDone& message) {
  StepDone done;
  done.component = message.component;
  done.epoch = {message.run_id, message.epoch};
  done.incarnation = message.incarnation;
  done.index = message.index;
  for (std::size_t i = 0; i < std::min<std::size_t>(message.published_count, std::size(message.published)); ++i) {
    done.published.push_back({message.published[i].topic, message.published[i].count});
  }
  for (std::size_t i = 0; i < std::min<std::size_t>(message.consumed_count, std::size(message.consumed)); ++i) {
    done.consumed.push_back({message.consumed[i].topic, message.consumed[i].count});
  }
  std::copy(std::begin(message.output_hash), std::end(message.output_hash), done.output_hash.begin());
  done.end_of_run = message.end_of_run;
  if (!unpack_checkpoint(bytes_of(message.checkpoint), done.state, done.written)) return {};
  return done;
}

msg::Hello to_wire(const Greeting& greeting, const std::string& version) {
  msg::Hello message{};
  set_text(message.component, greeting.component);
  message.run_id = greeting.run_id;
  message.incarnation = greeting.incarnation;
  message.pid = greeting.pid;
  set_text(message.host, greeting.host);
  set_text(message.version, version);
  set_text(message.idl_hash, greeting.idl_hash);
  set_text(message.config_hash, greeting.config_hash);
  set_text(message.component_hash, greeting.component_hash);
  set_text(message.numeric_profile, greeting.numeric_profile);
  message.period_ticks = greeting.timing.period;
  message.latency_ticks = greeting.timing.latency;
  message.reads = greeting.reads;
  message.writes = greeting.writes;
  return message;
}

Greeting from_wire(const msg::Hello& message) {
  Greeting greeting;
  greeting.component = message.component;
  greeting.run_id = message.run_id;
  greeting.incarnation = message.incarnation;
  greeting.pid = message.pid;
  greeting.host = message.host;
  greeting.idl_hash = message.idl_hash;
  greeting.config_hash = message.config_hash;
  greeting.component_hash = message.component_hash;
  greeting.numeric_profile = message.numeric_profile;
  greeting.timing = {message.period_ticks, message.latency_ticks};
  greeting.reads = message.reads;
  greeting.writes = message.writes;
  return greeting;
}

msg::Resume to_wire(const Resumption& resumption, std::string& block) {
  msg::Resume message{};
  set_text(message.component, resumption.component);
  message.run_id = resumption.epoch.run_id;
  message.epoch = resumption.epoch.epoch;
  message.incarnation = resumption.incarnation;
  message.index = resumption.index;
  message.seed = resumption.seed;
  block = pack_checkpoint(resumption.state, resumption.outputs);
  message.checkpoint = borrow(block);
  return message;
}

std::optional<Resumption> from_wire(const msg::Resume& message) {
  Resumption resumption;
  resumption.component = message.component;
  resumption.epoch = {message.run_id, message.epoch};
  resumption.incarnation = message.incarnation;
  resumption.index = message.index;
  resumption.seed = message.seed;
  if (!unpack_checkpoint(bytes_of(message.checkpoint), resumption.state, resumption.outputs)) return {};
  return resumption;
}

}  // namespace constrictor::dds
