// `constrictor figure` and `constrictor film` with real processes, on the recording of a short run.
#include <signal.h>

#include "constrictor/topics.hpp"
#include "integration/pictures_fixture.hpp"
#include "recording/mcap_copy.hpp"

namespace constrictor::testing {
namespace {

/// A copy of the recording of a run as an observer makes it who joins in the last quarter of the run: of the time
/// before it has only the events, which their writer keeps for late readers.
void copy_last_quarter(const fs::path& from, const fs::path& to) {
  mcap::Reader reader(from);
  std::vector<std::uint64_t> times_ns;
  reader.read({[&](const mcap::Channel& channel, const mcap::Message& message) {
                 if (channel.topic == topics::kJointState.name) times_ns.push_back(message.log_time);
               },
               {},
               {}});
  ASSERT_FALSE(times_ns.empty());
  const std::uint64_t joined_ns = times_ns[times_ns.size() * 3 / 4];
  mcap::Reader again(from);
  mcap::Copy copy(to, again);
  again.read({[&](const mcap::Channel& channel, const mcap::Message& message) {
                const bool kept = channel.topic == topics::kTaskEvent.name ||
                                  channel.topic == topics::kSceneDescription.name ||
                                  channel.topic == topics::kMissionStatus.name;
                if (kept || message.log_time >= joined_ns) copy.copy(channel, message);
              },
              {},
              {}});
  copy.finish();
}

TEST_F(Pictures, TheFigureOfARecordingHasTheChosenMoments) {
  EXPECT_EQ(command({"figure", run("on").string(), "--size", "700", "-o", out("f.png")}), exit_status::kOk) << output_;
  EXPECT_EQ(cv::imread(out("f.png")).cols, 700);
  EXPECT_EQ(command({"figure", (run("on") / "run.mcap").string(), "--at", "0.3,0.7,0.7", "-o", out("f.svg")}),
            exit_status::kOk)
      << output_;
  EXPECT_TRUE(says("2 rows")) << output_ << "one moment has one row";
  const std::string svg = content("f.svg");
  for (const char* words : {">0.3 s</text>", ">0.7 s</text>", ">Scene</text>", ">Yaw torques [Nm]</text>"})
    EXPECT_NE(svg.find(words), std::string::npos) << words;
  std::size_t images = 0;
  for (auto at = svg.find("<image "); at != std::string::npos; at = svg.find("<image ", at + 1)) ++images;
  EXPECT_EQ(images, 6U) << "scene, camera and processed image of each row";
  EXPECT_EQ(command({"figure", run("on").string(), "--event", "line found", "--format", "pdf", "-o", out("f")}),
            exit_status::kOk)
      << output_;
  EXPECT_EQ(content("f").rfind("%PDF", 0), 0U);
}

TEST_F(Pictures, TheFigureOfARecordingThatBeganLateHasOnlyMomentsOfTheRecording) {
  copy_last_quarter(run("on") / "run.mcap", dir_ / "late.mcap");
  ASSERT_EQ(command({"figure", out("late.mcap"), "-o", out("f.svg")}), exit_status::kOk) << output_;
  const std::string svg = content("f.svg");
  for (const char* time : {">0.7 s</text>", ">0.8 s</text>"}) EXPECT_NE(svg.find(time), std::string::npos) << time;
  for (const char* words : {">line found", ">no image", ">0.4 s</text>", ">0.5 s</text>"})
    EXPECT_EQ(svg.find(words), std::string::npos) << words;
  EXPECT_EQ(command({"figure", out("late.mcap"), "--event", "line found", "-o", out("f.svg")}), 78) << output_;
  EXPECT_TRUE(says("does not occur")) << output_;
}

TEST_F(Pictures, AFilmHasItsFramesInMotion) {
  const auto film = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"film", run("on").string(), "-o", out("film.mp4")});
    return command(std::move(more));
  };
  ASSERT_EQ(film({"--fps", "10", "--from", "0.1", "--to", "0.7", "--size", "640x360"}), exit_status::kOk) << output_;
  const auto frames = frames_of("film.mp4");
  ASSERT_EQ(frames.size(), 7U) << output_;
  for (const auto& frame : frames) ASSERT_EQ(frame.size(), cv::Size(640, 360));
  for (std::size_t i = 1; i < frames.size(); ++i) {
    EXPECT_GT(difference(frames[i], frames[i - 1]), 0.05) << "nothing moves in frame " << i;
    EXPECT_LT(difference(frames[i], frames[i - 1]), 60.0) << "frame " << i << " shows another scene";
  }
  cv::Scalar mean, deviation;
  cv::meanStdDev(frames[3](cv::Rect(10, 60, 400, 150)), mean, deviation);
  EXPECT_GT(deviation[0], 5.0) << "the scene is empty";
  EXPECT_EQ(cv::VideoCapture(out("film.mp4"), cv::CAP_FFMPEG).get(cv::CAP_PROP_FPS), 10.0);
  EXPECT_EQ(unfinished().size(), 0u);
  ASSERT_EQ(film({"--fps", "10", "--speed", "4", "--size", "320x180"}), exit_status::kOk) << output_;
  EXPECT_EQ(frames_of("film.mp4").size(), 3U) << "0, 0.4 and 0.8 s";
}

