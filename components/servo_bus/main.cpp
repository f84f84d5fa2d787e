#include "runtime/component_main.hpp"
#include "servo_bus/servo_bus.hpp"

int main(int argc, char** argv) {
  return constrictor::component_main(argc, argv, constrictor::make_servo_bus_factory());
}
