// Grasp (Tables IX, X): the body wraps itself round the object beside it, drives on until the base of the U touches the
// object, squeezes until the torque in the base shows that the object is held, and checks by touch that it is inside. A
// robot without contact sensors relies on the torque alone.
#include <algorithm>
#include <cereal/types/array.hpp>
#include <cmath>

#include "navigation/motions.hpp"
#include "navigation/steering.hpp"

namespace constrictor {
namespace {

struct GraspState : PhaseState {
  double seated_s = 0.0;
  int touching = 0;                                  ///< modules near the base that touched within touch_memory_s
  std::array<double, msg::kMaxModules> touched_s{};  ///< time since the last touch of each module
  PlanarPose before;                                 ///< the head at the previous step
  PlanarPose seat_from;                              ///< the head when the seat began
  double slid_m = 0.0;                               ///< distance by which the arc has moved along the body
  int squeezes = 0;
  SteeringState steering;
  double speed_m_s = 0.0;  ///< smoothed speed of the head along its own axis
  template <class Archive>
  void serialize(Archive& archive) {
    archive(phase, phase_s, seated_s, touching, touched_s, before, seat_from, slid_m, squeezes, speed_m_s, steering);
  }
};

class Grasp : public StatefulTask<GraspState> {
  enum Phase : int { kWrap, kSeat, kSqueeze, kCheck, kOpen };

 public:
  /// The object is felt; the camera does not see it.
  [[nodiscard]] bool steers_by_sight() const override { return false; }
  std::string refusal(const TaskInput& input, const Grip& grip) const override {
    const std::uint16_t named = input.parameters.object_handle;
    if (grip.carrying) return "the body holds an object already";
    if (!grip.pregrasped) return "no object is pregrasped";
    const std::uint8_t colour = input.parameters.object_colour;
    if (colour != msg::kColourUnknown && colour != grip.colour) return "the pregrasped object has another colour";
    const bool another = named != 0 && grip.handle != 0 && named != grip.handle;
    return another ? "object_handle: found " + std::to_string(named) + ", pregrasped is " + std::to_string(grip.handle)
                   : "";
  }
  void start(const TaskInput& input, Grip& grip) override {
    grip.pregrasped = false;
    const double scale = input.parameters.wrap_scale;
    grip.wrap_scale = scale > 0.0 ? scale : 1.0;
    state_.touched_s.fill(1e9);
    if (grip.handle == 0) grip.handle = input.parameters.object_handle;
    state_.before = input.X_MH;
    state_.speed_m_s = input.config.grasp.wrap_speed_m_s;
  }

  void step(const TaskInput& input, Grip& grip, TaskOutput& output) override {
    state_.phase_s += input.tick.dt_s();
    output.progress = 0.25 * state_.phase;
    run_phase<Grasp, 5>(*this, {&Grasp::wrap, &Grasp::seat, &Grasp::squeeze, &Grasp::check, &Grasp::open}, state_.phase,
                        input, grip, output);
  }

 private:
  static std::array<double, msg::kMaxJoints> open_u(const TaskInput& input, const Grip& grip) {
    return input.grip_sense.open_shape(grip.side, input.grip_sense.open_angle_rad(grip));
  }

  void wrap(const TaskInput& input, Grip& grip, TaskOutput& output) {
    output.phase = "wrap";
    // The head bends round the object before the body begins to move; otherwise it would pass the object.
    const bool still = state_.slid_m < input.config.grasp.wrap_still_m;
    // The arc must slide along the body as fast as the body advances, so that it stays round the object.
    const GraspConfig& config = input.config.grasp;
    const double moved_m = (input.X_MH.p - state_.before.p).dot(input.X_MH.forward());
    const double share = -std::expm1(-input.tick.dt_s() / config.wrap_speed_filter_s);
    state_.speed_m_s += share * (moved_m / input.tick.dt_s() - state_.speed_m_s);
    state_.before = input.X_MH;
    const double slide_m_s = still ? config.wrap_speed_m_s
                                   : std::clamp(state_.speed_m_s, config.wrap_speed_min_m_s, config.wrap_speed_max_m_s);
    wrap_round(input.grip_sense, still ? 0.0 : config.wrap_m_s, grip.side, slide_m_s, grip, output);
    state_.slid_m += slide_m_s * input.tick.dt_s();
    if (input.motion_done && state_.phase_s > 0.2) enter_seat(input);
  }

  void enter_seat(const TaskInput& input) {
    state_.enter(kSeat);
    state_.seat_from = input.X_MH;
  }

