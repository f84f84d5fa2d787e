// Lens and mount from drawn pictures of a board, whose camera is known.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <numbers>
#include <opencv2/imgcodecs.hpp>

#include "camera_setup/lens.hpp"
#include "camera_setup/mount.hpp"
#include "component/data_path.hpp"
#include "configuration/configuration.hpp"
#include "drawn_board.hpp"
#include "robot/camera_mount.hpp"
#include "robot/robot_model.hpp"
#include "support/process.hpp"

namespace constrictor::camera_setup {
namespace {

using camera_setup::Board;
using camera_setup::Corners;
using Eigen::AngleAxisd;
using Eigen::Vector3d;
using namespace std::chrono_literals;

constexpr double kDegree = std::numbers::pi / 180.0;

video::CameraCalibration true_camera() {
  video::CameraCalibration c{.width = 640, .height = 480, .fx = 420.0, .fy = 424.0, .cx = 327.0, .cy = 233.0};
  c.distortion = {-0.25, 0.08, 0.001, -0.0005, -0.01};
  return c;
}

const Board kBoard{8, 6, 0.03};

/// The middle of the board at `p_C`, turned about x, y and z [degrees].
Eigen::Isometry3d board_at(const Vector3d& p_C, double about_x, double about_y, double about_z) {
  Eigen::Isometry3d X_CB = Eigen::Isometry3d::Identity();
  X_CB.linear() = (AngleAxisd(about_x * kDegree, Vector3d::UnitX()) * AngleAxisd(about_y * kDegree, Vector3d::UnitY()) *
                   AngleAxisd(about_z * kDegree, Vector3d::UnitZ()))
                      .toRotationMatrix();
  X_CB.translation() = p_C - X_CB.linear() * Vector3d(0.5 * (kBoard.columns - 1) * kBoard.square_m,
                                                      0.5 * (kBoard.rows - 1) * kBoard.square_m, 0.0);
  return X_CB;
}

const std::vector<Eigen::Isometry3d>& poses() {
  static const std::vector<Eigen::Isometry3d> kPoses = {
      board_at({0.0, 0.0, 0.35}, 0, 0, 0),       board_at({-0.13, -0.06, 0.4}, 20, 15, 5),
      board_at({0.13, -0.07, 0.4}, -20, 20, -8), board_at({-0.13, 0.08, 0.42}, 25, -20, 3),
      board_at({0.13, 0.08, 0.42}, -15, -25, 0), board_at({0.0, 0.0, 0.6}, 35, 0, 10),
      board_at({0.02, -0.02, 0.45}, 0, 35, 90),  board_at({-0.02, 0.02, 0.3}, -10, 10, 0),
      board_at({0.2, 0.0, 0.5}, 0, -35, 0),      board_at({-0.2, 0.0, 0.5}, 0, 35, 0)};
  return kPoses;
}

const BoardPainter& painter() {
  static const BoardPainter kPainter(true_camera());
  return kPainter;
}

const std::vector<cv::Mat>& pictures() {
  static const std::vector<cv::Mat> kPictures = [] {
    std::vector<cv::Mat> drawn;
    for (const auto& X_CB : poses()) drawn.push_back(painter().draw(kBoard, X_CB));
    return drawn;
  }();
  return kPictures;
}

TEST(Lens, IsFoundFromDrawnPictures) {
  const auto camera = true_camera();
  std::vector<Corners> views;
  for (const auto& picture : pictures()) {
    const auto corners = camera_setup::find_board(picture, kBoard);
    if (corners) views.push_back(*corners);
  }
  ASSERT_GE(views.size(), 8U);
  const auto result = camera_setup::calibrate_lens(views, kBoard, {640, 480});
  const auto& found = result.calibration;
  EXPECT_LT(found.reprojection_error_px.value(), 0.2);
  EXPECT_NEAR(found.fx, camera.fx, 0.005 * camera.fx);
  EXPECT_NEAR(found.fy, camera.fy, 0.005 * camera.fy);
  EXPECT_NEAR(found.cx, camera.cx, 1.5);
  EXPECT_NEAR(found.cy, camera.cy, 1.5);
  // What counts is where rays go, because the coefficients share the work.
  for (const double u : {60.0, 320.0, 580.0}) {
    for (const double v : {60.0, 240.0, 420.0}) {
      const Vector3d expected = ray_of(camera, u, v).normalized(), ray = ray_of(found, u, v).normalized();
      EXPECT_LT(std::acos(std::min(1.0, expected.dot(ray))), 0.3 * kDegree) << u << " " << v;
    }
  }
  EXPECT_EQ(result.view_errors_px.size(), views.size());
}

TEST(Lens, RefusesTooFewViewsAndViewsThatSayNothing) {
  const auto corners = camera_setup::find_board(pictures()[0], kBoard);
  ASSERT_TRUE(corners.has_value());
  EXPECT_THROW(static_cast<void>(camera_setup::calibrate_lens({*corners}, kBoard, {640, 480})), std::invalid_argument);
  const auto warned = camera_setup::calibrate_lens(std::vector<Corners>(8, *corners), kBoard, {640, 480}).warnings;
  EXPECT_FALSE(warned.empty()) << "no view shows the board at the borders";
}

TEST(Board, IsNotFoundWhereThereIsNone) {
  EXPECT_FALSE(camera_setup::find_board(cv::Mat(480, 640, CV_8UC3, cv::Scalar::all(128)), kBoard).has_value());
  EXPECT_FALSE(camera_setup::find_board(pictures()[0], Board{9, 6, 0.03}).has_value());
}

/// A board as a person lays it down before a head whose centre is `height_m` above the ground: its rows run to the
/// right, its columns towards the robot.
Eigen::Isometry3d board_on_ground(const Board& board, const camera_setup::BoardOnGround& place, double height_m) {
  Eigen::Isometry3d X_HB = Eigen::Isometry3d::Identity();
  X_HB.linear().col(0) = Vector3d(0, -1, 0);
  X_HB.linear().col(1) = Vector3d(-1, 0, 0);
  X_HB.linear().col(2) = Vector3d(0, 0, -1);
  X_HB.linear() = AngleAxisd(place.yaw_rad, Vector3d::UnitZ()).toRotationMatrix() * X_HB.linear();
  const Vector3d middle(0.5 * (board.columns - 1) * board.square_m, 0.5 * (board.rows - 1) * board.square_m, 0);
  X_HB.translation() = Vector3d(place.x_m, place.y_m, -height_m) - X_HB.linear() * middle;
  return X_HB;
}

TEST(Mount, IsFoundFromABoardOnTheGround) {
  CameraModel model;
  model.p_HC = {0.06, 0.0, 0.05};
  model.tilt_rad = 0.5;
  const Eigen::Isometry3d expected = camera_mount(model);
  Eigen::Isometry3d X_HC = expected;  // the real one is a little different
  X_HC.translation() += Vector3d(0.004, -0.003, 0.002);
  X_HC.linear() = AngleAxisd(2.0 * kDegree, Vector3d(0.3, 1.0, 0.5).normalized()).toRotationMatrix() * X_HC.linear();
  const auto lens = true_camera();
  const double height_m = 0.035;
  const Board board{6, 5, 0.04};  // the camera is low: it sees a board on the ground from the side
  for (const double yaw : {0.0, 20.0, -35.0}) {
    const camera_setup::BoardOnGround place{0.36, 0.01, yaw * kDegree};
    const Eigen::Isometry3d X_HB = board_on_ground(board, place, height_m);
    const cv::Mat picture = painter().draw(board, X_HC.inverse() * X_HB);
    const auto corners = camera_setup::find_board_on_ground(picture, board, place, lens, height_m, expected);
    ASSERT_TRUE(corners.has_value()) << yaw;
    const auto found = camera_setup::find_mount(*corners, board, place, lens, height_m, expected);
    EXPECT_LT((found.X_HC.translation() - X_HC.translation()).norm(), 0.002) << yaw;
    EXPECT_LT(AngleAxisd(found.X_HC.linear().transpose() * X_HC.linear()).angle(), 0.4 * kDegree) << yaw;
    EXPECT_LT(found.error_px, 0.3);
    EXPECT_EQ(camera_setup::doubt_of_mount(found.X_HC, expected), "");
  }
}

TEST(Mount, AWrongSizeOfTheSquaresAndAWrongOrderOfTheNumbersAreRefused) {
  const RobotModel robot = load_robot(data_path("components/lib/robot/mamba.yaml"));
  const auto lens = video::calibration_of(robot.camera);
  const Board board{6, 5, 0.04};
  const camera_setup::BoardOnGround place{0.36, 0.0, 0.0};
  const Eigen::Isometry3d X_HB = board_on_ground(board, place, robot.module_radius_m);
  const testing::TemporaryFolder folder;
  const std::string picture = (folder.path() / "board.png").string(), file = (folder.path() / "camera.yaml").string();
  ASSERT_TRUE(cv::imwrite(picture, BoardPainter(lens).draw(board, camera_mount(robot.camera).inverse() * X_HB)));
  const std::string before = video::calibration_text(lens, false, "this test");
  std::ofstream(file) << before;
  const auto content = [&]() -> std::string {
    std::ifstream stream(file);
    return {std::istreambuf_iterator<char>(stream), {}};
  };
  const auto mount = [&](const std::string& numbers, const std::string& square, std::vector<std::string> more,
                         int status) -> std::string {
    std::vector<std::string> words = {testing::program("camera_setup"),
                                      "mount",
                                      "--source",
                                      picture,
                                      "--calibration",
                                      file,
                                      "--at",
                                      "0.36,0",
                                      "--board",
                                      numbers,
                                      "--square",
                                      square};
    words.insert(words.end(), more.begin(), more.end());
    testing::Process process(std::move(words));
    EXPECT_EQ(process.wait(60s), status) << process.output() << process.errors();
    return process.output() + process.errors();
  };
  const std::string size = mount("6x5", "0.4", {}, 1);
  EXPECT_NE(size.find("m from the centre of the head, accepted at most 0.3 m"), std::string::npos) << size;
  EXPECT_NE(size.find("--square"), std::string::npos) << size;
  const std::string order = mount("5x6", "0.04", {}, 1);
  EXPECT_NE(order.find("numbers of --board in the right order"), std::string::npos) << order;
  EXPECT_EQ(content(), before) << "nothing was written";
  const std::string other = (folder.path() / "other.yaml").string();
  EXPECT_NE(mount("6x5", "0.4", {"--accept-mount", "--out", other}, 0).find("careful: found a camera"),
            std::string::npos);
  mount("6x5", "0.04", {}, 0);
  EXPECT_NE(content().find("mount:"), std::string::npos) << content();
}

TEST(CameraSetup, CalibratesFromAFolderOfPicturesAndRefusesNonsense) {
  const testing::TemporaryFolder folder;
  const auto place = folder.path() / "pictures";
  std::filesystem::create_directory(place);
  const auto run = [&](std::vector<std::string> arguments, int status) -> std::string {
    arguments.insert(arguments.begin(), testing::program("camera_setup"));
    testing::Process process(std::move(arguments));
    EXPECT_EQ(process.wait(60s), status) << process.output() << process.errors();
    return process.output() + process.errors();
  };
  const std::string out = (folder.path() / "camera.yaml").string();
  EXPECT_NE(
      run({"calibrate", "--source", place.string(), "--square", "0.03", "--out", out}, 70).find("found no picture"),
      std::string::npos);
  for (std::size_t i = 0; i < pictures().size(); ++i)
    ASSERT_TRUE(cv::imwrite((place / fmt::format("{:02}.png", i)).string(), pictures()[i]));
  const std::string source = place.string();
  EXPECT_NE(run({"calibrate", "--source", source, "--board", "9x7", "--square", "0.03", "--out", out}, 1)
                .find("inner corners"),
            std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(out));
  const std::string text =
      run({"calibrate", "--source", source, "--board", "8x6", "--square", "0.03", "--out", out}, 0);
  EXPECT_NE(text.find("reprojection error 0."), std::string::npos) << text;
  EXPECT_NEAR(video::load_calibration(out, CameraModel{}).fx, true_camera().fx, 3.0);
  EXPECT_NE(run({"show", "--source", source}, 0).find("640 x 480 pixels"), std::string::npos);
  EXPECT_NE(run({"calibrate", "--source", source, "--board", "8", "--square", "0.03", "--out", out}, 64)
                .find("--board: found '8', accepted COLUMNSxROWS"),
            std::string::npos);
  EXPECT_NE(run({"colours", "--source", source, "--sample", "blue=1,2", "--out", out}, 64)
                .find("--sample: found 'blue=1,2', accepted COLOUR=X,Y,WIDTH,HEIGHT"),
            std::string::npos);
  EXPECT_NE(run({"colours", "--source", source, "--sample", "blue=630,2,20,20", "--out", out}, 1)
                .find("--sample: found a box of blue beyond the picture"),
            std::string::npos);
}

}  // namespace
}  // namespace constrictor::camera_setup
