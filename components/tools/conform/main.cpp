// conform: does a part keep the contract of idl/README.md? `constrictor conform` becomes this program.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>

#include "component/data_path.hpp"
#include "configuration/temporary_folder.hpp"
#include "conform/hardware_port.hpp"
#include "conform/manifest_run.hpp"
#include "conform/plant_conformance.hpp"
#include "runtime/host.hpp"
#include "runtime/version.hpp"

namespace {

using namespace constrictor;
using namespace constrictor::conform;

volatile std::sig_atomic_t g_signal = 0;
void on_signal(int number) { g_signal = number; }

struct Options {
  std::uint32_t domain = 0;
  std::uint16_t robot_id = 1;
  std::string robot = "mamba", profile, json, manifest;
  bool yes = false, list = false, show_profile = false;
};

std::filesystem::path robot_file(const std::string& name) {
  if (name.find('/') != std::string::npos || name.ends_with(".yaml")) return name;
  return data_path("components/lib/robot/" + name + ".yaml");
}

/// Whether the user agrees that joints are moved; asks only on a terminal.
bool agreed(const PlantProfile& profile) {
  fmt::print(
      "This moves {} joints, one after the other, by {:.2f} rad at {:.2f} rad/s, sends commands that must be ignored, "
      "and\nrelaxes the joints for a second. Lay the robot on flat ground and keep a hand at the power switch.\n"
      "Type yes to begin: ",
      profile.joints.size(), profile.amplitude_rad, profile.rate_rad_s);
  std::fflush(stdout);
  if (!::isatty(STDIN_FILENO)) {
    fmt::print(stderr, "\nconform: found no terminal to ask, accepted --yes\n");
    return false;
  }
  std::string answer;
  std::getline(std::cin, answer);
  return answer == "yes";
}

void print_profile(const PlantProfile& profile) {
  for (const auto& row : profile.describe())
    fmt::print("# {} [{}{}{}]\n{}: {}\n", row.meaning, row.accepted, row.unit.empty() ? "" : " ", row.unit, row.key,
               row.value);
}

void print_line(const std::string& line) {
  fmt::print("{}\n", line);
  std::fflush(stdout);
}

std::filesystem::path manifest_file(const std::string& name) {
  if (name.find('/') != std::string::npos || name.ends_with(".yaml")) return std::filesystem::absolute(name);
  return data_path("deploy/" + name + ".yaml");
}

/// Checks the plant of a manifest, which is a member of a run.
int plant_of_manifest(const Options& options) {
  const std::filesystem::path folder = new_temporary_folder("conform");
  if (options.profile.empty()) std::ofstream(folder / "profile.yaml") << "{}\n";
  else std::filesystem::copy_file(options.profile, folder / "profile.yaml");
  bool found = false;
  try {
    found = run_manifest(
        manifest_file(options.manifest), folder, [] { return g_signal != 0; }, print_line);
  } catch (...) {
    std::filesystem::remove_all(folder);
    throw;
  }
  if (!found) {
    std::ifstream log(folder / "log");
    fmt::print(stderr, "conform: the run has ended without results; {} has its logs, and it said:\n{}\n",
               folder.string(), std::string(std::istreambuf_iterator<char>(log), {}));
    return g_signal ? 128 + g_signal : exit_status::kSoftware;
  }
  const auto result = nlohmann::json::parse(std::ifstream(folder / "result.json"));
  if (!options.json.empty())
    std::filesystem::copy_file(folder / "result.json", options.json, std::filesystem::copy_options::overwrite_existing);
  std::filesystem::remove_all(folder);
  if (g_signal) return 128 + g_signal;
  return result.at("conforms").get<bool>() ? exit_status::kOk : exit_status::kFailed;
}

int plant(const Options& options) {
  const RobotModel robot = load_robot(robot_file(options.robot));
  PlantProfile profile = load_parameters<PlantProfile>(options.profile);
  profile.adapt_to(robot);
  if (options.list) {
    for (const auto& check : plant_checks()) fmt::print("{:<16} {}\n", check.name, check.expected);
    return exit_status::kOk;
  }
  if (options.show_profile) {
    print_profile(profile);
    return exit_status::kOk;
  }
  if (!options.yes && !agreed(profile)) return exit_status::kUsage;
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) std::signal(number, on_signal);
  if (!options.manifest.empty()) return plant_of_manifest(options);
  Report report(plant_checks(), [](const Check& check) { print_line(text_of(check)); });
  std::string gone;
  try {
    HardwarePort port(options.domain, profile.period_s, options.robot_id, [] { return g_signal != 0; });
    port.advance({});
    if (port.commanded_by_others()) {
      fmt::print(stderr,
                 "conform: found another process that writes hardware/joint_command in domain {} (plant_relay?); end "
                 "its run first\n",
                 options.domain);
      return exit_status::kUsage;
    }
    PlantConformance(port, robot, profile, report).run();
  } catch (const Interrupted&) {
    gone = "interrupted; the joints hold";
  } catch (const PlantGone& error) {
    gone = error.what();
  }
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

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app{"Checks whether a part keeps the contract of Constrictor (idl/README.md).", "constrictor conform"};
  app.set_version_flag("--version", kVersion);
  app.require_subcommand(1);
  CLI::App* sub = app.add_subcommand(
      "plant", "check a process that drives joints on the topics hardware/*, or the plant of a manifest");
  sub->add_option("--domain", options.domain, "DDS domain in which the process writes; no plant_relay may be there")
      ->envname("CONSTRICTOR_DOMAIN")
      ->check(CLI::Range(0, 229));
  sub->add_option("--manifest", options.manifest,
                  "instead: check the plant of this manifest (a file, or a name as in `constrictor run`) in a run of "
                  "its own");
  sub->add_option("--robot", options.robot, "robot file, or the name of one")->capture_default_str();
  sub->add_option("--robot-id", options.robot_id, "robot_id of the process's samples")->capture_default_str();
  sub->add_option("--profile", options.profile, "what is expected, and how the joints are moved (YAML)")
      ->check(CLI::ExistingFile);
  sub->add_option("--json", options.json, "file for the results");
  sub->add_flag("--yes", options.yes, "move the joints without asking");
  sub->add_flag("--list", options.list, "print all checks, and what they expect; moves nothing");
  sub->add_flag("--show-profile", options.show_profile, "print the profile that is in force; moves nothing");
  sub->footer(
      "Holds the joints where they are, then moves them one after the other, slowly and by a small angle, and sends\n"
      "commands that must be ignored. Prints one line for each check; a failure names what was found, what is "
      "expected\n"
      "and what to do. Ctrl-C leaves the joints holding and names what was not checked.\n\n"
      "EXAMPLES\n"
      "  constrictor conform plant --domain 5 --yes\n"
      "  constrictor conform plant --manifest emulated_servos --yes\n"
      "  constrictor conform plant --domain 5 --profile slow.yaml --json result.json\n\n"
      "EXIT STATUS\n"
      "  0 it conforms; 1 a check failed or was not made; 64 wrong usage, or not agreed; 78 a file is wrong; 130 "
      "Ctrl-C\n\n"
      "ENVIRONMENT\n  CONSTRICTOR_DOMAIN, CYCLONEDDS_URI");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? exit_status::kOk : exit_status::kUsage;
  }
  try {
    return plant(options);
  } catch (const ConfigurationError& error) {
    fmt::print(stderr, "conform: configuration: {}\n", error.what());
    return exit_status::kConfiguration;
  } catch (const std::exception& error) {
    fmt::print(stderr, "conform: {}\n", error.what());
    return exit_status::kSoftware;
  }
}
