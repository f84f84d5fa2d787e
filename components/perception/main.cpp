#include "perception/perception.hpp"
#include "runtime/component_main.hpp"

int main(int argc, char** argv) {
  return constrictor::component_main(argc, argv, constrictor::make_perception_factory());
}
