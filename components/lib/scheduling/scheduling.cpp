#include "scheduling/scheduling.hpp"

#include <fmt/format.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <optional>
#include <set>
#include <stdexcept>

namespace constrictor {
namespace {

std::optional<int> cpu_of(std::string_view text) {
  int cpu = -1;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), cpu);
  if (error != std::errc() || end != text.data() + text.size() || cpu < 0 || cpu >= CPU_SETSIZE) return std::nullopt;
  return cpu;
}

std::string refuse_priority() {
  return fmt::format(
      "the real-time scheduler is not allowed ({}); `setcap cap_sys_nice+ep` on this program, or an rtprio limit in "
      "/etc/security/limits.conf, allows it",
      ::strerrordesc_np(errno));
}

/// The first word after this key in /proc/self/status; empty: there is no such key.
std::string from_status(std::string_view key) {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    std::string value;
    if (word == key && status >> value) return value;
  }
  return {};
}

/// Whether limits on locked memory do not concern this process.
bool may_lock_everything() {
  constexpr unsigned kIpcLock = 14;  // CAP_IPC_LOCK
  return (std::strtoull(from_status("CapEff:").c_str(), nullptr, 16) >> kIpcLock & 1U) != 0;
}

/// With a limit on locked memory, a later allocation could fail in the middle of a run. So memory is locked only where
/// nothing limits it.
std::optional<std::string> lock_memory() {
  const rlimit unlimited{RLIM_INFINITY, RLIM_INFINITY};
  rlimit limit{};
  ::getrlimit(RLIMIT_MEMLOCK, &limit);
  const bool is_unlimited =
      may_lock_everything() || limit.rlim_cur == RLIM_INFINITY || ::setrlimit(RLIMIT_MEMLOCK, &unlimited) == 0;
  if (is_unlimited && ::mlockall(MCL_CURRENT | MCL_FUTURE | MCL_ONFAULT) == 0) return std::nullopt;
  return fmt::format(
      "memory may not be locked ({}); a memlock limit of `unlimited` in /etc/security/limits.conf allows it",
      is_unlimited ? ::strerrordesc_np(errno) : fmt::format("the limit is {} KiB", limit.rlim_cur / 1024));
}

std::optional<std::string> use_cpus(const std::vector<int>& cpus) {
  cpu_set_t set;
  CPU_ZERO(&set);
  for (const int cpu : cpus) CPU_SET(static_cast<unsigned>(cpu), &set);
  if (::sched_setaffinity(0, sizeof set, &set) == 0) return std::nullopt;
  return fmt::format("the processors {} cannot be used ({}); this computer has {}", cpus_text(cpus),
                     ::strerrordesc_np(errno), ::sysconf(_SC_NPROCESSORS_ONLN));
}

bool memory_is_locked() { return std::strtoull(from_status("VmLck:").c_str(), nullptr, 10) > 0; }

}  // namespace

std::vector<int> parse_cpus(const std::string& text) {
  const auto refuse = [&] {
    return std::invalid_argument(fmt::format(
        "found '{}', accepted numbers of processors from 0 to {}, for example 0,2-3", text, CPU_SETSIZE - 1));
  };
  std::set<int> cpus;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const std::string_view part = std::string_view(text).substr(begin, end - begin);
    const std::size_t dash = part.find('-');
    const auto first = cpu_of(part.substr(0, dash));
    const auto last = dash == std::string_view::npos ? first : cpu_of(part.substr(dash + 1));
    if (!first || !last || *last < *first) throw refuse();
    for (int cpu = *first; cpu <= *last; ++cpu) cpus.insert(cpu);
    begin = end + 1;
  }
  return {cpus.begin(), cpus.end()};
}

std::string cpus_text(const std::vector<int>& cpus) { return fmt::format("{}", fmt::join(cpus, ",")); }

std::vector<std::string> apply(const Scheduling& wanted) {
  std::vector<std::string> refusals;
  if (!wanted.cpus.empty()) {
    if (auto refusal = use_cpus(wanted.cpus)) refusals.push_back(*std::move(refusal));
  }
  if (wanted.lock_memory) {
    if (auto refusal = lock_memory()) refusals.push_back(*std::move(refusal));
  }
  if (wanted.priority > 0) {
    sched_param parameters{};
    parameters.sched_priority = wanted.priority;
    if (::sched_setscheduler(0, SCHED_FIFO, &parameters) != 0) refusals.push_back(refuse_priority());
  }
  return refusals;
}

std::string scheduling_in_force() {
  std::vector<std::string> parts;
  sched_param parameters{};
  if (::sched_getscheduler(0) == SCHED_FIFO && ::sched_getparam(0, &parameters) == 0)
    parts.push_back(fmt::format("FIFO {}", parameters.sched_priority));
  if (memory_is_locked()) parts.emplace_back("memory locked");
  cpu_set_t set;
  CPU_ZERO(&set);
  if (::sched_getaffinity(0, sizeof set, &set) == 0 && CPU_COUNT(&set) < ::sysconf(_SC_NPROCESSORS_ONLN)) {
    std::vector<int> cpus;
    for (int cpu = 0; cpu < CPU_SETSIZE; ++cpu) {
      if (CPU_ISSET(static_cast<unsigned>(cpu), &set)) cpus.push_back(cpu);
    }
    parts.push_back("CPUs " + cpus_text(cpus));
  }
  return parts.empty() ? "usual" : fmt::format("{}", fmt::join(parts, ", "));
}

}  // namespace constrictor
