#include "runtime/component_main.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstdlib>

#include "configuration/configuration.hpp"
#include "runtime/dds/entity.hpp"
#include "runtime/host.hpp"
#include "runtime/numeric_profile.hpp"
#include "runtime/pacer.hpp"
#include "runtime/share.hpp"
#include "runtime/version.hpp"

namespace constrictor {
namespace {

const CLI::Validator kPace(
    [](std::string& text) {
      char* end = nullptr;
      const double pace = std::strtod(text.c_str(), &end);
      if (end != text.c_str() && *end == '\0' && Pacer::accepts(pace)) return std::string{};
      return fmt::format("found '{}', accepted 0 or {} to {}", text, Pacer::kSlowest, Pacer::kFastest);
    },
    "");

}  // namespace

int component_main(int argc, char** argv, ComponentFactory factory) { return host_main(argc, argv, {std::move(factory)}); }

int host_main(int argc, char** argv, std::vector<ComponentFactory> factories) {
  ensure_numeric_environment(argv);
  Host::heed_signals();  // after the program is started anew, which forgets them
  std::string names;
  for (const auto& factory : factories) names += (names.empty() ? "" : ",") + factory.name;
  HostOptions options;
  std::vector<std::string> config_files;
  options.setup.robot_file = share_path("components/robot/mamba.yaml");
  options.setup.scenario_file = share_path("sim/scenarios/case_study.yaml");

  CLI::App app{"Constrictor component " + names + ": takes part in a run on Cyclone DDS."};
  app.set_version_flag("--version", kVersion);
  app.add_option("--domain", options.domain, "DDS domain of the run")->envname("CONSTRICTOR_DOMAIN")->check(CLI::Range(0, 229));
  app.add_option("--roster", options.roster, "every member of the run, comma separated (default: " + names + ")")->delimiter(',');
  app.add_option("--plant", options.plant, "the member that is the time master");
  app.add_option("--robot", options.setup.robot_file, "robot file (YAML)");
  app.add_option("--scenario", options.setup.scenario_file, "scenario file (YAML); read by simulation components only");
  app.add_option("--seed", options.setup.seed, "seed of the run");
  app.add_option("--output", options.setup.output_dir, "directory for what this process writes");
  app.add_option("--config", config_files, "NAME=FILE: configuration of a component, instead of its default");
  app.add_option("--incarnation", options.incarnation, "1, and one more with each restart")->check(CLI::Range(1u, 1'000'000u));
  app.add_option("--run-id", options.run_id, "of the run that this process belongs to; 0: of whatever run begins in the domain");
  app.add_option("--pace", options.pace, "plant only: at most so many times real time; 0: as fast as it goes")->check(kPace);
  app.add_option("--operator-pace", options.operator_pace, "plant only: the same while an operator has authority; 0: no such cap")
      ->capture_default_str()->check(kPace);
  app.add_flag("--realtime", options.realtime, "plant only: ticks on the wall clock, nobody is waited for");
  app.add_option("--max-sim-time", options.max_sim_time_s, "plant only: [s] end the run at this simulated time; 0: never")->check(CLI::Range(0.0, 1e6));
  app.add_option("--patience", options.patience_s, "[s] wait so long for a peer before giving up; 0: for ever")->check(CLI::Range(0.0, 86400.0));
  app.add_flag("--record", options.record, "plant only: log every message but images for `constrictor diff`");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? exit_status::kOk : exit_status::kUsage;
  }

  try {
    for (const auto& text : config_files) {
      const auto equals = text.find('=');
      if (equals == std::string::npos) throw ConfigurationError("--config: found '" + text + "', accepted NAME=FILE");
      options.config_files[text.substr(0, equals)] = text.substr(equals + 1);
    }
    if (options.roster.empty()) {
      for (const auto& factory : factories) options.roster.push_back(factory.name);
    }
    for (const auto& factory : factories) {
      if (std::find(options.roster.begin(), options.roster.end(), factory.name) == options.roster.end()) {
        throw ConfigurationError("--roster: " + factory.name + " is not in it");
      }
    }
    return Host(std::move(options), std::move(factories)).run();
  } catch (const ConfigurationError& error) {
    std::fprintf(stderr, "%s: configuration: %s\n", names.c_str(), error.what());
    return exit_status::kConfiguration;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", names.c_str(), error.what());
    return exit_status::kSoftware;
  }
}

}  // namespace constrictor
