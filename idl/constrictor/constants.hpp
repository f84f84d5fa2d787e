// Names of the constants in messages, as people and files write them: kTaskFollowLine is "follow_line".
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "constrictor/messages.hpp"

namespace constrictor {

/// name_of(constants::kColour, msg::kColourGreen) is "green". "?" if the group has no such value.
const char* name_of(const ConstantGroup& group, std::uint8_t value);

/// The name as words, for sentences: "object lost" for kEventObjectLost.
std::string words_of(const ConstantGroup& group, std::uint8_t value);

/// The inverse. Accepts upper case, and blanks or "-" for "_". Empty if the group has no such name.
std::optional<std::uint8_t> value_of(const ConstantGroup& group, std::string_view name);

/// All names from the value `first` on: names_of(constants::kColour, 1) leaves "unknown" out.
std::vector<std::string> names_of(const ConstantGroup& group, std::uint8_t first = 0);

/// The same, joined by commas, for messages to people.
std::string listed(const ConstantGroup& group, std::uint8_t first = 0);

}  // namespace constrictor
