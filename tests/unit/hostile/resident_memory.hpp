// Memory use of the test's own process.
#pragma once

#include <unistd.h>

#include <fstream>

namespace constrictor::testing {

/// [MiB] resident memory of this process.
inline double resident_mib() {
  std::ifstream file("/proc/self/statm");
  long size = 0;
  long resident = 0;
  file >> size >> resident;
  return static_cast<double>(resident) * static_cast<double>(::sysconf(_SC_PAGESIZE)) / 1048576.0;
}

}  // namespace constrictor::testing
