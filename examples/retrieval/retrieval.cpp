#include "retrieval.hpp"

#include <algorithm>
#include <cmath>

namespace retrieval {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr int kSure = 3;               // images in a row until something counts as seen
constexpr double kObjectNear_m = 1.6;  // an object this near is worth an approach
constexpr double kZoneNear_m = 1.7;    // a zone this near is where to put down
constexpr double kAligned_rad = 1.0;   // the course is the wanted way
constexpr double kStraight_rad = 0.6;  // of head against body: beyond it an empty body is too curled up from turning to follow a line
constexpr double kAfterEnd_s = 8.0;    // just after the line's end only its stump can be in view

double wrapped(double angle_rad) { return std::remainder(angle_rad, 2 * kPi); }

}  // namespace

std::string Retrieval::stage() const {
  static const char* const names[] = {"look",         "follow", "search object", "track", "pregrasp", "grasp",
                                      "find the line", "carry",  "drop",          "turn",  "turn back"};
  return names[stage_];
}

void Retrieval::see(const Line& line) {
  line_ = line;
  lines_ = line.visible ? lines_ + 1 : 0;
  const bool follows = doing_.task == kFollowLine && doing_.state == kRunning;
  if (!follows || lines_ < kSure || !std::isfinite(line.offset_m) || !std::isfinite(line.heading_rad)) return;
  const double c = std::cos(pose_.yaw_rad);
  const double s = std::sin(pose_.yaw_rad);
  const double x_m = pose_.x_m + c * line.lookahead_m - s * line.offset_m;
  const double y_m = pose_.y_m + s * line.lookahead_m + c * line.offset_m;
  const Crumb* known = nearest_crumb(x_m, y_m);
  if (known && std::hypot(known->x_m - x_m, known->y_m - y_m) < 0.3) return;
  trail_.push_back({x_m, y_m, wrapped(pose_.yaw_rad + line.heading_rad + (doing_.carrying ? kPi : 0.0))});
}

void Retrieval::see(const std::vector<Thing>& things) {
  bool object = false;
  bool zone = false;
  for (const Thing& thing : things) {
    if (!std::isfinite(thing.range_m) || !std::isfinite(thing.bearing_rad)) continue;
    const double heading_rad = pose_.yaw_rad + thing.bearing_rad;
    const double x_m = pose_.x_m + thing.range_m * std::cos(heading_rad);
    const double y_m = pose_.y_m + thing.range_m * std::sin(heading_rad);
    // What lies on the zone of its colour is delivered, or is that zone seen askew.
    const auto zone_place = places_.find({thing.colour, true});
    if (!thing.zone && zone_place != places_.end() && std::hypot(zone_place->second.first - x_m, zone_place->second.second - y_m) < 0.7) continue;
    places_[{thing.colour, thing.zone}] = {x_m, y_m};
    if (thing.colour != colour()) continue;
    object = object || (!thing.zone && thing.range_m < kObjectNear_m);
    zone = zone || (thing.zone && thing.range_m < kZoneNear_m);
  }
  objects_ = object ? objects_ + 1 : 0;
  zones_ = zone ? zones_ + 1 : 0;
}

void Retrieval::hear(const Happening& happening) {
  if (happening.event == kObjectGrasped) held_ = happening.colour;
  if (happening.event == kObjectGraspLost) held_ = 0;
  if (happening.event == kDroppingDone) {
    // The event's colour is the zone's; whoever dropped it, it is delivered.
    remaining_.erase(std::remove(remaining_.begin(), remaining_.end(), happening.colour), remaining_.end());
    held_ = 0;
  }
  heard_.push_back(happening);
}

void Retrieval::take_over(double time_s) {
  now_s_ = time_s;
  in_command_ = true;
  heard_.clear();
  const auto held = std::find(remaining_.begin(), remaining_.end(), held_);
  if (doing_.carrying && held != remaining_.end()) std::rotate(remaining_.begin(), held, held + 1);
  enter(doing_.carrying ? kFindLine : kLook);
}

void Retrieval::enter(Stage stage) {
  if (stage != stage_) {
    since_s_ = now_s_;
    lines_ = objects_ = zones_ = 0;
  }
  stage_ = stage;
  asked_ = false;
  unlike_since_s_ = now_s_;
}

