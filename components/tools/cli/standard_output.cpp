#include "cli/standard_output.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <iostream>
#include <stdexcept>

namespace constrictor::cli {

void write_standard_output(std::string_view text) {
  errno = 0;
  std::cout << text << std::flush;
  if (std::cout && std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return;
  throw std::runtime_error(fmt::format("cannot write the standard output: {}",
                                       errno != 0 ? ::strerrordesc_np(errno) : "some of it is missing"));
}

}  // namespace constrictor::cli
