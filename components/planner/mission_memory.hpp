// What the mission planner remembers from step to step. Plain data, serialisable.
#pragma once

#include <cereal/types/string.hpp>
#include <cereal/types/vector.hpp>
#include <cstdint>
#include <string>
#include <vector>

#include "constrictor/messages.hpp"
#include "planner/attempts.hpp"
#include "planner/line_trail.hpp"
#include "planner/mission_state.hpp"
#include "planner/refusals.hpp"
#include "planner/standstill.hpp"
#include "planner/sweep.hpp"

namespace constrictor {

/// An object that was seen on its zone, or that another source has dropped. The robot may push it off again.
struct PlacedObject {
  std::uint16_t index = 0;          ///< in the sequence
  std::uint16_t handle = 0;         ///< of its landmark; 0: unknown
  std::uint16_t newest_handle = 0;  ///< highest handle of the map when it was delivered
  std::int64_t tick = 0;            ///< at which it was delivered
  double outside_s = 0.0;           ///< time for which the map has shown it outside its zone
  bool touched = false;             ///< the body has touched it since then, and may have pushed it
  bool unseen = false;              ///< another source has dropped it, and the planner has not looked at it yet
  template <class Archive>
  void serialize(Archive& archive) {
    archive(index, handle, newest_handle, tick, outside_s, touched, unseen);
  }
};

using PlacedObjects = std::vector<PlacedObject>;

/// Where images have shown a zone to a robot with an object, until the map has the zone.
struct ZoneGlimpse {
  std::uint8_t colour = msg::kColourUnknown;  ///< kColourUnknown: none was seen
  double x_m = 0.0, y_m = 0.0;                ///< about its centre, in M
  double seen_s = 0.0;                        ///< active time of the newest of these images
  template <class Archive>
  void serialize(Archive& archive) {
    archive(colour, x_m, y_m, seen_s);
  }
};

/// The whole state of the planner.
struct MissionMemory {
  MissionState state = MissionState::kSearchLineOrObject;
  bool requested = false;        ///< the task of the state was requested
  bool direction_known = false;  ///< an object was found, so the directions of the trail are right
  bool suspended = false;        ///< another source has authority, or an emergency stop is latched
  bool stopped = false;          ///< from an emergency stop until an operator or external planner releases authority
  double last_s = 0.0;           ///< time of the previous step
  double active_s = 0.0;         ///< mission time, without suspensions
  double entered_s = 0.0;        ///< active time at which the state began
  double requested_s = 0.0;      ///< active time of the request
  double contradiction_s = 0.0;  ///< time for which navigation's report about a held object has contradicted the state
  double line_ended_s = -1e9;    ///< active time of the last end of the line
  double turned_back_s = -1e9;   ///< active time at which turning back to the line last ended without success
  std::uint8_t vain_turns = 0;   ///< how often turning back with the present object has ended without success
  double zone_seen_s = -1e9;     ///< active time at which a zone of any colour was last seen
  std::uint64_t goals = 0;       ///< number of requests so far
  std::uint16_t object_index = 0;    ///< the first object of the sequence that is neither delivered nor put aside
  std::uint32_t delivered = 0;       ///< bit i: object i of the sequence was seen on its zone, or is still `unseen`
  std::uint32_t aside = 0;           ///< bit i: object i was put aside after too many failures
  bool second_pass = false;          ///< the objects that were put aside are tried once more
  std::vector<Attempts> attempts;    ///< by place in the sequence; later entries are missing until they are needed
  bool dropped = false;              ///< the planner's drop is done, and its result is not yet decided
  std::uint16_t dropped_handle = 0;  ///< of the dropped object; 0: unknown
  std::uint16_t newest_handle = 0;   ///< highest handle of the map at the release
  std::uint16_t newest_carried =
      0;                            ///< the same at the last tick in which the body held any object, whoever steered it
  PlacedObjects placed;             ///< the delivered objects
  std::uint32_t rechecked = 0;      ///< bit i: the robot has looked at object i again since the newest drop
  std::uint32_t displaced = 0;      ///< bit i: object i was delivered, and was then pushed off its zone
  std::int64_t released_tick = -1;  ///< last tick in which the body held or left the object last dropped; -1: none
  std::uint16_t recoveries = 0;
  std::uint16_t object_handle = 0;  ///< handle of the object that was reached or pregrasped; 0: unknown
  std::uint16_t object_images = 0;  ///< consecutive images with the wanted object
  std::uint16_t zone_images = 0;
  ZoneGlimpse zone_glimpse;
  std::uint16_t line_images = 0;
  std::uint16_t searches = 0;                    ///< requests of the present search so far; selects the next move
  double searched_s = 0.0;                       ///< time of the newest one
  std::uint8_t search_task = msg::kTaskNone;     ///< task of the present search: explore or rotate
  Standstill standstill;                         ///< of a search or transport with an object
  Sweep sweep;                                   ///< of a search with an object that nothing remembered leads
  std::uint8_t vain_looks = 0;                   ///< looks at the dropped object after which the map did not have it
  bool steps_back = false;                       ///< the robot moves away from the dropped object to see it
  std::uint8_t step_backs = 0;                   ///< how often it has done so in this look
  std::uint8_t backed_off = 0;                   ///< moves of this search that backed off from obstacles
  bool wrong_way = false;                        ///< the robot follows the line the wrong way, and will turn round
  bool search_by_memory = false;                 ///< its direction comes from the memory of line, object or zone
  std::uint8_t direction = msg::kDirectionNone;  ///< of the last requested rotate or explore
  LineTrail trail;
  std::string reason;                  ///< why the mission failed
  std::string hindrance;               ///< the hindrance of the mission, as a predicate; empty: none
  double suspended_s = 0.0;            ///< duration of the present suspension
  double unseen_s = 0.0;               ///< time without percepts
  bool blind = false;                  ///< the mission waits for percepts
  std::uint64_t refused_sequence = 0;  ///< number of the planner's last request that `input` has refused
  RefusalMemory refusals;

  template <class Archive>
  void serialize(Archive& archive) {
    archive(state, requested, direction_known, suspended, stopped, last_s, active_s, entered_s, requested_s,
            contradiction_s, line_ended_s, zone_seen_s, goals, object_index, delivered, recoveries, object_handle,
            object_images, zone_images, zone_glimpse, line_images, searches, searched_s, search_task, search_by_memory,
            direction, trail, reason, standstill, sweep, vain_looks, steps_back, step_backs, backed_off, aside,
            second_pass, attempts, dropped, dropped_handle, newest_handle, released_tick, placed, displaced, hindrance,
            suspended_s, unseen_s, blind, refused_sequence, refusals, wrong_way, rechecked, turned_back_s,
            newest_carried, vain_turns);
  }
};

}  // namespace constrictor
