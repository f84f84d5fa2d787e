// The latch between a plant and a process outside the barrier that drives the joints. The runtime adds what arrives on
// the topics hardware/*, in any thread; the plant takes it at a tick.
#pragma once

#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "constrictor/messages.hpp"

namespace constrictor {

class HardwareLink {
 public:
  /// Bounds what is kept between two ticks, whatever arrives; the oldest are dropped.
  static constexpr std::size_t kMostSamples = 16;
  static constexpr std::size_t kMostRefusals = 8;

  /// Everything since the last take(), oldest first.
  struct Arrived {
    std::vector<msg::HardwareJointState> joints;
    std::vector<msg::HardwareContactState> contacts;
    std::vector<msg::HardwareImuState> imus;
    std::vector<std::string> refused;  ///< why samples were refused that broke their IDL
  };

  void add(const msg::HardwareJointState& sample) { keep(arrived_.joints, sample); }
  void add(const msg::HardwareContactState& sample) { keep(arrived_.contacts, sample); }
  void add(const msg::HardwareImuState& sample) { keep(arrived_.imus, sample); }
  /// Adds the reason why a sample was refused, before the plant could see it.
  void add_refused(const std::string& reason) {
    const std::lock_guard lock(mutex_);
    if (arrived_.refused.size() < kMostRefusals) arrived_.refused.push_back(reason);
  }
  [[nodiscard]] Arrived take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(arrived_, {});
  }

  /// Sends a command. Does nothing if no process can be reached.
  void send(const msg::HardwareJointCommand& command) const {
    if (send_) send_(command);
  }
  /// [ns] on a clock that rises; 0: there is none. For diagnoses, never for results.
  [[nodiscard]] std::int64_t now_ns() const { return clock_ ? clock_() : 0; }
  /// To be called by the runtime before the first tick.
  void connect(std::function<void(const msg::HardwareJointCommand&)> sender, std::function<std::int64_t()> clock) {
    send_ = std::move(sender);
    clock_ = std::move(clock);
  }

 private:
  template <class Sample>
  void keep(std::vector<Sample>& samples, const Sample& sample) {
    const std::lock_guard lock(mutex_);
    if (samples.size() == kMostSamples) samples.erase(samples.begin());
    samples.push_back(sample);
  }

  std::mutex mutex_;
  Arrived arrived_;
  std::function<void(const msg::HardwareJointCommand&)> send_;
  std::function<std::int64_t()> clock_;
};

}  // namespace constrictor
