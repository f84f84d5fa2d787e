// A whole run in one process without DDS: the same conductor and members, connected by direct calls. Distributed runs
// are compared with it, and tests of components use it.
#pragma once

#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "barrier/conductor.hpp"
#include "barrier/member.hpp"

namespace constrictor {

class LocalRun : private MemberSink, private ConductorSink {
 public:
  /// `factories`: the plant's first. `setup`: of all components, name and configuration file aside. `config_files`:
  /// configuration files by component; a component without one has its default. Throws std::invalid_argument if the
  /// first component is not a plant.
  LocalRun(std::vector<ComponentFactory> factories, Setup setup,
           std::map<std::string, std::filesystem::path> config_files = {});
  ~LocalRun() override;

  /// Makes `ticks` ticks, or fewer if the run ends; returns how many it made.
  std::int64_t advance(std::int64_t ticks);
  [[nodiscard]] bool ended() const { return conductor_->ended(); }
  /// Index of the next tick.
  [[nodiscard]] std::int64_t tick() const { return conductor_->next_index(); }
  [[nodiscard]] double time_s() const { return static_cast<double>(conductor_->next_time_ns()) * 1e-9; }

  /// Newest sample that was written, also if it is not visible yet; null before the first.
  template <class T>
  [[nodiscard]] const T* latest(const Topic<T>& topic) const {
    return history_[topic.id].empty() ? nullptr : static_cast<const T*>(history_[topic.id].back().message.get());
  }
  /// Calls `callback` with every sample at the time when it is written.
  template <class T>
  void subscribe(const Topic<T>& topic, std::function<void(const T&)> callback) {
    subscribers_[topic.id].push_back([callback = std::move(callback)](const Sample& sample) {
      callback(*static_cast<const T*>(sample.message.get()));
    });
  }

  [[nodiscard]] Component& component(const std::string& name) { return member(name).component(); }
  [[nodiscard]] Member& member(const std::string& name);
  /// Destroys the member, as a crash would, and resumes a new incarnation from the last checkpoint. The plant dies
  /// together with the conductor; both continue from the conductor's checkpoint.
  void restart(const std::string& name);
  /// The conductor's checkpoint, which a process of the plant would store before the next tick.
  [[nodiscard]] Checkpoint checkpoint() const { return conductor_->save(); }
  /// Makes the next tick the final one.
  void end_run() { conductor_->end_run(); }
  /// Begins a new epoch with this seed.
  void reset(std::uint64_t seed) { conductor_->reset(seed); }
  /// Output hashes by member.
  [[nodiscard]] std::map<std::string, std::array<std::uint8_t, 32>> output_hashes() const {
    return conductor_->output_hashes();
  }

 private:
  void publish(const TopicInfo& topic, const Sample& sample) override;
  void done(const TickDone& done) override;
  void start_epoch(const EpochId& epoch, std::uint64_t seed) override;
  void continue_epoch(const EpochId& epoch, std::uint64_t seed, const std::vector<msg::Tick>& ticks) override;
  void tick(const msg::Tick& tick) override;
  void resume(const Resume& resume) override;
  void refuse(const Hello& hello, const std::string& reason) override;
  [[nodiscard]] std::unique_ptr<Member> make(std::size_t index, std::uint32_t incarnation);
  void send_hello(const Member& member);
  void restart_plant();

  std::vector<ComponentFactory> factories_;
  Setup setup_;
  ConductorOptions options_;
  std::map<std::string, std::filesystem::path> config_files_;
  std::vector<std::unique_ptr<Member>> members_;  ///< plant first
  std::unique_ptr<Conductor> conductor_;
  std::array<std::deque<Sample>, topics::kCount> history_;
  std::deque<msg::Tick> ticks_;
  std::array<std::vector<std::function<void(const Sample&)>>, topics::kCount> subscribers_;
};

}  // namespace constrictor
