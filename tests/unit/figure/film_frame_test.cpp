// Frames of the film: size, place of the panels, progress.
#include "sim/figure/film_frame.hpp"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

namespace constrictor::figure {
namespace {

cv::Mat draw(int width, int height, const FilmFrame& frame) {
  Canvas canvas(width, height, film_scale(width, height));
  TorqueSeries torques;
  torques.time_s = {0.0, 5.0, 10.0, 15.0};
  torques.torque_nm = {{0.0, 1.0, -1.0, 1.0}};
  draw_film_frame(canvas, width, height, frame, torques, 2.0, {{5.0, 2}});
  cv::Mat bgr;
  cv::cvtColor(cv::Mat(height, width, CV_8UC4, const_cast<std::uint8_t*>(canvas.pixels())), bgr, cv::COLOR_BGRA2BGR);
  return bgr;
}

FilmFrame frame_at(double time_s) {
  const std::vector<std::uint8_t> red = {255, 0, 0};
  return {time_s, 0.0, 20.0, "case_study, seed 1", "transport", "green object grasped", Picture(1, 1, red.data()),
          {},     {}};
}

int count(const cv::Mat& bgr, const cv::Scalar& colour) {
  cv::Mat found;
  cv::inRange(bgr, colour, colour, found);
  return cv::countNonZero(found);
}

TEST(FilmFrame, HasTheSceneInItsPlaceAtEachSize) {
  for (const cv::Size size : {cv::Size(1280, 720), cv::Size(640, 360), cv::Size(640, 480), cv::Size(1920, 1080)}) {
    const cv::Mat frame = draw(size.width, size.height, frame_at(7.0));
    ASSERT_EQ(frame.size(), size);
    const double scale = film_scale(size.width, size.height);
    EXPECT_NEAR(count(frame, {0, 0, 255}) / (scale * scale * kFilmScene.width * kFilmScene.height), 1.0, 0.02);
    EXPECT_EQ(count(frame.col(0), {255, 255, 255}), size.height) << "the border is free";
    EXPECT_EQ(count(frame.col(size.width - 1), {255, 255, 255}), size.height);
  }
}

TEST(FilmFrame, ShowsTheTimeOnlyUntilNow) {
  const cv::Mat early = draw(1280, 720, frame_at(2.0)), late = draw(1280, 720, frame_at(18.0));
  const cv::Rect bar(16, 690, 1248, 8);
  EXPECT_GT(count(early(bar), {230, 227, 227}), 2 * count(late(bar), {230, 227, 227})) << "the bar fills";
  cv::Mat difference;
  cv::absdiff(early, late, difference);
  EXPECT_GT(cv::countNonZero(difference.reshape(1)), 1000);
}

}  // namespace
}  // namespace constrictor::figure
