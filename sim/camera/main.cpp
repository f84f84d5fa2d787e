#include "runtime/component_main.hpp"
#include "sim/camera/camera.hpp"

int main(int argc, char** argv) { return constrictor::component_main(argc, argv, constrictor::make_camera_factory()); }
