// `constrictor figure` and `constrictor film`: pictures of a recording, which the program `pictures` draws.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <thread>

#include "cli/commands.hpp"
#include "cli/recording/recorded_messages.hpp"
#include "cli/subcommands.hpp"
#include "cli/usage.hpp"
#include "client/task_names.hpp"
#include "configuration/closest_name.hpp"
#include "constrictor/constants.hpp"
#include "constrictor/json.hpp"
#include "recording/mcap_format.hpp"

namespace constrictor::cli {
namespace {

namespace fs = std::filesystem;

struct FigureOptions {
  std::string file, output, format;
  double width = 0.0;
  std::vector<double> at_s;
  std::vector<std::string> events;
};

struct FilmOptions {
  std::string file, output = "film.mp4", size = "1280x720";
  double speed = 1.0, rate_hz = 25.0;
  std::optional<double> from_s, to_s;
  unsigned jobs = std::max(1U, std::thread::hardware_concurrency());
};

std::string ending_of(const std::string& file) {
  std::string ending = fs::path(file).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) { return std::tolower(c); });
  return ending.empty() ? ending : ending.substr(1);
}

/// A picture must not take the place of a recording, which cannot be made again.
void refuse_recording(const fs::path& output) {
  if (fs::is_directory(output))
    throw UsageError(fmt::format("--output: found {}, a folder, accepted a file", output.string()));
  if (mcap::is_mcap(output))
    throw UsageError(fmt::format("--output: found {}, a recording, accepted another file", output.string()));
}

int figure(const FigureOptions& options) {
  const bool named = !options.output.empty();
  const std::string ending = named ? ending_of(options.output) : options.format.empty() ? "png" : options.format;
  const bool known = ending == "png" || ending == "svg" || ending == "pdf";
  if (!known && options.format.empty())
    throw UsageError(fmt::format("--output: found {}, accepted a name that ends in .png, .svg or .pdf, or --format",
                                 options.output));
  const std::string format = options.format.empty() ? ending : options.format;
  if (known && format != ending)
    throw UsageError(fmt::format("--format: found {}, accepted {}, the ending of {}", format, ending, options.output));
  const std::string output = named ? options.output : "figure." + format;
  refuse_recording(output);
  std::vector<unsigned> events;
  for (const auto& name : options.events) {
    const auto event = event_by_name(name);
    if (!event)
      throw UsageError(fmt::format("--event: found '{}', accepted {}{}", name, event_words(),
                                   did_you_mean(name, names_of(constants::kEvent, 1))));
    events.push_back(*event);
  }
  return become("pictures", {json_text(nlohmann::json{{"picture", "figure"},
                                                      {"file", recording_or_throw(options.file).string()},
                                                      {"output", output},
                                                      {"format", format},
                                                      {"width", options.width},
                                                      {"at", options.at_s},
                                                      {"events", events}})});
}

int film(const FilmOptions& options) {
  unsigned width = 0, height = 0;
  char rest = 0;
  const bool read = std::sscanf(options.size.c_str(), "%ux%u%c", &width, &height, &rest) == 2;
  const auto fits = [](unsigned value, unsigned least, unsigned most) {
    return value >= least && value <= most && value % 2 == 0;
  };
  if (!read || !fits(width, 320, 3840) || !fits(height, 180, 2160))
    throw UsageError(
        fmt::format("--size: found '{}', accepted WIDTHxHEIGHT in pixels, even numbers from 320x180 to "
                    "3840x2160",
                    options.size));
  if (ending_of(options.output) != "mp4")
    throw UsageError(fmt::format("--output: found {}, accepted a name that ends in .mp4", options.output));
  refuse_recording(options.output);
  if (options.from_s && options.to_s && *options.from_s >= *options.to_s)
    throw UsageError(
        fmt::format("--to: found {:g}, accepted more than --from ({:g} s)", *options.to_s, *options.from_s));
  nlohmann::json wish = {{"picture", "film"},        {"file", recording_or_throw(options.file).string()},
                         {"output", options.output}, {"speed", options.speed},
                         {"fps", options.rate_hz},   {"width", width},
                         {"height", height},         {"jobs", options.jobs}};
  if (options.from_s) wish["from"] = *options.from_s;
  if (options.to_s) wish["to"] = *options.to_s;
  return become("pictures", {json_text(wish)});
}

