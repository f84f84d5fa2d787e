#include "runtime/component_main.hpp"
#include "sim/physics/physics.hpp"

int main(int argc, char** argv) { return constrictor::component_main(argc, argv, constrictor::make_physics_factory()); }
