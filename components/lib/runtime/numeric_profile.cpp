#include "runtime/numeric_profile.hpp"

#include <fmt/format.h>
#include <unistd.h>
#if defined(__x86_64__)
#include <cpuid.h>
#endif

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>

namespace constrictor {
namespace {

struct CpuFeature {
  const char* name;  ///< as OpenCV writes it
  bool present;      ///< on this processor
};

/// The features beyond SSE2 that OpenCV must not use.
std::vector<CpuFeature> opencv_features() {
#if defined(__x86_64__)
  unsigned eax = 0, ebx = 0, ecx = 0, edx = 0;
  const bool fp16 = __get_cpuid(1, &eax, &ebx, &ecx, &edx) != 0 && (ecx & bit_F16C) != 0;
  const bool avx512 = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512cd") &&
                      __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512dq") &&
                      __builtin_cpu_supports("avx512vl");
  const bool avx = __builtin_cpu_supports("avx");
  return {{"AVX512-SKX", avx512},
          {"AVX2", __builtin_cpu_supports("avx2") != 0},
          {"FMA3", __builtin_cpu_supports("fma") != 0},
          {"AVX", avx},
          {"FP16", fp16 && avx},
          {"SSE4.2", __builtin_cpu_supports("sse4.2") != 0},
          {"SSE4.1", __builtin_cpu_supports("sse4.1") != 0},
          {"SSSE3", __builtin_cpu_supports("ssse3") != 0}};
#else
  return {{"AVX512-SKX", true}, {"AVX2", true},   {"FMA3", true},   {"AVX", true},
          {"FP16", true},       {"SSE4.2", true}, {"SSE4.1", true}, {"SSSE3", true}};
#endif
}

/// The names of these features, separated by commas. `only_present` leaves out features that the processor does not
/// have, because OpenCV prints a notice about each of them.
std::string opencv_list(bool only_present) {
  std::string list;
  for (const auto& [name, present] : opencv_features()) {
    if (present || !only_present) list += (list.empty() ? "" : ",") + std::string(name);
  }
  return list;
}

}  // namespace

const std::vector<std::pair<std::string, std::string>>& numeric_environment() {
  static const std::vector<std::pair<std::string, std::string>> variables = {
      {"GLIBC_TUNABLES", "glibc.cpu.hwcaps=-FMA,-FMA4,-AVX2"},
      {"OPENCV_CPU_DISABLE", opencv_list(true)},
      {"OPENCV_OPENCL_RUNTIME", "disabled"},
      {"LP_NATIVE_VECTOR_WIDTH", "256"},
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
  // If execv fails, the profile shows it: the fingerprint of libm differs from that of the other processes.
  if (changed) ::execv("/proc/self/exe", argv);
}

std::string numeric_profile() {
  // FNV-1a over the bit patterns of results that differ between glibc's code variants in their last bits.
  std::uint64_t fingerprint = 0xcbf29ce484222325ULL;
  const auto add = [&](double value) {
    fingerprint = (fingerprint ^ std::bit_cast<std::uint64_t>(value)) * 0x100000001b3ULL;
  };
  for (int i = 1; i <= 2000; ++i) {
    // volatile, so that libm computes the results at run time instead of the compiler.
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
    // The fingerprint shows the effect of glibc's masks. Masks beyond those of the profile change no result.
    if (name == "GLIBC_TUNABLES") continue;
    const char* found = std::getenv(name.c_str());
    // OPENCV_CPU_DISABLE lists only the features that the processor has. It has the same effect as the complete list.
    const std::string all = opencv_list(false);
    if (name == "OPENCV_CPU_DISABLE" && found && value == found) found = all.c_str();
    else if (!found || value != found) differing += " " + name + "=" + (found ? found : "(unset)");
    for (const char* at = found ? found : "?"; *at; ++at) {
      environment = (environment ^ static_cast<unsigned char>(*at)) * 0x100000001b3ULL;
    }
  }
  return fmt::format("libm {:016x} env {:016x}{}", fingerprint, environment, differing).substr(0, 127);
}

}  // namespace constrictor