  void seat(const TaskInput& input, Grip& grip, TaskOutput& output) {
    const GraspConfig& config = input.config.grasp;
    output.phase = "seat";
    move_in_shape({"seat", config.seat_m_s}, back_to_line_1_m(input, state_.steering), 1.0, open_u(input, grip),
                  input.grip_sense.yaw_joint_count(), output);
    keep_upright(input.config, grip, output);
    if (input.grip_sense.apex_force_n(touches_of(grip.handle, input.touches)) >= config.seat_force_n)
      state_.seated_s += input.tick.dt_s();
    count_touching(input, grip);
    // A large object wedges between the arms before it reaches the middle of the base. It moves with the body all the
    // same, and the squeeze shows whether it is held.
    constexpr double kLong_s = 8.0;  // twice the usual time
    const bool wedged = state_.phase_s > kLong_s && state_.touching >= config.touching_modules;
    const bool felt = state_.seated_s >= config.seat_time_s || wedged;
    // Without contact sensors, only the squeeze shows whether the object lies in the base.
    if (input.feels ? felt : state_.phase_s >= config.unfelt_seat_s) {
      state_.touched_s.fill(1e9);
      state_.enter(kSqueeze);
    } else if (state_.phase_s > config.seat_timeout_s || passed(input)) {
      state_.enter(kOpen);
    }
  }

  /// Whether the body has driven farther than the whole of it can need to bring its base to the object. In 116 grasps
  /// the longest seat took 1.1 lengths of the body. Without this bound, a robot that had missed its object drove on for
  /// 6 m, and did not find it again for a minute.
  [[nodiscard]] bool passed(const TaskInput& input) const {
    constexpr double kLengths = 1.25;
    const double length_m = static_cast<double>(input.robot.module_count) * input.robot.module_length_m;
    return (input.X_MH.p - state_.seat_from.p).norm() > kLengths * length_m;
  }

  /// Counts the modules near the base with a recent touch of the object: the gait interrupts touches.
  void count_touching(const TaskInput& input, const Grip& grip) {
    for (double& since_s : state_.touched_s) since_s += input.tick.dt_s();
    for (const Touch& touch : touches_of(grip.handle, input.touches)) state_.touched_s[touch.module] = 0.0;
    state_.touching = 0;
    for (std::size_t m = 0; m < input.robot.module_count; ++m) {
      if (input.grip_sense.is_near_base(m) && state_.touched_s[m] < input.config.grasp.touch_memory_s)
        ++state_.touching;
    }
  }

  /// Whether as many modules touch as with a held object; always true for a robot without contact sensors.
  [[nodiscard]] bool enough_touches(const TaskInput& input) const {
    return !input.feels || state_.touching >= input.config.grasp.touching_modules;
  }

  void squeeze(const TaskInput& input, Grip& grip, TaskOutput& output) {
    const GraspConfig& config = input.config.grasp;
    output.phase = "squeeze";
    // Driving on presses the object into the base, and moving arms overcome the friction of the ground more easily.
    squeeze_u(input.config, input.grip_sense, grip.side, grip, output);
    const double torque_nm = input.grip_sense.largest_closing_nm(input.joints, grip.side);
    count_touching(input, grip);
    const bool settled = state_.phase_s >= config.squeeze_settle_s;  // the wave of the seat loads the joints, too
    const bool firm = settled && torque_nm >= config.squeeze_torque_nm && enough_touches(input);
    const bool closed = input.motion_done && state_.phase_s > 0.5;
    if (!firm && !closed) return;
    if (!firm && ++state_.squeezes < config.squeeze_attempts) {
      state_.seated_s = 0.0;
      enter_seat(input);
      return;
    }
    grip.shape_rad = input.grip_sense.hold_shape(input.joints, grip, input.feels);
    input.grip_sense.hold_starts(grip);
    state_.enter(kCheck);
  }

  void check(const TaskInput& input, Grip& grip, TaskOutput& output) {
    const GraspConfig& config = input.config.grasp;
    output.phase = "check";
    // The robot drives as it does with an object: the base pushes an object that is inside the U, and so touches it.
    move_in_shape(carrying_pace(input.config), back_to_line_1_m(input, state_.steering), 1.0, grip.shape_rad,
                  input.grip_sense.yaw_joint_count(), output);
    keep_upright(input.config, grip, output);
    output.desired.torque_limit_nm = grip.hold_torque_nm;
    count_touching(input, grip);
    const bool lost = input.grip_sense.watch(input.joints, input.touches, input.feels, input.tick.dt_s(), grip);
    if (state_.phase_s < config.check_s && !lost) return;
    if (enough_touches(input) && !lost) {
      grip.carrying = true;
      output.emit(msg::kEventObjectGrasped, grip.colour, grip.handle);
      output.succeed();
    } else {
      state_.enter(kOpen);
    }
  }

  /// Opens and straightens after a failed grasp, so that another attempt can begin.
  void open(const TaskInput& input, Grip& grip, TaskOutput& output) {
    output.phase = "open";
    bend_head(0.0, input.config.drop.straighten_rate_rad_s, grip, output);
    if (!input.motion_done || state_.phase_s < 0.2) return;
    output.emit(msg::kEventObjectGraspLost, grip.colour, grip.handle);
    output.abort("the object is not between the arms");
  }
};

}  // namespace

std::unique_ptr<Task> make_grasp() { return std::make_unique<Grasp>(); }

}  // namespace constrictor
