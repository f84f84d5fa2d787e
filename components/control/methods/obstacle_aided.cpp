// "obstacle_aided": the body pushes itself along obstacles, on ground that is equally slippery in each direction. It
// needs contact sensors. README.md derives the law.
//
// Sources: the torques in proportion to the derivative of the curvature are those of H. Date and Y. Takita, "Adaptive
// locomotion of a snake like robot based on curvature derivatives", IROS 2007; that contacts which push the body
// forwards are sought and others avoided is the idea of obstacle-aided locomotion (A. Transeth et al., 2008; P.
// Liljebäck et al., 2010; F. Sanfilippo et al., "Perception-driven obstacle-aided locomotion for snake robots", 2017).
// The rules for the head and for the search are this project's own.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "control/obstacle_contacts.hpp"
#include "control/wave_motion.hpp"
#include "robot/planar.hpp"
#include "robot/planar_message.hpp"

namespace constrictor {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;

// The method's own state in BodyState::scratch.
enum Scratch : std::size_t {
  kSwing,      // 0 to 1: share of the swing, for a soft start
  kCourse,     // [rad] heading that the robot shall keep, in the frame of the inertial unit
  kSpeed,      // [m/s] at which the shape moves along the body towards the tail, low-passed
  kWayOut,     // -1 to 1: as ObstacleEffect::way_out; it fades
  kSupport,    // [N] ObstacleEffect::forward_n, low-passed
  kAlone,      // [s] time without support, time of the search included
  kSearch,     // 0 to 1: share of the search in the setpoints
  kOtherSide,  // 0: the next search goes to the left; 1: to the right
};

constexpr double kSpeed_s = 0.3;  // time constants
constexpr double kWayOut_s = 0.5;
constexpr double kSupport_s = 1.0;
constexpr double kSearchRate_1_s = 1.0;  // of the change to and from the search
constexpr double kRecovery = 2.0;        // so much faster than it grows, the time without support falls
constexpr double kSteepest_rad = 1.4;    // of the head, against the course
constexpr double kLead_rad = 0.09;       // between a joint and its setpoint: the torque limit alone is the torque
constexpr double kAllow_rad2 = 0.01;     // of the shape of a straight body, which has no speed

/// Angles and rates of the yaw joints, and the heading of each link.
struct Body {
  explicit Body(const MethodInput& input) {
    for (std::size_t k = 0; k < input.chain.joint_count(); ++k) {
      angle_rad[k] = input.measured_rad[input.chain.joint_index(k)];
      rate_rad_s[k] = input.rate_rad_s[input.chain.joint_index(k)];
    }
    heading_rad = input.chain.headings(angle_rad);
    double mean_rad = 0.0;
    for (std::size_t k = 0; k < input.chain.link_count(); ++k)
      mean_rad += heading_rad[k] / static_cast<double>(input.chain.link_count());
    // Without an inertial unit, the mean heading of the body is its course.
    const double head_rad = input.around.imu ? yaw_of(input.around.imu->orientation) : -mean_rad;
    for (std::size_t k = 0; k < input.chain.link_count(); ++k) heading_rad[k] += head_rad;
    mean_heading_rad = mean_rad + head_rad;
  }
  LinkArray angle_rad{}, rate_rad_s{}, heading_rad{};
  double mean_heading_rad = 0.0;
};

/// [m/s] The speed at which the shape travels along the body towards the tail, by least squares. The rate of a joint is
/// this speed times (angle of the joint before it - angle of the joint behind it) / (two link lengths).
double shape_speed_m_s(const YawChain& chain, const Body& body) {
  double product = 0.0, square = kAllow_rad2;
  for (std::size_t k = 1; k + 1 < chain.joint_count(); ++k) {
    const double difference_rad = body.angle_rad[k - 1] - body.angle_rad[k + 1];
    product += body.rate_rad_s[k] * difference_rad;
    square += difference_rad * difference_rad;
  }
  return 2.0 * chain.link_length_m() * product / square;
}

class ObstacleAided : public ControlMethod {
 public:
  std::string_view name() const override { return "obstacle_aided"; }
  /// Only forwards, and without an object.
  bool accepts(const msg::DesiredTrajectory& desired, const YawChain& chain) const override {
    return ControlMethod::accepts(desired, chain) && desired.speed_m_s >= 0.0 &&
           std::all_of(desired.shape_rad, desired.shape_rad + desired.shape_count,
                       [](double angle) { return angle == 0.0; });
  }

  void start(const MethodInput& input, BodyState& body) const override {
    body.residual_rad = input.commanded_rad;
    body.shape_rad = {};
    body.lift_rad = {};
    body.wave.amplitude_rad = 0.0;
    body.scratch[kCourse] = Body(input).mean_heading_rad;
  }

