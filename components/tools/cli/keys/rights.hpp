// The least rights of each process of a run, as documents of DDS Security.
#pragma once

#include <set>
#include <string>
#include <vector>

namespace constrictor::cli {

/// Names of DDS topics.
struct Rights {
  std::set<std::string> publish;
  std::set<std::string> subscribe;
};

/// The rights of a process that hosts these components. `lines` is what the processes print with --topics: "reads
/// TOPIC" and "writes TOPIC". `conducts`: the plant is among the components. Throws std::runtime_error if a line has
/// another form.
[[nodiscard]] Rights rights_of_member(const std::vector<std::string>& lines, bool conducts);
/// The rights of `constrictor` and of teleoperation: they read everything, send requests and command the run.
[[nodiscard]] Rights rights_of_operator();
/// The rights of external planners and bridges: they read what the robot's components publish, and send requests.
[[nodiscard]] Rights rights_of_client();
/// The rights of programs that only read.
[[nodiscard]] Rights rights_of_observer();

/// The permissions of one identity for the domains 0 to 229, for `days` from yesterday on. Not signed yet.
[[nodiscard]] std::string permissions_document(const std::string& subject, const Rights& rights, int days);
/// The rules of every domain: all participants are authenticated, everything is encrypted, and each topic needs a
/// right.
[[nodiscard]] std::string governance_document();

}  // namespace constrictor::cli
