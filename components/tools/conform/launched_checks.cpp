#include "conform/launched_checks.hpp"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "component/data_path.hpp"

namespace constrictor::conform {
namespace {

/// The value of an option of the launcher's command line; empty: it is not there.
std::string value_of(int argc, char** argv, const std::string& option) {
  for (int i = 1; i + 1 < argc; ++i) {
    if (argv[i] == option) return argv[i + 1];
  }
  return {};
}

}  // namespace

LaunchedChecks launched_checks(int argc, char** argv) {
  const char* folder = std::getenv("CONSTRICTOR_CONFORM");
  if (!folder)
    throw std::invalid_argument(
        "found no environment variable CONSTRICTOR_CONFORM; `constrictor conform PART --manifest` starts this program");
  const int named = argc > 1 && argv[1][0] != '-' ? 1 : 0;
  LaunchedChecks launched;
  launched.folder = folder;
  launched.argc = argc - named;
  launched.argv = argv + named;
  launched.robot = value_of(argc, argv, "--robot");
  if (launched.robot.empty()) launched.robot = default_robot_file();
  launched.mission = value_of(argc, argv, "--mission");
  const std::string domain = value_of(argc, argv, "--domain");
  const bool only_asked = std::any_of(
      argv, argv + argc, [](const std::string& argument) { return argument == "--check" || argument == "--topics"; });
  launched.takes_part = !only_asked && !domain.empty();
  if (launched.takes_part) launched.domain = static_cast<std::uint32_t>(std::stoul(domain));
  return launched;
}

std::thread start_checks(const std::filesystem::path& folder, std::vector<Check> checks,
                         std::function<void(Report&)> run, std::function<void()> finish) {
  return std::thread([folder, checks = std::move(checks), run = std::move(run), finish = std::move(finish)]() mutable {
    std::ofstream lines(folder / "lines.txt");
    Report report(std::move(checks), [&](const Check& one) { lines << text_of(one) << std::endl; });
    std::string gone;
    try {
      run(report);
    } catch (const std::exception& error) {
      gone = error.what();
    }
    lines << summary_of(report) << std::endl;
    if (!gone.empty()) lines << gone << std::endl;
    std::ofstream(folder / "result.new") << to_json(report).dump(2) << "\n";
    std::filesystem::rename(folder / "result.new", folder / "result.json");
    finish();
  });
}

}  // namespace constrictor::conform
