// The layout of the figure and the files that it reads.
#include "sim/report/figure.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgcodecs.hpp>

#include "sim/report/moments.hpp"
#include "support/temporary_folder.hpp"

namespace constrictor::report {
namespace {

TEST(Figure, ParsesTheTorqueJournal) {
  const TorqueSeries series =
      parse_torques("sim_time_s,joint_0_nm,joint_2_nm\n0.100,1.5000,-2.2500\n0.200,0.0000,3.0000\n");
  ASSERT_EQ(series.torque_nm.size(), 2U);
  EXPECT_EQ(series.time_s, (std::vector<double>{0.1, 0.2}));
  EXPECT_EQ(series.torque_nm[0], (std::vector<double>{1.5, 0.0}));
  EXPECT_EQ(series.torque_nm[1], (std::vector<double>{-2.25, 3.0}));
  EXPECT_TRUE(parse_torques("").time_s.empty());
}

TEST(Figure, HasARowForEachMomentWithItsPictures) {
  const testing::TemporaryFolder folder;
  const auto file = folder.path() / "blue.png";
  cv::imwrite(file.string(), cv::Mat(90, 160, CV_8UC3, cv::Scalar(255, 0, 0)));
  FigureRow row;
  row.time_s = 2.0;
  row.caption = "green object grasped";
  row.scene = file;
  TorqueSeries torques;
  torques.torque_nm.resize(1);
  for (int i = 0; i < 100; ++i) {
    torques.time_s.push_back(0.1 * i);
    torques.torque_nm[0].push_back(3.0 * std::sin(0.2 * i));
  }
  const cv::Mat one = draw_figure({"title", "subtitle", ""}, {row}, torques, 30.0);
  const cv::Mat three = draw_figure({"title", "subtitle", ""}, {row, row, row}, torques, 30.0);
  EXPECT_EQ(one.cols, three.cols);
  const int row_height = (three.rows - one.rows) / 2;
  EXPECT_GT(row_height, 150);
  cv::Mat blue;
  cv::inRange(three, cv::Scalar(250, 0, 0), cv::Scalar(255, 5, 5), blue);
  EXPECT_NEAR(cv::countNonZero(blue), 3 * 320 * 180, 3 * 2 * (320 + 180));  // without the frames
}

TEST(Figure, NamesWhyTheMissionDidNotSucceedInRed) {
  const auto red_pixels = [](const cv::Mat& figure) {
    std::vector<cv::Mat> bgr;
    cv::split(figure(cv::Rect(0, 0, figure.cols, 90)), bgr);
    return cv::countNonZero(bgr[2] - bgr[1] > 60);
  };
  const cv::Mat success = draw_figure({"title", "subtitle", ""}, {}, {}, 30.0);
  const cv::Mat failure = draw_figure({"title", "subtitle", "time limit of 900 s"}, {}, {}, 30.0);
  const cv::Mat lengthy = draw_figure({"title", "subtitle", std::string(1000, 'x')}, {}, {}, 30.0);
  EXPECT_EQ(red_pixels(success), 0);
  EXPECT_GT(red_pixels(failure), 100);
  EXPECT_GT(failure.rows, success.rows);
  EXPECT_EQ(lengthy.cols, success.cols);
  EXPECT_EQ(cv::countNonZero(lengthy(cv::Rect(lengthy.cols - 20, 70, 20, 20)).reshape(1) != 255), 0)
      << "a long reason is cut before the margin";
}

TEST(FigureRows, KeepTheFirstFindingAndTheLastRepetition) {
  const auto moment = [](std::int64_t tick, std::uint8_t event, std::uint8_t colour) {
    Moment m;
    m.tick = tick;
    m.event = event;
    m.colour = colour;
    return m;
  };
  const auto rows = figure_rows(
      {moment(1, msg::kEventObjectFound, msg::kColourGreen), moment(2, msg::kEventObjectGrasped, msg::kColourGreen),
       moment(3, msg::kEventObjectFound, msg::kColourGreen), moment(4, msg::kEventObjectGrasped, msg::kColourGreen),
       moment(5, msg::kEventObjectGrasped, msg::kColourRed)});
  ASSERT_EQ(rows.size(), 3U);
  EXPECT_EQ(rows[0].tick, 1);
  EXPECT_EQ(rows[1].tick, 4);
  EXPECT_EQ(rows[2].tick, 5);
}

}  // namespace
}  // namespace constrictor::report