  MethodProgress step(const MethodInput& input, BodyState& body, Setpoints& setpoints) const override {
    const ControlConfig& c = input.config;
    auto& state = body.scratch;
    const Body now(input);
    const bool moves = input.gait.amplitude_rad > 0.0 && input.gait.frequency_hz > 0.0;
    state[kSwing] =
        approach(state[kSwing], moves ? 1.0 : 0.0, c.amplitude_rate_rad_s / c.obstacles.swing_rad * input.dt_s);
    body.frequency_hz = approach(body.frequency_hz, input.gait.frequency_hz, c.frequency_rate_hz_s * input.dt_s);
    body.wave.curvature_1_m =
        approach(body.wave.curvature_1_m, input.gait.curvature_1_m, c.curvature_rate_1_ms * input.dt_s);
    state[kSpeed] += (shape_speed_m_s(input.chain, now) - state[kSpeed]) * input.dt_s / kSpeed_s;
    const double forward_m_s = std::max(0.0, state[kSpeed]);
    state[kCourse] += body.wave.curvature_1_m * forward_m_s * input.dt_s;
    if (!moves && state[kSwing] <= 0.0) return {};  // keeps its posture
    feel(input, now, body);
    const double search = state[kSearch];
    const double swings_hz = (1.0 - search) * (forward_m_s / c.obstacles.path_m) + body.frequency_hz;
    body.wave.phase_rad = wrap_angle(body.wave.phase_rad + kTurn * swings_hz * input.dt_s);
    fade_residual(input, body, setpoints);
    lead_with_head(input, now, body, setpoints);
    for (std::size_t k = 1; k < input.chain.joint_count(); ++k) push(input, now, k, state[kSwing], setpoints);
    if (search > 0.0) move_sideways(input, body, setpoints);
    return {};
  }

 private:
  /// Updates what the contacts mean: a way out for the head, and whether obstacles support the body.
  static void feel(const MethodInput& input, const Body& now, BodyState& body) {
    auto& state = body.scratch;
    const ObstacleParameters& law = input.config.obstacles;
    state[kWayOut] -= state[kWayOut] * input.dt_s / kWayOut_s;
    if (!input.around.contacts || input.around.contacts->module_count == 0) return;  // it feels nothing
    LinkArray heading_rad = now.heading_rad;
    for (double& heading : heading_rad) heading -= state[kCourse];
    const ObstacleEffect effect = obstacle_effect(*input.around.contacts, input.chain, heading_rad);
    if (effect.way_out != 0.0) state[kWayOut] = effect.way_out;
    state[kSupport] += (effect.forward_n - state[kSupport]) * input.dt_s / kSupport_s;
    const bool searches = state[kAlone] > law.alone_s;
    if (state[kSupport] < law.engaged_n || searches) {
      state[kAlone] += input.dt_s;
    } else {
      state[kAlone] = std::max(0.0, state[kAlone] - kRecovery * input.dt_s);
    }
    if (state[kAlone] > law.alone_s + law.search_s) {
      state[kAlone] = 0.0;
      state[kOtherSide] = 1.0 - state[kOtherSide];
    }
    state[kSearch] = approach(state[kSearch], state[kAlone] > law.alone_s ? 1.0 : 0.0, kSearchRate_1_s * input.dt_s);
  }

  /// The first joint turns the head to the heading of the path, and away from what stops it.
  static void lead_with_head(const MethodInput& input, const Body& now, const BodyState& body, Setpoints& setpoints) {
    const auto& state = body.scratch;
    const ObstacleParameters& law = input.config.obstacles;
    const double path_rad =
        law.swing_rad * state[kSwing] * std::cos(body.wave.phase_rad) + law.avoid_rad * state[kWayOut];
    const double heading_rad = state[kCourse] + std::clamp(path_rad, -kSteepest_rad, kSteepest_rad);
    setpoints.position_rad[input.chain.joint_index(0)] += wrap_angle(heading_rad - now.heading_rad[1]);
  }

  /// The torque of joint `k`: what bends the body as it would be bent if it had slid forwards along itself.
  static void push(const MethodInput& input, const Body& now, std::size_t k, double share, Setpoints& setpoints) {
    const std::size_t j = input.chain.joint_index(k);
    const bool last = k + 1 == input.chain.joint_count();
    // The tail has no joint behind it; the difference of one length counts twice.
    const double difference_rad =
        last ? 2.0 * (now.angle_rad[k - 1] - now.angle_rad[k]) : now.angle_rad[k - 1] - now.angle_rad[k + 1];
    const double torque_nm = share * input.config.obstacles.bend_nm * difference_rad;
    setpoints.position_rad[j] = now.angle_rad[k] + std::copysign(kLead_rad, torque_nm);
    setpoints.torque_limit_nm[j] = std::min(std::abs(torque_nm), input.robot.joints[j].max_torque_nm);
  }

  /// Mixes the gait "sidewinding" into the setpoints.
  static void move_sideways(const MethodInput& input, const BodyState& body, Setpoints& setpoints) {
    const ControlConfig& c = input.config;
    const double search = body.scratch[kSearch];
    const double side = body.scratch[kOtherSide] > 0.0 ? -1.0 : 1.0;
    const double wave_number = kTurn / c.sidewinding_wavelength_m;
    for (std::size_t j = 0; j < input.robot.joints.size(); ++j) {
      const double arc_m = static_cast<double>(j + 1) * input.robot.module_length_m;
      const double argument = body.wave.phase_rad + wave_number * arc_m;
      if (input.robot.joints[j].axis == JointAxis::kYaw) {
        setpoints.position_rad[j] += search * (c.sidewinding_yaw_rad * std::sin(argument) - setpoints.position_rad[j]);
        setpoints.torque_limit_nm[j] = input.robot.joints[j].max_torque_nm;
      } else {
        setpoints.position_rad[j] -= side * search * c.sidewinding_pitch_rad * std::cos(argument);
      }
    }
  }
};

}  // namespace

std::unique_ptr<ControlMethod> make_obstacle_aided() { return std::make_unique<ObstacleAided>(); }

}  // namespace constrictor
