#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "configuration/counted.hpp"
#include "configuration/whole_file.hpp"
#include "constrictor/constants.hpp"
#include "pictures/picture_feed.hpp"
#include "pictures/pictures.hpp"
#include "pictures/recorded_story.hpp"
#include "pictures/scene_painter.hpp"
#include "runtime/host.hpp"
#include "sim/figure/captions.hpp"
#include "sim/figure/figure.hpp"

namespace constrictor::pictures {
namespace {

constexpr double kTorqueWindow_s = 30.0;
constexpr std::size_t kMostRows = 200;
constexpr double kFirstImages_s = 0.5;  // after the begin of a recording, its first images have arrived

report::Moment moment_at(const RecordedStory& story, double time_s) {
  report::Moment moment;
  moment.time_s = time_s;
  moment.state = story.state_at(time_s);
  return moment;
}

/// Whether the recording has joints, and thus images, of this time. A recording that began during the run also has the
/// events before it, which writers keep for late readers.
bool recorded(const RecordedStory& story, double time_s) {
  return time_s >= story.from_s - 1e-9 && time_s <= story.to_s + 1e-9;
}

/// The rows of the figure at the end of a run. If no event was recorded: begin, middle and end of the recording.
std::vector<report::Moment> usual_moments(const RecordedStory& story) {
  std::vector<report::Moment> moments;
  for (const auto& event : story.events) {
    const bool same = !moments.empty() && moments.back().tick == event.tick;  // it would have the same pictures
    if (report::is_key_event(event.event) && !same && recorded(story, event.time_s)) moments.push_back(event);
  }
  const double end_s = recorded(story, story.mission_end_s) ? story.mission_end_s : story.to_s;
  if (moments.empty() && story.from_s < end_s) {
    moments.push_back(moment_at(story, story.from_s + std::min(kFirstImages_s, 0.25 * (end_s - story.from_s))));
    moments.push_back(moment_at(story, 0.5 * (story.from_s + end_s)));
    moments.push_back(moment_at(story, end_s));
    return moments;
  }
  moments.push_back(moment_at(story, end_s));
  return report::merge_end(report::figure_rows(moments));
}

std::vector<report::Moment> chosen_moments(const RecordedStory& story, const FigureOptions& options) {
  std::vector<report::Moment> moments;
  for (const double at_s : options.at_s) {
    if (!recorded(story, at_s))
      throw NoPicture(fmt::format("--at: found {:g}, accepted {:.2f} to {:.2f} s, the time of the recording", at_s,
                                  story.from_s, story.to_s));
    moments.push_back(moment_at(story, at_s));
  }
  for (const auto wanted : options.events) {
    const auto before = moments.size();
    std::copy_if(story.events.begin(), story.events.end(), std::back_inserter(moments),
                 [&](const auto& event) { return event.event == wanted && recorded(story, event.time_s); });
    if (moments.size() > before) continue;
    std::vector<std::string> names;
    for (const auto& event : story.events) {
      if (!recorded(story, event.time_s)) continue;
      const std::string name = name_of(constants::kEvent, event.event);
      if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    }
    throw NoPicture(
        fmt::format("--event: found {}, which does not occur, accepted {}", name_of(constants::kEvent, wanted),
                    names.empty() ? "--at: the recording has no event" : fmt::format("{}", fmt::join(names, ", "))));
  }
  std::stable_sort(moments.begin(), moments.end(), [](const auto& a, const auto& b) { return a.time_s < b.time_s; });
  // A second row of one tick would show the same pictures. A row that names an event is kept.
  std::vector<report::Moment> rows;
  for (auto& moment : moments) {
    const bool same = !rows.empty() && std::abs(rows.back().time_s - moment.time_s) < 0.01;
    if (!same) rows.push_back(std::move(moment));
    else if (rows.back().event == msg::kEventNone) rows.back() = std::move(moment);
  }
  return rows;
}

std::string caption_of(const RecordedStory& story, const report::Moment& moment, bool chosen) {
  const bool ended = recorded(story, story.mission_end_s);
  const std::string end = ended ? "end of the mission" : "end of the recording";
  if (moment.event == msg::kEventNone)
    return chosen || moment.time_s < (ended ? story.mission_end_s : story.to_s) - 1e-9 ? "" : end;
  const std::string words = figure::event_caption(moment.event, moment.colour);
  return moment.ends ? words + ", " + end : words;
}

figure::Heading heading_of(const RecordedStory& story) {
  figure::Heading heading{figure::kTitle, {}, {}};
  if (story.scene) heading.subtitle = fmt::format("scenario {}, seed {}: ", story.scenario, story.seed);
  if (story.outcome == msg::kMissionSucceeded)
    heading.subtitle += fmt::format("the planner ended the mission with success after {:.1f} s", story.mission_end_s);
  else if (story.mission_end_s >= 0.0)
    heading.subtitle += fmt::format("the planner gave the mission up after {:.1f} s", story.mission_end_s);
  else heading.subtitle += fmt::format("recorded from {:.1f} to {:.1f} s", story.from_s, story.to_s);
  heading.failure = story.reason;
  return heading;
}

}  // namespace

int make_figure(const FigureOptions& options) {
  require_writable(options.output);
  const RecordedStory story = read_story(options.file, check_interrupt);
  const bool chosen = !options.at_s.empty() || !options.events.empty();
  const auto moments = chosen ? chosen_moments(story, options) : usual_moments(story);
  if (moments.size() > kMostRows)
    throw NoPicture(
        fmt::format("found {} moments, accepted up to {}; choose some with --at", moments.size(), kMostRows));
  if (!story.no_images.empty()) fmt::print(stderr, "figure: without images: {}\n", story.no_images);
  if (story.images == Images::kComputed) fmt::print(stderr, "figure: computes the images again ...\n");
  const double scale = options.width > 0.0 ? options.width / figure::kWidth : 1.0;
  const double finer = std::clamp(std::ceil(scale), 1.0, 4.0);  // pictures of the scene as fine as the figure
  ScenePainter painter(story, static_cast<int>(640.0 * finer), static_cast<int>(360.0 * finer));
  std::vector<double> times_s;
  std::vector<figure::Row> rows;
  for (const auto& moment : moments) times_s.push_back(moment.time_s);
  const std::string wrong = feed_pictures(story, times_s, Choice::kPair, [&](const Seen& seen) {
    check_interrupt();
    const auto& moment = moments[rows.size()];
    rows.push_back({moment.time_s, caption_of(story, moment, chosen), moment.state, moment.colour, painter.scene(seen),
                    picture_of(seen.camera), picture_of(seen.processed)});
  });
  if (!wrong.empty()) fmt::print(stderr, "figure: images are missing or differ from the run: {}\n", wrong);
  write_whole(options.output,
              figure::draw_figure(heading_of(story), rows, story.torques, kTorqueWindow_s, options.format, scale));
  fmt::print("wrote {}: {}, {:.1f} MB\n", options.output.string(), counted(rows.size(), "row"),
             1e-6 * static_cast<double>(std::filesystem::file_size(options.output)));
  return exit_status::kOk;
}

}  // namespace constrictor::pictures
