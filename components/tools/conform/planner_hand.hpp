// Plays the surroundings of a planner: what the robot sees, and an input layer and a navigation that take its requests.
// A straight line lies along x of the map; the robot moves as the running task demands.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "conform/part_port.hpp"

namespace constrictor::conform {

class PlannerHand {
 public:
  /// Goal ids of the built-in planner on task/event and task/status: its own number plus this.
  static constexpr std::uint64_t kGoalBase = std::uint64_t{msg::kAuthorityPlanner} << 48;

  explicit PlannerHand(PartPort& port);

  /// Goes on for `seconds`. `until`: ends earlier when it returns true. Returns whether it did.
  bool run(double seconds, const std::function<bool()>& until = {});

  // The content of the percepts from now on.
  void see_line(bool visible) { sees_line_ = visible; }
  void see(std::uint8_t colour, std::uint8_t kind, double range_m);
  void see_no_objects() { objects_.blob_count = 0; }
  /// The map knows the zone of this colour, straight ahead. Returns its index in the map.
  std::size_t map_zone(std::uint8_t colour, double ahead_m);
  /// The map shows an object in the middle of the zone of its colour.
  void map_on_zone(std::uint8_t colour);

  /// An event of the running goal, or of a goal with another number.
  void report(std::uint8_t event, std::uint8_t goal_state = msg::kGoalRunning, std::uint16_t handle = 0,
              std::int64_t other_goal = 0);
  void carry(bool carrying) { status_.carrying = carrying; }
  void give_authority(std::uint8_t level, bool emergency_stop = false);

  enum class Answer { kTake, kRefuse, kIgnore };
  Answer answer = Answer::kTake;  ///< to requests; after one that was refused, the next ones are taken
  bool moves = true;              ///< the robot moves as the running task demands

  /// All requests of this epoch, and the newest start.
  [[nodiscard]] const std::vector<msg::Request>& requests() const { return requests_; }
  [[nodiscard]] const msg::Request* newest() const { return newest_ ? &*newest_ : nullptr; }
  [[nodiscard]] const std::vector<std::int64_t>& request_ticks() const { return request_ticks_; }
  [[nodiscard]] const std::vector<msg::MissionStatus>& missions() const { return missions_; }
  [[nodiscard]] std::size_t ticks() const { return ticks_; }

 private:
  void tick();
  void take(const msg::Request& request);
  void move();
  PartPort& port_;
  bool sees_line_ = false;
  msg::ObjectPercepts objects_{};
  msg::RobotPose pose_{};
  msg::FieldMap map_{};
  msg::TaskStatus status_{};
  msg::Authority authority_{};
  std::vector<msg::TaskEvent> events_;  ///< of the next tick
  std::vector<msg::Request> requests_;
  std::vector<std::int64_t> request_ticks_;
  std::optional<msg::Request> newest_;
  std::vector<msg::MissionStatus> missions_;
  std::size_t ticks_ = 0;
};

}  // namespace constrictor::conform