void Retrieval::set_back(Stage stage) {
  ++setbacks_;
  since_s_ = now_s_;
  enter(stage);
}

std::optional<Order> Retrieval::decide(double time_s) {
  now_s_ = time_s;
  if (!in_command_) {
    heard_.clear();
    return std::nullopt;
  }
  if (asked_) follow_goal();
  if (asked_) follow_senses();
  if (asked_) follow_time();
  heard_.clear();
  if (asked_ || done()) return std::nullopt;
  asked_ = true;
  asked_s_ = now_s_;
  return order_of_stage();
}

void Retrieval::follow_goal() {
  std::uint8_t state = doing_.goal == goal_ ? doing_.state : std::uint8_t{kRunning};
  for (const Happening& happening : heard_) {
    if (happening.event == kObjectGraspLost && loaded()) return set_back(kSearch);
    if (happening.goal != goal_) continue;
    if (happening.state != 0) state = happening.state;
    if (happening.event == kEndOfLine) line_end_s_ = now_s_;
    if (happening.event == kDroppingDone) return enter(kTurn);
  }
  if (state == kRunning || state == 0) return;
  const bool good = state == kSucceeded;
  switch (stage_) {
    case kFollow: return good ? enter(kSearch) : set_back(kLook);
    case kSearch: return good ? enter(kTrack) : set_back(kLook);
    case kTrack: return good ? enter(kPre) : set_back(kSearch);
    case kPre: return good ? enter(kHold) : set_back(kSearch);
    case kHold: return good ? enter(kFindLine) : set_back(kSearch);
    case kCarry: return set_back(kFindLine);
    case kPutDown: return good ? enter(kTurn) : set_back(kFindLine);
    case kTurn: return enter(kLook);
    case kTurnBack: return enter(kFindLine);
    default: return enter(stage_);  // a look round has ended: look elsewhere
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
      if (line && may_follow()) return enter(kFollow);  // else the look round turns towards the wanted way
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
    default: break;
  }
  // Navigation knows best whether something is held.
  const bool may_differ = stage_ == kHold || stage_ == kPutDown;
  if (may_differ || doing_.goal != goal_ || doing_.carrying == loaded()) unlike_since_s_ = now_s_;
  if (now_s_ - unlike_since_s_ > 2.0) set_back(doing_.carrying ? kFindLine : kSearch);
}

void Retrieval::follow_time() {
  const double asked_for_s = now_s_ - asked_s_;
  if (doing_.goal != goal_ && asked_for_s > 2.0) return set_back(stage_);  // refused, or lost on the way: ask again
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
    case kFollow: if (in_stage_s > 120.0) set_back(kLook); return;
    case kCarry: if (in_stage_s > 480.0) set_back(kFindLine); return;
    case kTrack: if (in_stage_s > 60.0) set_back(kSearch); return;
    case kSearch: if (in_stage_s > 60.0) set_back(kLook); return;  // look where it was seen last
    default: if (in_stage_s > 240.0) set_back(loaded() ? kFindLine : kSearch); return;
  }
}

const Retrieval::Crumb* Retrieval::nearest_crumb(double x_m, double y_m) const {
  const auto distance = [&](const Crumb& crumb) { return std::hypot(crumb.x_m - x_m, crumb.y_m - y_m); };
  const auto best = std::min_element(trail_.begin(), trail_.end(), [&](const Crumb& a, const Crumb& b) { return distance(a) < distance(b); });
  return best == trail_.end() ? nullptr : &*best;
}

std::optional<double> Retrieval::off_line_rad() const {
  const Crumb* crumb = nearest_crumb(pose_.x_m, pose_.y_m);
  if (!crumb) return std::nullopt;
  return wrapped(crumb->outbound_rad + (loaded() ? kPi : 0.0) - course_rad());
}

bool Retrieval::may_follow() const {
  const auto off_rad = off_line_rad();
  const bool curled = !loaded() && std::abs(wrapped(pose_.yaw_rad - pose_.body_yaw_rad)) > kStraight_rad;
  return !curled && (!off_rad || std::abs(*off_rad) < kAligned_rad);
}