TEST_F(Pictures, AFilmDoesNotDependOnHowManyFramesAreDrawnAtATime) {
  std::vector<std::vector<cv::Mat>> films;
  std::string outputs;  // they name the codec
  for (const char* jobs : {"1", "3"}) {
    ASSERT_EQ(command({"film", run("on").string(), "-o", out("film.mp4"), "--fps", "10", "--to", "0.7", "--size",
                       "320x180", "--jobs", jobs}),
              exit_status::kOk)
        << output_;
    films.push_back(frames_of("film.mp4"));
    outputs += output_;
  }
  ASSERT_EQ(films[0].size(), 8U);
  ASSERT_EQ(films[1].size(), 8U);
  // The encoder may round a few pixels otherwise in each film. Frames in another order, or with parts of others, would
  // be as far from their counterparts as from other frames.
  for (std::size_t i = 0; i < films[0].size(); ++i) {
    for (std::size_t j = 0; j < films[1].size(); ++j) {
      if (i == j) continue;
      EXPECT_LT(difference(films[0][i], films[1][i]), 0.5 * difference(films[0][i], films[1][j]))
          << i << " and " << j << ": " << outputs;
    }
  }
}

TEST_F(Pictures, AnInterruptedFilmHasWhatWasDone) {
  Process process({program("constrictor"), "film", run("on").string(), "-o", out("cut.mp4"), "--fps", "120", "--speed",
                   "0.02", "--size", "320x180"},
                  environment_);
  EXPECT_TRUE(eventually([&] { return unfinished().size() == 1 && unfinished().begin()->second > 0; }));
  process.signal(SIGINT);
  EXPECT_EQ(process.wait(20s), 128 + SIGINT) << process.errors();
  const std::string said = process.output() + process.errors();
  if (said.find("no film is left") != std::string::npos) return;  // not even one frame was drawn
  EXPECT_NE(said.find("interrupted; " + out("cut.mp4") + " has the first "), std::string::npos) << said;
  const std::size_t frames = frames_of("cut.mp4").size();
  EXPECT_GT(frames, 0U);
  EXPECT_LT(frames, 11'000U);
  EXPECT_NE(said.find("the first " + std::to_string(frames) + " of "), std::string::npos) << said;
}

TEST_F(Pictures, WhatCannotBeDrawnIsRefusedWithAReason) {
  const std::string good = run("on").string();
  const auto refused = [&](std::vector<std::string> arguments, int status, const std::string& reason) {
    EXPECT_EQ(command(std::move(arguments)), status) << output_;
    EXPECT_TRUE(says(reason)) << output_ << "\nwanted: " << reason;
  };
  refused({"figure", good, "-o", out("f.jpg")}, 64, "accepted a name that ends in .png, .svg or .pdf");
  refused({"figure", good, "-o", out("f.png"), "--format", "pdf"}, 64, "accepted png, the ending of");
  refused({"figure", good, "--event", "lunch"}, 64, "--event: found 'lunch', accepted ");
  refused({"figure", good, "--event", "object_grasped", "-o", out("f.png")}, 78, "does not occur");
  refused({"figure", good, "--at", "99", "-o", out("f.png")}, 78, "the time of the recording");
  refused({"figure", good, "-o", out("no_folder/f.png")}, 70, "cannot write");
  refused({"film", good, "-o", out("film.avi")}, 64, "accepted a name that ends in .mp4");
  refused({"film", good, "-o", out("film.mp4"), "--size", "641x360"}, 64, "even numbers");
  refused({"film", good, "-o", out("film.mp4"), "--from", "3", "--to", "2"}, 64, "accepted more than --from");
  refused({"film", good, "-o", out("film.mp4"), "--from", "50"}, 78, "the time of the recording");
  refused({"film", good, "-o", out("no_folder/film.mp4")}, 70, "cannot write");
  refused({"film", dir_.string(), "-o", out("film.mp4")}, 64, "which has no run.mcap");
  std::ofstream(dir_ / "text.mcap") << "this is no recording";
  refused({"film", out("text.mcap"), "-o", out("film.mp4")}, 70, "text.mcap");
  for (const char* name : {"f.png", "film.mp4"}) EXPECT_FALSE(fs::exists(dir_ / name)) << name;
  EXPECT_EQ(unfinished().size(), 0u);
}

}  // namespace
}  // namespace constrictor::testing
