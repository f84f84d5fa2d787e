// The parameters that each task needs, independently of percepts and of a held object. `input` checks them before a
// request takes authority, navigation before it starts a goal, and clients may check them before they send a request.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "constrictor/messages.hpp"

namespace constrictor {

/// Why a task of this kind cannot start with these parameters: a text for people that names what was found and what is
/// accepted. Empty if the parameters are complete. Navigation decides whether the robot can do the task at present.
[[nodiscard]] std::string task_parameter_refusal(std::uint8_t task, const msg::TaskParameters& parameters,
                                                 const msg::Path& path);

/// Why a path cannot have so many points: "found 1 point, accepted 2 to 64". Empty if it can.
[[nodiscard]] std::string path_size_refusal(std::size_t points);

/// For clients whose users write the request: why this task cannot have this path, because it needs another one or
/// follows none. Empty if it can. `input` ignores the path of a task that follows none.
[[nodiscard]] std::string path_refusal(std::uint8_t task, const msg::Path& path);

/// For the same clients: why the task of this request cannot start with its path and its parameters. Empty if it can.
[[nodiscard]] std::string request_refusal(const msg::Request& request);

/// A parameter that a task needs or uses, for programs that ask people for it.
struct TaskParameter {
  std::string name;                 ///< of set_task_parameter(), or "path"
  std::vector<std::string> values;  ///< the accepted names; empty: points
  bool optional = false;
};

/// The parameters that task_parameter_refusal() checks for this task.
[[nodiscard]] std::vector<TaskParameter> task_parameters_of(std::uint8_t task);

}  // namespace constrictor
