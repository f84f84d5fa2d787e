#include "navigation/grip.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace constrictor {
namespace {

constexpr double kFrontArm_m = 0.75;  // a U with a shorter front arm (16 modules: 0.62 m) hardly reaches a zone

// Yaw joints of the arms, whose waves drive and steer the robot with an object. 18 modules of 0.12 m have three in each
// arm, and three of three missions succeeded; 16 modules of 0.12 and 0.135 m have three and two, 14 of 0.12 to 0.15 m
// three and one, or two and two: none of 15 did. 16 modules of 0.089 and 0.105 m have four and one, and succeed.
constexpr int kFrontJoints = 4;
constexpr int kBothJoints = 3;

// A wave needs three links to travel: two stand. Missions with other distances of the yaw joints are in the README.
constexpr double kWavelength_m = 1.07;  // of control's gaits without an object
constexpr double kLinksPerWave = 3.0;

/// [m] Distance of neighbouring yaw joints, on average.
double link_m(const RobotModel& robot, const std::vector<std::size_t>& yaw_joints) {
  if (yaw_joints.size() < 2) return 0.0;
  return static_cast<double>(yaw_joints.back() - yaw_joints.front()) * robot.module_length_m /
         static_cast<double>(yaw_joints.size() - 1);
}

/// [m] Length of the arm in front of the base of a U.
double front_arm_m(const RobotModel& robot, std::size_t first_base_joint) {
  return static_cast<double>(first_base_joint + 1) * robot.module_length_m;
}

/// Why these joints cannot form the base of a U, which opens to either side, and hold an object; empty: they can.
std::string weak_joint_refusal(const RobotModel& robot, const std::vector<std::size_t>& base,
                               const GripConfig& config) {
  for (const std::size_t j : base) {
    const JointModel& joint = robot.joints[j];
    const std::string refusal = fmt::format("the robot {} cannot grasp: joints.", robot.name);
    constexpr const char* kOpenU = "to bend to the open U";
    if (joint.max_rad < config.base_angle_rad) {
      return fmt::format("{}max_rad: found {:g}, accepted at least {:.4g} {}", refusal, joint.max_rad,
                         config.base_angle_rad, kOpenU);
    }
    if (-joint.min_rad < config.base_angle_rad) {
      return fmt::format("{}min_rad: found {:g}, accepted at most {:.4g} {}", refusal, joint.min_rad,
                         -config.base_angle_rad, kOpenU);
    }
    if (joint.max_torque_nm < config.hold_torque_nm) {
      return fmt::format("{}max_torque_nm: found {:g}, accepted at least {:.3g} to hold an object", refusal,
                         joint.max_torque_nm, config.hold_torque_nm);
    }
  }
  return {};
}

}  // namespace

int middle_base_joint(const RobotModel& robot, int base_joints) {
  const std::vector<std::size_t> yaw_joints = robot.yaw_joints();
  const int last = static_cast<int>(yaw_joints.size()) - base_joints - 1;  // one joint remains behind the base
  int best = std::max(0, last);
  int best_difference = static_cast<int>(robot.module_count);
  for (int k = 0; k <= last; ++k) {
    const std::size_t first_joint = yaw_joints[static_cast<std::size_t>(k)];
    const int front = static_cast<int>(first_joint) + 1;  // modules of the arm
    const int last_base_joint = static_cast<int>(yaw_joints[static_cast<std::size_t>(k + base_joints - 1)]);
    const int rear = static_cast<int>(robot.module_count) - 1 - last_base_joint;
    const int difference = std::abs(front - rear);
    if (front_arm_m(robot, first_joint) < kFrontArm_m || difference > best_difference) continue;
    best = k;  // of two places that are equally good, the one with the longer front arm
    best_difference = difference;
  }
  return best;
}

int first_base_joint(const RobotModel& robot, const GripConfig& config) {
  return config.base_first_joint < 0 ? middle_base_joint(robot, config.base_joints) : config.base_first_joint;
}

