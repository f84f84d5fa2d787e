// The layout of the figure in its three formats: OpenCV reads PNG, and the text of SVG and PDF is searched.
#include "sim/figure/figure.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <set>

#include "sim/figure/lazy_figure.hpp"
#include "support/temporary_folder.hpp"

namespace constrictor::figure {
namespace {

TorqueSeries sine() {
  TorqueSeries torques;
  torques.torque_nm.resize(2);
  for (int i = 0; i < 100; ++i) {
    torques.time_s.push_back(0.1 * i);
    torques.torque_nm[0].push_back(3.0 * std::sin(0.2 * i));
    torques.torque_nm[1].push_back(3.0 * std::cos(0.2 * i));
  }
  return torques;
}

Row blue_row() {
  const std::vector<std::uint8_t> pixel = {0, 0, 255};
  Row row;
  row.time_s = 2.0;
  row.caption = "green object grasped";
  row.state = "grasp";
  row.scene = Picture(1, 1, pixel.data());
  return row;
}

std::string draw(const Heading& heading, const std::vector<Row>& rows, Format format, double scale = 1.0) {
  return draw_figure(heading, rows, sine(), 30.0, format, scale);
}

cv::Mat decoded(const std::string& png) {
  return cv::imdecode(std::vector<unsigned char>(png.begin(), png.end()), cv::IMREAD_COLOR);
}

TEST(Figure, ParsesTheTorqueJournal) {
  const TorqueSeries series =
      parse_torques("sim_time_s,joint_0_nm,joint_2_nm\n0.100,1.5000,-2.2500\n0.200,0.0000,3.0000\n");
  ASSERT_EQ(series.torque_nm.size(), 2U);
  EXPECT_EQ(series.time_s, (std::vector<double>{0.1, 0.2}));
  EXPECT_EQ(series.torque_nm[0], (std::vector<double>{1.5, 0.0}));
  EXPECT_EQ(series.torque_nm[1], (std::vector<double>{-2.25, 3.0}));
  EXPECT_TRUE(parse_torques("").time_s.empty());
}

TEST(Figure, ShowsTheWholeNameOfAState) {
  Row row = blue_row();
  row.state = "follow line to drop zone";
  const std::string svg = draw({"title", "subtitle", ""}, {row}, Format::kSvg);
  std::size_t at = 0;  // the words stand one after the other, perhaps in several lines
  for (const char* word : {"follow", "line", "to", "drop", "zone"}) {
    at = svg.find(word, at);
    ASSERT_NE(at, std::string::npos) << word;
  }
  EXPECT_EQ(svg.find("…"), std::string::npos);
  row.state = std::string(300, 'x');
  EXPECT_NE(draw({"title", "subtitle", ""}, {row}, Format::kSvg).find("…"), std::string::npos);
}

TEST(Figure, HasARowForEachMomentWithItsPictures) {
  const cv::Mat one = decoded(draw({"title", "subtitle", ""}, {blue_row()}, Format::kPng));
  const cv::Mat three = decoded(draw({"title", "subtitle", ""}, {blue_row(), blue_row(), blue_row()}, Format::kPng));
  EXPECT_EQ(one.cols, 1400);
  EXPECT_EQ(three.cols, 1400);
  const int row_height = (three.rows - one.rows) / 2;
  EXPECT_GT(row_height, 150);
  cv::Mat blue;
  cv::inRange(three, cv::Scalar(250, 0, 0), cv::Scalar(255, 5, 5), blue);
  EXPECT_NEAR(cv::countNonZero(blue), 3 * 320 * 180, 3 * 2 * (320 + 180));  // without the frames
  const cv::Mat half = decoded(draw({"title", "subtitle", ""}, {blue_row()}, Format::kPng, 0.5));
  EXPECT_EQ(half.size(), cv::Size((one.cols + 1) / 2, (one.rows + 1) / 2));
}

TEST(Figure, LeavesTheColumnOfTheSceneOutIfNoMomentHasOne) {
  Row real = blue_row();
  std::swap(real.camera, real.scene);
  const std::string svg = draw({"title", "subtitle", ""}, {real, real}, Format::kSvg);
  EXPECT_EQ(svg.find(">Scene</text>"), std::string::npos);
  EXPECT_NE(svg.find(">Camera</text>"), std::string::npos);
  const cv::Mat figure = decoded(draw({"title", "subtitle", ""}, {real, real}, Format::kPng));
  EXPECT_EQ(figure.cols, 1400);
  cv::Mat blue;
  cv::inRange(figure, cv::Scalar(250, 0, 0), cv::Scalar(255, 5, 5), blue);
  EXPECT_NEAR(cv::boundingRect(blue).x, 24 + 150 + 10, 1) << "the camera is beside the caption";
  EXPECT_NEAR(cv::countNonZero(blue), 2 * 240 * 180, 2 * 2 * (240 + 180));

  const std::string mixed = draw({"title", "subtitle", ""}, {blue_row(), real}, Format::kSvg);
  EXPECT_NE(mixed.find(">Scene</text>"), std::string::npos);
}

TEST(Figure, NamesWhyTheMissionDidNotSucceedInRed) {
  const auto red_pixels = [](const cv::Mat& figure) {
    std::vector<cv::Mat> bgr;
    cv::split(figure(cv::Rect(0, 0, figure.cols, 95)), bgr);
    return cv::countNonZero(bgr[2] - bgr[1] > 60);
  };
  const auto figure = [](const std::string& failure) {
    return decoded(draw_figure({"title", "subtitle", failure}, {}, {}, 30.0, Format::kPng));
  };
  const cv::Mat success = figure(""), failure = figure("time limit of 900 s"), lengthy = figure(std::string(2000, 'x'));
  EXPECT_EQ(red_pixels(success), 0);
  EXPECT_GT(red_pixels(failure), 100);
  EXPECT_GT(failure.rows, success.rows);
  EXPECT_EQ(lengthy.cols, success.cols);
  EXPECT_EQ(cv::countNonZero(lengthy(cv::Rect(lengthy.cols - 20, 70, 20, 22)).reshape(1) != 255), 0)
      << "a long reason is cut before the margin";
}

TEST(Figure, TextsOfAnSvgFileCanBeSearched) {
  const std::string svg = draw({"title & <subtitle>", "", "\x1b[2J"}, {blue_row()}, Format::kSvg);
  EXPECT_EQ(svg.rfind("<?xml", 0), 0U);
  for (const char* words : {">Scene</text>", ">Camera</text>", ">Processed</text>", ">Yaw torques [Nm]</text>",
                            ">green object</text>", ">grasped</text>", ">grasp</text>", ">2.0 s</text>", ">10 s</text>",
                            ">−2</text>", ">head</text>", ">tail</text>", ">title &amp; &lt;subtitle&gt;</text>"})
    EXPECT_NE(svg.find(words), std::string::npos) << words;
  EXPECT_EQ(svg.find('\x1b'), std::string::npos) << "control characters are not allowed in XML";
  EXPECT_EQ(svg.find("<symbol"), std::string::npos) << "text is not drawn as outlines";
}

/// Where a text of an SVG file begins and ends.
std::pair<double, double> place_of(const std::string& svg, const std::string& words) {
  const std::size_t end = svg.find(">" + words + "</text>");
  if (end == std::string::npos) return {};
  const std::string text = svg.substr(svg.rfind("<text", end), end);
  const auto value = [&](const std::string& name) { return std::stod(text.substr(text.find(name) + name.size())); };
  const double x = value(" x=\"");
  return {x, x + value(" textLength=\"")};
}

TEST(Figure, TheKeyOfManyJointsStaysBesideTheHeading) {
  for (const std::size_t joints : {1, 2, 12, 16, 32, 63}) {
    TorqueSeries torques;
    torques.torque_nm.resize(joints);
    const std::string svg = draw_figure({"title", "", ""}, {}, torques, 30.0, Format::kSvg);
    const auto heading = place_of(svg, "Yaw torques [Nm]"), head = place_of(svg, "head"), tail = place_of(svg, "tail");
    EXPECT_GT(heading.second, heading.first);
    EXPECT_GE(head.first, heading.second + 8.0) << joints << " joints";
    EXPECT_GT(tail.first, head.second) << joints << " joints";
    EXPECT_NEAR(tail.second, 1400.0 - 24.0, 0.01);
    // The colours between the two words: runs of at least three equal pixels that are not the white of the paper.
    const cv::Mat figure = decoded(draw_figure({"title", "", ""}, {}, torques, 30.0, Format::kPng, 4.0));
    const int from = static_cast<int>(4.0 * head.second), to = static_cast<int>(4.0 * tail.first);
    const cv::Mat row = figure(cv::Rect(from, 4 * (108 - 10) - 12, to - from, 1));
    std::set<std::array<int, 3>> colours;
    for (int x = 2; x < row.cols; ++x) {
      const auto& pixel = row.at<cv::Vec3b>(0, x);
      const bool solid = pixel == row.at<cv::Vec3b>(0, x - 1) && pixel == row.at<cv::Vec3b>(0, x - 2);
      if (solid && pixel != cv::Vec3b(255, 255, 255)) colours.insert({pixel[0], pixel[1], pixel[2]});
    }
    EXPECT_EQ(colours.size(), joints) << "each joint has its colour";
  }
}

TEST(Figure, APdfFileHasItsFontsAndIsTheSameEachTime) {
  const std::string pdf = draw({"title", "subtitle", ""}, {blue_row()}, Format::kPdf);
  EXPECT_EQ(pdf.rfind("%PDF-", 0), 0U);
  EXPECT_NE(pdf.find("DejaVuSans"), std::string::npos);
  EXPECT_NE(pdf.find("%%EOF"), std::string::npos);
  EXPECT_EQ(pdf, draw({"title", "subtitle", ""}, {blue_row()}, Format::kPdf));
}

TEST(Figure, ALongCaptionStaysInItsColumn) {
  Canvas canvas(10, 10, 1.0);
  const TextStyle style{14.0};
  const auto lines = canvas.wrapped("an averylongwordthatdoesnotfitintotheline of a caption", 100.0, style);
  EXPECT_GT(lines.size(), 3U);
  std::string joined;
  for (const auto& line : lines) {
    EXPECT_LE(canvas.width_of(line, style), 100.0) << line;
    joined += line;
  }
  std::erase(joined, ' ');
  EXPECT_EQ(joined, "anaverylongwordthatdoesnotfitintothelineofacaption");
  EXPECT_TRUE(canvas.wrapped("words", 0.5, style).empty());
  EXPECT_EQ(canvas.fitted("short", 100.0, style), "short");
  EXPECT_LE(canvas.width_of(canvas.fitted(std::string(500, 'w'), 100.0, style), style), 100.0);
}

TEST(Figure, TheModuleDrawsTheSameFigureFromFiles) {
  const testing::TemporaryFolder folder;
  const auto file = folder.path() / "blue.png";
  cv::imwrite(file.string(), cv::Mat(9, 16, CV_8UC3, cv::Scalar(255, 0, 0)));
  std::ofstream(folder.path() / "text.png") << "this is no PNG file";
  FileRow row{2.0, "green object grasped", "grasp", 1, file, folder.path() / "missing.png", folder.path() / "text.png"};
  Row expected{2.0, "green object grasped", "grasp", 1, Picture::read_png(file), {}, {}};
  EXPECT_FALSE(expected.scene.empty());
  EXPECT_TRUE(Picture::read_png(folder.path() / "text.png").empty());
  const std::string csv = "time_s,joint_0_nm\n0.0,1.0\n5.0,-1.0\n";
  EXPECT_EQ(draw_png_lazily({"title", "", ""}, {row}, csv, 30.0),
            draw_figure({"title", "", ""}, {expected}, parse_torques(csv), 30.0, Format::kPng));
}

TEST(Figure, TheEndingChoosesTheFormat) {
  EXPECT_EQ(format_of("a/figure.png"), Format::kPng);
  EXPECT_EQ(format_of("figure.SVG"), Format::kSvg);
  EXPECT_EQ(format_of("figure.pdf"), Format::kPdf);
  EXPECT_EQ(format_of("figure.jpg"), std::nullopt);
  EXPECT_EQ(format_of("figure"), std::nullopt);
}

}  // namespace
}  // namespace constrictor::figure
