// Parts of ROS 2 messages that several translations share.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "constrictor/messages.hpp"
#include "constrictor/reflect.hpp"
#include "ros_types.h"

namespace constrictor::ros_bridge {

inline constexpr std::int64_t kSecond_ns = 1'000'000'000;

/// The message structs of idlc have char* members, but no code writes through them.
inline char* text(const char* literal) { return const_cast<char*>(literal); }
inline char* text(const std::string& name) { return const_cast<char*>(name.c_str()); }

inline builtin_interfaces_msg_dds__Time_ time_of(std::int64_t time_ns) {
  return {static_cast<std::int32_t>(time_ns / kSecond_ns), static_cast<std::uint32_t>(time_ns % kSecond_ns)};
}

inline std_msgs_msg_dds__Header_ header_of(std::int64_t time_ns, char* frame) { return {time_of(time_ns), frame}; }

/// The time of an exposure. The message of an image, or of what perception found in it, comes later.
inline std::int64_t exposure_ns(const msg::Header& header, std::int64_t exposure_tick) {
  return header.tick > 0 ? header.time_ns / header.tick * exposure_tick : 0;
}

inline geometry_msgs_msg_dds__Quaternion_ yaw_rotation(double yaw_rad) {
  return {0, 0, std::sin(0.5 * yaw_rad), std::cos(0.5 * yaw_rad)};
}

/// Lets a sequence of idlc point to the elements of a vector, which must live until the message is written.
template <class Sequence, class Element>
void borrow(Sequence& sequence, std::vector<Element>& elements) {
  sequence._length = sequence._maximum = static_cast<std::uint32_t>(elements.size());
  sequence._buffer = elements.data();
  sequence._release = false;
}

/// Whether a time of ROS 2, which has seconds of 32 bits, can express this time.
inline bool sayable(std::int64_t time_ns) {
  return time_ns >= 0 && time_ns / kSecond_ns <= std::numeric_limits<std::int32_t>::max();
}

/// The reason why the bridge cannot write this message in the form of ROS; empty: it can.
template <class T>
std::string broken(const T& message) {
  if (auto violation = validate(message)) return *std::move(violation);
  return sayable(message.header.time_ns)
             ? ""
             : "header.time_ns: found " + std::to_string(message.header.time_ns) + ", accepted a time of ROS";
}

/// The same for a message that follows from an image.
template <class T>
std::string broken_exposure(const T& message) {
  std::string reason = broken(message);
  if (reason.empty() && (message.exposure_tick < 0 || message.exposure_tick > message.header.tick))
    reason =
        "exposure_tick: found " + std::to_string(message.exposure_tick) + ", accepted 0 to the tick of the message";
  return reason;
}

}  // namespace constrictor::ros_bridge
