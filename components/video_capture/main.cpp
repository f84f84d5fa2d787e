#include <unistd.h>

#include <cstdio>
#include <string_view>

#include "runtime/component_main.hpp"
#include "runtime/numeric_profile.hpp"
#include "video_capture/video_capture.hpp"

int main(int argc, char** argv) {
  constrictor::ensure_numeric_environment(argv);  // may start the program again, which needs all arguments
  // A manifest that names a program gives it the names of its components first.
  const bool named = argc > 1 && std::string_view(argv[1]) == "camera";
  const int status = constrictor::component_main(argc - (named ? 1 : 0), argv + (named ? 1 : 0),
                                                 constrictor::make_video_capture_factory());
  std::fflush(nullptr);
  // A thread may still wait for a source that does not answer. It must not meet destructors of the libraries.
  ::_exit(status);
}
