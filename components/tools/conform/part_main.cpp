// conform_part: takes the places of all members around a part and checks the part. `constrictor conform PART
// --manifest` starts such a run. CONSTRICTOR_CONFORM names the folder with profile.yaml, where lines.txt and
// result.json are written; CONSTRICTOR_CONFORM_PART is the part.
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "component/data_path.hpp"
#include "conform/exchange_port.hpp"
#include "conform/parts.hpp"
#include "runtime/component_main.hpp"
#include "runtime/host.hpp"
#include "runtime/numeric_profile.hpp"

namespace {

using namespace constrictor;
using namespace constrictor::conform;
namespace fs = std::filesystem;

/// The value of an option of the launcher's command line; empty: it is not there.
std::string value_of(int argc, char** argv, const std::string& option) {
  for (int i = 1; i + 1 < argc; ++i) {
    if (argv[i] == option) return argv[i + 1];
  }
  return {};
}

void check(ExchangePort& port, const PartKind& kind, const fs::path& folder, const fs::path& robot_file,
           const std::string& mission) {
  std::ofstream lines(folder / "lines.txt");
  Report report(kind.checks(), [&](const Check& one) { lines << text_of(one) << std::endl; });
  std::string gone;
  try {
    kind.run(port, {load_robot(robot_file), folder / "profile.yaml", mission}, report);
  } catch (const std::exception& error) {
    gone = error.what();
  }
  lines << summary_of(report) << std::endl;
  if (!gone.empty()) lines << gone << std::endl;
  std::ofstream(folder / "result.new") << to_json(report).dump(2) << "\n";
  fs::rename(folder / "result.new", folder / "result.json");
  port.finish();
}

}  // namespace

int main(int argc, char** argv) {
  ensure_numeric_environment(argv);  // may start the program again, which needs all arguments
  const char* folder = std::getenv("CONSTRICTOR_CONFORM");
  const char* part = std::getenv("CONSTRICTOR_CONFORM_PART");
  if (!folder || !part) {
    fmt::print(stderr,
               "conform_part: found no CONSTRICTOR_CONFORM and CONSTRICTOR_CONFORM_PART; `constrictor conform "
               "PART --manifest` starts this program\n");
    return exit_status::kUsage;
  }
  if (argc > 1 && argv[1][0] != '-') {
    --argc;  // the launcher passes the names of the components as the first argument
    ++argv;
  }
  const std::string robot = value_of(argc, argv, "--robot"), domain = value_of(argc, argv, "--domain");
  // The launcher may ask a program first what it reads and writes, and whether its files are right.
  const bool only_asked = std::any_of(
      argv, argv + argc, [](const std::string& argument) { return argument == "--check" || argument == "--topics"; });
  try {
    const PartKind& kind = part_kind(part);
    ExchangePort port(part, domain.empty() ? 0 : static_cast<std::uint32_t>(std::stoul(domain)));
    std::thread checks;
    if (!only_asked && !domain.empty())
      checks = std::thread([&, mission = value_of(argc, argv, "--mission")] {
        check(port, kind, folder, robot.empty() ? data_path("components/lib/robot/mamba.yaml") : fs::path(robot),
              mission);
      });
    const int status = host_main(argc, argv, stand_factories(part_place(part), port));
    port.end();
    if (checks.joinable()) checks.join();
    return status;
  } catch (const std::exception& error) {
    fmt::print(stderr, "conform_part: {}\n", error.what());
    return exit_status::kSoftware;
  }
}
