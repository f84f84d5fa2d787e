// A plant that is a member of a run. The process takes the place of `control`: a component exchanges ticks and commands
// with the thread that makes the checks.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>

#include "component/component.hpp"
#include "conform/plant_port.hpp"

namespace constrictor::conform {

/// Between the component, which is constructed anew in each epoch, and the thread of the checks.
class TickExchange {
 public:
  struct Observed {
    std::vector<JointSample> joints;
    std::vector<ImuSample> imus;
    std::vector<ContactSample> contacts;
    bool stopped = false;
    std::uint32_t epoch = 0;
    std::int64_t tick = -1;
  };
  /// Called by the component at each tick: adds its inputs. Returns the command of this tick; empty: none.
  std::optional<PlantCommand> step(const Observed& observed);
  /// The checks: gives the command of the next tick and waits until the component has taken it. Returns what the
  /// component has seen since the last call. Throws PlantGone if the run has ended, or makes no ticks.
  Observed advance(std::optional<PlantCommand> command);
  /// No more ticks will come.
  void end();
  /// The checks have ended: the component asks the run to end.
  void finish() { finished_ = true; }
  [[nodiscard]] bool finished() const { return finished_; }

 private:
  std::mutex mutex_;
  std::condition_variable stepped_;
  Observed observed_;
  std::optional<PlantCommand> command_;
  std::uint64_t steps_ = 0;
  bool ended_ = false;
  std::atomic<bool> finished_{false};
};

/// The actions of a client for the checks: emergency stops, new epochs, and the plant's process.
struct RunClient {
  std::function<void()> stop, clear_stop, begin_epoch;
  std::function<std::string()> restart;        ///< as PlantPort::restart()
  std::function<std::uint32_t()> incarnation;  ///< of the plant; 0: it is not known
};

class MemberPort final : public PlantPort {
 public:
  MemberPort(TickExchange& exchange, RunClient client) : exchange_(exchange), client_(std::move(client)) {}
  [[nodiscard]] Abilities abilities() const override { return {false, true, true, false}; }
  void advance(const std::vector<PlantCommand>& commands) override;
  [[nodiscard]] double now_s() const override;
  void order_stop() override { client_.stop(); }
  void clear_stop() override { client_.clear_stop(); }
  [[nodiscard]] bool stopped() const override { return stopped_; }
  void begin_epoch() override { client_.begin_epoch(); }
  [[nodiscard]] std::uint32_t epoch() const override { return epoch_; }
  [[nodiscard]] std::string restart() override { return client_.restart(); }
  [[nodiscard]] std::uint64_t incarnation() const override { return client_.incarnation(); }

 private:
  TickExchange& exchange_;
  RunClient client_;
  bool stopped_ = false;
  std::uint32_t epoch_ = 0;
};

/// The component `control` of such a process.
ComponentFactory make_conform_factory(TickExchange& exchange);

}  // namespace constrictor::conform
