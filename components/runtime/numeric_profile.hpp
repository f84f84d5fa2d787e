// One numeric environment for every process: libm, OpenCV and llvmpipe otherwise choose code by the CPU they find.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace constrictor {

/// Environment variables, with the values every process of a run must have.
const std::vector<std::pair<std::string, std::string>>& numeric_environment();

/// Sets what is missing and, if anything was, starts this program anew with it (libraries read these variables when they are
/// loaded). A variable that is set to something else is left alone: the profile then differs and the run refuses the process.
void ensure_numeric_environment(char** argv);

/// The profile in force: the values of the variables (glibc's aside, which counts by its effect) and a fingerprint of what libm computes on fixed inputs. Two processes with
/// equal profiles compute equal numbers.
std::string numeric_profile();

}  // namespace constrictor
