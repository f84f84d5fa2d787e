// main() of a component's executable, and of anything that hosts several.
#pragma once

#include <vector>

#include "runtime/component.hpp"

namespace constrictor {

/// Parses arguments, builds and hosts one component. Returns the exit status; see exit_status in host.hpp.
int component_main(int argc, char** argv, ComponentFactory factory);

/// The same for any set of components in one process.
int host_main(int argc, char** argv, std::vector<ComponentFactory> factories);

}  // namespace constrictor
