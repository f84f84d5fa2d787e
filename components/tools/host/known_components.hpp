// The components that this program can host.
#pragma once

#include <map>
#include <string>

#include "component/component.hpp"

namespace constrictor {

/// Makers of all components of this build, by name.
const std::map<std::string, ComponentFactory (*)()>& known_components();

}  // namespace constrictor
