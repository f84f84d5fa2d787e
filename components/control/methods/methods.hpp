// The built-in control methods; each is described in its own file.
#pragma once

#include <memory>

#include "control/control_method.hpp"

namespace constrictor {

std::unique_ptr<ControlMethod> make_hold();
std::unique_ptr<ControlMethod> make_relax();
std::unique_ptr<ControlMethod> make_undulation();
std::unique_ptr<ControlMethod> make_bend();
std::unique_ptr<ControlMethod> make_wrap();
std::unique_ptr<ControlMethod> make_squeeze();

}  // namespace constrictor
