// Command authority: who may say what the robot does, decided request by request. Pure.
#pragma once

#include <cereal/types/array.hpp>
#include <cereal/types/map.hpp>
#include <cereal/types/string.hpp>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "constrictor/messages.hpp"
#include "runtime/outside_requests.hpp"

namespace constrictor {

/// Everything the arbiter remembers.
struct ArbiterState {
  struct Source {
    std::uint64_t sequence = 0;   ///< newest sequence number that was ruled on
    std::uint64_t ruled = 0;      ///< bit i: number `sequence` - i was ruled on,
    std::uint64_t granted = 0;    ///< and granted
    WriterId writer{};            ///< through which it spoke last; all zeros: unknown
    std::uint32_t index = 0;      ///< order of first appearance; the built-in planner has 0
    std::uint64_t last_goal = 0;  ///< newest goal it started, by its own count
    bool detached = false;        ///< what it holds outlives its writer
    bool gone = false;            ///< its writer is dead, but it holds authority, detached
    template <class Archive>
    void serialize(Archive& archive) {
      archive(sequence, ruled, granted, writer, index, last_goal, detached, gone);
    }
  };
  std::uint8_t level = msg::kAuthorityNone;
  std::string holder;             ///< source that holds authority
  bool stopped = false;           ///< latched emergency stop
  std::string stopper;
  std::map<std::string, Source> sources;
  std::uint32_t next_index = 1;
  std::uint64_t refused = 0;
  std::string refusal;            ///< why the last refused request was refused
  std::string refused_source;     ///< whose it was
  std::uint64_t refused_sequence = 0;
  std::string ruled_source;       ///< who asked last, whether or not it was granted
  std::uint64_t ruled_sequence = 0;

  template <class Archive>
  void serialize(Archive& archive) {
    archive(level, holder, stopped, stopper, sources, next_index, refused, refusal, refused_source, refused_sequence,
            ruled_source, ruled_sequence);
  }
};

/// What a request leads to.
struct Ruling {
  enum Kind {
    kRefused,
    kForward,    ///< pass the task command on with `goal_id`
    kMove,       ///< pass the direct motion on
    kSet,        ///< a parameter may be changed
    kCancelAll,  ///< whatever runs must end
    kNothing,
    kRepeated,   ///< was ruled on before: nothing happens, and it is answered as it was then
  };
  Kind kind = kNothing;
  std::uint64_t goal_id = 0;  ///< of kForward: as it goes on task/command
  bool granted = false;       ///< of kRepeated: what the answer was
};

/// Emergency stop over operator over external planner over built-in planner. A request for a task, a motion or authority itself by
/// a source of higher level than the holder's takes authority; one of the same or a lower level is refused until the holder
/// releases it or dies. A detached holder does not die; sources of its own level may take over from it, or release for it.
/// A request is ruled on once, however often it is repeated under its number.
/// Parameters may be set without authority, but by nobody of a lower level than who has it.
/// An emergency stop is obeyed from anybody, whatever else the request says.
class Arbiter {
 public:
  explicit Arbiter(ArbiterState& state) : state_(state) {}

  /// Rules on a request of the built-in planner (topic planner/request).
  Ruling decide_planner(const msg::Request& request) { return decide(request, true); }
  /// Rules on a request from outside the run: never at the built-in planner's level, nor under its name.
  Ruling decide_outside(const msg::Request& request, const WriterId& writer = {});
  /// A source's process is gone. If it held authority, that falls to nobody and the robot holds its posture. It is forgotten:
  /// one of the same name is another source. Of a detached holder authority and the count of its goals stay until it loses authority.
  Ruling on_death(const std::string& source);
  /// Whether the source of this name is known by another writer than this one.
  [[nodiscard]] bool has_another_writer(const std::string& source, const WriterId& writer) const;
  /// The sources outside that have a writer.
  [[nodiscard]] std::vector<LivingSource> living() const;
  /// Refuses a request for a reason that was found elsewhere.
  Ruling refuse(const msg::Request& request, const std::string& reason);

 private:
  using Source = ArbiterState::Source;
  Ruling refuse(const std::string& reason);
  void note(const msg::Request& request);
  Ruling decide(const msg::Request& request, bool built_in);
  Ruling decide_task(const msg::Request& request, Source& source);
  Ruling stop(const std::string& source);
  Ruling clear_stop(const msg::Request& request);
  Ruling release(const msg::Request& request);
  void hold(const msg::Request& request, Source& source);
  [[nodiscard]] bool holder_is_detached() const;
  void leave_to_nobody();
  void forget_gone_holder();
  ArbiterState& state_;
};

/// The goal's id on task/command: (level << 48) + (index of the source << 32) + the source's own id, so that goals of different
/// sources never meet and each source knows the ids of its own.
constexpr std::uint64_t mapped_goal_id(std::uint8_t level, std::uint32_t index, std::uint64_t own_id) {
  return (static_cast<std::uint64_t>(level) << 48) + (static_cast<std::uint64_t>(index & 0xffffu) << 32) + (own_id & 0xffffffffu);
}

}  // namespace constrictor
