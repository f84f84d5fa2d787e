// Draws a frame of the busy scene, and writes its RGB bytes to the file that is named on the command line. The
// environment decides how Mesa compiles the shaders.
#include <fstream>
#include <iostream>
#include <vector>

#include "unit/render/busy_scene.hpp"

int main(int argc, char** argv) {
  using namespace constrictor;
  if (argc != 2) {
    std::cerr << "usage: draw_frame FILE\n";
    return 2;
  }
  Renderer renderer(testing::busy_scene(), {});
  const std::vector<std::uint8_t>& rgb = renderer.draw(testing::busy_poses(), testing::scene_camera(), {});
  std::ofstream file(argv[1], std::ios::binary);
  file.write(reinterpret_cast<const char*>(rgb.data()), static_cast<std::streamsize>(rgb.size()));
  return file.good() ? 0 : 1;
}
