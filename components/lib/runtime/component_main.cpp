#include "runtime/component_main.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <thread>

#include "component/data_path.hpp"
#include "configuration/command_line.hpp"
#include "configuration/configuration.hpp"
#include "cyclone/entity.hpp"
#include "cyclone/run_token.hpp"
#include "faults/faulty_component.hpp"
#include "log/log.hpp"
#include "runtime/component_check.hpp"
#include "runtime/host.hpp"
#include "runtime/numeric_profile.hpp"
#include "runtime/pacer.hpp"
#include "runtime/version_text.hpp"

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

/// Reads NAME=TICKS. Throws ConfigurationError.
std::pair<std::string, std::uint16_t> parse_latency(const std::string& text, const HostOptions& options) {
  const auto equals = std::min(text.find('='), text.size());
  const std::string name = text.substr(0, equals);
  const std::string_view number = std::string_view(text).substr(std::min(equals + 1, text.size()));
  std::uint16_t ticks = 0;
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), ticks);
  const bool is_number = error == std::errc() && end == number.data() + number.size();
  if (!is_number || ticks < 1 || ticks > kLargestLatency_ticks) {
    throw ConfigurationError(
        fmt::format("--latency: found '{}', accepted NAME=TICKS with 1 to {} ticks", text, kLargestLatency_ticks));
  }
  if (name == options.plant) {
    throw ConfigurationError(fmt::format(
        "--latency: found the plant '{}', accepted other members, because the plant's outputs are visible at once",
        name));
  }
  if (std::find(options.roster.begin(), options.roster.end(), name) == options.roster.end())
    throw ConfigurationError(fmt::format("--latency: found '{}', accepted a member of the roster", name));
  return {name, ticks};
}

void add_recording_options(CLI::App& app, RecordingOptions& options) {
  app.add_flag("--record", options.record, "plant only: record all topics in the file run.mcap in --output");
  app.add_option_function<std::string>(
         "--images",
         [&options](const std::string& word) {
           options.images = word == "on"    ? RecordedImages::kOn
                            : word == "off" ? RecordedImages::kOff
                                            : RecordedImages::kRecompute;
         },
         "plant only: what --record records of images")
      ->check(one_of({"on", "off", "recompute"}));
  app.add_option_function<std::vector<std::string>>(
      "--attach",
      [&options](const std::vector<std::string>& texts) {
        for (const auto& text : texts) {
          const auto equals = text.find('=');
          if (equals == std::string::npos)
            throw CLI::ValidationError("--attach", "found '" + text + "', accepted NAME=FILE");
          options.attachments[text.substr(0, equals)] = text.substr(equals + 1);
        }
      },
      "plant only: NAME=FILE: a file that --record adds to the recording; may be repeated");
}

void add_scheduling_options(CLI::App& app, Scheduling& scheduling) {
  app.add_option("--priority", scheduling.priority,
                 "1 to 99: ask for the real-time scheduler (SCHED_FIFO) with this priority; 0: the usual scheduler")
      ->capture_default_str()
      ->check(whole_number(0, 99));
  app.add_flag("--lock-memory", scheduling.lock_memory, "keep the memory of this process from being paged out");
  app.add_option_function<std::string>(
      "--cpus",
      [&scheduling](const std::string& text) {
        try {
          scheduling.cpus = parse_cpus(text);
        } catch (const std::invalid_argument& error) {
          throw CLI::ValidationError("--cpus", error.what());
        }
      },
      "processors that this process may use, for example 0,2-3 (default: all)");
}

}  // namespace

int component_main(int argc, char** argv, ComponentFactory factory, const Scheduling& usual) {
  ensure_numeric_environment(argv);  // before a word is left out: it may start the program again
  // The launcher starts a program that a manifest names as `PROGRAM NAME OPTIONS`.
  const int named = argc > 1 && argv[1][0] != '-' ? 1 : 0;
  if (named != 0 && argv[1] != factory.name) {
    fmt::print(stderr,
               "{}: found the component {}, accepted {}: this program hosts nothing else (if the launcher has grouped "
               "it: leave out --in-process, and --group with {})\n",
               std::filesystem::path(argv[0]).filename().string(), argv[1], factory.name, factory.name);
    return exit_status::kConfiguration;
  }
  return host_main(argc - named, argv + named, {std::move(factory)}, usual);
}

