// "sliding_mode": the wave of "undulation", which the joints follow by torques instead of angles. README.md derives the
// law and its limits.
#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "control/joint_inertia.hpp"
#include "control/wave_motion.hpp"

namespace constrictor {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kMostReached = 0.5;  // share of the distance to the surface that is covered in a tick, at most
/// A damper D on an inertia J does not swing up to D = J / (kNoSwing dt), if it acts one tick late.
constexpr double kNoSwing = 4.0;

/// The joints of one axis as vectors.
struct Axis {
  explicit Axis(const MethodInput& input, JointAxis axis) {
    for (std::size_t j = 0; j < input.robot.joints.size(); ++j) {
      if (input.robot.joints[j].axis == axis) joints.push_back(j);
    }
  }
  [[nodiscard]] VectorXd of(const JointArray& values) const {
    VectorXd vector(static_cast<Index>(joints.size()));
    for (std::size_t i = 0; i < joints.size(); ++i) vector(static_cast<Index>(i)) = values[joints[i]];
    return vector;
  }
  void put(const VectorXd& vector, JointArray& values) const {
    for (std::size_t i = 0; i < joints.size(); ++i) values[joints[i]] = vector(static_cast<Index>(i));
  }
  std::vector<std::size_t> joints;
};

class SlidingMode : public ControlMethod {
 public:
  std::string_view name() const override { return "sliding_mode"; }
  bool keeps_pose() const override { return true; }
  /// A body that holds an object is not moved by torques: the law knows nothing of the object.
  bool accepts(const msg::DesiredTrajectory& desired, const YawChain& chain) const override {
    return ControlMethod::accepts(desired, chain) &&
           std::all_of(desired.shape_rad, desired.shape_rad + desired.shape_count,
                       [](double angle) { return angle == 0.0; });
  }
  void start(const MethodInput& input, BodyState& body) const override { keep_residual(input, body); }

  MethodProgress step(const MethodInput& input, BodyState& body, Setpoints& setpoints) const override {
    const LinkArray shape_rad = desired_shape(input.desired, input.chain);
    advance_wave(input, 1.0, body);
    const double left_rad = advance_shape(input, shape_rad, desired_shape_rate(input), body);
    ride(input, shape_rad, body, setpoints);
    SlidingState& state = body.sliding;
    if (!state.started) {
      state.reference_rad = state.reference2_rad = setpoints.position_rad;
      state.rate_rad_s = input.rate_rad_s;
      state.started = true;
    }
    push(input, Axis(input, JointAxis::kYaw), state, setpoints);
    give_way(input, Axis(input, JointAxis::kPitch), setpoints);
    state.reference2_rad = state.reference_rad;
    state.reference_rad = setpoints.position_rad;
    state.rate_rad_s = input.rate_rad_s;
    state.exerted_nm = input.exerted_nm;
    setpoints.torque_mode = true;
    return {false, left_rad > 0.0 ? 0.0 : 1.0};
  }

 private:
  /// The torques of the pitch joints: those of soft springs with dampers. The ground keeps these joints straight. An
  /// estimate of unknown torques would contain the push of the ground, and the torque against it made the body rear up.
  static void give_way(const MethodInput& input, const Axis& axis, Setpoints& setpoints) {
    if (axis.joints.empty()) return;
    const SlidingParameters& law = input.config.sliding;
    const VectorXd angle = axis.of(input.measured_rad);
    const MatrixXd inertia = JointInertia(input.robot, axis.joints, law.mass_share).matrix(angle);
    const Eigen::SelfAdjointEigenSolver<MatrixXd> modes(inertia, Eigen::EigenvaluesOnly);
    const double damping_nm_s = modes.eigenvalues()(0) / (kNoSwing * input.dt_s);
    const VectorXd error = angle - axis.of(setpoints.position_rad);
    axis.put(-damping_nm_s * (axis.of(input.rate_rad_s) + law.surface_1_s * error), setpoints.torque_nm);
  }

  /// The torques of the yaw joints. `setpoints.position_rad` is the reference of this tick.
  static void push(const MethodInput& input, const Axis& axis, SlidingState& state, Setpoints& setpoints) {
    if (axis.joints.empty()) return;
    const SlidingParameters& law = input.config.sliding;
    const double dt = input.dt_s;
    const VectorXd angle = axis.of(input.measured_rad), rate = axis.of(input.rate_rad_s);
    MatrixXd inertia = JointInertia(input.robot, axis.joints, law.mass_share).matrix(angle);
    if (law.inertia != 0) inertia = inertia.inverse().diagonal().cwiseInverse().asDiagonal().toDenseMatrix();
    const auto solver = inertia.ldlt();

    // The torques of the motion that the torques of the tick before last, which acted until now, do not explain.
    const VectorXd missing = inertia * (rate - axis.of(state.rate_rad_s)) / dt - axis.of(state.exerted_nm);
    VectorXd unknown = axis.of(state.unknown_nm);
    unknown += (missing - unknown) * dt / (law.estimate_s + dt);
    axis.put(unknown, state.unknown_nm);

    // The new torques act from the next tick on; until then the previous ones do.
    const VectorXd now = axis.of(input.exerted_nm);
    const VectorXd acceleration = solver.solve(now + unknown);
    const VectorXd next_angle = angle + dt * rate + 0.5 * dt * dt * acceleration;
    const VectorXd next_rate = rate + dt * acceleration;

    const VectorXd r2 = axis.of(state.reference2_rad), r1 = axis.of(state.reference_rad);
    const VectorXd r0 = axis.of(setpoints.position_rad);
    const VectorXd error = next_angle - r1;
    const VectorXd error_rate = next_rate - (r0 - r2) / (2.0 * dt);
    const VectorXd surface = error_rate + law.surface_1_s * error;
    const double layer = std::max(law.layer_rad_s, law.reaching_rad_s2 * dt / kMostReached);
    const VectorXd reaching = law.reaching_rad_s2 * (surface / layer).cwiseMax(-1.0).cwiseMin(1.0);
    const VectorXd wanted = (r0 - 2.0 * r1 + r2) / (dt * dt) - law.surface_1_s * error_rate - reaching;
    axis.put(inertia * wanted - unknown, setpoints.torque_nm);
  }
};

}  // namespace

std::unique_ptr<ControlMethod> make_sliding_mode() { return std::make_unique<SlidingMode>(); }

}  // namespace constrictor