GripSense::GripSense(const RobotModel& robot, const GripConfig& config)
    : robot_(robot), config_(config), first_(0), yaw_joints_(robot.yaw_joints()) {
  const int first = first_base_joint(robot, config);
  const int end = first + config.base_joints;
  const int joints = static_cast<int>(yaw_joints_.size());
  const bool named = config.base_first_joint >= 0;
  if (named && end > joints) {
    throw ConfigurationError(
        fmt::format("navigation: grip.base_first_joint: found {} with {} base_joints, accepted at most {} for "
                    "the {} yaw joints of the robot {}",
                    first, config.base_joints, joints - config.base_joints, joints, robot.name));
  }
  first_ = static_cast<std::size_t>(first);
  for (int i = first; i < std::min(joints, end); ++i) base_joints_.push_back(yaw_joints_[static_cast<std::size_t>(i)]);

  refusal_ = weak_joint_refusal(robot, base_joints_, config);
  constexpr double kLongest_m = kWavelength_m / kLinksPerWave;
  if (const double found_m = link_m(robot, yaw_joints_); found_m > kLongest_m) {
    refusal_ = fmt::format(
        "the robot {} cannot grasp: module.length_m: found {:g}, accepted at most {:.3f}: its yaw joints would be "
        "{:.2f} m apart, and a wave of {} m needs {} links",
        robot.name, robot.module_length_m, kLongest_m * robot.module_length_m / found_m, found_m, kWavelength_m,
        kLinksPerWave);
  }
  if (named || !refusal_.empty()) return;
  const double arm_m = front_arm_m(robot, base_joints_.front());
  if (end >= joints) {
    refusal_ = fmt::format(
        "the robot {} cannot grasp: module.count: found {} with {} yaw joints, accepted more: the U needs {} and one "
        "behind it",
        robot.name, robot.module_count, joints, config.base_joints);
  } else if (arm_m < kFrontArm_m) {
    refusal_ = fmt::format(
        "the robot {} cannot grasp: module.count: found {} of {:g} m, accepted more or longer modules: the arm in "
        "front of its U would be {:.2f} m long, accepted at least {:.2f} m",
        robot.name, robot.module_count, robot.module_length_m, arm_m, kFrontArm_m);
  } else if (first < kFrontJoints && std::min(first, joints - end) < kBothJoints) {
    refusal_ = fmt::format(
        "the robot {} cannot grasp: module.count: found {} of {:g} m, accepted more modules: the arms of its U would "
        "have {} and {} yaw joints, accepted at least {} in front of it, or {} in each",
        robot.name, robot.module_count, robot.module_length_m, first, joints - end, kFrontJoints, kBothJoints);
  }
}

std::array<double, msg::kMaxJoints> GripSense::open_shape(double side, double angle_rad) const {
  std::array<double, msg::kMaxJoints> shape{};
  for (std::size_t i = 0; i < base_joints_.size(); ++i) shape[first_ + i] = side * angle_rad;
  return shape;
}

// The yaw joints of the base are corners of a regular polygon, whose sides touch an object. A base of one joint has one
// corner only, and no bound.
double GripSense::side_m() const {
  return robot_.module_length_m * static_cast<double>(base_joints_[1] - base_joints_[0]);
}

double GripSense::largest_radius_m() const {
  if (base_joints_.size() < 2 || config_.base_angle_rad <= 0.0) return 1e9;
  return 0.5 * side_m() / std::tan(0.5 * std::min(config_.base_angle_rad, 3.0)) - robot_.module_radius_m;
}

double GripSense::closed_angle_rad(double radius_m) const {
  return 2.0 * std::atan(0.5 * side_m() / (radius_m + robot_.module_radius_m));
}

double GripSense::open_angle_rad(double radius_m) const {
  if (base_joints_.size() < 2) return config_.base_angle_rad;
  const double least_rad = std::min(config_.widest_angle_rad, config_.base_angle_rad);
  return std::clamp(closed_angle_rad(radius_m) - config_.closing_rad, least_rad, config_.base_angle_rad);
}

double GripSense::open_angle_rad(const Grip& grip) const {
  const double usual_rad = open_angle_rad(grip.radius_m);
  if (grip.wrap_scale == 1.0 || base_joints_.size() < 2) return usual_rad;
  const double least_rad = std::min(config_.widest_angle_rad, usual_rad);
  const double most_rad = std::max(usual_rad, closed_angle_rad(grip.radius_m) - 0.5 * config_.closing_rad);
  return std::clamp(usual_rad / grip.wrap_scale, least_rad, most_rad);
}

double GripSense::largest_closing_nm(const msg::JointState& joints, double side) const {
  double largest_nm = 0.0;
  for (const std::size_t j : base_joints_) largest_nm = std::max(largest_nm, side * joints.torque_nm[j]);
  return largest_nm;
}

double GripSense::mean_closing_nm(const msg::JointState& joints, double side) const {
  double sum_nm = 0.0;
  for (const std::size_t j : base_joints_) sum_nm += side * joints.torque_nm[j];
  return sum_nm / static_cast<double>(base_joints_.size());
}

bool GripSense::is_base_module(std::size_t module) const {
  return module >= base_joints_.front() && module <= base_joints_.back() + 2;
}

bool GripSense::is_near_base(std::size_t module) const {
  return module + 2 >= base_joints_.front() && module <= base_joints_.back() + 4;
}

double GripSense::base_force_n(const std::vector<Touch>& touches) const {
  double sum_n = 0.0;
  for (const Touch& touch : touches) sum_n += is_base_module(touch.module) ? touch.force_n : 0.0;
  return sum_n;
}

double GripSense::apex_force_n(const std::vector<Touch>& touches) const {
  double sum_n = 0.0;
  for (const Touch& touch : touches) {
    sum_n += touch.module > base_joints_.front() && touch.module <= base_joints_.back() ? touch.force_n : 0.0;
  }
  return sum_n;
}

int GripSense::touching_modules(const std::vector<Touch>& touches) const {
  std::array<bool, msg::kMaxModules> touching{};
  for (const Touch& touch : touches) touching[touch.module] = true;
  return static_cast<int>(std::count(touching.begin(), touching.end(), true));
}

