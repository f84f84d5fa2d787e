// `constrictor replay`: a recording onto DDS, or through components.
#include <fmt/format.h>

#include <chrono>
#include <optional>
#include <sstream>
#include <utility>

#include "cli/commands.hpp"
#include "cli/recording/player.hpp"
#include "cli/recording/recorded_messages.hpp"
#include "cli/subcommands.hpp"
#include "cli/usage.hpp"
#include "common/interrupt.hpp"
#include "recording/mcap_reader.hpp"
#include "runtime/host.hpp"

namespace constrictor::cli {
namespace {

struct ReplayOptions {
  std::string file;
  std::vector<std::string> components;
  std::string output;
  std::string restored;
  std::string speed = "1";
  PlayOptions play;
};

/// The components of a recorded run. Throws mcap::Error, or UsageError if the recording is not that of a run.
std::vector<std::string> recorded_roster(const std::filesystem::path& file) {
  std::vector<std::string> names;
  mcap::Reader(file).read({nullptr, nullptr, [&](const mcap::Metadata& metadata) {
                             const auto roster = metadata.entries.find("roster");
                             if (metadata.name != "recording" || roster == metadata.entries.end()) return;
                             std::istringstream list(roster->second);
                             // NOLINTNEXTLINE(performance-inefficient-vector-operation): their number is not known
                             for (std::string name; std::getline(list, name, ',');) names.push_back(name);
                           }});
  if (names.empty())
    throw UsageError(fmt::format("FILE: found {}, accepted a recording of `constrictor run --record`", file.string()));
  return names;
}

/// This process becomes constrictor_host, which contains the components.
int replay_components(const ReplayOptions& options) {
  std::vector<std::string> arguments = {"--replay", options.file};
  if (!options.restored.empty()) arguments.insert(arguments.end(), {"--restore", options.restored});
  else if (!options.output.empty()) arguments.insert(arguments.end(), {"--output", options.output});
  if (options.components == std::vector<std::string>{"all"}) {
    for (const auto& name : recorded_roster(options.file)) arguments.push_back(name);
  } else {
    arguments.insert(arguments.end(), options.components.begin(), options.components.end());
  }
  return become("constrictor_host", std::move(arguments));
}

int replay(ReplayOptions options) {
  survive_closed_pipes();
  options.file = recording_or_throw(options.file).string();
  if (!options.restored.empty() && std::filesystem::exists(options.restored))
    throw UsageError(
        fmt::format("--restore: found {}, a file that exists; accepted the path of a new file", options.restored));
  if (!options.components.empty() || !options.restored.empty()) return replay_components(options);
  PlayOptions play = options.play;
  play.file = options.file;
  if (options.speed != "max") play.speed = std::stod(options.speed);
  return play_recording(play);
}

}  // namespace

void add_replay(CLI::App& app, Action& action) {
  auto options = std::make_shared<ReplayOptions>();
  auto* sub = add_subcommand(app, "replay", "replay a recording onto DDS, or repeat a component on its recorded inputs",
                             action, options, replay);
  sub->add_option("FILE", options->file, kFileMeaning)->required()->check(existing_path());
  auto* component =
      sub->add_option("--component", options->components,
                      "repeat this component on its recorded inputs, without DDS, and compare its outputs "
                      "byte by\nbyte; may be repeated; `all`: every component of the run")
          ->allow_extra_args(false);
  auto* restored = sub->add_option("--restore", options->restored,
                                   "write a copy with the images of a recording that was made with --images recompute")
                       ->excludes(component);
  const auto of_dds = [&](CLI::Option* option) { option->excludes(component)->excludes(restored); };
  sub->add_option("--output", options->output,
                  "keep what the components write in this folder: `--component report` draws the figure of the run")
      ->needs(component);
  of_dds(sub->add_option("--speed", options->speed, "times the recorded speed, or max: as fast as possible")
             ->capture_default_str()
             ->check(CLI::Validator(
                 [](std::string& text) {
                   std::string why = text == "max" ? std::string() : number(1e-3, 1e3, "")(text);
                   return why.empty() ? why : why + ", or max";
                 },
                 "")));
  of_dds(sub->add_option("--from", options->play.from_s, "[s] begin this long after the first message")
             ->check(number(0, 1e9, "s")));
  of_dds(
      sub->add_option("--topic", options->play.topics,
                      "replay only these topics; * and ? stand for any characters; may be repeated (default: all but\n"
                      "commands to a run)")
          ->allow_extra_args(false));
  of_dds(sub->add_flag("--paused", options->play.paused, "begin with a pause"));
  of_dds(sub->add_flag("--stay", options->play.stay,
                       "stay after the last message until Ctrl-C, so that late readers receive the last samples"));
  of_dds(
      sub->add_option("--domain", options->play.domain, "DDS domain, 0 to 229 (default: a free one, which is printed)")
          ->check(whole_number(0, 229)));
  sub->footer(help_footer(
      "Publishes the recorded bytes in a domain without a run: `constrictor topic echo --domain N`, viewers and\n"
      "programs of your own receive them as they would from the run. Late readers receive the last samples of each\n"
      "topic, the scene included. On a terminal, the space bar pauses and continues, `s` makes one tick, `q` ends.\n"
      "With --component or --restore, a recording of `run --record` is needed. Images that were not recorded are "
      "computed\n"
      "again.",
      {"constrictor replay runs/NAME/run.mcap --speed 2 --from 60", "constrictor replay run.mcap --topic 'guidance/*'",
       "constrictor replay run.mcap --component perception", "constrictor replay run.mcap --component all",
       "constrictor replay run.mcap --component report --output figure_of_run",
       "constrictor replay run.mcap --restore with_images.mcap"},
      "0 done, and all outputs are equal; 1 an output differs; 64 wrong usage; 70 damaged, or the domain has a run;\n"
      "  78 the recording is of another release, or has no such component",
      "CYCLONEDDS_URI  DDS configuration"));
}

}  // namespace constrictor::cli
