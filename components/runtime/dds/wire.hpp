// The barrier's values to and from their wire forms (idl/constrictor/barrier.idl).
#pragma once

#include <optional>
#include <string>

#include "runtime/barrier/protocol.hpp"
#include "runtime/dds/endpoint.hpp"

namespace constrictor::dds {

/// Names of the barrier's topics.
namespace barrier_topics {
inline constexpr const char* kTick = "barrier/tick";
inline constexpr const char* kTickDone = "barrier/tick_done";
inline constexpr const char* kHello = "barrier/hello";
inline constexpr const char* kReady = "barrier/ready";
inline constexpr const char* kEpochStart = "barrier/epoch_start";
inline constexpr const char* kResume = "barrier/resume";
inline constexpr const char* kRefused = "barrier/refused";
inline constexpr const char* kWaiting = "barrier/waiting";
inline constexpr const char* kStatus = "component_status";
inline constexpr const char* kRunControl = "run_control";
inline constexpr const char* kRunState = "run_state";
/// A restarted member with the longest period and latency must still find its tick.
inline constexpr int kTickDepth = 256;
}  // namespace barrier_topics

/// `block` keeps the bytes that the message points into.
msg::TickDone to_wire(const StepDone& done, std::string& block);
/// Empty if the checkpoint is damaged. Of a message that validate() accepts.
std::optional<StepDone> from_wire(const msg::TickDone& message);
msg::Hello to_wire(const Greeting& greeting, const std::string& version);
Greeting from_wire(const msg::Hello& message);
msg::Resume to_wire(const Resumption& resumption, std::string& block);
/// Empty if the checkpoint is damaged.
std::optional<Resumption> from_wire(const msg::Resume& message);

}  // namespace constrictor::dds
