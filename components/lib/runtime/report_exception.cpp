#include "runtime/report_exception.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <filesystem>

#include "configuration/configuration.hpp"
#include "runtime/host.hpp"

namespace constrictor {

void say_error(const std::string& line) noexcept {
  // If nobody can read it, the exit status still says that something failed.
  static_cast<void>(std::fputs(line.c_str(), stderr));
  static_cast<void>(std::fputc('\n', stderr));
}

int report_exception(const std::string& program) {
  try {
    throw;
  } catch (const ConfigurationError& error) {
    say_error(fmt::format("{}: configuration: {}", program, error.what()));
    return exit_status::kConfiguration;
  } catch (const std::filesystem::filesystem_error& error) {  // what() has the words of the C++ library
    say_error(fmt::format("{}: {}: {}", program, error.path1().string(), error.code().message()));
    return exit_status::kSoftware;
  } catch (const std::exception& error) {
    say_error(fmt::format("{}: {}", program, error.what()));
    return exit_status::kSoftware;
  }
}

}  // namespace constrictor
