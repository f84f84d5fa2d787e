#include <unistd.h>

#include <cstdio>
#include <string_view>

#include "runtime/component_main.hpp"
#include "runtime/host.hpp"
#include "runtime/numeric_profile.hpp"
#include "video_capture/video_capture.hpp"

int main(int argc, char** argv) {
  constrictor::ensure_numeric_environment(argv);  // may start the program again, which needs all arguments
  // A manifest that names a program gives it the names of its components first.
  const std::string_view names = argc > 1 && argv[1][0] != '-' ? argv[1] : "";
  if (!names.empty() && names != "camera") {
    std::fprintf(stderr,
                 "video_capture: found the components %s, accepted camera: the program hosts nothing else; leave out "
                 "--in-process, and --group with camera\n",
                 argv[1]);
    return constrictor::exit_status::kConfiguration;
  }
  const int skipped = names.empty() ? 0 : 1;
  const int status =
      constrictor::component_main(argc - skipped, argv + skipped, constrictor::make_video_capture_factory());
  std::fflush(nullptr);
  // A thread may still wait for a source that does not answer. The libraries must not be destroyed while it runs.
  ::_exit(status);
}
