#include "guidance/guidance.hpp"
#include "runtime/component_main.hpp"

int main(int argc, char** argv) {
  return constrictor::component_main(argc, argv, constrictor::make_guidance_factory());
}