std::optional<double> Retrieval::to_turn_rad() const {
  const auto towards = [&](double x_m, double y_m) { return wrapped(std::atan2(y_m - pose_.y_m, x_m - pose_.x_m) - course_rad()); };
  const auto distance_m = [&](double x_m, double y_m) { return std::hypot(x_m - pose_.x_m, y_m - pose_.y_m); };
  const bool looks = stage_ == kLook || stage_ == kFindLine;
  const auto place = places_.find({colour(), loaded()});
  if (looks && place != places_.end()) {
    const auto [x_m, y_m] = place->second;
    if (distance_m(x_m, y_m) > 0.3 && distance_m(x_m, y_m) < 2.5) return towards(x_m, y_m);
  }
  const Crumb* crumb = nearest_crumb(pose_.x_m, pose_.y_m);
  if (!crumb || distance_m(crumb->x_m, crumb->y_m) < 0.5) return off_line_rad();
  const double ahead_m = loaded() ? -0.6 : 0.6;  // beside the line: to where it is joined best
  return towards(crumb->x_m + ahead_m * std::cos(crumb->outbound_rad), crumb->y_m + ahead_m * std::sin(crumb->outbound_rad));
}

bool Retrieval::has_turned() const {
  const auto turn_rad = to_turn_rad();
  if (!turn_rad) return false;
  const bool past = turning_left_ ? *turn_rad < 0 : *turn_rad > 0;
  return std::abs(*turn_rad) < 0.2 || (past && std::abs(*turn_rad) < kAligned_rad);
}

Order Retrieval::order_of_stage() {
  Order order;
  order.goal = ++goal_;
  switch (stage_) {
    case kFollow:
    case kCarry: order.task = kFollowLine; order.line_colour = line_colour_; break;
    case kSearch: order.task = kSearchObject; order.object_colour = colour(); break;
    case kTrack: order.task = kTrackObject; order.object_colour = colour(); break;
    case kPre: order.task = kPregrasp; order.object_colour = colour(); break;
    case kHold: order.task = kGrasp; order.object_colour = colour(); break;
    case kPutDown: order.task = kDrop; order.zone_colour = colour(); break;
    case kTurn:
    case kTurnBack:
      order.task = kRotate;
      order.line_colour = line_colour_;
      turning_left_ = to_turn_rad().value_or(1.0) >= 0;
      order.direction = turning_left_ ? kLeft : kRight;
      order.timeout_s = loaded() ? 80.0 : 20.0;
      break;
    case kLook:
    case kFindLine: look_round(order); break;
  }
  return order;
}

// Towards what is remembered; now and then back to the line by waypoints; without a memory forwards, left, right and back in turn.
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
  const bool on_the_spot = std::abs(wanted_rad) > 0.7;  // beyond that a turn on the spot is the shorter way
  turning_left_ = wanted_rad > 0;
  const Direction side = turning_left_ ? kLeft : kRight;
  order.task = looking_ = on_the_spot ? kRotate : kExplore;
  order.direction = on_the_spot || std::abs(wanted_rad) > 0.25 ? side : look == 6 && !by_memory_ ? kBackwards : kForwards;
  if (on_the_spot) order.timeout_s = loaded() ? 40.0 : 10.0;
}

std::vector<std::pair<double, double>> Retrieval::way_back() const {
  const Crumb* crumb = nearest_crumb(pose_.x_m, pose_.y_m);
  std::vector<std::pair<double, double>> path;
  if (!crumb) return path;
  if (std::hypot(crumb->x_m - pose_.x_m, crumb->y_m - pose_.y_m) > 0.2) path.emplace_back(pose_.x_m, pose_.y_m);
  const int step = loaded() ? -1 : 1;
  const int last = loaded() ? -1 : static_cast<int>(trail_.size());
  for (int i = static_cast<int>(crumb - trail_.data()); i != last && path.size() < 64; i += step) {
    path.emplace_back(trail_[static_cast<std::size_t>(i)].x_m, trail_[static_cast<std::size_t>(i)].y_m);
  }
  return path;
}

}  // namespace retrieval
