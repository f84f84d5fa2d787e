#include "conform/planner_hand.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include "constrictor/text.hpp"
#include "robot/planar.hpp"

namespace constrictor::conform {
namespace {

constexpr std::size_t kImage_ticks = 5;
constexpr double kSpeed_m_s = 0.2, kTurn_rad_s = 0.5;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

}  // namespace

PlannerHand::PlannerHand(PartPort& port) : port_(port) { status_.parameters.timeout_s = status_.cross_track_m = kNaN; }

void PlannerHand::see(std::uint8_t colour, std::uint8_t kind, double range_m) {
  objects_ = {};
  objects_.blob_count = 1;
  msg::Blob& blob = objects_.blobs[0];
  blob.colour = colour;
  blob.kind = kind;
  blob.object_probability = kind == msg::kBlobObject ? 0.99 : 0.01;
  blob.range_m = range_m;
  blob.width_m = kind == msg::kBlobObject ? 0.16 : 0.6;
  blob.height_m = kind == msg::kBlobObject ? 0.15 : kNaN;
  blob.area_fraction = 0.02;
  blob.u_min = 150, blob.u_max = 170, blob.v_min = 100, blob.v_max = 140;
}

std::size_t PlannerHand::map_zone(std::uint8_t colour, double ahead_m) {
  const double x_m = pose_.x_m + ahead_m * std::cos(pose_.yaw_rad), y_m = pose_.y_m + ahead_m * std::sin(pose_.yaw_rad);
  const auto handle = static_cast<std::uint16_t>(2 * colour + 1);
  std::size_t zone = 0;  // each zone is followed by its object
  while (zone < map_.object_count && map_.objects[zone].handle != handle) zone += 2;
  map_.object_count = static_cast<std::uint16_t>(std::max<std::size_t>(map_.object_count, zone + 1));
  map_.objects[zone] = {handle, colour, msg::kBlobZone, x_m, y_m, 0.4, kNaN, 0.03, false, false, port_.tick(), 0.01};
  return zone;
}

void PlannerHand::map_on_zone(std::uint8_t colour) {
  constexpr double kAhead_m = 0.5;
  const std::size_t index = map_zone(colour, kAhead_m);
  const msg::MapObject& zone = map_.objects[index];
  map_.object_count = static_cast<std::uint16_t>(std::max<std::size_t>(map_.object_count, index + 2));
  map_.objects[index + 1] = {static_cast<std::uint16_t>(zone.handle + 1),
                             colour,
                             msg::kBlobObject,
                             zone.x_m + 0.05,
                             zone.y_m,
                             0.08,
                             0.15,
                             0.03,
                             false,
                             false,
                             port_.tick(),
                             1.0};
}

void PlannerHand::report(std::uint8_t event, std::uint8_t goal_state, std::uint16_t handle, std::int64_t other_goal) {
  msg::TaskEvent message{};
  message.goal_id = status_.goal_id + static_cast<std::uint64_t>(other_goal);
  message.task = status_.task;
  message.event = event;
  message.goal_state = goal_state;
  message.object_handle = handle;
  events_.push_back(message);
  if (other_goal == 0) status_.goal_state = goal_state;
}

void PlannerHand::give_authority(std::uint8_t level, bool emergency_stop) {
  authority_.level = level;
  authority_.emergency_stop = emergency_stop;
  set_text(authority_.source, level == msg::kAuthorityOperator  ? "person.1"
                              : level == msg::kAuthorityPlanner ? "planner"
                                                                : "");
}

void PlannerHand::take(const msg::Request& request) {
  if (request.kind != msg::kRequestTask || answer == Answer::kIgnore) return;
  if (request.command == msg::kCommandCancel) {
    if (status_.goal_state == msg::kGoalRunning) report(msg::kEventNone, msg::kGoalCancelled);
    return;
  }
  newest_ = request;
  const std::uint8_t carrying = status_.carrying;
  status_.goal_id = kGoalBase + request.goal_id;
  status_.task = request.task;
  status_.parameters = request.parameters;
  status_.progress = 0.0;
  status_.carrying = carrying;
  authority_.goal_id = status_.goal_id;
  give_authority(msg::kAuthorityPlanner);
  report(msg::kEventNone, answer == Answer::kRefuse ? msg::kGoalRefused : msg::kGoalRunning);
  if (answer == Answer::kRefuse) answer = Answer::kTake;
}

void PlannerHand::move() {
  if (!moves || status_.goal_state != msg::kGoalRunning) return;
  const std::uint8_t direction = status_.parameters.direction;
  const double side = direction == msg::kDirectionLeft ? 1.0 : direction == msg::kDirectionRight ? -1.0 : 0.0;
  const bool turns = status_.task == msg::kTaskRotate || status_.task == msg::kTaskExplore;
  if (turns) pose_.yaw_rad = wrap_angle(pose_.yaw_rad + side * kTurn_rad_s * kTick_s);
  if (status_.task == msg::kTaskFollowLine) {
    // Along the line, in the direction in which the head looks.
    pose_.yaw_rad = std::abs(pose_.yaw_rad) < 0.5 * std::numbers::pi ? 0.0 : std::numbers::pi;
    pose_.x_m += kSpeed_m_s * kTick_s * std::cos(pose_.yaw_rad);
  }
  pose_.body_yaw_rad = pose_.yaw_rad;
  status_.progress = std::min(0.9, status_.progress + 0.001);
}

void PlannerHand::tick() {
  if (ticks_ % kImage_ticks == 0) {
    msg::LinePercept line{};
    line.exposure_tick = std::max<std::int64_t>(0, port_.tick() - 2);
    line.colour = msg::kColourBlue;
    line.visible = sees_line_;
    line.lookahead_m = 0.35;
    line.end_distance_m = kNaN;
    // The line lies along x of the map; the head sees the direction that is nearer.
    const double ahead_rad = std::remainder(-pose_.yaw_rad, std::numbers::pi);
    line.offset_m = sees_line_ ? 0.0 : kNaN;
    line.heading_rad = sees_line_ ? ahead_rad : kNaN;
    line.curvature_1_m = sees_line_ ? 0.0 : kNaN;
    line.near_m = sees_line_ ? 0.1 : kNaN;
    line.far_m = sees_line_ ? 0.8 : kNaN;
    port_.send(topics::kLinePercept, line);
    objects_.exposure_tick = line.exposure_tick;
    port_.send(topics::kObjectPercepts, objects_);
    port_.send(topics::kFieldMap, map_);
    port_.send(topics::kAuthority, authority_);
  }
  move();
  pose_.speed_m_s = 0.0;
  port_.send(topics::kRobotPose, pose_);
  port_.send(topics::kTaskStatus, status_);
  for (const auto& event : events_) port_.send(topics::kTaskEvent, event);
  events_.clear();
  port_.advance();
  ++ticks_;
  for (const auto* mission : port_.written(topics::kMissionStatus)) missions_.push_back(*mission);
  for (const auto* request : port_.written(topics::kPlannerRequest)) {
    requests_.push_back(*request);
    request_ticks_.push_back(port_.tick());
    take(*request);
  }
}

bool PlannerHand::run(double seconds, const std::function<bool()>& until) {
  for (long i = std::lround(seconds / kTick_s); i > 0; --i) {
    if (until && until()) return true;
    tick();
  }
  return until && until();
}

}  // namespace constrictor::conform
