#include "camera_setup/commands.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <map>
#include <numbers>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "camera_setup/colours.hpp"
#include "camera_setup/command_steps.hpp"
#include "camera_setup/lens.hpp"
#include "camera_setup/mount.hpp"
#include "constrictor/constants.hpp"
#include "robot/camera_mount.hpp"
#include "runtime/host.hpp"
#include "video/rectifier.hpp"

namespace constrictor::camera_setup {

volatile std::sig_atomic_t g_signal = 0;

namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

constexpr double kSteady_px = 0.7;         // a board that moves less between two frames is held still
constexpr auto kNoBoardEvery = 1s;         // between two lines on a board that is not in view
constexpr double kLeastDifference = 0.15;  // between two views of a board; see Pose2

/// The board that a value of --board describes; empty if there is none.
std::optional<Board> board_in(const std::string& text) {
  const auto accepted = [](int count) { return count >= 3 && count <= 50; };
  Board board;
  char rest = 0;
  if (std::sscanf(text.c_str(), "%dx%d%c", &board.columns, &board.rows, &rest) != 2 || !accepted(board.columns) ||
      !accepted(board.rows))
    return std::nullopt;
  return board;
}

Board board_of(const Options& options) {
  Board board = board_in(options.board).value();
  board.square_m = options.square_m;
  return board;
}

}  // namespace

int show(const Options& options) {
  if (!options.out.empty()) require_writable(options.out);
  FrameReader reader = reader_of(options);
  cv::Mat picture;
  for (int i = 0; i < (reader.live() ? 20 : 1) && !stopped(); ++i) {
    auto found = next(reader);
    if (!found) break;
    picture = *found;
  }
  if (picture.empty()) return 128 + g_signal;
  const auto counters = reader.counters();
  const cv::Scalar mean = cv::mean(picture);
  fmt::print("{} x {} pixels, mean brightness {:.0f} of 255", picture.cols, picture.rows,
             (mean[0] + mean[1] + mean[2]) / 3);
  if (reader.live()) fmt::print(", {:.1f} frames in a second", counters.rate_hz);
  // Without an expected rate, nothing tells how many frames there should have been.
  if (reader.live() && options.rate_given) fmt::print(", {} missing of {}", counters.missing, counters.frames);
  fmt::print("\n");
  if (!options.out.empty()) {
    if (!cv::imwrite(options.out.string(), picture))
      throw Failed(fmt::format("--out: cannot write {}: is the disk full?", options.out.string()));
    fmt::print("wrote {}\n", options.out.string());
  }
  return exit_status::kOk;
}

int calibrate(const Options& options) {
  const Board board = board_of(options);
  require_writable(options.out);
  FrameReader reader = reader_of(options);
  if (reader.live())
    fmt::print(
        "Show the board to the camera: in every corner of the picture, near and far, slanted to all sides. Hold it\n"
        "still until it is counted. Ctrl-C ends the collection.\n");
  std::vector<Corners> views;
  std::vector<Pose2> poses;
  std::optional<Corners> before;
  cv::Size size;
  int pictures = 0;
  while (!stopped() && (!reader.live() || views.size() < options.views)) {
    const auto picture = next(reader);
    if (!picture) break;
    ++pictures;
    if (!views.empty() && picture->size() != size)
      throw Failed(fmt::format("found pictures of {} x {} and of {} x {} pixels, accepted one size", size.width,
                               size.height, picture->cols, picture->rows));
    size = picture->size();
    auto corners = find_board(*picture, board);
    const bool steady = !reader.live() || (corners && before && largest_motion(*corners, *before) < kSteady_px);
    before = corners;
    if (!corners || !steady) continue;
    const Pose2 pose = pose_in_picture(*corners, board, size);
    const auto same = [&](const Pose2& other) { return difference(pose, other) < kLeastDifference; };
    if (reader.live() && std::any_of(poses.begin(), poses.end(), same)) continue;
    views.push_back(std::move(*corners));
    poses.push_back(pose);
    if (reader.live()) fmt::print("view {} of {}\n", views.size(), options.views);
    std::fflush(stdout);
  }
  fmt::print("the board was found in {} of {} pictures\n", views.size(), pictures);
  LensResult result;
  try {
    result = calibrate_lens(views, board, size);
  } catch (const std::invalid_argument& error) {
    throw Failed(fmt::format("{}; is --board the number of inner corners?", error.what()));
  }
  for (std::size_t i = 0; i < views.size(); ++i) fmt::print("view {}: {:.3f} pixel\n", i + 1, result.view_errors_px[i]);
  const auto& c = result.calibration;
  fmt::print("focal lengths {:.1f} and {:.1f} pixel, field of view {:.1f} degrees, reprojection error {:.3f} pixel\n",
             c.fx, c.fy, 360.0 / std::numbers::pi * std::atan(0.5 * c.width / c.fx), *c.reprojection_error_px);
  for (const auto& line : result.warnings) fmt::print("careful: {}\n", line);
  if (*c.reprojection_error_px > options.largest_error_px)
    throw Failed(
        fmt::format("the reprojection error is {:.3f} pixel, accepted at most {:g} (--largest-error); nothing was "
                    "written",
                    *c.reprojection_error_px, options.largest_error_px));
  write(options.out, calibration_text(c, false, "constrictor camera calibrate"));
  return exit_status::kOk;
}

