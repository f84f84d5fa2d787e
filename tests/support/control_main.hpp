// The main function of programs that take the place of `control` in a run.
#pragma once

#include <string>
#include <utility>

#include "component/component.hpp"
#include "runtime/component_main.hpp"
#include "runtime/numeric_profile.hpp"

namespace constrictor::testing {

/// Hosts this component as the program that a manifest names for `control`. Returns the exit status.
inline int control_main(int argc, char** argv, ComponentFactory factory) {
  ensure_numeric_environment(argv);  // may start the program again, which needs all arguments
  if (argc > 1 && std::string(argv[1]) == "control") {
    --argc;  // the launcher passes the names of the components as the first argument
    ++argv;
  }
  return component_main(argc, argv, std::move(factory));
}

}  // namespace constrictor::testing
