// Command authority: who may say what the robot does, decided request by request. Pure.
#pragma once

#include <cereal/types/map.hpp>
#include <cereal/types/string.hpp>
#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "constrictor/messages.hpp"

namespace constrictor {

/// Everything the arbiter remembers.
struct ArbiterState {
  struct Source {
    std::uint64_t sequence = 0;  ///< newest sequence number obeyed or refused
    std::uint32_t index = 0;     ///< order of first appearance
    template <class Archive>
    void serialize(Archive& archive) {
      archive(sequence, index);
    }
  };
  std::uint8_t level = msg::kAuthorityNone;
  std::string holder;            ///< source that holds authority
  bool stopped = false;          ///< latched emergency stop
  std::string stopper;
  std::map<std::string, Source> sources;
  std::uint64_t refused = 0;
  std::string refusal;           ///< why the last refused request was refused

  template <class Archive>
  void serialize(Archive& archive) {
    archive(level, holder, stopped, stopper, sources, refused, refusal);
  }
};

/// What a request leads to.
struct Ruling {
  enum Kind { kRefused, kForward, kCancelAll, kNothing };
  Kind kind = kNothing;          ///< kForward: pass the task on; kCancelAll: whatever runs must end
};

/// Emergency stop over operator over external planner over built-in planner. A task request of a source of higher level than
/// the holder's takes authority; one of the same or a lower level is refused until the holder releases it or dies.
class Arbiter {
 public:
  explicit Arbiter(ArbiterState& state) : state_(state) {}

  /// Rules on one request; `name` and bounds were validated by the runtime before.
  Ruling decide(const msg::Request& request);
  /// The holder's process is gone: authority falls back to nobody and the robot holds its posture.
  Ruling on_death(const std::string& source);

  /// The goal's id in task/command: (level << 48) + (index of the source << 32) + low 32 bits of the source's own id.
  [[nodiscard]] std::uint64_t goal_id(const msg::Request& request) const;

 private:
  Ruling refuse(const std::string& reason);
  void take(const msg::Request& request);
  ArbiterState& state_;
};

}  // namespace constrictor
