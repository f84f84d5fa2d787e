// Requests for the tests of `input`.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>

#include "component/client_requests.hpp"
#include "constrictor/messages.hpp"

namespace constrictor {

inline msg::Request request(const std::string& source, std::uint8_t level, std::uint8_t kind, std::uint64_t sequence,
                            std::uint64_t goal = 1) {
  msg::Request r{};
  std::copy(source.begin(), source.end(), r.source);
  r.level = level;
  r.kind = kind;
  r.header.sequence_number = sequence;
  r.goal_id = goal;
  r.task = msg::kTaskFollowLine;
  r.parameters.line_colour = msg::kColourBlue;
  return r;
}

inline WriterId writer(std::uint8_t number) {
  WriterId id{};
  id[0] = number;
  return id;
}

inline constexpr auto kPlanner = msg::kAuthorityPlanner;
inline constexpr auto kExternal = msg::kAuthorityExternal;
inline constexpr auto kOperator = msg::kAuthorityOperator;

}  // namespace constrictor
