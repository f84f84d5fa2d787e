// The conductor: it tracks which members take part, decides when the next tick may come and what the tick makes
// visible, and lets restarted members resume. Without DDS and clock.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "barrier/checkpoint.hpp"
#include "barrier/protocol.hpp"

namespace constrictor {

/// Receives what the conductor sends.
class ConductorSink {
 public:
  virtual ~ConductorSink() = default;
  virtual void start_epoch(const EpochId& epoch, std::uint64_t seed) = 0;
  /// A successor sends what its predecessor has sent and what died with it: the present epoch and its last ticks.
  virtual void continue_epoch(const EpochId& epoch, std::uint64_t seed, const std::vector<msg::Tick>& ticks) {
    static_cast<void>(epoch), static_cast<void>(seed), static_cast<void>(ticks);
  }
  virtual void tick(const msg::Tick& tick) = 0;
  virtual void resume(const Resume& resume) = 0;
  virtual void refuse(const Hello& hello, const std::string& reason) = 0;
};

struct ConductorOptions {
  std::uint64_t run_id = 1;
  std::vector<std::string> roster;  ///< every member, the plant included
  std::string plant;                ///< its name
  std::string idl_hash;
  std::string release;
  std::string config_hash;
  std::string component_hash;  ///< of the plant: only its part for the scenario is compared with those of the members
  std::string numeric_profile;
  std::uint64_t seed = 1;
  std::int64_t period_ns = 20'000'000;
  bool realtime = false;         ///< once all members are ready, ticks do not wait for members
  std::int64_t last_index = -1;  ///< the run ends with this tick at the latest; negative: no such limit
};

class Conductor {
 public:
  Conductor(ConductorOptions options, ConductorSink& sink);
  /// The successor of a conductor that has died: it continues from save(). Throws std::runtime_error if the checkpoint
  /// belongs to another run, release or configuration; the message names both values.
  Conductor(ConductorOptions options, ConductorSink& sink, const Checkpoint& checkpoint);
  /// To be called once by a successor, when the members of its process have sent Hello: lets the sink send again what
  /// died with the predecessor.
  void continue_epoch();

  /// Everything that a successor needs. A conductor that is to be continued is saved before each call of the sink is
  /// carried out, so that no process has ever received something from it that the checkpoint does not contain. What
  /// the conductor received since then, the successor receives again from the histories of the writers. The result uses
  /// the memory of `memory`, whose content is lost.
  [[nodiscard]] Checkpoint save(Checkpoint memory = {}) const;

  /// A member announces itself: it joins, it comes back with a newer incarnation, or it is refused with a reason.
  void on_hello(const Hello& hello);
  void on_ready(const std::string& component, const EpochId& epoch, std::uint32_t incarnation);
  /// Why a message of this component, epoch and incarnation does not belong to this run; empty if it does. A message of
  /// an older incarnation does: it is only late.
  [[nodiscard]] std::optional<std::string> foreign(const std::string& component, const EpochId& epoch,
                                                   std::uint32_t incarnation) const;
  /// The reason why a TickDone of another process cannot be true; empty if it is plausible. An implausible message must
  /// not be passed to on_done(). The component of the message must be in the roster.
  [[nodiscard]] std::optional<std::string> implausible(const TickDone& done) const;
  /// Whether this is the report of the very next tick, which this conductor has not sent. Its predecessor has sent it
  /// if its newest checkpoint was damaged. The message must be kept until the tick is sent.
  [[nodiscard]] bool is_early(const TickDone& done) const;
  /// Returns whether the step counts: false for an older incarnation, another epoch, or a step that was done before.
  bool on_done(const TickDone& done);
  /// Ends this epoch and begins the next: every member builds its component anew and sends Ready again.
  void reset(std::uint64_t seed);
  /// Makes the next tick the final one.
  void end_run() { end_requested_at_ = next_index_; }

