#include "runtime/numeric_profile.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>

namespace constrictor {

const std::vector<std::pair<std::string, std::string>>& numeric_environment() {
  static const std::vector<std::pair<std::string, std::string>> variables = {
      {"GLIBC_TUNABLES", "glibc.cpu.hwcaps=-FMA,-FMA4,-AVX2"},
      {"OPENCV_CPU_DISABLE", "AVX512-SKX,AVX2,FMA3,AVX,FP16,SSE4.2,SSE4.1,SSSE3"},
      {"OPENCV_OPENCL_RUNTIME", "disabled"},
      {"LP_NATIVE_VECTOR_WIDTH", "128"},
      {"GALLIUM_OVERRIDE_CPU_CAPS", "sse4.1"},
  };
  return variables;
}

void ensure_numeric_environment(char** argv) {
  bool changed = false;
  for (const auto& [name, value] : numeric_environment()) {
    if (std::getenv(name.c_str())) continue;
    ::setenv(name.c_str(), value.c_str(), 0);
    changed = true;
  }
  // If it cannot be started anew the profile says so: the libm fingerprint differs from the others'.
  if (changed) ::execv("/proc/self/exe", argv);
}

std::string numeric_profile() {
  // FNV-1a over the bit patterns of results that differ between glibc's code variants in their last bits.
  std::uint64_t fingerprint = 0xcbf29ce484222325ULL;
  const auto add = [&](double value) {
    fingerprint = (fingerprint ^ std::bit_cast<std::uint64_t>(value)) * 0x100000001b3ULL;
  };
  for (int i = 1; i <= 2000; ++i) {
    // volatile: the compiler must not fold with its own arithmetic what libm shall compute.
    volatile double x = 0.0137 * i - 7.3;
    add(std::sin(x));
    add(std::cos(x));
    add(std::tan(x));
    add(std::exp(x));
    add(std::atan2(x, 1.7));
    add(std::log(std::abs(x) + 0.1));
    add(std::pow(std::abs(x) + 0.1, 1.3));
  }
  std::uint64_t environment = 0xcbf29ce484222325ULL;
  std::string differing;
  for (const auto& [name, value] : numeric_environment()) {
    // glibc's masks count by their effect, which the fingerprint shows: masking more than these changes no result.
    if (name == "GLIBC_TUNABLES") continue;
    const char* found = std::getenv(name.c_str());
    if (!found || value != found) differing += " " + name + "=" + (found ? found : "(unset)");
    for (const char* at = found ? found : "?"; *at; ++at) {
      environment = (environment ^ static_cast<unsigned char>(*at)) * 0x100000001b3ULL;
    }
  }
  return fmt::format("libm {:016x} env {:016x}{}", fingerprint, environment, differing).substr(0, 127);
}

}  // namespace constrictor