Eigen::Vector2d GripSense::mouth(const std::vector<PlanarPose>& body) const {
  Eigen::Vector2d mouth{0.0, 0.0};
  for (std::size_t m = 0; m < body.size(); ++m) {
    if (m < base_joints_.front()) mouth += body[m].forward();
    if (m > base_joints_.back() + 1) mouth -= body[m].forward();
  }
  if (mouth.norm() < 1e-6) return {1.0, 0.0};
  return mouth.normalized();
}

double GripSense::mouth_rad(const std::vector<PlanarPose>& body) const {
  const Eigen::Vector2d direction = mouth(body);
  return std::atan2(direction.y(), direction.x());
}

Eigen::Vector2d GripSense::held_object_H(const std::vector<PlanarPose>& body, double radius_m) const {
  // The apex A is the middle joint of the base.
  const std::size_t apex = base_joints_[base_joints_.size() / 2];
  const Eigen::Vector2d p_HA = body[apex].p - 0.5 * robot_.module_length_m * body[apex].forward();
  return p_HA + (radius_m + robot_.module_radius_m) * mouth(body);
}

std::array<double, msg::kMaxJoints> GripSense::hold_shape(const msg::JointState& joints, const Grip& grip,
                                                          bool feels) const {
  const double side = grip.side;
  std::array<double, msg::kMaxJoints> shape{};
  double closed_rad = 0.0;  // beyond the U with parallel arms
  for (std::size_t k = first_; k < first_ + base_joints_.size(); ++k) {
    shape[k] = joints.position_rad[yaw_joints_[k]] + side * margin_rad(feels);
    closed_rad += shape[k] - side * config_.base_angle_rad;
  }
  // The joints beside the base keep the angle to which the squeeze has opened them. A large object has kept the base
  // from closing so far: then they close by what is missing, because arms that are not parallel drive the U askew, and
  // their thrust opens the base further.
  const double share = side * closed_rad > 0.0 ? config_.opening_share : 1.0;
  const double beside_rad = 0.5 * share * closed_rad;
  const std::size_t after = first_ + base_joints_.size();
  if (first_ > 0) shape[first_ - 1] = -beside_rad;
  if (after < yaw_joints_.size()) shape[after] = -beside_rad;
  return shape;
}

void GripSense::hold_starts(Grip& grip) const {
  double closed_rad = 0.0;  // beyond the U with parallel arms
  for (std::size_t k = first_; k < first_ + base_joints_.size(); ++k)
    closed_rad += grip.side * grip.shape_rad[k] - config_.base_angle_rad;
  grip.usual_torque_nm = closed_rad < 0.0 ? config_.wide_hold_torque_nm : config_.hold_torque_nm;
  grip.hold_torque_nm = grip.usual_torque_nm;
  grip.opened_rad = 0.0;
  grip.torque_nm = config_.hold_torque_nm;
  grip.contact_share = 1.0;
  grip.below_s = 0.0;
}

void GripSense::choose_torque(const msg::JointState& joints, bool feels, double share, Grip& grip) const {
  double opened_rad = 0.0;
  for (std::size_t k = first_; k < first_ + base_joints_.size(); ++k)
    opened_rad += grip.side * (grip.shape_rad[k] - joints.position_rad[yaw_joints_[k]]) - margin_rad(feels);
  grip.opened_rad += share * (opened_rad - grip.opened_rad);
  const bool closing = grip.hold_torque_nm > grip.usual_torque_nm;
  const bool open = grip.opened_rad > (closing ? 0.5 : 1.0) * config_.opened_rad;
  const double most_nm = std::min(config_.closing_torque_nm, robot_.joints[base_joints_.front()].max_torque_nm);
  grip.hold_torque_nm = open ? std::max(most_nm, grip.usual_torque_nm) : grip.usual_torque_nm;
}

bool GripSense::watch(const msg::JointState& joints, const std::vector<Touch>& touches, bool feels, double dt_s,
                      Grip& grip, bool moves) const {
  const double share = -std::expm1(-dt_s / config_.lost_filter_s);
  grip.torque_nm += share * (mean_closing_nm(joints, grip.side) - grip.torque_nm);
  choose_torque(joints, feels, share, grip);
  const bool touched = base_force_n(touches_of(grip.handle, touches)) >= config_.touch_force_n;
  grip.contact_share += share * ((touched ? 1.0 : 0.0) - grip.contact_share);
  const bool few_touches = !feels || grip.contact_share < config_.lost_contact_share;
  const bool weak = grip.torque_nm < config_.lost_torque_nm && few_touches;
  // A large wave loads the base of an empty U, too: without any touch the torque proves nothing.
  const bool below = weak || (feels && grip.contact_share < config_.untouched_share);
  if (!below) grip.below_s = 0.0;
  else if (moves) grip.below_s += dt_s;
  return grip.below_s >= config_.lost_after_s;
}

}  // namespace constrictor
