// Checks of a camera while the head rests: model, sizes, rate, stamps, pictures, colours.
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "configuration/counted.hpp"
#include "conform/camera_conformance.hpp"
#include "robot/camera_mount.hpp"

namespace constrictor::conform {
namespace {

bool same(const msg::CameraInfo& a, const msg::CameraInfo& b) {
  const auto &p = a.X_HC, &q = b.X_HC;
  return a.width == b.width && a.height == b.height && a.fx == b.fx && a.fy == b.fy && a.cx == b.cx && a.cy == b.cy &&
         a.frame_period_s == b.frame_period_s && p.position_m.x == q.position_m.x && p.position_m.y == q.position_m.y &&
         p.position_m.z == q.position_m.z && p.orientation.w == q.orientation.w && p.orientation.x == q.orientation.x;
}

}  // namespace

std::vector<Check> camera_checks() {
  return {
      {"arrives", "camera/image and camera/info begin", {}, {}, {}},
      {"info_once", "camera/info comes with the first image at the latest, and does not change", {}, {}, {}},
      {"model", "camera/info describes a pin-hole camera: focal lengths, centre, mount, period", {}, {}, {}},
      {"view", "the field of view is that of the robot file", {}, {}, {}},
      {"mount", "X_HC is that of the robot file: z ahead, x right, y down", {}, {}, {}},
      {"size", "each image has the size of camera/info, and 3 bytes for each pixel", {}, {}, {}},
      {"rate", "the images follow each other as frame_period_s says", {}, {}, {}},
      {"stamps", "exposure_tick rises, and is not in the future", {}, {}, {}},
      {"latency", "the time from the exposure until the image can be read is short and nearly constant", {}, {}, {}},
      {"dark", "the images are neither black nor of one colour", {}, {}, {}},
      {"frozen", "the images do not repeat", {}, {}, {}},
      {"colours", "the bytes of a pixel are red, green, blue", {}, {}, {}},
      {"moves", "the scene moves through the image when the head is turned", {}, {}, {}},
      {"upside_down", "when the nose is lifted the scene moves down", {}, {}, {}},
      {"mirrored", "when the head turns left the scene moves to the right", {}, {}, {}},
      {"scale", "it moves as far as the focal length says", {}, {}, {}},
      {"stamp_of_motion", "exposure_tick is the tick at which the head was where the image shows it", {}, {}, {}},
      {"restart", "a process that is killed comes back, with the same model and images that are new", {}, {}, {}},
  };
}

void CameraConformance::run() {
  if (!check_arrival()) {
    report_.skip_rest("there is no image");
    return;
  }
  watch(profile_.watch_s);
  check_model();
  check_frames();
  check_stamps();
  check_pictures();
  check_colour();
  check_motion();
  check_restart();
}

void CameraConformance::check_restart() {
  const std::uint32_t before = port_.incarnation();
  const std::size_t first = frames_.size();
  info_changed_ = false;
  std::string fault;
  try {
    const std::string obstacle = before > 1   ? std::string()
                                 : first == 0 ? std::string("there is no image")
                                              : port_.restart();
    if (!obstacle.empty()) return report_.skip("restart", obstacle);
    const std::int64_t begin = port_.tick();
    const auto passed_s = [&] { return kTick_s * static_cast<double>(port_.tick() - begin); };
    while (frames_.size() == first && passed_s() < profile_.patience_s) tick();
    if (frames_.size() == first) fault = fmt::format("no image within {:.0f} s", profile_.patience_s);
    for (int i = 0; i < PartPort::kStatusTicks; ++i) tick();
  } catch (const PartGone& gone) {
    fault = gone.what();
  }
  for (std::size_t i = std::max<std::size_t>(first, 1); i < frames_.size() && fault.empty(); ++i) {
    if (frames_[i].exposure_tick <= frames_[i - 1].exposure_tick)
      fault = fmt::format("an image of tick {} after one of tick {}", frames_[i].exposure_tick,
                          frames_[i - 1].exposure_tick);
  }
  if (info_changed_ && fault.empty()) fault = "camera/info changes";
  if (before > 1) fault = fmt::format("the process has ended by itself, and is now incarnation {}", before);
  else if (fault.empty() && port_.incarnation() != before + 1) fault = "the process was not started again";
  report_.pass_unless("restart", fault, counted(frames_.size() - first, "image") + " of the new process",
                      "connect again at the start, write camera/info first, and show nothing that was seen before");
}

void CameraConformance::tick() {
  if (may_move_ && setpoints_rad_.size() == robot_.joints.size()) {
    msg::JointCommand command{};
    command.joint_count = static_cast<std::uint16_t>(setpoints_rad_.size());
    std::copy(setpoints_rad_.begin(), setpoints_rad_.end(), command.position_rad);
    for (std::size_t j = 0; j < setpoints_rad_.size(); ++j) command.torque_limit_nm[j] = robot_.joints[j].max_torque_nm;
    port_.send(topics::kJointCommand, command);
  }
  port_.advance();
  for (const auto* joints : port_.written(topics::kJointState)) {
    postures_.push_back({joints->header.tick, {joints->position_rad, joints->position_rad + joints->joint_count}});
    if (setpoints_rad_.empty()) setpoints_rad_ = postures_.back().angles_rad;  // held from now on
  }
  for (const auto* info : port_.written(topics::kCameraInfo)) {
    if (info_ && !same(*info_, *info)) info_changed_ = true;
    if (!info_) info_tick_ = in_barrier_ ? port_.tick() : info->header.tick;
    info_ = *info;
    ++infos_;
  }
  for (const auto* image : port_.written(topics::kCameraImage)) {
    Frame frame;
    frame.written_tick = image->header.tick;
    frame.arrival_tick = in_barrier_ ? port_.tick() : frame.written_tick;
    frame.exposure_tick = image->exposure_tick;
    frame.width = image->width;
    frame.height = image->height;
    frame.bytes = image->data._length;
    if (frame.bytes == static_cast<std::size_t>(frame.width) * static_cast<std::size_t>(frame.height) * 3) {
      frame.rgb = cv::Mat(frame.height, frame.width, CV_8UC3, image->data._buffer).clone();
      cv::cvtColor(frame.rgb, frame.grey, cv::COLOR_RGB2GRAY);
      frame.grey.convertTo(frame.grey, CV_32F, 1.0 / 255.0);
    }
    frames_.push_back(std::move(frame));
  }
}

void CameraConformance::watch(double seconds) {
  for (long i = std::lround(seconds / kTick_s); i > 0; --i) tick();
}

bool CameraConformance::check_arrival() {
  for (long i = std::lround(profile_.patience_s / kTick_s); i > 0 && (frames_.empty() || !info_); --i) tick();
  const bool arrived = !frames_.empty() && info_;
  report_.judge("arrives", !arrived,
                arrived           ? fmt::format("at tick {}", frames_.front().arrival_tick)
                : frames_.empty() ? fmt::format("no camera/image within {} s", profile_.patience_s)
                                  : std::string("camera/image, but no camera/info"),
                "write both; the run refuses values that are not finite or out of range, and its log names them");
  return arrived;
}

void CameraConformance::check_model() {
  const msg::CameraInfo& info = *info_;
  const bool late = info_tick_ > frames_.front().arrival_tick;
  report_.judge("info_once", late || info_changed_,
                late ? counted(info_tick_ - frames_.front().arrival_tick, "tick") + " after the first image"
                     : fmt::format("{} messages{}", infos_, info_changed_ ? ", which differ" : ""),
                "write camera/info once, in the step of the first image");
  std::string wrong;
  const auto& q = info.X_HC.orientation;
  const double norm = std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  if (!(info.fx > 0.0 && info.fy > 0.0)) wrong = fmt::format("focal lengths {:.1f} and {:.1f}", info.fx, info.fy);
  else if (!(info.fx / info.fy > 0.8 && info.fx / info.fy < 1.25))
    wrong = fmt::format("focal lengths {:.1f} and {:.1f}: pixels that are not square", info.fx, info.fy);
  else if (!(info.cx > 0.25 * info.width && info.cx < 0.75 * info.width && info.cy > 0.25 * info.height &&
             info.cy < 0.75 * info.height))
    wrong =
        fmt::format("principal point ({:.1f}, {:.1f}) in {} x {} pixels", info.cx, info.cy, info.width, info.height);
  else if (!(std::abs(norm - 1.0) < 1e-3)) wrong = fmt::format("the quaternion of X_HC has the length {:.3f}", norm);
  else if (!(info.frame_period_s > 0.0)) wrong = fmt::format("frame_period_s {}", info.frame_period_s);
  report_.pass_unless("model", wrong,
                      fmt::format("{} x {} pixels, focal length {:.1f}", info.width, info.height, info.fx),
                      "write focal lengths and centre in pixels (constrictor camera calibrate measures them)");
  const CameraModel& camera = robot_.camera;
  const double view_rad = info.fx > 0.0 ? 2.0 * std::atan(0.5 * info.width / info.fx) : 0.0;
  report_.judge("view", std::abs(view_rad - camera.horizontal_fov_rad) > profile_.view_rad,
                fmt::format("{:.2f} rad, {:.2f} in the robot file", view_rad, camera.horizontal_fov_rad),
                "correct fx, the size, or the robot file");
  const Eigen::Isometry3d X_HC = camera_mount(camera);
  const auto& p = info.X_HC.position_m;
  const double off_m = (Eigen::Vector3d(p.x, p.y, p.z) - X_HC.translation()).norm();
  const double off_rad =
      norm > 0.5
          ? Eigen::Quaterniond(q.w, q.x, q.y, q.z).normalized().angularDistance(Eigen::Quaterniond(X_HC.linear()))
          : 3.2;
  report_.judge(
      "mount", off_m > profile_.mount_m || off_rad > profile_.mount_rad,
      fmt::format("{:.3f} m and {:.2f} rad from the robot file", off_m, off_rad),
      "X_HC is the camera in the head: rotate z ahead, x right, y down (constrictor camera mount measures it)");
}

void CameraConformance::check_frames() {
  const msg::CameraInfo& info = *info_;
  std::string wrong;
  for (const Frame& frame : frames_) {
    if (frame.width != info.width || frame.height != info.height || frame.rgb.empty())
      wrong = fmt::format("{} x {} pixels in {} bytes, with {} x {} in camera/info", frame.width, frame.height,
                          frame.bytes, info.width, info.height);
  }
  report_.pass_unless("size", wrong, counted(frames_.size(), "image"),
                      "write width * height * 3 bytes, rows from the top, of the size in camera/info");
  if (frames_.size() < 3 || !(info.frame_period_s > 0.0))
    return report_.fail("rate", fmt::format("{} in {} s", counted(frames_.size(), "image"), profile_.watch_s),
                        "write an image every frame_period_s");
  const double passed_s = kTick_s * static_cast<double>(frames_.back().arrival_tick - frames_.front().arrival_tick);
  const double period_s = passed_s / static_cast<double>(frames_.size() - 1);
  double gap_s = 0.0;
  for (std::size_t i = 1; i < frames_.size(); ++i)
    gap_s = std::max(gap_s, kTick_s * static_cast<double>(frames_[i].arrival_tick - frames_[i - 1].arrival_tick));
  report_.judge("rate",
                std::abs(period_s / info.frame_period_s - 1.0) > profile_.rate_share ||
                    gap_s > profile_.longest_gap * info.frame_period_s,
                fmt::format("one in {:.3f} s, at most {:.2f} s apart; frame_period_s is {:.3f} s", period_s, gap_s,
                            info.frame_period_s),
                "write an image every frame_period_s; or correct frame_period_s [s]");
}

void CameraConformance::check_stamps() {
  std::string wrong;
  std::int64_t shortest = 1'000'000, longest = -1'000'000;
  for (std::size_t i = 0; i < frames_.size(); ++i) {
    const Frame& frame = frames_[i];
    if (frame.exposure_tick > frame.written_tick)
      wrong = fmt::format("exposed at tick {}, written at tick {}", frame.exposure_tick, frame.written_tick);
    if (i > 0 && frame.exposure_tick <= frames_[i - 1].exposure_tick)
      wrong = fmt::format("exposed at tick {} after {}", frame.exposure_tick, frames_[i - 1].exposure_tick);
    if (frame.exposure_tick == 0) continue;  // cut at the start of the epoch
    shortest = std::min(shortest, frame.arrival_tick - frame.exposure_tick);
    longest = std::max(longest, frame.arrival_tick - frame.exposure_tick);
  }
  report_.pass_unless("stamps", wrong, "rising", "exposure_tick is the tick of the exposure, not of the message");
  const double most_s = kTick_s * static_cast<double>(longest),
               jitter_s = kTick_s * static_cast<double>(longest - shortest);
  report_.judge("latency", most_s > profile_.latency_s || jitter_s > profile_.jitter_s,
                fmt::format("{:.2f} s at most, varying by {:.2f} s", most_s, jitter_s),
                "measure the age of each frame, and drop frames that have waited");
}

void CameraConformance::check_pictures() {
  std::string dark;
  int equal = 1, most_equal = 1;
  for (std::size_t i = 0; i < frames_.size(); ++i) {
    if (frames_[i].grey.empty()) continue;
    cv::Scalar mean, sd;
    cv::meanStdDev(frames_[i].grey, mean, sd);
    if (mean[0] < 0.02) dark = "black images";
    else if (sd[0] < 0.01) dark = fmt::format("images of one colour, of brightness {:.2f}", mean[0]);
    const bool repeats = i > 0 && frames_[i - 1].rgb.size() == frames_[i].rgb.size() &&
                         cv::norm(frames_[i - 1].rgb, frames_[i].rgb, cv::NORM_L1) == 0.0;
    equal = repeats ? equal + 1 : 1;
    most_equal = std::max(most_equal, equal);
  }
  report_.pass_unless("dark", dark, "neither", "look at the lens cap, exposure and light");
  report_.judge("frozen", most_equal > profile_.most_equal, fmt::format("{} equal images in a row", most_equal),
                "the noise of any camera makes images different: the source repeats one");
}

void CameraConformance::check_colour() {
  std::uint8_t expected = profile_.colour;
  const bool telling = expected == msg::kColourBlue || expected == msg::kColourRed || expected == msg::kColourYellow;
  if (!telling) return report_.skip("colours", "needs a blue, red or yellow line ahead (line_colour of the profile)");
  // Hues [degrees] of the line, as it is and with red and blue exchanged.
  const auto hue_of = [](std::uint8_t colour) {
    return colour == msg::kColourBlue ? 235.0 : colour == msg::kColourRed ? 0.0 : 57.0;
  };
  const double right_deg = hue_of(expected), wrong_deg = std::fmod(600.0 - right_deg, 360.0);
  std::size_t right = 0, wrong = 0, all = 0;
  for (const Frame& frame : frames_) {
    if (frame.rgb.empty()) continue;
    cv::Mat hsv;
    cv::Mat level;
    cv::GaussianBlur(frame.rgb.rowRange(frame.height / 3, frame.height), level, {0, 0}, 1.5);
    level.convertTo(level, CV_32FC3, 1.0 / 255.0);
    cv::cvtColor(level, hsv, cv::COLOR_RGB2HSV);
    for (int v = 0; v < hsv.rows; ++v) {
      for (int u = 0; u < hsv.cols; ++u) {
        const auto pixel = hsv.at<cv::Vec3f>(v, u);
        ++all;
        if (pixel[1] < 0.4F || pixel[1] * pixel[2] < 0.12F) continue;
        const auto near = [&](double deg) { return std::abs(std::remainder(pixel[0] - deg, 360.0)) < 30.0; };
        right += near(right_deg);
        wrong += near(wrong_deg);
      }
    }
  }
  const double share = all > 0 ? 1.0 / static_cast<double>(all) : 0.0;
  const double right_share = share * static_cast<double>(right), wrong_share = share * static_cast<double>(wrong);
  if (right_share < 0.002 && wrong_share < 0.002)
    return report_.skip("colours", "no line is in view; lay the robot in front of it");
  report_.judge(
      "colours", wrong_share > 3.0 * right_share,
      fmt::format("{:.1f} % of the ground have the line's colour, {:.1f} % its colour with red and blue exchanged",
                  100.0 * right_share, 100.0 * wrong_share),
      "write red, green, blue; OpenCV's images are blue, green, red");
}

}  // namespace constrictor::conform
