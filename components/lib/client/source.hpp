// Names and numbers by which `input` and the conductor distinguish clients and their messages.
#pragma once

#include <cstdint>
#include <string>

namespace constrictor {

/// A source name that no other process uses: "NAME.HOST.PID", with NAME and HOST cut so that a message can hold it.
std::string unique_source(const std::string& name);

/// The number before that of a client's first message: the time of day [us]. The numbers of a source must increase,
/// also if a later process uses the same source name.
std::uint64_t first_sequence_number();

}  // namespace constrictor
