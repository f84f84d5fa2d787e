#include "runtime/report_exception.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <exception>

#include "configuration/configuration.hpp"
#include "runtime/host.hpp"

namespace constrictor {

int report_exception(const std::string& program) {
  try {
    throw;
  } catch (const ConfigurationError& error) {
    fmt::print(stderr, "{}: configuration: {}\n", program, error.what());
    return exit_status::kConfiguration;
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}: {}\n", program, error.what());
    return exit_status::kSoftware;
  }
}

}  // namespace constrictor
