// Names of the constants in messages, as the paper and the report spell them.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "constrictor/messages.hpp"

namespace constrictor::report {

template <std::size_t kSize>
std::string name_in(const std::array<const char*, kSize>& names, std::uint8_t value) {
  return value < kSize ? names[value] : "unknown";
}

inline std::string colour_name(std::uint8_t colour) {
  static constexpr std::array<const char*, msg::kColourCount> kNames{"unknown", "green", "red", "blue", "yellow"};
  return name_in(kNames, colour);
}

inline std::string task_name(std::uint8_t task) {
  static constexpr std::array<const char*, msg::kTaskCount> kNames{
      "none", "follow_line", "search_object", "track_object", "pregrasp", "grasp", "drop", "rotate", "explore", "follow_path"};
  return name_in(kNames, task);
}

inline std::string event_name(std::uint8_t event) {
  static constexpr std::array<const char*, msg::kEventCount> kNames{
      "none", "line_found", "line_lost", "end_of_line", "object_found", "object_lost", "object_reached", "object_pregrasped",
      "object_pregrasp_lost", "object_grasped", "object_grasp_lost", "dropping_done", "timeout"};
  return name_in(kNames, event);
}

inline std::string goal_state_name(std::uint8_t state) {
  static constexpr std::array<const char*, 7> kNames{"idle", "running", "succeeded", "aborted", "preempted", "cancelled", "refused"};
  return name_in(kNames, state);
}

}  // namespace constrictor::report
