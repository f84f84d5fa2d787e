// The allowed dependencies between folders, checked by #include lines, by names of ground truth, and by linker symbols.
//
//   idl <- runtime <- mains        robot, configuration <- component logic <- mains
//   Component logic sees ports, topics and messages only: no DDS, no clock, no simulation, no other component.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace constrictor::test {

/// Every violation in the source tree `root`, as "components/x/y.cpp:12: why".
std::vector<std::string> source_violations(const std::filesystem::path& root);

/// Every violation in what the static library `name` (e.g. "libconstrictor_control.a") needs from elsewhere, given the
/// output of `nm -u`.
std::vector<std::string> symbol_violations(const std::string& name, const std::string& nm_output);

}  // namespace constrictor::test
