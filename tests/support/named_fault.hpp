// A fault that is planted in a part, and the check that must name it.
#pragma once

namespace constrictor::testing {

struct NamedFault {
  const char* fault;
  const char* check;  ///< the first one that fails
  const char* found;  ///< a part of what it says
};

}  // namespace constrictor::testing
