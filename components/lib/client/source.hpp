// Names and numbers by which `input` and the conductor distinguish clients and their messages.
#pragma once

#include <cstdint>
#include <string>

namespace constrictor {

/// A source name that no other process uses: "NAME.HOST.PID", with NAME and HOST cut so that a message can hold it.
std::string unique_source(const std::string& name);

/// The number before a client's first message: the time of day [us]. Numbers of a source must rise, also from one
/// process to a later process with the same source name.
std::uint64_t first_sequence_number();

}  // namespace constrictor
