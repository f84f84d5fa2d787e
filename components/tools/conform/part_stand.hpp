// The surroundings of a part that is checked: components that write the messages that the checks give them. They take
// the places of all members that write what the part reads.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "component/component.hpp"
#include "conform/part_port.hpp"

namespace constrictor::conform {

/// Connects the surroundings with the checks. The leader is the component that exchanges messages with the checks: the
/// plant of the run, or the only component of the surroundings.
class StandBoard {
 public:
  virtual ~StandBoard() = default;
  /// The leader, before anything is written in a tick. An implementation may wait here for the checks.
  virtual void begin_tick(const Tick& tick) = 0;
  /// The messages to write on a topic in this tick, oldest first. Each message is returned once.
  virtual std::vector<Sample> take(std::size_t topic) = 0;
  /// The leader: what became visible in this tick.
  virtual void deliver(const Tick& tick, std::vector<Letter> arrived) = 0;
  /// The checks have ended: the run must end, too.
  [[nodiscard]] virtual bool finished() const = 0;
};

/// A part as a member of a run, and its surroundings.
struct PartPlace {
  std::string part;                        ///< name in the roster
  std::vector<const TopicInfo*> writes;    ///< topics that the surroundings write
  std::vector<const TopicInfo*> observes;  ///< topics that the checks read
  /// False: the run keeps the plant of the manifest, and the surroundings are one component of this run.
  bool own_plant = true;
};
/// Throws std::invalid_argument if there is no such part.
[[nodiscard]] const PartPlace& part_place(const std::string& part);

/// Name of the plant of the surroundings.
inline constexpr const char* kStandPlant = "surroundings";

/// The components of the surroundings, the leader first. `board` must outlive them.
[[nodiscard]] std::vector<ComponentFactory> stand_factories(const PartPlace& place, StandBoard& board);

}  // namespace constrictor::conform
