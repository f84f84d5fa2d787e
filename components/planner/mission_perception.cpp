// How the mission planner uses percepts, pose and map, and which tasks it requests.
#include <algorithm>
#include <cmath>
#include <limits>

#include "planner/free_way.hpp"
#include "planner/mission_planner.hpp"
#include "robot/landmarks.hpp"
#include "robot/planar.hpp"

namespace constrictor {
namespace {

using enum MissionState;

/// The nearest blob for which `accept` is true.
template <class Accept>
const msg::Blob* nearest(const msg::ObjectPercepts& percepts, Accept accept) {
  const msg::Blob* best = nullptr;
  for (std::size_t i = 0; i < std::min<std::size_t>(percepts.blob_count, msg::kMaxBlobs); ++i) {
    const auto& blob = percepts.blobs[i];
    if (!std::isfinite(blob.range_m) || !std::isfinite(blob.bearing_rad) || !accept(blob)) continue;
    if (!best || blob.range_m < best->range_m) best = &blob;
  }
  return best;
}

/// [m] in M: the point of the ground that lies `beyond_m` behind the near edge of a blob.
Eigen::Vector2d place_of(const msg::Blob& blob, const msg::RobotPose& pose, double beyond_m = 0.0) {
  return Eigen::Vector2d(pose.x_m, pose.y_m) + (blob.range_m + beyond_m) * along(pose.yaw_rad + blob.bearing_rad);
}

void count(std::uint16_t& images, bool seen) {
  images = seen ? static_cast<std::uint16_t>(std::min(images + 1, 1000)) : std::uint16_t{0};
}

}  // namespace

void MissionPlanner::count_percepts(const PlannerInputs& inputs) {
  if (!inputs.new_percepts || !inputs.line || !inputs.objects) return;
  const std::uint8_t wanted = colour();
  const auto* object = nearest(*inputs.objects, [&](const msg::Blob& blob) {
    return wanted != msg::kColourUnknown && blob.colour == wanted && blob.kind == msg::kBlobObject &&
           blob.object_probability >= config_.object_probability && !is_delivered(blob, inputs);
  });
  const auto* zone = nearest(*inputs.objects, [&](const msg::Blob& blob) {
    return blob.colour == wanted && blob.kind == msg::kBlobZone && is_zone(blob, inputs);
  });
  const auto* any_zone = nearest(*inputs.objects, [](const msg::Blob& blob) { return blob.kind == msg::kBlobZone; });
  count(memory_.object_images, object && object->range_m <= config_.object_range_m);
  count(memory_.zone_images, zone && zone->range_m <= config_.zone_range_m);
  if (holding() && memory_.zone_images >= config_.confirm_images) note_zone(*zone, inputs);
  count(memory_.line_images, inputs.line->visible && inputs.line->colour == config_.line_colour);
  if (any_zone && any_zone->range_m < config_.end_zone_m) memory_.zone_seen_s = memory_.active_s;
  if (inputs.pose && outbound() && inputs.line->colour == config_.line_colour)
    memory_.trail.note_beyond(*inputs.line, *inputs.pose);
  // At the beginning of a state the head may still point to the side.
  const bool follows = memory_.state == kFollowLine || memory_.state == kTransport;
  if (follows && !memory_.wrong_way && inputs.pose && memory_.line_images >= config_.confirm_images &&
      memory_.active_s - memory_.entered_s > 1.0) {
    memory_.trail.record(*inputs.line, *inputs.pose, outbound());
  }
}

// An object that lies on its side may look like a zone. The range of a blob leads to its near edge.
bool MissionPlanner::is_zone(const msg::Blob& blob, const PlannerInputs& inputs) const {
  constexpr double kAnother_m = 1.0;
  const msg::MapObject* zone = inputs.map && inputs.pose ? zone_of(*inputs.map, blob.colour) : nullptr;
  if (!zone) return true;
  const double sd_m = std::sqrt(std::max(inputs.pose->covariance[0], inputs.pose->covariance[4]));
  const Eigen::Vector2d place = place_of(blob, *inputs.pose);
  return std::hypot(zone->x_m - place.x(), zone->y_m - place.y()) < kAnother_m + 3.0 * sd_m;
}

bool MissionPlanner::zone_found(const PlannerInputs& inputs) const {
  return memory_.zone_images >= config_.confirm_images && (!inputs.map || zone_of(*inputs.map, colour()));
}

// An object that stands on the zone of its colour, after one of this colour was dropped there, is not fetched again.
bool MissionPlanner::is_delivered(const msg::Blob& blob, const PlannerInputs& inputs) const {
  if (!inputs.pose) return false;
  const Eigen::Vector2d place = place_of(blob, *inputs.pose);
  return is_delivered(blob.colour, place.x(), place.y(), inputs);
}

bool MissionPlanner::is_delivered(std::uint8_t colour, double x_m, double y_m, const PlannerInputs& inputs) const {
  bool any = false;
  for (std::size_t i = 0; i < config_.sequence.size(); ++i) any = any || (config_.sequence[i] == colour && done(i));
  if (!any || !inputs.map) return false;
  const auto* zone = zone_of(*inputs.map, colour);
  if (!zone) return false;
  // If one of this colour was pushed off its zone, the border of the zone tells it from those that stand there.
  double reach_m = config_.on_zone_m;
  for (std::size_t i = 0; i < config_.sequence.size(); ++i) {
    if (config_.sequence[i] != colour || (memory_.displaced >> i & 1u) == 0) continue;
    reach_m = std::min(reach_m, radius_or(*zone, config_.zone_radius_m));
  }
  return std::hypot(zone->x_m - x_m, zone->y_m - y_m) < reach_m;
}

bool MissionPlanner::is_placed(const msg::MapObject& landmark, const PlannerInputs& inputs) const {
  const bool placed = std::any_of(memory_.placed.begin(), memory_.placed.end(),
                                  [&](const PlacedObject& object) { return object.handle == landmark.handle; });
  return placed || is_delivered(landmark.colour, landmark.x_m, landmark.y_m, inputs);
}

// A delivered object of the same colour is not the one that is wanted, and would hold the robot at the zones.
const msg::MapObject* MissionPlanner::wanted_landmark(const PlannerInputs& inputs) const {
  if (!inputs.map || !inputs.pose || colour() == msg::kColourUnknown) return nullptr;
  if (holding()) return zone_of(*inputs.map, colour());
  const msg::MapObject* best = nullptr;
  double best_m = std::numeric_limits<double>::infinity();
  for (const msg::MapObject& landmark : landmarks_of(*inputs.map)) {
    if (landmark.kind != msg::kBlobObject || landmark.colour != colour()) continue;
    const double apart_m = std::hypot(landmark.x_m - inputs.pose->x_m, landmark.y_m - inputs.pose->y_m);
    if (apart_m >= best_m || is_placed(landmark, inputs)) continue;
    best = &landmark;
    best_m = apart_m;
  }
  return best;
}

// The map does not take a zone that the border of the image cuts: it does not know where its centre is. The robot then
// turns and drives towards the zone until it is whole in view.
void MissionPlanner::note_zone(const msg::Blob& zone, const PlannerInputs& inputs) {
  if (!inputs.pose) return;
  const Eigen::Vector2d centre = place_of(zone, *inputs.pose, config_.zone_radius_m);
  memory_.zone_glimpse = {zone.colour, centre.x(), centre.y(), memory_.active_s};
}

std::optional<Eigen::Vector2d> MissionPlanner::wanted_place(const PlannerInputs& inputs) const {
  constexpr double kForgotten_s = 40.0;  // what the map still does not have then is no zone
  if (const msg::MapObject* landmark = wanted_landmark(inputs)) return Eigen::Vector2d(landmark->x_m, landmark->y_m);
  const ZoneGlimpse& glimpse = memory_.zone_glimpse;
  const bool wanted = holding() && colour() != msg::kColourUnknown && glimpse.colour == colour();
  if (!wanted || memory_.active_s - glimpse.seen_s > kForgotten_s) return std::nullopt;
  return Eigen::Vector2d(glimpse.x_m, glimpse.y_m);
}

double MissionPlanner::remembered_m(const PlannerInputs& inputs) const {
  const auto place = wanted_place(inputs);
  if (!place || !inputs.pose) return std::numeric_limits<double>::infinity();
  return std::hypot(place->x() - inputs.pose->x_m, place->y() - inputs.pose->y_m);
}

std::optional<double> MissionPlanner::wanted_turn_rad(const PlannerInputs& inputs) const {
  if (!inputs.pose) return std::nullopt;
  const auto& pose = *inputs.pose;
  if (const auto place = searches() ? wanted_place(inputs) : std::nullopt) {
    const double x_m = place->x() - pose.x_m, y_m = place->y() - pose.y_m;
    const double distance_m = std::hypot(x_m, y_m);
    if (distance_m > 0.3 && (distance_m < config_.remembered_range_m || sweeps() || memory_.trail.empty()))
      return wrap_angle(std::atan2(y_m, x_m) - course_rad(pose));
  }
  if (sweeps() && memory_.sweep.leads()) return wrap_angle(memory_.sweep.direction_rad(pose) - course_rad(pose));
  const auto heading_rad = memory_.trail.heading_rad(pose, outbound(), [&](double x_m, double y_m) {
    const double room_m = holding() ? config_.carry_room_m : config_.room_m;
    return !inputs.map || is_free_way(*inputs.map, {pose.x_m, pose.y_m}, {x_m, y_m}, room_m);
  });
  if (!heading_rad) return std::nullopt;
  return wrap_angle(*heading_rad - course_rad(pose));
}

bool MissionPlanner::leads_wanted_way(const PlannerInputs& inputs) const {
  if (!inputs.pose) return true;
  if (leads_to_new_ground(inputs)) return true;
  const auto direction_rad = memory_.trail.direction_rad(*inputs.pose, outbound());
  return !direction_rad || std::abs(wrap_angle(*direction_rad - course_rad(*inputs.pose))) < config_.aligned_rad;
}

bool MissionPlanner::leads_to_new_ground(const PlannerInputs& inputs) const {
  return outbound() && inputs.line && inputs.pose && memory_.trail.leads_to_new_ground(*inputs.line, *inputs.pose);
}

bool MissionPlanner::has_turned(const PlannerInputs& inputs) const {
  const auto turn_rad = wanted_turn_rad(inputs);
  if (!turn_rad) return false;
  const bool past = memory_.direction == msg::kDirectionLeft ? *turn_rad < 0.0 : *turn_rad > 0.0;
  return std::abs(*turn_rad) < 0.2 || (past && std::abs(*turn_rad) < config_.aligned_rad);
}

// A body without an object curls up while it turns on the spot: its course lags behind the head.
bool MissionPlanner::may_follow(const PlannerInputs& inputs) const {
  if (!leads_wanted_way(inputs)) return false;
  if (leads_to_new_ground(inputs)) return true;
  const bool curled = !holding() && inputs.pose &&
                      std::abs(wrap_angle(inputs.pose->yaw_rad - inputs.pose->body_yaw_rad)) > config_.straight_rad;
  return !curled;
}

WantedTask MissionPlanner::task_of_state(const PlannerInputs& inputs) {
  constexpr std::uint8_t kVainLooks = 2;
  WantedTask wanted;
  wanted.goal_id = ++memory_.goals;
  wanted.task = row_of(memory_.state).task;
  if (memory_.state == kInspect && memory_.vain_looks >= kVainLooks) {
    // The object is in view and the map does not get its place: it is so near that the image cuts it. Step back.
    memory_.vain_looks = 0;
    memory_.steps_back = true;
    ++memory_.step_backs;
    wanted.task = msg::kTaskExplore;
    wanted.parameters.timeout_s = std::numeric_limits<double>::quiet_NaN();
    wanted.parameters.direction = msg::kDirectionBackwards;
    return wanted;
  }
  auto& parameters = wanted.parameters;
  parameters.timeout_s = std::numeric_limits<double>::quiet_NaN();
  switch (wanted.task) {
    case msg::kTaskFollowLine:
      parameters.line_colour = config_.line_colour;
      break;
    case msg::kTaskDrop:
      parameters.drop_zone_colour = colour();
      parameters.timeout_s = config_.drop_timeout_s;
      break;
    case msg::kTaskRotate: {
      parameters.line_colour = config_.line_colour;
      memory_.direction = side_for(wanted_turn_rad(inputs).value_or(1.0), inputs);
      parameters.direction = memory_.direction;
      parameters.timeout_s = longest_turn_s();
      break;
    }
    case msg::kTaskNone:
      choose_search(inputs, wanted);
      break;
    case msg::kTaskExplore:  // of kApproachAnew; each time to another side
      parameters.direction = next_departure(attempts());
      break;
    default:
      if (wanted.task == msg::kTaskPregrasp) {
        const Way way = next_way(attempts());
        parameters.direction = way.direction;
        parameters.clearance_m = way.clearance_m;
      }
      if (wanted.task == msg::kTaskGrasp) parameters.wrap_scale = next_way(attempts()).wrap_scale;
      parameters.object_colour = colour();
      parameters.object_handle = memory_.object_handle;
      if (memory_.state == kInspect && inspects_by_handle(inputs)) parameters.object_handle = memory_.dropped_handle;
      if (memory_.state == kSearchObject && has_delivered_twin()) {
        // Of two objects of one colour side by side, the search sees only the nearer one: it may be either.
        const msg::MapObject* landmark = wanted_landmark(inputs);
        const msg::MapObject* zone = landmark ? zone_of(*inputs.map, landmark->colour) : nullptr;
        const bool alone =
            zone && std::hypot(zone->x_m - landmark->x_m, zone->y_m - landmark->y_m) > 2.0 * config_.on_zone_m;
        if (alone && !refusals().rejected()) parameters.object_handle = landmark->handle;
      }
      break;
  }
  return wanted;
}

}  // namespace constrictor
