#include "sim/world/ode_handles.hpp"

namespace constrictor {

void ensure_ode() {
  struct Library {
    Library() { dInitODE2(0); }
    ~Library() { dCloseODE(); }
    Library(const Library&) = delete;
    Library& operator=(const Library&) = delete;
  };
  static const Library library;
}

}  // namespace constrictor
