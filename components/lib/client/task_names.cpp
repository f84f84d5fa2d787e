#include "client/task_names.hpp"

#include <fmt/format.h>

#include <cctype>
#include <cmath>
#include <cstdio>
#include <sstream>

#include "component/task_parameters.hpp"
#include "configuration/closest_name.hpp"
#include "constrictor/constants.hpp"

namespace constrictor {
namespace {

std::string plain(std::string text) {
  for (char& c : text) c = c == '-' || c == ' ' ? '_' : static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

std::string wrong(const std::string& key, const std::string& value, const ConstantGroup& group) {
  return fmt::format("{}: found '{}', accepted {}", key, value, listed(group, 1)) +
         did_you_mean(plain(value), names_of(group, 1));
}

/// The value of a name. The first name of a group means "none" and is not accepted.
std::optional<std::uint8_t> chosen(const ConstantGroup& group, const std::string& name) {
  const auto value = value_of(group, name);
  return value == 0 ? std::nullopt : value;
}

}  // namespace

const char* task_word(std::uint8_t task) { return name_of(constants::kTask, task); }
const char* event_name(std::uint8_t event) { return name_of(constants::kEvent, event); }
const char* goal_state_name(std::uint8_t state) { return name_of(constants::kGoal, state); }
const char* authority_name(std::uint8_t level) {
  return level == msg::kAuthorityEmergencyStop ? "EMERGENCY STOP" : name_of(constants::kAuthority, level);
}

std::string task_words() { return listed(constants::kTask, 1); }
std::string event_words() { return listed(constants::kEvent, 1); }
std::string colour_words() { return listed(constants::kColour, 1); }
std::string direction_words() { return listed(constants::kDirection, 1); }

std::optional<std::uint8_t> task_by_name(const std::string& name) { return chosen(constants::kTask, name); }
std::optional<std::uint8_t> event_by_name(const std::string& name) { return chosen(constants::kEvent, name); }

std::string TaskNumber::accepted() const { return fmt::format("{} up to {:g}", unit, info.max); }

std::span<const TaskNumber> task_numbers() {
  using Fields = Description<msg::TaskParameters>;
  static constexpr TaskNumber kNumbers[] = {{Fields::k_timeout_s, "seconds", &msg::TaskParameters::timeout_s},
                                            {Fields::k_clearance_m, "metres", &msg::TaskParameters::clearance_m},
                                            {Fields::k_wrap_scale, "numbers", &msg::TaskParameters::wrap_scale}};
  return kNumbers;
}

std::string set_task_parameter(msg::TaskParameters& parameters, const std::string& key, const std::string& value) {
  const std::string name = plain(key);
  const auto colour = value_of(constants::kColour, value);
  if (name == "line_colour" || name == "object_colour" || name == "drop_zone_colour") {
    if (!colour) return wrong(key, value, constants::kColour);
    (name == "line_colour"     ? parameters.line_colour
     : name == "object_colour" ? parameters.object_colour
                               : parameters.drop_zone_colour) = *colour;
    return {};
  }
  if (name == "direction") {
    const auto direction = value_of(constants::kDirection, value);
    if (!direction) return wrong(key, value, constants::kDirection);
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
  for (const TaskNumber& row : task_numbers()) {
    if (name != row.info.name) continue;
    double number = 0.0;
    if (!(stream >> number) || !stream.eof() || !row.accepts(number))
      return fmt::format("{}: found '{}', accepted {}", key, value, row.accepted());
    parameters.*row.field = number;
    return {};
  }
  std::vector<std::string> accepted;
  Description<msg::TaskParameters>::visit(
      parameters, [&accepted](const FieldInfo& info, const auto&) { accepted.emplace_back(info.name); });
  accepted.emplace_back("path");
  return fmt::format("parameter: found '{}', accepted {}{}", key, fmt::join(accepted, ", "),
                     did_you_mean(name, accepted));
}

std::string set_path(msg::Path& path, const std::vector<std::string>& points) {
  path = {};
  if (points.empty()) return {};
  if (const std::string size = path_size_refusal(points.size()); !size.empty()) return "path: " + size;
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
  if (!(words >> word)) return wrong("task", "nothing", constants::kTask);
  const auto found = task_by_name(word);
  if (!found) return wrong("task", word, constants::kTask);
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
  const std::string refusal = path_refusal(task, path);
  return refusal.empty() || path.point_count > 0 ? refusal : refusal + " (path=X,Y;X,Y in m)";
}

}  // namespace constrictor
