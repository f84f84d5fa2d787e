#include "runtime/component_main.hpp"
#include "sim/overview/overview.hpp"

int main(int argc, char** argv) {
  return constrictor::component_main(argc, argv, constrictor::make_overview_factory());
}
