#include "conform/command.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <system_error>

#include "component/data_path.hpp"
#include "configuration/closest_name.hpp"
#include "configuration/configuration.hpp"
#include "configuration/temporary_folder.hpp"
#include "runtime/host.hpp"

namespace constrictor::conform {
namespace {

namespace fs = std::filesystem;

volatile std::sig_atomic_t g_signal = 0;
void on_signal(int number) { g_signal = number; }

/// As `constrictor run` does: the file with this path; if there is none, the file of the project with this name.
fs::path named_file(const char* kind, const char* folder, const std::string& name) {
  std::error_code unreachable;
  if (fs::is_regular_file(name, unreachable)) return fs::absolute(name);
  const auto names = data_names(folder);
  if (std::find(names.begin(), names.end(), name) != names.end()) return data_path(fs::path(folder) / (name + ".yaml"));
  throw ConfigurationError(fmt::format("{}: found '{}', accepted a file or one of {}{}", kind, name,
                                       fmt::join(names, ", "), did_you_mean(name, names)));
}

}  // namespace

int signal_number() { return g_signal; }

void note_signals() {
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) std::signal(number, on_signal);
}

fs::path robot_file(const std::string& name) { return named_file("robot", "components/lib/robot", name); }
fs::path scenario_file(const std::string& name) { return named_file("scenario", "sim/scenarios", name); }
fs::path manifest_file(const std::string& name) { return named_file("manifest", "deploy", name); }

void print_line(const std::string& line) {
  fmt::print("{}\n", line);
  std::fflush(stdout);
}

bool shown(const Options& options, const std::vector<Check>& checks, const std::vector<ParameterRow>& profile) {
  if (options.list) {
    for (const auto& check : checks) fmt::print("{:<16} {}\n", check.name, check.expected);
  } else if (options.show_profile) {
    for (const auto& row : profile)
      fmt::print("# {} [{}{}{}]\n{}: {}\n", row.meaning, row.accepted, row.unit.empty() ? "" : " ", row.unit, row.key,
                 row.value);
  }
  return options.list || options.show_profile;
}

bool agreed(const std::string& warning) {
  fmt::print("{}\nType yes to begin: ", warning);
  std::fflush(stdout);
  if (!::isatty(STDIN_FILENO)) {
    fmt::print(stderr, "\nconform: found no terminal to ask, accepted --yes\n");
    return false;
  }
  std::string answer;
  std::getline(std::cin, answer);
  return answer == "yes";
}

int concluded(const Options& options, const Report& report, const std::string& gone) {
  fmt::print("{}\n", summary_of(report));
  if (!gone.empty()) fmt::print("{}\n", gone);
  if (!options.json.empty()) {
    std::ofstream file(options.json);
    file << to_json(report).dump(2) << "\n";
    if (!file.flush()) throw std::runtime_error(options.json + ": cannot be written");
  }
  if (g_signal) return 128 + g_signal;
  return report.conforms() ? exit_status::kOk : exit_status::kFailed;
}

int check_in_run(const Options& options, const std::function<bool(const fs::path&)>& run) {
  TemporaryFolder temporary("conform");
  const fs::path& folder = temporary.path();
  if (options.profile.empty()) std::ofstream(folder / "profile.yaml") << "{}\n";
  else fs::copy_file(options.profile, folder / "profile.yaml");
  const bool found = run(folder);
  if (!found) {
    temporary.keep();
    std::ifstream log(folder / "log");
    fmt::print(stderr, "conform: the run has ended without results; {} has its logs, and it said:\n{}\n",
               folder.string(), std::string(std::istreambuf_iterator<char>(log), {}));
    return g_signal ? 128 + g_signal : exit_status::kSoftware;
  }
  const auto result = nlohmann::json::parse(std::ifstream(folder / "result.json"));
  if (!options.json.empty()) fs::copy_file(folder / "result.json", options.json, fs::copy_options::overwrite_existing);
  if (g_signal) return 128 + g_signal;
  return result.at("conforms").get<bool>() ? exit_status::kOk : exit_status::kFailed;
}

}  // namespace constrictor::conform
