// Numbers of things, for people.
#pragma once

#include <cstdint>
#include <string>

namespace constrictor {

/// "1 process", "2 processes". `plural`: of a noun whose plural does more than add an s.
inline std::string counted(std::uint64_t count, const std::string& noun, const std::string& plural = {}) {
  return std::to_string(count) + " " + (count == 1 ? noun : plural.empty() ? noun + "s" : plural);
}

}  // namespace constrictor