void add_file(CLI::App& sub, std::string& file) {
  sub.add_option("FILE", file, kFileMeaning)->required()->check(existing_path());
}

constexpr const char* kStatuses =
    "0 done; 64 wrong usage; 70 the file cannot be written, the disk is full, or the recording is damaged; 78 the\n"
    "  recording has nothing to show; 130 Ctrl-C, 143 SIGTERM";

}  // namespace

void add_pictures(CLI::App& app, Action& action) {
  auto drawn = std::make_shared<FigureOptions>();
  auto* sub =
      add_subcommand(app, "figure", "draw the figure of a recorded run: scene, images and torques at its moments",
                     action, drawn, figure);
  add_file(*sub, drawn->file);
  sub->add_option("-o,--output", drawn->output, "file; an existing one is replaced (default: figure.png)");
  sub->add_option("--format", drawn->format, "png, svg or pdf (default: by the ending of --output)")
      ->check(one_of({"png", "svg", "pdf"}));
  sub->add_option("--at", drawn->at_s, "[s] moments, for example 12.5,40 (default: those of the figure of the run)")
      ->delimiter(',')
      ->check(number(0, 1e9, "s"));
  sub->add_option("--event", drawn->events,
                  "a moment for each time that this event happened, for example object_grasped; may be repeated")
      ->allow_extra_args(false);
  sub->add_option("--size", drawn->width, "[pixel] width, for PDF [point] (default: 1400); the height follows")
      ->check(number(200, 14000, "pixels"));
  sub->footer(help_footer(
      "Draws what `constrictor run` draws at the end of a run, for the moments that you choose, and for print: SVG "
      "and\n"
      "PDF files have lines and text that stay sharp. --at and --event may be combined; each moment has one row.\n"
      "Images that were not recorded (`run --record --images recompute` or `off`) are computed again.",
      {"constrictor figure runs/NAME", "constrictor figure run.mcap --output figure.pdf --event object_grasped",
       "constrictor figure run.mcap --output figure.svg --at 12.5,40 --size 1000"},
      kStatuses, kDataEnvironment));

  auto filmed = std::make_shared<FilmOptions>();
  sub = add_subcommand(app, "film", "make a film of a recorded run: scene, camera, processed image and torques", action,
                       filmed, film);
  add_file(*sub, filmed->file);
  sub->add_option("-o,--output", filmed->output, "file (MP4); an existing one is replaced when the film is complete")
      ->capture_default_str();
  sub->add_option("--speed", filmed->speed, "times the speed of the run")
      ->capture_default_str()
      ->check(number(0.01, 1000, ""));
  sub->add_option("--from", filmed->from_s, "[s] begin at this time of the run")->check(number(0, 1e9, "s"));
  sub->add_option("--to", filmed->to_s, "[s] end at this time of the run")->check(number(0, 1e9, "s"));
  sub->add_option("--fps", filmed->rate_hz, "[Hz] frames in a second")
      ->capture_default_str()
      ->check(number(1, 120, "Hz"));
  sub->add_option("--size", filmed->size, "[pixel] WIDTHxHEIGHT, even numbers")->capture_default_str();
  sub->add_option("--jobs", filmed->jobs, "frames drawn at a time (default: as many as there are processor cores)")
      ->check(whole_number(1, 64));
  sub->footer(help_footer(
      "Shows the four panels of the figure in motion, with the state of the planner, the newest event, and a bar with\n"
      "the key events. Prints its progress and the time that is left. Ctrl-C completes the film with what was done.\n"
      "Images that were not recorded (`run --record --images recompute` or `off`) are computed again.",
      {"constrictor film runs/NAME", "constrictor film run.mcap --output fast.mp4 --speed 8 --fps 30",
       "constrictor film run.mcap --from 30 --to 45 --size 1920x1080"},
      kStatuses, kDataEnvironment));
}

}  // namespace constrictor::cli
