// Which images of a recording belong to a time. Perception draws only some of them.
#include "pictures/picture_feed.hpp"

#include <cstring>

#include "integration/pictures_fixture.hpp"
#include "pictures/recorded_story.hpp"

namespace constrictor::testing {
namespace {

using pictures::Choice;
using pictures::Seen;

std::vector<Seen> seen_at(const pictures::RecordedStory& story, Choice choice, const std::vector<double>& times_s) {
  std::vector<Seen> all;
  EXPECT_EQ(pictures::feed_pictures(story, times_s, choice, [&](const Seen& seen) { all.push_back(seen); }), "");
  EXPECT_EQ(all.size(), times_s.size());
  return all;
}

const std::vector<double> kTimes_s{0.1, 0.2, 0.3, 0.4, 0.5, 0.58, 0.66, 0.76};

TEST_F(Pictures, AFilmShowsTheNewestProcessedImageThatIsNotNewerThanTheRawOne) {
  const auto story = pictures::read_story(run("on") / "run.mcap", [] {});
  std::size_t other = 0;
  for (const Seen& seen : seen_at(story, Choice::kNewest, kTimes_s)) {
    ASSERT_TRUE(seen.camera && seen.processed) << seen.time_s;
    const std::int64_t older_ticks = seen.camera->exposure_tick - seen.processed->exposure_tick;
    EXPECT_GE(older_ticks, 0) << seen.time_s;
    EXPECT_LE(older_ticks, 20) << seen.time_s << " s: each 5th image is drawn";
    other += older_ticks > 0;
  }
  EXPECT_GE(other, 3U) << "not every image is drawn";
}

TEST_F(Pictures, AFigureShowsRawAndProcessedImageOfOneExposure) {
  for (const char* images : {"on", "recompute"}) {
    const auto story = pictures::read_story(run(images) / "run.mcap", [] {});
    for (const Seen& seen : seen_at(story, Choice::kPair, kTimes_s)) {
      ASSERT_TRUE(seen.camera && seen.processed) << seen.time_s;
      EXPECT_EQ(seen.camera->exposure_tick, seen.processed->exposure_tick) << seen.time_s;
    }
  }
}

/// The same images as in the figure at the end of the run.
TEST_F(Pictures, AFigureShowsTheImagesThatTheReportSaved) {
  const auto story = pictures::read_story(run("on") / "run.mcap", [] {});
  ASSERT_FALSE(story.events.empty());
  for (const report::Moment& event : story.events) {
    if (!report::is_key_event(event.event)) continue;
    const report::MomentFiles saved(run("on"), event);
    const Seen seen = seen_at(story, Choice::kPair, {event.time_s}).front();
    for (const auto& [file, image] : {std::pair{saved.camera, seen.camera}, {saved.processed, seen.processed}}) {
      cv::Mat rgb;
      cv::cvtColor(cv::imread(file.string()), rgb, cv::COLOR_BGR2RGB);
      ASSERT_EQ(rgb.total() * rgb.elemSize(), image->data._length) << file;
      EXPECT_EQ(std::memcmp(rgb.data, image->data._buffer, image->data._length), 0) << file;
    }
  }
}

}  // namespace
}  // namespace constrictor::testing
