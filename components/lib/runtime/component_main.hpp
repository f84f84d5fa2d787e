// main() of a component's program, and of programs that host several components.
#pragma once

#include <vector>

#include "component/component.hpp"
#include "scheduling/scheduling.hpp"

namespace constrictor {

/// Parses arguments, builds and hosts one component. The name of the component may come before the options, as the
/// launcher writes it for a program of a manifest. `usual`: the scheduling of the process, unless its arguments say
/// otherwise. Returns the exit status; see exit_status in host.hpp.
int component_main(int argc, char** argv, ComponentFactory factory, const Scheduling& usual = {});

/// The same for several components in one process.
int host_main(int argc, char** argv, std::vector<ComponentFactory> factories, Scheduling usual = {});

}  // namespace constrictor
