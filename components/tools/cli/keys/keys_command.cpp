#include "cli/keys/keys_command.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <system_error>

#include "cli/keys/authority.hpp"
#include "cli/keys/rights.hpp"
#include "cli/subcommands.hpp"
#include "cli/usage.hpp"
#include "configuration/configuration.hpp"
#include "configuration/counted.hpp"
#include "cyclone/security.hpp"
#include "runtime/host.hpp"

namespace constrictor::cli {
namespace {

namespace fs = std::filesystem;

struct KeysOptions {
  RunOptions run;
  std::string folder;
  int days = 365;
};

void write_text(const fs::path& file, const std::string& text) {
  std::ofstream stream(file, std::ios::binary);
  stream << text;
  if (!stream.flush()) throw std::runtime_error(fmt::format("{}: cannot be written", file.string()));
}

/// The files of one identity in a folder of its own.
void issue(const fs::path& folder, const std::string& name, const Rights& rights, const Authority& identities,
           const Authority& permissions, int days) {
  const fs::path own = folder / name;
  fs::create_directories(own);
  fs::permissions(own, fs::perms::owner_all);
  const Identity identity = identities.issue(name, days);
  write_key(own / "key.pem", *identity.key);
  write_certificate(own / "certificate.pem", *identity.certificate);
  write_text(own / "permissions.p7s", permissions.sign(permissions_document(subject_of(name), rights, days)));
  fmt::print("  {:<24} writes {}, reads {}\n", name, counted(rights.publish.size(), "topic"), rights.subscribe.size());
}

int keys(const KeysOptions& options) {
  const LaunchPlan plan = make_launch_plan(options.run);
  const fs::path folder = fs::absolute(options.folder);
  fs::create_directories(folder / "authority");
  fs::permissions(folder / "authority", fs::perms::owner_all);
  // Two authorities: with one, an identity could sign rights for itself.
  const Authority identities(folder / "identity_ca.pem", folder / "authority/identity_ca.key.pem",
                             "constrictor identities", options.days);
  const Authority permissions(folder / "permissions_ca.pem", folder / "authority/permissions_ca.key.pem",
                              "constrictor permissions", options.days);
  fmt::print("identities in {}, valid for {} days:\n", folder.string(), options.days);
  write_text(folder / "governance.p7s", permissions.sign(governance_document()));
  for (const auto& process : plan.manifest.processes) {
    const auto& components = process.components;
    const bool conducts = std::find(components.begin(), components.end(), plan.manifest.plant) != components.end();
    issue(folder, identity_of(process), rights_of_member(topics_of(options.run, plan, process), conducts), identities,
          permissions, options.days);
  }
  issue(folder, "operator", rights_of_operator(), identities, permissions, options.days);
  issue(folder, "client", rights_of_client(), identities, permissions, options.days);
  issue(folder, "observer", rights_of_observer(), identities, permissions, options.days);
  fmt::print(
      "`constrictor run --secure {0}` uses them, and sends the keys of its own processes to each other host.\n"
      "Keep authority/ in a safe place: every person who has it can make further identities.\n",
      folder.string());
  return exit_status::kOk;
}

}  // namespace

std::string identity_of(const ProcessPlan& process) { return fmt::format("{}", fmt::join(process.components, "+")); }

std::vector<fs::path> files_of_identities(const std::vector<std::string>& identities) {
  std::vector<fs::path> files{"identity_ca.pem", "permissions_ca.pem", "governance.p7s"};
  for (const fs::path name : identities) {
    for (const char* file : {"certificate.pem", "key.pem", "permissions.p7s"}) files.push_back(name / file);
  }
  return files;
}

std::string problems_of_keys(const fs::path& folder, const LaunchManifest& manifest) {
  std::vector<std::string> names{"operator"};
  for (const auto& process : manifest.processes) {
    if (!has_own_keys(process)) names.push_back(identity_of(process));
  }
  std::string problems;
  for (const auto& name : names) {
    const std::string problem = dds::problem_of_identity(folder, name);
    if (!problem.empty()) problems += "\n  " + problem;
  }
  return problems;
}

void use_keys(const fs::path& folder, const LaunchPlan& plan) {
  std::error_code error;
  if (!fs::is_directory(folder, error))
    throw ConfigurationError(
        fmt::format("--secure: found no folder {0}; `constrictor keys {0}` with the same manifest "
                    "and groups makes it",
                    folder.string()));
  const std::string problems = problems_of_keys(folder, plan.manifest);
  if (problems.empty()) {
    ::setenv("CONSTRICTOR_SECURITY", fs::absolute(folder).c_str(), 1);
    ::unsetenv("CONSTRICTOR_IDENTITY");  // each process has the identity of its components
    return;
  }
  throw ConfigurationError(
      fmt::format("--secure: {} cannot be used for this run:{}\n  `constrictor keys {}` with the "
                  "same manifest and groups makes what is missing",
                  folder.string(), problems, folder.string()));
}

void add_keys(CLI::App& app, Action& action) {
  auto options = std::make_shared<KeysOptions>();
  auto* sub =
      add_subcommand(app, "keys", "make identities and rights for a run with DDS Security", action, options, keys);
  sub->add_option("DIR", options->folder, "folder for the files; if it has authorities already, they are used again")
      ->required();
  sub->add_option("--manifest", options->run.manifest, "launch manifest: a name or a file")->capture_default_str();
  sub->add_flag("--in-process", options->run.in_process, "make one identity for a process that hosts all components");
  sub->add_option("--group", options->run.groups,
                  "make one identity for a process that hosts these components, separated by commas; may be repeated")
      ->allow_extra_args(false)
      ->excludes("--in-process");
  sub->add_option("--days", options->days, "[days] how long certificates and rights are valid")
      ->capture_default_str()
      ->check(whole_number(1, 3650));
  sub->footer(help_footer(
      "Makes an authority for identities, another one for rights, and for each process of the manifest an identity\n"
      "that may write and read the topics of its components only. Further identities: operator (`constrictor` and\n"
      "teleoperation), client (external planners, bridges), observer (reads only). The same command again renews all\n"
      "identities with the same authorities; restart the run afterwards.",
      {"constrictor keys ~/keys && constrictor run --secure ~/keys",
       "constrictor keys ~/keys --manifest case_study_fast --days 30"},
      "0 done; 64 wrong usage; 70 a file cannot be written; 78 wrong configuration"));
}

}  // namespace constrictor::cli
