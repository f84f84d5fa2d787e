// The events at the buses, for people.
#pragma once

#include <string>

namespace constrictor {

/// An event at a bus: a servo is lost, a port is back.
struct BusNews {
  std::string text;
  bool is_good = false;  ///< a trouble is over
};

}  // namespace constrictor
