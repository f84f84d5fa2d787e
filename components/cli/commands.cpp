#include "cli/commands.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <string>
#include <thread>
#include <vector>

#include "cli/run_difference.hpp"
#include "cli/run_registry.hpp"
#include "runtime/domain_claim.hpp"
#include "runtime/host.hpp"

namespace constrictor::cli {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr auto kPoll = 20ms;

}  // namespace

int end_command(std::optional<std::uint32_t> domain) {
  const RunNote run = find_run(domain);
  ::kill(run.pid, SIGTERM);
  const auto end = Clock::now() + 20s;
  while (domain_claimed(run.domain)) {
    if (Clock::now() > end) {
      std::fprintf(stderr, "end: run %u (pid %d) did not end within 20 s\n", run.domain, run.pid);
      return exit_status::kWaitedTooLong;
    }
    std::this_thread::sleep_for(kPoll);
  }
  fmt::print("run {} ended\n", run.domain);
  return exit_status::kOk;
}

int diff_command(const std::filesystem::path& a, const std::filesystem::path& b) {
  const auto difference = compare_runs(a, b);
  if (!difference) {
    fmt::print("equal\n");
    return 0;
  }
  fmt::print("first difference: tick {}, component {}, topic {}", difference->tick, difference->component, difference->topic);
  if (!difference->field.empty()) fmt::print(", field {}", difference->field);
  fmt::print("\n  {}: {}\n  {}: {}\n", a.string(), difference->a, b.string(), difference->b);
  if (difference->field.empty() && difference->a.rfind("hash", 0) == 0) {
    fmt::print("  (runs recorded with `constrictor run --record` show the field and its values)\n");
  }
  return 1;
}

int host_command(int argc, char** argv) {
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe").parent_path() / "constrictor_host";
  std::string names;
  int next = 0;
  for (; next < argc && argv[next][0] != '-'; ++next) names += (names.empty() ? "" : ",") + std::string(argv[next]);
  std::vector<std::string> arguments = {program.string()};
  if (!names.empty()) arguments.push_back(names);
  arguments.insert(arguments.end(), argv + next, argv + argc);
  std::vector<char*> pointers;
  for (auto& argument : arguments) pointers.push_back(argument.data());
  pointers.push_back(nullptr);
  ::execv(program.c_str(), pointers.data());
  std::perror(program.c_str());
  return exit_status::kSoftware;
}

}  // namespace constrictor::cli
