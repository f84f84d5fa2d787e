// The head is turned to the left, and the nose is lifted: does the scene move through the image as it must?
#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "conform/camera_conformance.hpp"
#include "conform/image_motion.hpp"

namespace constrictor::conform {
namespace {

constexpr double kMoved = 0.25;    // share of the motion; a smaller one counts as none
constexpr double kClearer = 0.01;  // the right rotation must raise the correlation by this
const char* const kMotionChecks[] = {"moves", "upside_down", "mirrored", "scale", "stamp_of_motion"};

}  // namespace

double CameraConformance::angle_at(std::int64_t tick, std::size_t joint) const {
  const Posture* nearest = &postures_.front();
  for (const Posture& posture : postures_) {
    if (std::abs(posture.tick - tick) < std::abs(nearest->tick - tick)) nearest = &posture;
  }
  return nearest->angles_rad[joint];
}

void CameraConformance::move_to(std::size_t joint, double goal_rad) {
  const double step_rad = profile_.rate_rad_s * kTick_s;
  while (std::abs(goal_rad - setpoints_rad_[joint]) > 1e-9) {
    setpoints_rad_[joint] += std::clamp(goal_rad - setpoints_rad_[joint], -step_rad, step_rad);
    tick();
  }
  watch(profile_.settle_s);
}

CameraConformance::Motion CameraConformance::turn(std::size_t joint, const Eigen::Vector3d& axis_H, double angle_rad) {
  Motion motion;
  watch(profile_.settle_s);
  const double start_rad = setpoints_rad_[joint];
  const double before_rad = postures_.back().angles_rad[joint];
  const Frame before = frames_.back();
  const std::size_t first = frames_.size();
  move_to(joint, start_rad + angle_rad);
  motion.wanted_rad = postures_.back().angles_rad[joint] - before_rad;
  motion.obeyed = std::abs(motion.wanted_rad / angle_rad - 1.0) < 0.5;
  if (frames_.size() > first && motion.obeyed && !before.grey.empty() && !frames_.back().grey.empty()) {
    const double most_rad = 1.8 * std::abs(angle_rad);
    const ImageMotion whole = image_motion(before.grey, frames_.back().grey, *info_, axis_H, most_rad);
    motion.seen_rad = whole.angle_rad;
    motion.likeness = whole.likeness;
    motion.at_rest = whole.at_rest;
    // How far the images are behind the angles that were measured at their exposure, in the middle of the motion.
    double behind_rad = 0.0;
    int used = 0;
    for (std::size_t i = first; i < frames_.size(); ++i) {
      const double turned_rad = angle_at(frames_[i].exposure_tick, joint) - before_rad;
      const double share = turned_rad / motion.wanted_rad;
      if (share < 0.15 || share > 0.85 || frames_[i].grey.empty() || std::abs(motion.seen_rad) < 1e-6) continue;
      const double seen =
          image_motion(before.grey, frames_[i].grey, *info_, axis_H, most_rad).angle_rad / motion.seen_rad;
      behind_rad += (share - seen) * std::abs(motion.wanted_rad);
      ++used;
    }
    if (used > 1) motion.lag_s = behind_rad / used / profile_.rate_rad_s;
  }
  move_to(joint, start_rad);
  return motion;
}

void CameraConformance::check_motion() {
  const auto skip_all = [&](const std::string& reason) {
    for (const char* name : kMotionChecks) report_.skip(name, reason);
  };
  if (!may_move_) return skip_all("the head is not moved");
  if (setpoints_rad_.size() != robot_.joints.size()) return skip_all("no joint_state of this robot arrives");
  std::size_t yaw = robot_.joints.size(), pitch = yaw;
  for (std::size_t j = robot_.joints.size(); j-- > 0;) (robot_.joints[j].axis == JointAxis::kYaw ? yaw : pitch) = j;
  if (yaw == robot_.joints.size()) return skip_all("the robot has no yaw joint");
  const Motion left = turn(yaw, Eigen::Vector3d::UnitZ(), profile_.yaw_rad);
  if (!left.obeyed) return skip_all("the plant does not obey: the head does not turn");
  std::optional<Motion> up;
  if (pitch < robot_.joints.size()) up = turn(pitch, Eigen::Vector3d::UnitY(), -profile_.pitch_rad);
  judge_motion(left, up);
}

void CameraConformance::judge_motion(const Motion& yaw, const std::optional<Motion>& pitch) {
  const double ratio = yaw.seen_rad / yaw.wanted_rad;
  const bool moved = std::abs(ratio) > kMoved && yaw.likeness > yaw.at_rest + kClearer;
  report_.judge("moves", !moved,
                fmt::format("turned by {:.2f} rad, for {:.2f} rad of the head (likeness {:.2f}, {:.2f} at rest)",
                            yaw.seen_rad, yaw.wanted_rad, yaw.likeness, yaw.at_rest),
                "show the camera something with contrast; or set motion.moves to false where pictures are replayed");
  if (!moved) {
    for (const char* name : {"upside_down", "mirrored", "scale", "stamp_of_motion"})
      report_.skip(name, "the scene does not move through the image");
    return;
  }
  bool inverted = false;
  if (!pitch || !pitch->obeyed || pitch->likeness <= pitch->at_rest + kClearer) {
    report_.skip("upside_down", pitch && pitch->obeyed ? "the images do not show that the nose was lifted"
                                                       : "the nose cannot be lifted");
  } else {
    inverted = pitch->seen_rad / pitch->wanted_rad < 0.0;
    report_.judge("upside_down", inverted,
                  fmt::format("lifted by {:.2f} rad, for {:.2f} rad of the head", -pitch->seen_rad, -pitch->wanted_rad),
                  ratio < 0.0 ? "turn the images by half a turn" : "write the rows from the top");
  }
  const bool mirrored = ratio < 0.0 && !inverted;
  report_.judge("mirrored", mirrored,
                fmt::format("the scene moves to the {}", ratio > 0.0 || inverted ? "right" : "left"),
                "write the columns from left to right, as a viewer who looks ahead sees them");
  report_.judge("scale", std::abs(std::abs(ratio) - 1.0) > profile_.scale_share,
                fmt::format("{:.2f} times as far as the focal length says", std::abs(ratio)),
                "calibrate the camera: fx and fy [pixel] belong to the size in which images are written");
  if (!yaw.lag_s) return report_.skip("stamp_of_motion", "too few images during the motion");
  report_.judge("stamp_of_motion", std::abs(*yaw.lag_s) > profile_.stamp_s,
                fmt::format("the images are {:.2f} s behind their stamps", *yaw.lag_s),
                "subtract the whole delay from the exposure to the reception (stream.delay_s of video_capture)");
}

}  // namespace constrictor::conform
