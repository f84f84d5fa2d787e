#include "runtime/wire.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "constrictor/hex.hpp"
#include "cyclone/run_token.hpp"

namespace constrictor {
namespace {

dds_sequence_octet borrow(std::string& block) {
  dds_sequence_octet sequence{};
  sequence._length = sequence._maximum = static_cast<std::uint32_t>(block.size());
  sequence._buffer = reinterpret_cast<std::uint8_t*>(block.data());
  sequence._release = false;
  return sequence;
}

/// Valid as long as the message.
std::string_view bytes_of(const dds_sequence_octet& sequence) {
  return {reinterpret_cast<const char*>(sequence._buffer), sequence._length};
}

// The common fields of both messages about a checkpoint: the component, its incarnation, the epoch and the last tick.
template <class Message, class Value>
Message identity_to_wire(const Value& value) {
  Message message{};
  set_text(message.component, value.component);
  message.run_id = value.epoch.run_id;
  message.epoch = value.epoch.epoch;
  message.incarnation = value.incarnation;
  message.index = value.index;
  return message;
}

template <class Value, class Message>
void identity_from_wire(const Message& message, Value& value) {
  value.component = message.component;
  value.epoch = {message.run_id, message.epoch};
  value.incarnation = message.incarnation;
  value.index = message.index;
}

}  // namespace

msg::TickDone to_wire(const TickDone& done, std::string& block) {
  auto message = identity_to_wire<msg::TickDone>(done);
  if (done.published.size() > std::size(message.published))
    throw std::logic_error(done.component + " writes too many topics");
  message.published_count = static_cast<std::uint8_t>(done.published.size());
  for (std::size_t i = 0; i < done.published.size(); ++i) {
    message.published[i] = {done.published[i].topic, done.published[i].count};
  }
  if (done.consumed.size() > std::size(message.consumed))
    throw std::logic_error(done.component + " reads too many topics");
  message.consumed_count = static_cast<std::uint8_t>(done.consumed.size());
  for (std::size_t i = 0; i < done.consumed.size(); ++i)
    message.consumed[i] = {done.consumed[i].topic, done.consumed[i].count};
  std::copy(done.output_hash.begin(), done.output_hash.end(), message.output_hash);
  message.end_of_run = done.end_of_run;
  message.checkpoint = borrow(block = pack_checkpoint(done.state, done.written, std::move(block)));
  return message;
}

std::optional<TickDone> from_wire(const msg::TickDone& message, TickDone memory) {
  TickDone done = std::move(memory);
  identity_from_wire(message, done);
  done.published.clear();
  done.consumed.clear();
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

std::string hello_proof(const std::string& token, const Hello& hello, const dds::GuidPrefix& participant) {
  return proof_of_token(
      token, fmt::format("hello\n{}\n{}\n{}\n{}", hello.run_id, hello.component, hello.incarnation, hex(participant)));
}

msg::Hello to_wire(const Hello& hello) {
  msg::Hello message{};
  set_text(message.component, hello.component);
  message.run_id = hello.run_id;
  message.incarnation = hello.incarnation;
  message.pid = hello.pid;
  set_text(message.host, hello.host);
  set_text(message.version, hello.release);
  set_text(message.idl_hash, hello.idl_hash);
  set_text(message.config_hash, hello.config_hash);
  set_text(message.component_hash, hello.component_hash);
  set_text(message.numeric_profile, hello.numeric_profile);
  message.period_ticks = hello.timing.period;
  message.latency_ticks = hello.timing.latency;
  message.reads = hello.reads.bits();
  message.writes = hello.writes.bits();
  set_text(message.proof, hello.proof);
  return message;
}

Hello from_wire(const msg::Hello& message) {
  Hello hello;
  hello.component = message.component;
  hello.run_id = message.run_id;
  hello.incarnation = message.incarnation;
  hello.pid = message.pid;
  hello.host = message.host;
  hello.release = message.version;
  hello.idl_hash = message.idl_hash;
  hello.config_hash = message.config_hash;
  hello.component_hash = message.component_hash;
  hello.numeric_profile = message.numeric_profile;
  hello.timing = {message.period_ticks, message.latency_ticks};
  hello.reads = TopicSet::from_bits(message.reads);
  hello.writes = TopicSet::from_bits(message.writes);
  hello.proof = message.proof;
  return hello;
}

msg::Resume to_wire(const Resume& resume, std::string& block) {
  auto message = identity_to_wire<msg::Resume>(resume);
  message.seed = resume.seed;
  message.checkpoint = borrow(block = pack_checkpoint(resume.state, resume.outputs, std::move(block)));
  return message;
}

std::optional<Resume> from_wire(const msg::Resume& message) {
  Resume resume;
  identity_from_wire(message, resume);
  resume.seed = message.seed;
  if (!unpack_checkpoint(bytes_of(message.checkpoint), resume.state, resume.outputs)) return {};
  return resume;
}

}  // namespace constrictor