namespace {

/// Prints once a second what a live source without a board shows, and gives up `within_s` after the first picture.
class NoBoard {
 public:
  NoBoard(const Board& board, double within_s) : board_(board), within_s_(within_s) {}

  /// Throws Failed when the time is over.
  void look(const cv::Mat& picture) {
    const auto now = Clock::now();
    if (pictures_++ == 0) begin_ = next_ = now;
    const double waited_s = std::chrono::duration<double>(now - begin_).count();
    if (waited_s > within_s_)
      throw Failed(
          fmt::format("found no board of {} x {} corners within {:g} s (--within): is the whole board in the picture, "
                      "flat and in good light, and are the numbers of --board right? Nothing was written",
                      board_.columns, board_.rows, within_s_));
    if (now < next_) return;
    next_ = now + kNoBoardEvery;
    const cv::Scalar mean = cv::mean(picture);
    fmt::print("no board of {} x {} corners in view: {} pictures of {} x {} pixels, mean brightness {:.0f} of 255\n",
               board_.columns, board_.rows, pictures_, picture.cols, picture.rows, (mean[0] + mean[1] + mean[2]) / 3);
    std::fflush(stdout);
  }

 private:
  using Clock = std::chrono::steady_clock;
  Board board_;
  double within_s_;
  int pictures_ = 0;
  Clock::time_point begin_, next_;
};

}  // namespace

int mount(const Options& options) {
  const Board board = board_of(options);
  const RobotModel robot = load_robot(options.robot);
  video::CameraCalibration lens = video::load_calibration(options.calibration, robot.camera);
  const fs::path out = options.out.empty() ? fs::path(options.calibration) : options.out;
  require_writable(out);
  FrameReader reader = reader_of(options);
  NoBoard no_board(board, options.within_s);
  const BoardOnGround place{options.at_m[0], options.at_m[1], options.yaw_deg * std::numbers::pi / 180.0};
  while (!stopped()) {
    const auto picture = next(reader);
    if (!picture) break;
    const Eigen::Isometry3d expected = camera_mount(robot.camera);
    const auto scaled = lens.scaled_to(picture->cols, picture->rows);
    const auto corners = find_board_on_ground(*picture, board, place, scaled, robot.module_radius_m, expected);
    if (!corners) {
      if (reader.live()) {
        no_board.look(*picture);
        continue;
      }
      throw Failed("the board is not in the picture, or not wholly");
    }
    const MountResult found = find_mount(*corners, board, place, scaled, robot.module_radius_m, expected);
    const Eigen::Vector3d moved = found.X_HC.translation() - expected.translation();
    const double turned = Eigen::AngleAxisd(expected.linear().transpose() * found.X_HC.linear()).angle();
    const Eigen::Vector3d view = found.X_HC.linear().col(2);
    fmt::print(
        "the camera is at {:.4f} {:.4f} {:.4f} m in the head and looks down by {:.2f} degrees (error {:.3f} pixel)\n",
        found.X_HC.translation().x(), found.X_HC.translation().y(), found.X_HC.translation().z(),
        std::asin(-view.z()) * 180.0 / std::numbers::pi, found.error_px);
    fmt::print("that is {:.4f} m and {:.2f} degrees from the mount in {}\n", moved.norm(),
               turned * 180.0 / std::numbers::pi, options.robot.filename().string());
    if (found.error_px > options.largest_error_px)
      throw Failed(
          fmt::format("the error is {:.3f} pixel, accepted at most {:g} (--largest-error); is the calibration that "
                      "of this camera? Nothing was written",
                      found.error_px, options.largest_error_px));
    if (const std::string doubt = doubt_of_mount(found.X_HC, expected); !doubt.empty()) {
      if (!options.accept_mount)
        throw Failed(fmt::format(
            "{} If the camera really is there, --accept-mount accepts the mount. Nothing was written", doubt));
      fmt::print("careful: {}\n", doubt);
    }
    lens.X_HC = found.X_HC;
    write(out, calibration_text(lens, true, "constrictor camera calibrate and mount"));
    return exit_status::kOk;
  }
  return 128 + g_signal;
}

