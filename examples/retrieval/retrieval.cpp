#include "retrieval.hpp"

#include <algorithm>
#include <cmath>

namespace retrieval {
namespace {

constexpr int kSure = 3;               // consecutive images that prove that something is in view
constexpr double kObjectNear_m = 1.6;  // objects nearer than this are approached
constexpr double kZoneNear_m = 1.7;    // zones nearer than this are near enough for a drop
constexpr double kAfterEnd_s = 8.0;    // for this long after the end of the line, only its last piece can be in view

}  // namespace

std::string Retrieval::stage() const {
  static const char* const names[] = {"look",          "follow", "search object", "track", "pregrasp", "grasp",
                                      "find the line", "carry",  "drop",          "turn",  "turn back"};
  return names[stage_];
}

void Retrieval::take(const Line& line) {
  line_ = line;
  lines_ = line.visible ? lines_ + 1 : 0;
  const bool follows = status_.task == kFollowLine && status_.state == kRunning;
  if (!follows || lines_ < kSure || !std::isfinite(line.offset_m) || !std::isfinite(line.heading_rad)) return;
  const double c = std::cos(pose_.yaw_rad);
  const double s = std::sin(pose_.yaw_rad);
  const double x_m = pose_.x_m + c * line.lookahead_m - s * line.offset_m;
  const double y_m = pose_.y_m + s * line.lookahead_m + c * line.offset_m;
  const TrailPoint* known = nearest_trail_point(x_m, y_m);
  if (known && std::hypot(known->x_m - x_m, known->y_m - y_m) < 0.3) return;
  trail_.push_back({x_m, y_m, wrapped(pose_.yaw_rad + line.heading_rad + (status_.carrying ? kPi : 0.0))});
}

void Retrieval::take(const std::vector<Percept>& percepts) {
  bool object = false;
  bool zone = false;
  for (const Percept& percept : percepts) {
    if (!std::isfinite(percept.range_m) || !std::isfinite(percept.bearing_rad)) continue;
    const double heading_rad = pose_.yaw_rad + percept.bearing_rad;
    const double x_m = pose_.x_m + percept.range_m * std::cos(heading_rad);
    const double y_m = pose_.y_m + percept.range_m * std::sin(heading_rad);
    // An object on the zone of its colour is delivered, or it is the zone itself seen at a low angle.
    const auto zone_place = places_.find({percept.colour, true});
    if (!percept.zone && zone_place != places_.end() &&
        std::hypot(zone_place->second.first - x_m, zone_place->second.second - y_m) < 0.7)
      continue;
    places_[{percept.colour, percept.zone}] = {x_m, y_m};
    if (percept.colour != colour()) continue;
    object = object || (!percept.zone && percept.range_m < kObjectNear_m);
    zone = zone || (percept.zone && percept.range_m < kZoneNear_m);
  }
  objects_ = object ? objects_ + 1 : 0;
  zones_ = zone ? zones_ + 1 : 0;
}

void Retrieval::take(const GoalEvent& event) {
  if (event.event == kObjectGrasped) held_ = event.colour;
  if (event.event == kObjectGraspLost) held_ = 0;
  if (event.event == kDroppingDone) {
    // The event's colour is that of the zone. The object is delivered, whichever planner dropped it.
    remaining_.erase(std::remove(remaining_.begin(), remaining_.end(), event.colour), remaining_.end());
    held_ = 0;
  }
  events_.push_back(event);
}

void Retrieval::take_over(double time_s) {
  now_s_ = time_s;
  in_command_ = true;
  events_.clear();
  const auto held = std::find(remaining_.begin(), remaining_.end(), held_);
  if (status_.carrying && held != remaining_.end()) std::rotate(remaining_.begin(), held, held + 1);
  enter(status_.carrying ? kFindLine : kLook);
}

void Retrieval::enter(Stage stage) {
  if (stage != stage_) {
    since_s_ = now_s_;
    lines_ = objects_ = zones_ = 0;
  }
  stage_ = stage;
  asked_ = false;
  differs_since_s_ = now_s_;
}

void Retrieval::set_back(Stage stage) {
  ++setbacks_;
  since_s_ = now_s_;
  enter(stage);
}

std::optional<Order> Retrieval::decide(double time_s) {
  now_s_ = time_s;
  if (!in_command_) {
    events_.clear();
    return std::nullopt;
  }
  if (asked_) follow_goal();
  if (asked_) follow_senses();
  if (asked_) follow_time();
  events_.clear();
  if (asked_ || done()) return std::nullopt;
  asked_ = true;
  asked_s_ = now_s_;
  return order_of_stage();
}

void Retrieval::follow_goal() {
  std::uint8_t state = status_.goal == goal_ ? status_.state : std::uint8_t{kRunning};
  for (const GoalEvent& event : events_) {
    if (event.event == kObjectGraspLost && loaded()) return set_back(kSearch);
    if (event.goal != goal_) continue;
    if (event.state != 0) state = event.state;
    if (event.event == kEndOfLine) line_end_s_ = now_s_;
    if (event.event == kDroppingDone) return enter(kTurn);
  }
  if (state == kRunning || state == 0) return;
  const bool good = state == kSucceeded;
  switch (stage_) {
    case kFollow:
      return good ? enter(kSearch) : set_back(kLook);
    case kSearch:
      return good ? enter(kTrack) : set_back(kLook);
    case kTrack:
      return good ? enter(kPre) : set_back(kSearch);
    case kPre:
      return good ? enter(kHold) : set_back(kSearch);
    case kHold:
      return good ? enter(kFindLine) : set_back(kSearch);
    case kCarry:
      return set_back(kFindLine);
    case kPutDown:
      return good ? enter(kTurn) : set_back(kFindLine);
    case kTurn:
      return enter(kLook);
    case kTurnBack:
      return enter(kFindLine);
    default:
      return enter(stage_);  // a look round has ended: look in another direction
  }
}

void Retrieval::follow_senses() {
  const bool line = lines_ >= kSure && now_s_ - line_end_s_ > kAfterEnd_s;
  const bool object = objects_ >= kSure;
  const bool zone = zones_ >= kSure;
  const auto off_rad = off_line_rad();
  const bool right_way = !off_rad || std::abs(*off_rad) < kAligned_rad;
  switch (stage_) {
    case kLook:
      if (object) return enter(kTrack);
      if (line && may_follow()) return enter(kFollow);  // otherwise the robot turns to the wanted direction
      break;
    case kFollow:
      if (object) return enter(kTrack);
      break;
    case kFindLine:
      if (zone) return enter(kPutDown);
      if (line) return right_way ? enter(kCarry) : set_back(kTurnBack);
      break;
    case kCarry:
      if (zone) return enter(kPutDown);
      break;
    case kTurn:
    case kTurnBack:
      if (zone && loaded()) return enter(kPutDown);
      if (line && may_follow()) return enter(loaded() ? kCarry : kFollow);
      if (has_turned()) return enter(loaded() ? kFindLine : kLook);
      break;
    default:
      break;
  }
  // Navigation measures whether the body holds an object. If the stage of this planner disagrees, navigation is right.
  const bool may_differ = stage_ == kHold || stage_ == kPutDown;
  if (may_differ || status_.goal != goal_ || status_.carrying == loaded()) differs_since_s_ = now_s_;
  if (now_s_ - differs_since_s_ > 2.0) set_back(status_.carrying ? kFindLine : kSearch);
}

void Retrieval::follow_time() {
  const double asked_for_s = now_s_ - asked_s_;
  if (status_.goal != goal_ && asked_for_s > 2.0) return set_back(stage_);  // the order was refused or lost: repeat it
  const double slow = loaded() ? 4.0 : 1.0;
  const double in_stage_s = now_s_ - since_s_;
  switch (stage_) {
    case kLook:
    case kFindLine: {
      const double limit_s = looking_ == kExplore ? 8.0 : looking_ == kRotate ? 10.0 : 30.0;
      if (asked_for_s > slow * limit_s || (by_memory_ && looking_ == kRotate && has_turned())) enter(stage_);
      return;
    }
    case kTurn:
    case kTurnBack:
      if (in_stage_s > slow * 20.0) enter(loaded() ? kFindLine : kLook);
      return;
    case kFollow:
      if (in_stage_s > 120.0) set_back(kLook);
      return;
    case kCarry:
      if (in_stage_s > 480.0) set_back(kFindLine);
      return;
    case kTrack:
    case kSearch:  // the look round begins where the object was last seen
      if (in_stage_s > 60.0) set_back(stage_ == kTrack ? kSearch : kLook);
      return;
    default:
      if (in_stage_s > 240.0) set_back(loaded() ? kFindLine : kSearch);
      return;
  }
}

Order Retrieval::order_of_stage() {
  Order order;
  order.goal = ++goal_;
  switch (stage_) {
    case kFollow:
    case kCarry:
      order.task = kFollowLine;
      order.line_colour = line_colour_;
      break;
    case kSearch:
    case kTrack:
    case kPre:
    case kHold:
      order.task = stage_ == kSearch  ? kSearchObject
                   : stage_ == kTrack ? kTrackObject
                   : stage_ == kPre   ? kPregrasp
                                      : kGrasp;
      order.object_colour = colour();
      break;
    case kPutDown:
      order.task = kDrop;
      order.zone_colour = colour();
      break;
    case kTurn:
    case kTurnBack:
      order.task = kRotate;
      order.line_colour = line_colour_;
      turning_left_ = to_turn_rad().value_or(1.0) >= 0;
      order.direction = turning_left_ ? kLeft : kRight;
      order.timeout_s = loaded() ? 80.0 : 20.0;
      break;
    case kLook:
    case kFindLine:
      look_round(order);
      break;
  }
  return order;
}

// The robot turns to the remembered place of the object or zone; two of eight orders instead follow waypoints back to
// the line. If no place is remembered, it looks forwards, left, right and backwards in turn.
void Retrieval::look_round(Order& order) {
  order.line_colour = line_colour_;
  const unsigned look = looks_++ % 8;
  by_memory_ = false;
  order.path = look == 3 || look == 6 ? way_back() : std::vector<std::pair<double, double>>{};
  if (order.path.size() >= 2) {
    order.task = looking_ = kFollowPath;
    return;
  }
  const auto turn_rad = to_turn_rad();
  by_memory_ = turn_rad && look != 7;
  const double wanted_rad = by_memory_ ? *turn_rad : look % 2 == 0 ? 0.0 : look % 4 == 1 ? 2.0 : -2.0;
  const bool on_the_spot = std::abs(wanted_rad) > 0.7;  // for larger angles a turn on the spot is quicker
  turning_left_ = wanted_rad > 0;
  const Direction side = turning_left_ ? kLeft : kRight;
  order.task = looking_ = on_the_spot ? kRotate : kExplore;
  order.direction = on_the_spot || std::abs(wanted_rad) > 0.25 ? side
                    : look == 6 && !by_memory_                 ? kBackwards
                                                               : kForwards;
  if (on_the_spot) order.timeout_s = loaded() ? 40.0 : 10.0;
}

}  // namespace retrieval
