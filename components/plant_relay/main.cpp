#include "plant_relay/plant_relay.hpp"
#include "runtime/component_main.hpp"

int main(int argc, char** argv) {
  return constrictor::component_main(argc, argv, constrictor::make_plant_relay_factory());
}
