// The arbiter decides for each request whether its source may command the robot. It contains no DDS code.
#pragma once

#include <cereal/types/array.hpp>
#include <cereal/types/map.hpp>
#include <cereal/types/string.hpp>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "component/client_requests.hpp"
#include "constrictor/messages.hpp"

namespace constrictor {

/// The whole state of the arbiter.
struct ArbiterState {
  struct Source {
    std::uint64_t sequence = 0;   ///< newest sequence number with a decision
    std::uint64_t decided = 0;    ///< bit i: there is a decision on number `sequence` - i
    std::uint64_t granted = 0;    ///< bit i: that request was granted
    WriterId writer{};            ///< writer of its newest request; all zeros: unknown
    std::uint32_t index = 0;      ///< counts the sources by their first request; the built-in planner has 0
    std::uint64_t last_goal = 0;  ///< newest goal that it started, by its own count
    bool detached = false;        ///< its authority outlives its writer
    bool gone = false;            ///< its writer is dead; it still has authority because it is detached
    template <class Archive>
    void serialize(Archive& archive) {
      archive(sequence, decided, granted, writer, index, last_goal, detached, gone);
    }
  };
  std::uint8_t level = msg::kAuthorityNone;
  std::string holder;    ///< source that has authority; empty: none
  bool stopped = false;  ///< an emergency stop is latched
  std::string stopper;   ///< source that requested the emergency stop
  std::map<std::string, Source> sources;
  std::uint32_t next_index = 1;
  std::uint64_t refused = 0;   ///< number of refused requests
  std::string refusal;         ///< why the last refused request was refused
  std::string refused_source;  ///< source of that request
  std::uint64_t refused_sequence = 0;
  std::string answered_source;  ///< source of the last request, granted or refused
  std::uint64_t answered_sequence = 0;

  template <class Archive>
  void serialize(Archive& archive) {
    archive(level, holder, stopped, stopper, sources, next_index, refused, refusal, refused_source, refused_sequence,
            answered_source, answered_sequence);
  }
};

/// The decision on a request.
struct Decision {
  enum Kind {
    kRefused,
    kForward,    ///< send the task command to navigation with `goal_id`
    kMove,       ///< send the direct motion to navigation
    kSet,        ///< the source may change the parameter
    kCancelAll,  ///< the running task or motion must end
    kNothing,
    kRepeated,  ///< there is a decision already: nothing happens, and the answer is repeated
  };
  Kind kind = kNothing;
  std::uint64_t goal_id = 0;  ///< of kForward: the id on task/command
  bool granted = false;       ///< of kRepeated: the first answer
};

/// The levels of authority are, from the strongest: emergency stop, operator, external planner, built-in planner. A
/// request for a task, a motion or authority itself takes authority if its source's level is above the holder's.
/// Requests of the same or a lower level are refused until the holder releases authority or dies. A detached holder
/// does not die; other sources of its level may take authority from it, or release it. There is one decision on each
/// request, however often it is repeated under its number. Sources may change parameters without authority, unless the
/// holder has a higher level. An emergency stop is obeyed from every source, whatever else the request contains.
class Arbiter {
 public:
  explicit Arbiter(ArbiterState& state) : state_(state) {}

  /// Decides on a request of the built-in planner (topic planner/request).
  Decision decide_planner(const msg::Request& request) { return decide(request, true); }
  /// Decides on a request of a client, which has neither the level nor the name of the built-in planner.
  Decision decide_client(const msg::Request& request, const WriterId& writer = {});
  /// Latches an emergency stop of this source: that of a request, or one that the plant has latched.
  Decision stop(const std::string& source);
  /// The process of a source is gone. If the source had authority, no source has it now. The source is forgotten: a
  /// later one of the same name is another source. A detached holder keeps authority and the count of its goals until
  /// it loses authority.
  Decision on_death(const std::string& source);
  /// Whether the known source of this name has another writer than this one.
  [[nodiscard]] bool has_another_writer(const std::string& source, const WriterId& writer) const;
  /// The clients with a living writer.
  [[nodiscard]] std::vector<LivingSource> living() const;
  /// Refuses a request for a reason that the caller has found.
  Decision refuse(const msg::Request& request, const std::string& reason);

 private:
  using Source = ArbiterState::Source;
  Decision refuse(const std::string& reason);
  /// Makes this request the last one in the state.
  void note(const msg::Request& request);
  Decision decide(const msg::Request& request, bool built_in);
  Decision decide_task(const msg::Request& request, Source& source);
  Decision clear_stop(const msg::Request& request);
  Decision release(const msg::Request& request);
  void hold(const msg::Request& request, Source& source);
  [[nodiscard]] bool holder_is_detached() const;
  void leave_to_nobody();
  void forget_gone_holder();
  ArbiterState& state_;
};

/// The goal's id on task/command: (level << 48) + (index of the source << 32) + the source's own id. Goals of different
/// sources therefore have different ids, and each source can compute the ids of its own goals.
constexpr std::uint64_t mapped_goal_id(std::uint8_t level, std::uint32_t index, std::uint64_t own_id) {
  return (static_cast<std::uint64_t>(level) << 48) + (static_cast<std::uint64_t>(index & 0xffffu) << 32) +
         (own_id & 0xffffffffu);
}

}  // namespace constrictor