namespace {

struct Sample {
  std::string name;
  cv::Rect box;
};

std::vector<std::string> sample_names() {
  std::vector<std::string> names = names_of(constants::kColour, msg::kColourUnknown + 1);
  names.emplace_back("ground");
  return names;
}

/// The sample that a value of --sample describes; empty if there is none.
std::optional<Sample> sample_in(const std::string& text) {
  Sample sample;
  const auto equals = text.find('=');
  sample.name = text.substr(0, equals);
  char rest = 0;
  const bool box =
      equals != std::string::npos && std::sscanf(text.c_str() + equals + 1, "%d,%d,%d,%d%c", &sample.box.x,
                                                 &sample.box.y, &sample.box.width, &sample.box.height, &rest) == 4;
  const auto names = sample_names();
  const bool named = std::find(names.begin(), names.end(), sample.name) != names.end();
  if (!box || !named || sample.box.width < 2 || sample.box.height < 2) return std::nullopt;
  return sample;
}

}  // namespace

std::string wrong_board(const std::string& text) {
  if (board_in(text)) return {};
  return fmt::format(
      "found '{}', accepted COLUMNSxROWS of inner corners, for example 9x6 for a board of 10 x 7 squares", text);
}

std::string wrong_sample(const std::string& text) {
  if (sample_in(text)) return {};
  return fmt::format("found '{}', accepted COLOUR=X,Y,WIDTH,HEIGHT in pixels with one of {}", text,
                     fmt::join(sample_names(), ", "));
}

int colours(const Options& options) {
  std::vector<Sample> boxes;
  for (const auto& text : options.samples) boxes.push_back(sample_in(text).value());
  require_writable(options.out);
  std::optional<video::Rectifier> rectifier;
  if (!options.calibration.empty())
    rectifier.emplace(video::load_calibration(options.calibration, load_robot(options.robot).camera), 0, 0);
  FrameReader reader = reader_of(options);
  std::map<std::string, ColourSample> samples;
  for (int i = 0; i < 10 && !stopped(); ++i) {  // several frames, because of the noise
    auto picture = next(reader);
    if (!picture) break;
    if (rectifier) cv::cvtColor(rectifier->rectify(*picture), *picture, cv::COLOR_RGB2BGR);
    for (const auto& [name, box] : boxes) {
      if ((box & cv::Rect({}, picture->size())) != box)
        throw Failed(fmt::format("--sample: found a box of {} beyond the picture, accepted boxes within {} x {} pixels",
                                 name, picture->cols, picture->rows));
      samples[name].add(*picture, box);
    }
  }
  if (stopped()) return 128 + g_signal;
  for (const auto& [name, sample] : samples) {
    const auto seen = sample.statistics();
    fmt::print("{}: hue {:.1f} +- {:.1f} degrees, chroma from {:.3f}, saturation from {:.2f}, {} pixels\n", name,
               seen.hue_deg, seen.spread_deg, seen.chroma, seen.saturation, seen.pixels);
  }
  try {
    const ColourResult result = teach_colours(samples);
    for (const auto& line : result.warnings) fmt::print("careful: {}\n", line);
    write(options.out,
          "# Colours as a camera shows them, made by constrictor camera colours. Use it with\n#   constrictor run "
          "--config perception=" +
              options.out.filename().string() + "\n" + result.yaml);
  } catch (const std::invalid_argument& error) {
    throw Failed(fmt::format("{}; nothing was written", error.what()));
  }
  return exit_status::kOk;
}

}  // namespace constrictor::camera_setup
