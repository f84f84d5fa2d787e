#include "component/task_parameters.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "configuration/counted.hpp"
#include "constrictor/constants.hpp"

namespace constrictor {
namespace {

enum class Need { kLineColour, kObjectColour, kDropZoneColour, kDirection, kLeftOrRight, kSideIfAny, kPath };

struct Row {
  std::uint8_t task;
  Need need;
};

/// One row for each parameter that a task needs or checks. A task without a row needs none.
constexpr std::array kNeeds = {
    Row{msg::kTaskFollowLine, Need::kLineColour},    Row{msg::kTaskSearchObject, Need::kObjectColour},
    Row{msg::kTaskTrackObject, Need::kObjectColour}, Row{msg::kTaskPregrasp, Need::kObjectColour},
    Row{msg::kTaskDrop, Need::kDropZoneColour},      Row{msg::kTaskRotate, Need::kLeftOrRight},
    Row{msg::kTaskExplore, Need::kDirection},        Row{msg::kTaskFollowPath, Need::kPath},
    Row{msg::kTaskPregrasp, Need::kSideIfAny},
};

std::string colour_problem(const char* what, std::uint8_t colour) {
  if (colour != msg::kColourUnknown && colour < msg::kColourCount) return {};
  return fmt::format("{} colour: found {}, accepted {}", what,
                     colour == msg::kColourUnknown ? "none" : name_of(constants::kColour, colour),
                     listed(constants::kColour, msg::kColourGreen));
}

std::string direction_problem(std::uint8_t direction, bool left_or_right) {
  const bool turns = direction == msg::kDirectionLeft || direction == msg::kDirectionRight;
  const bool any = direction != msg::kDirectionNone && direction < msg::kDirectionCount;
  if (turns || (any && !left_or_right)) return {};
  return fmt::format("a direction: found {}, accepted {}", name_of(constants::kDirection, direction),
                     left_or_right ? "left or right" : "left, right, forwards or backwards");
}

std::string path_problem(const msg::Path& path) {
  constexpr double kShortest_m = 1e-3;
  if (const std::string size = path_size_refusal(path.point_count); !size.empty()) return "a path: " + size;
  for (std::size_t i = 1; i < path.point_count; ++i) {
    const double apart_m = std::hypot(path.x_m[i] - path.x_m[i - 1], path.y_m[i] - path.y_m[i - 1]);
    if (!std::isfinite(apart_m) || apart_m <= kShortest_m) {
      return fmt::format("a path: found point {} at the place of the point before, accepted at least 1 mm apart",
                         i + 1);
    }
  }
  return {};
}

std::string problem(Need need, const msg::TaskParameters& parameters, const msg::Path& path) {
  switch (need) {
    case Need::kLineColour:
      return colour_problem("a line", parameters.line_colour);
    case Need::kObjectColour:
      return colour_problem("an object", parameters.object_colour);
    case Need::kDropZoneColour:
      return colour_problem("a drop zone", parameters.drop_zone_colour);
    case Need::kDirection:
      return direction_problem(parameters.direction, false);
    case Need::kLeftOrRight:
      return direction_problem(parameters.direction, true);
    case Need::kSideIfAny:
      return parameters.direction == msg::kDirectionNone ? std::string{}
                                                         : direction_problem(parameters.direction, true);
    case Need::kPath:
      return path_problem(path);
  }
  return {};
}

TaskParameter parameter_of(Need need) {
  const auto colours = names_of(constants::kColour, msg::kColourGreen);
  const std::vector<std::string> sides = {name_of(constants::kDirection, msg::kDirectionLeft),
                                          name_of(constants::kDirection, msg::kDirectionRight)};
  switch (need) {
    case Need::kLineColour:
      return {"line_colour", colours};
    case Need::kObjectColour:
      return {"object_colour", colours};
    case Need::kDropZoneColour:
      return {"drop_zone_colour", colours};
    case Need::kDirection:
      return {"direction", names_of(constants::kDirection, msg::kDirectionNone + 1)};
    case Need::kLeftOrRight:
      return {"direction", sides};
    case Need::kSideIfAny:
      return {"direction", sides, true};
    case Need::kPath:
      return {"path", {}};
  }
  return {};
}

}  // namespace

std::string path_size_refusal(std::size_t points) {
  constexpr std::size_t kFewest = 2, kMost = msg::kMaxPathPoints;
  if (points >= kFewest && points <= kMost) return {};
  return fmt::format("found {}, accepted {} to {}", counted(points, "point"), kFewest, kMost);
}

std::string path_refusal(std::uint8_t task, const msg::Path& path) {
  if (task == msg::kTaskFollowPath) return task_parameter_refusal(task, {}, path);  // it needs nothing else
  return path.point_count > 0 ? "path: accepted with follow_path only" : "";
}

std::string request_refusal(const msg::Request& request) {
  const std::string path = path_refusal(request.task, request.path);
  return path.empty() ? task_parameter_refusal(request.task, request.parameters, request.path) : path;
}

std::vector<TaskParameter> task_parameters_of(std::uint8_t task) {
  std::vector<TaskParameter> parameters;
  for (const Row& row : kNeeds) {
    if (row.task == task) parameters.push_back(parameter_of(row.need));
  }
  return parameters;
}

std::string task_parameter_refusal(std::uint8_t task, const msg::TaskParameters& parameters, const msg::Path& path) {
  if (task == msg::kTaskNone || task >= msg::kTaskCount)
    return fmt::format("task: found {}, accepted 1 to {}", task, msg::kTaskCount - 1);
  for (const Row& row : kNeeds) {
    if (row.task != task) continue;
    const std::string missing = problem(row.need, parameters, path);
    if (!missing.empty()) return fmt::format("{} needs {}", name_of(constants::kTask, task), missing);
  }
  return {};
}

}  // namespace constrictor