  /// True if all members are ready and have finished the steps that the next tick needs.
  [[nodiscard]] bool may_tick() const;
  /// Index and time of the tick that comes next.
  [[nodiscard]] std::int64_t next_index() const { return next_index_; }
  [[nodiscard]] std::int64_t next_time_ns() const { return next_index_ * options_.period_ns; }
  /// Sends the next tick. `plant`: the plant's counts after it has measured for this tick, and its checkpoint.
  void tick(const std::vector<TickDone::Count>& plant, PlantCheckpoint checkpoint = {});
  [[nodiscard]] bool next_is_final() const {
    return (end_requested_at_ && *end_requested_at_ <= next_index_) ||
           (options_.last_index >= 0 && options_.last_index <= next_index_);
  }
  [[nodiscard]] bool ended() const { return ended_; }
  [[nodiscard]] std::optional<EpochId> epoch() const { return epoch_; }
  [[nodiscard]] std::uint64_t run_id() const { return options_.run_id; }
  [[nodiscard]] std::uint64_t seed() const { return seed_; }

  /// A member that the next tick waits for, and the message that it has not sent yet.
  struct Owed {
    std::string component;
    const char* what;   ///< "Hello", "Ready" or "TickDone"
    std::int64_t have;  ///< tick of the last finished step
    std::int64_t want;  ///< tick whose step must be finished
  };
  [[nodiscard]] std::vector<Owed> owed() const;
  /// Whether the next tick waits for a TickDone of this member of the roster.
  [[nodiscard]] bool awaits_step(const std::string& component) const;
  /// Output hash of each member over what is visible at the last tick.
  [[nodiscard]] std::map<std::string, std::array<std::uint8_t, 32>> output_hashes() const;
  [[nodiscard]] std::uint32_t incarnation(const std::string& component) const;
  /// The conductor's knowledge of a member, as text that tests compare: incarnation, ready or not, last finished step.
  [[nodiscard]] std::string known_of(const std::string& component) const {
    const MemberState& member = members_.at(component);
    return std::to_string(member.hello.incarnation) + (member.ready ? "r" : "-") + std::to_string(member.last_done);
  }

 private:
  /// A finished step whose outputs are not visible yet.
  struct Pending {
    std::int64_t index = 0;
    std::uint32_t incarnation = 0;
    std::array<std::uint64_t, msg::kMaxTopics> published{};  ///< counts by topic after the step
    std::array<std::uint8_t, 32> output_hash{};
  };
  struct MemberState {
    Hello hello;
    bool hello_received = false;
    bool ready = false;
    std::int64_t last_done = -1;
    std::vector<Pending> pending;
    std::array<std::uint64_t, msg::kMaxTopics> published{};  ///< counts by topic after last_done
    std::array<std::uint8_t, 32> output_hash{};              ///< of what is visible
    Blob state;                                              ///< checkpoint; null: none
    std::int64_t state_index = -1;                           ///< last step that `state` contains
    std::map<std::uint8_t, std::deque<Blob>> history;        ///< newest outputs by topic
  };
  struct Archived;
  static void keep(MemberState& member, TickDone::Written written);
  [[nodiscard]] std::int64_t newest_due(const MemberState& member, std::int64_t tick) const;
  /// Why the latencies do not suit the depths of the topics; empty if they do, or if another member has not joined yet.
  [[nodiscard]] std::optional<std::string> latency_violation(const Hello& hello) const;
  /// Why `hello` may not take the place of a member with another configuration; empty: it may.
  [[nodiscard]] std::optional<std::string> replacement_violation(const Hello& before, const Hello& hello) const;
  void clear_epoch_state();
  void send_resume(const MemberState& member);

  ConductorOptions options_;
  ConductorSink& sink_;
  std::map<std::string, MemberState> members_;
  std::optional<EpochId> epoch_;
  std::uint64_t seed_;
  std::int64_t next_index_ = 0;
  bool ended_ = false;
  bool successor_ = false;        ///< it continues from a checkpoint
  bool awaits_plant_ = false;     ///< likewise, and the plant has not sent its Hello
  std::vector<msg::Tick> ticks_;  ///< the newest ones: those that a member may not have stepped at
  std::optional<std::int64_t> end_requested_at_;
  std::array<std::uint64_t, msg::kMaxTopics> visible_{};
  std::array<std::uint32_t, msg::kMaxTopics> incarnations_{};
};

}  // namespace constrictor
