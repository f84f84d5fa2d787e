// Where requests from outside the run (operators, external planners) enter it. Any thread adds; the input layer takes everything
// at a tick boundary, in an order that does not depend on arrival.
#pragma once

#include <cstdint>
#include <mutex>
#include <string>
#include <vector>

#include "constrictor/messages.hpp"

namespace constrictor {

/// A request from outside, or the news that a source is gone.
struct OutsideItem {
  std::string source;
  bool died = false;        ///< the source's writer lost its liveliness; `request` is empty then
  msg::Request request{};
};

/// The latch. What is taken at a tick was added before it; the strongest level first, then by source and
/// sequence_number, deaths last.
/// At most `capacity` items are kept between two ticks; more are dropped and counted, but always one emergency stop.
class OutsideRequests {
 public:
  explicit OutsideRequests(std::size_t capacity = 64) : capacity_(capacity) {}

  void add(const msg::Request& request);
  void add_death(const std::string& source);
  /// Everything since the last call, in order.
  [[nodiscard]] std::vector<OutsideItem> latch();
  [[nodiscard]] std::uint64_t dropped() const;

 private:
  std::size_t capacity_;
  mutable std::mutex mutex_;
  std::vector<OutsideItem> items_;
  bool stop_kept_ = false;  ///< an emergency stop was kept beyond the capacity
  std::uint64_t dropped_ = 0;
};

}  // namespace constrictor
