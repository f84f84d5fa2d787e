// Search object (Tables III, IV): if an object of the colour was seen before, the body turns and goes to that place.
// Otherwise the head looks to both sides, and the body advances or turns on the spot between two looks. The task ends
// when an object of the colour has stayed in view for a moment.
#include <algorithm>
#include <cmath>
#include <optional>

#include "navigation/motions.hpp"
#include "navigation/object_handles.hpp"
#include "robot/planar.hpp"

namespace constrictor {
namespace {

struct SearchState {
  int phase = 0;
  int looks = 0;  ///< completed looks to both sides
  double phase_s = 0.0;
  double turned_rad = 0.0;
  double last_course_rad = 0.0;
  PlanarPose from;    ///< the head when the phase began
  int returns = 0;    ///< how often the robot went to the remembered place
  double side = 1.0;  ///< of the turn towards that place: +1 left, -1 right
  template <class Archive>
  void serialize(Archive& archive) {
    archive(phase, looks, phase_s, turned_rad, last_course_rad, from, returns, side);
  }
};

class SearchObject : public StatefulTask<SearchState> {
  enum Phase : int { kLookLeft, kLookRight, kLookAhead, kAdvance, kTurn, kConfirm, kLeave, kFace, kApproach };

 public:
  std::string refusal(const TaskInput& input, const Grip&) const override { return handle_refusal(input); }
  void start(const TaskInput& input, Grip&) override { begin(input); }

  void step(const TaskInput& input, Grip& grip, TaskOutput& output) override {
    const SearchConfig& config = input.config.search;
    const std::uint8_t colour = input.parameters.object_colour;
    const Sighting& object = input.sightings.objects[colour];
    state_.phase_s += input.tick.dt_s();
    const double course_rad = body_course_rad(input);  // of the body: the head may be looking aside
    state_.turned_rad += wrap_angle(course_rad - state_.last_course_rad);
    state_.last_course_rad = course_rad;
    output.progress = 1.0 - 1.0 / (1.0 + 0.25 * state_.looks);

    if (state_.phase == kConfirm) {
      confirm(input, grip, object, output);
      return;
    }
    // An object of which something hides the foot may be in view for a while before the map has its place.
    if (object.visible && object.decided && object.known && is_named(input)) {
      output.emit(msg::kEventObjectFound, colour, seen_handle(input, colour));
      enter(input, kConfirm);
      confirm(input, grip, object, output);
      return;
    }
    // With an object in the U the head cannot turn by itself, so the robot looks around by driving in bends.
    if (grip.carrying) {
      move_on(input, std::sin(0.3 * state_.phase_s), 1.0, grip, output);
      output.phase = "drive";
      return;
    }
    if (state_.phase >= kLeave) {
      go_back(input, grip, output);
    } else {
      sweep(input, grip, config, output);
    }
  }

 private:
  void enter(const TaskInput& input, int phase) {
    state_.phase = phase;
    state_.phase_s = 0.0;
    state_.turned_rad = 0.0;
    state_.last_course_rad = body_course_rad(input);
    state_.from = input.X_MH;
  }

  /// Last known place of an object of the colour, in M; empty: there is none nearby.
  [[nodiscard]] static std::optional<Eigen::Vector2d> remembered(const TaskInput& input) {
    const std::uint8_t colour = input.parameters.object_colour;
    std::optional<Eigen::Vector2d> best;
    if (input.sightings.objects[colour].known) best = input.sightings.objects[colour].p_M();
    if (const msg::MapObject* named = named_object(input)) best = Eigen::Vector2d(named->x_m, named->y_m);
    const bool nearby = best && (*best - input.X_MH.p).norm() < input.config.search.remembered_m;
    return nearby ? best : std::nullopt;
  }

  void begin(const TaskInput& input) {
    constexpr int kReturns = 3;
    const bool back = remembered(input) && state_.returns < kReturns;
    if (back) ++state_.returns;
    enter(input, back ? kLeave : kLookAhead);
  }

  /// First away from the remembered place, so that the turn does not push the object; then face it; then approach it.
  void go_back(const TaskInput& input, Grip& grip, TaskOutput& output) {
    constexpr double kTurn_s = 12.0;
    const SearchConfig& config = input.config.search;
    const auto p_MO = remembered(input);
    if (!p_MO) {
      enter(input, kLookAhead);
      return;
    }
    const Eigen::Vector2d d = *p_MO - input.X_MH.p;
    const double bearing_rad = wrap_angle(std::atan2(d.y(), d.x()) - body_course_rad(input));
    switch (state_.phase) {
      case kLeave:
        output.phase = "leave";
        move_on(input, 0.0, std::cos(bearing_rad) > 0.0 ? -1.0 : 1.0, grip, output);
        if (nearest_module_m(input, *p_MO) < config.near_m && state_.phase_s < kTurn_s) break;
        state_.side = bearing_rad > 0.0 ? 1.0 : -1.0;
        enter(input, kFace);
        break;
      case kFace:
        output.phase = "face";
        move_on(input, state_.side * config.turn_curvature_1_m, 1.0, grip, output);
        if (std::abs(bearing_rad) < 0.25 || (state_.side * bearing_rad < 0.0 && std::abs(bearing_rad) < 1.5) ||
            state_.phase_s > kTurn_s) {
          enter(input, kApproach);
        }
        break;
      default:
        output.phase = "approach";
        move_on(input, std::clamp(2.0 * bearing_rad, -1.2, 1.2), 1.0, grip, output);
        if (d.norm() < config.near_m || state_.phase_s > kTurn_s) enter(input, kLookAhead);
        break;
    }
  }

  void confirm(const TaskInput& input, Grip& grip, const Sighting& object, TaskOutput& output) {
    stand(grip, output);
    output.phase = "confirm";
    if (!object.visible) {
      output.emit(msg::kEventObjectLost, input.parameters.object_colour, input.parameters.object_handle);
      begin(input);
    } else if (state_.phase_s >= input.config.search.confirm_s && object.missed == 0) {
      output.succeed();
    }
  }

  void sweep(const TaskInput& input, Grip& grip, const SearchConfig& config, TaskOutput& output) {
    const double each_rad = config.head_turn_rad / 3.0;
    const bool done = input.motion_done && state_.phase_s > 0.1;
    switch (state_.phase) {
      case kLookLeft:
        output.phase = "look left";
        bend_head(each_rad, config.head_rate_rad_s, grip, output);
        if (done) enter(input, kLookRight);
        break;
      case kLookRight:
        output.phase = "look right";
        bend_head(-each_rad, config.head_rate_rad_s, grip, output);
        if (done) {
          ++state_.looks;
          enter(input, state_.looks % 2 == 0 ? kTurn : kAdvance);
        }
        break;
      case kLookAhead:
        output.phase = "look ahead";
        bend_head(0.0, config.head_rate_rad_s, grip, output);
        if (done) enter(input, kLookLeft);
        break;
      case kAdvance:
        output.phase = "advance";
        move_on(input, 0.0, 1.0, grip, output);
        if ((input.X_MH.p - state_.from.p).norm() >= config.advance_m || state_.phase_s > 6.0) enter(input, kLookAhead);
        break;
      default:
        output.phase = "turn";
        move_on(input, config.turn_curvature_1_m, 1.0, grip, output);
        if (std::abs(state_.turned_rad) >= config.turn_rad || state_.phase_s > 8.0) enter(input, kLookAhead);
        break;
    }
  }
};

}  // namespace

std::unique_ptr<Task> make_search_object() { return std::make_unique<SearchObject>(); }

}  // namespace constrictor
