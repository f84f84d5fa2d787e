// faulty_part PART OPTIONS: the project's control, perception, planner or camera with the fault that $CONSTRICTOR_FAULT
// names. Manifests of tests name it as the program of a part.
#include <cstdlib>
#include <string>

#include "runtime/component_main.hpp"
#include "runtime/host.hpp"
#include "support/faulty_cameras.hpp"
#include "support/faulty_controls.hpp"
#include "support/faulty_perceptions.hpp"
#include "support/faulty_planners.hpp"

int main(int argc, char** argv) {
  using namespace constrictor;
  const char* fault = std::getenv("CONSTRICTOR_FAULT");
  const std::string part = argc > 1 ? argv[1] : "";
  if (fault == nullptr) return exit_status::kUsage;
  if (part == "control") return component_main(argc, argv, testing::faulty_control(fault));
  if (part == "perception") return component_main(argc, argv, testing::faulty_perception(fault));
  if (part == "planner") return component_main(argc, argv, testing::faulty_planner(fault));
  if (part == "camera") return component_main(argc, argv, testing::faulty_camera(fault));
  return exit_status::kUsage;
}
