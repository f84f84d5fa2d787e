// Watches over DDS whether the run that a client has joined still exists.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include "client/run_attachment.hpp"
#include "client/run_registry.hpp"
#include "constrictor/messages.hpp"
#include "cyclone/endpoint.hpp"

namespace constrictor {

/// Reads the state of the run, of its plant and of `input`. The run is the one of the first RunState that arrives;
/// messages of other runs in the same domain are ignored.
class RunMonitor {
 public:
  /// `participant`, in the DDS domain of `run`, must outlive this object.
  RunMonitor(const RunNote& run, std::int32_t participant);
  /// Takes everything that has arrived. Looks whether the launcher still holds its claim of the domain, if it is on
  /// this host.
  void poll();
  /// Whether the run goes on, and what may be sent to it.
  [[nodiscard]] const RunAttachment& attachment() const { return attachment_; }
  /// The newest state of the run; empty before the first.
  [[nodiscard]] const std::optional<msg::RunState>& state() const { return state_; }
  /// True if a message belongs to the run and to its present epoch. False before the first RunState: messages of this
  /// run cannot be distinguished from those that an earlier run left.
  [[nodiscard]] bool is_present(const msg::Header& header) const {
    return state_ && header.run_id == state_->run_id && header.epoch >= state_->epoch;
  }

 private:
  RunNote run_;
  dds::Reader<msg::RunState> states_;
  dds::Reader<msg::ComponentStatus> statuses_;
  dds::Reader<msg::Authority> input_;  ///< only to see whether `input` has its writer
  std::optional<msg::RunState> state_;
  RunSigns signs_;
  RunAttachment attachment_;
  RunAttachment::Clock::time_point claim_looked_at_{};
};

}  // namespace constrictor
