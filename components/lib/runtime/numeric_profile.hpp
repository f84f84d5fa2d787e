// One numeric environment for every process. Without it, libm, OpenCV and llvmpipe choose code by the host's CPU, and
// results differ in their last bits.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace constrictor {

/// Environment variables with the values that every process of a run must have.
const std::vector<std::pair<std::string, std::string>>& numeric_environment();

/// Sets the variables that are missing. If any was missing, starts this program again, because libraries read the
/// variables when they are loaded. A variable with another value is not changed: the profile then differs, and the
/// conductor refuses the process.
void ensure_numeric_environment(char** argv);

/// The profile in force: the values of the variables except glibc's, and a fingerprint of libm's results for fixed
/// inputs. Two processes with equal profiles compute equal numbers.
std::string numeric_profile();

}  // namespace constrictor
