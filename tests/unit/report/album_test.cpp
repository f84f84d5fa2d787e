// Raw and processed image of each moment have one exposure, whichever images perception draws, and when.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>
#include <optional>

#include "report_of.hpp"

namespace constrictor {
namespace {

using testing::Outcome;
using testing::report_of;
using testing::Story;

/// The exposures that the pictures of a moment show (their brightness, see write_picture()); empty: no such file.
struct Shown {
  std::optional<int> camera, processed;
};

Shown shown(const Outcome& outcome, std::int64_t tick) {
  const auto exposure = [&](const char* picture) -> std::optional<int> {
    const auto file = outcome.files.find(fmt::format("run/snapshots/{:07}_{}.png", tick, picture));
    if (file == outcome.files.end()) return {};
    const std::vector<unsigned char> bytes(file->second.begin(), file->second.end());
    return cv::imdecode(bytes, cv::IMREAD_COLOR).at<cv::Vec3b>(0, 1)[0];
  };
  return {exposure("camera"), exposure("processed")};
}

/// The exposure, as brightness, that both pictures of a moment show.
int shown_by_both(const Outcome& outcome, std::int64_t tick) {
  const Shown pictures = shown(outcome, tick);
  EXPECT_TRUE(pictures.camera && pictures.processed) << "tick " << tick;
  EXPECT_EQ(pictures.camera.value_or(-1), pictures.processed.value_or(-2)) << "tick " << tick;
  return pictures.processed.value_or(-1);
}

constexpr std::int64_t kEnd = 421;  // tick at which the report sees the end of the mission

void expect_no_work_files(const Outcome& outcome) {
  for (const auto& [name, bytes] : outcome.files) EXPECT_FALSE(name.ends_with(".bin")) << name << " is left";
}

TEST(MomentAlbum, ShowsRawAndProcessedImageOfOneExposure) {
  // With the longer delays, newer raw images have come before the processed one.
  for (const auto& [period, delay] : {std::pair{1, 3}, {5, 3}, {7, 9}, {5, 14}}) {
    SCOPED_TRACE(fmt::format("period {}, drawn after {} ticks", period, delay));
    Story story;
    story.picture_period = period;
    story.picture_delay = delay;
    const Outcome whole = report_of(story);
    expect_no_work_files(whole);
    for (const auto& event : testing::scripted_events()) {
      if (!report::is_key_event(event.event)) continue;
      // The newest image at that time, or the first one after it that was drawn.
      std::int64_t exposure = event.tick - 5;
      while (!testing::drawn(story, exposure)) exposure += 5;
      EXPECT_EQ(shown_by_both(whole, event.tick), exposure % 256) << "tick " << event.tick;
    }
    std::int64_t last = 415;
    while (!testing::drawn(story, last)) last += 5;
    EXPECT_EQ(shown_by_both(whole, kEnd), last % 256);

    const Outcome restarted = report_of(story, {61,  62,  63,  64,  65,  66,  121, 122, 123, 124, 125, 129, 130, 135,
                                                205, 206, 209, 210, 300, 401, 409, 415, 420, 422, 424, 430, 500, 521});
    ASSERT_EQ(whole.files.size(), restarted.files.size());
    for (const auto& [name, bytes] : whole.files) EXPECT_TRUE(restarted.files.at(name) == bytes) << name << " differs";
  }
}

TEST(MomentAlbum, AtTheEndOfARunShowsThePairBeforeIt) {
  for (const std::int64_t delay : {3, 9}) {
    Story story;
    story.picture_period = 5;
    story.picture_delay = delay;
    const Outcome whole = report_of(story, {}, {}, {.end_tick = 287});
    EXPECT_EQ(shown_by_both(whole, 287), 275 % 256);
    expect_no_work_files(whole);
    const Outcome restarted = report_of(story, {285, 287}, {}, {.end_tick = 287});
    for (const auto& [name, bytes] : whole.files) EXPECT_TRUE(restarted.files.at(name) == bytes) << name << " differs";
  }
}

TEST(MomentAlbum, AnEventJustBeforeTheEndShowsThePairBeforeIt) {
  Story story;
  story.picture_period = 5;
  const Outcome outcome = report_of(story, {}, {}, {.end_tick = 61});  // the picture of exposure 60 would come later
  EXPECT_EQ(shown_by_both(outcome, 60), 50);
}

TEST(MomentAlbum, APerceptionThatDrawsNothingLeavesTheRawImages) {
  Story story;
  story.picture_period = 0;
  story.pictures_after_events = false;
  const Outcome outcome = report_of(story, {125});
  EXPECT_EQ(shown(outcome, 120).camera, 115);
  EXPECT_FALSE(shown(outcome, 120).processed);
  EXPECT_TRUE(outcome.files.contains("run/figure.png"));
  expect_no_work_files(outcome);
}

TEST(MomentAlbum, APictureOfAnotherTimeIsNotShown) {
  Story story;
  story.picture_period = 40;  // exposures at ticks 0, 200, 400
  story.pictures_after_events = false;
  const Outcome outcome = report_of(story);
  EXPECT_EQ(shown_by_both(outcome, 200), 200);
  EXPECT_EQ(shown(outcome, 120).camera, 115);
  EXPECT_FALSE(shown(outcome, 120).processed) << "the next picture was exposed 1.7 s later";
  EXPECT_EQ(shown_by_both(outcome, kEnd), 400 % 256) << "exposed 0.4 s before the end, and no later one was drawn";
}

}  // namespace
}  // namespace constrictor
