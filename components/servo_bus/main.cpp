#include "runtime/component_main.hpp"
#include "servo_bus/servo_bus.hpp"

int main(int argc, char** argv) {
  // Servos stop when they hear nothing for a while, and on a busy computer a usual process may wait longer than that.
  // The priority is above that of all usual processes, and below those of emulated servos and of interrupts.
  constexpr int kPriority = 5;
  return constrictor::component_main(argc, argv, constrictor::make_servo_bus_factory(), {kPriority, false, {}});
}
