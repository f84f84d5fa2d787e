#include "cli/task_names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <sstream>

namespace constrictor::cli {
namespace {

constexpr std::array<const char*, msg::kTaskCount> kTasks = {"none",     "follow_line", "search_object", "track_object", "pregrasp",
                                                             "grasp",    "drop",        "rotate",        "explore",      "follow_path"};
constexpr std::array<const char*, msg::kEventCount> kEvents = {
    "none", "line found", "line lost", "end of line", "object found", "object lost", "object reached", "object pregrasped",
    "object pregrasp lost", "object grasped", "object grasp lost", "dropping done", "timeout"};
constexpr std::array<const char*, 7> kGoalStates = {"idle", "running", "succeeded", "aborted", "preempted", "cancelled", "refused"};
constexpr std::array<const char*, 5> kLevels = {"nobody", "planner", "external", "operator", "EMERGENCY STOP"};
constexpr std::array<const char*, msg::kColourCount> kColours = {"unknown", "green", "red", "blue", "yellow"};
constexpr std::array<const char*, msg::kDirectionCount> kDirections = {"none", "left", "right", "forwards", "backwards"};

std::string plain(std::string text) {
  for (char& c : text) c = c == '-' || c == ' ' ? '_' : static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

template <std::size_t N>
std::optional<std::uint8_t> index_of(const std::array<const char*, N>& names, const std::string& name) {
  const auto found = std::find_if(names.begin(), names.end(), [&](const char* n) { return plain(n) == plain(name); });
  if (found == names.end()) return std::nullopt;
  return static_cast<std::uint8_t>(found - names.begin());
}

template <std::size_t N>
const char* at(const std::array<const char*, N>& names, std::uint8_t index) {
  return index < N ? names[index] : "?";
}

template <std::size_t N>
std::string all(const std::array<const char*, N>& names) {
  return fmt::format("{}", fmt::join(names.begin() + 1, names.end(), ", "));
}

template <std::size_t N>
std::string wrong(const std::string& key, const std::string& value, const std::array<const char*, N>& names) {
  return fmt::format("{}: found '{}', accepted {}", key, value, all(names));
}

}  // namespace

const char* task_word(std::uint8_t task) { return at(kTasks, task); }
const char* event_name(std::uint8_t event) { return at(kEvents, event); }
const char* goal_state_name(std::uint8_t state) { return at(kGoalStates, state); }
const char* authority_name(std::uint8_t level) { return at(kLevels, level); }

std::string task_words() { return all(kTasks); }
std::string event_words() { return all(kEvents); }
std::string colour_words() { return all(kColours); }
std::string direction_words() { return all(kDirections); }

std::optional<std::uint8_t> task_by_name(const std::string& name) {
  const auto task = index_of(kTasks, name);
  return task == msg::kTaskNone ? std::nullopt : task;
}

std::optional<std::uint8_t> event_by_name(const std::string& name) {
  const auto event = index_of(kEvents, name);
  return event == msg::kEventNone ? std::nullopt : event;
}

std::string set_task_parameter(msg::TaskParameters& parameters, const std::string& key, const std::string& value) {
  const std::string name = plain(key);
  const auto colour = index_of(kColours, value);
  if (name == "line_colour" || name == "object_colour" || name == "drop_zone_colour") {
    if (!colour) return wrong(key, value, kColours);
    (name == "line_colour" ? parameters.line_colour : name == "object_colour" ? parameters.object_colour : parameters.drop_zone_colour) = *colour;
    return {};
  }
  if (name == "direction") {
    const auto direction = index_of(kDirections, value);
    if (!direction) return wrong(key, value, kDirections);
    parameters.direction = *direction;
    return {};
  }
  std::istringstream stream(value);
  if (name == "object_handle") {
    std::uint16_t handle = 0;
    if (!(stream >> handle) || !stream.eof()) return fmt::format("{}: found '{}', accepted 0 to 65535", key, value);
    parameters.object_handle = handle;
    return {};
  }
  if (name == "timeout_s") {
    double timeout_s = 0.0;
    if (!(stream >> timeout_s) || !stream.eof() || !(timeout_s > 0.0 && timeout_s <= 3600.0)) {
      return fmt::format("{}: found '{}', accepted seconds up to 3600", key, value);
    }
    parameters.timeout_s = timeout_s;
    return {};
  }
  return fmt::format("parameter: found '{}', accepted line_colour, object_colour, object_handle, drop_zone_colour, direction, timeout_s, path", key);
}

std::string set_path(msg::Path& path, const std::vector<std::string>& points) {
  path = {};
  if (points.empty()) return {};
  if (points.size() < 2 || points.size() > msg::kMaxPathPoints) {
    return fmt::format("path: found {} point{}, accepted 2 to {}", points.size(), points.size() == 1 ? "" : "s", msg::kMaxPathPoints);
  }
  for (const auto& point : points) {
    double x_m = 0.0;
    double y_m = 0.0;
    char rest = 0;
    if (std::sscanf(point.c_str(), "%lf,%lf%c", &x_m, &y_m, &rest) != 2 || !std::isfinite(x_m) || !std::isfinite(y_m)) {
      return fmt::format("path: found '{}', accepted points X,Y in m, as 1.5,-0.2", point);
    }
    path.x_m[path.point_count] = x_m;
    path.y_m[path.point_count] = y_m;
    ++path.point_count;
  }
  return {};
}

std::string parse_task(const std::string& line, std::uint8_t& task, msg::TaskParameters& parameters, msg::Path& path) {
  std::istringstream words(line);
  std::string word;
  if (!(words >> word)) return wrong("task", "nothing", kTasks);
  const auto found = task_by_name(word);
  if (!found) return wrong("task", word, kTasks);
  task = *found;
  path = {};
  while (words >> word) {
    const auto equals = word.find('=');
    if (equals == std::string::npos) return fmt::format("parameter: found '{}', accepted NAME=VALUE", word);
    const std::string key = word.substr(0, equals);
    std::string problem;
    if (plain(key) == "path") {
      std::vector<std::string> points;
      std::istringstream list(word.substr(equals + 1));
      for (std::string point; std::getline(list, point, ';');) points.push_back(point);
      problem = points.empty() ? "path: found nothing, accepted X,Y;X,Y" : set_path(path, points);
    } else {
      problem = set_task_parameter(parameters, key, word.substr(equals + 1));
    }
    if (!problem.empty()) return problem;
  }
  if ((task == msg::kTaskFollowPath) != (path.point_count > 0)) {
    return task == msg::kTaskFollowPath ? "follow_path: found no path, accepted path=X,Y;X,Y (2 to 64 points in m)" : "path: accepted with follow_path only";
  }
  return {};
}

}  // namespace constrictor::cli
