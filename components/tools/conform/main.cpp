// conform: does a part keep the contract of idl/CLIENTS.md? `constrictor conform` becomes this program.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdlib>

#include "configuration/command_line.hpp"
#include "conform/command.hpp"
#include "conform/parts.hpp"
#include "runtime/report_exception.hpp"
#include "runtime/version.hpp"

namespace {

using namespace constrictor;
using namespace constrictor::conform;

constexpr const char* kStatuses =
    "EXIT STATUS\n"
    "  0 it conforms; 1 a check failed or was not made; 64 wrong usage, or not agreed; 78 a file is wrong; 130 "
    "Ctrl-C\n\n"
    "ENVIRONMENT\n  CONSTRICTOR_DOMAIN (of a plant, without --domain and --manifest), CYCLONEDDS_URI";

const CLI::Validator kDomains = whole_number(0, 229);

/// The domain that the environment names; it is not an alternative to an option, but what holds without one.
std::optional<std::uint32_t> domain_of_environment() {
  const char* text = std::getenv("CONSTRICTOR_DOMAIN");
  if (!text || !*text) return {};
  std::string number = text;
  if (const std::string error = kDomains(number); !error.empty())
    throw ConfigurationError("CONSTRICTOR_DOMAIN: " + error);
  return static_cast<std::uint32_t>(std::stoul(number));
}

/// The options that all parts have.
void add_options(CLI::App& sub, Options& options) {
  sub.add_option("--profile", options.profile, "what is expected, and how the part is tried (YAML)")
      ->check(existing_file());
  sub.add_option("--json", options.json, "file for the results");
  sub.add_flag("--yes", options.yes, "do not ask before joints are moved");
  sub.add_flag("--list", options.list, "print all checks, and what they expect; moves nothing");
  sub.add_flag("--show-profile", options.show_profile, "print the profile that is in force; moves nothing");
}

void add_plant(CLI::App& app, Options& options) {
  CLI::App* sub = app.add_subcommand(
      "plant", "check a process that drives joints on the topics hardware/*, or the plant of a manifest");
  auto* domain = sub->add_option("--domain", options.domain,
                                 "DDS domain in which the process writes; no plant_relay may be there");
  domain->check(kDomains);
  sub->add_option("--manifest", options.manifest,
                  "instead of --domain: check the plant of this manifest (a file, or a name as in `constrictor run`) "
                  "in a run of its own")
      ->excludes(domain);
  sub->add_option("--robot", options.robot, "robot: a file, or a name as in `constrictor run`")->capture_default_str();
  sub->add_option("--robot-id", options.robot_id, "number of the robot: the robot_id in the samples of the process")
      ->capture_default_str();
  sub->add_option("--restart-command", options.restart_command,
                  "shell command that ends the process and starts it again, for the check `restart` with --domain; "
                  "without it\nyou are asked to do so, if this is a terminal and without --yes");
  add_options(*sub, options);
  sub->footer(
      std::string("Holds the joints where they are, then moves them one after the other, slowly and by a small angle, "
                  "and sends\n"
                  "commands that must be ignored. Prints one line for each check; a failure names what was found, what "
                  "is expected\n"
                  "and what to do. Ctrl-C leaves the joints holding and names what was not checked.\n\n"
                  "EXAMPLES\n"
                  "  constrictor conform plant --domain 5 --yes\n"
                  "  constrictor conform plant --domain 5 --yes --restart-command 'systemctl restart my_plant'\n"
                  "  constrictor conform plant --manifest emulated_servos --yes\n"
                  "  constrictor conform plant --domain 5 --profile slow.yaml --json result.json\n\n") +
      kStatuses);
}

void add_part(CLI::App& app, Options& options, const PartKind& kind) {
  CLI::App* sub = app.add_subcommand(kind.name, kind.summary);
  auto* manifest = sub->add_option(
      "--manifest", options.manifest,
      fmt::format("check the {} of this manifest (a file, or a name as in `constrictor run`) in a run of "
                  "its own",
                  kind.name));
  auto* domain = sub->add_option(
      "--domain", options.domain,
      kind.observable
          ? std::string("instead of --manifest: only watch the run in this DDS domain; nothing is moved")
          : fmt::format("instead of --manifest: serve a {} that you start yourself in this DDS domain, in which no run "
                        "goes on; prints\nthe arguments with which it joins",
                        kind.name));
  domain->check(kDomains)->excludes(manifest);
  sub->add_option("--robot", options.robot, "robot: a file, or a name as in `constrictor run`; with --domain")
      ->capture_default_str()
      ->needs(domain);
  if (!kind.observable) {
    sub->add_option("--patience", options.patience_s, "[s] time in which the part must join; with --domain")
        ->capture_default_str()
        ->needs(domain)
        ->check(number(1.0, 3600.0, "s"));
    sub->add_option("--scenario", options.scenario,
                    "scenario: a file, or a name as in `constrictor run`; with --domain")
        ->capture_default_str()
        ->needs(domain);
  }
  add_options(*sub, options);
  sub->footer(
      fmt::format("{}\n"
                  "Prints one line for each check; a failure names what was found, what is expected and what "
                  "to do. Ctrl-C ends\nthe run and names what was not checked.\n\n"
                  "EXAMPLES\n"
                  "  constrictor conform {} --manifest case_study{}\n"
                  "  constrictor conform {} --domain 5\n"
                  "  constrictor conform {} --manifest mine.yaml --profile slow.yaml --json result.json\n\n{}",
                  kind.what, kind.name, kind.moves_joints ? " --yes" : "", kind.name, kind.name, kStatuses));
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app{"Checks whether a part keeps the contract of Constrictor (idl/CLIENTS.md).", "constrictor conform"};
  app.set_version_flag("--version", kVersion);
  app.require_subcommand(1);
  add_plant(app, options);
  for (const PartKind& kind : part_kinds()) add_part(app, options, kind);
  if (const auto status = parse_command_line(app, argc, argv)) return *status;
  const std::string part = app.get_subcommands().front()->get_name();
  try {
    if (part == "plant" && options.manifest.empty() && !options.domain) options.domain = domain_of_environment();
    return part == "plant" ? plant_command(options) : part_command(options, part);
  } catch (...) {
    return report_exception("conform");
  }
}
