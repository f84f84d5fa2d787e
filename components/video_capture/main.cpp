#include <unistd.h>

#include <cstdio>

#include "runtime/component_main.hpp"
#include "video_capture/video_capture.hpp"

int main(int argc, char** argv) {
  const int status = constrictor::component_main(argc, argv, constrictor::make_video_capture_factory());
  std::fflush(nullptr);
  // A thread may still wait for a source that does not answer. The libraries must not be destroyed while it runs.
  ::_exit(status);
}
