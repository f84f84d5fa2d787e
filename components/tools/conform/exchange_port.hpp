// A part in a run over DDS. The components of the surroundings are members of this process; they exchange messages
// with the thread that makes the checks, once in each tick.
#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "conform/part_port.hpp"
#include "conform/part_stand.hpp"
#include "cyclone/entity.hpp"

namespace constrictor::conform {

class ExchangePort final : public PartPort, public StandBoard {
 public:
  /// `is_served`: the user has started the part by hand, and nobody would start it again.
  ExchangePort(std::string part, std::uint32_t domain, bool is_served = false);
  ~ExchangePort() override;

  void begin_epoch() override;
  [[nodiscard]] std::uint64_t refused() override;
  [[nodiscard]] std::string restart() override;
  [[nodiscard]] std::uint32_t incarnation() override;

  // The components. begin_tick() waits until the checks have decided what is written in the tick.
  void begin_tick(const Tick& tick) override;
  std::vector<Sample> take(std::size_t topic) override;
  void deliver(const Tick& tick, std::vector<Letter> arrived) override;
  [[nodiscard]] bool finished() const override { return finished_; }

  /// No more ticks will come: advance() throws PartGone.
  void end();
  /// The checks have ended: the components ask the run to end.
  void finish();

 private:
  void exchange(std::vector<Letter> outgoing) override;
  struct Operator;
  Operator& client();
  /// The newest status of the part; waits for one that is not too old.
  Operator& fresh_status();

  std::string part_;
  std::uint32_t domain_;
  bool is_served_;
  std::unique_ptr<Operator> operator_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<std::vector<Letter>> decided_;  ///< by the checks, for the next tick
  bool awaited_ = false;                        ///< the checks wait for a tick
  std::vector<Letter> current_;                 ///< of the present tick, not yet written
  std::vector<Letter> delivered_;
  std::uint64_t deliveries_ = 0;
  std::int64_t delivered_tick_ = -1;
  std::uint32_t delivered_epoch_ = 0;
  bool ended_ = false;
  std::atomic<bool> finished_{false};
};

}  // namespace constrictor::conform
