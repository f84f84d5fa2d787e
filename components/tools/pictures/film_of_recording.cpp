#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "common/interrupt.hpp"
#include "common/progress_display.hpp"
#include "configuration/counted.hpp"
#include "pictures/film_drawer.hpp"
#include "pictures/film_file.hpp"
#include "pictures/picture_feed.hpp"
#include "pictures/pictures.hpp"
#include "pictures/recorded_story.hpp"
#include "runtime/host.hpp"
#include "sim/figure/captions.hpp"
#include "sim/figure/film_frame.hpp"

namespace constrictor::pictures {
namespace {

struct Full {};  // the disk

std::vector<double> times_of(const FilmOptions& options, const RecordedStory& story) {
  const double from_s = std::max(options.from_s.value_or(story.from_s), story.from_s);
  const double to_s = std::min(options.to_s.value_or(story.to_s), story.to_s);
  if (from_s > to_s)
    throw NoPicture(fmt::format(
        "--from, --to: found {:g} to {:g} s, accepted a part of {:.2f} to {:.2f} s, the time of "
        "the recording",
        options.from_s.value_or(story.from_s), options.to_s.value_or(story.to_s), story.from_s, story.to_s));
  const double step_s = options.speed / options.rate_hz;
  const auto count = static_cast<std::size_t>(std::floor((to_s - from_s) / step_s + 1e-6)) + 1;
  std::vector<double> times_s;
  for (std::size_t i = 0; i < count; ++i) times_s.push_back(from_s + static_cast<double>(i) * step_s);
  return times_s;
}

std::string duration(double seconds) {
  const auto whole = static_cast<long>(std::ceil(seconds));
  return whole < 100 ? fmt::format("{} s", whole) : fmt::format("{} min {} s", whole / 60, whole % 60);
}

/// How far the work has come, and how long it will still take.
class Progress {
 public:
  explicit Progress(std::size_t frames) : frames_(frames) {}
  void note(std::size_t done) {
    const double wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    if (done == 0 || (wall_s - shown_s_ < 0.2 && done < frames_)) return;
    shown_s_ = wall_s;
    const double rate = static_cast<double>(done) / std::max(wall_s, 1e-9);
    display_.show_status(fmt::format("film: {} % (frame {} of {}), {:.1f} frames/s, {} left", 100 * done / frames_,
                                     done, frames_, rate, duration(static_cast<double>(frames_ - done) / rate)));
  }
  void print(const std::string& line) { display_.print(line); }

 private:
  std::size_t frames_;
  ProgressDisplay display_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  double shown_s_ = -1.0;
};

}  // namespace

int make_film(const FilmOptions& options) {
  require_writable(options.output);
  const RecordedStory story = read_story(options.file, check_interrupt);
  const std::vector<double> times_s = times_of(options, story);
  if (!story.scene && story.images == Images::kNone)
    throw NoPicture(
        fmt::format("{}: has neither a simulated world nor images: {}", options.file.string(), story.no_images));
  const int width = options.width, height = options.height;
  FilmStyle style{width, height, story.torques, figure::torque_limit(story.torques), {}};
  for (const auto& event : story.events) {
    if (report::is_key_event(event.event)) style.marks.push_back({event.time_s, event.colour});
  }
  FilmDrawer drawer(story, style, std::min(options.jobs, times_s.size()));
  FilmFile film(options.output, options.rate_hz, width, height);
  Progress progress(times_s.size());
  if (story.epochs > 1) progress.print(fmt::format("film: shows epoch {}, the last of {}", story.epoch, story.epochs));
  if (!story.no_images.empty()) progress.print("film: without images: " + story.no_images);
  if (story.images == Images::kComputed)
    progress.print("film: computes the images again, which makes it slower; `constrictor replay --restore` keeps them");

  figure::FilmFrame frame;
  frame.from_s = times_s.front();
  frame.to_s = times_s.back();
  frame.title = story.scene ? fmt::format("{}, seed {}", story.scenario, story.seed) : story.file.filename().string();
  if (options.speed != 1.0) frame.title += fmt::format(", {:g}x", options.speed);
  std::string ended, wrong;
  int status = exit_status::kOk;
  const auto write_oldest = [&] {
    if (!film.add(drawer.take())) throw Full();
    progress.note(film.frames());
  };
  try {
    wrong = feed_pictures(story, times_s, Choice::kNewest, [&](const Seen& seen) {
      check_interrupt();
      frame.time_s = seen.time_s;
      frame.state = story.state_at(seen.time_s);
      for (const auto& event : story.events) {
        if (event.time_s <= seen.time_s && report::is_key_event(event.event))
          frame.event = fmt::format("{:.1f} s: {}", event.time_s, figure::event_caption(event.event, event.colour));
      }
      if (drawer.full()) write_oldest();
      drawer.begin(seen, frame);
    });
    while (!drawer.empty()) write_oldest();
  } catch (const Interrupted&) {
    ended = "interrupted";
    status = interrupt_status();
  } catch (const Full&) {
    ended = "the disk is full";
    status = exit_status::kSoftware;
  }
  if (!film.finish()) {
    progress.print(fmt::format("film: {}; no frame was done, and no film is left", ended));
    return status;
  }
  const double shown_s = static_cast<double>(film.frames()) / options.rate_hz;
  if (!ended.empty())
    progress.print(fmt::format("film: {}; {} has the first {} of {} frames, up to {:.2f} s of the run", ended,
                               options.output.string(), film.frames(), times_s.size(), times_s[film.frames() - 1]));
  else
    progress.print(fmt::format("wrote {}: {}, {}, {}, {:.1f} MB", options.output.string(),
                               counted(film.frames(), "frame"), duration(shown_s), film.codec(),
                               1e-6 * static_cast<double>(std::filesystem::file_size(options.output))));
  if (!wrong.empty()) progress.print("film: images are missing or differ from the run: " + wrong);
  return status;
}

}  // namespace constrictor::pictures
