// A whole run in one process without DDS: the same Conductor and Members on direct queues. The reference that distributed
// runs are compared with, and the harness of component tests.
#pragma once

#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "runtime/barrier/conductor.hpp"
#include "runtime/barrier/member.hpp"

namespace constrictor {

class LocalRun : private MemberSink, private ConductorSink {
 public:
  /// `factories`: the plant first. `setup` is every component's but for its name. `config_files` gives components their own
  /// configuration by name.
  LocalRun(std::vector<ComponentFactory> factories, Setup setup,
           std::map<std::string, std::filesystem::path> config_files = {});
  ~LocalRun() override;

  /// Runs `ticks` ticks or until the run ends; returns the ticks done.
  std::int64_t advance(std::int64_t ticks);
  [[nodiscard]] bool ended() const { return conductor_->ended(); }
  /// Index of the next tick.
  [[nodiscard]] std::int64_t tick() const { return conductor_->next_index(); }
  [[nodiscard]] double time_s() const { return static_cast<double>(conductor_->next_time_ns()) * 1e-9; }

  /// Newest sample written, whether or not visible yet; null before the first.
  template <class T>
  [[nodiscard]] const T* latest(const Topic<T>& topic) const {
    return history_[topic.id].empty() ? nullptr : static_cast<const T*>(history_[topic.id].back().message.get());
  }
  /// Called for every sample at the time it is written.
  template <class T>
  void subscribe(const Topic<T>& topic, std::function<void(const T&)> callback) {
    subscribers_[topic.id].push_back(
        [callback = std::move(callback)](const Sample& sample) { callback(*static_cast<const T*>(sample.message.get())); });
  }

  [[nodiscard]] Component& component(const std::string& name) { return member(name).component(); }
  [[nodiscard]] Member& member(const std::string& name);
  /// Throws the member away as a crash would and resumes a new incarnation from its last checkpoint.
  void restart(const std::string& name);
  /// The next tick becomes the final one.
  void end_run() { conductor_->end_run(); }
  /// A new epoch with this seed.
  void reset(std::uint64_t seed) { conductor_->reset(seed); }
  /// SHA-256 chains of everything each member wrote, by name.
  [[nodiscard]] std::map<std::string, std::array<std::uint8_t, 32>> output_hashes() const {
    return conductor_->output_hashes();
  }

 private:
  void publish(const TopicInfo& topic, const Sample& sample) override;
  void done(const StepDone& done) override;
  void start_epoch(const EpochId& epoch, std::uint64_t seed) override;
  void tick(const msg::Tick& tick) override;
  void resume(const Resumption& resumption) override;
  void refuse(const Greeting& greeting, const std::string& reason) override;
  [[nodiscard]] std::unique_ptr<Member> make(std::size_t index, std::uint32_t incarnation);
  void greet(const Member& member);

  std::vector<ComponentFactory> factories_;
  Setup setup_;
  std::map<std::string, std::filesystem::path> config_files_;
  std::vector<std::unique_ptr<Member>> members_;  ///< plant first
  std::unique_ptr<Conductor> conductor_;
  std::array<std::deque<Sample>, topics::kCount> history_;
  std::deque<msg::Tick> ticks_;
  std::array<std::vector<std::function<void(const Sample&)>>, topics::kCount> subscribers_;
};

}  // namespace constrictor