int host_main(int argc, char** argv, std::vector<ComponentFactory> factories, Scheduling usual) {
  ensure_numeric_environment(argv);
  Host::heed_signals();  // after the line above, which may start the program again
  std::string names;
  for (const auto& factory : factories) names += (names.empty() ? "" : ",") + factory.name;
  HostOptions options;
  std::vector<std::string> config_files;
  std::vector<std::string> latencies;
  std::string token_file;
  options.setup.robot_file = default_robot_file();
  options.setup.scenario_file = default_scenario_file();

  CLI::App app{"Constrictor component " + names + ": takes part in a run on Cyclone DDS."};
  app.set_version_flag("--version", [&names] { return version_text(names, own_git_revision()); });
  app.add_option("--domain", options.domain, "DDS domain of the run")
      ->envname("CONSTRICTOR_DOMAIN")
      ->check(whole_number(0, 229));
  app.add_option("--roster", options.roster, "every member of the run, comma separated (default: " + names + ")")
      ->delimiter(',');
  app.add_option("--plant", options.plant, "the member that is the plant");
  app.add_option("--robot", options.setup.robot_file, "robot file (YAML)");
  app.add_option("--scenario", options.setup.scenario_file,
                 "scenario file (YAML); only components of the simulation read it");
  app.add_option(
      "--mission", options.setup.mission,
      "mission (YAML), for example '{sequence: [green, red], line_colour: blue, known: {zone_radius_m: 0.4}}'");
  app.add_option("--seed", options.setup.seed, "seed of the run")->check(whole_number());
  app.add_option("--output", options.setup.output_dir, "folder for the files that this process writes");
  app.add_option("--config", config_files,
                 "NAME=FILE: configuration file of a component, instead of its default; may be repeated");
  app.add_option("--latency", latencies,
                 "NAME=TICKS: the outputs of this member of the roster become visible this many ticks after its step "
                 "began, or later if its own latency is longer; equal in all processes of the run; may be repeated");
  app.add_option("--faults", options.faults_file,
                 "file of faults (YAML) to inject into the run; equal in all processes of the run");
  app.add_option("--incarnation", options.incarnation,
                 "1 at the first start of the process in the run, and one more at each restart")
      ->check(whole_number(1, 1'000'000));
  app.add_flag("--replace", options.replace,
               "take the place of components with another configuration or of another program, and begin anew; in runs "
               "at real-time pace only");
  app.add_option("--run-id", options.run_id,
                 "number of the run that this process belongs to; 0: the first run that begins in the domain")
      ->check(whole_number());
  app.add_option("--token-file", token_file,
                 "file with the run's token, readable by its owner only; without it any process in the domain may "
                 "command the run")
      ->envname("CONSTRICTOR_TOKEN_FILE");
  app.add_option("--pace", options.pace, "plant only: at most this many times real time; 0: as fast as possible")
      ->check(kPace);
  app.add_option("--operator-pace", options.operator_pace,
                 "plant only: the same while an operator has authority; 0: no limit")
      ->capture_default_str()
      ->check(kPace);
  app.add_flag("--realtime", options.realtime, "plant only: ticks follow the wall clock and wait for no member");
  app.add_option("--max-sim-time", options.max_sim_time_s,
                 "[s] simulated time at which the plant ends the run; 0: never")
      ->check(number(0.0, 1e6, "s"));
  app.add_option("--patience", options.patience_s,
                 "[s] wall time to wait for another process before this one gives up; 0: for ever")
      ->check(number(0.0, 86400.0, "s"));
  bool check = false;
  app.add_flag("--check", check, "read all files, print what is wrong with them, and exit; joins no run");
  bool topics = false;
  app.add_flag("--topics", topics, "print which topics the components read and write, and exit; joins no run");
  add_recording_options(app, options.recording);
  add_scheduling_options(app, usual);
  bool no_checkpoints = false;
  app.add_flag("--no-checkpoints", no_checkpoints,
               "plant only: keep no checkpoints in --output; the process can then not be restarted");
  if (const auto status = parse_command_line(app, argc, argv)) return *status;

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
        throw ConfigurationError("--roster: found no '" + factory.name +
                                 "', accepted a list that names every component of this process");
      }
    }
    for (const auto& text : latencies) options.latency_ticks.insert(parse_latency(text, options));
    if (!token_file.empty()) options.token = read_token_file(token_file);
    options.setup.max_sim_time_s = options.max_sim_time_s;
    options.checkpoints = !no_checkpoints;
    const auto plan = std::make_shared<const FaultPlan>(load_fault_plan(options.faults_file, {options.roster}));
    const auto wait_ms = [](double ms) { std::this_thread::sleep_for(std::chrono::duration<double, std::milli>(ms)); };
    for (auto& factory : factories) factory = with_faults(std::move(factory), plan, wait_ms);
    if (check) {
      const Findings findings = check_components(options, factories);
      for (const auto& error : findings.errors) std::fprintf(stderr, "%s\n", error.c_str());
      if (findings.errors.empty())
        for (const auto& warning : findings.warnings) std::printf("%s%s\n", kWarningMark, warning.c_str());
      return findings.errors.empty() ? exit_status::kOk : exit_status::kConfiguration;
    }
    if (topics) {
      for (const auto& line : topics_of_components(options, factories)) std::printf("%s\n", line.c_str());
      return exit_status::kOk;
    }
    // Before the first message, so that the threads of DDS are treated alike.
    for (const auto& refusal : apply(usual)) Log(names).warning("on a busy computer ticks may be late: {}", refusal);
    return Host(std::move(options), std::move(factories)).run();
  } catch (const ConfigurationError& error) {
    Log(names).error("configuration: {}", error.what());
    return exit_status::kConfiguration;
  } catch (const std::exception& error) {
    Log(names).error("{}", error.what());
    return exit_status::kSoftware;
  }
}

}  // namespace constrictor
