// The time master's side of the barrier: who takes part, when the next tick may come, what it makes visible, and what a
// restarted member is told. Pure: no DDS, no clock.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "runtime/barrier/protocol.hpp"

namespace constrictor {

class ConductorSink {
 public:
  virtual ~ConductorSink() = default;
  virtual void start_epoch(const EpochId& epoch, std::uint64_t seed) = 0;
  virtual void tick(const msg::Tick& tick) = 0;
  virtual void resume(const Resumption& resumption) = 0;
  virtual void refuse(const Greeting& greeting, const std::string& reason) = 0;
};

struct ConductorOptions {
  std::uint64_t run_id = 1;
  std::vector<std::string> roster;  ///< every member, the plant included
  std::string plant;                ///< its name
  std::string idl_hash;
  std::string config_hash;
  std::string numeric_profile;
  std::uint64_t seed = 1;
  std::int64_t period_ns = 20'000'000;
  bool realtime = false;            ///< nobody is waited for once all are ready
  std::int64_t last_index = -1;     ///< the run ends with this tick at the latest; negative: it has no such end
};

class Conductor {
 public:
  Conductor(ConductorOptions options, ConductorSink& sink);

  /// A member introduces itself: joins, rejoins with a newer incarnation, or is refused with the reason.
  void on_greeting(const Greeting& greeting);
  void on_ready(const std::string& component, const EpochId& epoch, std::uint32_t incarnation);
  /// Why a message of this member, epoch and incarnation is none of this run's, if so. An older incarnation's is: it comes late.
  [[nodiscard]] std::optional<std::string> stranger(const std::string& component, const EpochId& epoch, std::uint32_t incarnation) const;
  /// What cannot be true of a step from elsewhere, if anything; on_done() must not see it then.
  [[nodiscard]] std::optional<std::string> implausible(const StepDone& done) const;
  /// Returns whether it counts: false for an older incarnation, another epoch, or a step done before.
  bool on_done(const StepDone& done);
  /// Ends this epoch and begins the next; every member builds its component anew and says ready again.
  void reset(std::uint64_t seed);
  /// Lets the run end: the next tick is the final one.
  void end_run() { end_requested_at_ = next_index_; }

  /// True when everybody is there and has done what the next tick needs.
  [[nodiscard]] bool may_tick() const;
  /// Index and time of the tick that comes next.
  [[nodiscard]] std::int64_t next_index() const { return next_index_; }
  [[nodiscard]] std::int64_t next_time_ns() const { return next_index_ * options_.period_ns; }
  /// Sends the next tick. `plant` are the counts after the plant sampled for it.
  void tick(const std::vector<StepDone::Count>& plant);
  [[nodiscard]] bool next_is_final() const {
    return (end_requested_at_ && *end_requested_at_ <= next_index_) || (options_.last_index >= 0 && options_.last_index <= next_index_);
  }
  [[nodiscard]] bool ended() const { return ended_; }
  [[nodiscard]] std::optional<EpochId> epoch() const { return epoch_; }
  [[nodiscard]] std::uint64_t run_id() const { return options_.run_id; }
  [[nodiscard]] std::uint64_t seed() const { return seed_; }

  /// Members that keep the next tick from coming, with what they owe ("Hello", "Ready" or "TickDone").
  struct Owed {
    std::string component;
    const char* what;
    std::int64_t have;  ///< last tick done
    std::int64_t want;
  };
  [[nodiscard]] std::vector<Owed> owed() const;
  /// Output hash chain of each member over what was visible at the last tick; for reports and comparison of runs.
  [[nodiscard]] std::map<std::string, std::array<std::uint8_t, 32>> output_hashes() const;
  [[nodiscard]] std::uint32_t incarnation(const std::string& component) const;
  /// What it knows of a member, for comparison of states: incarnation, ready or not, last tick done.
  [[nodiscard]] std::string known_of(const std::string& component) const;

 private:
  /// A step that is done and whose outputs are not visible yet.
  struct Pending {
    std::int64_t index;
    std::uint32_t incarnation;
    std::vector<StepDone::Count> published;
    std::array<std::uint8_t, 32> output_hash;
  };
  struct MemberState {
    Greeting greeting;
    bool greeted = false;
    bool ready = false;
    std::int64_t last_done = -1;
    std::deque<Pending> pending;
    std::array<std::uint64_t, msg::kMaxTopics> published{};           ///< by topic, after last_done
    std::array<std::uint8_t, 32> output_hash{};                       ///< of what is visible
    std::string state;                                                ///< checkpoint after last_done
    std::map<std::uint8_t, std::deque<std::string>> history;          ///< last outputs by topic
  };
  [[nodiscard]] std::int64_t newest_due(const MemberState& member, std::int64_t tick) const;
  void clear_epoch_state();
  void send_resume(const MemberState& member);

  ConductorOptions options_;
  ConductorSink& sink_;
  std::map<std::string, MemberState> members_;
  std::optional<EpochId> epoch_;
  std::uint64_t seed_;
  std::int64_t next_index_ = 0;
  bool ended_ = false;
  std::optional<std::int64_t> end_requested_at_;
  std::array<std::uint64_t, msg::kMaxTopics> visible_{};
  std::array<std::uint32_t, msg::kMaxTopics> incarnations_{};
};

}  // namespace constrictor
